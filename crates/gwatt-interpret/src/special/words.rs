//! Words with a meaning of their own, as blocks have them.

use super::{MOTION_GROUP, MOVES_OF_A_BLOCK, Turning};
use crate::code::{GCode, Motion};
use crate::control::{Control, Run};
use crate::letters::bit;
use crate::rules::CycleWords;
use crate::turning::{BOX, FACE, THREAD, THREAD_BOX};
use gwatt_machine::{AxisSet, AxisValues};
use gwatt_motion::{ActionKind, MoveKind};
use gwatt_syntax::source::Span;

impl Control<'_> {
    /// The motion word in force after `motion` was read; `None` if it does not
    /// count.
    #[inline]
    pub(crate) fn enter(&mut self, motion: Motion, groups: u32) -> Option<Motion> {
        match motion {
            Motion::Special(number) => {
                if self.modal.motion != motion && number != 53 {
                    self.special.spline.end();
                }
                if !matches!(self.modal.motion, Motion::Special(_)) {
                    self.special.before = self.modal.motion;
                }
                Some(motion)
            }
            Motion::None => self.cancel(groups),
            _ => {
                self.special.active = 0;
                self.special.spline.end();
                Some(motion)
            }
        }
    }

    /// G80. Next to another motion word it does nothing.
    fn cancel(&mut self, groups: u32) -> Option<Motion> {
        if groups & MOTION_GROUP != 0 {
            return None;
        }
        self.special.active = 0;
        let language = &self.machine.controller.language;
        let lathe = language.dialect.lathe.is_some();
        if self.rules.cycles != CycleWords::Fanuc || !(language.mill_cycles || lathe) {
            return Some(Motion::None);
        }
        // On a Fanuc, G80 is of another group than G0 to G3, which come back.
        matches!(self.modal.motion, Motion::Special(_)).then_some(self.special.before)
    }

    /// G98 and G99.
    pub(crate) fn retract_level(&mut self, initial: bool, span: Span, run: &mut Run<'_, '_>) {
        let fanuc = self.rules.cycles == CycleWords::Fanuc;
        let in_cycle = matches!(self.modal.motion, Motion::Special(_));
        let lathe = self.dialect().lathe.is_some();
        if fanuc && !lathe && !initial && !in_cycle {
            run.report
                .error(
                    "unsupported-code",
                    "G99 without a canned cycle: it may mean the feed per revolution of a lathe",
                    span,
                )
                .help("write it in the block of the cycle, or G95 for a feed per revolution");
            return;
        }
        self.special.to_initial = initial;
    }

    /// A block under a special motion word (number × 10).
    pub(crate) fn special_motion(&mut self, number: u16, run: &mut Run<'_, '_>) {
        let fanuc = self.rules.cycles == CycleWords::Fanuc;
        let moves = match number {
            52 | 53 => run.facts.motion_word.is_some() || run.words.has_axes(),
            _ if fanuc => run.words.has_axes() || run.words.unused & bit(b'R') != 0,
            _ => run.words.has_axes(),
        };
        if !moves {
            if run.facts.motion_word.is_some() && !fanuc {
                let span = run.whole();
                run.report
                    .error("no-axes", "this motion word needs an axis word", span)
                    .help("write where it is to move");
            }
            return;
        }
        run.facts.uses_motion = true;
        // What was edited before has to be put back on a line of its own:
        // neither G nor F may be written into the block.
        run.facts.boundary = true;
        let whole = run.whole();
        if run.facts.machine_coordinates {
            run.report
                .error("special-in-g53", "G53 goes with G0 and G1 only", whole)
                .help("use work coordinates here");
            return;
        }
        if !self.suits_frame(number) {
            run.report
                .error(
                    "special-in-frame",
                    "turned, scaled or mirrored coordinates, or diameters, under this motion word",
                    whole,
                )
                .help("end them before, or write the moves out");
            return;
        }
        let before = run.steps.len();
        match number {
            50..=53 => self.spline(number, run),
            330 | 331 => self.thread(number, run),
            810..=890 if self.dialect().lathe.is_some() => self.turning_motion(number, run),
            THREAD | BOX | THREAD_BOX | FACE => self.turning_motion(number, run),
            380..=389 => self.probe(number, run),
            760 if !fanuc => self.thread_cycle(run),
            _ if fanuc => self.iso_cycle(number, run),
            _ => self.rs274_cycle(number, run),
        }
        if run.steps.len() > before + MOVES_OF_A_BLOCK {
            run.report
                .error(
                    "too-many-moves",
                    format!("this block makes more than {MOVES_OF_A_BLOCK} moves"),
                    whole,
                )
                .help("check Q and the number of repeats");
        }
    }

    /// Whether the coordinates in force are such that a motion word is followed.
    /// A cycle may have its holes placed in a turned plane, as long as its own
    /// axis is left alone; G76 and G87 shift in that plane.
    fn suits_frame(&self, number: u16) -> bool {
        let frame = &self.position.frame;
        if self.dialect().lathe.is_some() {
            // Turning cycles see to diameters and frames themselves.
            return true;
        }
        if self.modal.diameter && !matches!(number, 330 | 760) {
            return false;
        }
        let follows = matches!(number, 380..=389 | 730 | 740 | 800..=860 | 880 | 890);
        frame.is_plain() || follows && frame.leaves_alone(self.modal.plane[2])
    }

    /// Counts the moves of a repetition, made since there were `before` steps;
    /// false when there are too many.
    pub(crate) fn count_repeated(&mut self, before: usize, run: &mut Run<'_, '_>) -> bool {
        self.special.repeated += (run.steps.len() - before) as u64;
        if self.special.repeated <= self.special.most {
            return true;
        }
        let whole = run.whole();
        let message = format!("repetition makes more than {} moves", self.special.most);
        run.report
            .error("too-many-moves", message, whole)
            .help("if that is meant, allow more: --max-moves");
        false
    }

    /// A part of a special motion that moves to `end`.
    pub(crate) fn part(&mut self, run: &mut Run<'_, '_>, kind: MoveKind, end: &AxisValues) {
        let mut apart = AxisSet::default();
        let [first, second, normal] = self.modal.plane;
        let lathe = self.dialect().lathe.is_some();
        for axis in self.machine.axis_set.iter() {
            let of_cycle = if lathe {
                axis == first || axis == second
            } else {
                axis == normal
            };
            let unsure = of_cycle && self.position.points.apart();
            let goes = end[axis] != self.position.at[axis] || unsure;
            if goes && self.places_in_cycle(axis) {
                apart.insert(axis);
            }
        }
        self.go(run, kind, end, apart, None);
    }

    /// Where the control believes the axes to be.
    pub(crate) fn believed(&self) -> AxisValues {
        match &self.special.left {
            None => self.position.at,
            Some(place) => *place,
        }
    }

    /// After the stop of G88 the next move starts elsewhere than the control
    /// believes: followed for straight moves and cycles.
    pub(crate) fn may_follow_a_stop(&mut self, run: &mut Run<'_, '_>) -> bool {
        let other = run.words.g.iter().any(|(code, ..)| {
            matches!(
                code,
                GCode::SetOffset | GCode::ClearOffset { .. } | GCode::RestoreOffset
            )
        });
        let arc = matches!(self.modal.motion, Motion::ArcCw | Motion::ArcCcw);
        let probe = matches!(self.modal.motion, Motion::Special(380..=389));
        if !(other || (arc || probe) && run.words.has_axes()) {
            return true;
        }
        let whole = run.whole();
        run.report
            .error(
                "after-g88",
                "G88 leaves the axis to be retracted by hand: what follows is not known",
                whole,
            )
            .help("move the axes by G0 or G1 first");
        false
    }
}

impl Run<'_, '_> {
    /// True while the block may go on; at its limit of moves it is reported by
    /// [`Control::special`].
    pub(crate) fn within_limits(&self) -> bool {
        self.steps.len() <= MOVES_OF_A_BLOCK
    }

    /// The spindle, as part of a cycle.
    pub(crate) fn spin(&mut self, turning: Turning) {
        self.act(ActionKind::Spindle, turning.m_word());
    }
}
