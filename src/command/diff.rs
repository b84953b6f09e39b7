//! `gwatt diff`.
//!
//! Each program runs on both machines at the same time; what each says of a
//! move meets in a channel, so that memory stays flat.

use std::io::{self, BufWriter};
use std::path::Path;
use std::sync::mpsc::{SyncSender, sync_channel};
use std::thread;

use anyhow::{Result, ensure};
use gwatt::interpret::MoveKind;
use gwatt::pipeline::{self, Failure, Row, Summary};
use gwatt::report::{
    Change, Compared, Comparison, PageRows, Verdict, comparison_csv, comparison_text,
};

use super::clash::refuse_clashes;
use super::dialect;
use super::in_order::in_order;
use super::input::Program;
use super::listing::Listing;
use super::output::{Target, print};
use super::page::{self, Pictures, Refused};
use super::paired::{SentRows, pair};
use super::setup::{Setup, machine_file, share_threads};
use super::terminal::Terminal;
use crate::cli::DiffArgs;

/// How far a figure may exceed its limit by rounding alone.
const FIT_TOLERANCE: f64 = 1e-9;

/// Compares two machines over programs.
pub fn run(args: &DiffArgs, terminal: Terminal) -> Result<Verdict> {
    let mut programs = Listing::of(&args.programs, terminal)?.programs();
    let pictures = places(args, &programs)?;
    let mut from = Setup::of(&args.from, &args.reading, terminal)?;
    let mut to = Setup::of(&args.to, &args.reading, terminal)?;
    to.one_way("`diff` compares")?;
    dialect::settle(&mut from, &mut programs, terminal)?;
    if to.auto {
        to.machine.controller.language = from.machine.controller.language.clone();
    }
    let (at_once, each) = share_threads(from.options.threads.div_ceil(2), programs.len());
    from.options.threads = each;
    to.options.threads = each;
    let setups = [&from, &to];
    let mut frames = pictures.open()?;

    let mut comparisons = Vec::new();
    let mut in_turn = programs.iter();
    in_order(
        &programs,
        at_once,
        |program| compare(program, setups, pictures.is_any()),
        |(comparison, rows)| {
            if let Some(program) = in_turn.next() {
                show(program, &comparison, setups, terminal);
                if let (Some(rows), Ok(from), Ok(to)) = (rows, &comparison.from, &comparison.to) {
                    let compared = Compared {
                        other: &setups[1].machine,
                        names: [&args.from, &args.to],
                        summaries: [from, to],
                        comparison: &comparison,
                    };
                    page::draw_diff(&mut frames, program, setups, compared, &rows)
                        .map_err(Refused::into_error)?;
                }
            }
            comparisons.push(comparison);
            Ok(())
        },
    )?;
    let worst = comparisons.iter().map(Comparison::verdict).max();
    let worst = worst.unwrap_or(Verdict::Fits);
    let text = comparison_text(&comparisons, &args.from, &args.to, terminal.out_style());
    if let Some(path) = &args.csv {
        let mut spool = BufWriter::new(Target::new(path)?.spool()?);
        comparison_csv(&comparisons, &args.from, &args.to, &mut spool)?;
        let spool = spool.into_inner().map_err(io::IntoInnerError::into_error)?;
        spool.deliver()?;
    }
    if worst != Verdict::Refused {
        frames.deliver()?;
    }
    print(|out| out.write_all(text.as_bytes()))?;
    Ok(worst)
}

/// Where results go, which nothing may be read from.
fn places<'a>(args: &'a DiffArgs, programs: &[Program]) -> Result<Pictures<'a>> {
    let pictures = Pictures {
        html: args.html.as_deref(),
        svg: None,
    };
    ensure!(
        !pictures.is_any() || programs.len() == 1,
        "--html shows one program: give one, or a page to each"
    );
    let machines = [&args.from, &args.to];
    let machines = machines
        .into_iter()
        .filter_map(|name| machine_file(Some(name)));
    let programs = programs.iter().filter_map(Program::path);
    let inputs: Vec<&Path> = programs.chain(machines).collect();
    // The table goes to standard output.
    let table = pictures.is_any().then_some(Path::new("-"));
    let files = args.csv.iter().map(AsRef::as_ref);
    let outputs: Vec<&Path> = files.chain(pictures.paths()).chain(table).collect();
    refuse_clashes(&inputs, &outputs)?;
    Ok(pictures)
}

fn show(program: &Program, comparison: &Comparison, setups: [&Setup; 2], terminal: Terminal) {
    let [from, to] = setups;
    match (&comparison.from, &comparison.to) {
        (Err(failure), _) => terminal.say(|it| dialect::failure(from, program, failure, it)),
        (_, Err(failure)) => terminal.say(|it| dialect::failure(to, program, failure, it)),
        (Ok(summary), Ok(_)) => terminal.diagnostics(&program.name, &summary.notes),
    }
}

/// What differs, and the rows of both machines where a page is to show them.
fn compare(
    program: &Program,
    setups: [&Setup; 2],
    with_page: bool,
) -> (Comparison, Option<PageRows>) {
    let (from_sender, from_rows) = sync_channel(4);
    let (to_sender, to_rows) = sync_channel(4);
    let mut comparison = Comparison {
        program: program.name.clone(),
        from: Ok(Summary::default()),
        to: Ok(Summary::default()),
        begin: 0,
        cease: 0,
        changes: Vec::new(),
    };
    let mut page = with_page.then(PageRows::default);
    let (from, to) = thread::scope(|scope| {
        let from = scope.spawn(|| analyze(program, setups[0], from_sender));
        let to = scope.spawn(|| analyze(program, setups[1], to_sender));
        pair(from_rows, to_rows, |from, to| {
            let begins = begins(from, to);
            if let (Some(begins), Some(row)) = (begins, from.or(to)) {
                comparison.count(Change {
                    line: row.line,
                    file: row.file.clone(),
                    begins,
                });
            }
            if let Some(page) = &mut page {
                page.pair(from, to, word(begins));
            }
        });
        (join(from), join(to))
    });
    comparison.from = from;
    comparison.to = to;
    (comparison, page)
}

/// Whether a move begins or ceases to fit; `None`: neither. A move that one machine does not
/// make fits there.
fn begins(from: Option<&Row>, to: Option<&Row>) -> Option<bool> {
    // Waits for the spindle differ from machine to machine.
    let waits = from.or(to)?.kind == MoveKind::Spindle;
    let [from, to] = [from, to].map(|row| row.is_none_or(fits));
    (!waits && from != to).then_some(to)
}

fn word(begins: Option<bool>) -> &'static str {
    match begins {
        Some(true) => "begins to fit",
        Some(false) => "ceases to fit",
        None => "",
    }
}

fn fits(row: &Row) -> bool {
    let within = |value: f64, limit: f64| value <= limit * (1.0 + FIT_TOLERANCE);
    let regen_fits = row
        .regen_limit_w
        .is_none_or(|limit| within(row.regen_w, limit));
    regen_fits && within(row.peak_w, row.limit_w)
}

/// A panic of the thread goes on in this one.
fn join<T>(thread: thread::ScopedJoinHandle<'_, T>) -> T {
    thread
        .join()
        .unwrap_or_else(|panic| std::panic::resume_unwind(panic))
}

fn analyze(
    program: &Program,
    setup: &Setup,
    sender: SyncSender<Vec<Row>>,
) -> Result<Summary, Failure> {
    let mut rows = SentRows::new(sender);
    let input = program.open()?;
    let summary = pipeline::analyze(
        input,
        &setup.machine,
        &setup.options_for(program),
        Some(&mut rows),
    )?;
    rows.send().map_err(Failure::Output)?;
    Ok(summary)
}
