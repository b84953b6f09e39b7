//! Energy of an arc.
//!
//! Input: an arc and a phase of its profile. Output: the energy that its axes
//! draw, by quadrature between the instants at which power has a kink: where an
//! axis turns back, and where its mechanical or electrical power changes sign.

use super::arc_circle::Circle;
use super::circle::Motion;
use super::quadrants::Pieces;
use super::quadrature::integral;
use arrayvec::ArrayVec;
use gwatt_machine::AXES;
use gwatt_plan::Phase;
use std::f64::consts::TAU;

/// Cells of a piece in which a change of sign is looked for. A pair of changes
/// inside one cell is left to the adaptive quadrature.
const CELLS: usize = 6;
/// Steps at most in which a change of sign is located, and how nearly, as a share of its cell:
/// what the kink is off by changes the integral by the square of it.
const STEPS: u32 = 60;
const APART: f64 = 1e-9;
/// Points of the average over a turn.
const TURN_POINTS: u32 = 64;

/// Energy of the axes in one phase, J.
pub(super) fn phase_energy_j(circle: &Circle<'_>, phase: &Phase) -> f64 {
    let mut sum = 0.0;
    let turn_s = circle.turn_s(phase);
    let turns = if phase.is_cruise() && turn_s > 0.0 {
        (phase.duration_s / turn_s).floor()
    } else {
        0.0
    };
    let rest_s = phase.duration_s - turns * turn_s;
    for (from, to, last) in Pieces::new(circle, phase) {
        if last {
            sum += integral(|t| turn_average_w(circle, phase, t), from, to);
            break;
        }
        // Of a cruise the first turn is visited; what lies in the last, broken
        // turn counts once more.
        let split = if turns > 0.0 {
            rest_s.clamp(from, to)
        } else {
            to
        };
        for (from, to, times) in [(from, split, turns + 1.0), (split, to, turns)] {
            if to > from && times > 0.0 {
                sum += times * piece_energy_j(circle, phase, from, to);
            }
        }
    }
    sum
}

/// Energy of a piece on which no axis turns back, J.
pub(super) fn piece_energy_j(circle: &Circle<'_>, phase: &Phase, from: f64, to: f64) -> f64 {
    let signs = circle.signs(phase, 0.5 * (from + to));
    let power = |t| nominal_w(circle, &signs, &circle.motion(phase, t));
    let mut sum = 0.0;
    let mut start = from;
    for end in kinks(circle, phase, &signs, from, to) {
        if end > start {
            sum += integral(power, start, end);
            start = end;
        }
    }
    sum
}

/// Instants at which the power of an axis changes sign, in order; then `to`.
fn kinks(
    circle: &Circle<'_>,
    phase: &Phase,
    signs: &[f64; AXES],
    from: f64,
    to: f64,
) -> ArrayVec<f64, { 2 * AXES * CELLS + 1 }> {
    let mut found = ArrayVec::new();
    let instants: [f64; CELLS + 1] =
        std::array::from_fn(|i| from + (to - from) * (i as f64 / CELLS as f64));
    let motions = instants.map(|t| circle.motion(phase, t));
    for (index, (arc_axis, &sign)) in circle.axes.iter().zip(signs).enumerate() {
        let axis = arc_axis.axis;
        let lossless = circle.credit_regen && axis.efficiency == 1.0;
        let tests: &[fn(f64, f64) -> f64] = match (lossless, axis.copper == 0.0) {
            (true, _) => &[],
            (false, true) => &[|force, _| force],
            (false, false) => &[|force, _| force, |_, electrical| electrical],
        };
        for test in tests {
            let value = |motion: &Motion| {
                let (force, electrical) = axis_power(circle, index, sign, motion);
                test(force, electrical)
            };
            let values = motions.map(|motion| value(&motion));
            for cell in 0..CELLS {
                if values[cell] * values[cell + 1] < 0.0 {
                    let ends = [instants[cell], instants[cell + 1]];
                    let values = [values[cell], values[cell + 1]];
                    found.push(zero(|t| value(&circle.motion(phase, t)), ends, values));
                }
            }
        }
    }
    found.push(to);
    found.sort_unstable_by(f64::total_cmp);
    found
}

/// Where a function changes its sign between two instants, at which it has these values.
///
/// Source: regula falsi by Illinois (Dowell and Jarratt 1971), halving where that leaves the
/// interval.
fn zero(
    value: impl Fn(f64) -> f64,
    [mut a, mut b]: [f64; 2],
    [mut at_a, mut at_b]: [f64; 2],
) -> f64 {
    let near = APART * (b - a);
    for _ in 0..STEPS {
        if (b - a).abs() <= near {
            break;
        }
        let (low, high) = (a.min(b), a.max(b));
        let by_chord = b - at_b * (b - a) / (at_b - at_a);
        let t = if by_chord > low && by_chord < high {
            by_chord
        } else {
            0.5 * (a + b)
        };
        let at_t = value(t);
        if at_t == 0.0 {
            return t;
        }
        if (at_t > 0.0) == (at_b > 0.0) {
            at_a *= 0.5;
        } else {
            (a, at_a) = (b, at_b);
        }
        (b, at_b) = (t, at_t);
    }
    b
}

/// Force and electrical power of one axis.
fn axis_power(circle: &Circle<'_>, index: usize, sign: f64, m: &Motion) -> (f64, f64) {
    let arc_axis = &circle.axes[index];
    let axis = arc_axis.axis;
    let (v, a) = arc_axis.motion_towards(sign, m);
    let force = axis.mass * a + axis.viscous * v + axis.coulomb * sign + axis.gravity;
    (force, axis.electrical(v, force))
}

/// Power of the axes that counts towards the energy, W.
fn nominal_w(circle: &Circle<'_>, signs: &[f64; AXES], m: &Motion) -> f64 {
    let powers = (0..circle.axes.len()).map(|i| axis_power(circle, i, signs[i], m).1);
    if circle.credit_regen {
        powers.sum()
    } else {
        powers.map(|power| power.max(0.0)).sum()
    }
}

/// Power averaged over a turn at the speed of one instant, for arcs with so
/// many turns that each one need not be looked at.
fn turn_average_w(circle: &Circle<'_>, phase: &Phase, t: f64) -> f64 {
    let mut motion = circle.motion(phase, t);
    let mut sum = 0.0;
    for i in 0..TURN_POINTS {
        let angle = TAU * (f64::from(i) + 0.5) / f64::from(TURN_POINTS);
        (motion.sin, motion.cos) = libm::sincos(angle);
        let mut signs = [0.0; AXES];
        for (sign, axis) in signs.iter_mut().zip(&circle.axes) {
            *sign = axis.motion(&motion).0.signum();
        }
        sum += nominal_w(circle, &signs, &motion);
    }
    sum / f64::from(TURN_POINTS)
}
