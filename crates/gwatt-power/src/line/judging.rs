//! How lines are judged.

use super::{BLOCKS_MAX, STRAIGHT_ON, straight_on};
use crate::assess::Assessor;
use crate::assessment::{Assessment, Certificate, Loads};
use crate::demand::Want;
use crate::piece::piece_demand;
use crate::spindle_share::SpindleShare;
use gwatt_motion::{Move, MoveKind};
use gwatt_plan::lookahead::{Element, Joint, PathPlanner, Planned};
use gwatt_plan::{Overrides, is_independent};

impl Assessor<'_> {
    /// Takes a move that goes straight on after what waits; false, and nothing done, for
    /// all others.
    #[inline]
    pub(crate) fn goes_straight_on(&mut self, mv: &Move, text: &[u8]) -> bool {
        let closed = std::mem::take(&mut self.line.closed);
        if closed || self.held.is_none() && self.line.is_empty() {
            return false;
        }
        self.extend_line(mv, text)
    }

    #[inline(never)]
    fn extend_line(&mut self, mv: &Move, text: &[u8]) -> bool {
        let last = match (self.line.blocks.last(), self.held.as_deref()) {
            (Some((last, _)), _) => last,
            (None, Some(held)) if !held.assessment.joined && held.riders.is_empty() => &held.mv,
            _ => return false,
        };
        let modelled = self.machine.controller.planner.look_ahead.is_some();
        let planned = self.requested != Some(Certificate::Robust);
        let plain =
            self.bus.is_none() && self.observer.watch.is_none() && self.observer.motions.is_none();
        let fits = !modelled && planned && plain && self.line.blocks.len() < BLOCKS_MAX;
        let runs = fits && self.joins(last, mv) && self.may_run(last) && self.may_run(mv);
        if !(runs && straight_on(last, mv) && self.knows_change(last, mv)) {
            return false;
        }
        if let Some(held) = self.held.take_if(|_| self.line.is_empty()) {
            self.line.rested = held.rested;
            self.line.blocks.push((held.mv, held.text));
        }
        self.line.blocks.push((mv.clone(), text.to_vec()));
        self.rested = self.ends_at_rest(mv).unwrap_or(self.rested);
        true
    }

    /// Whether both have the same acceleration, or the words that change it are known to act
    /// between two moves that run into each other.
    fn knows_change(&self, last: &Move, mv: &Move) -> bool {
        let mut knobs = self.machine.controller.knobs.iter();
        let same = last.accel_mm_s2 == mv.accel_mm_s2;
        same && last.path_accel_mm_s2 == mv.path_accel_mm_s2
            || knobs.all(|knob| knob.between_moves || !knob.sets_accel())
    }

    /// Whether a move may be one of a line: its axes speed up and brake as the line does.
    fn may_run(&self, mv: &Move) -> bool {
        let jerk = |axis: usize| self.machine.axes[axis].is_some_and(|axis| axis.jerk_mm_s3 > 0.0);
        matches!(mv.kind, MoveKind::Rapid | MoveKind::Feed)
            && mv.arc.is_none()
            && !mv.stray.strays()
            && mv.unknown_start.is_empty()
            && mv.length_mm > 0.0
            && self.machine.force_curves.is_empty()
            && !mv.moving.iter().any(jerk)
            && !is_independent(self.machine, mv)
    }

    /// Judges a line that `next` ends, or the end of the program.
    pub(crate) fn end_straight(
        &mut self,
        next: Option<&Move>,
        sink: &mut impl FnMut(&Move, &Assessment, &[u8]),
    ) {
        let Some((last, _)) = self.line.blocks.last() else {
            return;
        };
        // As for one block between two stops, the ends of the program are none for feeds.
        let rapid = last.kind == MoveKind::Rapid;
        let stops = next.map_or(rapid, |next| {
            let passes = next.kind != MoveKind::Dwell && !next.moves_axes();
            !passes && !self.joins(last, next)
        });
        let between = stops && (rapid || self.line.rested);
        if !(between && self.plan_line(sink)) {
            self.bound_line(sink);
        }
    }

    /// Gives the blocks that wait the robust bound.
    #[cold]
    pub(crate) fn bound_line(&mut self, sink: &mut impl FnMut(&Move, &Assessment, &[u8])) {
        if !self.line.is_empty() {
            self.rested = self.line.rested;
        }
        for (mv, text) in std::mem::take(&mut self.line.blocks) {
            self.push_unmodelled(&mv, &text, sink);
        }
    }

    /// Plans the blocks that wait, from rest to rest; false where one has no path.
    fn plan_line(&mut self, sink: &mut impl FnMut(&Move, &Assessment, &[u8])) -> bool {
        let [largest, nominal] = [self.largest, self.nominal];
        let Some(peaks) = self.pieces(largest) else {
            return false;
        };
        let times = if nominal == largest {
            None
        } else {
            self.pieces(nominal)
        };
        let blocks = std::mem::take(&mut self.line.blocks);
        for (index, ((mv, text), planned)) in blocks.iter().zip(&peaks).enumerate() {
            let timed = times.as_ref().and_then(|times| times.get(index));
            let timed = timed.unwrap_or(planned);
            let mut assessment = self.on_line(mv, planned, timed);
            assessment.joined = index > 0;
            sink(mv, &assessment, text);
        }
        // It began and ended at rest: nothing is blended with it.
        self.before = None;
        true
    }

    /// The pieces of the plan, one for each block.
    fn pieces(&self, overrides: Overrides) -> Option<Vec<Planned<u64>>> {
        let mut planner = PathPlanner::new(self.machine, STRAIGHT_ON);
        let joint = Joint::Blend {
            tolerance_mm: 0.0,
            join_mm: 0.0,
        };
        for (number, (mv, _)) in self.line.blocks.iter().enumerate() {
            let element = Element::of(self.machine, mv, overrides, joint, number as u64)?;
            planner.push(&element);
        }
        planner.stop();
        let mut pieces = Vec::with_capacity(self.line.blocks.len());
        while let Some(planned) = planner.pop() {
            if !planned.certain || planned.tag != pieces.len() as u64 {
                return None;
            }
            pieces.push(planned);
        }
        (pieces.len() == self.line.blocks.len()).then_some(pieces)
    }

    fn on_line(&self, mv: &Move, planned: &Planned<u64>, timed: &Planned<u64>) -> Assessment {
        let want = Want {
            energy: false,
            ..Want::PEAKS
        };
        let top_speed_mm_s = planned.top_speed_mm_s();
        let demand = piece_demand(&self.model, mv, planned, want);
        let mut demand = self.model.with_cruises(demand, mv, top_speed_mm_s);
        if self.want.energy {
            demand.energy_j = piece_demand(&self.model, mv, timed, Want::ALL).energy_j;
        }
        let own = gwatt_plan::plan(self.machine, mv, self.nominal);
        Assessment {
            duration_s: timed.duration_s(),
            speed_mm_s: own.speed_limit_mm_s,
            accel_mm_s2: own.accel_mm_s2,
            top_speed_mm_s,
            ends2: [planned.speeds2.start, planned.speeds2.end],
            fastest_s: planned.duration_s(),
            demand,
            loads: Loads {
                own: demand.load_ratio,
                steps: 0.0,
            },
            certificate: Certificate::Planned,
            blended: true,
            joined: false,
            ahead: true,
            spindle: SpindleShare::NONE,
        }
    }
}
