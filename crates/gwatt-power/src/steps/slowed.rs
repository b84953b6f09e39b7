//! What lower overrides make of the means over a response time.

use super::Placed;
use super::peaks::{Mean, swing};
use crate::demand::larger;
use gwatt_machine::AxisValues;

/// All means between two, `step_s` apart, and what changes the speeds within.
pub(super) struct Window<'a> {
    pub means: &'a [Mean; 2],
    pub step_s: f64,
    pub over_s: f64,
    pub changes: Changes,
}

/// By what the speeds of the axes change in some time, mm/s.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Changes {
    /// At joints, by all steps together.
    pub steps: AxisValues,
    /// Between them, by all that is upwards, and by all that is downwards.
    pub ramps: [AxisValues; 2],
}

impl Changes {
    /// Adds that between two shares of a span's time.
    pub fn ramp(&mut self, axes: &[usize], placed: &Placed, [from, to]: [f64; 2]) {
        let [first, last] = &placed.span.axes_mm_s;
        let [up, down] = &mut self.ramps;
        for &axis in axes {
            let change = (last[axis] - first[axis]) * (to - from) * placed.span.beyond.ramp;
            up[axis] += change.max(0.0);
            down[axis] += change.min(0.0);
        }
    }

    /// The most of both: in between both change evenly.
    pub fn most(mut self, other: &Self, axes: &[usize]) -> Self {
        let [up, down] = &mut self.ramps;
        for &axis in axes {
            up[axis] = up[axis].max(other.ramps[0][axis]);
            down[axis] = down[axis].min(other.ramps[1][axis]);
        }
        self
    }
}

impl Window<'_> {
    /// The largest speed of an axis and its largest acceleration, mm/s and mm/s², where a
    /// share of all speeds is left; `lower`: or of some.
    pub fn most(&self, axis: usize, share: f64, lower: bool) -> [f64; 2] {
        let [a, b] = swing(self.means, axis, self.step_s);
        let [first, last] = self.means;
        let own = larger(first.accel[axis].abs(), last.accel[axis].abs());
        let [up, down] = &self.changes.ramps;
        let changes = share * self.changes.steps[axis].abs() + larger(up[axis], -down[axis]);
        let changed = if lower { changes / self.over_s } else { 0.0 };
        let accel = if share < 1.0 {
            changed
        } else {
            larger(own, changed)
        };
        [share * larger(a.abs(), b.abs()), accel]
    }

    /// What becomes of it where a share of all speeds is left: it is that much longer, and each
    /// of the ramps around may have ended before or be as it is. `steps`: the share of the
    /// steps within that is left, for the time that they take here.
    pub fn slowed(&self, axes: &[usize], share: f64, steps: f64) -> [Mean; 2] {
        self.lower(axes, steps, |speeds| speeds.map(|speed| share * speed))
    }

    /// The same where only some places are passed more slowly: the axes are as fast as at the
    /// largest overrides, or have a share of that.
    pub fn partly_slowed(&self, axes: &[usize], share: f64, steps: f64) -> [Mean; 2] {
        self.lower(axes, steps, |[a, b]| {
            let (least, most) = (a.min(b), a.max(b));
            [least.min(share * least), most.max(share * most)]
        })
    }

    /// The least and the largest accelerations, with a share of the steps and the ramps up or
    /// those down, and the speeds of both.
    fn lower(
        &self,
        axes: &[usize],
        steps: f64,
        speeds: impl Fn([f64; 2]) -> [f64; 2],
    ) -> [Mean; 2] {
        let mut lower = *self.means;
        let [up, down] = &self.changes.ramps;
        for &axis in axes {
            let steps = steps * self.changes.steps[axis];
            let accels = [steps + down[axis], steps + up[axis]];
            let speeds = speeds(swing(self.means, axis, self.step_s));
            for (mean, (accel, speed)) in lower.iter_mut().zip(accels.into_iter().zip(speeds)) {
                mean.accel[axis] = accel / self.over_s;
                mean.speed[axis] = speed;
            }
        }
        lower
    }
}
