//! A program's figures, and its moves.

use std::io::{Read, Seek};

use super::advice::Adviser;
use super::conditions::conditions;
use super::front::Front;
use super::tally::Tally;
use super::{Certificate, Failure, Options, RowSink, Summary};
use crate::diagnostic::Diagnostic;
use crate::interpret::{Move, Step};
use crate::machine::Machine;
use crate::power::{Assessment, Assessor, Want};

/// Reads a program and gives its figures; with `rows`, every move too.
///
/// # Errors
/// See [`Failure`].
pub fn analyze<R: Read + Seek + Send>(
    input: R,
    machine: &Machine,
    options: &Options,
    rows: Option<&mut dyn RowSink>,
) -> Result<Summary, Failure> {
    let mut front = Front::new(input, machine, options);
    let mut assessor = Assessor::new(machine, options.certificate, Want::ALL)
        .starting(options.reading.start)
        .watching();
    let energy = rows.is_some();
    let mut tally = Tally::new(machine, options, rows);
    let adviser = Adviser::new(machine);
    while let Some(line) = front.next_line()? {
        tally.learn_files(line.files);
        assessor.want = wanted(&tally);
        for step in &*line.steps {
            let mut sink = |mv: &Move, assessment: &Assessment, text: &[u8]| {
                let help = || adviser.help(mv, assessment, line.interpreter);
                tally.take(mv, assessment, text, help);
            };
            match step {
                Step::Move(mv) => assessor.push(mv, line.text_of(mv), &mut sink),
                Step::Action(action) => assessor.act(action, &mut sink),
            }
            assessor.want = wanted(&tally);
        }
        tally.check()?;
    }
    let interpreter = front.interpreter();
    assessor.finish(&mut |mv, assessment, text| {
        tally.take(mv, assessment, text, || {
            adviser.help(mv, assessment, interpreter)
        });
    });
    tally.check()?;
    let lines = front.lines;
    let notes = front.finish()?;
    refuse_planned(&assessor, machine)?;
    tally.rate(assessor.ratings());
    let mut summary = tally.finish(energy);
    summary.lines = lines;
    summary.notes = notes;
    summary.conditions = conditions(machine, options, &summary);
    Ok(summary)
}

/// Reads a program and hands over every commanded move with its duration in s
/// (`None` where it cannot be known: the start is not).
///
/// # Errors
/// See [`Failure`]; an error of `each` becomes [`Failure::Output`].
pub fn moves<R: Read + Seek + Send>(
    input: R,
    machine: &Machine,
    options: &Options,
    each: &mut dyn FnMut(&Move, Option<f64>) -> std::io::Result<()>,
) -> Result<Vec<Diagnostic>, Failure> {
    let mut front = Front::new(input, machine, options);
    let assessor = Assessor::new(machine, None, Want::PEAKS);
    while let Some(line) = front.next_line()? {
        for step in &*line.steps {
            if let Step::Move(mv) = step {
                let seconds = crate::plan::plan(machine, mv, assessor.nominal).duration_s;
                let known = mv.unknown_start.is_empty();
                each(mv, known.then_some(seconds)).map_err(Failure::Output)?;
            }
        }
    }
    front.finish()
}

/// What is wanted of the next move.
fn wanted(tally: &Tally<'_, '_>) -> Want {
    let want = tally.want();
    Want {
        accel: want.energy,
        ..want
    }
}

/// The planned certificate cannot be given for moves that are blended by rules
/// that are not modelled.
pub(super) fn refuse_planned(assessor: &Assessor<'_>, machine: &Machine) -> Result<(), Failure> {
    if !assessor.needs_robust || assessor.requested() != Some(Certificate::Planned) {
        return Ok(());
    }
    Err(Failure::Unsuitable(format!(
        "the program blends moves, and how the controller `{}` does that is not modelled: \
         use --certificate robust, or path.mode = \"exact-stop\" if the machine stops at every block",
        machine.controller.name
    )))
}
