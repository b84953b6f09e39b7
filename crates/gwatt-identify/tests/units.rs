//! The figures of an axis in other units.

use std::f64::consts::TAU;

use gwatt_identify::flexible::{self, Choice, Flexible, Method};
use gwatt_identify::{Given, Quantity, Recording, judgement};

use crate::simulated::{PERIOD_S, Random, recording};

/// Steps of the simulation in a sampling period.
const FINE: usize = 20;

/// Motor, table and a mass on the table with an anti-resonance at 40 Hz, 0.024 kg·m² in
/// all; friction acts on the table. Speed and acceleration of the table at each sample.
fn axis(torque: &[f64], viscous: f64, coulomb: f64) -> [Vec<f64>; 2] {
    let spring = |mass: f64, hz: f64, damping: f64| {
        let w = TAU * hz;
        [mass * w * w, 2.0 * damping * mass * w]
    };
    let (motor, table, side) = (0.006, 0.01, 0.008);
    let [k1, c1] = spring(0.0045, 150.0, 0.05);
    let [k2, c2] = spring(side, 40.0, 0.03);
    let step_s = PERIOD_S / FINE as f64;
    let (mut x, mut v) = ([0.0; 3], [0.0_f64; 3]);
    let (mut speed, mut accel) = (Vec::new(), Vec::new());
    for torque in torque {
        for step in 0..FINE {
            let f1 = k1 * (x[0] - x[1]) + c1 * (v[0] - v[1]);
            let f2 = k2 * (x[2] - x[1]) + c2 * (v[2] - v[1]);
            let friction = viscous * v[1] + coulomb * libm::tanh(v[1] / 1e-3);
            let a = [
                (torque - f1) / motor,
                (f1 + f2 - friction) / table,
                -f2 / side,
            ];
            if step == 0 {
                speed.push(v[1]);
                accel.push(a[1]);
            }
            for ((x, v), a) in x.iter_mut().zip(&mut v).zip(a) {
                *v += a * step_s;
                *x += *v * step_s;
            }
        }
    }
    [speed, accel]
}

fn torque(samples: usize, random: &mut Random) -> Vec<f64> {
    let (mut slow, share) = (0.0, 0.25);
    (0..samples)
        .map(|_| {
            slow += share * (random.normal() - slow);
            5.0 * slow
        })
        .collect()
}

fn scaled(recording: &Recording, force: f64, motion: f64) -> Recording {
    let mut out = recording.clone();
    for signal in &mut out.signals {
        let by = if signal.quantity == Quantity::Force { force } else { motion };
        signal.values.iter_mut().for_each(|x| *x *= by);
    }
    out
}

fn found(recording: &Recording, method: Method) -> Result<Flexible, String> {
    let choice = Choice {
        method,
        given: Given::default(),
        from_command: false,
    };
    flexible::identify(recording, &choice).map_err(|e| e.to_string())
}

#[test]
#[ignore = "draft"]
fn draft() {
    for (viscous, coulomb) in [(0.048, 0.0), (0.048, 0.3)] {
    for (quantity, noise) in [(Quantity::Velocity, 0.0), (Quantity::Velocity, 1e-4), (Quantity::Velocity, 1e-3), (Quantity::Velocity, 1e-2), (Quantity::Velocity, 1e-1), (Quantity::Acceleration, 0.0), (Quantity::Acceleration, 0.05)] {
        for factor in [1.0, 5.0, 1000.0] {
        let mut random = Random(0);
        let torque = torque(8000, &mut random);
        let [speed, accel] = axis(&torque, viscous, coulomb);
        let signal = if quantity == Quantity::Velocity { speed } else { accel };
        let rms = (signal.iter().map(|x| x * x).sum::<f64>() / signal.len() as f64).sqrt();
        let signal: Vec<f64> = signal.iter().map(|x| x + noise * rms * random.normal()).collect();
        let recording = recording(torque.clone(), signal, quantity);
        let start = std::time::Instant::now();
        let f = found(&scaled(&recording, factor, 1.0), Method::Iv).unwrap();
        println!("{viscous} {coulomb} {quantity:?} {noise} x{factor}: J {:?} {:.1e} b {:?} {:.1e} c {:?} {:.1e} p {} z {} rel {:.3e} missed {:.3e} energy {:.3e} leak {:.3e} noise order {} {} {:.1} s", f.inertia.map(|j| j.value/factor), f.inertia.map_or(0.0, |j| j.std/factor),f.viscous.map(|j| j.value/factor), f.viscous.map_or(0.0, |j| j.std/factor), f.coulomb.map(|j| j.value/factor), f.coulomb.map_or(0.0, |j| j.std/factor), f.transfer.order(), f.transfer.zero_count(), f.rel_error, f.missed_share, f.missed_energy, f.leak, f.noise_order, judgement::flexible(&f).word(), start.elapsed().as_secs_f64());
    } } }
}
