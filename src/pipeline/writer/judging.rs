//! How the moves of blocks are judged and decided, at once or while their blocks wait.

use std::io::{Read, Seek, Write};

use super::Writer;
use crate::interpret::{Move, Step};
use crate::pipeline::drive::{MoveSink, drive_end, drive_line_end, drive_step};
use crate::pipeline::entry::Entry;
use crate::pipeline::judge::{Flight, Judge, Queue};
use crate::pipeline::own_steps::hand_back;
use crate::pipeline::row::Detail;
use crate::pipeline::spindle_rows::SpindleRows;
use crate::pipeline::totals::Totals;
use crate::power::{Assessment, Assessor, Want};

/// Counts judged moves, and hands them to the limiter.
struct Counted<'a, 'm> {
    tally: &'a mut Totals<'m, 'm>,
    spindle: &'a mut SpindleRows,
    detail: Detail,
    judge: Judge<'a, 'm>,
}

impl MoveSink for Counted<'_, '_> {
    fn want(&self) -> Want {
        self.detail.want(self.tally.want())
    }

    fn take(&mut self, mv: &Move, judged: &Assessment, text: &[u8]) {
        self.tally.add(mv, judged, text);
        if self.spindle.judge(mv, judged) {
            self.judge.take(mv, judged);
        }
    }
}

impl<'m, R: Read + Seek, W: Write> Writer<'m, R, W> {
    /// Lets a block wait, and judges its moves, and those that it lets earlier blocks have.
    pub(super) fn judge_waiting(&mut self, entry: Box<Entry>) {
        let moved = entry.moves_on();
        self.entries.push_back(entry);
        let mut placed = std::mem::take(&mut self.placed);
        hand_back(&mut self.entries, &mut self.mode, &mut placed);
        let (assessor, mut counted) = self.counted();
        let first = counted.judge.queue.first;
        let entries = counted.judge.queue.entries;
        for (number, step) in placed.iter().copied() {
            let Some(entry) = entries.get(number) else {
                continue;
            };
            let Some(taken) = entry.steps.get(step) else {
                continue;
            };
            if matches!(taken, Step::Move(_)) {
                counted.judge.queue.flights.push_back(Flight {
                    entry: first + number as u64,
                    step,
                    assessment: None,
                });
            }
            drive_step(assessor, taken, &entry.text, &mut counted);
        }
        drive_line_end(assessor, moved, &mut counted);
        self.placed = placed;
    }

    /// What judges moves, and what takes them then.
    fn counted(&mut self) -> (&mut Assessor<'m>, Counted<'_, 'm>) {
        let counted = Counted {
            tally: &mut self.tally,
            spindle: &mut self.spindle,
            detail: self.detail,
            judge: Judge {
                limiter: &mut self.limiter,
                queue: Queue {
                    machine: self.machine,
                    entries: &self.entries,
                    first: self.first,
                    flights: &mut self.flights,
                },
                judged: &mut self.judged,
                outcomes: &mut self.outcomes,
            },
        };
        (&mut self.assessor, counted)
    }

    /// Judges and decides the moves of a block none of which has to wait; of a
    /// plain one, `judged` may be known.
    pub(super) fn decide_at_once(&mut self, entry: &mut Entry, judged: Option<Assessment>) {
        for (step, mv) in entry.steps.iter().enumerate() {
            let mv = match mv {
                Step::Move(mv) => mv,
                // No move waits that it could let go.
                Step::Action(action) => {
                    self.assessor.act(action, &mut |_, _, _| {});
                    continue;
                }
            };
            self.mode = mv.path_mode;
            let Self {
                assessor,
                limiter,
                tally,
                machine,
                decided,
                spindle,
                ..
            } = self;
            let mut decide = |assessment: &Assessment| {
                let find = |_| Some(entry.waiting(machine, mv, step));
                limiter.push(mv, assessment, &find, &mut |outcome| {
                    decided.push((*assessment, outcome));
                });
            };
            if let Some(assessment) = &judged {
                decide(assessment);
                continue;
            }
            assessor.want = self.detail.want(tally.want());
            assessor.push(mv, &entry.text, &mut |judged, assessment, text| {
                tally.add(judged, assessment, text);
                if spindle.judge(judged, assessment) {
                    decide(assessment);
                }
            });
        }
        std::mem::swap(&mut entry.decided, &mut self.decided);
    }

    /// Judges and decides what is left at the end.
    pub(super) fn finish_moves(&mut self) {
        let (assessor, mut counted) = self.counted();
        drive_end(assessor, &mut counted);
        counted.judge.finish();
        self.decide();
    }

    /// Gives the outcomes to their blocks.
    pub(super) fn decide(&mut self) {
        for outcome in self.outcomes.drain(..) {
            let Some(flight) = self.flights.pop_front() else {
                break;
            };
            self.judged = self.judged.saturating_sub(1);
            let index = (flight.entry - self.first) as usize;
            if let (Some(entry), Some(assessment)) =
                (self.entries.get_mut(index), flight.assessment)
            {
                entry.decided.push((assessment, outcome));
            }
        }
    }
}
