//! Cutter compensation of the blocks as they come.

use super::fault::Fault;
use super::{Compensation, State};
use crate::code::GCode;
use crate::control::{Control, Run};
use crate::execute::Interpreter;
use gwatt_machine::CompensationLead;
use gwatt_motion::{Move, MoveKind, Step};

impl Interpreter<'_> {
    /// The text of the line of a move that was given with the last block, if
    /// that line came before it; cut if it is long.
    #[must_use]
    pub fn held_text(&self, mv: &Move) -> Option<&[u8]> {
        let control = &self.control;
        let shifted = control.compensation.as_ref().and_then(|it| it.text_of(mv));
        shifted.or_else(|| control.corners.as_ref()?.text_of(mv))
    }

    /// True while cutter compensation is on, and for the block that ends it.
    #[must_use]
    pub fn compensates(&self) -> bool {
        let compensation = self.control.compensation.as_ref();
        compensation.is_some_and(|compensation| compensation.is_at_work())
    }

    /// True while moves are held back: cutter compensation needs the next one
    /// to know where they end.
    #[must_use]
    pub fn holds(&self) -> bool {
        let compensation = self.control.compensation.as_ref();
        compensation.is_some_and(|compensation| compensation.holds()) || self.holds_corner()
    }

    /// True while a move waits for its chamfer or rounded corner.
    #[must_use]
    pub fn holds_corner(&self) -> bool {
        let corners = self.control.corners.as_ref();
        corners.is_some_and(|corners| corners.holds())
    }
}

impl Control<'_> {
    /// LinuxCNC asks the machine where it is after a tool change: what was left
    /// of a compensation that G40 has switched off is forgotten, and the axes are
    /// where they are, next to the path.
    pub(crate) fn forget_way_back(&mut self) {
        let Some(compensation) = &mut self.compensation else {
            return;
        };
        if compensation.state != State::Leaving
            || compensation.style.lead != CompensationLead::AtEnd
        {
            return;
        }
        compensation.state = State::Off;
        let places = compensation.plane.into_iter().zip(compensation.hold.tool);
        for (axis, at) in places {
            self.position.at[axis] = at;
        }
    }

    /// Whether the tool is still next to the path of a compensation that was
    /// switched off.
    pub(crate) fn is_on_way_back(&self) -> bool {
        let compensation = self.compensation.as_ref();
        compensation.is_some_and(|compensation| compensation.state == State::Leaving)
    }

    /// Sends what a block gave through the compensation.
    #[cold]
    pub(crate) fn compensate(&mut self, run: &mut Run<'_, '_>, before: usize, errors: u64) {
        let Some(mut compensation) = self.compensation.take() else {
            return;
        };
        let switches = run.words.groups & GCode::CompensationOff.group() != 0;
        if compensation.is_on() || compensation.holds() || switches {
            run.facts.compensated = true;
        }
        if compensation.state == State::Off && !compensation.holds() {
            return;
        }
        if compensation.passive {
            self.compensation = Some(compensation);
            return;
        }
        if run.report.diagnostics.errors == errors {
            compensation.forget();
            let mut own = std::mem::take(&mut compensation.own);
            own.extend(run.steps.drain(before..));
            if let Err(fault) = self.pass(&mut compensation, &mut own, run) {
                // One fault is reported once: it goes on without compensation.
                fault.report(run);
                return;
            }
            own.clear();
            compensation.own = own;
            compensation.remember((self.text, run.line), run.report.text);
        }
        self.compensation = Some(compensation);
    }

    fn pass(
        &mut self,
        compensation: &mut Compensation,
        own: &mut Vec<Step>,
        run: &mut Run<'_, '_>,
    ) -> Result<(), Fault> {
        let by_corner = compensation.style.lead == CompensationLead::Corner;
        if !(compensation.is_on() || by_corner && compensation.state == State::Leaving) {
            compensation.hold.finish(run.steps)?;
        }
        compensation.moved = false;
        if compensation.entering && !compensation.is_on() {
            return Err(Fault::NothingBetween);
        }
        let path = |step: &&Step| matches!(step, Step::Move(mv) if mv.kind != MoveKind::Dwell);
        let cut = self
            .corners
            .as_ref()
            .is_some_and(|corners| corners.is_cut());
        if compensation.is_on() && !cut && own.iter().filter(path).count() > 1 {
            return Err(Fault::OtherMotion);
        }
        for mut step in own.drain(..) {
            match (compensation.state, &mut step) {
                (State::Leaving, Step::Move(mv))
                    if mv.kind != MoveKind::Dwell && compensation.leaves_by(mv) =>
                {
                    self.leave(compensation, mv, run)?;
                    run.steps.push(step);
                }
                (State::Off, _) => run.steps.push(step),
                (State::Leaving, _) => compensation.hold.stay(step, run.steps)?,
                _ => compensation.follow(step, run.steps)?,
            }
        }
        if compensation.moved {
            compensation.idle = 0;
        } else if compensation.state == State::On {
            compensation.idle += 1;
        }
        if self.ended {
            compensation.hold.finish(run.steps)?;
            compensation.state = State::Off;
        }
        Ok(())
    }

    fn leave(
        &self,
        compensation: &mut Compensation,
        mv: &mut Move,
        run: &mut Run<'_, '_>,
    ) -> Result<(), Fault> {
        if mv.arc.is_some() {
            return Err(Fault::ArcAfterExit);
        }
        let timed = mv.feed_mode == gwatt_motion::FeedMode::InverseTime;
        let at_end = compensation.style.lead == CompensationLead::AtEnd;
        if timed && mv.kind != MoveKind::Rapid && !at_end {
            return Err(Fault::InverseTime);
        }
        if compensation.style.lead == CompensationLead::Corner {
            compensation.turn_to_leave(mv, run.steps)?;
        }
        let linear = compensation.leave(mv);
        // Its time is for the programmed way too.
        if mv.kind != MoveKind::Rapid
            && !timed
            && let Some(speed_mm_s) =
                self.feed_speed(run, &mv.end, mv.arc.as_ref(), mv.length_mm, linear)
        {
            (mv.feed_mm_s, mv.feed_excess) = (speed_mm_s, 1.0);
        }
        Ok(())
    }
}
