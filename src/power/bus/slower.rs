//! Runs of the spindle next to axes at lower overrides of feed and rapid.

use super::SpindleBus;
use crate::interpret::{Move, MoveKind};
use crate::plan::Plan;
use crate::power::assessment::Assessment;
use crate::power::overlap_lower::{self, Since};
use crate::power::spindle_state::{SpindleMotor, SpindleState};

/// The spindle where the knobs of feed and rapid may stand lower than at the largest.
#[derive(Debug)]
pub(super) struct Slower {
    pub state: SpindleState,
    /// Time at the largest overrides since the last command, s: of moves that the knob of
    /// feeds makes last longer, and that of rapids.
    grows_s: [f64; 2],
}

/// Which knobs make a move last longer: that of feeds, that of rapids.
fn knobs(mv: &Move) -> [bool; 2] {
    match mv.kind {
        MoveKind::Rapid => [false, true],
        MoveKind::Feed | MoveKind::Arc => [true, false],
        MoveKind::Dwell | MoveKind::Spindle => [false, false],
        MoveKind::Thread | MoveKind::Tap | MoveKind::Probe => [true, true],
    }
}

impl Slower {
    pub fn new(state: SpindleState) -> Self {
        Self {
            state,
            grows_s: [0.0; 2],
        }
    }

    /// A move passes, which takes so long at the largest overrides, at least and at most.
    pub fn pass(&mut self, mv: &Move, time_s: [f64; 2]) {
        self.state.pass(time_s);
        for (grows_s, grows) in self.grows_s.iter_mut().zip(knobs(mv)) {
            *grows_s += if grows { time_s[1] } else { 0.0 };
        }
    }

    /// A new speed is asked for. When that is, and so at which speed, is not known where
    /// moves came between.
    pub fn command(&mut self, motor: &SpindleMotor, target: f64) {
        if self.grows_s != [0.0; 2] {
            self.state.pass([0.0, f64::INFINITY]);
        }
        self.grows_s = [0.0; 2];
        self.state.command(motor, target);
    }

    /// How much of the time since the command grows as the override of a move falls, s;
    /// `None`: any.
    fn scaled_s(&self, mv: &Move) -> Option<f64> {
        let [feed_s, rapid_s] = self.grows_s;
        match knobs(mv) {
            [true, false] if rapid_s == 0.0 => Some(feed_s),
            [false, true] if feed_s == 0.0 => Some(rapid_s),
            _ => None,
        }
    }
}

impl SpindleBus<'_> {
    /// Counts what axes and spindle ask for together at lower overrides, if that is more
    /// than the converter gives; below that the largest overrides stand for all. A run
    /// that does not fit by itself has a row of its own.
    /// `plan`: of the move, where it is planned by itself.
    pub(super) fn count_slower(
        &self,
        mv: &Move,
        assessment: &Assessment,
        plan: Option<&Plan>,
        cutting_w: f64,
        judged: &mut Assessment,
    ) {
        let rests = mv.moving.is_empty() && mv.unknown_start.is_empty();
        let Some(slower) = self.slower.as_ref().filter(|_| !rests) else {
            return;
        };
        let mut demand = assessment.demand;
        let henceforth = slower.state.henceforth(&self.motor);
        self.add(&mut demand, henceforth, 0.0, cutting_w);
        if self.model.fits(&demand) || !self.model.fits(&self.alone(Some(mv), henceforth)) {
            return;
        }
        let index = self.spindle.converter;
        if let (Some((trace, span_s)), Some(converter)) =
            (slower.state.on_run(), self.model.converters.get(index))
        {
            let since = Since {
                span_s,
                scaled_s: slower.scaled_s(mv),
            };
            let known = assessment.fastest_s > 0.0;
            let duration_s = if known {
                assessment.fastest_s
            } else {
                f64::INFINITY
            };
            let axes = (duration_s, assessment.demand.beside);
            let run = (trace, since);
            let [peak_w, regen_w] =
                overlap_lower::peaks(&self.model, converter, mv, plan, axes, run);
            let more_w = self.spindle.base_load_w + cutting_w;
            let fed_back_w = (regen_w - self.credited_w()).max(0.0);
            demand = assessment.demand;
            demand.set_spindle(index, &self.model, [peak_w + more_w, fed_back_w]);
        }
        if !self.model.fits(&demand) {
            judged.demand.include(&demand);
        }
    }
}
