//! Sines at many frequencies with a small peak.
//!
//! Phases begin as Schroeder's (1970, *Synthesis of low-peak-factor signals and binary
//! sequences with low autocorrelation*), after which the peaks are cut off and the
//! amplitudes put back, again and again (van der Ouderaa, Schoukens & Renneboog 1988). Lines
//! above all that are asked for may keep what the cuts made of them: a steeper signal has a
//! smaller peak, and half as much power again where it is wanted ("snow lines", Guillaume,
//! Schoukens, Pintelon & Kollár 1991).

use std::f64::consts::TAU;

use nalgebra::Complex;
use realfft::RealFftPlanner;

type C = Complex<f64>;

/// Rounds at most, and values that all of them go through: a long signal gets fewer.
const ROUNDS: usize = 60;
const VALUES: usize = 40_000_000;
/// Shares of the largest at which peaks are cut off, at first and at last: a deep cut at first
/// leaves the small peaks that gentle ones never find.
const CUTS: [f64; 2] = [0.5, 0.95];

/// What lines above those that are asked for have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Above {
    /// Nothing.
    Still,
    /// What makes the peak smaller.
    Free,
}

/// One period of `count` samples whose lines have these amplitudes, from bin 0 on, with
/// a peak of 1. `None` where there are none.
pub(super) fn multisine(amplitudes: &[f64], count: usize, above: Above) -> Option<Vec<f64>> {
    let mut planner = RealFftPlanner::<f64>::new();
    let (forward, backward) = (
        planner.plan_fft_forward(count),
        planner.plan_fft_inverse(count),
    );
    let mut spectrum = backward.make_input_vec();
    let mut values = backward.make_output_vec();
    let total: f64 = amplitudes.iter().map(|a| a * a).sum();
    if !(total > 0.0 && total.is_finite()) {
        return None;
    }
    let (mut share, mut phase) = (0.0, 0.0);
    let mut kept: Vec<C> = Vec::with_capacity(spectrum.len());
    for amplitude in amplitudes.iter().take(spectrum.len()) {
        share += amplitude * amplitude / total;
        phase = (phase + share) % 2.0;
        let (sin, cos) = libm::sincos(-0.5 * TAU * phase);
        kept.push(C::new(cos, sin) * *amplitude);
    }
    kept.resize(spectrum.len(), C::default());
    let rounds = (VALUES / count.max(1)).clamp(4, ROUNDS);
    for round in 0..=rounds {
        spectrum.copy_from_slice(&kept);
        // The first line and that of half the rate are real.
        if let Some(first) = spectrum.first_mut() {
            *first = C::default();
        }
        if count.is_multiple_of(2)
            && let Some(last) = spectrum.last_mut()
        {
            *last = C::default();
        }
        backward.process(&mut spectrum, &mut values).ok()?;
        if round == rounds {
            break;
        }
        let share = CUTS[0] + (CUTS[1] - CUTS[0]) * round as f64 / rounds as f64;
        let cut = share * peak(&values);
        for x in &mut values {
            *x = x.clamp(-cut, cut);
        }
        forward.process(&mut values, &mut spectrum).ok()?;
        for (bin, (kept, moved)) in kept.iter_mut().zip(&spectrum).enumerate() {
            if above == Above::Free && bin >= amplitudes.len() {
                // Forth and back makes each line `count` times as large.
                *kept = moved / count as f64;
                continue;
            }
            let size = moved.norm();
            if size > 0.0 {
                *kept = moved * (kept.norm() / size);
            }
        }
    }
    let peak = peak(&values);
    (peak > 0.0).then(|| values.iter().map(|x| x / peak).collect())
}

fn peak(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |peak: f64, x| peak.max(x.abs()))
}

/// The same period from where the speed that it makes is nil: begun elsewhere, a mass at
/// rest would drift away.
pub(super) fn from_rest(values: &mut [f64]) {
    let mut speed = 0.0;
    let speeds: Vec<f64> = values
        .iter()
        .map(|x| {
            let before = speed;
            speed += x;
            before
        })
        .collect();
    // Midway through a held sample the speed is what its mean is about.
    let mean = speeds.iter().zip(values.iter()).map(|(v, x)| v + 0.5 * x);
    let mean = mean.sum::<f64>() / values.len().max(1) as f64;
    let at = speeds
        .iter()
        .enumerate()
        .min_by(|(_, a), (_, b)| (*a - mean).abs().total_cmp(&(*b - mean).abs()))
        .map_or(0, |(at, _)| at);
    values.rotate_left(at);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_multisine_has_its_lines_and_a_small_peak() {
        let mut amplitudes = vec![0.0; 200];
        for (bin, amplitude) in amplitudes.iter_mut().enumerate().skip(4) {
            *amplitude = if bin < 100 { 1.0 } else { 0.5 };
        }
        let x = multisine(&amplitudes, 2000, Above::Still).unwrap();
        assert_eq!(peak(&x), 1.0);
        let rms = (x.iter().map(|x| x * x).sum::<f64>() / 2000.0).sqrt();
        // 0.68; Schroeder's phases alone leave 0.42, random ones about 1/4.
        assert!(rms > 0.66, "{rms}");
        let line = |bin: usize| {
            let sum: C = x.iter().enumerate().fold(C::default(), |sum, (k, x)| {
                let (sin, cos) = libm::sincos(TAU * (bin * k % 2000) as f64 / 2000.0);
                sum + C::new(cos, -sin) * *x
            });
            sum.norm()
        };
        let of_first = line(10);
        assert!((line(150) / of_first - 0.5).abs() < 1e-9);
        assert!(line(300) < 1e-9 * of_first && line(2) < 1e-9 * of_first);
    }

    #[test]
    fn a_period_begins_where_it_makes_no_speed() {
        // A cosine makes a sine of speed: from rest it comes back.
        let mut x: Vec<f64> = (0..100)
            .map(|k| libm::sin(TAU * f64::from(k) / 100.0))
            .collect();
        from_rest(&mut x);
        let (mut v, mut s) = (0.0, 0.0);
        for x in &x {
            s += v + 0.5 * x;
            v += x;
        }
        // Without it a sine drifts by its mean speed of 100/2π a sample, 1592 in all.
        assert!(s.abs() < 60.0, "{s}");
    }

    #[test]
    fn nothing_has_no_sines() {
        assert!(multisine(&[0.0; 10], 100, Above::Still).is_none());
        assert!(multisine(&[], 100, Above::Free).is_none());
    }
}
