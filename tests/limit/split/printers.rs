//! Pieces where the control plans all moves together.

use super::super::Rig;
use super::{HOW, ISG, limited, notes};
use gwatt::pipeline::{LimitOptions, Row, Strategy};

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
        } else if line != "G1" {
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

/// Marlin runs moves of less than 20 ms at a lower F while its queue is short: that F is not
/// below the speed that a piece leads to.
#[test]
fn marlin_gets_no_pieces_that_it_runs_more_slowly() {
    for (program, peak_w) in [("G0 X60 F30000\n", 500.0), ("G0 X45 F30000\n", 300.0)] {
        let rig = Rig {
            controller: "marlin",
            peak_w,
            ..ISG
        };
        let (text, rows) = limited(&rig.machine(), HOW, program);
        assert_eq!(rows[0].action, "split");
        let (mut accel, mut at, mut speed2, mut pieces) = (5000.0, 0.0, 0.0_f64, Vec::new());
        for line in text.lines() {
            if let Some(values) = line.strip_prefix("M201 X") {
                accel = values.split(' ').next().unwrap().parse().unwrap();
            } else if let Some(place) = line.strip_prefix("G0 X") {
                let place: f64 = place.trim_end_matches(" F30000").parse().unwrap();
                speed2 += 2.0 * accel * (place - at);
                pieces.push((place - at, speed2.sqrt()));
                at = place;
            }
        }
        // The last one brakes.
        pieces.pop();
        assert!(pieces.len() > 2, "{text}");
        for (length, speed) in pieces {
            assert!(length >= 0.02 * speed, "{length} {speed}\n{text}");
        }
    }
}

/// Klipper cruises half of each hill of speed: a block that does not reach its F as it is
/// reaches no more in pieces, 300·5000/2 mm²/s² for 274 mm/s on 30 mm.
#[test]
fn a_hill_without_a_cruise_is_no_higher() {
    let rig = Rig {
        controller: "klipper",
        peak_w: 350.0,
        ..ISG
    };
    let (text, rows) = limited(&rig.machine(), HOW, "G0 X30 F30000\n");
    assert_eq!(rows[0].action, "split", "{text}");
    let (mut accel, mut at, mut speed2) = (5000.0, 0.0, 0.0_f64);
    for line in text.lines() {
        if let Some(value) = line.strip_prefix("SET_VELOCITY_LIMIT ACCEL=") {
            accel = value.split(' ').next().unwrap().parse().unwrap();
        } else if let Some(place) = line.strip_prefix("G0 X") {
            let place: f64 = place.trim_end_matches(" F30000").parse().unwrap();
            let left2 = 2.0 * 5000.0 * (30.0 - place);
            speed2 = (speed2 + 2.0 * accel * (place - at)).min(left2);
            at = place;
            assert!(speed2 <= 0.5 * 5000.0 * 30.0, "{speed2}\n{text}");
        }
    }
}

/// Two lines of one direction: the first does not reach the speed that it had at its end, and
/// the second begins with what it reaches.
#[test]
fn a_line_that_ends_more_slowly_is_divided() {
    for controller in ["reprap", "klipper"] {
        let rig = Rig {
            controller,
            peak_w: 437.5,
            ..ISG
        };
        let sum = |program: &str| -> f64 {
            let (text, rows) = limited(&rig.machine(), HOW, program);
            assert!(rows.iter().all(|row| row.action == "split"), "{text}");
            rows.iter().filter_map(|row| row.duration_after_s).sum()
        };
        let whole_s = sum("G0 X300 F30000\n");
        let both_s = sum("G0 X30 F30000\nG0 X300\n");
        assert!(both_s < 1.003 * whole_s, "{controller} {both_s} {whole_s}");
    }
}
