//! Integrals of power over time where there is no closed form.
//!
//! Input: a function and an interval. Output: its integral by adaptive
//! Gauss–Kronrod quadrature (7 and 15 points; Kronrod 1965, QUADPACK `qk15`).

use arrayvec::ArrayVec;

/// Largest relative error that is aimed at.
const TOLERANCE: f64 = 1e-10;
/// Evaluations of the rule on one interval, then the estimate is taken.
const BUDGET: u32 = 200;

/// Points of the Kronrod rule on [0, 1] next to the centre.
const NODES: [f64; 7] = [
    0.991_455_371_120_812_6,
    0.949_107_912_342_758_5,
    0.864_864_423_359_769_1,
    0.741_531_185_599_394_4,
    0.586_087_235_467_691_1,
    0.405_845_151_377_397_2,
    0.207_784_955_007_898_47,
];
/// Kronrod weights of the nodes, and of the centre.
const KRONROD: [f64; 7] = [
    0.022_935_322_010_529_224,
    0.063_092_092_629_978_55,
    0.104_790_010_322_250_18,
    0.140_653_259_715_525_92,
    0.169_004_726_639_267_9,
    0.190_350_578_064_785_4,
    0.204_432_940_075_298_9,
];
/// See `KRONROD`.
const KRONROD_CENTRE: f64 = 0.209_482_141_084_727_82;
/// Gauss weights of every second node, and of the centre.
const GAUSS: [f64; 3] = [
    0.129_484_966_168_869_7,
    0.279_705_391_489_276_64,
    0.381_830_050_505_118_9,
];
/// See `GAUSS`.
const GAUSS_CENTRE: f64 = 0.417_959_183_673_469_4;

/// The integral of `f` from `from` to `to`.
pub(super) fn integral(f: impl Fn(f64) -> f64, from: f64, to: f64) -> f64 {
    let (whole, error, magnitude) = rule(&f, from, to);
    if !whole.is_finite() || error <= TOLERANCE * magnitude {
        return whole;
    }
    let allowed = TOLERANCE * magnitude / (to - from);
    let mut budget = BUDGET;
    let mut sum = 0.0;
    let mut stack = ArrayVec::<(f64, f64), 64>::new();
    stack.push((from, to));
    while let Some((a, b)) = stack.pop() {
        let (value, error, _) = rule(&f, a, b);
        let middle = 0.5 * (a + b);
        let divisible = a < middle && middle < b && stack.remaining_capacity() >= 2;
        if error <= allowed * (b - a) || !divisible || budget == 0 {
            sum += value;
        } else {
            budget -= 1;
            stack.push((middle, b));
            stack.push((a, middle));
        }
    }
    sum
}

/// The integral by the Kronrod rule, its error, and the integral of |f|.
///
/// The error is QUADPACK's estimate from the difference of the two rules, which
/// takes into account how much faster the longer one converges.
fn rule(f: &impl Fn(f64) -> f64, from: f64, to: f64) -> (f64, f64, f64) {
    let (centre, half) = (0.5 * (from + to), 0.5 * (to - from));
    let middle = f(centre);
    let (mut kronrod, mut gauss) = (KRONROD_CENTRE * middle, GAUSS_CENTRE * middle);
    let mut magnitude = kronrod.abs();
    for (i, node) in NODES.into_iter().enumerate() {
        let (low, high) = (f(centre - half * node), f(centre + half * node));
        kronrod += KRONROD[i] * (low + high);
        magnitude += KRONROD[i] * (low.abs() + high.abs());
        if i % 2 == 1 {
            gauss += GAUSS[i / 2] * (low + high);
        }
    }
    let share = if magnitude > 0.0 {
        f64::min(200.0 * (kronrod - gauss).abs() / magnitude, 1.0)
    } else {
        0.0
    };
    let error = magnitude * share * share.sqrt();
    (kronrod * half, error * half, magnitude * half)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn smooth_and_kinked_functions() {
        let sine = integral(libm::sin, 0.0, std::f64::consts::PI);
        assert!((sine - 2.0).abs() < 1e-13);
        let kinked = integral(|t: f64| (t - 0.3).abs(), 0.0, 1.0);
        assert!((kinked - 0.29).abs() < 1e-9);
    }

    #[test]
    fn what_overflows_ends() {
        assert!(!integral(|_| f64::INFINITY, 0.0, 1.0).is_finite());
    }
}
