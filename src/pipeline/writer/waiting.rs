//! Dwells between rapids and before tool changes, where limits over time ask for them.

use super::waits::Plan;
use std::io::{Read, Seek, Write};

use super::Writer;
use crate::interpret::{ActionKind, Motion, Move, MoveKind, Step};
use crate::machine::AxisSet;
use crate::pipeline::entry::Entry;
use crate::pipeline::expected::{Expected, ExpectedMove};
use crate::pipeline::outcome::Pause;
use crate::pipeline::row::{Certificate, Row};

/// Places that are kept.
const PLACES: usize = 1 << 16;

impl<R: Read + Seek, W: Write> Writer<'_, R, W> {
    /// Lets the program wait as planned.
    pub(in crate::pipeline) fn pausing(mut self, plan: Option<Plan>) -> Self {
        self.waits.plan = plan;
        self
    }

    /// Waits before a block, where that is planned.
    pub(super) fn wait_before(&mut self, entry: &Entry) {
        let Some(plan) = self.waits.plan else { return };
        // Comments and settings do nothing.
        if entry.steps.is_empty() {
            return;
        }
        let last = self.waits.last.take();
        self.waits.last = ended_by_rapid(entry);
        let Some(last) = last.filter(|last| self.is_place(entry, last)) else {
            return;
        };
        let line = entry.key.1;
        if self.waits.places.len() < PLACES {
            self.waits.places.push(line);
        }
        if plan.each_s <= 0.0 || plan.place.is_some_and(|place| place != line) {
            return;
        }
        let language = &self.machine.controller.language;
        let Some((words, dwell_s)) = language.dwell_block(plan.each_s) else {
            return;
        };
        self.rewriter.put_between(&words, &mut self.batch.bytes);
        self.waits.pauses.push(Pause {
            line,
            seconds: dwell_s,
        });
        let mv = Move {
            line,
            kind: MoveKind::Dwell,
            start: last.end,
            moving: AxisSet::default(),
            dwell_s,
            length_mm: 0.0,
            ..last
        };
        let row = self
            .detail
            .has_rows()
            .then(|| Box::new(self.pause_row(&mv)));
        self.batch.expected.push(Expected::Move(ExpectedMove {
            row,
            ..ExpectedMove::standing(&mv)
        }));
    }

    /// Whether the program may wait between a rapid and the block after it: the tool is in
    /// the air, and goes on there, or is changed, or the program stops or ends.
    fn is_place(&self, entry: &Entry, last: &Move) -> bool {
        let facts = &entry.facts;
        let changes = entry.steps.iter().any(|step| {
            use ActionKind::{End, Stop, ToolChange, ToolSelect};
            matches!(step, Step::Action(action)
                if matches!(action.kind, ToolChange | ToolSelect | Stop | End))
        });
        let goes_on = matches!(entry.steps.first(), Some(Step::Move(mv))
            if mv.kind == MoveKind::Rapid && mv.moves_axes() && mv.loads == last.loads);
        let kept = facts.checksum || facts.compensated || facts.cycle || facts.kept().is_some();
        let cuts = entry.its_moves().any(|mv| mv.kind != MoveKind::Rapid);
        let free = !kept && entry.block.delete_level == 0 && !cuts;
        free && self.mark.motion == Motion::Rapid && (goes_on || changes && entry.moves == 0)
    }

    /// The row of a dwell that the original does not have.
    fn pause_row(&self, mv: &Move) -> Row {
        let converter = self.machine.converters.first();
        let several = self.machine.converters.len() > 1;
        Row {
            line: mv.line,
            run: mv.run,
            file: String::new(),
            n_word: None,
            kind: MoveKind::Dwell,
            axes: AxisSet::default(),
            start_s: self.start_s,
            duration_s: 0.0,
            peak_w: 0.0,
            regen_w: 0.0,
            limit_w: self.model.limit_w(0),
            ratio: None,
            energy_j: 0.0,
            action: "pause",
            knob: "G4".to_owned(),
            words: String::new(),
            feed_allowed: false,
            value_before: None,
            value_after: Some(mv.dwell_s),
            peak_after_w: None,
            start_after_s: None,
            duration_after_s: None,
            regen_after_w: None,
            certificate: Certificate::Planned,
            regen_limit_w: self.model.regen_limit_w(0),
            converter: converter
                .filter(|_| several)
                .map_or_else(String::new, |it| it.name.clone()),
            route: None,
        }
    }
}

/// The rapid that a block ends with, if nothing comes after it there and it runs whether
/// blocks are skipped or not.
fn ended_by_rapid(entry: &Entry) -> Option<Move> {
    let Some(Step::Move(mv)) = entry.steps.last() else {
        return None;
    };
    let facts = &entry.facts;
    let kept = facts.checksum || facts.compensated || facts.cycle || facts.kept().is_some();
    let rapid = mv.kind == MoveKind::Rapid && mv.moves_axes() && mv.unknown_start.is_empty();
    (rapid && !kept && entry.block.delete_level == 0).then(|| mv.clone())
}
