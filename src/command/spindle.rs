//! `gwatt spindle`.

use std::io::{self, BufWriter};
use std::path::Path;
use std::slice;

use anyhow::{Context, Result, bail};
use gwatt::machine::Spindle;
use gwatt::pipeline::{Schedule, run_schedule};
use gwatt::plan::SpindleDrive;
use gwatt::power::SpindlePower;
use gwatt::report::{SpindleChart, SpindleRows, Verdict, spindle_text};

use super::clash::refuse_clashes;
use super::input::Program;
use super::output::Target;
use super::schedule_file::read_schedule;
use super::settings::Settings;
use super::setup::{load_machine, machine_file, machine_name};
use super::terminal::Terminal;
use crate::cli::SpindleArgs;

/// Runs a spindle through a schedule.
pub fn run(args: &SpindleArgs, terminal: Terminal) -> Result<Verdict> {
    let input = Program::new(&args.schedule);
    let mut given = args.machine.clone();
    Settings::of(slice::from_ref(&input), terminal)?.fill_machine(&mut given);
    let machine = machine_file(given.machine.as_deref());
    let inputs: Vec<&Path> = input.path().into_iter().chain(machine).collect();
    let stdout = Path::new("-");
    let csv = args.output.as_deref().unwrap_or(stdout);
    let outputs: Vec<&Path> = [Some(csv), args.svg.as_deref()]
        .into_iter()
        .flatten()
        .collect();
    refuse_clashes(&inputs, &outputs)?;
    let name = machine_name(&given, terminal);
    let machine = load_machine(name, terminal)?;
    let Some(spindle) = &machine.spindle else {
        bail!(
            "{name}: the machine has no [spindle]: describe it with inertia_kg_m2, max_rpm and accel_time_s or torque_curve"
        );
    };
    let drive = SpindleDrive::new(spindle).with_context(|| format!("{name}: [spindle]"))?;
    follow(spindle, &drive, name, terminal);

    let schedule = match Schedule::parse(&read_schedule(&input, terminal)?, &drive) {
        Ok(schedule) => schedule,
        Err(errors) => {
            terminal.diagnostics(&input.name, &errors);
            return Ok(Verdict::Refused);
        }
    };
    let mut rows = SpindleRows::new(BufWriter::new(Target::new(csv)?.spool()?))?;
    let svg = args.svg.as_deref().map(Target::new).transpose()?;
    let svg = svg.map(Target::spool).transpose()?;
    let mut chart = svg.is_some().then(SpindleChart::default);

    let power = SpindlePower::new(spindle);
    let outcome = run_schedule(
        &schedule,
        &drive,
        &power,
        args.period_ms * 1e-3,
        &mut |sample| {
            if let Some(chart) = &mut chart {
                chart.add(sample);
            }
            rows.row(sample)
        },
    );
    let summary = match outcome {
        Ok(summary) => summary,
        Err(failure) => {
            terminal.failure(&input.name, &failure);
            return Ok(Verdict::Refused);
        }
    };
    let rows = rows.finish()?;
    let rows = rows.into_inner().map_err(io::IntoInnerError::into_error)?;
    let picture = match (svg, chart) {
        (Some(spool), Some(chart)) => {
            let mut out = BufWriter::new(spool);
            chart.write(&mut out)?;
            Some(out.into_inner().map_err(io::IntoInnerError::into_error)?)
        }
        _ => None,
    };
    terminal.diagnostics(&input.name, &summary.notes);
    terminal.text(&spindle_text(&input.name, &summary));
    if let Some(picture) = picture {
        picture.deliver()?;
    }
    rows.deliver()?;
    Ok(Verdict::Fits)
}

/// Warns where the jerk limit cannot follow the acceleration limit.
fn follow(spindle: &Spindle, drive: &SpindleDrive, name: &str, terminal: Terminal) {
    if let Some(needed) = drive.missing_jerk() {
        let jerk = drive.limits().jerk.smallest();
        terminal.note(format_args!(
            "{name}: [spindle]: the acceleration limit falls faster than a jerk of {jerk:.0} 1/min/s² \
             can follow, which would have to be {needed:.0}: the acceleration stays below it; \
             shorten `jerk_time_s` = {}",
            spindle.jerk_time_s
        ));
    }
}
