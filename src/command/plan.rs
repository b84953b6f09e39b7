//! `gwatt plan`.

use std::io::{self, BufWriter};
use std::path::Path;
use std::slice;

use anyhow::Result;
use gwatt::machine::Machine;
use gwatt::pipeline::{DriveSchedule, DrivesSummary, Failure, run_drives};
use gwatt::report::{DriveRows, Verdict, drives_text};

use super::clash::refuse_clashes;
use super::input::Program;
use super::output::Target;
use super::schedule_file::read_schedule;
use super::settings::Settings;
use super::setup::{load_machine, machine_file, machine_name};
use super::terminal::Terminal;
use crate::cli::PlanArgs;

/// Period up to which a peak between its ends is not worth a note, ms.
const FINE_MS: f64 = 2.0;

/// Runs drives through a schedule.
pub fn run(args: &PlanArgs, terminal: Terminal) -> Result<Verdict> {
    let input = Program::new(&args.schedule);
    let mut given = args.machine.clone();
    Settings::of(slice::from_ref(&input), terminal)?.fill_machine(&mut given);
    let machine = machine_file(given.machine.as_deref());
    let inputs: Vec<&Path> = input.path().into_iter().chain(machine).collect();
    let csv = args.output.as_deref().unwrap_or(Path::new("-"));
    refuse_clashes(&inputs, &[csv])?;
    let name = machine_name(&given, terminal);
    let machine = load_machine(name, terminal)?;
    let schedule = match DriveSchedule::parse(&read_schedule(&input, terminal)?, &machine) {
        Ok(schedule) => schedule,
        Err(errors) => {
            terminal.diagnostics(&input.name, &errors);
            return Ok(Verdict::Refused);
        }
    };
    let period_s = args.period_ms * 1e-3;
    let mut rows = DriveRows::new(BufWriter::new(Target::new(csv)?.spool()?));
    let outcome = run_drives(&machine, &schedule, period_s, true, &mut |sample| {
        rows.row(&machine, sample)
    });
    let summary = match outcome {
        Ok(summary) => summary,
        Err(failure) => {
            terminal.failure(&input.name, &failure);
            return Ok(Verdict::Refused);
        }
    };
    if args.period_ms > FINE_MS {
        terminal.note(format_args!(
            "peaks are those at the ends of periods, which are {} ms apart; between them the \
             supply is held too",
            args.period_ms
        ));
    }
    let alone = alone(&machine, &schedule, period_s).ok();
    let rows = rows.finish()?;
    let rows = rows.into_inner().map_err(io::IntoInnerError::into_error)?;
    terminal.diagnostics(&input.name, &summary.notes);
    let text = drives_text(&input.name, &machine, &schedule, &summary, alone.as_ref());
    terminal.text(&text);
    rows.deliver()?;
    Ok(match summary.exceeded_s {
        None => Verdict::Fits,
        Some(_) => Verdict::DoesNotFit,
    })
}

/// The same without a supply that is shared.
fn alone(
    machine: &Machine,
    schedule: &DriveSchedule,
    period_s: f64,
) -> Result<DrivesSummary, Failure> {
    run_drives(machine, schedule, period_s, false, &mut |_| Ok(()))
}
