//! What a path draws that lies near the planned one: spirals that end on another circle than
//! they start on.
//!
//! With unit vectors of direction that are at most d apart, and accelerations that are at
//! most α larger, the speed of an axis differs by up to d·v, and its acceleration by up to
//! (2d + α)·â. So its power differs by no more than `(3d + α)·v·(m·â·k + b·v + Fc + |Fg|)/η`,
//! and what is lost in copper by no more than `2·(2d + α)·(1 + 2d + α)` of R·F².

use super::axis::Side;
use super::demand::Demand;
use super::model::PowerModel;
use crate::interpret::Move;

impl PowerModel {
    /// A demand with what the controller's own path may add to it, at speeds up to
    /// `top_speed_mm_s` along the path.
    #[cold]
    pub(super) fn with_stray(&self, demand: Demand, mv: &Move, top_speed_mm_s: f64) -> Demand {
        let (d, alpha) = (mv.stray.direction, mv.stray.accel);
        let force_share = 2.0 * d + alpha;
        let mut strayed = demand;
        for (index, converter) in self.converters.iter().enumerate() {
            let mut more_w = 0.0;
            for axis in converter
                .axes
                .iter()
                .filter(|axis| mv.moving.contains(*axis))
            {
                let power = &self.axes[axis];
                let v = top_speed_mm_s * power.si_per_unit;
                let accel = mv.accel_mm_s2[axis] * (1.0 + alpha) * power.si_per_unit;
                let factors = [
                    power.accel_factor(Side::Motor, true),
                    power.accel_factor(Side::Regen, false),
                ];
                let force = power.mass * accel * factors[0].max(factors[1])
                    + power.viscous_most() * v
                    + power.coulomb_most()
                    + power.gravity.abs();
                more_w += (d + force_share) * v * force * power.inverse_efficiency;
                more_w += 2.0 * force_share * (1.0 + force_share) * power.copper * force * force;
            }
            strayed.load_ratio = strayed
                .load_ratio
                .max(demand.load_ratio + more_w / self.least_limit_w(index));
            if index == demand.converter {
                strayed.peak_w += more_w;
                strayed.regen_w += more_w;
            }
            strayed.beside = strayed.beside.map(|beside| beside + more_w);
        }
        strayed
    }

    /// The lower of a converter's limits, drawn or fed back, W.
    fn least_limit_w(&self, converter: usize) -> f64 {
        let regen_w = self.regen_limit_w(converter).unwrap_or(f64::INFINITY);
        self.limit_w(converter).min(regen_w)
    }
}
