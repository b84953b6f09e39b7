//! The original of a program that is held whole, run once more: what each of its moves must
//! become.

use std::collections::VecDeque;
use std::io::Cursor;

use crate::interpret::{Move, MoveKind, Step};
use crate::machine::Machine;
use crate::pipeline::describe::{describe, row};
use crate::pipeline::drive::{MoveSink, drive_end, drive_line};
use crate::pipeline::executor::Executor;
use crate::pipeline::expected::{Expected, ExpectedMove};
use crate::pipeline::line_key::LineKey;
use crate::pipeline::row::Detail;
use crate::pipeline::spindle_rows::SpindleRows;
use crate::pipeline::table::Table;
use crate::pipeline::totals::whether_fits;
use crate::pipeline::{Failure, Options};
use crate::power::{Assessment, Assessor, PowerModel, Want};

/// Steps of the original that are held at a time while they are compared.
const STEPS: usize = 4096;

/// The original, run once more for the comparison.
pub(super) struct Original<'m, 'p> {
    machine: &'m Machine,
    front: Executor<'m, Cursor<&'p [u8]>>,
    assessor: Assessor<'m>,
    model: PowerModel,
    table: &'p Table,
    detail: Detail,
    waiting: Waiting,
    /// Lines executed so far.
    ordinal: u64,
    /// Names of the files of subprograms, by number less 1.
    files: Vec<String>,
    start_s: f64,
}

/// Steps that are not judged yet, in order.
struct Waiting {
    /// What is wanted of each move.
    want: Want,
    steps: VecDeque<Held>,
    /// Steps from the front on that are actions or judged.
    judged: usize,
    spindle: SpindleRows,
}

/// A step of the original.
struct Held {
    step: Step,
    key: LineKey,
    /// Which of the executed lines it belongs to.
    ordinal: u64,
    feed: Option<f64>,
    assessment: Option<Assessment>,
}

impl MoveSink for Waiting {
    fn want(&self) -> Want {
        self.want
    }

    fn take(&mut self, mv: &Move, assessment: &Assessment, _text: &[u8]) {
        if !self.spindle.judge(mv, assessment) {
            return;
        }
        self.pass_actions();
        if let Some(held) = self.steps.get_mut(self.judged) {
            held.assessment = Some(*assessment);
            self.judged += 1;
        }
        self.pass_actions();
    }
}

impl Waiting {
    fn pass_actions(&mut self) {
        while matches!(self.steps.get(self.judged), Some(held) if matches!(held.step, Step::Action(_)))
        {
            self.judged += 1;
        }
    }

    /// The next step of a line all of whose steps are judged.
    fn next(&mut self) -> Option<Held> {
        self.pass_actions();
        let front = self.steps.front()?.ordinal;
        if self
            .steps
            .get(self.judged)
            .is_some_and(|next| next.ordinal == front)
        {
            return None;
        }
        self.judged -= 1;
        self.steps.pop_front()
    }
}

impl<'m, 'p> Original<'m, 'p> {
    pub(super) fn new(
        program: &'p [u8],
        machine: &'m Machine,
        options: &Options,
        table: &'p Table,
        detail: Detail,
    ) -> Self {
        let model = PowerModel::new(machine);
        let want = detail.want(whether_fits(machine, &model));
        let assessor =
            Assessor::new(machine, options.certificate, want).starting(options.reading.start);
        Self {
            machine,
            front: Executor::new(Cursor::new(program), machine, options),
            assessor,
            model,
            table,
            detail,
            waiting: Waiting {
                want,
                steps: VecDeque::new(),
                judged: 0,
                spindle: SpindleRows::default(),
            },
            ordinal: 0,
            files: Vec::new(),
            start_s: 0.0,
        }
    }

    /// Adds what the next lines do to `expected`; false at the end.
    pub(super) fn read(&mut self, expected: &mut Vec<Expected>) -> Result<bool, Failure> {
        let mut more = true;
        while more && expected.len() < STEPS {
            let Self {
                front,
                assessor,
                waiting,
                ordinal,
                files,
                ..
            } = self;
            if let Some(line) = front.next_line()? {
                let feed = line
                    .interpreter
                    .modal()
                    .feed
                    .as_ref()
                    .map(|feed| feed.value);
                *ordinal += 1;
                let known = files.len();
                files.extend(line.files.iter().skip(known).cloned());
                for step in &*line.steps {
                    let key = match step {
                        // It may have waited for this line.
                        Step::Move(mv) if line.facts.compensated => (mv.text, mv.line),
                        _ => line.key,
                    };
                    waiting.steps.push_back(Held {
                        step: step.clone(),
                        key,
                        ordinal: *ordinal,
                        feed,
                        assessment: None,
                    });
                }
                let turns_knob = line.facts.turns_knob;
                let text_of = |_, _: &Step| line.text;
                drive_line(assessor, line.steps, turns_knob, text_of, waiting);
            } else {
                drive_end(assessor, waiting);
                more = false;
            }
            while let Some(held) = self.waiting.next() {
                if let (Step::Move(_), Some(_)) = (&held.step, held.assessment) {
                    self.expect_spindle(expected);
                    self.waiting.spindle.write();
                }
                expected.push(match (&held.step, held.assessment) {
                    (Step::Move(mv), Some(assessment)) => self.expect(mv, &held, &assessment),
                    (Step::Action(_), _) if held.step.is_note() => continue,
                    (Step::Action(action), _) => Expected::Action(*action),
                    (Step::Move(_), None) => continue,
                });
            }
        }
        if !more {
            self.expect_spindle(expected);
        }
        Ok(more)
    }

    /// Rows of the spindle before the next move.
    fn expect_spindle(&mut self, expected: &mut Vec<Expected>) {
        let of = (self.machine, &self.model, self.detail.has_rows());
        let spindle = &mut self.waiting.spindle;
        spindle.hand_over(of, &mut self.start_s, expected);
    }

    fn expect(&mut self, mv: &Move, held: &Held, assessment: &Assessment) -> Expected {
        let decision = self
            .table
            .decision(held.key)
            .filter(|_| mv.kind != MoveKind::Dwell);
        let change = decision.map(|decision| &decision.change);
        let hopeless = self.table.hopeless(held.key);
        let row = self.detail.has_rows().then(|| {
            let mut row = row(self.machine, &self.model, mv, assessment, self.start_s);
            row.file = self
                .files
                .get(usize::from(mv.text).wrapping_sub(1))
                .cloned()
                .unwrap_or_default();
            describe(self.machine, mv, change, held.feed, &mut row);
            if hopeless && !self.model.fits(&assessment.demand) {
                row.action = "none possible";
            }
            Box::new(row)
        });
        self.start_s += assessment.duration_s;
        Expected::Move(ExpectedMove {
            changed: change.is_some(),
            as_feed: change.is_some_and(|change| change.as_feed),
            exact_stop: change.is_some_and(|change| change.exact_stop),
            stops: change.is_some_and(|change| change.stop),
            hopeless,
            row,
            ..ExpectedMove::of(mv, assessment)
        })
    }
}
