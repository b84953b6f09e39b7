//! Signals that excite: what they cover.

use std::f64::consts::TAU;

use gwatt::identify::excitation::{Shape, make};

use super::{PERIOD_S, random};

/// Amplitude of a line of the spectrum.
fn line(x: &[f64], hz: f64) -> f64 {
    let (mut re, mut im) = (0.0, 0.0);
    for (k, x) in x.iter().enumerate() {
        let (sin, cos) = libm::sincos(TAU * hz * PERIOD_S * k as f64);
        re += x * cos;
        im += x * sin;
    }
    2.0 * libm::hypot(re, im) / x.len() as f64
}

#[test]
fn a_random_signal_is_flat_in_its_band_and_nothing_outside() {
    let signal = random(4000, 45.0);
    let inside = line(&signal, 10.0);
    for hz in [1.0, 2.25, 20.5, 44.75] {
        assert!((line(&signal, hz) / inside - 1.0).abs() < 1e-6, "{hz}");
    }
    for hz in [0.5, 46.0, 100.0, 400.0] {
        assert!(line(&signal, hz) < 1e-9 * inside, "{hz}");
    }
    assert_eq!(signal.iter().fold(0.0_f64, |a, x| a.max(x.abs())), 1.0);
}

#[test]
fn a_sweep_passes_its_frequencies_at_even_factors_or_steps() {
    for (logarithmic, middle_hz) in [(true, 20.0), (false, 50.5)] {
        let shape = Shape::Sweep {
            from_hz: 4.0,
            to_hz: if logarithmic { 100.0 } else { 97.0 },
            seconds: 20.0,
            logarithmic,
        };
        let signal = make(shape, 2.0, PERIOD_S).unwrap();
        assert!(signal.peak <= 2.0 && signal.peak > 1.99);
        assert!((signal.rms - std::f64::consts::SQRT_2).abs() < 0.02);
        // Turns within the second in the middle.
        let part = &signal.values[9_500..10_500];
        let ups = part.windows(2).filter(|w| w[0] < 0.0 && w[1] >= 0.0);
        let found = ups.count() as f64;
        assert!((found - middle_hz).abs() <= 1.0, "{found} {middle_hz}");
    }
}
