//! What `check` finds about a program.

use std::io::{self, Read};

use gwatt::machine::Machine;
use gwatt::pipeline::{self, Failure, Row, RowSink, Summary};
use gwatt::report::{self, Changes, Checked, PageRows};

use super::dialect;
use super::input::Program;
use super::setup::Setup;

/// What came of a program.
pub struct Found {
    pub checked: Checked,
    /// What is to be said before it: as which dialect it was read, or which would read it.
    pub note: Option<String>,
    /// What a page shows of it, and the machine with the dialect that it was read as.
    pub drawn: Option<(PageRows, Machine)>,
}

impl Found {
    fn with(mut self, changes: Option<Changes>) -> Self {
        self.checked.changes = changes;
        self
    }
}

/// What is wanted of a program besides the verdict.
#[derive(Debug, Clone, Copy)]
pub struct Wanted {
    /// What a page shows of it.
    pub page: bool,
    /// Exact figures of all moves, and the energy that they take.
    pub figures: bool,
    /// What makes it fit.
    pub changes: bool,
}

/// Rows of which only the sum counts.
struct Summed;

impl RowSink for Summed {
    fn row(&mut self, _: &Row) -> io::Result<()> {
        Ok(())
    }
}

/// Checks a program.
pub fn check_program(program: &Program, setup: &Setup, wanted: Wanted) -> Found {
    let found = |outcome, note, drawn| Found {
        checked: Checked {
            program: program.name.clone(),
            outcome,
            changes: None,
            held: None,
        },
        note,
        drawn,
    };
    let mut rows = wanted.page.then(PageRows::default);
    let mut summed = wanted.figures.then_some(Summed);
    let mut analyze = |machine: &Machine| {
        let options = setup.options_for(program);
        let mut input = program.open()?;
        let summed = summed.as_mut().map(|rows| rows as &mut dyn RowSink);
        let sink = rows
            .as_mut()
            .map(|rows| rows as &mut dyn RowSink)
            .or(summed);
        let mut summary = pipeline::analyze(&mut input, machine, &options, sink)?;
        pipeline::take_hints(input, machine, &options, &mut summary)?;
        Ok(summary)
    };
    if setup.auto {
        let (language, note) = match dialect::choose(setup, program) {
            Ok(chosen) => chosen,
            Err(failure) => return found(Err(failure), None, None),
        };
        let mut machine = setup.machine.clone();
        machine.controller.language = language;
        let outcome = analyze(&machine);
        let changes = wanted
            .changes
            .then(|| changes(program, setup, &machine, &outcome));
        let drawn = rows.map(|rows| (rows, machine));
        return found(outcome, Some(note), drawn).with(changes.flatten());
    }
    let outcome = analyze(&setup.machine);
    let changes = wanted
        .changes
        .then(|| changes(program, setup, &setup.machine, &outcome));
    let hint = outcome.as_ref().err();
    let hint = hint.and_then(|failure| dialect::hint(setup, program, failure));
    found(
        outcome,
        hint,
        rows.map(|rows| (rows, setup.machine.clone())),
    )
    .with(changes.flatten())
}

/// The largest program for which changes are given, as it is held twice, in bytes.
const CHANGED_BYTES_MAX: u64 = 16 << 20;

/// What makes a program fit, if that is known.
fn changes(
    program: &Program,
    setup: &Setup,
    machine: &Machine,
    outcome: &Result<Summary, Failure>,
) -> Option<Changes> {
    let unfit = outcome
        .as_ref()
        .is_ok_and(|summary| summary.unfit_count > 0);
    if !unfit || program.bytes() > CHANGED_BYTES_MAX {
        return None;
    }
    let options = setup.options_for(program);
    let input = program.open().ok()?;
    // Whatever is wrong about it has been said by the check.
    let (new, expand) = pipeline::as_advised(input, machine, &options).ok()??;
    let mut old = Vec::new();
    program.open().ok()?.read_to_end(&mut old).ok()?;
    let edits = report::line_edits(&old, &new).filter(|edits| !edits.is_empty())?;
    Some(Changes {
        command: if expand {
            "gwatt limit --allow feed,expand"
        } else {
            "gwatt limit --allow feed"
        },
        edits,
    })
}
