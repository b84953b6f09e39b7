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

/// Runs a section over a signal, in steady state for its first value.
fn run(section: Section, x: &mut [f64]) {
    let [b0, b1, b2, a1, a2] = section;
    let first = x.first().copied().unwrap_or_default();
    // Direct form II transposed; gain 1 at rest.
    let mut s1 = first * (1.0 - b0);
    let mut s2 = first * (b2 - a2);
    for value in x {
        let y = b0 * *value + s1;
        s1 = b1 * *value - a1 * y + s2;
        s2 = b2 * *value - a2 * y;
        *value = y;
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
    for _ in 0..2 {
        for section in butterworth(corner_hz, period_s) {
            run(section, &mut long);
        }
        long.reverse();
    }
    long.into_iter().skip(before).take(n).collect()
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
    let inner: Vec<f64> = x
        .windows(5)
        .map(|w| w.iter().zip(weights).map(|(x, k)| x * k).sum::<f64>() / scale)
        .collect();
    let (Some(first), Some(last)) = (inner.first().copied(), inner.last().copied()) else {
        return vec![0.0; x.len()];
    };
    let mut out = vec![first; 2];
    out.extend(inner);
    out.extend([last; 2]);
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
