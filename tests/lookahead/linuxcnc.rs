//! The rules of LinuxCNC, by hand; 200 mm/s and 1000 mm/s² in each axis.

use super::{Run, machine, plan_program, total_s};
use gwatt::plan::lookahead::{Blend, Piece, Planned};
use std::fmt::Write as _;

fn planned(program: &str) -> Run {
    plan_program(&machine("linuxcnc", 200.0, 1000.0), program.as_bytes())
}

fn assert_close(value: f64, expected: f64) {
    assert!(
        (value - expected).abs() <= 1e-9 * expected.abs(),
        "{value}, not {expected}"
    );
}

fn only_blend(pieces: &[Planned<u64>]) -> (&Planned<u64>, Blend) {
    let mut blends = pieces.iter().filter_map(|piece| match piece.piece {
        Piece::Blend(blend) => Some((piece, blend)),
        _ => None,
    });
    let first = blends.next().unwrap();
    assert!(blends.next().is_none());
    first
}

#[test]
fn exact_stop_is_a_trapezoid_for_each_block() {
    let planned = planned("G61.1\nG1 X40 F3000\nY40\nM2\n");
    assert_close(total_s(&planned), 2.0 * (40.0 / 50.0 + 50.0 / 1000.0));
}

#[test]
fn exact_path_stops_at_corners_with_nine_tenths_of_the_acceleration() {
    let planned = planned("G61\nG1 X40 F3000\nY40\nM2\n");
    assert_close(total_s(&planned), 2.0 * (40.0 / 50.0 + 50.0 / 900.0));
    // Straight on it runs through.
    let straight = self::planned("G61\nG1 X40 F3000\nX80\nM2\n");
    assert_close(total_s(&straight), 80.0 / 50.0 + 50.0 / 1000.0);
}

#[test]
fn a_corner_is_rounded_by_the_circle_of_its_tolerance() {
    // R = s·p/(1 − s), v = √(0.866·a·R); the piece is a quarter circle.
    let (pieces, _) = planned("G64 P0.05\nG1 X40 F6000\nY40\nM2\n");
    let (piece, blend) = only_blend(&pieces);
    let s = 0.5_f64.sqrt();
    let radius = s * 0.05 / (1.0 - s);
    assert_close(blend.radius_mm, radius);
    assert_close(blend.sweep_rad, std::f64::consts::FRAC_PI_2);
    assert_eq!((piece.tag, piece.next), (2, Some(3)));
    assert_close(
        piece.profile().top_speed_mm_s(),
        (0.75_f64.sqrt() * 1000.0 * radius).sqrt(),
    );
    for (value, expected) in blend.normal.iter().zip([0.0, 1.0, 0.0]) {
        assert!((value - expected).abs() < 1e-12);
    }
    // What the blend cuts off is missing on both sides.
    assert_close(pieces[0].profile().length_mm(), 40.0 - radius);
    let Piece::Along { from_mm, to_mm } = pieces[2].piece else {
        panic!("{:?}", pieces[2]);
    };
    assert_close(from_mm, radius);
    assert_eq!(to_mm, 40.0);
}

#[test]
fn before_a_stop_that_a_word_causes_half_of_the_acceleration_is_left() {
    let alone = planned("G64 P0.05\nG1 X60 F9000\nG4 P0.1\nG1 X0\nM2\n");
    let one = 60.0 / 150.0 + 150.0 / 500.0;
    assert_close(total_s(&alone), 2.0 * one + 0.1);
    // Rapids and feeds meet at rest, with all of it.
    let changed = planned("G64 P0.05\nG1 X60 F9000\nG0 X0\nG1 X60\nM2\n");
    let rest = 60.0 / 150.0 + 150.0 / 1000.0 + 60.0 / 200.0 + 200.0 / 1000.0 + one;
    assert_close(total_s(&changed), rest);
}

#[test]
fn blocks_are_seen_fifty_ahead() {
    // 0.2 mm each: √(2·a·50·0.2), a little more for the half of the last one.
    let mut program = String::from("G61\nG1 F9000\n");
    for i in 1..=1000 {
        let _ = writeln!(program, "X{:.1}", 0.2 * f64::from(i));
    }
    let (pieces, _) = planned(&(program + "M2\n"));
    let top = pieces.iter().map(|piece| piece.profile().top_speed_mm_s());
    let top = top.fold(0.0, f64::max);
    let seen = (2.0 * 1000.0 * 50.0 * 0.2_f64).sqrt();
    assert!(top >= seen && top < seen * 1.01, "{top}");
}

#[test]
fn lines_within_q_become_one() {
    let (pieces, _) =
        planned("G64 P0.01 Q0.1\nG1 X10 Y0.05 F3000\nX20 Y0\nX30 Y0.04\nX30 Y20\nM2\n");
    let Piece::Joined { direction } = pieces[0].piece else {
        panic!("{:?}", pieces[0]);
    };
    assert_eq!((pieces[0].first, pieces[0].tag), (2, 4));
    assert_close(direction[0], 30.0 / libm::hypot(30.0, 0.04));
    // Without Q it is P: three lines.
    let (pieces, _) = planned("G64 P0.01\nG1 X10 Y0.05 F3000\nX20 Y0\nX30 Y0.04\nX30 Y20\nM2\n");
    assert!(
        pieces
            .iter()
            .all(|piece| !matches!(piece.piece, Piece::Joined { .. }))
    );
}

#[test]
fn a_blend_that_is_not_modelled_exactly_is_not_certain() {
    // A helix and a line are not in one plane: LinuxCNC overlaps their ramps.
    let (pieces, _) = planned("G64 P0.05\nG1 X20 F3000\nG3 X20 Y0 Z-5 I-10 J0\nM2\n");
    assert!(pieces.iter().all(|piece| !piece.certain));
}
