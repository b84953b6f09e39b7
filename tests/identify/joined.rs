//! Rigid axes from what people record: motion one way, several recordings, short ones,
//! friction that differs by direction.

use std::f64::consts::TAU;

use gwatt::identify::rigid::{self, Friction, Rigid};
use gwatt::identify::{Judgement, Recording, judgement};

use super::{PERIOD_S, emps, sines, table};
use crate::random::Random;

/// Speed and acceleration of steps from speed to speed, rad/s: each is reached by the
/// half wave of a cosine in 0.08 s, and lasts 0.3 s in all.
fn steps(levels: &[f64]) -> Vec<[f64; 2]> {
    const RISE_S: f64 = 0.08;
    let mut motion = Vec::new();
    for pair in levels.windows(2) {
        let step = pair[1] - pair[0];
        for k in 0..300 {
            let t = f64::from(k) * PERIOD_S;
            let phase = TAU / 2.0 * (t / RISE_S).min(1.0);
            let v = pair[0] + step * 0.5 * (1.0 - libm::cos(phase));
            let a = if t < RISE_S {
                step * 0.5 * TAU / 2.0 / RISE_S * libm::sin(phase)
            } else {
                0.0
            };
            motion.push([v, a]);
        }
    }
    motion
}

/// A servo of 2.6e-4 kg·m² with 3e-4 N·m·s/rad, 0.05 N·m of Coulomb friction and an offset
/// of 0.01 N·m; torque with noise of 0.01 N·m, speed of 0.3 rad/s.
fn servo(levels: &[f64], seed: u64) -> Recording {
    let mut random = Random(seed);
    let (mut torque, mut speed) = (Vec::new(), Vec::new());
    for [v, a] in steps(levels) {
        let friction = 3e-4 * v + 0.05 * v.signum() + 0.01;
        torque.push(2.6e-4 * a + friction + 0.01 * random.normal());
        speed.push(v + 0.3 * random.normal());
    }
    table(&["torque_nm", "velocity_rad_s"], &[&torque, &speed])
}

fn near(found: rigid::Figure, truth: f64, share: f64) {
    assert!(
        (found.value / truth - 1.0).abs() < share,
        "{found:?} {truth}"
    );
    assert!(
        (found.value - truth).abs() < 4.0 * found.std,
        "{found:?} {truth}"
    );
}

/// In motion one way Coulomb friction and offset are a sum; all else is determined.
#[test]
fn motion_one_way_determines_the_mass() {
    let levels = [
        [20.0, 150.0, 60.0, 190.0, 90.0],
        [20.0, 100.0, 200.0, 40.0, 120.0],
        [30.0, 180.0, 30.0, 180.0, 30.0],
    ];
    let mut all = Vec::new();
    for (levels, seed) in levels.iter().zip(1..) {
        let recording = servo(levels, seed);
        let found = rigid::fit_all(std::slice::from_ref(&recording), None, None).unwrap();
        near(found.mass, 2.6e-4, 0.05);
        near(found.constant.unwrap(), 0.06, 0.1);
        assert_eq!((found.coulomb, found.offset), (None, None));
        assert_eq!(found.friction(), "one way");
        all.push(recording);
    }
    let joined = rigid::fit_all(&all, None, None).unwrap();
    near(joined.mass, 2.6e-4, 0.01);
    near(joined.viscous.unwrap(), 3e-4, 0.05);
    assert_eq!(joined.recordings, 3);
    assert_eq!(judgement::rigid(&joined), Judgement::Good);
    // Backwards the sum is that of the other direction.
    let back = servo(&[-20.0, -150.0, -60.0, -190.0], 4);
    let found = rigid::fit(&back, Friction::Directional, None).unwrap();
    near(found.constant.unwrap(), -0.04, 0.1);
    let trouble = rigid::predict_error(&joined, &to_and_fro(0.0, 0.0, 3000, 1)).unwrap_err();
    assert!(
        trouble
            .message
            .starts_with("the second recording moves both ways"),
        "{trouble}"
    );
    // There and back in two recordings, Coulomb friction and offset are two.
    all.push(back);
    let both = rigid::fit_all(&all, None, None).unwrap();
    near(both.coulomb.unwrap(), 0.05, 0.05);
    near(both.offset.unwrap(), 0.01, 0.3);
}

/// 80 kg with 25 N and 300 N·s/m, more by `more` forward; a force with noise of `noise`.
fn to_and_fro(more: f64, noise: f64, samples: u32, seed: u64) -> Recording {
    let mut random = Random(seed);
    let (mut force, mut position) = (Vec::new(), Vec::new());
    for k in 0..samples {
        let t = f64::from(k) * PERIOD_S;
        let [x, v, a] = sines(t, &[(0.05, 1.5), (0.01, 4.3), (0.003, 9.1)]);
        let viscous = if v > 0.0 { 300.0 + more } else { 300.0 };
        force.push(80.0 * a + viscous * v + 25.0 * v.signum() + noise * random.normal());
        position.push(x);
    }
    table(&["force_n", "position_m"], &[&force, &position])
}

#[test]
fn the_data_decide_whether_friction_differs_by_direction() {
    for (more, friction) in [
        (0.0, "symmetric"),
        (100.0, "directional"),
        (-80.0, "directional"),
    ] {
        for seed in 0..4 {
            let recording = to_and_fro(more, 10.0, 8000, seed);
            let found = rigid::fit_all(&[recording], None, None).unwrap();
            assert_eq!(found.friction(), friction, "{more} {seed}");
            near(found.mass, 80.0, 0.01);
        }
    }
    let Some(recording) = emps() else {
        return;
    };
    let found = rigid::fit_all(&[recording], None, None).unwrap();
    assert_eq!(found.friction(), "directional");
    assert!(found.rel_error <= 0.029, "{}", found.rel_error);
}

/// 0.68 s are enough where least squares are, and errors are what they say: the truth
/// is inside two of them about as often as that of a normal deviate.
#[test]
fn a_short_trace_is_fitted_with_honest_errors() {
    const SEEDS: u64 = 200;
    let inside = |pick: fn(&Rigid) -> rigid::Figure, truth: f64| {
        let seeds = 0..SEEDS;
        seeds
            .filter(|seed| {
                let recording = to_and_fro(0.0, 30.0, 680, *seed);
                let found = rigid::fit(&recording, Friction::Symmetric, None).unwrap();
                let figure = pick(&found);
                (figure.value - truth).abs() <= 2.0 * figure.std
            })
            .count() as f64
            / SEEDS as f64
    };
    let mass = inside(|found| found.mass, 80.0);
    let viscous = inside(|found| found.viscous.unwrap(), 300.0);
    for share in [mass, viscous] {
        assert!((0.9..=0.995).contains(&share), "{mass} {viscous}");
    }
}

#[test]
fn recordings_that_do_not_go_together_are_refused() {
    let wave: Vec<f64> = (0..2000)
        .map(|k| libm::sin(0.03 * f64::from(k)) + 0.3 * libm::sin(0.11 * f64::from(k)))
        .collect();
    let plain = table(&["force_n", "accel_m_s2"], &[&wave, &wave]);
    let mixed = [to_and_fro(0.0, 0.0, 2000, 1), plain];
    let trouble = rigid::fit_all(&mixed, None, None).unwrap_err();
    assert_eq!(
        trouble.message,
        "some of the recordings have a speed or position, others have not"
    );
}
