//! `gwatt report`.

use std::path::Path;
use std::slice;

use anyhow::Result;
use gwatt::pipeline::{self, RowSink};
use gwatt::report::{Checked, Verdict, check_text, report_json};

use super::clash::refuse_clashes;
use super::dialect;
use super::input::Program;
use super::output::Target;
use super::page::{self, Pictures};
use super::rows::Rows;
use super::series::{self, Refused};
use super::setup::{Setup, machine_file};
use super::terminal::Terminal;
use crate::cli::ReportArgs;

/// Says what each move of a program draws.
pub fn run(args: &ReportArgs, terminal: Terminal) -> Result<Verdict> {
    let mut program = Program::new(&args.program);
    let pictures = Pictures {
        html: args.html.as_deref(),
        svg: args.svg.as_deref(),
    };
    let machine = machine_file(args.machine.machine.as_deref());
    let inputs: Vec<&Path> = program
        .path()
        .into_iter()
        .chain(machine)
        .chain(args.limited.as_deref())
        .collect();
    let outputs: Vec<&Path> = args
        .csv
        .iter()
        .chain(&args.json)
        .chain(&args.series)
        .map(AsRef::as_ref)
        .chain(pictures.paths())
        .collect();
    refuse_clashes(&inputs, &outputs)?;
    let mut setup = Setup::new(&args.machine, &args.reading, terminal)?;
    if args.series.is_some() {
        setup.one_way("--series shows")?;
    }
    pictures.check(&setup)?;
    dialect::settle(&mut setup, slice::from_mut(&mut program), terminal)?;
    if let Some(overrides) = args.overrides {
        overrides.apply(&mut setup.machine.limits);
    }
    let csv = match &args.csv {
        Some(path) => Some(Target::new(path)?),
        None if args.json.is_none() && args.series.is_none() && !pictures.is_any() => {
            Some(Target::Stdout)
        }
        None => None,
    };
    let mut rows = Rows::new(csv, args.json.as_deref())?.with_page(pictures.is_any());
    let mut frames = pictures.open()?;

    // It is read more than once: what `limit` would do is looked up in it.
    if let Err(failure) = program.keep() {
        dialect::failure(&setup, &program, &failure, terminal);
        return Ok(Verdict::Refused);
    }
    let outcome = program.open().and_then(|mut input| {
        let sink = rows.sink().map(|rows| rows as &mut dyn RowSink);
        let options = setup.options_for(&program);
        let mut summary = pipeline::analyze(&mut input, &setup.machine, &options, sink)?;
        pipeline::take_hints(input, &setup.machine, &options, &mut summary)?;
        Ok(summary)
    });
    let summary = match outcome {
        Ok(summary) => summary,
        Err(failure) => {
            dialect::failure(&setup, &program, &failure, terminal);
            return Ok(Verdict::Refused);
        }
    };
    let series = match series::write(args, &program, &setup, terminal) {
        Ok(series) => series,
        Err(Refused::Told) => return Ok(Verdict::Refused),
        Err(Refused::Error(error)) => return Err(error),
    };
    if let Some(drawn) = rows.page.take() {
        let machine = &setup.machine;
        match page::draw_report(&mut frames, &program, &setup, machine, &summary, &drawn) {
            Ok(()) => {}
            Err(page::Refused::Error(error)) => return Err(error),
            Err(page::Refused::Program(failure)) => {
                dialect::failure(&setup, &program, &failure, terminal);
                return Ok(Verdict::Refused);
            }
        }
    }
    rows.deliver(|blocks, out| {
        report_json(&program.name, &setup.machine.name, &summary, blocks, out)
    })?;
    if let Some(series) = series {
        series.deliver()?;
    }
    frames.deliver()?;
    terminal.diagnostics(&program.name, &summary.notes);
    let checked = Checked {
        program: program.name,
        outcome: Ok(summary),
    };
    terminal.text(&check_text(&checked, &setup.machine));
    let verdict = checked.verdict();
    Ok(if args.fail { verdict } else { Verdict::Fits })
}
