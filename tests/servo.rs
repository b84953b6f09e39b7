//! Drives that follow as drives do, simulated: programs that `limit` makes fit by what
//! a machine file says are driven through machines that differ from it.

mod command;
mod drive;
mod plants;

use command::{Command, SIMULATED};
use drive::{Drive, Load, Loops};
use gwatt::machine::Machine;
use plants::{Rig, SETTINGS, Says};

use crate::limit::{RIG, run};
use crate::random::Random;

/// Step of the commands, s; drives take twice that.
const STEP_S: f64 = 1e-4;
/// Blocks of a program.
const BLOCKS: usize = 12;

/// What the plants of an experiment drew, by the converter's power.
#[derive(Debug, Clone, Copy, Default)]
struct Found {
    plants: usize,
    above: usize,
    most: f64,
}

/// The program as `limit` writes it with cutting feeds, if it can be made to fit.
fn limited(machine: &Machine, program: &str) -> Option<Vec<u8>> {
    let (text, summary) = run(machine, RIG.options, program.as_bytes())
        .unwrap_or_else(|failure| panic!("{failure:?}\n{program}"));
    summary.certified.then_some(text)
}

/// Drives a program through so many plants: the first of a seed's that can be made to
/// fit.
fn drive(rig: &Rig, says: Says, seed: u64, plants: usize, found: &mut Found) {
    let (machine, _) = Machine::from_toml("rig.toml", &rig.toml(says)).expect("a machine");
    let mut random = Random::new(seed);
    let fits = (0..5).find_map(|_| limited(&machine, &plants::program(&mut random, BLOCKS)));
    let command = Command::of(&machine, &fits.expect("one of five fits"), STEP_S);
    let mut random = Random::new(seed);
    for _ in 0..plants {
        let share = rig.peak_w(&command, &mut random) / rig.peak_w;
        found.plants += 1;
        found.above += usize::from(share > 1.0);
        found.most = found.most.max(share);
    }
}

/// Every machine with every setting of its drives, with programs of its own; by
/// setting and machine.
fn experiment(
    says: Says,
    settings: &[[Loops; SIMULATED]],
    programs: u64,
    plants: usize,
) -> Vec<[Found; 3]> {
    let all = settings.iter().zip(0_u64..).map(|(loops, setting)| {
        plants::rigs().map(|rig| {
            let rig = Rig {
                loops: *loops,
                ..rig
            };
            let mut found = Found::default();
            for number in 0..programs {
                drive(&rig, says, 1000 * number + setting, plants, &mut found);
            }
            found
        })
    });
    all.collect()
}

/// ω = 4·Kv and the speed fed forward: the answer to a step of acceleration is
/// `1 − (1 − p·t)·e^{-p·t}` with p = 2·Kv, at most 1 + e⁻² at p·t = 2. Viscous friction
/// and weight come on top of the force; the loop holds the weight at rest.
#[test]
fn a_simulated_drive_follows_as_the_formula_says() {
    let loops = Loops {
        position_gain_1_s: 50.0,
        velocity_bandwidth_hz: 200.0 / std::f64::consts::TAU,
        velocity_integral_time_s: 0.0,
        velocity_feedforward: 1.0,
        acceleration_feedforward: 0.0,
    };
    let load = Load {
        mass: 10.0,
        coulomb: 0.0,
        viscous: 0.0,
        gravity: 30.0,
        efficiency: 0.5,
        copper: 0.0,
    };
    let mut drive = Drive::new(loops, 10.0, load);
    let dt = 2.0 * STEP_S;
    let wanted = |t: f64| [t * t, 2.0 * t, 2.0];
    let mut most = 0.0_f64;
    for step in 0..500 {
        let t = f64::from(step) * dt;
        let [_, force] = drive.now(wanted(t));
        most = most.max(force);
        let x = 100.0 * t;
        let expected = 30.0 + 20.0 * (1.0 - (1.0 - x) * libm::exp(-x));
        assert!(
            (force - expected).abs() < 1e-4,
            "{t} s: {force} N, not {expected}"
        );
        drive.step([wanted(t), wanted(t + 0.5 * dt), wanted(t + dt)], dt);
    }
    assert!(
        (most - 30.0 - 20.0 * (1.0 + libm::exp(-2.0))).abs() < 1e-3,
        "{most} N"
    );
    assert_eq!(
        [load.power_w(2.0, 30.0), load.power_w(2.0, -30.0)],
        [120.0, -30.0]
    );
}

/// 40 N of friction hold what 39 N push.
#[test]
fn a_simulated_drive_sticks() {
    let loops = Loops {
        velocity_feedforward: 0.0,
        ..SETTINGS[0].1[0]
    };
    let load = Load {
        mass: 10.0,
        coulomb: 40.0,
        viscous: 0.0,
        gravity: 0.0,
        efficiency: 1.0,
        copper: 0.0,
    };
    // 10 kg · ω · Kv for each metre.
    let per_m = 10.0 * std::f64::consts::TAU * 40.0 * 40.0;
    for (force, moves) in [(39.0, false), (41.0, true)] {
        let mut drive = Drive::new(loops, 10.0, load);
        let wanted = [force / per_m, 0.0, 0.0];
        drive.step([wanted; 3], 1e-4);
        let [v, found] = drive.now(wanted);
        assert_eq!(v > 0.0, moves);
        assert!((found - force).abs() < 0.1, "{found} N");
    }
}

/// With all that is known in the machine file no margin is needed.
const ALL: Says = Says {
    errors: true,
    servo: true,
    margin: 0.0,
};

fn named() -> Vec<[Loops; SIMULATED]> {
    SETTINGS.iter().map(|(_, loops)| *loops).collect()
}

#[track_caller]
fn none_above(all: &[[Found; 3]], plants: usize) {
    assert_eq!(
        all.iter().flatten().map(|it| it.plants).sum::<usize>(),
        plants
    );
    assert!(all.iter().flatten().all(|it| it.above == 0), "{all:?}");
}

#[test]
fn no_plant_within_what_is_stated_draws_more() {
    none_above(&experiment(ALL, &named(), 1, 4), 60);
}

#[test]
#[ignore = "takes two minutes: cargo test -- --ignored thousand_plants"]
fn a_thousand_plants_within_what_is_stated_draw_no_more() {
    let mut random = Random::new(7);
    let mut settings = named();
    settings.extend((0..5).map(|_| plants::any_loops(&mut random)));
    let all = experiment(ALL, &settings, 2, 17);
    none_above(&all, 1020);
    // What is stated is not more than needed: some plant comes near.
    let most = all.iter().flatten().map(|it| it.most).fold(0.0, f64::max);
    assert!(most > 0.95, "{all:?}");
}

/// The same programs, limited by a file that says nothing.
#[test]
fn what_is_not_stated_is_not_covered() {
    let says = Says {
        errors: false,
        servo: false,
        ..ALL
    };
    let rig = Rig {
        loops: SETTINGS[1].1,
        ..plants::rigs()[0]
    };
    let mut found = Found::default();
    for seed in 0..3 {
        drive(&rig, says, 1000 * seed + 1, 3, &mut found);
    }
    assert!(found.above > 0 && found.most < 1.6, "{found:?}");
}

#[test]
#[ignore = "prints the table of docs/accuracy.md: ten minutes: cargo test -- --ignored --nocapture what_each"]
fn what_each_choice_bears() {
    let choices = [
        (0.0, false, false),
        (0.0, true, false),
        (0.0, false, true),
        (0.0, true, true),
        (0.1, false, false),
        (0.1, true, false),
        (0.1, false, true),
    ];
    for (margin, errors, servo) in choices {
        let says = Says {
            errors,
            servo,
            margin,
        };
        println!("margin {margin}, errors {errors}, servo {servo}");
        for (row, (name, _)) in experiment(says, &named(), 4, 17).iter().zip(SETTINGS) {
            let cells = row.map(|found| {
                let percent = 100.0 * found.most;
                format!("{:3} of {} {percent:6.1} %", found.above, found.plants)
            });
            println!("  {name:18} {}", cells.join(" | "));
        }
    }
}
