//! What lower overrides make of steps of speed, limits of jerk, losses and friction:
//! cases in which the largest override alone is not the worst.

use super::{Dice, at, peaks};
use gwatt::machine::Machine;

use crate::machines::{linear_axes, machine_from};

/// Rapid in mm/min, acceleration in mm/s², mass in kg, friction in N, and what else.
type Axis = (f64, f64, f64, f64, &'static str);

fn machine(controller: &str, path: &str, axes: &[(&str, Axis)]) -> Machine {
    let axes = axes
        .iter()
        .map(|(axis, (rapid, accel, mass, coulomb, more))| {
            let more = format!("coulomb_n = {coulomb}\n{more}");
            linear_axes(axis, [*rapid, *accel, *mass], &more)
        });
    machine_from(&format!(
        "schema = 1\nname = \"test\"\ncontroller = \"{controller}\"\n[path]\n{path}\n\
         [converter]\npeak_power_w = 1e6\nregen_power_w = 1e6\n[limits]\nmargin = 0.0\n{}",
        axes.collect::<String>()
    ))
}

/// The largest peaks of a program.
pub(super) fn most(machine: &Machine, program: &str) -> [f64; 2] {
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

/// RepRapFirmware with the chords and the steps of 3.2.
const LONG_CHORDS: &str = "rapid = \"linear\"\n[look_ahead]\n\
    chords = { max_mm = 2, min_mm = 0.1, per_second = 50, round_up = true }\n\
    [look_ahead.speed_step]\nstep_mm_s = { X = 15, Y = 15, Z = 0.2, E = 20 }";

/// At 60 % the last line is so slow that the arc has to brake for it, though it runs faster
/// than its curvature would permit: its chords know nothing of that.
#[test]
fn an_arc_of_chords_that_brakes_for_a_slower_line_after_the_next() {
    let axes = [
        ("X", (7590.0, 409.0, 42.18, 7.0, "efficiency = 0.789")),
        ("Y", (41791.0, 536.0, 14.39, 1.7, "efficiency = 0.784")),
        ("Z", (32649.0, 923.0, 23.26, 7.3, "gravity_n = 3.91")),
    ];
    let machine = machine("reprap", LONG_CHORDS, &axes);
    let program = "G1 X-3.3313 Y-16.5564 Z-5.3047 F6122.1\nG3 X-2.3377 Y-16.6766 I0.5610 J0.4707 F11446.2\n\
                   G0 X-1.7933 Y-16.2782\nG1 X108.9471 Y55.0388 F1207.5\n";
    let fed_back = |share: f64| peaks(&at(&machine, share, share), program)[1][1];
    assert!(fed_back(0.6) > 1.05 * fed_back(1.0));
    covers(&machine, program, 2.0);
}

/// At lower overrides its chords are shorter: the first points closer to where the arc begins,
/// and is steeper.
#[test]
fn an_arc_whose_first_chord_is_steeper_at_a_lower_feed() {
    let axes = [
        (
            "X",
            (
                15614.0,
                831.0,
                6.36,
                1.6,
                "efficiency = 0.795\ncopper_w_n2 = 0.0215",
            ),
        ),
        ("Y", (28635.0, 419.0, 5.1, 1.5, "efficiency = 0.618")),
    ];
    let machine = machine("reprap", LONG_CHORDS, &axes);
    let program = "G2 X-1.1759 Y2.1683 I1.6286 J2.2863 F891.2\n";
    let drawn = |share: f64| most(&at(&machine, share, share), program)[0];
    assert!(drawn(0.25) > 1.01 * drawn(1.0));
    let any = most(&machine, program)[0];
    assert!((1.0..1.1).contains(&(any / drawn(0.25))), "{any}");
    covers(&machine, program, 5.0);
}

/// With limits of jerk the short arc is one S-curve at 70 %, and its end is passed faster than
/// at 100 %, where each chord has one of its own.
#[test]
fn a_joint_of_s_curves_that_is_passed_faster_at_a_lower_feed() {
    let axes = [
        (
            "X",
            (
                14299.0,
                554.0,
                94.77,
                5.1,
                "efficiency = 0.651\njerk_mm_s3 = 15930",
            ),
        ),
        (
            "Y",
            (
                9481.0,
                3562.0,
                23.66,
                3.3,
                "efficiency = 0.841\njerk_mm_s3 = 24886",
            ),
        ),
    ];
    let mut machine = machine("reprap", LONG_CHORDS, &axes);
    // With limits of jerk the robust bound would count where how much is seen is not known.
    let rules = machine.controller.planner.look_ahead.as_mut();
    rules.expect("rules").blocks_at_most = None;
    let program = "G3 X-0.7080 Y-0.2650 I0.1585 J-1.5017 F8729.4\nG1 X-0.6631 Y-1.5102 F1188.3\n";
    let fed_back = |share: f64| most(&at(&machine, share, share), program)[1];
    assert!(fed_back(0.7) > 1.2 * fed_back(1.0));
    covers(&machine, program, 30.0);
}

/// The slower Z brakes the less it gives back, and copper takes as much: at 6 % a step after
/// a ramp draws more than at 100 %.
#[test]
fn a_step_of_a_slow_axis_that_loses_power_in_copper() {
    let axes = [
        (
            "X",
            (
                21194.0,
                563.0,
                7.89,
                2.0,
                "efficiency = 0.799\ncopper_w_n2 = 0.0040308\ngravity_n = -0.57",
            ),
        ),
        (
            "Y",
            (
                27132.0,
                1843.0,
                36.09,
                9.6,
                "efficiency = 0.836\ncopper_w_n2 = 0.0001785\ngravity_n = -10.08",
            ),
        ),
        (
            "Z",
            (
                21238.0,
                529.0,
                103.86,
                4.4,
                "efficiency = 0.640\ncopper_w_n2 = 0.0027801\ngravity_n = -16.20",
            ),
        ),
    ];
    let machine = machine("reprap", LONG_CHORDS, &axes);
    let program = "G1 X0.3028 Y0.2080 Z0.1387 F6421.5\nG1 X0.8861 Y0.4169 Z0.0043 F18995.5\n";
    let drawn = |share: f64| most(&at(&machine, share, share), program)[0];
    assert!(drawn(0.042) > drawn(1.0));
    covers(&machine, program, 2.0);
}

/// At 47 % the first line brakes for 2 ms before the corner, not 6: within the drives' mean
/// there is less that takes from the step.
#[test]
fn a_step_after_a_ramp_that_is_shorter_at_a_lower_feed() {
    let x = "efficiency = 0.612\ncopper_w_n2 = 0.0102837\nviscous_n_s_m = 0.807\ngravity_n = 1.3";
    let y = "efficiency = 0.706\ncopper_w_n2 = 0.0002528\nviscous_n_s_m = 4.49\ngravity_n = 10.88";
    let z = "efficiency = 0.752\ncopper_w_n2 = 0.0033497\nviscous_n_s_m = 2.148";
    let axes = [
        ("X", (18972.0, 1269.0, 30.1, 3.9, x)),
        ("Y", (8574.0, 2418.0, 25.28, 1.9, y)),
        ("Z", (35999.0, 1182.0, 6.72, 3.6, z)),
    ];
    let machine = machine("klipper", "rapid = \"linear\"", &axes);
    let program = "G1 X0.2206 Y-0.1821 F1550.6\nG1 X1.2118 Y-0.2182 Z-0.2511 F5595.1\n\
                   G1 X45.0307 Y-1.8112 F709.7\n";
    covers(&machine, program, 1.3);
}

/// The drives' means on both sides of a joint are bounded closely: what is shown for all
/// overrides is not below what is shown for one.
#[test]
fn a_bound_of_means_is_close() {
    let axes = [
        (
            "X",
            (
                14250.0,
                540.0,
                63.64,
                2.8,
                "efficiency = 0.911\ncopper_w_n2 = 0.0024012",
            ),
        ),
        (
            "Y",
            (
                11199.0,
                1299.0,
                13.7,
                4.6,
                "efficiency = 0.656\ncopper_w_n2 = 0.0032633",
            ),
        ),
    ];
    let machine = machine("klipper", "rapid = \"linear\"", &axes);
    let program = "G1 X1.0338 Y0.2167 F10992.3\nG2 X1.5376 Y0.6074 I1.1452 J-0.9565 F832.8\n\
                   G1 X4.0691 Y0.5987 F2286\n";
    for percent in 60..100 {
        let share = f64::from(percent) / 100.0;
        let one = most(&at(&machine, share, share), program)[0];
        assert!(
            one <= most(&machine, program)[0] * (1.0 + 1e-6),
            "{percent}"
        );
    }
}

/// The blend before the third line is passed at the pace of the second, and the third brakes
/// from there: at 5 % to 0.7 mm/s, where Y gives back next to nothing of what copper takes.
#[test]
fn a_slow_line_after_a_blend_that_is_passed_at_the_pace_of_a_faster_one() {
    let axes = [
        (
            "X",
            (
                36028.0,
                917.0,
                21.56,
                1.5,
                "efficiency = 0.905\ncopper_w_n2 = 0.0063597",
            ),
        ),
        (
            "Y",
            (
                9775.0,
                4516.0,
                71.64,
                1.7,
                "efficiency = 0.606\ncopper_w_n2 = 0.0001826\ngravity_n = 81.91",
            ),
        ),
        (
            "Z",
            (
                11482.0,
                487.0,
                12.51,
                2.9,
                "efficiency = 0.906\ngravity_n = 1.73",
            ),
        ),
    ];
    let machine = machine("linuxcnc", "rapid = \"linear\"", &axes);
    let program = "G64 P0.05\nG3 X0.0230 Y-0.0032 I0.0281 J0.1181 Z0.0167 F3627.9\n\
         G1 X1.1421 Y-0.0971 F12093.3\nG3 X1.2635 Y-0.1206 I0.1438 J0.4167 Z-0.0732 F16282.0\n\
         G1 X1.9661 Y-0.5275 F737.6\nG3 X2.9250 Y-2.1976 I2.2260 J0.1678 F20815.1\n";
    let drawn = |machine: &Machine| peaks(machine, program)[3][0];
    let slow = drawn(&at(&machine, 0.0545, 0.0545));
    assert!(slow > 4.0);
    assert!(slow <= drawn(&machine));
    // What is fed back is bounded loosely.
    covers(&machine, program, 12.0);
}

/// With limits of jerk an arc may be braked wherever it turns: at 17 % Z gives back more than
/// at 100 %.
#[test]
fn a_helix_with_jerk_that_gives_back_more_at_a_lower_feed() {
    let axes = [
        ("X", (27289.0, 498.0, 59.5, 3.6, "efficiency = 0.648")),
        (
            "Y",
            (
                19878.0,
                644.0,
                40.39,
                2.0,
                "efficiency = 0.896\njerk_mm_s3 = 191015",
            ),
        ),
        (
            "Z",
            (
                29702.0,
                2791.0,
                136.45,
                27.1,
                "efficiency = 0.728\njerk_mm_s3 = 238509",
            ),
        ),
    ];
    // As one chord: with two of them it is the other way round.
    let rest = "rapid = \"linear\"\n[look_ahead]\nchords = { round_up = false }";
    let machine = machine("marlin", rest, &axes);
    let program = "G1 X-1.1631 Y1.9483 F634.9\n\
                   G3 X-1.3037 Y2.1524 I-1.6435 J-0.9812 Z-0.7386 F10468.5\n";
    let fed_back = |share: f64| most(&at(&machine, share, share), program)[1];
    assert!(fed_back(0.1655) > 1.02 * fed_back(1.0));
    covers(&machine, program, 6.0);
}

/// The blend at the end of the second line speeds up from 5 mm/s there; from a lower speed it
/// does so for longer, and turned further towards the heavy axis.
#[test]
fn a_blend_that_speeds_up_for_longer() {
    let machine = machine("linuxcnc", "rapid = \"linear\"", &LIGHT_AND_HEAVY);
    let program = "G64\nG1 Y2.8 F300\nG1 Z0.601 F8000\n";
    let drawn = |share: f64| most(&at(&machine, share, share), program)[0];
    assert!(drawn(0.3) > 1.01 * drawn(1.0));
    assert!(most(&machine, program)[0] < 1.1 * drawn(0.3));
}

const LIGHT_AND_HEAVY: [(&str, Axis); 2] = [
    ("Y", (24000.0, 1000.0, 5.0, 200.0, "efficiency = 0.8")),
    ("Z", (9000.0, 1000.0, 400.0, 200.0, "efficiency = 0.8")),
];

/// With limits of jerk a short line after a corner is not known to be planned again. At 40 %
/// the corner holds nothing back, and is passed faster than the short line alone would let it.
#[test]
fn a_corner_before_a_short_line_with_limits_of_jerk() {
    let axes = [
        ("X", (8676.0, 953.0, 6.82, 2.2, "jerk_mm_s3 = 9784")),
        ("Y", (12607.0, 4385.0, 64.49, 35.1, "jerk_mm_s3 = 102623")),
        ("Z", (43772.0, 1374.0, 28.5, 11.3, "jerk_mm_s3 = 241884")),
    ];
    let machine = machine("linuxcnc", "rapid = \"linear\"", &axes);
    let program = "G64 P0.05\nG1 X21.0359 Y-27.0287 Z-4.3775 F9197.9\n\
                   G1 X21.2866 Y-27.3508 F3054.3\nG0 X23.6842 Y-30.4314\n";
    covers(&machine, program, 4.0);
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
            let accel = dice.scale(400.0, 8000.0);
            let jerk: &'static str =
                ["jerk_mm_s3 = 9000", "jerk_mm_s3 = 60000"][usize::from(dice.chance(0.5))];
            (
                dice.scale(7000.0, 60000.0),
                accel,
                dice.scale(5.0, 160.0),
                dice.scale(2.0, 90.0),
                jerk,
            )
        };
        let axes = [("X", axis()), ("Y", axis())];
        let machine = machine("iso", "rapid = \"independent\"", &axes);
        let program = format!(
            "G0 X{:.2} Y{:.2}\n",
            dice.scale(1.0, 900.0),
            dice.scale(1.0, 900.0)
        );
        covers(&machine, &program, 2.0);
    }
}
