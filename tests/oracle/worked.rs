//! The second implementation itself, compared with cases worked by hand.

use super::compare::{Compared, machine, rows};
use super::plant::Plant;
use super::profile::Limits;
use super::spindle::Turning;
use std::f64::consts::TAU;

use crate::near::assert_near;

fn near(found: f64, expected: f64, share: f64) {
    assert_near(found, expected, share * expected.abs());
}

const FREE: Limits<'static> = Limits {
    speed: 1.0,
    accel: 1.0,
    jerk: f64::INFINITY,
    curve: None,
};

/// `T = L/v + v/a`; a triangle `2·√(L/a)`.
#[test]
fn trapezoid_and_triangle() {
    near(FREE.run(4.0).duration_s(), 5.0, 1e-12);
    near(FREE.run(0.25).duration_s(), 1.0, 1e-12);
}

/// With J = 2 a ramp to 1 takes 1/1 + 1/2 s; over a short way `L = 2·v·√(v/J)`,
/// `T = 4·√(v/J)`.
#[test]
fn s_curves() {
    let limits = Limits { jerk: 2.0, ..FREE };
    near(limits.run(4.0).duration_s(), 5.5, 1e-12);
    let v = 0.25_f64;
    let short = limits.run(2.0 * v * (v / 2.0).sqrt());
    near(short.duration_s(), 4.0 * (v / 2.0).sqrt(), 1e-9);
}

/// Above half the speed `a = 1/2v`, constant power: `t = 1/2 + (1 − 1/4)/1`,
/// `s = 1/8 + 2/3·(1 − 1/8)`, up and down.
#[test]
fn a_ramp_under_a_curve() {
    let curve = |v: f64| if v < 0.5 { 1.0 } else { 0.5 / v };
    let limits = Limits {
        curve: Some([&curve, &curve]),
        ..FREE
    };
    let (ramp_s, ramp) = (1.25, 0.125 + 2.0 / 3.0 * 0.875);
    near(
        limits.run(5.0).duration_s(),
        2.0 * ramp_s + (5.0 - 2.0 * ramp),
        1e-5,
    );
    // With a jerk that hardly limits, nearly the same; never faster.
    let jerky = Limits {
        jerk: 500.0,
        ..limits
    };
    let slower = jerky.run(5.0).duration_s();
    near(slower, 2.0 * ramp_s + (5.0 - 2.0 * ramp), 5e-3);
    assert!(slower > limits_duration(&curve), "{slower}");
}

fn limits_duration(curve: &dyn Fn(f64) -> f64) -> f64 {
    let limits = Limits {
        curve: Some([curve, curve]),
        ..FREE
    };
    limits.run(5.0).duration_s()
}

/// 0.1 kg·m² to 3000/min in 1 s: 31.416 N·m, 9869.6 W at the end; with a base
/// speed of 1500/min the power stays what it is there, `(5/4 + …)`:
/// `A = (ω_b + (ω_m² − ω_b²)/2ω_b)/T = 2.5·ω_b/T`.
#[test]
fn a_spindle_runs_up() {
    let toml = |base: &str| {
        format!(
            "[converter]\npeak_power_w = 1\n[axes.X]\nmass_kg = 1\n[spindle]\n\
             inertia_kg_m2 = 0.1\nmax_rpm = 3000\naccel_time_s = 1\n{base}"
        )
    };
    let omega = TAU * 50.0;
    for (base, end_w) in [
        ("", 0.1 * omega * omega),
        ("base_rpm = 1500", 0.0625 * omega * omega * 1.0),
    ] {
        let plant = Plant::new(&toml(base));
        let spindle = plant.spindle.unwrap();
        let mut turning = Turning::default();
        turning.command(&spindle, 0.0, 3000.0, true);
        near(turning.settled_s(), 1.0, 1e-5);
        let end_s = turning.settled_s() - 1e-7;
        near(
            turning.spindle_load(&spindle, end_s, end_s).power_w,
            end_w,
            1e-4,
        );
    }
}

/// Y, 1000 kg at 1 m/s², draws 1000 W and feeds 1000 W back; the spindle holds
/// 3000/min with 1 N·m, 314.16 W, on the same converter. What is fed back loads it
/// more, and the spindle lowers that; what is drawn grows all the same.
#[test]
fn a_spindle_adds_to_what_is_drawn_where_it_lowers_what_is_fed_back() {
    let axis = "rapid_mm_min = 60000\naccel_mm_s2 = 1000\nmass_kg = 1000";
    let converter = "peak_power_w = 1e5\nregen_power_w = 1e4\ncredit_regen = true";
    let toml = format!(
        "schema = 1\nname = \"two\"\ncontroller = \"iso\"\n\
         [[converter]]\nname = \"left\"\naxes = [\"X\"]\n{converter}\n\
         [[converter]]\nname = \"right\"\naxes = [\"Y\"]\n{converter}\n\
         [axes.X]\n{axis}\n[axes.Y]\n{axis}\n[spindle]\ninertia_kg_m2 = 0.1\n\
         friction_nm = 1\nmax_rpm = 3000\naccel_time_s = 1\nwait = false\n\
         converter = \"right\"\n[limits]\nmargin = 0\n"
    );
    let program = "G21 G90\nM3 S3000\nG4 P5\nG0 Y2000\nM2\n";
    let mut compared = Compared::default();
    compared.program(&toml, program);
    assert!(compared.wrong.is_empty(), "{:?}", compared.wrong);
    let (found, _) = rows(&machine(&toml), program);
    near(found[1].peak_w, 1000.0 + 100.0 * std::f64::consts::PI, 1e-6);
}
