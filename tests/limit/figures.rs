//! Exact figures, worked by hand.
//!
//! At the end of the ramp `P = v·(m·a + Fc)`; V is limit/P, φ the share of
//! friction.

use super::{EXACT_STOP, RIG, Rig};
use gwatt::machine::Machine;
use gwatt::pipeline::{Law, Strategy};

/// 0.5 m/s · (500 kg · 5 m/s² + 500 N) = 1500 W: V = 2/3, φ = 1/6.
const WITH_FRICTION: Rig = Rig {
    axis: "coulomb_n = 500",
    rest: EXACT_STOP,
    ..RIG
};

/// The number after `word` in the text.
fn number(text: &str, word: &str) -> f64 {
    let at = text.find(word).expect("the word") + word.len();
    let rest = text[at..].trim_start();
    let end = rest
        .find(|c: char| !c.is_ascii_digit() && c != '.')
        .unwrap_or(rest.len());
    rest[..end].parse().expect("a number")
}

fn close(value: f64, expected: f64, tolerance: f64) {
    assert!(
        value <= expected * (1.0 + 1e-9) && value >= expected * (1.0 - tolerance),
        "{value} instead of {expected}"
    );
}

#[test]
fn speed_by_the_exact_law_is_v() {
    let rig = WITH_FRICTION.strategy(Strategy::Speed);
    close(number(&rig.fits("G0 X1000\n"), "F"), 20000.0, 1e-4);
}

#[test]
fn speed_by_the_printed_law_is_v_squared() {
    let mut rig = WITH_FRICTION.strategy(Strategy::Speed);
    rig.options.law = Law::Patent;
    close(
        number(&rig.fits("G0 X1000\n"), "F"),
        30000.0 * 4.0 / 9.0,
        1e-4,
    );
}

#[test]
fn acceleration_by_the_exact_law_leaves_friction_out() {
    // (V − φ)/(1 − φ) = (2/3 − 1/6)/(5/6) = 0.6
    let rig = Rig {
        controller: "isg",
        ..WITH_FRICTION
    };
    let text = rig.strategy(Strategy::Accel).fits("G0 X1000\n");
    close(number(&text, "G231 ="), 60.0, 2e-3);
}

#[test]
fn acceleration_by_the_printed_law_fits_only_with_little_friction() {
    // V² = 4/9: V·(1 − φ) + φ/V = 0.806 of the limit.
    let mut rig = Rig {
        controller: "isg",
        ..WITH_FRICTION
    }
    .strategy(Strategy::Accel);
    rig.options.law = Law::Patent;
    close(number(&rig.fits("G0 X1000\n"), "G231 ="), 400.0 / 9.0, 3e-3);
    // φ = 0.4, V = 0.48: V·(1 − φ) + φ/V = 1.12 of the limit.
    rig.axis = "coulomb_n = 1666.67";
    let reasons = rig.reasons("G0 X1000\n");
    assert_eq!(reasons[0].rule, "not-enough");
    assert!(reasons[0].message.contains("112"), "{}", reasons[0].message);
}

#[test]
fn acceleration_of_a_triangle_is_v_to_two_thirds() {
    // √(a·L) = 0.3162 m/s, 790.6 W: V = 0.506, V^(2/3) = 0.6349.
    let rig = Rig {
        controller: "isg",
        peak_w: 400.0,
        rest: EXACT_STOP,
        ..RIG
    };
    let text = rig.strategy(Strategy::Accel).fits("G0 X20\n");
    let peak: f64 = 500.0 * 5.0 * (5.0_f64 * 0.02).sqrt();
    let exact = 100.0 * libm::pow(400.0 / peak, 2.0 / 3.0);
    close(number(&text, "G231 ="), exact, 2e-3);
}

#[test]
fn a_block_that_fits_is_left_alone_though_its_nominal_speed_does_not() {
    let program = "G0 X20\nG1 X0 F30000\n";
    assert_eq!(RIG.fits(program), program);
}

#[test]
fn base_load_comes_off_first() {
    // (1000 − 200)/1250 of 30 000 mm/min.
    let rig = Rig {
        converter: "base_load_w = 200",
        ..RIG
    };
    close(number(&rig.fits("G0 X1000\n"), "F"), 19200.0, 1e-4);
}

#[test]
fn a_regenerative_limit_counts() {
    // Braking feeds 1250 W back; 500 W are 40 % of the speed.
    let rig = Rig {
        peak_w: 5000.0,
        converter: "regen_power_w = 500",
        ..RIG
    };
    close(number(&rig.fits("G0 X1000\n"), "F"), 12000.0, 1e-4);
}

#[test]
fn loads_count_while_they_are_on() {
    let rig = Rig {
        rest: "[[load]]\non = \"M8\"\noff = \"M9\"\npower_w = 500",
        ..RIG
    };
    let text = rig.fits("G0 X400\nM8\nX0\nM9 X400\nX0\n");
    // 1000 W leave 24 000 mm/min, 500 W half of it; M9 takes effect after
    // the motion of its block.
    let feeds: Vec<f64> = text
        .lines()
        .filter_map(|line| line.split_once('F'))
        .map(|(_, feed)| feed.parse().expect("a number"))
        .collect();
    assert_eq!(feeds.len(), 3, "{text}");
    for (feed, expected) in feeds.into_iter().zip([24000.0, 12000.0, 24000.0]) {
        close(feed, expected, 1e-4);
    }
}

#[test]
fn overrides_and_servo_factors_count() {
    let rig = Rig {
        axis: "servo_factor_motor = 1.25",
        rest: "override_max_percent = { feed = 120 }",
        ..RIG
    };
    // A rapid written as a feed is under the feed override.
    close(
        number(&rig.fits("G0 X1000\n"), "F"),
        30000.0 * 0.64 / 1.2,
        1e-4,
    );
}

#[test]
fn the_example_of_the_method_fits_on_the_default_machine() {
    let (machine, _) = Machine::load("three-axis").expect("built in");
    let program = include_bytes!("../../examples/simultaneous-start.ngc");
    let (text, summary) = super::run(&machine, RIG.options, program).expect("a program");
    assert!(summary.certified && !summary.before.fits());
    assert!(summary.after.peak_w <= 3600.0 * (1.0 + 1e-9) && summary.after.peak_w > 3599.0);
    let text = String::from_utf8(text).expect("text");
    assert!(text.contains("G04 F2"), "a dwell is no feed:\n{text}");
    // Of the rapids only those that do not fit are feeds now.
    assert!(text.contains("N101 G01 X0 Y0 Z0 F"), "{text}");
    let (again, summary) = super::run(&machine, RIG.options, text.as_bytes()).expect("a program");
    assert_eq!((again, summary.edited_lines), (text.into_bytes(), 0));
}
