//! A position command as the input of a model: its speed or acceleration, and how
//! that runs between samples.
//!
//! A load whose acceleration is measured is driven by the command's, of which the
//! recording holds positions. A drive that follows joins them smoothly, as a cubic
//! spline does: its second derivative runs straight from sample to sample, its first
//! along parabolas (de Boor, *A Practical Guide to Splines*). Plain differences that
//! are held would be too weak by 1/8 of the squared angle per sample, which a model
//! makes up for by zeros and delay that the axis does not have.

use super::state_space::Measured;

/// What drives the model.
pub struct CommandInput {
    /// Coefficients of the spline, or plain differences, one for each sample.
    pub values: Vec<f64>,
    /// How they run between samples: as differences of such a measurement do.
    pub runs: Measured,
    /// By how much that comes after the command, s.
    pub late_s: f64,
}

impl CommandInput {
    /// Of positions, for a load of which this is measured. Of positions themselves
    /// as they are, held.
    #[must_use]
    pub fn spline(positions: &[f64], measured: Measured, period_s: f64) -> Self {
        let plain = Self::held(positions, measured, period_s);
        match measured {
            Measured::Position => Self {
                values: parabolas(&plain.values),
                runs: Measured::Position,
                late_s: 1.5 * period_s,
            },
            Measured::Velocity => Self {
                values: spline(&plain.values),
                runs: Measured::Position,
                late_s: 2.0 * period_s,
            },
            Measured::Direct => Self {
                values: spline(&plain.values),
                runs: Measured::Velocity,
                late_s: 2.0 * period_s,
            },
        }
    }

    /// Plain differences, held.
    #[must_use]
    pub fn held(positions: &[f64], measured: Measured, period_s: f64) -> Self {
        let times = match measured {
            Measured::Position => 0,
            Measured::Velocity => 1,
            Measured::Direct => 2,
        };
        let mut values = positions.to_vec();
        for _ in 0..times {
            values = differences(&values, period_s);
        }
        // Before them there are no samples.
        for value in values.iter_mut().take(times) {
            *value = 0.0;
        }
        Self {
            values,
            runs: Measured::Direct,
            late_s: (0.5 + 0.5 * times as f64) * period_s,
        }
    }
}

fn differences(x: &[f64], period_s: f64) -> Vec<f64> {
    let before = x.iter().take(1).chain(x);
    let pairs = x.iter().zip(before);
    pairs.map(|(x, before)| (x - before) / period_s).collect()
}

/// The coefficients of the parabolic B-splines that go through these values:
/// `(c(k−1) + 6·c(k) + c(k+1))/8 = x(k)`.
fn parabolas(x: &[f64]) -> Vec<f64> {
    through(x, 8.0_f64.sqrt() - 3.0, 8.0)
}

/// The coefficients of the cubic B-splines that go through these values:
/// `(c(k−1) + 4·c(k) + c(k+1))/6 = x(k)`, by a recursion to and fro.
fn spline(x: &[f64]) -> Vec<f64> {
    through(x, 3.0_f64.sqrt() - 2.0, 6.0)
}

/// Coefficients `c` with `(c(k−1) − (r + 1/r)·c(k) + c(k+1))/share = x(k)` for this root `r`.
fn through(x: &[f64], root: f64, share: f64) -> Vec<f64> {
    let mut out = x.to_vec();
    let mut before = x.first().map_or(0.0, |x| x / (1.0 - root));
    for slot in &mut out {
        before = *slot + root * before;
        *slot = before;
    }
    let mut after = out.last().map_or(0.0, |x| x / (1.0 - root));
    for slot in out.iter_mut().rev() {
        after = *slot + root * after;
        *slot = -share * root * after;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The spline goes through what it is made of, its ends apart.
    #[test]
    fn spline_goes_through_its_values() {
        let x: Vec<f64> = (0..60).map(|k| libm::sin(0.3 * f64::from(k * k))).collect();
        let c = spline(&x);
        for k in 1..59 {
            let through = (c[k - 1] + 4.0 * c[k] + c[k + 1]) / 6.0;
            assert!((through - x[k]).abs() < 1e-14, "{k}: {through} {}", x[k]);
        }
        assert!(spline(&[]).is_empty());
    }

    /// What is made of a sine is its speed and acceleration, where it is said to be.
    #[test]
    fn sines_come_out_as_late_as_said() {
        const T: f64 = 1e-3;
        // 60 Hz at 1 kHz.
        let w = 2.0 * std::f64::consts::PI * 60.0;
        let at = |time_s: f64| libm::sin(w * time_s);
        let positions: Vec<f64> = (0..200).map(|k| at(T * f64::from(k))).collect();
        for (measured, scale, turned_s) in [
            (Measured::Direct, -w * w, 0.0),
            (Measured::Velocity, w, 0.5 * std::f64::consts::PI / w),
        ] {
            let made = CommandInput::spline(&positions, measured, T);
            // Half a period into a knot's stretch, where the runs are known.
            let runs: &[f64] = match made.runs {
                Measured::Velocity => &[0.5, 0.5],
                _ => &[0.125, 0.75, 0.125],
            };
            for k in 100..110 {
                let now: f64 = runs
                    .iter()
                    .zip(made.values[..=k].iter().rev())
                    .map(|(run, c)| run * c)
                    .sum();
                let time_s = (k as f64 + 0.5) * T - made.late_s;
                let right = scale * at(time_s + turned_s);
                assert!(
                    (now - right).abs() < 1.5e-2 * scale.abs(),
                    "{measured:?} {now} {right}"
                );
            }
        }
    }
}
