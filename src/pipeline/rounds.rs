//! Rounds of limiting: the program is written and handed to the certifier piece by piece, so
//! that nothing of it is held for long, until no change makes a neighbour exceed the limit.

use std::io::{Read, Seek, Write};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread;

use super::batch::Batch;
use super::certify::{Certified, Certifier};
use super::conclusion::{conclude, has_other_words};
use super::derate::LAST_ROUND;
use super::looped_program::LoopedProgram;
use super::row::Detail;
use super::worker::no_thread;
use super::writer::{Plan, Streamed, Writer, Written};
use super::{Failure, LimitOptions, LimitSummary, Options, Restart, RestartRows, RowSink};
use crate::diagnostic::Diagnostic;
use crate::limit::{Allowed, Depths, Limiter, Paces};
use crate::machine::{Machine, PathMode};
use crate::power::{Lower, PowerModel};

/// Pieces that may wait for the certifier.
const BATCHES: usize = 2;

/// Why there is no further round.
pub(super) fn last_round(depths: &Depths, allowed: Allowed, machine: &Machine) -> Diagnostic {
    let rounds = depths.rounds();
    Diagnostic::error(
        LAST_ROUND,
        format!("blocks exceed the limit next to others that were lowered, after {rounds} rounds"),
    )
    .help(allowed.else_helps(has_other_words(machine)))
}

/// One way of limiting, in as many rounds as it takes.
#[derive(Clone, Copy)]
pub(super) struct Job<'a> {
    pub(super) machine: &'a Machine,
    /// The same with the limits that are aimed at.
    pub(super) target: &'a Machine,
    /// How the program is read, on each path through it.
    pub(super) paths: &'a [Options],
    pub(super) how: LimitOptions,
    /// Where the program waits, if it may.
    pub(super) plan: Option<Plan>,
    pub(super) rounds: Rounds,
}

/// How often a program is limited.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Rounds {
    /// Once: which moves cannot be lowered shows then.
    First,
    /// Until it fits next to its own changes, or cannot be made to.
    All,
}

/// What came of it.
pub(super) struct Attempt {
    pub(super) summary: LimitSummary,
    /// Lines before which the program may wait.
    pub(super) places: Vec<u64>,
    /// What was learned of the paces of lines.
    pub(super) paces: Option<Paces>,
}

impl Job<'_> {
    /// Limits in rounds: where changes make neighbours exceed the limit, all is planned again
    /// with more, and what the bound over all overrides leaves open is looked at in further
    /// runs, which write the same.
    ///
    /// Rows cost far more than all else: of several rounds the last one alone has them, and
    /// of a first attempt the first, which most often is the last.
    pub(super) fn rounds<R: Read + Seek + Send, W: Write + Restart + Send>(
        &self,
        mut depths: Depths,
        mut input: R,
        mut output: W,
        rows: &mut Option<&mut dyn RestartRows>,
        again: bool,
    ) -> Result<Attempt, Failure> {
        let mut rungs = Lower::default();
        let mut ladder = None;
        let mut progress = Progress::default();
        let mut has_rows = !again || rows.is_none();
        loop {
            let used = depths.clone();
            let (mut written, mut certified) = if has_rows {
                self.run(&rungs, &used, &mut input, &mut output, rows)?
            } else {
                self.run(&rungs, &used, &mut input, &mut output, &mut None)?
            };
            let places = std::mem::take(&mut written.places);
            if let Some(paces) = depths.paces_mut() {
                let over = certified.deeper.iter().map(|line| line.place);
                paces.learn(std::mem::take(&mut certified.paced), over);
            }
            let mut asked = Lower::default();
            let (mut stuck, mut in_vain) = (false, false);
            let more = if self.rounds == Rounds::First {
                false
            } else if certified.deeper.is_empty() {
                let ladder = ladder.get_or_insert_with(|| certified.summary.ladder(self.machine));
                ladder.take(&certified.summary.lower);
                if certified.reasons.count == 0 && certified.summary.fits_at_largest() {
                    asked = ladder.ask();
                }
                !asked.is_empty()
            } else {
                in_vain = written.reasons.count > 0 && progress.stands_still(&certified);
                stuck = in_vain || !depths.deepen(&certified.deeper);
                !stuck
            };
            if more || !has_rows {
                input.rewind().map_err(Failure::Input)?;
                restart(&mut output, rows)?;
            }
            if more {
                rungs = asked;
                has_rows = rows.is_none();
                continue;
            }
            if !has_rows {
                (written, certified) = self.run(&rungs, &used, &mut input, &mut output, rows)?;
            }
            if let Some(ladder) = ladder.as_mut().filter(|_| !stuck) {
                certified.summary.settle(ladder);
            }
            let Self {
                machine,
                target,
                paths,
                how,
                ..
            } = *self;
            let mut summary = conclude(machine, target, paths, how, written, certified);
            if stuck && !in_vain {
                summary
                    .reasons
                    .push(last_round(&depths, how.allowed, machine));
            }
            let paces = depths.paces().cloned();
            return Ok(Attempt {
                summary,
                places,
                paces,
            });
        }
    }

    /// Writes and certifies the program.
    fn run<R: Read + Seek + Send, W: Write + Restart + Send>(
        &self,
        rungs: &Lower,
        depths: &Depths,
        mut input: R,
        mut output: W,
        rows: &mut Option<&mut dyn RestartRows>,
    ) -> Result<(Written, Certified), Failure> {
        let Self {
            machine,
            target,
            paths,
            how,
            plan,
            ..
        } = *self;
        let whole = LoopedProgram {
            machine,
            target,
            how,
        };
        let source = (paths, depths, rungs);
        let [options] = paths else {
            return whole.limit(
                input,
                output,
                source,
                rows.as_mut().map(|rows| as_sink(&mut **rows)),
            );
        };
        // Where blocks stop unless the program says otherwise, few programs need it: they are
        // read again once it shows.
        let blends = machine.controller.language.power_on_mode == PathMode::LookAhead;
        let mut first_look = blends && machine.controller.stops_by_word();
        loop {
            let stopping = if first_look {
                Some(whole.stopping(&mut input, source)?)
            } else {
                None
            };
            let detail = Detail::of(rows.as_deref());
            let sink = rows.as_mut().map(|rows| as_sink(&mut **rows));
            let certifier = Certifier::new(machine, rungs, options, sink);
            let limiter = Limiter::new(target, how, depths.clone());
            let model = PowerModel::new(machine);
            let writer = Writer::new(&mut input, &mut output, target, options, limiter, model)
                .detailed(detail)
                .pausing(plan)
                .stopping(stopping);
            let streamed = if options.threads > 1 {
                side_by_side(writer, certifier)?
            } else {
                one_after_the_other(writer, certifier)?
            };
            match streamed {
                Streamed::Written(done) => return Ok(done),
                Streamed::WantsStops if !first_look => {
                    first_look = true;
                    input.rewind().map_err(Failure::Input)?;
                    restart(&mut output, rows)?;
                }
                Streamed::WantsStops | Streamed::Flows => break,
            }
        }
        restart(&mut output, rows)?;
        whole.limit(
            input,
            output,
            source,
            rows.as_mut().map(|rows| as_sink(&mut **rows)),
        )
    }
}

/// Whether rounds still change anything: of a program that stays as it is anyway, since some of its
/// blocks may not be changed, they say no more then.
#[derive(Default)]
struct Progress {
    last: Option<(usize, u64, f64)>,
    /// Rounds in a row that came to the same.
    idle: u32,
}

impl Progress {
    /// Rounds that have to come to the same: the first steps deeper may ask for nothing more.
    const IDLE: u32 = 3;

    fn stands_still(&mut self, certified: &Certified) -> bool {
        let reasons = certified.reasons.count;
        let now = (
            certified.deeper.len(),
            reasons,
            certified.summary.duration_s,
        );
        let same = self.last.replace(now) == Some(now);
        self.idle = if same { self.idle + 1 } else { 0 };
        self.idle >= Self::IDLE
    }
}

/// Forgets what was written.
pub(super) fn restart(
    output: &mut impl Restart,
    rows: &mut Option<&mut dyn RestartRows>,
) -> Result<(), Failure> {
    output.restart().map_err(Failure::Output)?;
    match rows {
        Some(rows) => rows.restart().map_err(Failure::Output),
        None => Ok(()),
    }
}

pub(super) fn as_sink<'r>(rows: &'r mut (dyn RestartRows + '_)) -> &'r mut (dyn RowSink + 'r) {
    rows
}

/// Writes and certifies piece by piece.
fn one_after_the_other<R: Read + Seek, W: Write>(
    writer: Writer<'_, R, W>,
    mut certifier: Certifier<'_, '_>,
) -> Result<Streamed<(Written, Certified)>, Failure> {
    let streamed = writer.run(&mut |batch| certifier.take(batch))?;
    streamed.with(|| certifier.finish())
}

/// Writes in this thread and certifies in another.
fn side_by_side<R: Read + Seek + Send, W: Write + Send>(
    writer: Writer<'_, R, W>,
    certifier: Certifier<'_, '_>,
) -> Result<Streamed<(Written, Certified)>, Failure> {
    thread::scope(|scope| {
        let (sender, receiver) = sync_channel(BATCHES);
        let (back, empty) = sync_channel(BATCHES + 2);
        let handle = thread::Builder::new()
            .spawn_scoped(scope, move || certify_all(certifier, receiver, &back))
            .map_err(|error| no_thread(&error))?;
        let written = writer.run(&mut |batch| send(batch, &sender, &empty));
        drop(sender);
        // A panic of the certifier is a fault of gwatt: it goes on here.
        let certified = handle
            .join()
            .unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        match (written, certified) {
            // A certifier that failed has stopped the writer: its failure is
            // the cause. A refusal of the program comes from the writer alone.
            (Err(refused @ Failure::Refused { .. }), _) => Err(refused),
            (written, certified) => {
                let certified = certified?;
                written?.with(|| Ok(certified))
            }
        }
    })
}

/// The certifier's side of the channel.
fn certify_all(
    mut certifier: Certifier<'_, '_>,
    receiver: Receiver<Batch>,
    back: &SyncSender<Batch>,
) -> Result<Certified, Failure> {
    for mut batch in receiver {
        certifier.take(&mut batch)?;
        // A full channel of empty buffers only means one more allocation.
        let _ = back.try_send(batch);
    }
    certifier.finish()
}

fn send(
    batch: &mut Batch,
    sender: &SyncSender<Batch>,
    empty: &Receiver<Batch>,
) -> Result<(), Failure> {
    let full = std::mem::replace(batch, empty.try_recv().unwrap_or_default());
    // The certifier has stopped: its own failure is the one to report.
    sender
        .send(full)
        .map_err(|_| Failure::Output(std::io::ErrorKind::BrokenPipe.into()))
}
