//! `gwatt check`.

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::mpsc;
use std::thread;

use anyhow::{Context, Result, ensure};
use gwatt::machine::Machine;
use gwatt::pipeline::{self, RowSink};
use gwatt::report::{self, Checked, PageRows, Verdict};
use rayon::iter::{ParallelBridge, ParallelIterator};

use super::clash::refuse_clashes;
use super::dialect;
use super::input::Program;
use super::output::print;
use super::page::{self, Pictures};
use super::setup::{Setup, machine_file, share_threads};
use super::terminal::Terminal;
use crate::cli::{CheckArgs, Format};

/// Says whether programs fit.
pub fn run(args: &CheckArgs, terminal: Terminal) -> Result<Verdict> {
    let mut programs = Program::list(&args.programs)?;
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
    let check = |program: &Program| check_program(program, &setup, pictures.is_any());

    let mut worst = Verdict::Fits;
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
        worst = worst.max(checked.verdict());
        if let Some(note) = note {
            terminal.note(format_args!("{}: {note}", checked.program));
        }
        tell(&checked, terminal);
        if args.format == Format::Text {
            let text = report::check_text(&checked, &setup.machine);
            return print(|out| out.write_all(text.as_bytes()));
        }
        kept.push(checked);
        Ok(())
    })?;
    print(|out| write_all(&kept, args.format, &setup, out))?;
    if worst != Verdict::Refused {
        frames.deliver()?;
    }
    Ok(worst)
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

/// Checks a program; `draws` is whether a page is asked for.
fn check_program(program: &Program, setup: &Setup, draws: bool) -> Found {
    let found = |outcome, note, drawn| Found {
        checked: Checked {
            program: program.name.clone(),
            outcome,
        },
        note,
        drawn,
    };
    let mut rows = draws.then(PageRows::default);
    let mut analyze = |machine: &Machine| {
        let options = setup.options_for(program);
        let mut input = program.open()?;
        let sink = rows.as_mut().map(|rows| rows as &mut dyn RowSink);
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
        Format::Text => Ok(()),
        Format::Json => report::check_json(checked, &setup.machine.name, out),
        Format::Sarif => report::sarif(checked, out),
        Format::Junit => report::junit(checked, &setup.machine, out),
        Format::Github => report::github(checked, out),
    }
}

/// Does `work` for all `items`, so many at once, and hands the results over in
/// the order of the items as soon as each one's turn comes.
pub fn in_order<I: Sync, O: Send>(
    items: &[I],
    at_once: usize,
    work: impl Fn(&I) -> O + Sync,
    mut each: impl FnMut(O) -> Result<()>,
) -> Result<()> {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(at_once)
        .build()
        .context("cannot start threads")?;
    // Set when results are no longer wanted: the output is closed.
    let closed = AtomicBool::new(false);
    thread::scope(|scope| {
        let (sender, results) = mpsc::channel();
        let (pool, work, closed) = (&pool, &work, &closed);
        scope.spawn(move || {
            // A bridge takes the items one after another.
            pool.install(|| {
                items.iter().enumerate().par_bridge().for_each_with(
                    sender,
                    |sender, (index, item)| {
                        // Nobody listens any more: the output is closed.
                        let _ = sender.send((index, work(item)));
                    },
                );
            });
        });
        let mut early = BTreeMap::new();
        let mut next = 0;
        for (index, result) in results {
            early.insert(index, result);
            while let Some(result) = early.remove(&next) {
                if let Err(error) = each(result) {
                    closed.store(true, Relaxed);
                    return Err(error);
                }
                next += 1;
            }
        }
        Ok(())
    })
}
