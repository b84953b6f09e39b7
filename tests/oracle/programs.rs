//! Random programs for random machines.

use std::f64::consts::TAU;
use std::fmt::Write as _;

use super::machines::Described;
use crate::random::Random;

/// A program in mm and absolute positions, of so many blocks that move or wait.
pub fn any(random: &mut Random, machine: &Described, blocks: usize) -> String {
    let mut text = String::from("G21 G90 G17 G94\n");
    let mut at = vec![0.0; machine.axes.len()];
    let feed = |random: &mut Random| random.scale(100.0, 60_000.0).round();
    let mut written = 0;
    while written < blocks {
        match random.below(16) {
            0 if machine.max_rpm > 0.0 => {
                let word = ["M3", "M3", "M4", "M5"][random.below(4)];
                let rpm = random.within(0.0, machine.max_rpm).round();
                let _ = writeln!(text, "{word} S{rpm}");
                continue;
            }
            1 if machine.loads => {
                let _ = writeln!(text, "{}", ["M7", "M8", "M9"][random.below(3)]);
                continue;
            }
            2 => {
                let _ = writeln!(text, "G4 P{:.3}", random.within(0.0, 2.0));
            }
            3..=5 if machine.arcs => arc(random, &mut text, &mut at),
            6..=10 => {
                let words = target(random, machine, &mut at);
                let _ = writeln!(text, "G0{words}");
            }
            _ => {
                let words = target(random, machine, &mut at);
                let _ = writeln!(text, "G1{words} F{}", feed(random));
            }
        }
        written += 1;
    }
    text + "M2\n"
}

/// A program that a controller with look-ahead passes without stops: chords of
/// curves, corners, long lines, rapids.
pub fn curvy(random: &mut Random, machine: &Described, controller: &str, blocks: usize) -> String {
    let printer = ["marlin", "reprap", "klipper"].contains(&controller);
    let mut text = String::from(if printer {
        "G21\nG90\n"
    } else {
        "G21 G90 G17 G94\n"
    });
    if controller == "iso" {
        text += "G61\n";
    }
    let mut at = vec![0.0; machine.axes.len()];
    let mut written = 0;
    while written < blocks {
        match random.below(12) {
            0 if machine.max_rpm > 0.0 && !printer => {
                let rpm = random.within(0.0, machine.max_rpm).round();
                let _ = writeln!(text, "{} S{rpm}", ["M3", "M5"][random.below(2)]);
            }
            1 if machine.loads && !printer => {
                let _ = writeln!(text, "{}", ["M8", "M9"][random.below(2)]);
            }
            2..=3 => {
                let words = target(random, machine, &mut at);
                let _ = writeln!(text, "G0{words}");
                written += 1;
            }
            4 if machine.arcs && !printer => {
                arc(random, &mut text, &mut at);
                written += 1;
            }
            5..=7 => {
                let words = target(random, machine, &mut at);
                let feed = random.scale(300.0, 60_000.0).round();
                let _ = writeln!(text, "G1{words} F{feed}");
                written += 1;
            }
            _ => written += chords(random, &mut text, &mut at),
        }
    }
    text + if printer { "" } else { "M2\n" }
}

/// Some chords of a curve in XY, mm; how many.
fn chords(random: &mut Random, text: &mut String, at: &mut [f64]) -> usize {
    let count = 3 + random.below(12);
    let feed = random.scale(600.0, 60_000.0).round();
    let (chord, bend) = (random.scale(0.2, 10.0), random.within(-0.5, 0.5));
    let mut angle = random.within(0.0, TAU);
    for _ in 0..count {
        let (sin, cos) = libm::sincos(angle);
        at[0] = ((at[0] + chord * cos) * 1e4).round() / 1e4;
        at[1] = ((at[1] + chord * sin) * 1e4).round() / 1e4;
        let _ = writeln!(text, "G1 X{:.4} Y{:.4} F{feed}", at[0], at[1]);
        angle += bend;
    }
    count
}

/// Where a straight move goes: some axes, near or far.
fn target(random: &mut Random, machine: &Described, at: &mut [f64]) -> String {
    let far = random.scale(0.05, 600.0);
    let mut words = String::new();
    let first = random.below(at.len());
    for (index, position) in at.iter_mut().enumerate() {
        if index == first || random.once_in(2) {
            *position = ((*position + random.within(-far, far)) * 1e4).round() / 1e4;
            let _ = write!(words, " {}{:.4}", machine.axes[index], *position);
        }
    }
    words
}

/// An arc or a helix in XY.
fn arc(random: &mut Random, text: &mut String, at: &mut [f64]) {
    let radius = random.scale(1.0, 200.0);
    let (sin, cos) = libm::sincos(random.within(0.0, TAU));
    let round = |value: f64| (value * 1e8).round() / 1e8;
    let [i, j] = [radius * cos, radius * sin].map(round);
    let sense = if random.once_in(2) { 1.0 } else { -1.0 };
    let sweep = if random.once_in(4) {
        0.0
    } else {
        random.within(0.1, 6.2)
    };
    let (turn_sin, turn_cos) = libm::sincos(sense * sweep);
    // From the centre to the end.
    let (x, y) = (-i * turn_cos + j * turn_sin, -i * turn_sin - j * turn_cos);
    let end = if sweep == 0.0 {
        [at[0], at[1]]
    } else {
        [at[0] + i + x, at[1] + j + y].map(round)
    };
    (at[0], at[1]) = (end[0], end[1]);
    let word = if sense > 0.0 { "G3" } else { "G2" };
    let _ = write!(text, "{word} X{:.8} Y{:.8} I{i:.8} J{j:.8}", at[0], at[1]);
    if random.once_in(3) {
        at[2] = ((at[2] + random.within(-30.0, 30.0)) * 1e4).round() / 1e4;
        let _ = write!(text, " Z{:.4}", at[2]);
    }
    let _ = writeln!(text, " F{}", random.scale(100.0, 60_000.0).round());
}
