//! Friction of flexible axes, at random: no wrong figure is called good.

use std::thread;

use gwatt_identify::excitation::{Shape, make};
use gwatt_identify::flexible::{self, Choice, Flexible, Method};
use gwatt_identify::{Figure, Given, Judgement, Quantity, judgement};

use super::simulated::{PERIOD_S, Random, recording, wanted};
use super::units::{axis, noisy, torque};

/// What is found of an axis with viscous and Coulomb friction, and what it has.
struct Case {
    found: Flexible,
    viscous: f64,
    coulomb: f64,
}

/// By its speed or acceleration, without noise, with a hundredth and three hundredths.
fn case(seed: u64) -> Case {
    let mut random = Random(9000 + seed);
    let viscous = random.uniform(0.0, 0.1);
    let coulomb = random.uniform(0.0, 0.5);
    let torque = torque(4000, &mut random);
    let [speed, accel] = axis(&torque, viscous, coulomb);
    let (quantity, motion) = if seed.is_multiple_of(2) {
        (Quantity::Velocity, speed)
    } else {
        (Quantity::Acceleration, accel)
    };
    let noise = [0.0, 0.01, 0.03][(seed / 2 % 3) as usize];
    let motion = noisy(&motion, noise, &mut random);
    Case {
        found: identified(torque, motion, quantity),
        viscous,
        coulomb,
    }
}

fn identified(torque: Vec<f64>, motion: Vec<f64>, quantity: Quantity) -> Flexible {
    let choice = Choice {
        method: Method::Iv,
        given: Given::default(),
        from_command: false,
    };
    flexible::identify(&recording(torque, motion, quantity), &choice).unwrap()
}

/// An axis of 0.05 N·m·s/rad and 0.1 N·m that moves one way under this torque and more, which
/// is all from 1 to 45 Hz or slow for the most part: noise is a share of a speed that is
/// large next to its changes.
fn one_way(mean: f64, is_flat: bool, noise: f64, seed: u64) -> Flexible {
    let mut random = Random(seed);
    let more = if is_flat {
        let shape = Shape::Random {
            from_hz: 1.0,
            to_hz: 45.0,
            seconds: 6000.0 * PERIOD_S,
            seed,
        };
        make(shape, 1.0, PERIOD_S).unwrap().values
    } else {
        torque(6000, &mut random).iter().map(|u| 0.1 * u).collect()
    };
    let torque: Vec<f64> = more.iter().map(|u| mean + u).collect();
    let [speed, _] = axis(&torque, 0.05, 0.1);
    let speed = noisy(&speed, noise, &mut random);
    // Without the run-up.
    let cut = |x: &[f64]| x.get(2000..).unwrap().to_vec();
    identified(cut(&torque), cut(&speed), Quantity::Velocity)
}

/// Whether it is good, and by how many standard errors the worst of its figures is off.
fn judged_one_way(mean: f64, is_flat: bool, noise: f64, seed: u64) -> (bool, f64) {
    let found = one_way(mean, is_flat, noise, seed);
    let what = format!("{mean} {is_flat} {noise} {seed}");
    assert!(found.coulomb.is_none(), "{what}");
    let worst = apart(found.viscous, 0.05).max(apart(found.inertia, 0.024));
    let verdict = judgement::flexible(&found);
    println!(
        "{what}: {:?} {:?} {worst:.1} {}",
        found.inertia,
        found.viscous,
        verdict.word()
    );
    (verdict == Judgement::Good, worst)
}

/// The noise of the speed is that of the motion: as an input of the model it came out as
/// viscous friction of up to 100 times the true one, with small errors.
#[test]
fn friction_of_motion_one_way_is_right_next_to_the_noise_of_its_speed() {
    for (mean, is_flat, noise, seed) in [
        (0.6, true, 0.002, 1),
        (0.6, false, 0.002, 2),
        (1.2, true, 0.002, 2),
        (1.2, true, 0.0002, 126),
        (-2.5, false, 0.002, 4),
        (-2.5, true, 0.0002, 5),
    ] {
        let (_, worst) = judged_one_way(mean, is_flat, noise, seed);
        assert!(worst < 3.0, "{mean} {is_flat} {noise} {seed}: {worst}");
    }
}

#[test]
#[ignore = "minutes: cargo test --release -p gwatt-identify -- --ignored one_way_at_random"]
fn friction_of_motion_one_way_at_random_is_right_where_it_is_good() {
    let is_wrong = |case: u64| {
        let mean = [0.3, 0.6, 1.2, -2.5][(case / 4 % 4) as usize];
        let noise = if (case / 2).is_multiple_of(2) {
            0.002
        } else {
            0.0002
        };
        let (is_good, worst) = judged_one_way(mean, case.is_multiple_of(2), noise, 100 + case);
        is_good && worst > 3.0
    };
    let cases = wanted(48);
    let wrong = cases.clone().filter(|case| is_wrong(*case)).count();
    assert!(50 * wrong <= cases.count(), "{wrong}");
}

/// How far a figure is from the truth, in standard errors; one that is missing says nothing.
fn apart(figure: Option<Figure>, truth: f64) -> f64 {
    figure.map_or(0.0, |figure| (figure.value - truth).abs() / figure.std)
}

impl Case {
    /// Whether it is good, and by how many standard errors the worst of its figures is off.
    fn judged(&self, seed: u64) -> (bool, f64) {
        let Flexible {
            inertia,
            viscous,
            coulomb,
            ..
        } = &self.found;
        let verdict = judgement::flexible(&self.found);
        let worst = apart(*inertia, 0.024)
            .max(apart(*viscous, self.viscous))
            .max(apart(*coulomb, self.coulomb));
        let show = |figure: &Option<Figure>| {
            figure.map_or("none".to_owned(), |it| {
                format!("{:.4} ± {:.4}", it.value, it.std)
            })
        };
        println!(
            "{seed}: J {}, b {} for {:.4}, Coulomb {} for {:.4}, {worst:.1}, {}",
            show(inertia),
            show(viscous),
            self.viscous,
            show(coulomb),
            self.coulomb,
            verdict.word()
        );
        (verdict == Judgement::Good, worst)
    }
}

/// How many of these are good, and how many of them have a figure that is off by more than
/// three standard errors.
fn good_and_wrong(seeds: impl Iterator<Item = u64>) -> [usize; 2] {
    let judged: Vec<(bool, f64)> = seeds.map(|seed| case(seed).judged(seed)).collect();
    let good = judged.iter().filter(|(is_good, _)| *is_good);
    let wrong = good.clone().filter(|(_, worst)| *worst > 3.0);
    [good.count(), wrong.count()]
}

#[test]
fn friction_that_is_good_is_right() {
    let [good, wrong] = good_and_wrong([0, 1, 4, 5].into_iter());
    assert_eq!(wrong, 0);
    assert!(good >= 3, "{good}");
}

#[test]
#[ignore = "minutes: cargo test --release -p gwatt-identify -- --ignored friction_at_random"]
fn friction_at_random_is_right_where_it_is_good() {
    let cases = wanted(100);
    let [even, odd] = thread::scope(|scope| {
        let half = |odd: u64| {
            let cases = cases.clone().skip(odd as usize).step_by(2);
            scope.spawn(move || good_and_wrong(cases))
        };
        [half(0), half(1)].map(|half| half.join().unwrap())
    });
    let all = cases.count();
    let [good, wrong] = [even[0] + odd[0], even[1] + odd[1]];
    println!("{good} of {all} good, {wrong} of them wrong");
    assert!(50 * wrong <= all, "{wrong}");
    assert!(10 * good >= 9 * all, "{good} of {all}");
}
