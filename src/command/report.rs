//! `gwatt report`.

use std::path::Path;
use std::slice;

use anyhow::{Result, bail, ensure};
use gwatt::pipeline::{self, RowSink};
use gwatt::report::{Checked, Verdict, check_text, report_json};

use super::clash::refuse_clashes;
use super::dialect;
use super::input::Program;
use super::listing::Listing;
use super::many::{OfMany, each_by_itself};
use super::output::Target;
use super::page;
use super::places::Places;
use super::rows::Rows;
use super::series::{self, Refused};
use super::settings::Settings;
use super::setup::{Setup, machine_file};
use super::terminal::{Messages, Terminal};
use crate::cli::ReportArgs;

/// Says what each move of programs draws.
pub fn run(args: &ReportArgs, terminal: Terminal) -> Result<Verdict> {
    let listing = Listing::of(&args.programs, terminal)?;
    let mut programs = listing.programs();
    let mut args = args.clone();
    let settings = Settings::of(&programs, terminal)?;
    settings.fill(&mut args.machine, &mut args.reading)?;
    if args.series.is_some() {
        settings.allow(&mut args.allow);
    }
    let args = &args;
    if listing.is_many {
        return report_each(args, &listing, terminal);
    }
    let [program] = programs.as_mut_slice() else {
        bail!("there is no program");
    };
    let places = places(args);
    let machine = machine_file(args.machine.machine.as_deref());
    let inputs: Vec<&Path> = program
        .path()
        .into_iter()
        .chain(machine)
        .chain(args.limited.as_deref())
        .collect();
    let outputs: Vec<&Path> = places.paths().chain(args.series.as_deref()).collect();
    refuse_clashes(&inputs, &outputs)?;
    let mut setup = setup(args, terminal)?;
    // It is read more than once: what `limit` would do is looked up in it.
    dialect::settle(&mut setup, slice::from_mut(program), terminal)?;
    let mut messages = terminal.direct();
    let pictures = usize::from(places.pictures().is_any());
    let _progress = program.progress(terminal.progress(args.quiet), 1 + 2 * pictures as u64);
    let done = report_one(args, &setup, program, &places, &mut messages)?;
    Ok(match done.unwrap_or(Verdict::Fits) {
        Verdict::DoesNotFit if !args.fail => Verdict::Fits,
        verdict => verdict,
    })
}

/// The same of several programs, into folders.
fn report_each(args: &ReportArgs, listing: &Listing, terminal: Terminal) -> Result<Verdict> {
    ensure!(
        args.series.is_none(),
        "--series shows one program: give one at a time"
    );
    let places = places(args);
    ensure!(
        places.paths().next().is_some(),
        "several programs: give a folder for their reports by -o"
    );
    let machine = machine_file(args.machine.machine.as_deref());
    let places = places.of_each(listing, machine)?;
    let setup = setup(args, terminal)?;
    let how = OfMany {
        quiet: args.quiet,
        at_once: usize::MAX,
    };
    let worst = each_by_itself(listing.programs(), places, setup, how, terminal, |it| {
        report_one(args, it.setup, it.program, it.places, it.messages)
    })?;
    Ok(match worst {
        Verdict::DoesNotFit if !args.fail => Verdict::Fits,
        worst => worst,
    })
}

fn setup(args: &ReportArgs, terminal: Terminal) -> Result<Setup> {
    let mut setup = Setup::new(&args.machine, &args.reading, terminal)?;
    if args.series.is_some() {
        setup.one_way("--series shows")?;
    }
    if let Some(overrides) = args.overrides {
        overrides.apply(&mut setup.machine.limits);
    }
    Ok(setup)
}

fn places(args: &ReportArgs) -> Places {
    Places {
        program: None,
        csv: args.csv.clone(),
        json: args.json.clone(),
        html: args.html.clone(),
        svg: args.svg.clone(),
    }
}

/// Reports one program; `None` where it holds only subprograms.
fn report_one(
    args: &ReportArgs,
    setup: &Setup,
    program: &Program,
    places: &Places,
    messages: &mut Messages,
) -> Result<Option<Verdict>> {
    let pictures = places.pictures();
    pictures.check(setup)?;
    let csv = match &places.csv {
        Some(path) => Some(Target::new(path)?),
        None if places.json.is_none() && args.series.is_none() && !pictures.is_any() => {
            Some(Target::Stdout)
        }
        None => None,
    };
    let mut rows = Rows::new(csv, places.json.as_deref())?.with_page(pictures.is_any());
    let mut frames = pictures.open()?;
    let outcome = program.open().and_then(|mut input| {
        let sink = rows.sink().map(|rows| rows as &mut dyn RowSink);
        let options = setup.options_for(program);
        let mut summary = pipeline::analyze(&mut input, &setup.machine, &options, sink)?;
        pipeline::take_hints(input, &setup.machine, &options, &mut summary)?;
        Ok(summary)
    });
    let summary = match outcome {
        Ok(summary) => summary,
        Err(failure) => {
            dialect::failure(setup, program, &failure, messages);
            return Ok(Some(Verdict::Refused));
        }
    };
    let series = match series::write(args, program, setup, messages) {
        Ok(series) => series,
        Err(Refused::Reported) => return Ok(Some(Verdict::Refused)),
        Err(Refused::Error(error)) => return Err(error),
    };
    if let Some(drawn) = rows.page.take() {
        let machine = &setup.machine;
        match page::draw_report(&mut frames, program, setup, machine, &summary, &drawn) {
            Ok(()) => {}
            Err(page::Refused::Error(error)) => return Err(error),
            Err(page::Refused::Program(failure)) => {
                dialect::failure(setup, program, &failure, messages);
                return Ok(Some(Verdict::Refused));
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
    messages.diagnostics(&program.name, &summary.notes);
    let checked = Checked {
        program: program.name.clone(),
        outcome: Ok(summary),
        changes: None,
        held: None,
    };
    let style = messages.style();
    messages.text(&check_text(&checked, &setup.machine, style));
    Ok(checked.counted())
}
