//! The words of chamfers and rounded corners.

use super::{Corner, Corners, FIXED, Insert, TEXT_MAX};
use crate::code::GCode;
use crate::compensation::fault::Fault;
use crate::compensation::hold::place;
use crate::control::{Control, Run};
use gwatt_motion::{FeedMode, Move, MoveKind, Step};
use std::f64::consts::TAU;

impl Control<'_> {
    /// Asks for something in the corner after the present block.
    pub(crate) fn ask_corner(&mut self, insert: Insert) {
        self.corners.get_or_insert_default().ask = Some(insert);
    }

    /// Puts in what corners ask for, among what a block gave.
    #[cold]
    pub(crate) fn insert_corners(&mut self, run: &mut Run<'_, '_>, before: usize, errors: u64) {
        let Some(mut corners) = self.corners.take() else {
            return;
        };
        let ask = corners.ask.take();
        corners.cut = false;
        if ask.is_none() && corners.waits.is_none() {
            return;
        }
        run.facts.fixed = Some(FIXED);
        run.facts.compensated = true;
        if run.report.diagnostics.errors != errors {
            return;
        }
        match self.join(&mut corners, ask, before, run) {
            Ok(()) => self.corners = Some(corners),
            // One fault is reported once.
            Err(fault) => fault.report(run),
        }
    }

    fn join(
        &self,
        corners: &mut Corners,
        ask: Option<Insert>,
        before: usize,
        run: &mut Run<'_, '_>,
    ) -> Result<(), Fault> {
        let path = |step: &Step| matches!(step, Step::Move(_));
        let own = run.steps.get(before..).unwrap_or_default();
        let moves = own.iter().filter(|step| path(step)).count();
        let modal = |insert| matches!(insert, Insert::Round { modal: true, .. });
        let switches = run.words.groups & GCode::CompensationOff.group() != 0;
        if let Some((first, insert)) = corners.waits.take() {
            if switches {
                // The move that waits belongs to the compensation before.
                return Err(Fault::NoSecondMove);
            }
            let feeds = own.iter().all(|step| match step {
                Step::Move(mv) => matches!(mv.kind, MoveKind::Feed | MoveKind::Arc),
                Step::Action(_) => true,
            });
            if modal(insert) && ask.is_none() && (moves == 0 || !feeds) {
                // RNDM=0: no corner where its path ends.
                run.steps.insert(before, Step::Move(first));
            } else if moves == 0 && own.is_empty() {
                corners.waits = Some((first, insert));
                return if ask.is_some_and(|ask| !modal(ask)) {
                    Err(Fault::NoSecondMove)
                } else {
                    Ok(())
                };
            } else if moves != 1 || !feeds {
                return Err(Fault::NoSecondMove);
            } else {
                self.put_in(first, insert, before, run)?;
                corners.cut = true;
            }
        }
        let Some(insert) = ask else { return Ok(()) };
        let last = matches!(run.steps.get(before..).and_then(<[Step]>::last),
            Some(Step::Move(mv)) if matches!(mv.kind, MoveKind::Feed | MoveKind::Arc));
        if moves != 1 || !last || self.ended {
            let [a, b, _] = self.modal.plane;
            let in_plane = run.steps.get(before..).unwrap_or_default().iter().any(|step| {
                matches!(step, Step::Move(mv) if mv.moving.contains(a) || mv.moving.contains(b))
            });
            return if modal(insert) && !in_plane {
                Ok(())
            } else {
                Err(Fault::NoFirstMove)
            };
        }
        if let Some(Step::Move(mv)) = run.steps.pop() {
            let (text, _) = gwatt_syntax::source::split_line_end(run.report.text);
            let text = text.get(..TEXT_MAX).unwrap_or(text).to_vec();
            corners.text = Some(((mv.text, mv.line), text));
            corners.waits = Some((mv, insert));
        }
        Ok(())
    }

    /// Puts the corner in front of the only move of the present block.
    fn put_in(
        &self,
        mut first: Move,
        insert: Insert,
        before: usize,
        run: &mut Run<'_, '_>,
    ) -> Result<(), Fault> {
        let [a, b, _] = self.modal.plane;
        let plane = [a, b];
        let own = run.steps.get_mut(before..).unwrap_or_default();
        let second = own.iter_mut().find_map(|step| match step {
            Step::Move(mv) => Some(mv),
            Step::Action(_) => None,
        });
        let Some(second) = second else {
            return Err(Fault::NoSecondMove);
        };
        for mv in [&first, &*second] {
            let flat = mv.moving.iter().all(|axis| axis == a || axis == b);
            let known = mv.unknown_start.is_empty() && mv.feed_mode != FeedMode::InverseTime;
            let turn = mv
                .arc
                .is_none_or(|arc| arc.plane == plane && arc.sweep_rad.abs() <= TAU);
            if !(flat && known && turn) || mv.moving.is_empty() {
                return Err(Fault::CornerPlane);
            }
        }
        let inch = self.modal.mm_per_unit == gwatt_machine::units::MM_PER_INCH;
        let corner = Corner::new(&first, second, plane, inch)?;
        let (from, to, arc) = corner.cut(insert)?;
        let mut middle = second.clone();
        (middle.line, middle.number) = (first.line, first.number);
        (middle.run, middle.text) = (first.run, first.text);
        (middle.start, middle.end) = (first.end, first.end);
        middle.kind = if arc.is_some() {
            MoveKind::Arc
        } else {
            MoveKind::Feed
        };
        if !self.rules.chamfer_has_next_feed {
            // Which of the two feeds holds there is not documented: the faster.
            middle.feed_mm_s = middle.feed_mm_s.max(first.feed_mm_s);
        }
        corner.shorten(&mut first, corner.before.start, from)?;
        corner.shorten(second, to, corner.after.end)?;
        place(&mut middle, plane, from, to, arc);
        run.steps
            .splice(before..before, [Step::Move(first), Step::Move(middle)]);
        Ok(())
    }
}
