//! Numbers with a decimal point and without one in one program, where nobody has said what the
//! latter mean. Source: Fanuc B-63944EN, "Decimal Point Programming".

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io::Cursor;

use gwatt::machine::Machine;
use gwatt::pipeline::{self, Options};
use proptest::prelude::*;

use crate::listing::machine_of;
use crate::rows::Rows;

/// A mill or a lathe that knows its places; `more` stands in `[language]`.
fn machine(controller: &str, more: &str) -> Machine {
    // With exact stops: corners are no matter here.
    let offsets = "[path]\nmode = \"exact-stop\"\nrapid = \"linear\"\n[offsets]\nG54 = { X = -20, Z = -30 }\nG55 = { X = -25 }\n";
    let text = format!("{offsets}[language]\nunits = \"mm\"\n{more}\n");
    machine_of(
        controller,
        &text,
        if controller == "fanuc" { "XYZ" } else { "XZ" },
        "",
    )
}

/// The largest peak of each line, W.
fn peaks_w(machine: &Machine, program: &str) -> BTreeMap<u64, f64> {
    let mut rows = Rows::default();
    pipeline::analyze(
        Cursor::new(program),
        machine,
        &Options::default(),
        Some(&mut rows),
    )
    .unwrap_or_else(|failure| panic!("{failure:?}\n{program}"));
    let mut peaks = BTreeMap::new();
    for row in &rows.0 {
        let peak_w: &mut f64 = peaks.entry(row.line).or_default();
        *peak_w = peak_w.max(row.peak_w);
    }
    peaks
}

/// Lines whose moves are bounded, not planned: how far they go is not known.
fn unknown_ways(controller: &str, program: &str) -> Vec<u64> {
    let mut lines = Vec::new();
    let machine = machine(controller, "");
    pipeline::moves(
        Cursor::new(program),
        &machine,
        &Options::default(),
        &mut |mv, _| {
            if !mv.unknown_start.is_empty() && lines.last() != Some(&mv.line) {
                lines.push(mv.line);
            }
            Ok(())
        },
    )
    .unwrap_or_else(|failure| panic!("{failure:?}\n{program}"));
    lines
}

#[test]
fn how_far_it_is_from_one_kind_to_the_other_is_not_known() {
    let unknown = |program: &str| unknown_ways("fanuc", program);
    let begin = "G90 G54 G0 X0 Y0 Z0\n";
    let after = |lines: &str| unknown(&format!("{begin}{lines}"));
    let none: [u64; 0] = [];
    // One kind alone, and 0.
    assert_eq!(after("X50. Y20.\nX10. Y0\nX0\n"), none);
    assert_eq!(after("X50 Y20\nX10 Y0\nX0\n"), none);
    assert_eq!(after("X50.\nX0\nX10\nX0.\nX5.\n"), none);
    // From one to the other, and the direction of both.
    assert_eq!(after("X50.\nX10\nX20\nX30.\n"), [3, 5]);
    assert_eq!(after("X50. Y20\nX60. Y30.\nX70.\n"), [2, 3]);
    // Steps keep what was.
    assert_eq!(after("G91 X50.\nX10\nY5. X1\nG90 X20.\nX30.\n"), [4, 5]);
    // Levels of cycles, where they are not those of the place.
    assert_eq!(after("Z50.\nG81 X5. R2. Z-3. F100\nX9.\nG80 Z50.\n"), none);
    assert_eq!(
        after("Z50.\nG81 X5. R2 Z-3. F100\nX9.\nG80 Z50.\nX1.\n"),
        [3, 4, 5]
    );
    // Other origins: the program zero of G55 is another place.
    assert_eq!(after("X10\nX20\nG55 X20\nX30\n"), [4]);
    assert_eq!(after("X10.\nG53 X-5.\nX10.\n"), none);
    assert_eq!(after("X10\nG53 X-5.\nX10.\nG92 X3.\nX5.\n"), [3]);
    assert_eq!(after("G92 X3\nX5\nX7.\nG53 X-5.\nX5.\n"), [4, 5, 6]);
    assert_eq!(after("G52 X3\nX5\nG52 X0\n"), [3]);
    // What a macro works out from an argument without a point.
    let called = |word: &str| after(&format!("G65 P100 A{word}\nM30\nO100\nX#1\nX[#1+1]\nM99\n"));
    assert_eq!(called("5."), none);
    assert_eq!(called("5"), [5, 6]);
    // Diameters, radii and steps of lathes.
    let turned =
        |lines: &str| unknown_ways("fanuc-lathe", &format!("G97 S500 M3\nG0 X0 Z0\n{lines}"));
    assert_eq!(turned("X50. Z5.\nG90 X40. Z-20. F2.\nX30.\nG0 Z9.\n"), none);
    assert_eq!(turned("X50. Z5.\nG90 X40 Z-20. F2.\nG0 Z9.\nZ8.\n"), [4, 5]);
    assert_eq!(turned("X50. Z5.\nU-5\nW-5.\nX40. Z4.\n"), [6]);
}

#[test]
fn what_is_not_known_is_said_once_and_not_where_the_machine_file_knows() {
    let notes = |more: &str, program: &str| {
        let found = pipeline::analyze(
            Cursor::new(program),
            &machine("fanuc", more),
            &Options::default(),
            Some(&mut Rows::default()),
        )
        .unwrap();
        found.notes
    };
    let program = "G0 X50.\nX10\nX20.\n";
    let said = |more: &str| -> Vec<String> {
        let mixed = notes(more, program).into_iter();
        mixed
            .filter(|note| note.rule == "mixed-points")
            .map(|note| format!("{}: {}", note.line, note.message))
            .collect()
    };
    assert_eq!(
        said(""),
        [
            "2: how far the axes go here depends on what numbers without a decimal point mean: it \
          is taken as not known; write decimal_point under [language] in the machine file"
        ]
    );
    for known in ["calculator", "least-increment"] {
        assert!(said(&format!("decimal_point = \"{known}\"")).is_empty());
    }
}

/// A number of a random program: 0, with a point, without one.
fn number(size: i32) -> impl proptest::strategy::Strategy<Value = String> {
    prop_oneof![
        1 => Just(String::from("0")),
        3 => (-size..size).prop_map(|value| value.to_string()),
        3 => (-size..size).prop_map(|value| format!("{value}.")),
    ]
}

fn mill_block() -> impl proptest::strategy::Strategy<Value = String> {
    let pair = || (number(60), number(60));
    prop_oneof![
        4 => pair().prop_map(|(x, y)| format!("G0 X{x} Y{y}")),
        2 => pair().prop_map(|(x, z)| format!("G0 X{x} Z{z}")),
        3 => pair().prop_map(|(x, y)| format!("G1 X{x} Y{y} F4000")),
        1 => Just(String::from("G91")),
        2 => Just(String::from("G90")),
        1 => pair().prop_map(|(x, z)| format!("G28 X{x} Z{z}")),
        1 => pair().prop_map(|(x, z)| format!("G92 X{x} Z{z}")),
        1 => number(60).prop_map(|x| format!("G52 X{x}")),
        1 => number(60).prop_map(|x| format!("G90 G53 G0 X{x}")),
        1 => prop_oneof![Just(String::from("G54")), Just(String::from("G55"))],
        2 => (number(50), 70..90, 1..9, any::<[bool; 3]>()).prop_map(|(x, from, level, points)| {
            let [a, b, c] = points.map(|point| if point { "." } else { "" });
            format!("G90 G0 Z{from}{a}\nG98 G81 X{x} Z-20{b} R{level}{c} F3000\nX5.\nG80")
        }),
    ]
}

fn lathe_block() -> impl proptest::strategy::Strategy<Value = String> {
    let pair = || (number(60), number(60));
    prop_oneof![
        4 => pair().prop_map(|(x, z)| format!("G0 X{x} Z{z}")),
        2 => pair().prop_map(|(u, z)| format!("G0 U{u} Z{z}")),
        3 => pair().prop_map(|(x, w)| format!("G1 X{x} W{w} F2.")),
        1 => pair().prop_map(|(u, w)| format!("G28 U{u} W{w}")),
        1 => pair().prop_map(|(x, z)| format!("G50 X{x} Z{z}")),
        2 => pair().prop_map(|(x, z)| format!("G90 X{x} Z{z} F2.\nG0 Z5.")),
    ]
}

/// No line draws less than with either meaning of its numbers.
fn holds_for_both(controller: &str, program: &str) -> Result<(), TestCaseError> {
    let unknown = peaks_w(&machine(controller, ""), program);
    for meaning in ["calculator", "least-increment"] {
        let known = machine(controller, &format!("decimal_point = \"{meaning}\""));
        for (line, peak_w) in peaks_w(&known, program) {
            let counted_w = unknown.get(&line).copied().unwrap_or(0.0);
            prop_assert!(
                counted_w >= peak_w * (1.0 - 1e-9),
                "line {line}: {counted_w} W, {meaning} {peak_w} W\n{program}"
            );
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 96, ..ProptestConfig::default() })]

    #[test]
    fn no_line_of_a_mill_draws_less_than_with_either_meaning(
        blocks in prop::collection::vec(mill_block(), 2..12),
    ) {
        let mut program = String::from("G21 G90 G54\n");
        for block in &blocks {
            let _ = writeln!(program, "{block}");
        }
        holds_for_both("fanuc", &program)?;
    }

    #[test]
    fn no_line_of_a_lathe_draws_less_than_with_either_meaning(
        blocks in prop::collection::vec(lathe_block(), 2..12),
    ) {
        let mut program = String::from("G97 S500 M3\n");
        for block in &blocks {
            let _ = writeln!(program, "{block}");
        }
        holds_for_both("fanuc-lathe", &program)?;
    }
}
