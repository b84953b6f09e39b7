//! What a filter asks of an axis.

use super::biquad::{Biquad, Cascade, response};

/// Frequencies at which the gain is looked at.
const POINTS: u32 = 2000;
/// Samples after which a filter is at rest again, at most, and what then moves no more.
const SAMPLES_MAX: usize = 20_000;
const SETTLED: f64 = 1e-6;

/// What a filter asks for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Effort {
    /// The largest gain up to half the rate.
    pub gain: f64,
    /// Where it is, Hz.
    pub gain_hz: f64,
    /// How many times the acceleration of the command an axis is to accelerate, at most,
    /// where the command's acceleration rises in the time that is given.
    pub accel: f64,
}

impl Effort {
    /// Of sections in series. The acceleration of the command rises evenly in `rise_s`; 0
    /// for a jump.
    #[must_use]
    pub fn of(sections: &[Biquad], period_s: f64, rise_s: f64) -> Self {
        let gains = (0..=POINTS).map(|k| {
            let hz = 0.5 / period_s * f64::from(k) / f64::from(POINTS);
            (response(sections, hz, period_s).norm(), hz)
        });
        let (gain, gain_hz) = gains.fold(
            (0.0, 0.0),
            |most, next| if next.0 > most.0 { next } else { most },
        );
        Self {
            gain,
            gain_hz,
            accel: overshoot(sections, period_s, rise_s),
        }
    }
}

/// The largest value of a filtered ramp from 0 to 1.
fn overshoot(sections: &[Biquad], period_s: f64, rise_s: f64) -> f64 {
    let steps = if rise_s > 0.0 { rise_s / period_s } else { 0.0 };
    let steps = steps.min(SAMPLES_MAX as f64);
    let mut cascade = Cascade::at_rest(sections, 0.0);
    let mut most = 1.0_f64;
    let mut quiet = 0;
    for k in 0..SAMPLES_MAX + steps as usize {
        let x = if steps > 0.0 {
            ((k + 1) as f64 / steps).min(1.0)
        } else {
            1.0
        };
        let out = cascade.step(x);
        most = most.max(out.abs());
        // A filter of these lengths has come to rest where it stays at 1.
        quiet = if x >= 1.0 && (out - 1.0).abs() < SETTLED {
            quiet + 1
        } else {
            0
        };
        if quiet > 100 || !out.is_finite() {
            break;
        }
    }
    most
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_filter_asks_for_its_largest_gain() {
        // 3 − 2·z⁻¹: 1 at rest, 5 at half the rate; a jump begins with 3.
        let sections = [Biquad::of([3.0, -2.0, 0.0, 0.0, 0.0])];
        let effort = Effort::of(&sections, 1e-3, 0.0);
        assert!((effort.gain - 5.0).abs() < 1e-12 && effort.gain_hz == 500.0);
        assert!((effort.accel - 3.0).abs() < 1e-12);
        // In four samples: 1/4·3, then 2/4·3 − 1/4·2 = 1, 1.25, 1.5.
        let effort = Effort::of(&sections, 1e-3, 4e-3);
        assert!((effort.accel - 1.5).abs() < 1e-12, "{effort:?}");
        let none = Effort::of(&[], 1e-3, 0.0);
        assert_eq!((none.gain, none.accel), (1.0, 1.0));
    }
}
