//! Texts of subprograms, as a program asks for them.

use crate::flow::{Flow, Place};
use std::path::PathBuf;

impl Flow {
    /// Where the files that were read so far lie.
    #[must_use]
    pub fn paths(&self) -> &[PathBuf] {
        self.library.paths()
    }

    /// The number of a text, by which moves and reports know it.
    #[must_use]
    pub fn number(&self, place: Place) -> u16 {
        self.library.number(place.text)
    }
}
