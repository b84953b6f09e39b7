//! Paths that differ from the moves that stand for them: spirals, and arcs in tilted
//! planes. Their bound is compared with the path itself, point by point.

use std::f64::consts::TAU;

use gwatt::interpret::Move;
use gwatt::machine::Machine;
use gwatt::pipeline::{Certificate, Options};

use crate::limit::{RIG, Rig};
use crate::machines::{linear_axes, machine_from};
use crate::runs::{moves_of, rows_of};

const MASS_KG: [f64; 3] = [300.0, 700.0, 150.0];
const COULOMB_N: [f64; 3] = [200.0, 500.0, 900.0];
const ACCEL_MM_S2: f64 = 2000.0;

fn machine(controller: &str) -> Machine {
    let axes = ["X", "Y", "Z"].iter().zip(MASS_KG).zip(COULOMB_N);
    let axes = axes.map(|((letter, mass_kg), coulomb_n)| {
        let friction = format!("coulomb_n = {coulomb_n:?}");
        linear_axes(letter, [30000.0, ACCEL_MM_S2, mass_kg], &friction)
    });
    machine_from(&format!(
        "schema = 1\nname = \"test\"\ncontroller = \"{controller}\"\n[converter]\n\
         peak_power_w = 1e6\n{}",
        axes.collect::<String>()
    ))
}

fn moves(controller: &str, program: &str) -> Vec<Move> {
    let (moves, failure) = moves_of(&machine(controller), &Options::default(), program);
    assert!(failure.is_none(), "{failure:?}");
    moves
}

/// The largest peak of a line, and whether all its moves are bounded.
fn peak(controller: &str, program: &str, line: u64) -> (f64, bool) {
    let rows = rows_of(&machine(controller), program);
    let own = rows.iter().filter(|row| row.line == line);
    own.fold((0.0, true), |(peak, robust), row| {
        (
            peak.max(row.peak_w),
            robust && row.certificate == Certificate::Robust,
        )
    })
}

/// The largest power along a path at a speed (mm/s), that every axis may reach with all of
/// its acceleration: `direction` gives unit vectors for places from 0 to 1.
fn reached(speed_mm_s: f64, direction: impl Fn(f64) -> [f64; 3]) -> f64 {
    (0..=2000)
        .map(|step| {
            let along = direction(f64::from(step) / 2000.0);
            (0..3)
                .map(|axis| {
                    let v = speed_mm_s * along[axis].abs() * 1e-3;
                    let force = MASS_KG[axis] * ACCEL_MM_S2 * 1e-3 + COULOMB_N[axis];
                    v * force
                })
                .sum::<f64>()
        })
        .fold(0.0, f64::max)
}

/// A short arc that begins along Y: the spiral moves X too, and faster. Steep spirals are
/// bounded.
#[test]
fn a_steep_spiral_draws_no_more_than_its_bound() {
    for (end_r, sweep) in [(20.028, 0.012_f64), (19.975, 0.01), (20.02, 0.008)] {
        let (program, spiral) = short_spiral(end_r, sweep);
        let (bound, robust) = peak("linuxcnc", &program, 3);
        let most = reached(100.0, spiral);
        assert!(robust && bound >= most, "{bound} {most}");
        // It is not out of all proportion.
        assert!(bound < 1.6 * most, "{bound} {most}");
        let mv = &moves("linuxcnc", &program)[1];
        assert!(mv.stray.is_far() && mv.arc.is_some());
    }
}

/// Others are planned as the circle, and what the spiral may draw beyond that is added: more
/// than the circle, less than the bound.
#[test]
fn a_slight_spiral_is_planned_with_what_it_adds() {
    for (end_r, sweep) in [(20.028, 0.05_f64), (19.975, 0.025), (20.02, 0.1)] {
        let (program, _) = short_spiral(end_r, sweep);
        let (found, robust) = peak("linuxcnc", &program, 3);
        let mv = &moves("linuxcnc", &program)[1];
        assert!(mv.stray.strays() && !mv.stray.is_far() && !robust);
        let (circle, _) = peak("linuxcnc", &short_spiral(20.0, sweep).0, 3);
        // From rest to rest: no faster than √(a·L), each axis with all of its acceleration.
        let top_mm_s = (ACCEL_MM_S2 * 20.0 * sweep).sqrt().min(100.0);
        let added: f64 = (0..2)
            .map(|axis| top_mm_s * 1e-3 * (MASS_KG[axis] * ACCEL_MM_S2 * 1e-3 + COULOMB_N[axis]))
            .sum();
        let share = 3.0 * mv.stray.direction + mv.stray.accel;
        assert!(found > circle, "{found} {circle}");
        assert!(
            found < circle + 1.2 * share * (1.0 + share) * added,
            "{found} {circle}"
        );
    }
}

/// An arc of 20 mm that ends at another radius, after a stop and before one; and the
/// directions of its spiral.
fn short_spiral(end_r: f64, sweep: f64) -> (String, impl Fn(f64) -> [f64; 3]) {
    let (x, y) = (end_r * libm::cos(sweep), end_r * libm::sin(sweep));
    let program = format!("G61.1\nG0 X20\nG3 X{x:.9} Y{y:.9} I-20 J0 F6000\nG64\nG1 X0\nM2\n");
    let k = (end_r - 20.0) / sweep;
    let spiral = move |share: f64| {
        let (angle, r) = (share * sweep, 20.0 + k * share * sweep);
        let long = libm::hypot(r, k);
        let (sin, cos) = libm::sincos(angle);
        [(k * cos - r * sin) / long, (k * sin + r * cos) / long, 0.0]
    };
    (program, spiral)
}

/// A circle in a plane that is turned about Y by 30 degrees, on a control that stops at
/// every block and on one that does not.
#[test]
fn an_arc_in_a_tilted_plane_draws_no_more_than_its_bound() {
    let (sin, cos) = libm::sincos(TAU / 12.0);
    for mode in ["G60", "G64"] {
        let program = format!("G0 X0 Y0 Z0\n{mode} ROT Y30\nG2 X0 Y0 I10 J0 F6000\nM30\n");
        let found = moves("siemens", &program);
        let arc: Vec<&Move> = found.iter().filter(|mv| mv.line == 3).collect();
        assert_eq!(arc.len(), 48);
        for mv in &arc {
            // On the circle about (10, 0, 0), turned: its distance, and its plane.
            let [x, y, z] = [mv.end[0], mv.end[1], mv.end[2]];
            let along = x * cos - z * sin - 10.0;
            assert!((libm::hypot(along, y) - 10.0).abs() < 1e-9);
            assert!((x * sin + z * cos).abs() < 1e-9);
            assert_eq!(mv.moving.iter().count(), 3);
        }
        let first = arc[0].end;
        assert!(first[1] > 0.0, "clockwise from the far left: {first:?}");
        let (bound, robust) = peak("siemens", &program, 3);
        let most = reached(100.0, |share| {
            let (s, c) = libm::sincos(share * TAU);
            [s * cos, c, s * sin]
        });
        assert!(robust && bound >= most, "{bound} {most}");
        assert!(bound < 1.25 * most, "{bound} {most}");
    }
}

/// Helices and parts of arcs in tilted planes end where they are programmed.
#[test]
fn arcs_in_tilted_planes_end_where_they_end() {
    let program = "G0 X0 Y0 Z0\nROT X90\nG3 X20 Y0 Z-6 CR=12 F600\nSCALE X2 Y2 Z2\nAROT Z45\nAROT X20\nG0 X0 Y0 Z0\nG2 X3 Y3 I3 J0\nM30\n";
    let found = moves("siemens", program);
    let last = |line: u64| {
        found
            .iter()
            .rfind(|mv| mv.line == line)
            .expect("a move")
            .end
    };
    let helix = last(3);
    for (place, wanted) in helix.iter().zip([20.0, 6.0, 0.0]) {
        assert!((place - wanted).abs() < 1e-9, "{helix:?}");
    }
    assert!(found.iter().filter(|mv| mv.line == 8).count() > 10);
}

/// `limit` lowers the F of such blocks: all their parts have it.
#[test]
fn such_blocks_can_be_lowered() {
    let rig = Rig {
        controller: "siemens",
        peak_w: 400.0,
        rest: "[axes.Z]\nrapid_mm_min = 30000\naccel_mm_s2 = 5000\nmass_kg = 500",
        ..RIG
    };
    let program = "G1 F600 X0\nROT Y30\nG2 X0 Y0 I10 J0 F6000\nROT\nG1 X1 F600\nM30\n";
    let text = rig.fits(program);
    assert!(
        !text.contains("F6000\n") && text.contains("G2 X0 Y0 I10 J0 F"),
        "{text}"
    );
    let rig = Rig {
        controller: "linuxcnc",
        peak_w: 100.0,
        ..RIG
    };
    let program = "G1 F600 X10\nG3 X0 Y10.028 I-10 J0 F6000\nG1 X-20 F600\nM2\n";
    let text = rig.fits(program);
    assert!(
        !text.contains("F6000\n") && text.contains("G3 X0 Y10.028 I-10 J0 F"),
        "{text}"
    );
}
