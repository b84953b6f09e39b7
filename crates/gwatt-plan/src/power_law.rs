//! Motion at constant power against a constant drag.
//!
//! ```text
//! a = p/v − d,   z = d·v/p
//! t(v) = ∫ v/(p − d·v) dv  = v²/p · Σ zⁿ/(n + 2) = p/d²·(−z − ln(1 − z))
//! x(v) = ∫ v²/(p − d·v) dv = v³/p · Σ zⁿ/(n + 3) = p²/d³·(−z²/2 − z − ln(1 − z))
//! ```
//!
//! p and d are power and drag by mass. While braking p is negative. Speed only
//! approaches p/d, where nothing is left to accelerate with. The series serve
//! where z is small, since the closed forms lose their digits there.

use super::phase::{Phase, State};

/// Up to this |z| the series are used.
const SERIES: f64 = 0.25;
/// Terms of the series: 0.25²⁶ is below the last digit.
const TERMS: u32 = 26;
/// Steps of Newton's method at most.
const STEPS: u32 = 60;

/// Power and drag by mass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PowerLaw {
    /// mm²/s³.
    pub power: f64,
    /// mm/s².
    pub drag: f64,
}

impl PowerLaw {
    /// The law with a given power that has the acceleration `a` at the speed
    /// `v`.
    pub fn through(power: f64, v: f64, a: f64) -> Self {
        Self {
            power,
            drag: power / v - a,
        }
    }

    /// Acceleration at a speed.
    pub fn accel(&self, v: f64) -> f64 {
        self.power / v - self.drag
    }

    /// Time from speed `v0` to `v1`, s.
    pub fn time(&self, v0: f64, v1: f64) -> f64 {
        self.integral(v1, 2) - self.integral(v0, 2)
    }

    /// Length of the way from speed `v0` to `v1`, mm.
    pub fn length(&self, v0: f64, v1: f64) -> f64 {
        self.integral(v1, 3) - self.integral(v0, 3)
    }

    /// The integral of `vⁿ⁻¹/(p − d·v)` from 0 to `v`; n is 2 or 3.
    fn integral(&self, v: f64, order: i32) -> f64 {
        let z = self.drag * v / self.power;
        let scale = v.powi(order) / self.power;
        if z.abs() <= SERIES {
            let mut sum = 0.0;
            for n in (0..TERMS).rev() {
                sum = sum * z + 1.0 / (f64::from(n) + f64::from(order));
            }
            return scale * sum;
        }
        let rest = -z - libm::log1p(-z);
        if order == 2 {
            scale * rest / (z * z)
        } else {
            scale * (rest - 0.5 * z * z) / (z * z * z)
        }
    }

    /// The state `t` seconds into a phase.
    pub fn state(&self, phase: &Phase, t: f64) -> State {
        let v0 = phase.velocity_mm_s;
        let v = self.speed(phase, t);
        State {
            position_mm: phase.position_mm + self.length(v0, v),
            velocity_mm_s: v,
            accel_mm_s2: self.accel(v),
        }
    }

    /// The speed `t` seconds into a phase: time grows with the change of
    /// speed, so the root is bracketed by both ends.
    fn speed(&self, phase: &Phase, t: f64) -> f64 {
        let (v0, v1) = (phase.velocity_mm_s, phase.end_velocity_mm_s);
        if t <= 0.0 {
            return v0;
        }
        if t >= phase.duration_s {
            return v1;
        }
        let (mut before, mut after) = (v0, v1);
        let start = self.integral(v0, 2);
        let mut v = 0.5 * (v0 + v1);
        for _ in 0..STEPS {
            let late = self.integral(v, 2) - start - t;
            if late > 0.0 {
                after = v;
            } else {
                before = v;
            }
            let step = late * self.accel(v);
            if step.abs() <= f64::EPSILON * v {
                break;
            }
            let newton = v - step;
            let inside = (newton - before) * (newton - after) < 0.0;
            let next = if inside {
                newton
            } else {
                0.5 * (before + after)
            };
            if next == v {
                break;
            }
            v = next;
        }
        v
    }
}
