//! Which files a set consists of.

use std::collections::BTreeSet;
use std::fs;
use std::io::Cursor;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::{SetFailure, SetProgram};
use crate::diagnostic::Diagnostic;
use crate::interpret::Shelf;
use crate::machine::Machine;
use crate::pipeline::executor::Executor;
use crate::pipeline::{Failure, LineCount, Options};

/// The files of a set.
pub(super) struct Found {
    /// All of them, the programs first.
    pub(super) shelf: Arc<Shelf>,
    /// The numbers of those that each program calls.
    pub(super) called: Vec<BTreeSet<usize>>,
}

/// Runs through all programs, and reads the files that they call.
pub(super) fn discover(
    programs: &[SetProgram],
    machine: &Machine,
    ways: &[Vec<Options>],
) -> Result<Found, SetFailure> {
    let mut shelf = Shelf::default();
    for program in programs {
        if shelf.holds(&program.path) {
            let message = format!("{} is given twice", program.name);
            return Err(Failure::Unsuitable(message).into());
        }
        shelf.put(&program.path, &program.name, Arc::clone(&program.text));
    }
    let counts = || programs.iter().filter_map(|it| it.options.count.as_ref());
    counts().for_each(LineCount::begin);
    let mut called = Vec::with_capacity(programs.len());
    for (place, (program, ways)) in programs.iter().zip(ways).enumerate() {
        let mut own = BTreeSet::new();
        for options in ways {
            let paths = files_of(&program.text, machine, options);
            for path in paths.map_err(SetFailure::of(place))? {
                put(&mut shelf, &path).map_err(SetFailure::of(place))?;
                own.extend(shelf.number(&path));
            }
        }
        called.push(own);
    }
    if shelf.files().count() > Shelf::FILES_MAX {
        let message = format!("there are more than {} files", Shelf::FILES_MAX);
        return Err(Failure::Unsuitable(message).into());
    }
    counts().for_each(LineCount::first_pass_ends);
    Ok(Found {
        shelf: Arc::new(shelf),
        called,
    })
}

/// The files that a program calls.
fn files_of(text: &[u8], machine: &Machine, options: &Options) -> Result<Vec<PathBuf>, Failure> {
    let mut front = Executor::new(Cursor::new(text), machine, options);
    while front.next_line()?.is_some() {}
    let paths = front.paths().to_vec();
    front.finish()?;
    Ok(paths)
}

fn put(shelf: &mut Shelf, path: &Path) -> Result<(), Failure> {
    if shelf.holds(path) {
        return Ok(());
    }
    let name = path.display().to_string();
    let text = fs::read(path).map_err(|error| Failure::Refused {
        diagnostics: vec![Diagnostic::error(
            "no-such-subprogram",
            format!("the subprogram file {name} cannot be read: {error}"),
        )],
        more: 0,
    })?;
    shelf.put(path, &name, text);
    Ok(())
}

impl Found {
    /// Whether some program calls the one of that number.
    pub(super) fn calls(&self, number: usize) -> bool {
        self.called.iter().any(|called| called.contains(&number))
    }
}
