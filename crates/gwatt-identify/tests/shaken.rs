//! A drive that is shaken while it moves one way: a table on an elastic screw with a little play,
//! Coulomb friction at both ends, cogging, a current loop that is late, and an encoder that counts.

use std::f64::consts::TAU;

use gwatt_identify::flexible::{self, Choice, Flexible, Method};
use gwatt_identify::{Given, Judgement, Quantity, Recording, judgement};

use crate::simulated::{PERIOD_S, Random, recording};

const SAMPLES: usize = 6000;
/// Steps of the simulation from sample to sample.
const FINE: usize = 20;
const H: f64 = PERIOD_S / FINE as f64;
/// Motor and screw as the slide sees them, and the table, kg.
const MOTOR: f64 = 829.0;
const TABLE: f64 = 260.0;
const SPRING: f64 = 5e7;
const DAMPER: f64 = 6840.0;
const PLAY: f64 = 2e-6;
/// Coulomb friction of motor and table, N, and the table's viscous friction, N·s/m.
const RUBS: [f64; 2] = [94.0, 150.0];
const VISCOUS: f64 = 600.0;
/// Amplitude, N, and period, m.
const COGGING: [f64; 2] = [38.0, 0.01 / 24.0];
const LAG_S: f64 = 5e-4;
const COUNT: f64 = 0.01 / 131_072.0;
/// Of the recorded force, N.
const NOISE: f64 = 3.6;
/// How fast it moves, m/s.
const SPEED: f64 = 0.01;
/// What is added at most, N.
const AMPLITUDE: f64 = 1000.0;

/// The speed after a step, with friction that holds what it can.
fn rubbed(speed: f64, force: f64, friction: f64, mass: f64) -> f64 {
    let free = speed + H * force / mass;
    let held = H * friction / mass;
    if free.abs() <= held {
        0.0
    } else {
        free - held * free.signum()
    }
}

/// Sines of these frequencies with phases by chance.
fn signal([from_hz, to_hz]: [f64; 2], random: &mut Random) -> Vec<f64> {
    let seconds = SAMPLES as f64 * PERIOD_S;
    let lines = (from_hz * seconds) as usize..(to_hz * seconds) as usize;
    let lines: Vec<(f64, f64)> = lines
        .map(|line| (TAU * line as f64 / seconds, random.uniform(0.0, TAU)))
        .collect();
    let at = |k: usize| -> f64 {
        let t = k as f64 * PERIOD_S;
        lines
            .iter()
            .map(|(w, phase)| libm::sin(w * t + phase))
            .sum()
    };
    let sums: Vec<f64> = (0..SAMPLES).map(at).collect();
    let most = sums.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    sums.iter().map(|x| x * AMPLITUDE / most).collect()
}

fn shaken(random: &mut Random) -> Recording {
    let added = signal([2.0, 150.0], random);
    let (mut x, mut v, mut table, mut table_v, mut force) = (0.0, 0.0, 0.0, 0.0, 0.0);
    let (mut asked, mut counted) = (Vec::new(), Vec::new());
    for added in added {
        // What keeps it at its speed is lazy.
        let held = added + RUBS[0] + RUBS[1] + VISCOUS * SPEED + 15_800.0 * (SPEED - v);
        asked.push(held + NOISE * random.normal());
        counted.push(COUNT * libm::floor(x / COUNT));
        for _ in 0..FINE {
            force += H / LAG_S * (held - force);
            let gap: f64 = x - table;
            let pressed = gap - gap.clamp(-0.5 * PLAY, 0.5 * PLAY);
            let damped = if pressed == 0.0 {
                0.0
            } else {
                DAMPER * (v - table_v)
            };
            let push = SPRING * pressed + damped;
            let cogging = COGGING[0] * libm::sin(TAU * x / COGGING[1]);
            v = rubbed(v, force - push - cogging, RUBS[0], MOTOR);
            table_v = rubbed(table_v, push - VISCOUS * table_v, RUBS[1], TABLE);
            x += H * v;
            table += H * table_v;
        }
    }
    recording(asked, counted, Quantity::Position)
}

fn found(recording: &Recording) -> Flexible {
    let choice = Choice {
        method: Method::Iv,
        given: Given::default(),
        from_command: false,
    };
    flexible::identify(recording, &choice).unwrap()
}

/// Within a hundredth of what is moved: play and friction take less than that off.
fn assert_mass(case: u64, found: &Flexible) {
    let mass = found.inertia.unwrap();
    assert!(
        (mass.value / (MOTOR + TABLE) - 1.0).abs() < 0.01,
        "{case}: {mass:?}"
    );
    assert!(mass.std < 0.01 * mass.value, "{case}: {mass:?}");
    assert_eq!(judgement::flexible(found), Judgement::Good, "{case}");
}

/// The current loop is a lag of its own, though it was joined with a slower pole that friction
/// made, which is next to nothing together with a zero.
#[test]
fn a_lag_is_found_without_what_friction_joins_to_it() {
    for case in [0, 3] {
        let found = found(&shaken(&mut Random(case)));
        assert_mass(case, &found);
        assert_eq!(found.transfer.order(), 3, "{case}: {:?}", found.transfer);
        let mut poles = found.transfer.poles.iter();
        let lag = poles.find(|pole| pole.degree() == 1).unwrap().lag_s();
        assert!((lag / LAG_S - 1.0).abs() < 0.25, "{case}: {lag}");
        assert_eq!((found.zeros.len(), found.poles.len()), (1, 1), "{case}");
    }
}

/// Where a slow pole and a slow zero explain clearly more, the mass is not that of 0 Hz.
#[test]
fn what_creeps_takes_no_mass_along() {
    for case in [5, 8] {
        assert_mass(case, &found(&shaken(&mut Random(case))));
    }
}
