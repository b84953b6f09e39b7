//! Signals of which one of so many samples shows all: a recording that shows nothing
//! above some frequency is compared with models on fewer rows.
//!
//! Both signals go through the same low-pass, which leaves a model between them as
//! it is. Its response is the root of a raised cosine: sampled once in so many
//! periods, what it makes of white noise is white again (Nyquist's criterion), and a
//! sum of squares by rows shows as much as before.

use std::f64::consts::PI;

use super::data::{Data, Signals};

/// The share of the band up to Nyquist's frequency over which the low-pass falls, to
/// either side of it.
const ROLL_OFF: f64 = 0.3;
/// Its length to either side of the middle, in rows.
const REACH: usize = 8;
/// Points on which its response is summed up.
const POINTS: usize = 400;
/// One of so many samples at most, and no fewer rows than this.
const EVERY_MAX: usize = 8;
const ROWS_MIN: usize = 1500;

/// The signals after the low-pass.
pub struct FewerRows {
    signals: Signals,
    every: usize,
}

impl FewerRows {
    /// Of a recording that shows the axis up to `band_rad_s`. `None` where all samples
    /// are needed.
    #[must_use]
    pub fn of(data: &Data<'_>, band_rad_s: f64) -> Option<Self> {
        let passed = (1.0 - ROLL_OFF) * PI / (band_rad_s * data.period_s);
        let most = EVERY_MAX.min(data.len() / ROWS_MIN);
        let every = (passed.min(most as f64)) as usize;
        if every < 2 {
            return None;
        }
        let taps = low_pass(every);
        Some(Self {
            signals: Signals::filtered(data, |x| filtered(x, &taps)),
            every,
        })
    }

    /// What was recorded, with these signals.
    #[must_use]
    pub fn data<'a>(&'a self, data: &Data<'a>) -> Data<'a> {
        Data {
            every: self.every,
            ..self.signals.data(data)
        }
    }
}

/// The taps of the low-pass, of unit sum of squares: their distance from the middle
/// counts in samples.
fn low_pass(every: usize) -> Vec<f64> {
    let reach = REACH * every;
    // Up to the end of its band, by the middles of equal parts.
    let edge = (1.0 + ROLL_OFF) / every as f64;
    let parts: Vec<(f64, f64)> = (0..POINTS)
        .map(|point| {
            let share = (point as f64 + 0.5) / POINTS as f64;
            let of_nyquist = share * (1.0 + ROLL_OFF);
            let falls = ((of_nyquist - 1.0 + ROLL_OFF) / (2.0 * ROLL_OFF)).max(0.0);
            (PI * share * edge, libm::cos(0.5 * PI * falls))
        })
        .collect();
    let taps: Vec<f64> = (0..=2 * reach)
        .map(|tap| {
            let samples = tap as f64 - reach as f64;
            let each = parts
                .iter()
                .map(|(theta, size)| size * libm::cos(theta * samples));
            each.sum()
        })
        .collect();
    let squares: f64 = taps.iter().map(|tap| tap * tap).sum();
    let scale = 1.0 / squares.sqrt();
    taps.iter().map(|tap| tap * scale).collect()
}

/// A signal after a symmetrical filter, where all of it is known.
fn filtered(x: &[f64], taps: &[f64]) -> Vec<f64> {
    let windows = x.windows(taps.len());
    windows
        .map(|window| window.iter().zip(taps).map(|(x, tap)| x * tap).sum())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows of white noise have nothing to do with one another, and what is slow
    /// passes.
    #[test]
    fn noise_stays_white() {
        for every in 2..=EVERY_MAX {
            let taps = low_pass(every);
            for apart in 0..2 * REACH {
                let later = taps.iter().skip(apart * every);
                let sum: f64 = taps.iter().zip(later).map(|(x, y)| x * y).sum();
                let white = if apart == 0 { 1.0 } else { 0.0 };
                assert!((sum - white).abs() < 0.004, "{every} {apart} {sum}");
            }
            for (share, least) in [(0.0, 0.99), (0.5, 0.99), (1.0 - ROLL_OFF, 0.95)] {
                let theta = share * PI / every as f64;
                let reach = (taps.len() / 2) as f64;
                let each = taps.iter().enumerate();
                let sum: f64 = each
                    .map(|(k, tap)| tap * libm::cos(theta * (k as f64 - reach)))
                    .sum();
                let power = sum * sum / every as f64;
                assert!((least..1.02).contains(&power), "{every} {share} {power}");
            }
        }
    }
}
