//! How often figures lie within two of their standard errors, where what is left is not
//! white noise.

use std::f64::consts::TAU;

use gwatt_identify::flexible::{self, Choice, Flexible, Method};
use gwatt_identify::{
    Factor, Figure, Given, Judgement, Measured, Quantity, TransferFunction, judgement, simulate,
};

use crate::simulated::{PERIOD_S, Random, recording};

fn pair(hz: f64, damping: f64) -> Factor {
    Factor::Pair {
        omega_rad_s: TAU * hz,
        damping,
    }
}

fn axis() -> TransferFunction {
    TransferFunction {
        gain: 1.0 / 0.024,
        zeros: vec![pair(40.0, 0.03)],
        poles: vec![pair(49.0, 0.037)],
        delay_s: 0.0,
    }
}

fn torque(samples: usize, random: &mut Random) -> Vec<f64> {
    let lines: Vec<[f64; 2]> = (0..390)
        .map(|k| [0.25 * f64::from(k + 4), random.uniform(0.0, TAU)])
        .collect();
    let at = |k: usize| {
        let t = k as f64 * PERIOD_S;
        let each = lines.iter();
        each.map(|[hz, phase]| 0.05 * libm::cos(TAU * hz * t + phase))
            .sum()
    };
    (0..samples).map(at).collect()
}

fn by(method: Method, torque: Vec<f64>, motion: Vec<f64>) -> Flexible {
    let choice = Choice {
        method,
        given: Given {
            delay_s: Some(0.0),
            ..Given::default()
        },
        from_command: false,
    };
    let recording = recording(torque, motion, Quantity::Acceleration);
    flexible::identify(&recording, &choice).unwrap()
}

fn holds(figure: Figure, truth: f64) -> bool {
    (figure.value - truth).abs() <= 2.0 * figure.std
}

/// How many of the figures of one recording hold, of how many.
fn held(found: &Flexible) -> [usize; 2] {
    let mut all = vec![holds(found.inertia.unwrap(), 0.024)];
    for (root, [hz, damping]) in [
        (found.zeros.first(), [40.0, 0.03]),
        (found.poles.first(), [49.0, 0.037]),
    ] {
        let root = root.unwrap();
        all.push(holds(root.omega_rad_s, TAU * hz));
        all.push(holds(root.damping, damping));
    }
    [all.iter().filter(|held| **held).count(), all.len()]
}

/// Noise of the acceleration that an AR process colours, and what its squares add up to
/// as a share of the motion's.
fn coloured(samples: usize, pole: f64, share: f64, clean: &[f64], random: &mut Random) -> Vec<f64> {
    let mut at = 0.0;
    let noise: Vec<f64> = (0..samples)
        .map(|_| {
            at = pole * at + random.normal();
            at
        })
        .collect();
    let squares = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>();
    let scale = share * (squares(clean) / squares(&noise)).sqrt();
    clean
        .iter()
        .zip(noise)
        .map(|(a, n)| a + scale * n)
        .collect()
}

const SAMPLES: usize = 16_000;

/// Figures that hold in `cases` recordings with coloured noise, of how many.
fn share_that_holds(method: Method, pole: f64, cases: u64) -> [usize; 2] {
    let mut sums = [0; 2];
    for seed in 0..cases {
        let mut random = Random(100 + seed);
        // Four periods, of which the first is left out by the frequency response.
        let torque = torque(SAMPLES, &mut random);
        let clean = simulate(&axis(), Measured::Direct, PERIOD_S, &torque).unwrap();
        let motion = coloured(SAMPLES, pole, 0.1, &clean, &mut random);
        let [held, all] = held(&by(method, torque, motion));
        sums = [sums[0] + held, sums[1] + all];
    }
    sums
}

/// Noise that is strongest where motion is slow, or where it is fast. Of 300 figures of which
/// 95.4 % hold, 92 % do at least but for once in a hundred times.
#[test]
#[ignore = "minutes"]
fn errors_hold_next_to_coloured_noise() {
    for (method, pole) in [
        (Method::Iv, 0.9),
        (Method::Iv, 0.5),
        (Method::Iv, -0.8),
        (Method::Frequency, 0.9),
        (Method::Frequency, 0.5),
    ] {
        let [held, all] = share_that_holds(method, pole, 60);
        let share = held as f64 / all as f64;
        println!("{method:?} {pole}: {held} of {all}, {share:.3}");
        assert!(share >= 0.92, "{method:?} {pole}: {held} of {all}");
    }
}

/// A mode that the model has no place for: errors that hold, or no "good".
#[test]
fn what_a_model_misses_widens_its_errors() {
    let mut random = Random(5);
    let torque = torque(8000, &mut random);
    let mut axis = axis();
    axis.zeros.push(pair(70.0, 0.02));
    axis.poles.push(pair(72.0, 0.02));
    let clean = simulate(&axis, Measured::Direct, PERIOD_S, &torque).unwrap();
    let motion = coloured(8000, 0.0, 0.01, &clean, &mut random);
    let given = |order| Choice {
        method: Method::Iv,
        given: Given {
            order,
            delay_s: Some(0.0),
            ..Given::default()
        },
        from_command: false,
    };
    let recording = recording(torque, motion, Quantity::Acceleration);
    let whole = flexible::identify(&recording, &given(Some(4))).unwrap();
    assert_eq!(whole.missed_energy, 0.0);
    assert_eq!(judgement::flexible(&whole), Judgement::Good);
    let less = flexible::identify(&recording, &given(Some(2))).unwrap();
    assert!(less.missed_energy > 100.0, "{}", less.missed_energy);
    let std = |found: &Flexible| found.inertia.unwrap().std;
    assert!(std(&less) > 5.0 * std(&whole));
    let [held, all] = held(&less);
    assert!(
        held == all || judgement::flexible(&less) != Judgement::Good,
        "{held} of {all}"
    );
}

/// By a frequency response without three periods: no errors, and no "good".
#[test]
fn what_does_not_repeat_itself_has_no_errors_by_its_frequency_response() {
    let mut random = Random(9);
    let torque = torque(10_000, &mut random);
    let clean = simulate(&axis(), Measured::Direct, PERIOD_S, &torque).unwrap();
    let motion = coloured(10_000, 0.0, 0.05, &clean, &mut random);
    let found = by(Method::Frequency, torque, motion);
    assert!(!found.has_errors && found.inertia.unwrap().std.is_nan());
    assert_eq!(judgement::flexible(&found), Judgement::NoErrors);
}
