//! Corner speeds of each rule, by hand.

use super::{FREE, end, line, machine, plan, start};
use gwatt::machine::{AXES, CornerAngle, CornerRule, LookAhead};

fn rule(corner: CornerRule) -> LookAhead {
    LookAhead {
        blocks_at_most: None,
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

pub(super) fn assert_close(value: f64, expected: f64) {
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
    // Marlin looks at the next move at its own speed: 20 straight on after 12 is a step of 8,
    // which Y has only at half of that, but both may begin and end at 10 and 4 on their own.
    let pace = |direction: [f64; 3], first: f64, second: f64| {
        let machine = self::machine("marlin", 1000.0, 1000.0);
        let elements = [
            line(direction, first, 1000.0, FREE),
            line(direction, second, 1000.0, FREE),
        ];
        end(&plan(
            &machine,
            rule(CornerRule::ClassicJerk { step_mm_s }),
            &elements,
        )[0])
    };
    assert_close(pace([100.0, 0.0, 0.0], 12.0, 20.0), 12.0);
    assert_close(pace([100.0, 0.0, 0.0], 12.0, 24.0), 10.0);
    assert_close(pace([0.0, 100.0, 0.0], 12.0, 20.0), 6.0);
    assert_close(pace([0.0, 100.0, 0.0], 20.0, 12.0), 12.0);
    // It counts the larger part of a reversal alone, and starts at a speed
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
