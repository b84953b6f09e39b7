//! Independent rapids of axes that run alone on their converter, worked out by hand.

use gwatt::machine::Machine;
use gwatt::pipeline::Row;

use crate::machines::machine_from;
use crate::runs::{rows_of, turned};

/// A weight of 300 N that friction does not hold, on a converter of its own or not.
fn lift(converters: &str, axis: &str) -> Machine {
    let text = format!(
        "schema = 1\nname = \"test\"\ncontroller = \"iso\"\n[path]\nrapid = \"independent\"\n\
         {converters}[limits]\nmargin = 0.0\n\
         [axes.X]\nrapid_mm_min = 6000\naccel_mm_s2 = 1000\nmass_kg = 10\n\
         [axes.Z]\nrapid_mm_min = 30000\nmass_kg = 100\ngravity_n = 300\n{axis}"
    );
    machine_from(&text)
}

fn row(machine: &Machine, program: &str) -> Row {
    rows_of(machine, program).swap_remove(0)
}

fn at(machine: &Machine, rapid: f64) -> Machine {
    turned(machine, [rapid, rapid, 1.0])
}

const ONE: &str = "[converter]\npeak_power_w = 1000\nregen_power_w = 1000\n";

/// Down 5 mm at 2 m/s²: 0.1 m/s. Friction takes 100 of 300 N: nothing feeds back while
/// it speeds up (0 N), 400 N · 0.1 m/s are less than 0.0004 · 400² = 64 W as it brakes.
/// A cruise at 0.095 m/s feeds back 200 · 0.095 − 0.0004 · 200² = 3 W, at 0.1 m/s 4 W.
#[test]
fn a_weight_that_is_let_down_feeds_back_at_lower_overrides() {
    let machine = lift(
        ONE,
        "accel_mm_s2 = 2000\ncoulomb_n = 100\ncopper_w_n2 = 0.0004\n",
    );
    let program = "G90\nG0 Z-5\nM2\n";
    let full = row(&at(&machine, 1.0), program);
    assert!(full.regen_w < 1e-9, "{}", full.regen_w);
    let tenth = row(&at(&machine, 0.1), program);
    assert!(tenth.regen_w == 0.0, "{}", tenth.regen_w);
    let lower = row(&at(&machine, 0.19), program);
    assert!((lower.regen_w - 3.0).abs() < 1e-9, "{}", lower.regen_w);
    let any = row(&machine, program);
    assert!((any.regen_w - 4.0).abs() < 1e-9, "{}", any.regen_w);
    assert_eq!(any.peak_w, full.peak_w);
    assert_eq!(any.duration_s, full.duration_s);
}

/// With limited jerk a slower axis brakes more gently: less is lost in the copper. Nothing
/// that any override has is above the row of all.
#[test]
fn gentler_braking_feeds_back_no_more_than_is_read() {
    for (jerk, copper, travel) in [
        (20_000.0, 0.0004, 5.0),
        (20_000.0, 0.0001, 40.0),
        (5_000.0, 0.0002, 12.0),
        (100_000.0, 0.0003, 80.0),
    ] {
        let machine = lift(
            ONE,
            &format!(
                "accel_mm_s2 = 2000\ncoulomb_n = 100\ncopper_w_n2 = {copper}\njerk_mm_s3 = {jerk}\n"
            ),
        );
        for sign in ["-", ""] {
            let program = format!("G90\nG0 Z{sign}{travel}\nM2\n");
            let any = row(&machine, &program);
            let mut most_w = 0.0_f64;
            for percent in 1..=100 {
                let one = row(&at(&machine, f64::from(percent) / 100.0), &program);
                assert!(
                    one.peak_w <= any.peak_w * (1.0 + 1e-9),
                    "{percent} %: {one:?}"
                );
                most_w = most_w.max(one.regen_w);
            }
            assert!(
                any.regen_w >= most_w - 1e-9,
                "{} for {most_w} W",
                any.regen_w
            );
            assert!(
                any.regen_w <= 1.15 * most_w + 0.2,
                "{} for {most_w} W",
                any.regen_w
            );
        }
    }
}

/// Z has arrived long before X: what holds it, 0.001 · 300² = 90 W, is more than it drew
/// on its way down (150 N as it brakes).
#[test]
fn a_weight_is_held_while_axes_of_other_converters_run_on() {
    let converters = "[[converter]]\nname = \"left\"\naxes = [\"X\"]\npeak_power_w = 1e6\n\
                      [[converter]]\nname = \"right\"\naxes = [\"Z\"]\npeak_power_w = 200\n";
    let axis = "accel_mm_s2 = 500\ncoulomb_n = 200\ncopper_w_n2 = 0.001\n";
    let machine = lift(converters, axis);
    let program = "G90\nG0 X100 Z-5\nM2\n";
    for machine in [at(&machine, 1.0), machine] {
        let found = row(&machine, program);
        assert_eq!(found.converter, "right");
        assert!((found.peak_w - 90.0).abs() < 1e-9, "{}", found.peak_w);
    }
}
