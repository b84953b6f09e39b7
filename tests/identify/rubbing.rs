//! Flexible axes with ordinary friction.

use std::f64::consts::TAU;

use gwatt::identify::flexible::{self, Flexible, Method};
use gwatt::identify::{Factor, Judgement, judgement};

use super::{PERIOD_S, choice, random, table};
use crate::random::Random;

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

fn noisy(x: &[f64], share: f64, seed: u64) -> Vec<f64> {
    let rms = (x.iter().map(|x| x * x).sum::<f64>() / x.len() as f64).sqrt();
    let mut random = Random(seed);
    x.iter()
        .map(|x| x + share * rms * random.normal())
        .collect()
}

fn torque() -> Vec<f64> {
    random(8000, 45.0).iter().map(|u| 5.0 * u).collect()
}

fn found(name: &str, signal: &[f64]) -> Flexible {
    let table = table(&["torque_nm", name], &[&torque(), signal]);
    flexible::identify(&table, &choice(Method::Iv)).unwrap()
}

/// Within a share of the truth, or four standard errors.
fn is_near(figure: gwatt::identify::Figure, truth: f64, share: f64) -> bool {
    (figure.value - truth).abs() < (share * truth).max(4.0 * figure.std)
}

/// 0.048 N·m·s/rad make the gain at 0 Hz nil: with friction as a term the inertia is
/// what it is all the same.
#[test]
fn viscous_friction_and_inertia_are_told_apart() {
    let [speed, accel] = axis(&torque(), 0.048, 0.0);
    for (name, signal) in [
        ("accel_rad_s2", noisy(&accel, 0.05, 1)),
        ("velocity_rad_s", noisy(&speed, 0.001, 2)),
    ] {
        let found = found(name, &signal);
        let inertia = found.inertia.unwrap();
        assert!(is_near(inertia, 0.024, 0.003), "{name} {inertia:?}");
        assert!(inertia.std < 3e-3 * 0.024, "{name} {inertia:?}");
        let viscous = found.viscous.expect(name);
        assert!(is_near(viscous, 0.048, 0.03), "{name} {viscous:?}");
        assert_eq!(found.zeros.len(), 1, "{name} {:?}", found.transfer);
        let judged = judgement::flexible(&found);
        let is_usable = matches!(judged, Judgement::Good | Judgement::ExciteLonger { .. });
        assert!(is_usable, "{name} {judged:?}");
    }
}

/// With a recorded speed Coulomb friction is a term too; summed up from an acceleration
/// its sign is not known where motion is slow, and the verdict says so.
#[test]
fn coulomb_friction_is_a_term_where_the_speed_is_recorded() {
    let [speed, accel] = axis(&torque(), 0.048, 0.3);
    let by_speed = found("velocity_rad_s", &noisy(&speed, 0.01, 3));
    let inertia = by_speed.inertia.unwrap();
    assert!(is_near(inertia, 0.024, 0.02), "{inertia:?}");
    let coulomb = by_speed.coulomb.unwrap();
    assert!((coulomb.value / 0.3 - 1.0).abs() < 0.15, "{coulomb:?}");
    // The frequency of the anti-resonance is in the model.
    let is_near_40 = |zero: &Factor| match *zero {
        Factor::Pair { omega_rad_s, .. } => (omega_rad_s / TAU / 40.0 - 1.0).abs() < 0.01,
        Factor::Real { .. } => false,
    };
    let zeros = &by_speed.transfer.zeros;
    assert_eq!(
        zeros.iter().filter(|zero| is_near_40(zero)).count(),
        1,
        "{zeros:?}"
    );
    // A second recording is predicted with its friction.
    let again = table(
        &["torque_nm", "velocity_rad_s"],
        &[&torque(), &noisy(&speed, 0.01, 4)],
    );
    let error = flexible::predict_error(&by_speed, &again, &choice(Method::Iv)).unwrap();
    let left = by_speed.rel_error;
    assert!(error < 1.2 * left, "{error} {left}");
    let by_accel = found("accel_rad_s2", &noisy(&accel, 0.05, 5));
    assert_ne!(judgement::flexible(&by_accel), Judgement::Good);
    let coulomb = by_accel.coulomb.unwrap();
    let apart = (coulomb.value - 0.3).abs();
    assert!(apart < 3.0 * coulomb.std, "{coulomb:?}");
}

/// Where there is none, the model has none.
#[test]
fn without_friction_there_is_no_term_of_it() {
    let [_, accel] = axis(&torque(), 0.0, 0.0);
    let found = found("accel_rad_s2", &noisy(&accel, 0.05, 5));
    assert_eq!((found.viscous, found.coulomb), (None, None));
}

/// One way Coulomb friction is an offset: no figure of it is made up.
#[test]
fn motion_one_way_determines_no_coulomb_friction() {
    let torque: Vec<f64> = random(8000, 45.0).iter().map(|u| 0.6 + u).collect();
    let [speed, _] = axis(&torque, 0.05, 0.1);
    // Without the run-up, so that all of it is one way.
    let cut = |x: &[f64]| x[2000..].to_vec();
    let (torque, speed) = (cut(&torque), cut(&noisy(&speed, 0.002, 1)));
    let table = table(&["torque_nm", "velocity_rad_s"], &[&torque, &speed]);
    let found = flexible::identify(&table, &choice(Method::Iv)).unwrap();
    assert!(found.coulomb.is_none(), "{:?}", found.coulomb);
    assert!(
        is_near(found.viscous.unwrap(), 0.05, 0.1),
        "{:?}",
        found.viscous
    );
    assert!(
        is_near(found.inertia.unwrap(), 0.024, 0.05),
        "{:?}",
        found.inertia
    );
}
