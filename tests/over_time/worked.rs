//! Limits over time and peaks that are worked out by hand.

use std::io::Cursor;

use gwatt::machine::{Machine, OverrideAt};
use gwatt::pipeline::{Options, Summary, analyze};
use gwatt::power::Measure;

use crate::machines::machine_from;

/// An axis of 100 kg at 10 m/s²; `axis` are further lines of it, `converter` of the converter.
fn machine(letter: &str, axis: &str, converter: &str) -> Machine {
    let text = format!(
        "schema = 1\nname = \"test\"\ncontroller = \"iso\"\n\
         [path]\nmode = \"exact-stop\"\n[limits]\nmargin = 0.0\n\
         [converter]\n{converter}\n[axes.{letter}]\nrapid_mm_min = 200000\n\
         accel_mm_s2 = 10000\nmass_kg = 100\n{axis}\n"
    );
    let mut machine = machine_from(&text);
    machine.limits.override_at = Some(OverrideAt {
        feed: 1.0,
        rapid: 1.0,
        spindle: 1.0,
    });
    machine
}

fn check(machine: &Machine, program: &str, once: bool) -> Summary {
    let options = Options {
        once,
        ..Options::default()
    };
    let input = Cursor::new(program.as_bytes());
    analyze(input, machine, &options, None).expect("a program")
}

/// 100 kg are lifted at 1 m/s with 981 W, above 400 W from 20.2 ms on until they brake, with
/// 19 N downwards: 0.976 s at the beginning of a run, and 0.487 s at its end. A run by itself
/// keeps 1.2 s in 10 s, two do not.
#[test]
fn two_runs_overload_what_one_keeps() {
    let ratings = "peak_power_w = 2100\ncontinuous_power_w = 400\nwindow_s = 1000\n\
                   overload = [{ power_w = 2100, seconds = 1.2, every_s = 10 }]";
    let machine = machine("Z", "gravity_n = 980.665", ratings);
    let begun_s = 400.0 / (10.0 * 1980.665);
    let [first, last] = [0.976, 0.487].map(|above_s| 1000.0 * (above_s + begun_s));
    let program = format!(
        "G21 G91\nG1 Z{first:.6} F60000\nG1 Z{:.6}\nG4 P17\nG1 Z{last:.6}\nM30\n",
        -first - last
    );
    for (once, expected_s) in [(true, 0.976), (false, 1.463)] {
        let found = check(&machine, &program, once).over_time[0].rating;
        assert!(matches!(found.measure, Measure::Overload { .. }));
        assert!((found.value - expected_s).abs() < 1e-6, "{found:?}");
        assert_eq!(found.fits(), once);
    }
}

/// Braking from 2.59 m/s brings 333 J more than the 10 W that the resistor gives off, at the
/// beginning; at the end of a run 251.3 J, of which 19.3 J are gone until the next one brakes.
#[test]
fn two_runs_heat_what_one_keeps() {
    let ratings =
        "peak_power_w = 5000\nregen_power_w = 5000\nbrake_power_w = 10\nbrake_energy_j = 400";
    let machine = machine("X", "", ratings);
    // (1000·v − 10)²/(2·10⁴) J, and 5 mJ below 10 W.
    let speed = |energy_j: f64| ((2e4 * energy_j).sqrt() + 10.0) / 1000.0;
    let first = speed(333.0);
    let until_s = first / 10.0 + (5.0 - first * first / 10.0) / first;
    let last = speed(565.0 - 333.0 + 10.0 * until_s + 0.005);
    let program = format!(
        "G21 G91\nG1 X5000 F{:.5}\nG4 P60\nG1 X-5000 F{:.5}\nM30\n",
        first * 6e4,
        last * 6e4
    );
    for (once, expected_j) in [(true, 333.0), (false, 565.0)] {
        let over_time = check(&machine, &program, once).over_time;
        let found = over_time.last().expect("a resistor").rating;
        assert!(matches!(found.measure, Measure::Brake { .. }));
        assert!(
            found.value > expected_j - 1e-3 && found.value < expected_j + 0.1,
            "{found:?}"
        );
        assert_eq!(found.fits(), once);
    }
}

/// 1000 N to brake, less 60 N of friction, lose 0.0017655·940² = 1560 W in copper; a drive that
/// brakes 1.2 times as hard 0.0017655·1140² = 2294 W, which are drawn as it comes to rest. To
/// speed up takes 1984 W of losses and 0.2·1060 W.
#[test]
fn a_drive_that_brakes_harder_loses_more_in_copper() {
    let axis = "coulomb_n = 60\ncopper_w_n2 = 0.0017655\nfriction_min_ratio = 1.0\n\
                servo_factor_motor = 1.0\nservo_factor_regen = 1.2\nmass_error = 0\nfriction_error = 0";
    let machine = machine("X", axis, "peak_power_w = 5000");
    let found = check(&machine, "G21 G91\nG1 X100 F12000\nM30\n", true);
    let expected_w = 0.001_765_5 * 1140.0 * 1140.0;
    assert!((expected_w - 2294.0_f64).abs() < 1.0);
    assert!((found.peak_w - expected_w).abs() < 1e-6, "{}", found.peak_w);
}
