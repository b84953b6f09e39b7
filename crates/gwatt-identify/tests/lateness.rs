//! Forces that act later than they were recorded: a drive holds each until the next sample.

use gwatt_identify::rigid::{self, Rigid};
use gwatt_identify::{Figure, Judgement, Recording, judgement};

use crate::simulated::{Axis, Motion, PERIOD_S, Random, Sensors, recorded};

/// An axis by a force that is held, its position read after such a share of each sample, and
/// the force recorded so many samples before it is given out.
fn read_within(share: f64, samples_before: usize, seed: u64) -> Recording {
    let mut random = Random(300 + seed);
    let motion = if seed.is_multiple_of(2) {
        Motion::strokes(12_000, 0.2, &mut random)
    } else {
        Motion::sines(12_000, 0.2, &mut random)
    };
    let mut force = Axis::PLAIN.force(&motion);
    let mut position = Axis::PLAIN.read_within(&force, share);
    force.drain(..samples_before);
    position.truncate(force.len());
    let sensors = Sensors {
        force: 1.0,
        step: 1e-6,
    };
    recorded(&force, &position, sensors, &mut random)
}

fn fitted(recording: Recording) -> Rigid {
    rigid::fit_all(&[recording], None, None).unwrap()
}

fn is_near(figure: Figure, truth: f64) -> bool {
    (figure.value - truth).abs() < 3.5 * figure.std
}

/// Mass and friction are those of the force as late as it acts, and predict another recording
/// that is as late.
#[test]
fn a_force_that_is_held_is_taken_as_late_as_it_acts() {
    for (share, samples_before, periods) in [(0.0, 0, 0.5), (0.0, 1, 1.5), (1.0, 0, -0.5)] {
        for seed in 0..4 {
            // Steps of 50 µs make the motion itself early by half of one.
            let share = if share > 0.5 { 0.95 } else { share };
            let found = fitted(read_within(share, samples_before, seed));
            let late_s = found.lateness_s.unwrap();
            let expected = periods * PERIOD_S;
            assert!(
                (late_s.value - expected).abs() < 0.1 * PERIOD_S,
                "{share} {seed}: {late_s:?}"
            );
            assert!(
                is_near(found.mass, 80.0),
                "{share} {seed}: {:?}",
                found.mass
            );
            let viscous = found.viscous.unwrap();
            assert!(is_near(viscous, 300.0), "{share} {seed}: {viscous:?}");
            let coulomb = found.coulomb.unwrap();
            assert!(is_near(coulomb, 25.0), "{share} {seed}: {coulomb:?}");
            assert_eq!(judgement::rigid(&found), Judgement::Good);
            let other = read_within(share, samples_before, seed + 2);
            let error = rigid::predict_error(&found, &other).unwrap();
            assert!(error < 1.2 * found.rel_error, "{error} {}", found.rel_error);
        }
    }
}

/// Where force and motion are of one time but for the steps of the simulation, or farther apart than a drive that samples brings
/// about, nothing is moved.
#[test]
fn a_force_of_the_same_time_stays() {
    for seed in 0..4 {
        let found = fitted(read_within(0.5, 0, seed));
        let late_s = found.lateness_s.map_or(0.0, |late| late.value);
        assert!(late_s.abs() < 0.1 * PERIOD_S, "{seed}: {late_s}");
        let found = fitted(read_within(0.5, 30, seed));
        assert_eq!(found.lateness_s, None, "{seed}");
        assert_ne!(judgement::rigid(&found), Judgement::Good, "{seed}");
    }
}
