//! Runs of the spindle next to axes at lower overrides of feed, rapid and spindle.

use super::SpindleBus;
use crate::assessment::Assessment;
use crate::overlap_lower::{self, Since};
use gwatt_motion::Move;
use gwatt_plan::Plan;

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
        let henceforth = slower.henceforth(&self.motor);
        self.add(&mut demand, henceforth, 0.0, cutting_w);
        if self.model.fits(&demand) || !self.model.fits(&self.alone(Some(mv), henceforth)) {
            return;
        }
        let index = self.spindle.converter;
        if let (Some((run, span_s)), Some(converter)) =
            (slower.run(), self.model.converters.get(index))
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
            let axes = (duration_s, assessment.demand.spindle_converter_w);
            let [peak_w, regen_w] =
                overlap_lower::peaks(&self.model, converter, mv, plan, axes, (run, since));
            let more_w = self.spindle.base_load_w + cutting_w;
            let fed_back_w = (regen_w - self.credited_w()).max(0.0);
            demand = assessment.demand;
            demand.set_spindle(index, &self.model, [peak_w + more_w, fed_back_w]);
        }
        if !self.model.fits(&demand) {
            judged.demand.include(&demand);
        }
    }

    /// The same where the spindle follows the axes: `lower` is what it asks for at most at
    /// lower overrides.
    pub(super) fn count_following(
        &self,
        assessment: &Assessment,
        [largest_w, least_w]: [f64; 2],
        cutting_w: f64,
        judged: &mut Assessment,
    ) {
        let mut demand = assessment.demand;
        let lower = [largest_w.max(0.0), least_w.min(0.0)];
        self.add(&mut demand, lower, 0.0, cutting_w);
        if !self.model.fits(&demand) {
            judged.demand.include(&demand);
        }
    }
}
