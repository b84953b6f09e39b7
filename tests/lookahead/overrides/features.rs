//! What lower overrides make of steps of speed, limits of jerk, losses and friction:
//! cases in which the largest override alone is not the worst.

use super::{Dice, at, peaks};
use gwatt::machine::Machine;
use std::fmt::Write as _;

/// Rapid in mm/min, acceleration in mm/s², mass in kg, friction in N, and what else.
type Axis = (f64, f64, f64, f64, &'static str);

fn machine(controller: &str, path: &str, axes: &[(&str, Axis)]) -> Machine {
    let mut text = format!(
        "schema = 1\nname = \"test\"\ncontroller = \"{controller}\"\n[path]\n{path}\n\
         [converter]\npeak_power_w = 1e6\nregen_power_w = 1e6\n[limits]\nmargin = 0.0\n"
    );
    for (axis, (rapid, accel, mass, coulomb, more)) in axes {
        let _ = write!(
            text,
            "[axes.{axis}]\nrapid_mm_min = {rapid}\naccel_mm_s2 = {accel}\nmass_kg = {mass}\n\
             coulomb_n = {coulomb}\n{more}\n"
        );
    }
    Machine::from_toml("test.toml", &text).expect("a machine").0
}

/// The largest peaks of a program.
fn most(machine: &Machine, program: &str) -> [f64; 2] {
    let all = peaks(machine, program);
    let largest = |most: [f64; 2], found: &[f64; 2]| [0, 1].map(|i| most[i].max(found[i]));
    all.iter().fold([0.0; 2], largest)
}

/// How far the largest of eleven overrides lies above the bound, and how far the bound
/// above that.
#[track_caller]
fn covers(machine: &Machine, program: &str, loose: f64) {
    let any = most(machine, program);
    let mut found = [0.0_f64; 2];
    for percent in [5, 10, 20, 30, 40, 50, 60, 70, 80, 90, 100] {
        let share = f64::from(percent) / 100.0;
        let one = most(&at(machine, share, share), program);
        found = [0, 1].map(|i| found[i].max(one[i]));
    }
    for side in 0..2 {
        assert!(found[side] <= any[side] * (1.0 + 1e-6), "{found:?} {any:?}");
        assert!(any[side] <= found[side] * loose + 1e-9, "{found:?} {any:?}");
    }
}

/// At 100 % the third line brakes for 3 ms, which the drives' mean hardly sees; at 40 % it
/// brakes for longer than that before the corner.
#[test]
fn a_step_at_the_end_of_a_ramp_that_is_short_at_the_largest() {
    let axes = [
        ("X", (12657.0, 665.0, 16.49, 13.7, "efficiency = 0.629")),
        ("Y", (18318.0, 925.0, 7.28, 4.6, "efficiency = 0.716")),
    ];
    let machine = machine("reprap", "rapid = \"linear\"", &axes);
    let program = "G1 X-15.4 Y-13.3 F5089\nG1 X-16.2 Y-14.4 F13944\n\
                   G1 X-19.6 Y-16.8 F16222.8\nG1 X-58.9 Y-58.2 F12665\n";
    let fed_back = |share: f64| peaks(&at(&machine, share, share), program)[3][1];
    let any = peaks(&machine, program)[3][1];
    assert!(fed_back(0.4) > fed_back(1.0));
    assert!(fed_back(0.4) <= any, "{any}");
    covers(&machine, program, 2.5);
}

/// Copper takes F²: turned more gently an axis feeds more back.
#[test]
fn an_arc_on_axes_that_lose_power_in_copper() {
    let axes = [
        ("X", (34105.0, 518.0, 79.24, 39.2, "copper_w_n2 = 0.0012")),
        (
            "Y",
            (
                36193.0,
                6015.0,
                11.09,
                5.1,
                "copper_w_n2 = 0.00128\ngravity_n = -15.41",
            ),
        ),
        (
            "Z",
            (
                51545.0,
                4658.0,
                53.59,
                6.7,
                "copper_w_n2 = 0.00314\ngravity_n = 13.61",
            ),
        ),
    ];
    let program = "G17 G3 X-38.0099 Y9.8226 I-22.3151 J-7.8979 Z-5.412 F11977.2\n";
    for controller in ["linuxcnc", "iso"] {
        let machine = machine(controller, "mode = \"exact-stop\"", &axes);
        covers(&machine, program, 1.6);
    }
}

/// From 215 mm/s down the drive feeds back (339 − 2442·v)·v: most at 69 mm/s.
#[test]
fn friction_that_grows_with_speed() {
    let axes = [(
        "Z",
        (12928.0, 7512.0, 45.24, 3.1, "viscous_n_s_m = 2441.63"),
    )];
    let machine = machine("linuxcnc", "rapid = \"linear\"", &axes);
    covers(
        &machine,
        "G64 P0.05\nG0 Z-567\nG0 Z-7.9\nG0 Z6.6\nG0 Z993\n",
        1.05,
    );
}

/// Rapids of axes for themselves with limits of jerk: each axis at its worst.
#[test]
fn independent_rapids_with_jerk() {
    let mut dice = Dice(7);
    for _ in 0..20 {
        let mut axis = || {
            let accel = dice.between(400.0, 8000.0);
            let jerk: &'static str =
                ["jerk_mm_s3 = 9000", "jerk_mm_s3 = 60000"][usize::from(dice.chance(0.5))];
            (
                dice.between(7000.0, 60000.0),
                accel,
                dice.between(5.0, 160.0),
                dice.between(2.0, 90.0),
                jerk,
            )
        };
        let axes = [("X", axis()), ("Y", axis())];
        let machine = machine("iso", "rapid = \"independent\"", &axes);
        let program = format!(
            "G0 X{:.2} Y{:.2}\n",
            dice.between(1.0, 900.0),
            dice.between(1.0, 900.0)
        );
        covers(&machine, &program, 2.0);
    }
}
