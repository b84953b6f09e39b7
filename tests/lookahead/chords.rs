//! Arcs as chords, by hand.

use super::corners::assert_close;
use super::{FREE, end, plan};
use gwatt::interpret::{Arc, FeedMode, Move, MoveKind};
use gwatt::machine::{AXES, AxisSet, ChordRule, Machine, PathMode};
use gwatt::plan::Overrides;
use gwatt::plan::lookahead::{Curve, Element, Piece, Planned, chord_count};
use std::f64::consts::{FRAC_PI_2, PI};

use crate::machines::{linear_axes, machine_from};

/// A machine of these speeds (mm/s), with axes that speed up by so much (mm/s²).
fn machine(controller: &str, speeds_mm_s: [f64; 3], accel_mm_s2: f64) -> Machine {
    let [x, y, z] = speeds_mm_s.map(|speed| [speed * 60.0, accel_mm_s2, 100.0]);
    machine_from(&format!(
        "schema = 1\nname = \"test\"\ncontroller = \"{controller}\"\n[converter]\n\
         peak_power_w = 1e9\n{}{}{}",
        linear_axes("X", x, ""),
        linear_axes("Y", y, ""),
        linear_axes("Z", z, "")
    ))
}

/// A quarter of a circle of 10 mm, from X0 Y0 to X-10 Y10, that rises.
fn quarter(rise_mm: f64, feed_mm_s: f64, accel_mm_s2: f64) -> Move {
    let mut end = [0.0; AXES];
    (end[0], end[1], end[2]) = (-10.0, 10.0, rise_mm);
    Move {
        line: 1,
        number: None,
        run: 1,
        text: 0,
        kind: MoveKind::Arc,
        start: [0.0; AXES],
        end,
        moving: AxisSet(if rise_mm == 0.0 { 3 } else { 7 }),
        unknown_start: AxisSet(0),
        assumed_start: AxisSet(0),
        arc: Some(Arc {
            plane: [0, 1],
            center: [-10.0, 0.0],
            radius_mm: 10.0,
            start_angle_rad: 0.0,
            sweep_rad: FRAC_PI_2,
        }),
        length_mm: libm::hypot(10.0 * FRAC_PI_2, rise_mm),
        feed_mm_s,
        feed_excess: 1.0,
        feed_mode: FeedMode::PerMinute,
        accel_mm_s2: [accel_mm_s2; AXES],
        path_accel_mm_s2: f64::INFINITY,
        jerk_factor: 1.0,
        rapid_factor: 1.0,
        pace: 1.0,
        dwell_s: 0.0,
        loads: 0,
        path_mode: PathMode::LookAhead,
        corner: gwatt::interpret::Corner::default(),
        stray: gwatt::interpret::Stray::NONE,
    }
}

/// Its pieces, from rest to rest.
fn pieces(
    machine: &Machine,
    mv: &Move,
    change: impl FnOnce(&mut ChordRule),
) -> Vec<Planned<usize>> {
    let element = Element::of(machine, mv, Overrides::default(), FREE, 0).unwrap();
    let mut rule = machine.controller.planner.look_ahead.unwrap();
    change(rule.chords.as_mut().unwrap());
    plan(machine, rule, &[element])
}

#[test]
fn arcs_become_chords() {
    let chords = ChordRule {
        max_mm: f64::INFINITY,
        min_mm: 0.0,
        deviation_mm: 0.002,
        per_second: 0.0,
        per_circle: 0.0,
        more_from: 1.0,
        safe_exit: false,
    };
    let curve = Curve {
        plane: [0, 1],
        radius_mm: 10.0,
        sweep_rad: PI,
        rise_mm: 0.0,
        accel_mm_s2: 1000.0,
        axes_mm_s: [f64::INFINITY; 2],
        across_mm_s: f64::INFINITY,
    };
    // Chords of 2·√(0.002·19.998) = 0.39998 mm on 31.4159 mm.
    assert_eq!(chord_count(&chords, &curve, 50.0), 78);
    let coarse = ChordRule {
        deviation_mm: f64::INFINITY,
        max_mm: 2.0,
        per_second: 50.0,
        more_from: 0.0,
        ..chords
    };
    // 50 mm/s and 50 a second: chords of 1 mm; 200 mm/s: of 2 mm.
    assert_eq!(chord_count(&coarse, &curve, 50.0), 32);
    assert_eq!(chord_count(&coarse, &curve, 200.0), 16);
    // One more from 0.2 of a chord on: 31.4159 are 32, 30.08 (a turn of 3.008 rad) are 30.
    let from = |sweep_rad: f64| {
        let rule = ChordRule {
            max_mm: 1.0,
            per_second: 0.0,
            more_from: 0.2,
            ..coarse
        };
        chord_count(&rule, &Curve { sweep_rad, ..curve }, 50.0)
    };
    assert_eq!((from(PI), from(3.008)), (32, 30));
    let round = ChordRule {
        per_circle: 72.0,
        ..coarse
    };
    assert_eq!(chord_count(&round, &curve, 200.0), 36);
}

#[test]
fn chords_of_a_helix_end_where_it_ends() {
    let machine = machine("grbl", [1000.0; 3], 1000.0);
    let mv = quarter(3.0, 50.0, 1000.0);
    let pieces = pieces(&machine, &mv, |_| {});
    assert!(pieces.len() > 30);
    let mut at = 0.0;
    for piece in &pieces {
        let Piece::Along { from_mm, to_mm } = piece.piece else {
            panic!("{piece:?}");
        };
        assert_eq!(from_mm, at);
        at = to_mm;
    }
    assert_close(at, mv.length_mm);
    // The chords are shorter than the arc by their sagittas only.
    let length: f64 = pieces.iter().map(|piece| piece.profile().length_mm()).sum();
    assert!(
        length < mv.length_mm && length > mv.length_mm * 0.9999,
        "{length}"
    );
}

#[test]
fn each_chord_runs_as_fast_as_its_own_direction_permits() {
    // 39 chords; the first heads almost along Y (40 mm/s), the last almost along X (100 mm/s),
    // and where both are at their limits they make √(100² + 40²).
    let machine = machine("grbl", [100.0, 40.0, 100.0], 1e6);
    let mv = quarter(0.0, 1000.0, 1e6);
    let pieces = pieces(&machine, &mv, |_| {});
    assert_eq!(pieces.len(), 39);
    for (index, piece) in pieces.iter().enumerate() {
        let (sin, cos) = libm::sincos((index as f64 + 0.5) * FRAC_PI_2 / 39.0);
        assert_close(piece.top_speed_mm_s(), (100.0 / sin).min(40.0 / cos));
    }
    let fastest = pieces.iter().map(Planned::top_speed_mm_s);
    let fastest = fastest.fold(0.0, f64::max);
    let both = libm::hypot(100.0, 40.0);
    assert!(fastest < both && fastest > 0.99 * both, "{fastest}");
    // What holds however it is planned is no less.
    let bound = gwatt::plan::blended_bound(&machine, &mv, Overrides::default());
    assert_eq!((bound.negative[0], bound.positive[1]), (100.0, 40.0));
    let speed = gwatt::plan::blended_speed(&machine, &mv, Overrides::default());
    assert_close(speed, both);
}

#[test]
fn an_arc_goes_on_where_the_queue_ends() {
    // Marlin: 18 chords of 0.8724 mm, two of which are seen. What turning permits is
    // √(4000·10) = 200 mm/s, more than F.
    let mut machine = machine("marlin", [1000.0; 3], 4000.0);
    let rule = machine.controller.planner.look_ahead.as_mut().unwrap();
    rule.blocks = Some(1);
    let mv = quarter(0.0, 100.0, 4000.0);
    let at = |safe_exit| {
        let pieces = pieces(&machine, &mv, |rule| rule.safe_exit = safe_exit);
        assert_eq!(pieces.len(), 18);
        pieces.iter().map(end).collect::<Vec<_>>()
    };
    let (kept, stopped) = (at(true), at(false));
    // It gets to F, and leaves the twelfth where two more and 4 of 18 are enough to stop.
    assert_close(kept[9], 100.0);
    // Without that knowledge two chords are: 2·a·L of those after it, of 2 mm at most.
    assert!(
        stopped
            .iter()
            .all(|speed| speed * speed < 2.0 * 5657.0 * 2.0),
        "{stopped:?}"
    );
    assert_eq!((kept[17], stopped[17]), (0.0, 0.0));
}
