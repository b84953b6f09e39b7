//! `gwatt check`.

use std::io::{self, Write};
use std::path::Path;

use anyhow::{Result, ensure};
use gwatt::report::{self, Checked, Totals, Verdict};

use super::baselines::Baselines;
use super::clash::refuse_clashes;
use super::found::{Found, Wanted, check_program};
use super::in_order::in_order;
use super::input::Program;
use super::listing::Listing;
use super::output::print;
use super::page::{self, Pictures};
use super::progress::{Meter, Progress};
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
    let mut baselines = Baselines::new(args, &programs)?;
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
        figures: args.format == Format::Jsonl,
        changes: args.format == Format::Sarif,
    };
    let (_progress, one_done) = progress(&mut programs, terminal, args.quiet);
    let check = |program: &Program| check_program(program, &setup, wanted);

    let mut totals = Totals::default();
    let mut kept = Vec::new();
    in_order(&programs, at_once, check, |result| {
        let Found {
            mut checked,
            note,
            drawn,
        } = result;
        if let Some(meter) = &one_done {
            meter.add(1);
        }
        baselines.take(&mut checked);
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
            show(&checked, terminal);
        }
        match args.format {
            Format::Text if shown => {
                let text = report::check_text(&checked, &setup.machine, terminal.out_style());
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
    print(|out| write_all(&kept, args, &setup, out))?;
    if totals.worst() != Verdict::Refused {
        frames.deliver()?;
    }
    baselines.finish(totals.worst(), terminal)
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

/// What is read of the one program, or how many are done, which the meter is for.
fn progress(
    programs: &mut [Program],
    terminal: Terminal,
    quiet: bool,
) -> (Progress, Option<Meter>) {
    let shape = terminal.progress(quiet);
    if let [program] = programs {
        return (program.progress(shape, 1), None);
    }
    let progress = Progress::of_programs(shape, programs.len());
    let meter = progress.meter();
    (progress, Some(meter))
}

/// Warnings and refusals, with the lines under them.
fn show(checked: &Checked, terminal: Terminal) {
    match &checked.outcome {
        Ok(summary) => terminal.diagnostics(&checked.program, &summary.notes),
        Err(failure) => terminal.failure(&checked.program, failure),
    }
}

fn write_all(
    checked: &[Checked],
    args: &CheckArgs,
    setup: &Setup,
    out: &mut dyn Write,
) -> io::Result<()> {
    match args.format {
        Format::Text | Format::Jsonl => Ok(()),
        Format::Json => report::check_json(checked, &setup.machine.name, out),
        Format::Sarif => report::sarif(checked, args.rules_url.as_deref(), out),
        Format::Junit => report::junit(checked, &setup.machine, out),
        Format::Github => report::github(checked, out),
    }
}
