//! Corner speeds of each rule, by hand.

use super::{FREE, end, line, machine, plan, start};
use gwatt::interpret::{FeedMode, Move, MoveKind};
use gwatt::machine::{AXES, AxisSet, ChordRule, CornerAngle, CornerRule, LookAhead, PathMode};
use gwatt::plan::Overrides;
use gwatt::plan::lookahead::{Curve, Element, Piece, chord_count};

fn rule(corner: CornerRule) -> LookAhead {
    LookAhead {
        corner,
        blocks: None,
        path_accel_mm_s2: f64::INFINITY,
        min_cruise_ratio: 0.0,
        chords: None,
    }
}

/// The speed at which two long lines are joined.
fn corner(corner: CornerRule, first: [f64; 3], second: [f64; 3]) -> f64 {
    let machine = machine("grbl", 1000.0, 1000.0);
    let elements = [
        line(first, 200.0, 1000.0, FREE),
        line(second, 200.0, 1000.0, FREE),
    ];
    let pieces = plan(&machine, rule(corner), &elements);
    assert_eq!(end(&pieces[0]), start(&pieces[1]));
    end(&pieces[0])
}

fn assert_close(value: f64, expected: f64) {
    assert!(
        (value - expected).abs() <= 1e-9 * expected.abs(),
        "{value}, not {expected}"
    );
}

fn deviation(per_axis: bool) -> CornerRule {
    CornerRule::JunctionDeviation {
        deviation_mm: 0.02,
        angle: CornerAngle::AllAxes,
        per_axis,
        block_accel: false,
        small_block_mm: 0.0,
    }
}

/// As Marlin has it.
fn within_block() -> CornerRule {
    CornerRule::JunctionDeviation {
        deviation_mm: 0.02,
        angle: CornerAngle::AllAxes,
        per_axis: true,
        block_accel: true,
        small_block_mm: 0.0,
    }
}

#[test]
fn junction_deviation() {
    // 90°: s = √½, R = 0.02·s/(1 − s) = 0.048284…, v = √(1000·R).
    let s = 0.5_f64.sqrt();
    let square = (1000.0 * 0.02 * s / (1.0 - s)).sqrt();
    let along_x = [100.0, 0.0, 0.0];
    assert_close(corner(deviation(false), along_x, [0.0, 100.0, 0.0]), square);
    // The change of speed runs along a diagonal: √2 of an axis' acceleration (grbl),
    // but not more than the block's own (Marlin).
    let diagonal = square * 2.0_f64.sqrt().sqrt();
    let along_y = [0.0, 100.0, 0.0];
    assert_close(corner(deviation(true), along_x, along_y), diagonal);
    assert_close(corner(within_block(), along_x, along_y), square);
    // Straight on: no limit. Back: a stop.
    assert_close(corner(deviation(false), along_x, along_x), 200.0);
    assert_eq!(corner(deviation(false), along_x, [-100.0, 0.0, 0.0]), 0.0);
}

#[test]
fn a_square_corner_is_taken_at_the_square_corner_velocity() {
    let klipper = CornerRule::SquareCorner {
        velocity_mm_s: 5.0,
        extruder_step_mm_s: 1.0,
    };
    assert_close(corner(klipper, [100.0, 0.0, 0.0], [0.0, 100.0, 0.0]), 5.0);
    // 60° turn: s = sin 60° = √¾.
    let s = 0.75_f64.sqrt();
    let speed = 5.0 * ((2.0_f64.sqrt() - 1.0) * s / (1.0 - s)).sqrt();
    let turned = [50.0, 75.0_f64.sqrt() * 10.0, 0.0];
    assert_close(corner(klipper, [100.0, 0.0, 0.0], turned), speed);
    // A line of 0.01 mm: v² = a·L/2·tan 45°/… = 1000·0.01·0.5.
    let bent = corner(klipper, [0.01, 0.0, 0.0], [0.0, 100.0, 0.0]);
    assert_close(bent, (1000.0 * 0.01 * 0.5_f64).sqrt());
}

#[test]
fn steps_of_speed() {
    let mut step_mm_s = [f64::INFINITY; AXES];
    (step_mm_s[0], step_mm_s[1]) = (10.0, 4.0);
    let step = CornerRule::SpeedStep {
        step_mm_s,
        same_kind_only: false,
    };
    // X steps by v, Y by v: 4 is the smaller.
    assert_close(corner(step, [100.0, 0.0, 0.0], [0.0, 100.0, 0.0]), 4.0);
    // Back: X steps by 2·v.
    assert_close(corner(step, [100.0, 0.0, 0.0], [-100.0, 0.0, 0.0]), 5.0);
    // Marlin counts the larger part of a reversal alone, and starts at a speed
    // that no axis exceeds.
    let jerk = CornerRule::ClassicJerk { step_mm_s };
    assert_close(corner(jerk, [100.0, 0.0, 0.0], [-100.0, 0.0, 0.0]), 10.0);
    let machine = machine("marlin", 1000.0, 1000.0);
    let pieces = plan(
        &machine,
        rule(jerk),
        &[line([100.0, 0.0, 0.0], 50.0, 1000.0, FREE)],
    );
    assert_eq!((start(&pieces[0]), end(&pieces[0])), (10.0, 0.0));
}

#[test]
fn the_cruise_ratio_cuts_short_hills() {
    // Alone, 10 mm at 1000 mm/s²: √(a·L) = 100 mm/s. With half of the
    // acceleration in the smoothed pass: √(½·a·L).
    let machine = machine("klipper", 1000.0, 1000.0);
    let mut rule = machine.controller.planner.look_ahead.unwrap();
    let element = line([10.0, 0.0, 0.0], 500.0, 1000.0, FREE);
    let top = |rule| {
        plan(&machine, rule, &[element])[0]
            .profile()
            .top_speed_mm_s()
    };
    assert_close(top(rule), 5000.0_f64.sqrt());
    rule.min_cruise_ratio = 0.0;
    assert_close(top(rule), 100.0);
}

#[test]
fn arcs_become_chords() {
    let chords = ChordRule {
        max_mm: f64::INFINITY,
        min_mm: 0.0,
        deviation_mm: 0.002,
        per_second: 0.0,
        per_circle: 0.0,
        round_up: false,
    };
    let curve = Curve {
        plane: [0, 1],
        radius_mm: 10.0,
        sweep_rad: std::f64::consts::PI,
        rise_mm: 0.0,
        accel_mm_s2: 1000.0,
    };
    // Chords of 2·√(0.002·19.998) = 0.39998 mm on 31.4159 mm.
    assert_eq!(chord_count(&chords, &curve, 50.0), 78);
    let coarse = ChordRule {
        deviation_mm: f64::INFINITY,
        max_mm: 2.0,
        per_second: 50.0,
        round_up: true,
        ..chords
    };
    // 50 mm/s and 50 a second: chords of 1 mm; 200 mm/s: of 2 mm.
    assert_eq!(chord_count(&coarse, &curve, 50.0), 32);
    assert_eq!(chord_count(&coarse, &curve, 200.0), 16);
    let round = ChordRule {
        per_circle: 72.0,
        ..coarse
    };
    assert_eq!(chord_count(&round, &curve, 200.0), 36);
}

#[test]
fn chords_of_a_helix_end_where_it_ends() {
    let machine = machine("grbl", 1000.0, 1000.0);
    let mut end = [0.0; AXES];
    (end[0], end[1], end[2]) = (-10.0, 10.0, 3.0);
    let flat = 10.0 * std::f64::consts::FRAC_PI_2;
    let mv = Move {
        line: 1,
        number: None,
        run: 1,
        text: 0,
        kind: MoveKind::Arc,
        start: [0.0; AXES],
        end,
        moving: AxisSet(7),
        unknown_start: AxisSet(0),
        assumed_start: AxisSet(0),
        arc: Some(gwatt::interpret::Arc {
            plane: [0, 1],
            center: [-10.0, 0.0],
            radius_mm: 10.0,
            start_angle_rad: 0.0,
            sweep_rad: std::f64::consts::FRAC_PI_2,
        }),
        length_mm: libm::hypot(flat, 3.0),
        feed_mm_s: 50.0,
        feed_mode: FeedMode::PerMinute,
        accel_mm_s2: [1000.0; AXES],
        path_accel_mm_s2: f64::INFINITY,
        jerk_factor: 1.0,
        rapid_factor: 1.0,
        pace: 1.0,
        dwell_s: 0.0,
        loads: 0,
        path_mode: PathMode::LookAhead,
        corner: gwatt::interpret::Corner::default(),
        stray: gwatt::interpret::Stray::NONE,
    };
    let element = Element::of(&machine, &mv, Overrides::default(), FREE, 0).unwrap();
    let rule = machine.controller.planner.look_ahead.unwrap();
    let pieces = plan(&machine, rule, &[element]);
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
