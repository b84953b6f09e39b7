//! Random programs on random machines: what they draw and feed back at any override is no more
//! than their figures say.

use super::features::most;
use super::{CONTROLLERS, Dice, at};
use std::fmt::Write as _;

use crate::machines::machine_from;

/// X, Y and Z with some of limits of jerk, losses in copper, viscous friction, weights.
fn any_axes(dice: &mut Dice, controller: &str, mode: &str) -> String {
    let mut text = format!(
        "schema = 1\nname = \"test\"\ncontroller = \"{controller}\"\n[path]\n{mode}\n\
         [converter]\npeak_power_w = 1e6\nregen_power_w = 1e6\n[limits]\nmargin = 0.0\n"
    );
    let [jerk, copper, viscous, weight] = [0.4, 0.4, 0.4, 0.4].map(|share| dice.chance(share));
    for axis in ["X", "Y", "Z"] {
        let (accel, mass) = (dice.scale(400.0, 8000.0), dice.scale(5.0, 160.0));
        let force = accel * mass / 1000.0;
        let _ = writeln!(
            text,
            "[axes.{axis}]\nrapid_mm_min = {:.0}\naccel_mm_s2 = {accel:.0}\nmass_kg = {mass:.2}\n\
             coulomb_n = {:.1}\nefficiency = {:.3}",
            dice.scale(7000.0, 60000.0),
            dice.scale(1.0, 0.3 * force + 2.0),
            dice.scale(0.6, 0.95)
        );
        if jerk && dice.chance(0.8) {
            let _ = writeln!(text, "jerk_mm_s3 = {:.0}", accel * dice.scale(3.0, 300.0));
        }
        if copper && dice.chance(0.8) {
            let _ = writeln!(text, "copper_w_n2 = {:.7}", dice.scale(0.01, 0.5) / force);
        }
        if viscous && dice.chance(0.8) {
            let _ = writeln!(text, "viscous_n_s_m = {:.3}", force * dice.scale(0.02, 3.0));
        }
        if weight && dice.chance(0.8) {
            let _ = writeln!(text, "gravity_n = {:.2}", (dice.unit() - 0.5) * force);
        }
    }
    text
}

/// Lines, rapids and arcs, some of which go on where the last one ended.
fn any_path(dice: &mut Dice, controller: &str) -> String {
    let mut text = String::new();
    if controller == "linuxcnc" {
        let _ = writeln!(
            text,
            "{}",
            ["G64", "G64 P0.05", "G61"][(dice.unit() * 3.0) as usize]
        );
    }
    let (mut x, mut y, mut z, mut turn) = (0.0, 0.0, 0.0, dice.unit() * 6.25);
    let short = dice.chance(0.4);
    for block in 0..=(dice.unit() * 6.0) as usize {
        let length = if short && dice.chance(0.7) {
            dice.scale(0.1, 3.0)
        } else {
            dice.scale(0.3, 150.0)
        };
        if dice.chance(0.6) {
            turn += (dice.unit() + dice.unit() - 1.0) * 1.2;
        }
        let (sin, cos) = libm::sincos(turn);
        if dice.chance(0.3) {
            // An arc that begins where the path leads.
            let left = dice.chance(0.5);
            let sense = if left { 1.0 } else { -1.0 };
            let radius = length.min(60.0);
            let sweep = sense * dice.scale(0.1, 3.0);
            let (i, j) = (-sense * sin * radius, sense * cos * radius);
            let (sin, cos) = libm::sincos(sweep);
            x += i - (i * cos - j * sin);
            y += j - (i * sin + j * cos);
            turn += sweep;
            let _ = write!(
                text,
                "G{} X{x:.4} Y{y:.4} I{i:.4} J{j:.4}",
                if left { 3 } else { 2 }
            );
        } else {
            (x, y) = (x + length * cos, y + length * sin);
            if block > 0 && dice.chance(0.2) {
                let _ = writeln!(text, "G0 X{x:.4} Y{y:.4}");
                continue;
            }
            let _ = write!(text, "G1 X{x:.4} Y{y:.4}");
        }
        if dice.chance(0.25) {
            z += (dice.unit() - 0.5) * length;
            let _ = write!(text, " Z{z:.4}");
        }
        let _ = writeln!(text, " F{:.1}", dice.scale(600.0, 40000.0));
    }
    text
}

/// How many programs draw or feed back more at some override than their figures say.
fn exceeded(seed: u64, programs: usize) -> usize {
    let mut dice = Dice(seed);
    let mut exceeded = 0;
    for program in 0..programs {
        let (controller, mode) = match program % 8 {
            5 => ("linuxcnc", "mode = \"exact-stop\""),
            6 => ("iso", "mode = \"exact-stop\"\nrapid = \"linear\""),
            7 => ("iso", "mode = \"exact-stop\"\nrapid = \"independent\""),
            index => (CONTROLLERS[index], "rapid = \"linear\""),
        };
        let axes = any_axes(&mut dice, controller, mode);
        let machine = machine_from(&axes);
        let text = any_path(&mut dice, controller);
        let any = most(&machine, &text);
        let mut worst = (0.0_f64, [1.0; 2]);
        for _ in 0..12 {
            let feed = dice.scale(0.03, 1.0);
            let rapid = if dice.chance(0.6) {
                feed
            } else {
                dice.scale(0.03, 1.0)
            };
            let one = most(&at(&machine, feed, rapid), &text);
            for side in 0..2 {
                let ratio = one[side] / any[side].max(1e-9);
                if ratio > worst.0 {
                    worst = (ratio, [feed, rapid]);
                }
            }
        }
        // The drives' means are bounded to 1e-4.
        if worst.0 > 1.0 + 1e-4 {
            let (ratio, [feed, rapid]) = worst;
            eprintln!("=== {ratio} feed={feed},rapid={rapid} {any:?}\n{axes}---\n{text}");
            exceeded += 1;
        }
    }
    exceeded
}

#[test]
fn figures_hold_at_any_override() {
    assert_eq!(exceeded(3, 80), 0);
}

#[test]
#[ignore = "many programs; run it after changes of look-ahead or of the bounds"]
fn figures_of_many_programs_hold_at_any_override() {
    let found = (100..140).map(|seed| exceeded(seed, 400)).sum::<usize>();
    assert_eq!(found, 0, "of 16,000");
}
