//! How accurate the estimates are, and how honest their errors.

use gwatt::identify::flexible::{self, Method};
use gwatt::identify::{Factor, TransferFunction};

use super::{
    PERIOD_S, choice, errors, held_m_sequence, noisy_recording, one_side, random, two_sides,
};

/// Samples that each step of the M-sequence is held: one and a half periods of
/// an anti-resonance at 40 Hz. The first side lobe of the spectrum then lies on
/// it, and nine tenths of the power lie below, where the inertia shows.
const HOLD: usize = 37;

/// What tests/identify/reference.py works out with `SciPy`: the bound of Cramér and
/// Rao on the relative errors of ω and ζ of each anti-resonance and of J at last.
const ONE_LIGHT: [f64; 3] = [4.502e-4, 1.7688e-2, 9.768e-4];
const TWO_LIGHT: [f64; 5] = [5.215e-4, 1.9189e-2, 6.182e-4, 2.2935e-2, 1.0599e-3];

/// Standard errors are as small as any estimate's can be, and say what the
/// errors are.
#[test]
fn errors_are_as_small_as_the_noise_allows() {
    for (axis, least, seeds) in [
        (one_side(), &ONE_LIGHT[..], 5),
        (two_sides(), &TWO_LIGHT[..], 2),
    ] {
        let torque = held_m_sequence(4000, HOLD);
        let mut sum = 0.0;
        for seed in 0..seeds {
            let recording = noisy_recording(&axis, &torque, 0.05, seed);
            let found = flexible::identify(&recording, &choice(Method::Iv)).unwrap();
            for ((error, std), least) in errors(&axis, &found).into_iter().zip(least) {
                // Worked out where the estimate is, with the damping it found.
                assert!((std / least - 1.0).abs() < 0.12, "{std} {least}");
                sum += (error / std) * (error / std);
            }
        }
        // χ² by its degrees of freedom; figures of one seed are correlated a little.
        let mean = sum / (seeds as f64 * least.len() as f64);
        assert!((0.3..2.2).contains(&mean), "{mean}");
    }
}

/// Beyond the band of the excitation fast modes, delays and lags are hard to find
/// apart: none of them may take a part of the damping of what shows.
#[test]
fn what_lies_beyond_the_band_does_not_move_the_zero() {
    let late = TransferFunction {
        delay_s: 3.0 * PERIOD_S,
        ..one_side()
    };
    let mut lagging = one_side();
    lagging.poles.push(Factor::Real {
        time_constant_s: 0.8 * PERIOD_S,
    });
    for (axis, samples, to_hz, noise, seed) in [
        (one_side(), 16_000, 45.0, 0.2, 125),
        (late, 4000, 45.0, 0.05, 5),
        (lagging, 4000, 100.0, 0.2, 1),
    ] {
        let recording = noisy_recording(&axis, &random(samples, to_hz), noise, seed);
        let found = flexible::identify(&recording, &choice(Method::Iv)).unwrap();
        let errors = errors(&axis, &found);
        for (error, std) in &errors {
            assert!(error.abs() < 4.0 * std, "{errors:?}, {:?}", found.transfer);
        }
        assert!(errors[0].1 < 2e-3 && errors[1].1 < 0.1, "{errors:?}");
    }
}

/// Accuracy and honesty over 1000 seeds; half an hour. One anti-resonance is excited
/// by what ends a tenth above it, two at once by an M-sequence.
#[test]
#[ignore = "takes half an hour: cargo test --release -- --ignored seeds"]
fn a_thousand_seeds_are_as_accurate_as_promised() {
    const SEEDS: u64 = 1000;
    let count = |seconds: f64| (seconds / PERIOD_S) as usize;
    for (axis, seconds, noise, promised) in [
        (one_side(), 4.0, 0.05, &[5e-4, 2.5e-2, 1e-3][..]),
        (one_side(), 16.0, 0.2, &[1e-3, 4e-2, 3e-3]),
        (two_sides(), 4.0, 0.05, &[1e-3, 5e-2, 1e-3, 5e-2, 2e-3]),
        (two_sides(), 16.0, 0.2, &[2e-3, 8e-2, 2e-3, 8e-2, 6e-3]),
    ] {
        let torque = if promised.len() == 3 {
            random(count(seconds), 45.0)
        } else {
            held_m_sequence(count(seconds), HOLD)
        };
        let mut squares = vec![0.0; promised.len()];
        let mut inside = vec![0; promised.len()];
        for seed in 0..SEEDS {
            let recording = noisy_recording(&axis, &torque, noise, seed);
            let found = flexible::identify(&recording, &choice(Method::Iv)).unwrap();
            for (index, (error, std)) in errors(&axis, &found).into_iter().enumerate() {
                squares[index] += error * error / SEEDS as f64;
                inside[index] += usize::from(error.abs() <= 2.0 * std);
            }
        }
        let rms: Vec<f64> = squares.into_iter().map(f64::sqrt).collect();
        println!("{seconds} s, noise {noise}: rms {rms:?}, inside {inside:?} of {SEEDS}");
        for (rms, promised) in rms.iter().zip(promised) {
            assert!(rms <= promised, "noise {noise}: {rms} > {promised}");
        }
        // 200 seeds scatter by 3 about the 95.4 % that normal errors have: of the first
        // 200 of these, 198 are inside for the second zero's frequency even where the
        // model is known and only linearised. A thousand are enough.
        for count in inside {
            assert!(
                (930..=970).contains(&count),
                "noise {noise}: {count} of {SEEDS}"
            );
        }
    }
}

/// A sweep shows each mode once: its second half counts as well when models are
/// compared.
#[test]
fn what_a_sweep_shows_last_is_found() {
    const SECONDS: f64 = 16.0;
    let ratio = libm::log(120.0 / 2.0);
    let torque: Vec<f64> = (0..16_000)
        .map(|k| {
            let grown = libm::expm1(ratio * f64::from(k) / 16_000.0);
            libm::sin(std::f64::consts::TAU * 2.0 * SECONDS / ratio * grown)
        })
        .collect();
    for axis in [one_side(), two_sides()] {
        let recording = noisy_recording(&axis, &torque, 0.05, 1);
        let found = flexible::identify(&recording, &choice(Method::Iv)).unwrap();
        for (error, std) in errors(&axis, &found) {
            assert!(
                error.abs() < 4.0 * std,
                "{error} {std} {:?}",
                found.transfer
            );
        }
    }
}
