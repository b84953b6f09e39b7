//! Filters for axes that are recorded with the signals proposed for them.

use std::f64::consts::PI;
use std::thread;

use gwatt_identify::design::{Bounds, Known, propose};
use gwatt_identify::excitation::{Shape, make};
use gwatt_identify::flexible::{Choice, Method};
use gwatt_identify::tune::{AxisResponse, Correction, Discretization, Tuned, Wish, of_recording};
use gwatt_identify::{Given, Measured, Quantity, TransferFunction, simulate};

use crate::simulated::{PERIOD_S, Random, plant, recording, stiff, wanted};

const BAND_HZ: f64 = 50.0;

/// Noise of the sensor, as a share of the acceleration under the M-sequence.
#[derive(Clone, Copy)]
struct Noise(f64);

/// An M-sequence, the signal that it leads to, and the axis by a recording of that; the
/// noise is the sensor's in both.
fn tuned_by_proposal(
    letter: char,
    axis: &TransferFunction,
    noise: Noise,
    random: &mut Random,
) -> AxisResponse {
    let choice = Choice {
        method: Method::Iv,
        given: Given::default(),
        from_command: false,
    };
    let shape = Shape::MSequence {
        order: 12,
        hold: 1,
        repetitions: 1,
    };
    let first = make(shape, 1.0, PERIOD_S).unwrap().values;
    let clean = simulate(axis, Measured::Direct, PERIOD_S, &first).unwrap();
    let squares: f64 = clean.iter().map(|a| a * a).sum();
    let noise = noise.0 * (squares / clean.len() as f64).sqrt();
    let mut recorded = |torque: Vec<f64>| {
        let clean = simulate(axis, Measured::Direct, PERIOD_S, &torque).unwrap();
        let noisy = clean.iter().map(|a| a + noise * random.normal());
        recording(torque, noisy.collect(), Quantity::Acceleration)
    };
    let known = Known::of_recording(&recorded(first), &choice).unwrap();
    let bounds = Bounds {
        amplitude: 1.0,
        seconds: None,
        stroke: None,
        speed: None,
    };
    let proposal = propose(&known, &bounds).unwrap();
    let signal = proposal.excitation.values;
    println!(
        "  {letter}: {:.0} s, errors {:.2} of what is needed",
        signal.len() as f64 * PERIOD_S,
        proposal.best.by_wanted
    );
    of_recording(&recorded(signal), letter, &choice).unwrap()
}

/// How far axes are apart in truth, dB and degrees: the worst two of them.
fn apart(axes: &[TransferFunction], correction: &Correction) -> [f64; 2] {
    let zeros: Vec<TransferFunction> = axes
        .iter()
        .map(|axis| TransferFunction {
            zeros: axis.zeros.clone(),
            ..TransferFunction::constant(1.0)
        })
        .collect();
    let mut worst = [0.0_f64; 2];
    for k in 1..=500 {
        let hz = BAND_HZ / 500.0 * f64::from(k);
        let follows = |axis: usize| zeros[axis].at_hz(hz) * correction.at_hz(axis, hz);
        for (one, other) in (0..axes.len()).flat_map(|one| (0..one).map(move |other| (one, other)))
        {
            let ratio = follows(one) / follows(other);
            worst[0] = worst[0].max((20.0 * libm::log10(ratio.norm())).abs());
            worst[1] = worst[1].max(libm::atan2(ratio.im, ratio.re).abs() * 180.0 / PI);
        }
    }
    worst
}

/// Axes with filters by the signals that are proposed for each.
fn tuned_apart(axes: &[(TransferFunction, Noise)], random: &mut Random) -> [f64; 2] {
    let found = ['X', 'Y', 'Z', 'A', 'C']
        .into_iter()
        .zip(axes)
        .map(|(letter, (axis, noise))| tuned_by_proposal(letter, axis, *noise, random));
    let wish = Wish {
        period_s: PERIOD_S,
        discretization: Discretization::Matched,
        no_low_pass: false,
        order: None,
        bandwidth_hz: None,
    };
    let tuned = Tuned::new(found.collect(), wish, BAND_HZ).unwrap();
    let plants: Vec<TransferFunction> = axes.iter().map(|(axis, _)| axis.clone()).collect();
    apart(&plants, &tuned.correction)
}

/// One pair, by its number.
fn pair_apart(seed: u64, noise: Noise) -> [f64; 2] {
    let mut random = Random(5000 + seed);
    let axes = [plant(&mut random), plant(&mut random)].map(|axis| (axis, noise));
    tuned_apart(&axes, &mut random)
}

/// Three to five axes, one in five of them stiff, each with a sensor of its own.
fn mixed_apart(seed: u64) -> [f64; 2] {
    let mut random = Random(9000 + seed);
    let count = random.uniform(3.0, 6.0) as usize;
    let axes: Vec<(TransferFunction, Noise)> = (0..count)
        .map(|_| {
            let is_stiff = random.uniform(0.0, 1.0) < 0.2;
            let axis = if is_stiff { stiff } else { plant }(&mut random);
            (axis, Noise(random.uniform(0.002, 0.05)))
        })
        .collect();
    tuned_apart(&axes, &mut random)
}

/// How many of these lie within 0.1 dB and 0.6°.
fn alike(cases: impl Iterator<Item = u64>, apart: impl Fn(u64) -> [f64; 2]) -> usize {
    let is_alike = |seed: u64| {
        let [gain_db, phase_deg] = apart(seed);
        let is_alike = gain_db <= 0.1 && phase_deg <= 0.6;
        println!("{seed}: {gain_db:.4} dB, {phase_deg:.3}°, {is_alike}");
        is_alike
    };
    cases.filter(|seed| is_alike(*seed)).count()
}

/// 95 of 100 at least are alike.
fn nearly_all_are_alike(apart: impl Fn(u64) -> [f64; 2] + Copy + Send) {
    let cases = wanted(100);
    let (even, odd) = thread::scope(|scope| {
        let half = |odd: u64| {
            let cases = cases.clone().skip(odd as usize).step_by(2);
            scope.spawn(move || alike(cases, apart))
        };
        let (even, odd) = (half(0), half(1));
        (even.join().unwrap(), odd.join().unwrap())
    });
    let all = cases.count();
    assert!(20 * (even + odd) >= 19 * all, "{} of {all}", even + odd);
}

#[test]
#[ignore = "minutes: cargo test --release -p gwatt-identify -- --ignored signals_that_are_proposed"]
fn random_axes_are_alike_by_the_signals_that_are_proposed() {
    nearly_all_are_alike(|seed| pair_apart(seed, Noise(0.01)));
}

#[test]
#[ignore = "half an hour"]
fn random_axes_with_much_noise_are_alike_by_the_signals_that_are_proposed() {
    nearly_all_are_alike(|seed| pair_apart(seed, Noise(0.05)));
}

#[test]
#[ignore = "half an hour"]
fn three_to_five_mixed_axes_are_alike_by_the_signals_that_are_proposed() {
    nearly_all_are_alike(mixed_apart);
}
