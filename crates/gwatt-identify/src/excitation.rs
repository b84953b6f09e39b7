//! Excitation signals.

use std::f64::consts::PI;

use nalgebra::Complex;
use realfft::RealFftPlanner;

use super::error::{IdentifyError, Outcome};

/// Samples at most.
pub const SAMPLES_MAX: usize = 20_000_000;

/// Feedback taps of shift registers that run through all states, by length 3 to
/// 20 (Golomb, *Shift Register Sequences*): bit n is always one of them.
const TAPS: [&[u32]; 18] = [
    &[3, 2],
    &[4, 3],
    &[5, 3],
    &[6, 5],
    &[7, 6],
    &[8, 6, 5, 4],
    &[9, 5],
    &[10, 7],
    &[11, 9],
    &[12, 11, 10, 4],
    &[13, 12, 11, 8],
    &[14, 13, 12, 2],
    &[15, 14],
    &[16, 15, 13, 4],
    &[17, 14],
    &[18, 11],
    &[19, 18, 17, 14],
    &[20, 17],
];

/// Shapes of signals, without amplitude.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shape {
    /// A maximum-length sequence of ±1.
    MSequence {
        /// Length of the register: the sequence has 2^order − 1 steps.
        order: u32,
        /// Samples that each step is held.
        hold: usize,
        /// How often it is repeated.
        repetitions: usize,
    },
    /// A sine whose frequency goes from one to the other.
    Sweep {
        /// From, Hz.
        from_hz: f64,
        /// To, Hz.
        to_hz: f64,
        /// Length, s.
        seconds: f64,
        /// Frequency grows by equal factors, not by equal steps.
        logarithmic: bool,
    },
    /// Random phases, a flat spectrum within a band, none outside.
    Random {
        /// From, Hz.
        from_hz: f64,
        /// To, Hz.
        to_hz: f64,
        /// Length, s.
        seconds: f64,
        /// Other seeds give other signals.
        seed: u64,
    },
}

/// A signal with what there is to know of it.
#[derive(Debug, Clone)]
pub struct Excitation {
    /// Samples.
    pub values: Vec<f64>,
    /// Sampling period, s.
    pub period_s: f64,
    /// Lowest and highest frequency with at least half of the power, Hz.
    pub band_hz: (f64, f64),
    /// Distance of its frequencies: what can be distinguished, Hz.
    pub resolution_hz: f64,
    /// Largest value.
    pub peak: f64,
    /// Root of the mean square.
    pub rms: f64,
}

/// The order whose sequence is long enough for a resolution.
#[must_use]
pub fn order_for(resolution_hz: f64, hold: usize, period_s: f64) -> Option<u32> {
    (3..=20).find(|order| {
        let steps = f64::from((1_u32 << order) - 1);
        steps * hold as f64 * period_s * resolution_hz >= 1.0
    })
}

/// Makes a signal.
///
/// # Errors
///
/// Values outside what can be made.
pub fn make(shape: Shape, amplitude: f64, period_s: f64) -> Outcome<Excitation> {
    if !(amplitude.is_finite() && amplitude > 0.0) {
        return Err(IdentifyError::new(
            format!("the amplitude {amplitude} is not positive"),
            "give a positive number",
        ));
    }
    let (values, band_hz, resolution_hz) = match shape {
        Shape::MSequence {
            order,
            hold,
            repetitions,
        } => m_sequence(order, hold, repetitions, period_s)?,
        Shape::Sweep {
            from_hz,
            to_hz,
            seconds,
            logarithmic,
        } => {
            let n = samples(from_hz, to_hz, seconds, period_s)?;
            let values = sweep(from_hz, to_hz, n, logarithmic, period_s);
            (values, (from_hz, to_hz), 1.0 / seconds)
        }
        Shape::Random {
            from_hz,
            to_hz,
            seconds,
            seed,
        } => {
            let n = samples(from_hz, to_hz, seconds, period_s)?;
            let values = random(from_hz, to_hz, n, period_s, seed)?;
            (values, (from_hz, to_hz), 1.0 / (n as f64 * period_s))
        }
    };
    let values: Vec<f64> = values.into_iter().map(|x| x * amplitude).collect();
    let square: f64 = values.iter().map(|x| x * x).sum();
    Ok(Excitation {
        peak: values.iter().fold(0.0, |peak: f64, x| peak.max(x.abs())),
        rms: (square / values.len().max(1) as f64).sqrt(),
        values,
        period_s,
        band_hz,
        resolution_hz,
    })
}

type Made = (Vec<f64>, (f64, f64), f64);

fn m_sequence(order: u32, hold: usize, repetitions: usize, period_s: f64) -> Outcome<Made> {
    let taps = order
        .checked_sub(3)
        .and_then(|index| TAPS.get(index as usize))
        .ok_or_else(|| {
            IdentifyError::new(
                format!("there is no M-sequence of order {order} here"),
                "give --order from 3 to 20",
            )
        })?;
    let steps = (1_usize << order) - 1;
    let total = steps
        .checked_mul(hold)
        .and_then(|n| n.checked_mul(repetitions))
        .filter(|n| (1..=SAMPLES_MAX).contains(n));
    let Some(total) = total else {
        return Err(IdentifyError::new(
            format!("the signal would not have between 1 and {SAMPLES_MAX} samples"),
            "choose another --order, --hold or --repeat",
        ));
    };
    let mut register: u32 = 1;
    let mut one = Vec::with_capacity(steps);
    for _ in 0..steps {
        one.push(if register & 1 == 1 { 1.0 } else { -1.0 });
        let feedback = taps
            .iter()
            .fold(0, |bit, tap| bit ^ (register >> (order - tap)))
            & 1;
        register = (register >> 1) | (feedback << (order - 1));
    }
    let values = (0..total)
        .map(|k| one.get(k / hold % steps).copied().unwrap_or_default())
        .collect();
    let step_s = hold as f64 * period_s;
    let period = steps as f64 * step_s;
    // Power of a held step falls to one half at 0.443 of its rate.
    Ok((values, (1.0 / period, 0.443 / step_s), 1.0 / period))
}

fn samples(from_hz: f64, to_hz: f64, seconds: f64, period_s: f64) -> Outcome<usize> {
    let nyquist = 0.5 / period_s;
    if !(from_hz > 0.0 && to_hz > from_hz && to_hz < nyquist) {
        return Err(IdentifyError::new(
            format!(
                "the band {from_hz} to {to_hz} Hz cannot be made at {} Hz",
                1.0 / period_s
            ),
            format!("give 0 < --from-hz < --to-hz < {nyquist}"),
        ));
    }
    let n = seconds / period_s;
    if !(n >= 16.0 && n <= SAMPLES_MAX as f64) {
        return Err(IdentifyError::new(
            format!("{seconds} s are {n:.0} samples, not between 16 and {SAMPLES_MAX}"),
            "choose another --seconds or --rate-hz",
        ));
    }
    Ok(libm::round(n) as usize)
}

fn sweep(from_hz: f64, to_hz: f64, n: usize, logarithmic: bool, period_s: f64) -> Vec<f64> {
    let seconds = n as f64 * period_s;
    let ratio = libm::log(to_hz / from_hz);
    (0..n)
        .map(|k| {
            let t = k as f64 * period_s;
            let turns = if logarithmic {
                from_hz * seconds / ratio * libm::expm1(ratio * t / seconds)
            } else {
                from_hz * t + 0.5 * (to_hz - from_hz) * t * t / seconds
            };
            libm::sin(2.0 * PI * turns)
        })
        .collect()
}

fn random(from_hz: f64, to_hz: f64, n: usize, period_s: f64, seed: u64) -> Outcome<Vec<f64>> {
    let fft = RealFftPlanner::<f64>::new().plan_fft_inverse(n);
    let mut spectrum = fft.make_input_vec();
    let mut state = seed;
    let mut lines = 0;
    for (bin, slot) in spectrum.iter_mut().enumerate() {
        let f = bin as f64 / (n as f64 * period_s);
        if f >= from_hz && f <= to_hz && 2 * bin < n {
            let (sin, cos) = libm::sincos(2.0 * PI * uniform(&mut state));
            *slot = Complex::new(cos, sin);
            lines += 1;
        }
    }
    let mut values = fft.make_output_vec();
    if lines == 0 || fft.process(&mut spectrum, &mut values).is_err() {
        return Err(IdentifyError::new(
            "the band is narrower than the resolution",
            "make the signal longer with --seconds, or the band wider",
        ));
    }
    let peak = values.iter().fold(0.0, |peak: f64, x| peak.max(x.abs()));
    Ok(values.into_iter().map(|x| x / peak).collect())
}

/// A number from 0 to 1 (`SplitMix64`, Steele, Lea & Flood 2014).
fn uniform(state: &mut u64) -> f64 {
    *state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
}

/// How far and how fast an axis goes, as a rigid mass without friction: half of
/// the distance between its ends, and the largest speed; m and m/s, or rad. A
/// force that is not zero on the average carries it away; that drift is reported
/// apart as the third figure.
#[must_use]
pub fn reach(values: &[f64], period_s: f64, mass: f64) -> (f64, f64, f64) {
    let (mut x, mut v) = (0.0_f64, 0.0_f64);
    let (mut low, mut high, mut fastest) = (0.0_f64, 0.0_f64, 0.0_f64);
    for force in values {
        let a = force / mass;
        x += (v + 0.5 * a * period_s) * period_s;
        v += a * period_s;
        low = low.min(x);
        high = high.max(x);
        fastest = fastest.max(v.abs());
    }
    (0.5 * (high - low), fastest, x.abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn m_sequences_have_full_length_and_a_flat_correlation() {
        for order in 3..=12 {
            let shape = Shape::MSequence {
                order,
                hold: 1,
                repetitions: 1,
            };
            let x = make(shape, 1.0, 1e-3).unwrap().values;
            assert_eq!(x.len(), (1 << order) - 1);
            assert_eq!(x.iter().sum::<f64>().abs(), 1.0, "order {order}");
            for lag in 1..x.len() {
                let sum: f64 = (0..x.len()).map(|k| x[k] * x[(k + lag) % x.len()]).sum();
                assert_eq!(sum, -1.0, "order {order}, lag {lag}");
            }
        }
    }

    #[test]
    fn orders_follow_from_the_resolution() {
        // 1 kHz: 1023 steps are 1.023 s.
        assert_eq!(order_for(1.0, 1, 1e-3), Some(10));
        assert_eq!(order_for(0.9, 1, 1e-3), Some(11));
        assert_eq!(order_for(1e-9, 1, 1e-3), None);
    }
}
