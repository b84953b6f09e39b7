//! What would bring a move down, in a few words.

use super::entry::positions;
use crate::interpret::{FeedMode, Interpreter, Motion, Move, MoveKind};
use crate::limit::{Allowed, Change, Ends, Law, LimitOptions, Permit, Solver, Strategy};
use crate::machine::{AxisValues, Machine, RapidJoint};
use crate::power::Assessment;

/// How the advice for a move begins.
pub(super) const FITS: &str = "fits with ";

/// What is said after a change of F that takes a permission.
pub(super) const FEED_OPTION: &str = " (limit --allow feed)";

/// What helps where the spindle alone is too much.
pub(super) const SPINDLE_HELP: &str = "a lower S, or a drive that runs up and brakes more slowly \
     (`peak_power_w`, `regen_power_w` or `accel_time_s` in [spindle]); gwatt writes no S";

/// What helps where a move is not run by itself.
pub(super) const NEIGHBOURS_HELP: &str =
    "lower feed or acceleration here and in the neighbouring blocks";

/// What advice depends on next to the move: the state of its block.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Circumstances {
    compensates: bool,
    feed_mode: FeedMode,
    mm_per_unit: f64,
    feed_accel_mm_s2: AxisValues,
    speed_mm_s: AxisValues,
    unsure_unit: bool,
    motion: Motion,
}

impl Circumstances {
    pub(super) fn of(interpreter: &Interpreter<'_>) -> Self {
        let modal = interpreter.modal();
        Self {
            compensates: interpreter.compensates(),
            feed_mode: modal.feed_mode,
            mm_per_unit: modal.mm_per_unit,
            feed_accel_mm_s2: interpreter.knobs().feed_accel_mm_s2,
            speed_mm_s: interpreter.knobs().speed_mm_s,
            unsure_unit: interpreter.knobs().unsure_unit,
            motion: modal.motion,
        }
    }
}

/// Gives advice for moves that do not fit.
pub(super) struct Adviser<'m> {
    machine: &'m Machine,
    solver: Solver<'m>,
}

impl<'m> Adviser<'m> {
    pub(super) fn new(machine: &'m Machine) -> Self {
        let how = LimitOptions {
            strategy: Strategy::Optimal,
            law: Law::Exact,
            allowed: Allowed {
                feed: true,
                ..Allowed::NOTHING
            },
            ..LimitOptions::USUAL
        };
        Self {
            machine,
            solver: Solver::new(machine, how),
        }
    }

    /// What helps.
    pub(super) fn help(&self, mv: &Move, assessment: &Assessment, at: &Circumstances) -> String {
        if mv.kind == MoveKind::Spindle {
            return SPINDLE_HELP.to_owned();
        }
        if assessment.blended && !assessment.ahead {
            return NEIGHBOURS_HELP.to_owned();
        }
        // Under G93 each block has an F of its own.
        let by_f = at.feed_mode != FeedMode::PerRevolution
            && !(at.feed_mode == FeedMode::InverseTime && at.compensates);
        let printer = &self.machine.controller.language.printer;
        let permit = Permit {
            edit: true,
            feed_word: by_f,
            as_feed: true,
            exact_stop: false,
            stands: mv.path_mode == crate::machine::PathMode::ExactStop,
            line_before: true,
            knobs: !at.compensates && !at.unsure_unit,
            apart: false,
            stop_word: false,
            levels: !at.compensates,
            rests: mv.path_mode == crate::machine::PathMode::ExactStop
                || mv.kind == MoveKind::Rapid
                    && self.machine.controller.planner.rapid_joint == RapidJoint::Stop,
            unsplit: None,
            reason: "",
            reason_help: "",
            mm_per_unit: at.mm_per_unit,
            knob_mm_per_unit: printer.limit_unit(at.mm_per_unit),
            feed_before: None,
            positions: positions(self.machine, at.motion, mv),
            feed_accel_mm_s2: at.feed_accel_mm_s2,
            speed_mm_s: at.speed_mm_s,
        };
        let ends = if assessment.blended {
            Ends::Any(0)
        } else {
            Ends::Rest
        };
        match self.solver.solve(mv, assessment, &permit, ends) {
            Ok(change) => self.words(mv, &change, permit.positions),
            Err(obstacle) => format!("{}: {}", obstacle.message, obstacle.help),
        }
    }

    /// The words that a change writes.
    fn words(&self, mv: &Move, change: &Change, free: bool) -> String {
        let words = super::describe::words(self.machine, change);
        if words.is_empty() {
            return NEIGHBOURS_HELP.to_owned();
        }
        let option = if mv.kind != MoveKind::Rapid && change.feed.is_some() && !free {
            FEED_OPTION
        } else {
            ""
        };
        format!("{FITS}{words}{option}")
    }
}
