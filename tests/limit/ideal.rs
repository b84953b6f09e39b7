//! What a word for acceleration would bring.

use std::io::{self, Cursor};

use super::{EXACT_STOP, RIG, Rig};
use gwatt::pipeline::{Ideal, LimitOptions, LimitSummary, Options, ideal, limit};

fn found(rig: &Rig, how: LimitOptions, program: &str) -> (LimitSummary, Option<Ideal>) {
    let (machine, options) = (rig.machine(), Options::default());
    let input = || Cursor::new(program.as_bytes());
    let limited = limit(input(), &machine, &options, how, io::sink(), None).expect("a program");
    let ideal = ideal(input(), &machine, &options, how, &limited).expect("a program");
    (limited, ideal)
}

const STOPS: Rig = Rig {
    rest: EXACT_STOP,
    ..RIG
};

/// 1000 W are 0.4 m/s at 500 kg and 5 m/s², 0.4/0.4 + 0.4/5 = 1.08 s for 400 mm; or 4 m/s² at
/// 0.5 m/s, 0.4/0.5 + 0.5/4 = 0.925 s.
#[test]
fn the_best_pair_of_a_rapid() {
    let (limited, ideal) = found(&STOPS, LimitOptions::USUAL, "G0 X400\nM2\n");
    assert!((limited.after.duration_s - 1.08).abs() < 1e-4);
    let ideal = ideal.expect("0.155 s less");
    assert!((ideal.duration_s - 0.925).abs() < 1e-4, "{ideal:?}");
    // Each piece would end at rest.
    assert_eq!(ideal.in_pieces_s, None);
    assert_eq!(ideal.settings, [""; 0]);
}

/// 40 mm and 1 % are no gain that is worth a line, nor is one that fits already.
#[test]
fn little_is_not_said() {
    for program in ["G0 X40\nM2\n", "G1 X400 F6000\nM2\n"] {
        assert_eq!(
            found(&STOPS, LimitOptions::USUAL, program).1,
            None,
            "{program}"
        );
    }
}

/// A feed that may not be lowered would fit with less acceleration: 400/500 + 500/4000 s.
#[test]
fn what_is_refused_would_fit() {
    let (limited, ideal) = found(&STOPS, LimitOptions::USUAL, "G1 X400 F30000\nM2\n");
    assert!(!limited.certified);
    assert!((ideal.expect("it fits").duration_s - 0.925).abs() < 1e-4);
    // Nothing helps against coolant.
    let coolant = Rig {
        rest: "[path]\nmode = \"exact-stop\"\n[[load]]\non = \"M8\"\noff = \"M9\"\npower_w = 1500",
        ..STOPS
    };
    let (limited, ideal) = found(&coolant, LimitOptions::USUAL, "M8\nG1 X400 F30000\nM2\n");
    assert!(!limited.certified);
    assert_eq!(ideal, None);
}

/// Where the control has a word that acts between moves, pieces are what is left.
#[test]
fn pieces_where_there_is_a_word() {
    let isg = Rig {
        controller: "isg",
        peak_w: 500.0,
        ..RIG
    };
    let (limited, ideal) = found(&isg, LimitOptions::USUAL, "G0 X300\nM30\n");
    // One acceleration, 2 m/s²: 0.3/0.5 + 0.5/2 s. In pieces full force up to 0.2 m/s (0.04 s,
    // 4 mm), constant power up to 0.5 m/s (0.105 s, 39 mm), brakes (0.1 s, 25 mm), and 232 mm
    // at 0.5 m/s: 0.709 s.
    assert!((limited.after.duration_s - 0.85).abs() < 1e-3);
    let split_s = ideal
        .clone()
        .and_then(|ideal| ideal.in_pieces_s)
        .expect("pieces");
    assert!((0.709..0.7105).contains(&split_s), "{split_s}");
    let ideal = ideal.expect("0.14 s");
    assert_eq!(ideal.settings, ["--strategy split writes blocks in pieces"]);
}

#[test]
fn what_the_profile_knows_is_named() {
    let linuxcnc = Rig {
        controller: "linuxcnc",
        ..RIG
    };
    let program = "G21 G90 G61.1\nG0 X400\nG0 X0\nG0 X400\nM2\n";
    let (_, ideal) = found(&linuxcnc, LimitOptions::USUAL, program);
    assert_eq!(
        ideal.expect("a gain").settings,
        [
            "acceleration under [outputs] of the machine file, once M68 is wired to it (`gwatt \
             machine show linuxcnc` has the lines)"
        ]
    );
}
