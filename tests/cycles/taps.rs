//! Taps whose F is the pitch, or may be, and words of cycles that are those of tools elsewhere.
//!
//! Sources: Mazak EIA/ISO programming manual, "Fixed cycle functions", G74 and G84; Mitsubishi
//! M700V programming manual, "Tapping cycle".

use std::sync::Arc;

use gwatt::interpret::ToolTable;
use gwatt::pipeline::{Options, Reading};
use insta::assert_snapshot;

use super::{moves, moves_with};
use crate::fanuc::messages;
use crate::listing::{errors_of, in_full, machine_of};
use crate::runs::moves_of;

/// H from 1 on: F is the pitch, and the way out has H percent of the speed; H0: a feed per
/// minute. It holds until the cycle ends.
#[test]
fn h_of_a_tap_on_a_mazak() {
    let program = "S1000 M3\nG0 Z10.\nG99 G84 X1. Z-5. R2. F1. H200\nX2.\nX3. H0\nX4. H50\nG80\n";
    assert_snapshot!(moves("mazak", program), @r"
    2 rapid 0 0 10
    3 rapid 1 0 10
    3 rapid 1 0 2
    3 tap 1 0 -5 F1000
    3 tap 1 0 2 F2000
    4 rapid 2 0 2
    4 tap 2 0 -5 F1000
    4 tap 2 0 2 F2000
    5 rapid 3 0 2
    5 tap 3 0 -5 F1
    5 tap 3 0 2 F1
    6 rapid 4 0 2
    6 tap 4 0 -5 F1000
    6 tap 4 0 2 F1000
    ");
}

/// It holds for its own cycle alone: after another one both meanings of F count again.
#[test]
fn h_of_a_tap_ends_with_its_cycle() {
    let program =
        "S1000 M3\nG0 Z10.\nG99 G84 X1. Z-5. R2. F1.25 H0\nG81 X2. Z-5.\nG84 X3. Z-5.\nG80\n";
    let taps: Vec<String> = moves("mazak", program)
        .lines()
        .filter(|line| line.contains(" tap "))
        .map(str::to_owned)
        .collect();
    assert_eq!(
        taps,
        [
            "3 tap 1 0 -5 F1.25",
            "3 tap 1 0 2 F1.25",
            "5 tap 3 0 -5 F1250",
            "5 tap 3 0 2 F1250"
        ]
    );
}

/// Only G43 chooses a length: a Z of 50 is at 101, and R at 53.
#[test]
fn h_of_a_tap_is_no_tool_length() {
    let table = ToolTable::parse(b"T1 P1 Z51\nT100 P2 Z150\n").unwrap();
    let reading = Reading {
        tools: Some(Arc::new(table)),
        ..Reading::default()
    };
    let program = "T1 M6\nS1000 M3\nG43 Z50. H1\nG84 X10. Z-10. R2. F1. H100 D0\nG80\n";
    assert_snapshot!(moves_with("mazak", program, reading), @r"
    3 rapid 0 0 101
    4 rapid 10 0 101
    4 rapid 10 0 53
    4 tap 10 0 41 F1000
    4 tap 10 0 53 F1000
    4 rapid 10 0 101
    ");
}

/// Where nothing says what F is, the faster counts: 1.25 mm at 1000 turns, or 2000 mm/min at
/// 0.5 turns.
#[test]
fn f_of_a_tap_may_be_its_pitch() {
    let program = "S1000 M3\nG0 Z10.\nG99 G84 X1. Z-5. R2. F1.25\nG80\n";
    assert_snapshot!(moves("mitsubishi", program), @r"
    2 rapid 0 0 10
    3 rapid 1 0 10
    3 rapid 1 0 2
    3 tap 1 0 -5 F1250
    3 tap 1 0 2 F1250
    ");
    let slow = "S0.5 M3\nG0 Z10.\nG99 G84 X1. Z-5. R2. F2000.\nG80\n";
    assert_snapshot!(moves("mitsubishi", slow), @r"
    2 rapid 0 0 10
    3 rapid 1 0 10
    3 rapid 1 0 2
    3 tap 1 0 -5 F2000
    3 tap 1 0 2 F2000
    ");
    assert_snapshot!(messages("mitsubishi", program).join("\n"), @r#"
    F of a tap is its pitch or a feed per minute, as a parameter of the control says: the faster counts; say tap_feed = "pitch" or "per-minute" under [language] of the machine file, on a Mazak also H in the block
    "#);
    let by_turns = program.replace("G84", "G95 G84");
    assert_snapshot!(messages("mazak", &by_turns).join("\n"), @"");
}

/// The machine file says it.
#[test]
fn f_of_a_tap_as_the_machine_file_says() {
    let program = "S1000 M3\nG0 Z10.\nG99 G84 X1. Z-5. R2. F2.\nG80\n";
    let with = |meaning: &str, program: &str| {
        let more = format!("[language]\ntap_feed = \"{meaning}\"\n");
        let machine = machine_of("mitsubishi", &more, "XYZ", "");
        let (moves, failure) = moves_of(&machine, &Options::default(), program);
        match failure {
            Some(failure) => errors_of(&failure),
            None => moves.iter().map(in_full).collect(),
        }
    };
    assert_snapshot!(with("pitch", program), @r"
    2 rapid Z10.0000
    3 rapid X1.0000
    3 rapid Z2.0000
    3 tap Z-5.0000 F2000.0000
    3 tap Z2.0000 F2000.0000
    ");
    assert_snapshot!(with("per-minute", program), @r"
    2 rapid Z10.0000
    3 rapid X1.0000
    3 rapid Z2.0000
    3 tap Z-5.0000 F2.0000
    3 tap Z2.0000 F2.0000
    ");
    let comma = program.replace("F2.", "F2. ,R1");
    assert_eq!(with("pitch", &comma), with("pitch", program));
    let other = program.replace("F2.", "F2. ,R0");
    assert_snapshot!(with("pitch", &other), @"3 cycle-word: `,R` of a tap, which says whether F is its pitch");
}

#[test]
fn words_of_taps_that_are_not_followed() {
    let all = [
        "G84 X1. Z-5. R2. F1. D3.",
        "G81 X1. Z-5. R2. F1. H3",
        "G84 X1. Z-5. R2. F1. H-1",
        "S0\nG84 X1. Z-5. R2. F1. H1",
        "G84 H1",
    ]
    .map(|block| moves("mazak", &format!("S1000 M3\nG0 Z10.\n{block}\n")));
    assert_snapshot!(all.concat(), @r"
    3 cycle-word: D of a canned cycle, a distance from R, is not followed | check the number
    3 cycle-word: H of a canned cycle that does not tap is not followed | check the number
    3 cycle-word: H of a tap is 0, or the speed of the return in percent, from 1 on | check the number
    4 no-spindle-speed: a tap whose F may be its pitch, but no spindle speed is in force | write S before it
    3 unused-word: nothing in this block uses the H word | take it out, or write the word that it belongs to
    ");
}
