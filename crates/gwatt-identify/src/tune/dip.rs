//! Dips of a measured frequency response: where an axis has an anti-resonance.

use crate::certainty;
use crate::spectrum::FrequencyResponse;

/// A minimum of the smoothed gain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dip {
    /// Where, Hz.
    pub frequency_hz: f64,
    /// The smoothed gain there.
    pub gain: f64,
    /// How far below the lower of the two shoulders next to it, dB.
    pub depth_db: f64,
}

/// Shallower minima are ripple.
const DEPTH_DB: f64 = 3.0;
/// Half the width of the moving average: this share of the frequency, and at
/// least one sample.
const WIDTH: f64 = 0.01;

/// The minima of the gain, smoothed by a moving average, in ascending order.
///
/// A minimum counts by its shoulders: on either side the largest gain before
/// the gain falls below the minimum again.
#[must_use]
pub fn dips(response: &FrequencyResponse) -> Vec<Dip> {
    let gain = smoothed(response, |g, _| g.norm());
    let noise = smoothed(response, |_, variance| variance.max(0.0).sqrt());
    let mut dips = Vec::new();
    for (index, here) in gain.iter().enumerate() {
        let Some(((before, after), frequency_hz)) = gain
            .get(..index)
            .zip(gain.get(index + 1..))
            .zip(response.frequency_hz.get(index).copied())
        else {
            continue;
        };
        let is_least =
            before.last().is_some_and(|g| g > here) && after.first().is_some_and(|g| g >= here);
        if !is_least {
            continue;
        }
        let (Some(noise_before), Some(noise_after)) = (noise.get(..index), noise.get(index + 1..))
        else {
            continue;
        };
        let left = shoulder(before.iter().zip(noise_before).rev(), *here);
        let right = shoulder(after.iter().zip(noise_after), *here);
        let depth_db = 20.0 * libm::log10(left.min(right) / here.max(f64::MIN_POSITIVE));
        if depth_db >= DEPTH_DB {
            dips.push(Dip {
                frequency_hz,
                gain: *here,
                depth_db,
            });
        }
    }
    dips
}

/// The largest gain that stands out of the noise, before it falls below `least`.
/// Beyond the band of the excitation there is nothing but noise.
fn shoulder<'a>(points: impl Iterator<Item = (&'a f64, &'a f64)>, least: f64) -> f64 {
    points
        .take_while(|(gain, _)| **gain >= least)
        .filter(|(gain, noise)| **gain > certainty::SHOULDER * **noise)
        .map(|(gain, _)| *gain)
        .fold(0.0, f64::max)
}

fn smoothed(
    response: &FrequencyResponse,
    value: impl Fn(nalgebra::Complex<f64>, f64) -> f64,
) -> Vec<f64> {
    let values: Vec<f64> = response
        .response
        .iter()
        .zip(&response.variance)
        .map(|(g, variance)| value(*g, *variance))
        .collect();
    let resolution_hz = response
        .frequency_hz
        .first()
        .zip(response.frequency_hz.get(1))
        .map_or(1.0, |(a, b)| b - a);
    // Running sums, so that wide averages cost no more than narrow ones.
    let mut sums = vec![0.0];
    let mut sum = 0.0;
    for value in &values {
        sum += value;
        sums.push(sum);
    }
    let n = values.len();
    response
        .frequency_hz
        .iter()
        .take(n)
        .enumerate()
        .map(|(index, hz)| {
            let half = ((WIDTH * hz / resolution_hz) as usize).max(1);
            let half = half.min(index).min(n - 1 - index);
            let (from, to) = (index - half, index + half + 1);
            match (sums.get(from), sums.get(to)) {
                (Some(a), Some(b)) => (b - a) / (to - from) as f64,
                _ => 0.0,
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Complex;

    fn measured(gain: impl Fn(f64) -> f64, noise: f64) -> FrequencyResponse {
        let frequency_hz: Vec<f64> = (1..400).map(f64::from).collect();
        FrequencyResponse {
            response: frequency_hz
                .iter()
                .map(|hz| Complex::new(gain(*hz), 0.0))
                .collect(),
            coherence: vec![1.0; frequency_hz.len()],
            power: Vec::new(),
            variance: vec![noise * noise; frequency_hz.len()],
            frequency_hz,
            periodic: true,
            noise_values: 0,
        }
    }

    #[test]
    fn a_dip_has_two_shoulders_that_stand_out_of_the_noise() {
        let dip = |hz: f64| 1.0 - 0.9 / (1.0 + (hz - 40.0) * (hz - 40.0) / 9.0);
        let found = dips(&measured(dip, 0.01));
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].frequency_hz, 40.0);
        // The average over three samples: 1 - 0.9·(1 + 2·0.9)/3 = 0.16.
        assert!((found[0].depth_db - 15.9).abs() < 0.1, "{found:?}");
        assert!(dips(&measured(dip, 0.4)).is_empty());
        // Beyond 60 Hz nothing was excited: loud, and all noise.
        let mut ends = measured(dip, 0.01);
        for k in 60..ends.response.len() {
            ends.response[k] = Complex::new(5.0, 0.0);
            ends.variance[k] = 100.0;
        }
        assert_eq!(dips(&ends).len(), 1);
        // A fall without end is no dip, nor is ripple.
        assert!(dips(&measured(|hz| 1.0 / hz, 0.0)).is_empty());
        assert!(dips(&measured(|hz| 1.0 + 0.1 * libm::sin(hz / 5.0), 0.0)).is_empty());
        assert!(dips(&FrequencyResponse::default()).is_empty());
    }
}
