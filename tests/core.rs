//! Two motors that move two axes together (`CoreXY`): where both axes are alike, the robust bound
//! covers what the motors draw, whatever the control makes of a program.
//!
//! The belts run at `vx + vy` and `vx − vy`, and pull with `(Fx + Fy)/2` and `(Fx − Fy)/2` each
//! (their power is that of the axes, `vx·Fx + vy·Fy`). One motor may drive while the other
//! brakes, so that together they draw more than the axes: at a corner, X still moves while Y
//! accelerates from rest. With `C = vx·Fy + vy·Fx` they draw
//! `(P + max(|P|, |C|))/2`, and of two axes that are alike the faster one has the larger force:
//! then `|C|` is no more than the sum of the largest speeds times the largest forces.

use gwatt::machine::Machine;
use gwatt::pipeline::{Certificate, Options};

use crate::machines::{linear_axes, machine_from};
use crate::runs::rows_with;

const ACCEL_M_S2: f64 = 5.0;
const COULOMB_N: f64 = 8.0;
const VISCOUS: f64 = 20.0;
const EFFICIENCY: f64 = 0.8;

fn machine(masses_kg: [f64; 2]) -> Machine {
    let friction =
        format!("coulomb_n = {COULOMB_N}\nviscous_n_s_m = {VISCOUS}\nefficiency = {EFFICIENCY}");
    let axis = |letter: &str, mass_kg: f64| {
        linear_axes(letter, [30000.0, 1e3 * ACCEL_M_S2, mass_kg], &friction)
    };
    machine_from(&format!(
        "schema = 1\nname = \"core\"\ncontroller = \"iso\"\n[converter]\npeak_power_w = 1e6\n{}{}\
         [limits]\nmargin = 0\n",
        axis("X", masses_kg[0]),
        axis("Y", masses_kg[1])
    ))
}

/// The largest robust bound of a move between two of its kind.
fn bound_w(machine: &Machine, to: [f64; 2], feed_mm_min: f64) -> f64 {
    let [x, y] = to;
    let program = format!("G21 G90 G64\nG1 X{x} Y{y} F{feed_mm_min}\nX0 Y0\nX{x} Y{y}\nM2\n");
    let options = Options {
        certificate: Some(Certificate::Robust),
        ..Options::default()
    };
    let rows = rows_with(machine, &options, &program);
    rows.iter().map(|row| row.peak_w).fold(0.0, f64::max)
}

/// Places from −1 to 1, the ends among them.
fn places() -> impl Iterator<Item = f64> + Clone {
    (-6..=6).map(|k| f64::from(k) / 6.0)
}

/// The most that two motors draw at speeds up to these, in m/s, with any acceleration of each axis.
fn drawn_w(masses_kg: [f64; 2], most_m_s: [f64; 2]) -> f64 {
    let mut most_w = 0.0_f64;
    for (sx, sy) in places().flat_map(|sx| places().map(move |sy| (sx, sy))) {
        let v = [sx * most_m_s[0], sy * most_m_s[1]];
        for (ax, ay) in places().flat_map(|ax| places().map(move |ay| (ax, ay))) {
            let force = |n: usize, share: f64| {
                // At rest friction holds either way, as far as it is needed.
                let sign = if v[n] == 0.0 {
                    share.signum()
                } else {
                    v[n].signum()
                };
                masses_kg[n] * ACCEL_M_S2 * share + VISCOUS * v[n] + COULOMB_N * sign
            };
            let f = [force(0, ax), force(1, ay)];
            let belts = [(v[0] + v[1]) * (f[0] + f[1]), (v[0] - v[1]) * (f[0] - f[1])];
            let drawn = belts.map(|twice_w| (0.5 * twice_w).max(0.0));
            most_w = most_w.max((drawn[0] + drawn[1]) / EFFICIENCY);
        }
    }
    most_w
}

#[test]
fn the_robust_bound_covers_both_motors_of_axes_that_are_alike() {
    let masses_kg = [4.0, 4.0];
    let machine = machine(masses_kg);
    for to in [[80.0, 60.0], [100.0, 0.0], [10.0, 99.0], [70.0, -70.0]] {
        let length = libm::hypot(to[0], to[1]);
        for feed_mm_min in [3000.0, 12000.0, 24000.0] {
            let speed_m_s = feed_mm_min / 60e3;
            let most = to.map(|part: f64| (part / length).abs() * speed_m_s);
            let (bound, drawn) = (bound_w(&machine, to, feed_mm_min), drawn_w(masses_kg, most));
            assert!(
                drawn <= bound * (1.0 + 1e-9),
                "{to:?} F{feed_mm_min}: {drawn} {bound}"
            );
        }
    }
}

/// Why both axes get the larger mass: with a light Y that is fast and a heavy X that is slow the
/// motors draw more than the axes may.
#[test]
fn axes_that_differ_are_not_covered() {
    let masses_kg = [12.0, 1.0];
    let (to, feed_mm_min) = ([10.0, 99.0], 12000.0);
    let length = libm::hypot(to[0], to[1]);
    let most = to.map(|part: f64| part / length * feed_mm_min / 60e3);
    let bound = bound_w(&machine(masses_kg), to, feed_mm_min);
    assert!(drawn_w(masses_kg, most) > 1.2 * bound);
    assert!(drawn_w([12.0, 12.0], most) <= bound_w(&machine([12.0; 2]), to, feed_mm_min));
}
