//! The programs of a set, and what becomes of them.

use super::super::{Failure, LimitSummary, Options};
use crate::interpret::Shelf;
use std::path::PathBuf;
use std::sync::Arc;

/// A program of a set.
#[derive(Debug)]
pub struct SetProgram {
    /// What reports call it.
    pub name: String,
    /// Where it lies: another program may call it.
    pub path: PathBuf,
    /// Its bytes.
    pub text: Arc<[u8]>,
    /// How it is read, with the folders where its subprograms are looked for.
    pub options: Options,
}

/// A file as it is to be written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SetFile {
    /// What reports call it.
    pub name: String,
    /// Where the original lies, its folder without links.
    pub path: PathBuf,
    /// Its bytes; those of the original where nothing is changed.
    pub text: Vec<u8>,
    /// Number of lines that were changed or inserted.
    pub edited_lines: u64,
}

/// What was done to a set.
#[derive(Debug)]
pub struct SetSummary {
    /// What became of each program, in the order given.
    pub programs: Vec<LimitSummary>,
    /// The programs in the same order, then the files of subprograms.
    pub files: Vec<SetFile>,
}

impl SetSummary {
    /// True when the certificate holds for all programs: only then may the files be
    /// delivered.
    #[must_use]
    pub fn certified(&self) -> bool {
        self.programs.iter().all(|program| program.certified)
    }

    /// True where the written programs are at least the originals made slower.
    #[must_use]
    pub fn slower(&self) -> bool {
        let mut programs = self.programs.iter();
        programs.all(|program| program.certified || program.slower)
    }

    /// How a program is read together with all files as they are written.
    #[must_use]
    pub fn options_after(&self, programs: &[SetProgram], place: usize) -> Options {
        let mut shelf = Shelf::default();
        for file in &self.files {
            shelf.put(&file.path, &file.name, file.text.as_slice());
        }
        let mut options = programs
            .get(place)
            .map_or_else(Options::default, |it| it.options.clone());
        options.reading.shelf = Some(Arc::new(shelf));
        options.reading.text = place as u16;
        options
    }
}

/// Why a set came to no result.
#[derive(Debug)]
pub struct SetFailure {
    /// The program at fault, if it is one.
    pub program: Option<usize>,
    /// What is wrong.
    pub failure: Failure,
}

impl From<Failure> for SetFailure {
    fn from(failure: Failure) -> Self {
        Self {
            program: None,
            failure,
        }
    }
}

impl SetFailure {
    /// Names the program at fault.
    pub(super) fn of(program: usize) -> impl FnOnce(Failure) -> Self {
        move |failure| Self {
            program: Some(program),
            failure,
        }
    }
}
