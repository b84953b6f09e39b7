//! `gwatt diff`.
//!
//! Each program runs on both machines at the same time; what each says of a
//! move meets in a channel, so that memory stays flat.

use std::cmp::Ordering;
use std::io::{self, BufWriter};
use std::mem;
use std::path::Path;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread;

use anyhow::Result;
use gwatt::interpret::MoveKind;
use gwatt::pipeline::{self, Failure, Row, RowSink, Summary};
use gwatt::report::{Change, Comparison, Verdict, comparison_csv, comparison_text};

use super::clash::refuse_clashes;
use super::dialect;
use super::in_order::in_order;
use super::input::Program;
use super::listing::Listing;
use super::output::{Target, print};
use super::setup::{Setup, machine_file, share_threads};
use super::terminal::Terminal;
use crate::cli::DiffArgs;

/// Moves that go through the channel at once.
const BATCH: usize = 1024;
/// How far a figure may exceed its limit by rounding alone.
const FIT_TOLERANCE: f64 = 1e-9;

/// Compares two machines over programs.
pub fn run(args: &DiffArgs, terminal: Terminal) -> Result<Verdict> {
    let mut programs = Listing::of(&args.programs, terminal)?.programs();
    let machines = [&args.from, &args.to];
    let machines = machines
        .into_iter()
        .filter_map(|name| machine_file(Some(name)));
    let inputs: Vec<&Path> = programs
        .iter()
        .filter_map(Program::path)
        .chain(machines)
        .collect();
    let outputs: Vec<&Path> = args.csv.iter().map(AsRef::as_ref).collect();
    refuse_clashes(&inputs, &outputs)?;
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

    let mut comparisons = Vec::new();
    let mut in_turn = programs.iter();
    in_order(
        &programs,
        at_once,
        |program| compare(program, &from, &to),
        |comparison| {
            if let Some(program) = in_turn.next() {
                show(program, &comparison, [&from, &to], terminal);
            }
            comparisons.push(comparison);
            Ok(())
        },
    )?;
    let text = comparison_text(&comparisons, &args.from, &args.to);
    if let Some(path) = &args.csv {
        let mut spool = BufWriter::new(Target::new(path)?.spool()?);
        comparison_csv(&comparisons, &args.from, &args.to, &mut spool)?;
        let spool = spool.into_inner().map_err(io::IntoInnerError::into_error)?;
        spool.deliver()?;
    }
    print(|out| out.write_all(text.as_bytes()))?;
    let worst = comparisons.iter().map(Comparison::verdict).max();
    Ok(worst.unwrap_or(Verdict::Fits))
}

fn show(program: &Program, comparison: &Comparison, setups: [&Setup; 2], terminal: Terminal) {
    let [from, to] = setups;
    match (&comparison.from, &comparison.to) {
        (Err(failure), _) => terminal.say(|it| dialect::failure(from, program, failure, it)),
        (_, Err(failure)) => terminal.say(|it| dialect::failure(to, program, failure, it)),
        (Ok(summary), Ok(_)) => terminal.diagnostics(&program.name, &summary.notes),
    }
}

fn compare(program: &Program, from: &Setup, to: &Setup) -> Comparison {
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
    let (from, to) = thread::scope(|scope| {
        let from = scope.spawn(|| analyze(program, from, from_sender));
        let to = scope.spawn(|| analyze(program, to, to_sender));
        count_changes(from_rows, to_rows, &mut comparison);
        (join(from), join(to))
    });
    comparison.from = from;
    comparison.to = to;
    comparison
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
    sender: SyncSender<Vec<Fit>>,
) -> Result<Summary, Failure> {
    let mut rows = FitRows {
        batch: Vec::with_capacity(BATCH),
        sender,
    };
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

/// Whether the move of a line fits.
#[derive(Debug, Clone, Copy)]
struct Fit {
    line: u64,
    fits: bool,
}

impl From<&Row> for Fit {
    fn from(row: &Row) -> Self {
        let within = |value: f64, limit: f64| value <= limit * (1.0 + FIT_TOLERANCE);
        let regen_fits = row
            .regen_limit_w
            .is_none_or(|limit| within(row.regen_w, limit));
        Self {
            line: row.line,
            fits: regen_fits && within(row.peak_w, row.limit_w),
        }
    }
}

/// Sends rows to the other end of a channel.
struct FitRows {
    batch: Vec<Fit>,
    sender: SyncSender<Vec<Fit>>,
}

impl FitRows {
    fn send(&mut self) -> io::Result<()> {
        let batch = mem::replace(&mut self.batch, Vec::with_capacity(BATCH));
        self.sender.send(batch).map_err(io::Error::other)
    }
}

impl RowSink for FitRows {
    fn row(&mut self, row: &Row) -> io::Result<()> {
        // Waits for the spindle differ from machine to machine.
        if row.kind == MoveKind::Spindle {
            return Ok(());
        }
        self.batch.push(Fit::from(row));
        if self.batch.len() == BATCH {
            self.send()?;
        }
        Ok(())
    }
}

/// Pairs the moves of both machines by line. Both ends are read to their ends,
/// so that no thread waits for ever.
fn count_changes(from: Receiver<Vec<Fit>>, to: Receiver<Vec<Fit>>, comparison: &mut Comparison) {
    let mut from = from.into_iter().flatten().peekable();
    let mut to = to.into_iter().flatten().peekable();
    while let (Some(before), Some(after)) = (from.peek(), to.peek()) {
        // Two controllers may make different moves of one line.
        match before.line.cmp(&after.line) {
            Ordering::Less => {
                from.next();
            }
            Ordering::Greater => {
                to.next();
            }
            Ordering::Equal => {
                if before.fits != after.fits {
                    comparison.count(Change {
                        line: before.line,
                        begins: after.fits,
                    });
                }
                from.next();
                to.next();
            }
        }
    }
    from.for_each(drop);
    to.for_each(drop);
}
