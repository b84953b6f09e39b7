//! Friction of flexible axes, at random: no wrong figure is called good.

use std::thread;

use gwatt_identify::flexible::{self, Choice, Flexible, Method};
use gwatt_identify::{Figure, Given, Judgement, Quantity, judgement};

use super::simulated::{Random, recording, wanted};
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
    let choice = Choice {
        method: Method::Iv,
        given: Given::default(),
        from_command: false,
    };
    Case {
        found: flexible::identify(&recording(torque, motion, quantity), &choice).unwrap(),
        viscous,
        coulomb,
    }
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
