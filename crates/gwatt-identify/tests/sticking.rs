//! Flexible models of axes that stick at reversals, and of loads that follow a command.

use std::f64::consts::TAU;

use gwatt_identify::flexible::{self, Choice, Flexible, Method};
use gwatt_identify::{
    Factor, Figure, Given, Judgement, Kind, Quantity, Recording, Signal, TransferFunction,
    judgement,
};

use super::simulated::{PERIOD_S, Random};

const SAMPLES: usize = 8000;
const FINE: usize = 20;

fn signal(name: &str, quantity: Quantity, kind: Kind, values: Vec<f64>) -> Signal {
    Signal {
        name: name.to_owned(),
        quantity,
        kind,
        values,
    }
}

fn found(signals: Vec<Signal>) -> Flexible {
    let recording = Recording {
        period_s: PERIOD_S,
        signals,
        ignored: Vec::new(),
        notes: Vec::new(),
    };
    let choice = Choice {
        method: Method::Iv,
        given: Given::default(),
        from_command: false,
    };
    flexible::identify(&recording, &choice).unwrap()
}

/// Amplitude, rad/s and phase of sines from 1 to 100 Hz.
fn sines(random: &mut Random) -> Vec<[f64; 3]> {
    (0..198)
        .map(|k| {
            let hz = 1.0 + 0.5 * f64::from(k);
            [1.0, TAU * hz, random.uniform(0.0, TAU)]
        })
        .collect()
}

fn sum(sines: &[[f64; 3]], time_s: f64) -> f64 {
    let each = sines.iter();
    each.map(|[a, w, phase]| a * libm::sin(w * time_s + phase))
        .sum()
}

/// Acceleration and angle of 0.024 kg·m² with 0.048 N·m·s/rad that sticks below 0.1 N·m.
fn sticking(torque: &[f64]) -> [Vec<f64>; 2] {
    let step_s = PERIOD_S / FINE as f64;
    let stops = step_s * 0.1 / 0.024;
    let (mut speed, mut angle) = (0.0_f64, 0.0);
    let (mut accelerations, mut angles) = (Vec::new(), Vec::new());
    for torque in torque {
        angles.push(angle);
        for step in 0..FINE {
            let free = speed + step_s * (torque - 0.048 * speed) / 0.024;
            let next = if free.abs() <= stops {
                0.0
            } else {
                free - stops.copysign(free)
            };
            if step == 0 {
                accelerations.push((next - speed) / step_s);
            }
            speed = next;
            angle += step_s * speed;
        }
    }
    [accelerations, angles]
}

fn holds(figure: Figure, truth: f64, share: f64) {
    let off = (figure.value - truth).abs();
    assert!(off < 3.0 * figure.std, "{figure:?} for {truth}");
    assert!(off < share * truth, "{figure:?} for {truth}");
}

/// Without noise what sticks is all that is left; it is not taken for modes.
#[test]
fn sticking_makes_no_modes() {
    let mut random = Random(7);
    let sines = sines(&mut random);
    let torque: Vec<f64> = (0..SAMPLES)
        .map(|k| {
            let time_s = PERIOD_S * k as f64;
            let slow = if time_s % 2.0 < 1.0 { 0.6 } else { -0.6 };
            slow + 0.03 * sum(&sines, time_s)
        })
        .collect();
    let [acceleration, angle] = sticking(&torque);
    let steps: Vec<f64> = angle.iter().map(|x| 1e-5 * libm::round(x / 1e-5)).collect();
    for motion in [
        signal("accel", Quantity::Acceleration, Kind::Rotary, acceleration),
        signal("position", Quantity::Position, Kind::Rotary, steps),
    ] {
        let what = motion.name.clone();
        let force = signal("torque", Quantity::Force, Kind::Rotary, torque.clone());
        let axis = found(vec![force, motion]);
        assert!(axis.zeros.is_empty(), "{what} {:?}", axis.zeros);
        assert!(axis.poles.is_empty(), "{what} {:?}", axis.poles);
        assert_eq!(judgement::flexible(&axis), Judgement::Good, "{what}");
        let inertia = axis.inertia.unwrap();
        assert!((inertia.value / 0.024 - 1.0).abs() < 0.005, "{inertia:?}");
        holds(axis.viscous.unwrap(), 0.048, 0.05);
        holds(axis.coulomb.unwrap(), 0.1, 0.1);
    }
}

/// Positions that run on between the samples of their command: a load with an
/// anti-resonance at 40 Hz, with no more error than is said.
#[test]
fn loads_follow_a_command_that_runs_on() {
    let pair = |hz: f64, damping| Factor::Pair {
        omega_rad_s: TAU * hz,
        damping,
    };
    let lag = |time_constant_s| Factor::Real { time_constant_s };
    let load = TransferFunction {
        gain: 1.0,
        zeros: vec![pair(40.0, 0.03)],
        poles: vec![pair(45.0, 0.05), lag(4e-3), lag(1.5e-3), lag(8e-4)],
        delay_s: 5e-3,
    };
    let mut random = Random(11);
    let command = sines(&mut random);
    let answer: Vec<[f64; 3]> = command
        .iter()
        .map(|[a, w, phase]| {
            let (size, turn) = load.at_hz(w / TAU).to_polar();
            [a * size, *w, phase + turn]
        })
        .collect();
    let times = || (0..SAMPLES).map(|k| PERIOD_S * k as f64);
    let axis = found(vec![
        signal(
            "command",
            Quantity::Command,
            Kind::Linear,
            times().map(|t| sum(&command, t)).collect(),
        ),
        signal(
            "position",
            Quantity::Position,
            Kind::Linear,
            times()
                .map(|t| sum(&answer, t) + 1e-3 * random.normal())
                .collect(),
        ),
    ]);
    assert_eq!(judgement::flexible(&axis), Judgement::Good);
    assert_eq!((axis.zeros.len(), axis.poles.len()), (1, 1));
    holds(axis.zeros[0].omega_rad_s, TAU * 40.0, 1e-3);
    holds(axis.zeros[0].damping, 0.03, 0.02);
    holds(axis.poles[0].omega_rad_s, TAU * 45.0, 1e-3);
    assert!((axis.delay_s.value - 5e-3).abs() < 2.0 * axis.delay_s.std);
}
