//! Blocks in several pieces of one line, with stepped accelerations.

mod lines;

use std::fmt::Write as _;

use super::{EXACT_STOP, RIG, Rig, Run};
use crate::rows::Rows;
use gwatt::machine::Machine;
use gwatt::pipeline::{
    Allowed, Certificate, Failure, Law, LimitOptions, Options, Row, Strategy, analyze, limit,
};

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

fn reported(machine: &Machine, program: &str) -> Vec<Row> {
    let mut rows = Rows::default();
    let input = std::io::Cursor::new(program.as_bytes());
    analyze(input, machine, &Options::default(), Some(&mut rows)).expect("a program");
    rows.0
}

/// The notes of a program that fits in the end.
#[track_caller]
fn notes(machine: &Machine, how: LimitOptions, program: &str) -> Vec<String> {
    let mut text = Vec::new();
    let input = std::io::Cursor::new(program.as_bytes());
    let summary = limit(input, machine, &Options::default(), how, &mut text, None);
    let summary = summary.expect("a program");
    assert!(summary.certified, "{program}: {:?}", summary.reasons);
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
    let read = reported(&rig.machine(), &text);
    assert_eq!(read.len(), places.len() + 1);
    assert!(
        read.iter()
            .all(|row| row.certificate == Certificate::Planned)
    );
    let sum_s: f64 = read.iter().map(|row| row.duration_s).sum();
    assert!((sum_s - lasts_s).abs() < 1e-9);
    assert!(read.iter().all(|row| row.peak_w <= 625.0));
}

/// What an axis of the reference has, SI.
struct Axis {
    share: f64,
    mass_kg: f64,
    coulomb_n: f64,
    efficiency: f64,
}

/// A line for the reference, SI.
struct Reference {
    axes: Vec<Axis>,
    length_m: f64,
    top_m_s: f64,
    accel_m_s2: f64,
}

impl Reference {
    fn power_w(&self, speed: f64, accel: f64) -> f64 {
        let powers = self.axes.iter().map(|axis| {
            let force = axis.mass_kg * axis.share * accel + axis.coulomb_n;
            (axis.share * speed * force / axis.efficiency).max(0.0)
        });
        powers.sum()
    }

    /// The shortest time under a limit of power: forwards over the levels of v² with the
    /// largest acceleration that each permits, brakes with all force, and the best of all
    /// top speeds.
    fn soonest_s(&self, limit_w: f64) -> f64 {
        const LEVELS: usize = 3000;
        let speed =
            |level: usize| (level as f64 / LEVELS as f64 * self.top_m_s * self.top_m_s).sqrt();
        let (mut up_s, mut up_m, mut best_s) = (0.0, 0.0, f64::INFINITY);
        for level in 1..=LEVELS {
            let (low, high) = (speed(level - 1), speed(level));
            let middle = f64::midpoint(low, high);
            let (mut fits, mut exceeds) = (0.0, self.accel_m_s2);
            if self.power_w(middle, exceeds) <= limit_w {
                fits = exceeds;
            }
            for _ in 0..50 {
                let accel = f64::midpoint(fits, exceeds);
                if self.power_w(middle, accel) <= limit_w {
                    fits = accel;
                } else {
                    exceeds = accel;
                }
            }
            if fits < 1e-6 {
                break;
            }
            up_s += (high - low) / fits;
            up_m += (high * high - low * low) / (2.0 * fits);
            let down_m = high * high / (2.0 * self.accel_m_s2);
            let cruise_m = self.length_m - up_m - down_m;
            if cruise_m < 0.0 {
                break;
            }
            best_s = f64::min(best_s, up_s + high / self.accel_m_s2 + cruise_m / high);
        }
        best_s
    }
}

/// Numbers from 0 to 1 (`SplitMix64`).
struct Random(u64);

impl Random {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        low + (high - low) * ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// A machine without its converter, a block for it, and both for the reference.
fn any_line(random: &mut Random) -> (String, String, Reference) {
    let count = random.between(1.0, 3.999) as usize;
    let delta: Vec<f64> = (0..count)
        .map(|_| (random.between(30.0, 900.0) * 1e3).round() / 1e3)
        .collect();
    let length = delta.iter().map(|it| it * it).sum::<f64>().sqrt();
    let (mut text, mut block) = (String::new(), String::from("G0"));
    let (mut top, mut accel) = (f64::INFINITY, f64::INFINITY);
    let mut axes = Vec::new();
    for (letter, delta) in ["X", "Y", "Z"].into_iter().zip(delta) {
        let share = delta / length;
        let (rapid, own) = (random.between(0.3, 1.0), random.between(2.0, 10.0));
        let mass = random.between(20.0, 900.0);
        let friction = mass * own * random.between(0.0, 0.2);
        let efficiency = [1.0, 0.85, 0.7][random.between(0.0, 2.999) as usize];
        top = f64::min(top, rapid / share);
        accel = f64::min(accel, own / share);
        let _ = write!(
            text,
            "[axes.{letter}]\nrapid_mm_min = {:?}\naccel_mm_s2 = {:?}\nmass_kg = {mass:?}\n\
             coulomb_n = {friction:?}\nefficiency = {efficiency:?}\n",
            rapid * 6e4,
            own * 1e3
        );
        let _ = write!(block, " {letter}{delta}");
        axes.push(Axis {
            share,
            mass_kg: mass,
            coulomb_n: friction,
            efficiency,
        });
    }
    let reference = Reference {
        axes,
        length_m: length / 1e3,
        top_m_s: top,
        accel_m_s2: accel,
    };
    (text, block, reference)
}

/// Random machines with one to three axes, friction and losses, at 90, 70, 50 and 35 % of
/// what the block draws: within half a point of the time that the physics permits, and at
/// no time more than the converter has.
#[test]
fn pieces_lose_less_than_half_a_point() {
    let mut random = Random(7);
    let mut split = 0;
    for _ in 0..8 {
        let (axes, block, reference) = any_line(&mut random);
        let free_s = reference.soonest_s(f64::INFINITY);
        let reached = reference
            .top_m_s
            .min((reference.accel_m_s2 * reference.length_m).sqrt());
        let free_w = reference.power_w(reached, reference.accel_m_s2);
        for share in [0.9, 0.7, 0.5, 0.35] {
            let limit_w = share * free_w;
            let machine = format!(
                "schema = 1\nname = \"any\"\ncontroller = \"isg\"\n[converter]\n\
                 peak_power_w = {limit_w:?}\n[limits]\nmargin = 0\n{axes}"
            );
            let machine = Machine::from_toml("any.toml", &machine)
                .expect("a machine")
                .0;
            let (text, rows) = limited(&machine, HOW, &format!("{block}\nM30\n"));
            let lasts_s = rows[0].duration_after_s.unwrap();
            let physical_s = reference.soonest_s(limit_w);
            assert!(
                lasts_s > physical_s * (1.0 - 1e-4),
                "{lasts_s} {physical_s}"
            );
            let points = 100.0 * (lasts_s - physical_s) / free_s;
            assert!(points < 0.5, "{share} {points} {free_s}\n{text}");
            split += usize::from(rows[0].action == "split");
            // The block is the last of its line, and nothing else is changed.
            assert!(text.ends_with(&format!("\n{block}\nM30\n")), "{text}");
            for row in reported(&machine, &text) {
                assert!(row.peak_w <= limit_w * (1.0 + 1e-9), "{}", row.peak_w);
            }
        }
    }
    assert!(split > 24, "{split}");
}

/// A printer's extruder goes along; its look-ahead plans the pieces with all the rest.
#[test]
fn pieces_of_printers_are_planned_with_their_neighbours() {
    let rig = Rig {
        controller: "reprap",
        peak_w: 800.0,
        rest: "[axes.E]\nrapid_mm_min = 6000\naccel_mm_s2 = 5000\nmass_kg = 0.5\n",
        ..ISG
    };
    let program = "M82\nG92 E0\nG1 X300 E30 F30000 ; out\nG1 X200 Y180 E40\nG0 X180\nG1 X0 Y0\n";
    let (text, rows) = limited(&rig.machine(), HOW, program);
    let actions: Vec<&str> = rows.iter().map(|row| row.action).collect();
    assert_eq!(actions, ["split", "split", "", "split"]);
    let mut kept = program.lines().peekable();
    for line in text.lines() {
        if kept.peek() == Some(&line) {
            kept.next();
        } else if let Some(place) = line.strip_prefix("G1 X") {
            // Of the first line E is a tenth of X, of the second (1300 − X)/10 − 70 … 40.
            let mut words = place.split(" E");
            let (x, e) = (words.next().unwrap(), words.next());
            if let (false, Some(e)) = (x.contains('Y'), e) {
                let e: f64 = e.trim_end_matches(" F30000").parse().unwrap();
                let x: f64 = x.parse().unwrap();
                assert!((e - 0.1 * x).abs() < 2e-6, "{line}");
            }
        } else {
            assert!(line.starts_with("M201 X"), "{line}");
        }
    }
    assert_eq!(kept.next(), None, "{text}");
    let one = LimitOptions {
        strategy: Strategy::Optimal,
        ..HOW
    };
    let sum = |rows: &[Row]| {
        rows.iter()
            .filter_map(|row| row.duration_after_s)
            .sum::<f64>()
    };
    let (_, whole) = limited(&rig.machine(), one, program);
    assert!(sum(&rows) < 0.95 * sum(&whole));
    // With increments of E the block stays one.
    let increments = "M83\nG1 X300 E30 F30000\n";
    let found = notes(&rig.machine(), HOW, increments);
    assert_eq!(
        found,
        ["the block is not written in pieces: its places are increments (G91, M83)"]
    );
}

/// Marlin runs short moves at a lower F while its queue is short: pieces are long where
/// the top speed would not be reached again.
#[test]
fn marlin_gets_no_pieces_that_it_runs_more_slowly() {
    let rig = Rig {
        controller: "marlin",
        peak_w: 500.0,
        ..ISG
    };
    let (text, rows) = limited(&rig.machine(), HOW, "G0 X60 F30000\n");
    assert_eq!(rows[0].action, "split");
    let places = text.lines().filter_map(|line| line.strip_prefix("G0 X"));
    let mut last = 0.0;
    for place in places {
        let place: f64 = place.trim_end_matches(" F30000").parse().unwrap();
        // 20 ms at 0.5 m/s.
        assert!(place - last >= 10.0, "{text}");
        last = place;
    }
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

#[test]
fn blocks_that_cannot_be_divided_stay_one() {
    let machine = Rig {
        peak_w: 625.0,
        ..ISG
    }
    .machine();
    let line = "it makes several moves, or does something else as well";
    for (program, reason) in [
        (
            "G91\nG0 X300\nM30\n",
            "its places are increments (G91, M83)",
        ),
        ("G0 X300 M8\nM30\n", line),
        (
            "G0 X300 G60\nM30\n",
            "it has other words, or is not where its words say",
        ),
        (
            "G360\nG0 X300\nM30\n",
            "its pieces would not run on into each other as planned",
        ),
        (
            "G0 X300\nX290 Y200\nM30\n",
            "it may be blended with its neighbours, and how the control does that is not \
             modelled",
        ),
        (
            "P1 = 300\nG0 XP1\nM30\n",
            "its values are worked out by the program",
        ),
        (
            "$FOR P1 = 1, 2, 1\nG0 X300\nG4 P1\nX0\nG4 P1\n$ENDFOR\nM30\n",
            "the program has calls or loops, or there are several ways through it",
        ),
        ("G0 X12.6\nM30\n", "one acceleration is as good"),
    ] {
        let found = notes(&machine, HOW, program);
        let message = format!("the block is not written in pieces: {reason}");
        assert_eq!(found, [message], "{program}");
    }
    let mut slow = machine.clone();
    slow.controller.planner.shortest_block_s = 0.2;
    let message = "the block is not written in pieces: its pieces would be shorter than the \
                   control can use";
    assert_eq!(notes(&slow, HOW, "G0 X300\nM30\n"), [message]);
    // Nothing is said where nothing is lowered.
    assert_eq!(notes(&machine, HOW, "G0 X1\nM30\n"), [""; 0]);
}

#[test]
fn strategies_that_the_control_cannot_follow_are_refused() {
    let refused = |machine: &Machine, how: LimitOptions| {
        let input = std::io::Cursor::new(b"G0 X1\n");
        match limit(input, machine, &Options::default(), how, Vec::new(), None) {
            Err(Failure::Unsuitable(message)) => message,
            other => panic!("{other:?}"),
        }
    };
    let rig = Rig {
        controller: "iso",
        ..ISG
    };
    assert_eq!(
        refused(&rig.machine(), HOW),
        "--strategy split: the controller `iso` has no word for acceleration; use optimal"
    );
    let mut machine = ISG.machine();
    for knob in &mut machine.controller.knobs {
        knob.between_moves = false;
    }
    assert_eq!(
        refused(&machine, HOW),
        "--strategy split: the word for acceleration of the controller `isg` is not known to \
         act between moving blocks (between_moves); use optimal"
    );
    let rig = Rig {
        rest: EXACT_STOP,
        ..ISG
    };
    assert_eq!(
        refused(&rig.machine(), HOW),
        "--strategy split: with path.mode = \"exact-stop\" each piece of a block would end at \
         rest; use optimal"
    );
    let patent = LimitOptions {
        law: Law::Patent,
        ..HOW
    };
    let message = "--law patent goes with --strategy speed or accel";
    assert_eq!(refused(&ISG.machine(), patent), message);
}
