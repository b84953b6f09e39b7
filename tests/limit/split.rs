//! Blocks in several pieces of one line, with stepped accelerations.

mod best;
mod lines;
mod physical;
mod printers;
mod reference;
mod refused;

use super::{RIG, Rig, Run};
use crate::rows::Rows;
use gwatt::machine::Machine;
use gwatt::pipeline::{Allowed, Certificate, Law, LimitOptions, Options, Row, Strategy, limit};

use crate::runs::{made_to_fit, rows_of};

const ISG: Rig = Rig {
    controller: "isg",
    options: Run {
        strategy: Strategy::Split,
        ..RIG.options
    },
    ..RIG
};

const HOW: LimitOptions = LimitOptions {
    strategy: Strategy::Split,
    law: Law::Exact,
    allowed: Allowed::NOTHING,
    ..LimitOptions::USUAL
};

/// The text that `limit` writes for a program that it makes fit, and its rows.
#[track_caller]
fn limited(machine: &Machine, how: LimitOptions, program: &str) -> (String, Vec<Row>) {
    let (mut text, mut rows) = (Vec::new(), Rows::default());
    let input = std::io::Cursor::new(program.as_bytes());
    let options = Options::default();
    let summary = limit(input, machine, &options, how, &mut text, Some(&mut rows));
    let summary = summary.expect("a program");
    assert!(summary.certified, "{:?}", summary.reasons);
    (String::from_utf8(text).expect("text"), rows.0)
}

/// The notes of a program that fits in the end.
#[track_caller]
fn notes(machine: &Machine, how: LimitOptions, program: &str) -> Vec<String> {
    let (_, summary) = made_to_fit(machine, &Options::default(), how, program);
    let notes = summary.before.notes.into_iter();
    let about = notes.filter(|note| note.rule == "not-split");
    about.map(|note| note.message).collect()
}

/// 500 kg, 5 m/s² and 0.5 m/s under 625 W, half of what one acceleration asks for: full
/// force up to 0.25 m/s (0.05 s, 6.25 mm), constant power up to 0.5 m/s (500·(0.25 −
/// 0.0625)/1250 = 0.075 s, 500·(0.125 − 0.015625)/1875 = 29.1667 mm), brakes in 0.1 s and
/// 25 mm, and 239.5833 mm of 300 mm are left for 0.5 m/s.
#[test]
fn pieces_come_near_the_physical_limit() {
    let rig = Rig {
        peak_w: 625.0,
        ..ISG
    };
    let physical_s = 0.05 + 0.075 + 0.1 + 239.583_333 / 500.0;
    let (text, rows) = limited(&rig.machine(), HOW, "N1 G0 X300 (far)\nN2 M30\n");
    let [row] = rows.as_slice() else {
        panic!("{rows:?}");
    };
    assert_eq!(
        (row.line, row.action, row.knob.as_str()),
        (1, "split", "G231")
    );
    let lasts_s = row.duration_after_s.unwrap();
    assert!(lasts_s > physical_s, "{lasts_s}");
    assert!(lasts_s < physical_s + 0.001 * 0.7, "{lasts_s} {physical_s}");
    let peak_w = row.peak_after_w.unwrap();
    assert!((620.0..=625.0).contains(&peak_w), "{peak_w}");
    // One acceleration for the block: 2.5 m/s².
    let one = LimitOptions {
        strategy: Strategy::Optimal,
        ..HOW
    };
    let (_, rows) = limited(&rig.machine(), one, "N1 G0 X300 (far)\nN2 M30\n");
    assert!((rows[0].duration_after_s.unwrap() - 0.8).abs() < 1e-3);

    // The block itself stands last, as it was; its accelerations fall until it brakes.
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines[lines.len() - 2..], ["N1 G0 X300 (far)", "N2 M30"]);
    assert_eq!(lines[lines.len() - 3], "G231 = 100");
    let places = lines.iter().filter_map(|line| line.strip_prefix("G0 X"));
    let places: Vec<f64> = places.map(|place| place.parse().unwrap()).collect();
    assert!(places.is_sorted() && *places.last().unwrap() < 300.0);
    // Full force up to 0.25 m/s, or a little less.
    assert!((4.0..6.3).contains(&places[0]), "{places:?}");
    let values = lines.iter().filter_map(|line| line.strip_prefix("G231 = "));
    let mut values: Vec<f64> = values.map(|value| value.parse().unwrap()).collect();
    assert_eq!(values.pop(), Some(100.0));
    assert!(values.is_sorted_by(|a, b| a > b), "{values:?}");
    // a = P/(m·v) at 0.5 m/s.
    assert!((49.5..=50.0).contains(values.last().unwrap()), "{values:?}");
    // Read by itself it is what was certified.
    let read = rows_of(&rig.machine(), &text);
    assert_eq!(read.len(), places.len() + 1);
    assert!(
        read.iter()
            .all(|row| row.certificate == Certificate::Planned)
    );
    let sum_s: f64 = read.iter().map(|row| row.duration_s).sum();
    assert!((sum_s - lasts_s).abs() < 1e-9);
    assert!(read.iter().all(|row| row.peak_w <= 625.0));
}

#[test]
fn inches_are_inches() {
    let rig = Rig {
        peak_w: 625.0,
        ..ISG
    };
    let (text, rows) = limited(&rig.machine(), HOW, "G70\nG0 X12 Y4\nM30\n");
    assert_eq!(rows[0].action, "split");
    for line in text.lines().filter(|line| line.starts_with("G0 X")) {
        let (x, y) = line[4..].split_once(" Y").unwrap();
        let [x, y] = [x, y].map(|it| it.parse::<f64>().unwrap());
        assert!((x - 3.0 * y).abs() < 1e-6 && x <= 12.0, "{line}");
    }
}
