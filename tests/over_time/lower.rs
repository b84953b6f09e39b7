//! Limits over time at lower overrides: a bound over all of them, and what is looked at.

use std::io::Cursor;

use gwatt::machine::Machine;
use gwatt::pipeline::{Failure, LimitSummary, Options, OverTime, Summary, analyze};

use crate::machines::machine_from;
use crate::near::assert_near;
use crate::runs::{self, WITH_FEEDS, once, turned};

/// Z lifts 100 kg without friction; what else is in the file comes on top.
fn lift(ratings: &str, rest: &str) -> Machine {
    let text = format!(
        "schema = 1\nname = \"test\"\ncontroller = \"iso\"\n\
         [path]\nmode = \"exact-stop\"\nrapid = \"independent\"\n[limits]\nmargin = 0.0\n\
         [converter]\npeak_power_w = 2100\nregen_power_w = 2100\n{ratings}\n\
         [axes.X]\nrapid_mm_min = 60000\naccel_mm_s2 = 10000\nmass_kg = 1e-9\n\
         [axes.Z]\nrapid_mm_min = 60000\naccel_mm_s2 = 10000\nmass_kg = 100\n\
         gravity_n = 980.665\n{rest}\n"
    );
    machine_from(&text)
}

fn check(machine: &Machine, program: &str, options: &Options) -> Summary {
    analyze(Cursor::new(program.as_bytes()), machine, options, None).expect("a program")
}

fn limited(machine: &Machine, program: &str) -> Result<(LimitSummary, String), Failure> {
    let (text, summary) = runs::limited(machine, &Options::default(), WITH_FEEDS, program)?;
    Ok((summary, text))
}

fn at(machine: &Machine, feed: f64, rapid: f64) -> Machine {
    turned(machine, [feed, rapid, 1.0])
}

#[track_caller]
fn near(found: f64, expected: f64, share: f64) {
    assert_near(found, expected, share * expected.abs());
}

/// 980.665 N at 1 m/s: 981 W for 2 s, and above 400 W as long as the speed is above
/// 0.408 m/s. At 50 % it is 490 W for 4 s.
#[test]
fn a_load_that_is_lifted_more_slowly_draws_for_longer() {
    let ratings = "continuous_power_w = 400\n\
                   overload = [{ power_w = 2100, seconds = 2.5, every_s = 1000 }]";
    let machine = lift(ratings, "");
    let program = "G90 G21\nG0 Z2000\nG4 P30\n";
    let overload = |machine: &Machine| check(machine, program, &once()).over_time[0].clone();
    let fits = |found: &OverTime| found.rating.fits();
    let full = overload(&at(&machine, 1.0, 1.0));
    near(full.rating.value, 2.0, 0.05);
    assert!(fits(&full), "{full:?}");
    let half = overload(&at(&machine, 1.0, 0.5));
    near(half.rating.value, 4.0, 0.03);
    assert!(!fits(&half), "{half:?}");
    let any = overload(&machine);
    assert!(
        !fits(&any) && any.rating.value >= half.rating.value,
        "{any:?}"
    );
    let knobs = any.rating.overrides.expect("a lower override");
    assert!(knobs.rapid < 0.6, "{knobs:?}");
    assert!(any.title().contains("rapid 41 %"), "{}", any.title());
    // Where it never draws more than 400 W nothing counts.
    let (summary, written) =
        limited(&machine, "G90 G21\nG1 Z2000 F60000\nG4 P30\n").expect("a program");
    assert!(summary.certified, "{:?}", summary.reasons);
    for share in [0.1, 0.35, 0.5, 0.77, 1.0] {
        let found = check(&at(&machine, share, share), &written, &Options::default());
        assert!(found.fits(), "{share}: {:?}", found.over_time);
    }
}

/// A lowered load feeds back (981 − 500·v)·v W: of 2 m at 1 m/s the resistor keeps
/// 2·(481 − 100) = 762 J beyond 100 W, at 0.4 m/s 2·(981 − 200 − 250) = 1061 J.
#[test]
fn friction_takes_less_at_a_lower_speed() {
    let machine = lift(
        "brake_power_w = 100\nbrake_energy_j = 900",
        "viscous_n_s_m = 500",
    );
    let program = "G90 G21\nG0 Z0\nG0 Z-2000\n";
    let brake = |machine: &Machine| {
        let found = check(machine, program, &once()).over_time;
        found.last().expect("a resistor").rating
    };
    near(brake(&at(&machine, 1.0, 1.0)).value, 762.0, 0.1);
    near(brake(&at(&machine, 1.0, 0.4)).value, 1061.0, 0.03);
    assert!(brake(&at(&machine, 1.0, 1.0)).fits());
    let any = brake(&machine);
    near(any.value, brake(&at(&machine, 1.0, 0.4)).value, 0.02);
    assert!(!any.fits());
}

/// Nothing is worse at a lower override, which needs no looking; it does where what is fed
/// back is out of proportion to the speed.
#[test]
fn what_the_bound_settles_is_not_looked_at() {
    let ratings = |brake_j: f64| {
        format!(
            "continuous_power_w = 900\nwindow_s = 5\n\
             overload = [{{ power_w = 2100, seconds = 3, every_s = 10 }}]\n\
             brake_power_w = 100\nbrake_energy_j = {brake_j}"
        )
    };
    let program = "G90 G21\nG1 X300 F30000\nG4 P3\nG0 Z100\nG0 Z-200\n";
    let found = |brake_j: f64, rest: &str| {
        let machine = lift(&ratings(brake_j), rest);
        check(&machine, program, &once()).over_time
    };
    for rating in found(900.0, "").iter().map(|found| found.rating) {
        assert!(rating.fits() && !rating.looked_at, "{rating:?}");
    }
    let found = found(110.0, "viscous_n_s_m = 700");
    let brake = found.last().expect("a resistor").rating;
    assert!(brake.looked_at, "{brake:?}");
}

/// The lift of 2 m misses its limit at lower overrides, which in a long program are looked at
/// once the lift of 1 m keeps the peak power.
#[test]
fn lower_overrides_are_left_open_where_the_largest_do_not_fit() {
    let ratings = "continuous_power_w = 400\n\
                   overload = [{ power_w = 2100, seconds = 3.5, every_s = 1000 }]";
    let machine = lift(
        ratings,
        "[[load]]\non = \"M8\"\noff = \"M9\"\npower_w = 500\n",
    );
    let lifts = "G90 G21\nG0 Z2000\nG4 P30\n";
    let beyond = format!("{lifts}M8\nG0 Z3000\nM9\n");
    let short = check(&machine, &beyond, &once());
    assert!(short.over_time[0].rating.is_missed());
    let long = beyond + &"G1 X1 F6000\nX0\n".repeat(10_000);
    let open = check(&machine, &long, &once());
    assert_eq!(open.unfit_count, 1);
    let rating = open.over_time[0].rating;
    assert!(rating.is_open() && !rating.fits() && !rating.is_missed());
    assert!(rating.overrides.is_none() && !rating.looked_at);
    let left = "limits over time at lower overrides are not all looked at";
    assert!(open.conditions.iter().any(|it| it.starts_with(left)));
    let settled = check(&machine, lifts, &once());
    let rating = settled.over_time[0].rating;
    assert!(rating.is_missed() && !rating.is_open() && rating.looked_at);
}

/// A load of 500 W: at a lower override more of a window is feed than pause. At 100 %
/// 3 s of 20 s, at 40 % 7.5 s.
#[test]
fn a_pause_does_not_grow_with_the_feed() {
    let ratings = "continuous_power_w = 220\nwindow_s = 20";
    let load = "[[load]]\non = \"M8\"\noff = \"M9\"\npower_w = 500\n";
    let machine = lift(ratings, load);
    let program = "G90 G21\nM8\nG1 X500 F10000\nM9\nG4 P17\n";
    let mean = |machine: &Machine| check(machine, program, &once()).over_time[0].rating;
    near(
        mean(&at(&machine, 1.0, 1.0)).value,
        500.0 * 0.15_f64.sqrt(),
        0.01,
    );
    let any = mean(&machine);
    assert!(!any.fits() && any.overrides.is_some(), "{any:?}");
    // Next to rest it lasts for ever: a limit above the load is kept.
    let machine = lift("continuous_power_w = 501\nwindow_s = 20", load);
    let any = mean(&machine);
    assert!(any.fits() && !any.looked_at, "{any:?}");
}

/// Where nothing is limited over time the conditions say nothing of it.
#[test]
fn the_conditions_say_at_which_overrides() {
    let program = "G90 G21\nG0 Z100\n";
    let said = |machine: &Machine| {
        let summary = check(machine, program, &once());
        summary
            .conditions
            .iter()
            .any(|it| it.contains("at every lower override"))
    };
    let machine = lift("brake_power_w = 100\nbrake_energy_j = 900", "");
    assert!(said(&machine));
    assert!(!said(&at(&machine, 1.0, 1.0)));
    assert!(!said(&lift("", "")));
}
