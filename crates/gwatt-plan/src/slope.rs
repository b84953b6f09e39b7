//! Motion whose acceleration changes in proportion to speed: along a straight
//! piece of a curve of torque over speed, or against viscous friction.
//!
//! With s = da/dv, and `φ₁(x) = (eˣ − 1)/x`, `φ₂(x) = (eˣ − 1 − x)/x²`,
//!
//! ```text
//! v = v₀ + a₀·t·φ₁(s·t),   a = a₀·e^(s·t),   x = v₀·t + a₀·t²·φ₂(s·t)
//! ```

use super::phase::{Phase, State};

/// The state `t` seconds into a phase.
pub(super) fn state(phase: &Phase, slope: f64, t: f64) -> State {
    let (v, a, x) = (phase.velocity_mm_s, phase.accel_mm_s2, slope * t);
    State {
        position_mm: phase.position_mm + (v + a * t * phi2(x)) * t,
        velocity_mm_s: (v + a * t * phi1(x)).max(0.0),
        accel_mm_s2: a * libm::exp(x),
    }
}

/// Time in s in which the speed changes by `change` from a state with the
/// acceleration `a`.
pub(super) fn time(a: f64, slope: f64, change: f64) -> f64 {
    let x = slope * change / a;
    if x == 0.0 {
        change / a
    } else {
        change / a * libm::log1p(x) / x
    }
}

fn phi1(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { libm::expm1(x) / x }
}

fn phi2(x: f64) -> f64 {
    if x.abs() > 0.5 {
        return (libm::expm1(x) - x) / (x * x);
    }
    // Σ xⁿ/(n + 2)!, from the smallest term.
    let mut sum = 1.0;
    for n in (3..=18).rev() {
        sum = 1.0 + sum * x / f64::from(n);
    }
    0.5 * sum
}
