//! Filters for pairs of axes that are recorded with the signals proposed for them.

use std::f64::consts::PI;
use std::thread;

use gwatt_identify::design::{Bounds, Known, propose};
use gwatt_identify::excitation::{Shape, make};
use gwatt_identify::flexible::{Choice, Method};
use gwatt_identify::tune::{AxisResponse, Correction, Discretization, Tuned, Wish, of_recording};
use gwatt_identify::{Given, Measured, Quantity, TransferFunction, simulate};

use crate::simulated::{PERIOD_S, Random, plant, recording, wanted};

const BAND_HZ: f64 = 50.0;
/// Noise of the sensor, as a share of the acceleration under the M-sequence.
const NOISE: f64 = 0.01;

/// An M-sequence, the signal that it leads to, and the axis by a recording of that; the
/// noise is the sensor's in both.
fn tuned_by_proposal(letter: char, axis: &TransferFunction, random: &mut Random) -> AxisResponse {
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
    let noise = NOISE * (squares / clean.len() as f64).sqrt();
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

/// How far two axes are apart in truth, dB and degrees.
fn apart(axes: &[TransferFunction; 2], correction: &Correction) -> [f64; 2] {
    let zeros = axes.each_ref().map(|axis| TransferFunction {
        zeros: axis.zeros.clone(),
        ..TransferFunction::constant(1.0)
    });
    let mut worst = [0.0_f64; 2];
    for k in 1..=500 {
        let hz = BAND_HZ / 500.0 * f64::from(k);
        let ratio = zeros[0].at_hz(hz) / zeros[1].at_hz(hz) * correction.at_hz(0, hz)
            / correction.at_hz(1, hz);
        worst[0] = worst[0].max((20.0 * libm::log10(ratio.norm())).abs());
        worst[1] = worst[1].max(libm::atan2(ratio.im, ratio.re).abs() * 180.0 / PI);
    }
    worst
}

/// One pair, by its number.
fn pair_apart(seed: u64) -> [f64; 2] {
    let mut random = Random(5000 + seed);
    let axes = [plant(&mut random), plant(&mut random)];
    let found = ['X', 'Y']
        .into_iter()
        .zip(&axes)
        .map(|(letter, axis)| tuned_by_proposal(letter, axis, &mut random));
    let wish = Wish {
        period_s: PERIOD_S,
        discretization: Discretization::Matched,
        no_low_pass: false,
        order: None,
        bandwidth_hz: None,
    };
    let tuned = Tuned::new(found.collect(), wish, BAND_HZ).unwrap();
    apart(&axes, &tuned.correction)
}

/// How many of these pairs lie within 0.1 dB and 0.6°.
fn alike(pairs: impl Iterator<Item = u64>) -> usize {
    let is_alike = |seed: u64| {
        let [gain_db, phase_deg] = pair_apart(seed);
        let is_alike = gain_db <= 0.1 && phase_deg <= 0.6;
        println!("{seed}: {gain_db:.4} dB, {phase_deg:.3}°, {is_alike}");
        is_alike
    };
    pairs.filter(|seed| is_alike(*seed)).count()
}

#[test]
#[ignore = "minutes: cargo test --release -p gwatt-identify -- --ignored signals_that_are_proposed"]
fn random_axes_are_alike_by_the_signals_that_are_proposed() {
    let pairs = wanted(100);
    let (even, odd) = thread::scope(|scope| {
        let half = |odd: u64| {
            let pairs = pairs.clone().skip(odd as usize).step_by(2);
            scope.spawn(move || alike(pairs))
        };
        let (even, odd) = (half(0), half(1));
        (even.join().unwrap(), odd.join().unwrap())
    });
    let all = pairs.count();
    assert!(20 * (even + odd) >= 19 * all, "{} of {all}", even + odd);
}
