//! Filters without delay, and derivatives.

use std::f64::consts::PI;

/// A second-order section: `b0 b1 b2 a1 a2`.
type Section = [f64; 5];

/// The two sections of a low-pass of fourth order (Butterworth, by the bilinear
/// transformation with the corner kept).
fn butterworth(corner_hz: f64, period_s: f64) -> [Section; 2] {
    let w = libm::tan(PI * (corner_hz * period_s).min(0.49));
    // Poles at ±22.5° and ±67.5° from the negative axis.
    [PI / 8.0, 3.0 * PI / 8.0].map(|angle| {
        let damping = libm::cos(angle);
        let scale = 1.0 / (1.0 + 2.0 * damping * w + w * w);
        [
            w * w * scale,
            2.0 * w * w * scale,
            w * w * scale,
            2.0 * (w * w - 1.0) * scale,
            (1.0 - 2.0 * damping * w + w * w) * scale,
        ]
    })
}

/// A section with what it holds: direct form II transposed, of gain 1 at rest.
struct Running {
    section: Section,
    held: [f64; 2],
}

impl Running {
    /// In steady state for a first value.
    fn new(section: Section, first: f64) -> Self {
        let [b0, _, b2, _, a2] = section;
        Self {
            section,
            held: [first * (1.0 - b0), first * (b2 - a2)],
        }
    }

    fn next(&mut self, x: f64) -> f64 {
        let [b0, b1, b2, a1, a2] = self.section;
        let [s1, s2] = self.held;
        let y = b0 * x + s1;
        self.held = [b1 * x - a1 * y + s2, b2 * x - a2 * y];
        y
    }
}

/// Runs one section after the other over a signal. Both go on in one pass: what the one
/// waits for, the other fills.
fn run<'a>([one, two]: [Section; 2], mut x: impl Iterator<Item = &'a mut f64>) {
    let Some(first) = x.next() else {
        return;
    };
    let mut one = Running::new(one, *first);
    let y = one.next(*first);
    let mut two = Running::new(two, y);
    *first = two.next(y);
    for value in x {
        *value = two.next(one.next(*value));
    }
}

/// Low-pass of fourth order, forwards and backwards: no delay. The signal is
/// continued at both ends by its own mirror image.
#[must_use]
pub fn low_pass(x: &[f64], corner_hz: f64, period_s: f64) -> Vec<f64> {
    let n = x.len();
    let pad = ((3.0 / (corner_hz * period_s)) as usize).min(n.saturating_sub(1));
    let (Some(first), Some(last)) = (x.first(), x.last()) else {
        return Vec::new();
    };
    let mut long = Vec::with_capacity(n + 2 * pad);
    long.extend(x.iter().skip(1).take(pad).rev().map(|v| 2.0 * first - v));
    let before = long.len();
    long.extend_from_slice(x);
    long.extend(x.iter().rev().skip(1).take(pad).map(|v| 2.0 * last - v));
    let sections = butterworth(corner_hz, period_s);
    run(sections, long.iter_mut());
    run(sections, long.iter_mut().rev());
    long.drain(..before);
    long.truncate(n);
    long
}

/// First derivative by five points (error of fourth order); the two values at
/// each end are those next to them.
#[must_use]
pub fn derivative(x: &[f64], period_s: f64) -> Vec<f64> {
    stencil(x, [1.0, -8.0, 0.0, 8.0, -1.0], 12.0 * period_s)
}

/// Second derivative by five points.
#[must_use]
pub fn second_derivative(x: &[f64], period_s: f64) -> Vec<f64> {
    stencil(
        x,
        [-1.0, 16.0, -30.0, 16.0, -1.0],
        12.0 * period_s * period_s,
    )
}

fn stencil(x: &[f64], weights: [f64; 5], scale: f64) -> Vec<f64> {
    let sum = |w: &[f64]| w.iter().zip(weights).map(|(x, k)| x * k).sum::<f64>() / scale;
    let (Some(first), Some(last)) = (x.first_chunk::<5>(), x.last_chunk::<5>()) else {
        return vec![0.0; x.len()];
    };
    let mut out = Vec::with_capacity(x.len());
    out.extend([sum(first); 2]);
    out.extend(x.windows(5).map(sum));
    out.extend([sum(last); 2]);
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn low_pass_keeps_slow_and_takes_fast_without_delay() {
        let t = 1e-3;
        let wave = |hz: f64| -> Vec<f64> {
            (0..4000)
                .map(|k| libm::sin(2.0 * PI * hz * f64::from(k) * t))
                .collect()
        };
        let slow = wave(3.0);
        let out = low_pass(&slow, 50.0, t);
        let worst = slow
            .iter()
            .zip(&out)
            .skip(200)
            .take(3600)
            .map(|(a, b)| (a - b).abs());
        assert!(worst.fold(0.0, f64::max) < 1e-6);
        // Forwards and backwards: 1/(1 + (300/50)^8) of it is left.
        let fast = low_pass(&wave(300.0), 50.0, t);
        assert!(fast.iter().skip(200).take(3600).all(|x| x.abs() < 1e-6));
    }

    #[test]
    fn derivatives_of_a_sine() {
        let t = 1e-3;
        let w = 2.0 * PI * 10.0;
        let x: Vec<f64> = (0..500).map(|k| libm::sin(w * f64::from(k) * t)).collect();
        let (v, a) = (derivative(&x, t), second_derivative(&x, t));
        for k in (2..498).step_by(50) {
            let phase = w * k as f64 * t;
            assert!((v[k] / w - libm::cos(phase)).abs() < 1e-6);
            assert!((a[k] / (w * w) + libm::sin(phase)).abs() < 1e-6);
        }
    }
}
