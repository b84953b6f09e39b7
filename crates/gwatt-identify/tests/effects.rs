//! What an axis has besides mass and friction is named, with its figures, and mass and
//! friction are right next to it.

use gwatt_identify::effects::{Effect, Saturation};
use gwatt_identify::flexible::{self, Choice, Method};
use gwatt_identify::rigid::{self, Rigid};
use gwatt_identify::{Figure, Given, Judgement, Recording, judgement};

use crate::simulated::{Axis, Motion, Random, Sensors, recorded};

const SENSORS: Sensors = Sensors {
    force: 1.0,
    step: 1e-6,
};

fn fitted(axis: &Axis, motion: &Motion) -> Rigid {
    let force = axis.force(motion);
    let recording = recorded(&force, &motion.position, SENSORS, &mut Random(5));
    rigid::fit_all(&[recording], None, None).unwrap()
}

fn near(figure: Figure, truth: f64, share: f64) {
    let off = (figure.value - truth).abs();
    assert!(
        off < share * truth.abs() && off < 4.0 * figure.std + 1e-3 * truth.abs(),
        "{figure:?} {truth}"
    );
}

fn mass_and_friction(found: &Rigid) {
    near(found.mass, 80.0, 0.01);
    near(found.viscous.unwrap(), 300.0, 0.02);
    near(found.coulomb.unwrap(), 25.0, 0.02);
}

/// 40 N every 12 mm: found by its place, whatever the motion; small ones are no verdict.
#[test]
fn cogging_is_periodic_in_position() {
    for (seed, amplitude, verdict) in [
        (1, 40.0, Judgement::Cogging),
        (2, 40.0, Judgement::Cogging),
        (3, 6.0, Judgement::Good),
    ] {
        let axis = Axis {
            cogging: Some([0.012, amplitude]),
            ..Axis::PLAIN
        };
        let mut random = Random(seed);
        for motion in [
            Motion::sines(16_000, 0.15, &mut random),
            Motion::strokes(16_000, 0.1, &mut random),
        ] {
            let found = fitted(&axis, &motion);
            mass_and_friction(&found);
            assert!(!found.resonates);
            let [
                Effect::Cogging {
                    period,
                    amplitude: size,
                    ..
                },
            ] = found.effects[..]
            else {
                panic!("{:?}", found.effects)
            };
            near(period, 0.012, 0.001);
            near(size, amplitude, 0.02);
            assert_eq!(
                judgement::rigid(&found),
                verdict,
                "{seed} {:?}",
                found.effects
            );
        }
    }
}

/// What is periodic in time is none, such as a pump or a fan.
#[test]
fn a_force_of_the_time_is_no_cogging() {
    let motion = Motion::sines(16_000, 0.15, &mut Random(4));
    let mut force = Axis::PLAIN.force(&motion);
    for (k, force) in force.iter_mut().enumerate() {
        *force += 40.0 * libm::sin(0.1 * k as f64);
    }
    let recording = recorded(&force, &motion.position, SENSORS, &mut Random(5));
    let found = rigid::fit_all(&[recording], None, None).unwrap();
    assert!(found.effects.is_empty(), "{:?}", found.effects);
    assert_ne!(judgement::rigid(&found), Judgement::Good);
}

/// Friction of 45 N at breakaway, of 25 N from some 20 mm/s on.
#[test]
fn friction_that_falls_is_stribecks() {
    let axis = Axis {
        stribeck: Some([20.0, 0.02]),
        ..Axis::PLAIN
    };
    let motion = Motion::sines(16_000, 0.1, &mut Random(6));
    let found = fitted(&axis, &motion);
    mass_and_friction(&found);
    let [Effect::Stribeck { rise, speed, .. }] = found.effects[..] else {
        panic!("{:?}", found.effects)
    };
    near(rise, 20.0, 0.05);
    near(speed, 0.02, 0.05);
}

/// A load of three quarters of the mass in a play of 2 mm.
#[test]
fn force_that_is_missing_after_reversals_is_backlash() {
    let axis = Axis {
        backlash: Some([0.002, 0.75]),
        ..Axis::PLAIN
    };
    let mut random = Random(7);
    for motion in [
        Motion::sines(16_000, 0.15, &mut random),
        Motion::strokes(16_000, 0.1, &mut random),
    ] {
        let found = fitted(&axis, &motion);
        let [Effect::Backlash { width, mass, .. }] = found.effects[..] else {
            panic!("{:?}", found.effects)
        };
        let off = (width.value - 0.002).abs();
        assert!(off < 0.0006 && off < 3.0 * width.std, "{width:?}");
        assert!(width.std < 0.0006, "{width:?}");
        assert!((mass.value - 60.0).abs() < 20.0, "{mass:?}");
        assert_eq!(judgement::rigid(&found), Judgement::Backlash);
    }
}

/// The same load without friction of its own: all friction is the motor's.
#[test]
fn a_load_without_friction_shows_its_play_too() {
    let axis = Axis {
        backlash: Some([0.002, 0.75]),
        viscous: 0.0,
        coulomb: 0.0,
        ..Axis::PLAIN
    };
    let motion = Motion::sines(16_000, 0.15, &mut Random(7));
    let pushed = axis.force(&motion).into_iter().zip(&motion.velocity);
    let force: Vec<f64> = pushed
        .map(|(f, v)| f + 300.0 * v + 25.0 * libm::tanh(v / 1e-4))
        .collect();
    let recording = recorded(&force, &motion.position, SENSORS, &mut Random(5));
    let found = rigid::fit_all(&[recording], None, None).unwrap();
    assert!(
        matches!(found.effects[..], [Effect::Backlash { .. }]),
        "{found:?}"
    );
    assert_eq!(judgement::rigid(&found), Judgement::Backlash);
}

fn clipped(force: &[f64], limit: f64) -> Vec<f64> {
    force.iter().map(|f| f.clamp(-limit, limit)).collect()
}

/// The force ends at 100 N: in the recording alone, in the drive alone, or in both.
#[test]
fn a_force_that_ends_is_saturated() {
    let motion = Motion::sines(16_000, 0.15, &mut Random(8));
    let free = Axis::PLAIN.force(&motion);
    let limit = 100.0;
    let noise = Sensors {
        force: 0.0,
        ..SENSORS
    };
    let fit = |recording: Recording| rigid::fit_all(&[recording], None, None).unwrap();
    let cut = recorded(
        &clipped(&free, limit),
        &motion.position,
        noise,
        &mut Random(1),
    );
    let found = fit(cut);
    let Some(Saturation::Recording { limit: at, share }) = found.saturation else {
        panic!("{:?}", found.saturation)
    };
    assert_eq!(at, limit);
    let above = free.iter().filter(|f| f.abs() >= limit).count() as f64 / 16_000.0;
    assert!((share - above).abs() < 0.01, "{share} {above}");
    assert_eq!(judgement::rigid(&found), Judgement::Saturated);
    // Mass and friction are those of where it does not end.
    near(found.mass, 80.0, 0.05);

    // A drive that gives no more than 100 N, and a motion that follows from that.
    let wanted: Vec<f64> = free.iter().map(|f| 1.3 * f).collect();
    let given = clipped(&wanted, limit);
    let position = Axis::PLAIN.moved_by(&given);
    let found = fit(recorded(&given, &position, noise, &mut Random(1)));
    assert!(
        matches!(found.saturation, Some(Saturation::Drive { limit: at, .. }) if at == limit),
        "{:?}",
        found.saturation
    );
    near(found.mass, 80.0, 0.01);
    let found = fit(recorded(&wanted, &position, SENSORS, &mut Random(1)));
    let Some(Saturation::Beyond { limit: at, .. }) = found.saturation else {
        panic!("{:?}", found.saturation)
    };
    assert!((at - limit).abs() < 2.0, "{at}");
    near(found.mass, 80.0, 0.02);
    assert_eq!(judgement::rigid(&found), Judgement::Saturated);
}

/// Far more is asked for than the drive gives, and in between next to nothing: whatever is
/// found, it is not called good.
#[test]
fn a_drive_that_gives_little_of_what_is_asked() {
    let motion = Motion::sines(16_000, 0.15, &mut Random(8));
    let free = Axis::PLAIN.force(&motion);
    let mut sizes: Vec<f64> = free.iter().map(|f| f.abs()).collect();
    sizes.sort_by(f64::total_cmp);
    for share in [35, 45, 55, 70] {
        let small = sizes[16_000 * share / 100];
        let asked = |f: &f64| if f.abs() < small { 0.01 * f } else { 100.0 * f };
        let wanted: Vec<f64> = free.iter().map(asked).collect();
        let position = Axis::PLAIN.moved_by(&clipped(&wanted, 100.0));
        let recording = recorded(&wanted, &position, SENSORS, &mut Random(1));
        if let Ok(found) = rigid::fit_all(&[recording], None, None) {
            assert_ne!(judgement::rigid(&found), Judgement::Good, "{share}");
        }
    }
}

/// A third of the time the axis is asked for what the drive gives, else for thirty times as
/// much: the next size that is tried is far above the one that fits, and half of that
/// distance below it there is no force.
#[test]
fn a_limit_far_below_the_next_size_is_looked_for_above_zero() {
    let motion = Motion::sines(16_000, 0.15, &mut Random(8));
    let free = Axis::PLAIN.force(&motion);
    let mut sizes: Vec<f64> = free.iter().map(|f| f.abs()).collect();
    sizes.sort_by(f64::total_cmp);
    let limit = sizes[16_000 * 35 / 100];
    let asked = |f: &f64| if f.abs() < limit { *f } else { 30.0 * f };
    let wanted: Vec<f64> = free.iter().map(asked).collect();
    let position = Axis::PLAIN.moved_by(&clipped(&wanted, limit));
    let recording = recorded(&wanted, &position, SENSORS, &mut Random(1));
    let found = rigid::fit_all(&[recording], None, None).unwrap();
    let Some(Saturation::Beyond { limit: at, .. }) = found.saturation else {
        panic!("{:?}", found.saturation)
    };
    // Between that size and the next one nothing was asked for: all limits are the same.
    assert!(at > 0.0 && at < 30.0 * limit, "{at} {limit}");
    assert_eq!(judgement::rigid(&found), Judgement::Saturated);
}

/// An axis runs up to two even speeds, its force as noisy as it is large: cut off near
/// friction, the force is explained by friction, and yet nothing ends there.
#[test]
fn noise_that_is_cut_off_is_no_limit() {
    const RISE_S: f64 = 0.5;
    for seed in 0..4 {
        let mut random = Random(30 + seed);
        let mut motion = Motion {
            position: Vec::new(),
            velocity: Vec::new(),
            acceleration: Vec::new(),
        };
        for k in 0..16_000 {
            let t = f64::from(k) * 1e-3;
            let (mut x, mut v, mut a) = (0.0, 0.0, 0.0);
            for (from_s, speed) in [(0.0, 0.2), (8.0, 0.1)] {
                let t = (t - from_s).max(0.0);
                let left = libm::exp(-t / RISE_S);
                x += speed * (t - RISE_S * (1.0 - left));
                v += speed * (1.0 - left);
                a += if t > 0.0 { speed / RISE_S * left } else { 0.0 };
            }
            motion.position.push(x);
            motion.velocity.push(v);
            motion.acceleration.push(a);
        }
        // One sample in ten is far off, as of a current that is switched.
        let force = Axis::PLAIN.force(&motion).into_iter().map(|force| {
            let far = random.uniform(0.0, 1.0) < 0.1;
            force + if far { 400.0 } else { 40.0 } * random.normal()
        });
        let force: Vec<f64> = force.collect();
        let recording = recorded(&force, &motion.position, SENSORS, &mut random);
        let found = rigid::fit_all(&[recording], None, None).unwrap();
        assert_eq!(found.saturation, None, "{seed}");
        let off = (found.mass.value - 80.0).abs();
        assert!(off < 4.0 * found.mass.std, "{:?}", found.mass);
    }
}

/// Nothing is found where nothing is: friction, noise, motions of all kinds.
#[test]
fn a_plain_axis_has_no_effects() {
    for seed in 0..20 {
        let mut random = Random(seed);
        let sensors = Sensors {
            force: [1.0, 10.0, 40.0][seed as usize % 3],
            step: [1e-7, 1e-6, 1e-5][seed as usize / 3 % 3],
        };
        for motion in [
            Motion::sines(12_000, 0.15, &mut random),
            Motion::strokes(12_000, 0.1, &mut random),
        ] {
            let force = Axis::PLAIN.force(&motion);
            let recording = recorded(&force, &motion.position, sensors, &mut random);
            let found = rigid::fit_all(&[recording], None, None).unwrap();
            assert!(found.effects.is_empty(), "{seed} {:?}", found.effects);
            assert_eq!(found.saturation, None, "{seed}");
        }
    }
}

/// A second recording is predicted with the cogging of the first, wherever its positions
/// count from; several are joined.
#[test]
fn positions_may_count_from_elsewhere() {
    let axis = Axis {
        cogging: Some([0.012, 40.0]),
        ..Axis::PLAIN
    };
    let mut random = Random(9);
    let recordings: Vec<Recording> = [0.0, 0.0047, 0.1]
        .into_iter()
        .map(|shift| {
            let motion = Motion::sines(12_000, 0.15, &mut random);
            let force = axis.force(&motion);
            let position: Vec<f64> = motion.position.iter().map(|x| x + shift).collect();
            recorded(&force, &position, SENSORS, &mut random)
        })
        .collect();
    let found = rigid::fit_all(&recordings[..1], None, None).unwrap();
    let error = rigid::predict_error(&found, &recordings[1]).unwrap();
    assert!(error < 0.02, "{error}");
    let all = rigid::fit_all(&recordings, None, None).unwrap();
    mass_and_friction(&all);
    let [Effect::Cogging { amplitude, .. }] = all.effects[..] else {
        panic!("{:?}", all.effects)
    };
    near(amplitude, 40.0, 0.01);
}

/// Of a force that stands at its end nearly always nothing is left to find a mass by: no
/// figures, and the reason.
#[test]
fn a_force_that_hardly_leaves_its_end_gives_no_figures() {
    let motion = Motion::sines(16_000, 0.15, &mut Random(8));
    let free = Axis::PLAIN.force(&motion);
    for limit in [20.0, 10.0] {
        let noise = Sensors {
            force: 0.0,
            ..SENSORS
        };
        let cut = recorded(
            &clipped(&free, limit),
            &motion.position,
            noise,
            &mut Random(1),
        );
        let refused = rigid::fit_all(std::slice::from_ref(&cut), None, None).unwrap_err();
        assert!(refused.message.contains("saturated"), "{refused}");
        assert!(
            refused.to_string().contains("smaller amplitude"),
            "{refused}"
        );
        let choice = Choice {
            method: Method::Iv,
            given: Given::default(),
            from_command: false,
        };
        let refused = flexible::identify(&cut, &choice).unwrap_err();
        assert!(refused.message.contains("saturated"), "{refused}");
    }
}
