//! `gwatt check`.

use std::io::{self, Write};
use std::path::Path;

use anyhow::{Result, ensure};
use gwatt::machine::Machine;
use gwatt::pipeline::{self, Row, RowSink};
use gwatt::report::{self, Checked, PageRows, Totals, Verdict};

use super::clash::refuse_clashes;
use super::dialect;
use super::in_order::in_order;
use super::input::Program;
use super::listing::Listing;
use super::output::print;
use super::page::{self, Pictures};
use super::settings::Settings;
use super::setup::{Setup, machine_file, share_threads};
use super::terminal::Terminal;
use crate::cli::{CheckArgs, Format};

/// Says whether programs fit.
pub fn run(args: &CheckArgs, terminal: Terminal) -> Result<Verdict> {
    let listing = Listing::of(&args.programs, terminal)?;
    let mut programs = listing.programs();
    let mut args = args.clone();
    Settings::of(&programs, terminal)?.fill(&mut args.machine, &mut args.reading)?;
    let args = &args;
    let pictures = pictures(args, &programs)?;
    let mut setup = Setup::new(&args.machine, &args.reading, terminal)?;
    if let Some(overrides) = args.overrides {
        overrides.apply(&mut setup.machine.limits);
    }
    let (at_once, each) = share_threads(setup.options.threads, programs.len());
    setup.options.threads = each;
    for program in &mut programs {
        if let Err(failure) = program.keep() {
            terminal.failure(&program.name, &failure);
            return Ok(Verdict::Refused);
        }
    }
    pictures.check(&setup)?;
    let mut frames = pictures.open()?;
    let wanted = Wanted {
        page: pictures.is_any(),
        energy: args.format == Format::Jsonl,
    };
    let check = |program: &Program| check_program(program, &setup, wanted);

    let mut totals = Totals::default();
    let mut kept = Vec::new();
    in_order(&programs, at_once, check, |result| {
        let Found {
            checked,
            note,
            drawn,
        } = result;
        if let (Some((rows, machine)), Ok(summary)) = (drawn, &checked.outcome)
            && let [program] = programs.as_slice()
        {
            let drawn = page::draw_report(&mut frames, program, &setup, &machine, summary, &rows);
            drawn.map_err(page::Refused::into_error)?;
        }
        totals.count(checked.counted());
        let shown = !(args.quiet && checked.verdict() == Verdict::Fits);
        if shown {
            if let Some(note) = note {
                terminal.note(format_args!("{}: {note}", checked.program));
            }
            tell(&checked, terminal);
        }
        match args.format {
            Format::Text if shown => {
                let text = report::check_text(&checked, &setup.machine);
                print(|out| out.write_all(text.as_bytes()))?;
            }
            Format::Text => {}
            Format::Jsonl => {
                print(|out| report::check_json_line(&checked, &setup.machine.name, out))?;
            }
            _ => kept.push(checked),
        }
        Ok(())
    })?;
    if args.format == Format::Text && listing.is_many {
        print(|out| writeln!(out, "{totals}"))?;
    }
    print(|out| write_all(&kept, args.format, &setup, out))?;
    if totals.worst() != Verdict::Refused {
        frames.deliver()?;
    }
    Ok(totals.worst())
}

/// The page that is asked for: it shows one program.
fn pictures<'a>(args: &'a CheckArgs, programs: &[Program]) -> Result<Pictures<'a>> {
    let pictures = Pictures {
        html: args.html.as_deref(),
        svg: None,
    };
    if !pictures.is_any() {
        return Ok(pictures);
    }
    ensure!(
        programs.len() == 1,
        "--html shows one program: give one, or a page to each"
    );
    let machine = machine_file(args.machine.machine.as_deref());
    let inputs: Vec<&Path> = programs
        .iter()
        .filter_map(Program::path)
        .chain(machine)
        .collect();
    // The verdict goes to standard output.
    let outputs: Vec<&Path> = pictures.paths().chain([Path::new("-")]).collect();
    refuse_clashes(&inputs, &outputs)?;
    Ok(pictures)
}

/// What came of a program.
struct Found {
    checked: Checked,
    /// What is to be said before it: as which dialect it was read, or which would read it.
    note: Option<String>,
    /// What a page shows of it, and the machine with the dialect that it was read as.
    drawn: Option<(PageRows, Machine)>,
}

/// What is wanted of a program besides the verdict.
#[derive(Debug, Clone, Copy)]
struct Wanted {
    /// What a page shows of it.
    page: bool,
    /// The energy that it takes.
    energy: bool,
}

/// Rows of which only the sum counts.
struct Summed;

impl RowSink for Summed {
    fn row(&mut self, _: &Row) -> io::Result<()> {
        Ok(())
    }
}

/// Checks a program.
fn check_program(program: &Program, setup: &Setup, wanted: Wanted) -> Found {
    let found = |outcome, note, drawn| Found {
        checked: Checked {
            program: program.name.clone(),
            outcome,
        },
        note,
        drawn,
    };
    let mut rows = wanted.page.then(PageRows::default);
    let mut summed = wanted.energy.then_some(Summed);
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
        let drawn = rows.map(|rows| (rows, machine));
        return found(outcome, Some(note), drawn);
    }
    let outcome = analyze(&setup.machine);
    let hint = outcome.as_ref().err();
    let hint = hint.and_then(|failure| dialect::hint(setup, program, failure));
    found(
        outcome,
        hint,
        rows.map(|rows| (rows, setup.machine.clone())),
    )
}

/// Warnings and refusals, with the lines under them.
fn tell(checked: &Checked, terminal: Terminal) {
    match &checked.outcome {
        Ok(summary) => terminal.diagnostics(&checked.program, &summary.notes),
        Err(failure) => terminal.failure(&checked.program, failure),
    }
}

fn write_all(
    checked: &[Checked],
    format: Format,
    setup: &Setup,
    out: &mut dyn Write,
) -> io::Result<()> {
    match format {
        Format::Text | Format::Jsonl => Ok(()),
        Format::Json => report::check_json(checked, &setup.machine.name, out),
        Format::Sarif => report::sarif(checked, out),
        Format::Junit => report::junit(checked, &setup.machine, out),
        Format::Github => report::github(checked, out),
    }
}
