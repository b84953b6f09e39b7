//! Places in the texts of a program.

/// A line of one of the texts, from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Place {
    /// Which text; 0 is the program itself.
    pub text: usize,
    /// Its line, from 0.
    pub line: usize,
}
