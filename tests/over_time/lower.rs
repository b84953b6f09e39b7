//! Limits over time at lower overrides: the worst of those that are looked at counts.

use std::io::Cursor;

use gwatt::machine::{Machine, OverrideAt};
use gwatt::pipeline::{
    Allowed, Failure, Law, LimitOptions, LimitSummary, Options, OverTime, Strategy, Summary,
    analyze, limit,
};

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
    Machine::from_toml("test.toml", &text).expect("a machine").0
}

fn once() -> Options {
    Options {
        once: true,
        ..Options::default()
    }
}

fn check(machine: &Machine, program: &str, options: &Options) -> Summary {
    analyze(Cursor::new(program.as_bytes()), machine, options, None).expect("a program")
}

fn limited(machine: &Machine, program: &str) -> Result<(LimitSummary, String), Failure> {
    let how = LimitOptions {
        strategy: Strategy::Optimal,
        law: Law::Exact,
        allowed: Allowed {
            feed: true,
            ..Allowed::NOTHING
        },
    };
    let (mut out, input) = (Vec::new(), Cursor::new(program.as_bytes()));
    let summary = limit(input, machine, &Options::default(), how, &mut out, None)?;
    Ok((summary, String::from_utf8_lossy(&out).into_owned()))
}

fn at(machine: &Machine, feed: f64, rapid: f64) -> Machine {
    let mut machine = machine.clone();
    machine.limits.override_at = Some(OverrideAt {
        feed,
        rapid,
        spindle: 1.0,
    });
    machine
}

#[track_caller]
fn near(found: f64, expected: f64, share: f64) {
    let off = (found - expected).abs() / expected;
    assert!(off < share, "{found}, not {expected}");
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
    assert!(any.title().contains("rapid 50 %"), "{}", any.title());
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

/// The figures are the worst of the overrides that are looked at, whichever they are.
#[test]
fn the_worst_of_all_rungs_counts() {
    let ratings = "continuous_power_w = 400\nwindow_s = 5\n\
                   capacitance_f = 1e-3\nbus_nominal_v = 600\nbus_max_v = 800\n\
                   brake_power_w = 100\nbrake_energy_j = 900";
    let machine = lift(ratings, "viscous_n_s_m = 100\ncoulomb_n = 30");
    let program = "G90 G21\nG1 Z100 F20000\nG4 P1\nG0 Z900\nG1 X50 Z1000\nG0 X0 Z-200\n";
    let values = |machine: &Machine| -> Vec<f64> {
        let found = check(machine, program, &Options::default()).over_time;
        found
            .iter()
            .map(|found| found.rating.load_ratio())
            .collect()
    };
    let any = values(&machine);
    assert!(any.len() >= 3, "{any:?}");
    let mut most = values(&at(&machine, 1.0, 1.0));
    for step in 1..10 {
        let share = f64::from(step) / 10.0;
        let found = values(&at(&machine, share, share));
        for (most, found) in most.iter_mut().zip(found) {
            *most = most.max(found);
        }
    }
    for (any, most) in any.iter().zip(&most) {
        assert!(any >= most, "{any} {most}");
        assert!(*any <= most * 1.3, "{any} {most}");
    }
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
            .any(|it| it.contains("between these overrides"))
    };
    let machine = lift("brake_power_w = 100\nbrake_energy_j = 900", "");
    assert!(said(&machine));
    assert!(!said(&at(&machine, 1.0, 1.0)));
    assert!(!said(&lift("", "")));
}
