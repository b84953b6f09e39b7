//! The rules of LinuxCNC, by hand; 200 mm/s and 1000 mm/s² in each axis.

use super::{Run, machine, plan_program, total_s};
use gwatt::pipeline::Certificate;
use gwatt::plan::lookahead::{Blend, Piece, Planned};
use std::fmt::Write as _;

use super::corners::assert_close;
use crate::machines::{linear_axes, machine_from};
use crate::runs::rows_of;

/// Two blends: F is low between them.
const SLOWER_BEHIND_A_BLEND: &str =
    "G64 P0.05\nG1 X40 F9000\nG1 X50 Y1.8 F600\nG1 X60 Y1.8 F9000\nM2\n";

fn planned(program: &str) -> Run {
    plan_program(&machine("linuxcnc", 200.0, 1000.0), program.as_bytes())
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
fn in_exact_stop_an_arc_that_is_last_accelerates_by_half() {
    // A quarter circle of 40 mm at 100 mm/s asks for a quarter of 1000 mm/s² across.
    let length = 20.0 * std::f64::consts::PI;
    let time = |accel: f64| length / 100.0 + 100.0 / accel;
    let whole = 1000.0 * (1.0 - 0.25_f64 * 0.25).sqrt();
    let arc = "G61.1\nG1 X0 F6000\nG2 X40 Y40 I40 J0\n";
    let machine = super::machine("linuxcnc", 100.0, 1000.0);
    for (after, accel) in [
        ("G1 X60\n", whole),
        ("G4 P1\nG1 X60\n", 500.0),
        ("M2\n", 500.0),
    ] {
        let judged = super::glide::judged(&machine, &format!("G0 X0 Y0\n{arc}{after}"), 0.0, true);
        let (_, arc) = judged.iter().find(|(line, _)| *line == 4).unwrap();
        assert_close(arc.duration_s, time(accel));
        assert!(!arc.blended);
    }
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
fn ramps_that_overlap_are_told() {
    // A helix and a line are not in one plane: LinuxCNC overlaps their ramps.
    let (pieces, _) = planned("G64 P0.05\nG1 X20 F3000\nG3 X20 Y0 Z-5 I-10 J0\nM2\n");
    assert!(pieces.iter().all(|piece| piece.certain && piece.overlaps));
    assert!(pieces[0].overlap_s == 0.0 && pieces[1].overlap_s > 0.0);
}

#[test]
fn an_arc_that_bulges_less_than_the_tolerance_is_chords() {
    // A quarter of a circle of 0.5 mm bulges by 0.146 mm: both its chords and the
    // line from its start to its end keep within 0.3 mm.
    let program = |p: f64| format!("G64 P{p}\nG0 X5\nG3 X5.5 Y0.5 I0 J0.5 F5000\nG0 X9\nM2\n");
    let (pieces, _) = planned(&program(0.3));
    let Piece::Joined { direction } = pieces[1].piece else {
        panic!("{:?}", pieces[1]);
    };
    assert_close(direction[0], 0.5_f64.sqrt());
    assert_close(direction[1], 0.5_f64.sqrt());
    assert_close(pieces[1].length_mm, 0.5_f64.sqrt());
    // As an arc it is not faster than √(0.866·a·r).
    let (arc, _) = planned(&program(0.146));
    assert!(matches!(arc[1].piece, Piece::Along { .. }));
    assert!(pieces[1].top_speed_mm_s() > arc[1].top_speed_mm_s());
}

#[test]
fn helices_accelerate_as_recorded() {
    // Accelerations along the path, mm/s², that LinuxCNC 2.9.0~pre1 has put out.
    let recorded = [
        (
            "G2 X-7.351523 Y-5.763047 Z5.000000 I-4.776682 J-1.477601",
            956.2,
        ),
        (
            "G3 X-8.973273 Y-6.804149 Z2.000000 I-0.955336 J-0.295520",
            1281.7,
        ),
        (
            "G3 X-29.042888 Y17.023337 Z-18.000000 I-38.213460 J-11.820808",
            680.0,
        ),
        (
            "G2 X-29.042888 Y17.023337 Z-48.000000 I-4.776682 J-1.477601",
            1382.0,
        ),
        (
            "G2 X-25.023172 Y-9.573481 Z-68.000000 I-85.980284 J-26.596819",
            1057.6,
        ),
        (
            "G3 X-25.682228 Y-8.913901 Z-63.000000 I-0.955336 J-0.295520",
            509.3,
        ),
        (
            "G3 X-45.705819 Y20.354501 Z-63.000000 I-57.320189 J-17.731212",
            745.4,
        ),
        (
            "G3 X-47.769332 Y22.358615 Z-43.000000 I-2.866009 J-0.886561",
            965.7,
        ),
    ];
    let mut program = String::from("G61.1\nG1 X0.001 F9000\n");
    for (line, _) in recorded {
        program += line;
        program.push('\n');
    }
    let (pieces, _) = planned(&(program + "G1 X0\nM2\n"));
    for ((line, accel), piece) in recorded.iter().zip(&pieces[1..]) {
        let planned = piece.accel_mm_s2;
        assert!(
            (planned - accel).abs() < 0.5,
            "{line}: {planned}, not {accel}"
        );
    }
}

#[test]
fn programs_last_as_recorded() {
    // As LinuxCNC 2.9.0~pre1 runs them, s.
    let overlapping_ramps = "G64\nG1 X20 F3000\nG3 X24 Y4 I0 J4\nG18 G2 X34 Z10 I10 K0\n\
        G1 X50 Z14\nM2\n";
    let off_the_plane = "G64 P0.05\nG1 X20 F3000\nG3 X20 Y0 Z-5 I-10 J0\nG1 Y10\nM2\n";
    let slower_at_the_end = "G64 P0.05\nG1 X40 F9000\nG1 X60 Y3.6 F200\nM2\n";
    // Feeds beyond what the arcs permit: how sharp a corner is taken to be depends on
    // the speed that is asked for.
    let fast_arcs = "G64 P0.01\nF9000 G91\nG3 X11.26636 Y-3.51266 I5.15245 J-3.29821\n\
        G2 X3.34856 Y3.93068 I-0.56539 J3.87331\nM2\n";
    let fast_helices = "G64 P0.01\nF12000 G91\n\
        G2 X-8.82999 Y-25.16527 I-1.85813 J-13.47979 Z3.5254\n\
        G3 X0.32768 Y-2.18495 I7.33122 J-0.01759 Z-3.5111\n\
        G3 X6.82299 Y0.35839 I3.36619 J1.04173 Z1.8086\nM2\n";
    // Arcs whose speed the axes limit: joints are decided before the planner has
    // looked at how sharply they turn.
    let large_arcs = "G64 P0.05\nF12000 G91\nG3 X44.0976 Y132.86992 I-27.36337 J82.83414\n\
        G2 X-32.47949 Y89.72221 I38.75899 J64.77068\n\
        G2 X88.49719 Y-47.79167 I31.15385 J-48.14374\nM2\n";
    let large_helix = "G64 P0.05\nF12000 G91\nG2 X29.01052 Y63.17119 I85.51389 J-1.02416\n\
        G3 X41.76509 Y91.16897 I-26.9272 J67.48644\n\
        G2 X87.20821 Y81.89493 I77.84427 J4.48583 Z-2.594\nM2\n";
    for (program, recorded_s) in [
        (large_arcs, 3.098),
        (large_helix, 3.210),
        (fast_arcs, 1.003),
        (fast_helices, 1.511),
        (overlapping_ramps, 1.920),
        (off_the_plane, 2.036),
        (SLOWER_BEHIND_A_BLEND, 1.097),
        (slower_at_the_end, 6.221),
    ] {
        let planned_s = total_s(&planned(program));
        let off = planned_s / recorded_s - 1.0;
        assert!(off.abs() < 2e-3, "{program}{planned_s} s, not {recorded_s}");
    }
}

#[test]
fn parabolic_blends_are_chosen_as_recorded() {
    // Where what follows may take half of each element, they get to less.
    let long_enough = "G64\nG91 F8000\nG3 X9.1512 Y-2.36367 I4.41984 J-1.78488\n\
        G1 X0.8333 Y21.8881\nG3 X8.51999 Y-6.05773 I5.38156 J-1.45142\nM2\n";
    // A blend as short as its speed over one cycle is slower than that.
    let shorter_than_a_cycle = "G64 P0.01\nG91 F8000\n\
        G2 X11.69255 Y16.13696 I5.04367 J8.65003\nG1 X1.4127 Y-1.3577\nM2\n";
    // Slower than a kink: it decides again, with what a kink leaves of the arc's
    // acceleration.
    let decided_twice = "G64 P0.05 Q0\nG91 F4000\nG3 X-9.40799 Y-7.62254 I-8.65398 J1.06393\n\
        G1 X0.4095 Y-0.0326\nX1.1973 Y-0.0452\nM2\n";
    // With nothing after it the line gets to less until it is run.
    let last = "G64\nG91 F6000\nG2 X10.30608 Y-21.74059 I4.22459 J-11.31042 Z2.1897\n\
        F8000\nG1 X-19.6491 Y-11.7835\nM2\n";
    // Only the mode of the next element itself takes half of what that accelerates by.
    let before_exact_stop = "G64 P0.01\nG91 F8000\nG2 X-11.279 Y-4.8786 I-6.31001 J-0.88908\n\
        G61.1 G3 X8.0517 Y-5.6446 I7.07531 J1.52757\nM2\n";
    for (program, recorded_s) in [
        (before_exact_stop, 0.930),
        (long_enough, 1.032),
        (shorter_than_a_cycle, 0.804),
        (decided_twice, 1.015),
        (last, 0.899),
    ] {
        let planned_s = total_s(&planned(program));
        // Two cycles: it begins and ends with what is less than one.
        let off_s = planned_s - recorded_s;
        assert!(
            off_s.abs() <= 2.1e-3,
            "{program}{planned_s} s, not {recorded_s}"
        );
    }
}

#[test]
fn a_lower_feed_behind_a_blend_is_seen_too_late() {
    // The planner looks back with the speeds that the machine permits: recorded were
    // 92.3 mm/s less than a cycle of braking after the start of the line, and then
    // its F of 10 mm/s.
    let (pieces, _) = planned(SLOWER_BEHIND_A_BLEND);
    let line = pieces.iter().find(|piece| piece.tag == 3).unwrap();
    assert!((line.speeds2.start.sqrt() - 92.8).abs() < 0.5, "{line:?}");
    let profile = line.profile();
    assert_close(profile.phases[0].accel_mm_s2, -line.accel_mm_s2);
    assert_close(profile.phases[1].velocity_mm_s, 10.0);
    assert_close(profile.length_mm(), line.length_mm);
}

/// Limits of 200 mm/s and 2000 mm/s², friction of `coulomb_n` in each axis, no margin.
fn rig(masses_kg: [u32; 3], coulomb_n: u32, rest: &str) -> gwatt::machine::Machine {
    let more = format!("coulomb_n = {coulomb_n}\n{rest}");
    let axis = |letter, mass_kg| linear_axes(letter, [12000.0, 2000.0, f64::from(mass_kg)], &more);
    machine_from(&format!(
        "schema = 1\nname = \"test\"\ncontroller = \"linuxcnc\"\n[limits]\nmargin = 0\n\
         [converter]\npeak_power_w = 1e6\nregen_power_w = 1e6\n{}{}{}",
        axis("X", masses_kg[0]),
        axis("Y", masses_kg[1]),
        axis("Z", masses_kg[2])
    ))
}

/// Y 150 kg on an arc of 100 mm, then lines of 0.3 mm and a long one; recorded were 42.75 W at
/// 140 mm/s. The joints of the lines have limits of 140 mm/s. When the last short line was added
/// the first one could be entered with v² = 6·2·a·L + a·L/2 = 7500 mm²/s²; the long one brings
/// all seven joints to their limits, of which six are raised. So the axis speeds up again, by
/// 2·a·L = 1200 mm²/s² in each.
#[test]
fn runs_of_short_lines_are_slowed_down() {
    let machine = rig([50, 150, 50], 50, "");
    let check = |step_mm: f64, feed: u32| {
        let mut program =
            format!("G21 G90 G17 G94 G64 P0.01 Q0\nF{feed}\nG1 X30\nG3 X130 Y100 I0 J100\n");
        for number in 1..=7 {
            let _ = writeln!(program, "G1 Y{:.3}", 100.0 + step_mm * f64::from(number));
        }
        program.push_str("G1 Y182.1\nM2\n");
        let rows = rows_of(&machine, &program);
        let planned = |row: &gwatt::pipeline::Row| row.certificate == Certificate::Planned;
        assert!(rows.iter().all(planned));
        rows[2..9].iter().map(|row| row.peak_w).collect::<Vec<_>>()
    };
    let speeding_up = |v2: f64| (150.0 * 2.0 + 50.0) * 1e-3 * v2.sqrt();
    let peaks_w = check(0.3, 8400);
    for (peak_w, number) in peaks_w.into_iter().zip(1..) {
        assert_close(peak_w, speeding_up(7500.0 + 1200.0 * f64::from(number)));
    }
    // 140 mm/s all along.
    assert!(check(3.0, 8400).into_iter().all(|peak_w| peak_w < 7.001));
    // 86.5 mm/s are not slowed down, 86.67 mm/s are.
    assert!(check(0.3, 5190).into_iter().all(|peak_w| peak_w < 4.4));
    assert_close(check(0.3, 5200)[0], speeding_up(5200.0 * 5200.0 / 3600.0));
}

/// An arc at 100 mm/s before lines at 57 mm/s, which it brakes for later at lower overrides: what
/// it draws is what its turn takes, 0.1 m/s² at most, and friction. Sped up with 1 m/s² it drew
/// 37 W.
#[test]
fn an_arc_that_brakes_is_not_sped_up() {
    let program = "G21 G90 G17 G94 G64 P0.01 Q0\nF7999\nG1 X30\nG3 X130 Y100 I0 J100 F6000\n\
         G1 Y100.3 F3428\nG1 Y100.6\nG1 Y100.9\nG1 Y182.1\nM2\n";
    let found = rows_of(&rig([50, 150, 50], 50, ""), program);
    let diagonal = 0.5_f64.sqrt();
    let turning_w = 0.1 * diagonal * ((50.0 + 150.0) * 0.1 * diagonal + 2.0 * 50.0);
    let peak_w = found[1].peak_w;
    assert!(
        peak_w > 0.1 * 2.0 * diagonal * 50.0 && peak_w < 1.3 * turning_w,
        "{peak_w}"
    );
}

/// With limits of jerk what the optimiser leaves is not known: the robust bound counts where five
/// lines are shorter than it takes to stop.
#[test]
fn runs_of_short_lines_with_jerk_are_bounded() {
    let machine = rig([50, 150, 50], 50, "jerk_mm_s3 = 1e6\n");
    for (step_mm, certificate) in [(0.3, Certificate::Robust), (3.0, Certificate::Planned)] {
        let mut program = "G21 G90 G17 G94 G64 P0.01 Q0\nF8400\nG1 X30\n".to_owned();
        for number in 1..=60 {
            let _ = writeln!(program, "G1 X{:.3}", 30.0 + step_mm * f64::from(number));
        }
        program.push_str("M2\n");
        let rows = rows_of(&machine, &program);
        let middle = &rows[20..40];
        assert!(
            middle.iter().all(|row| row.certificate == certificate),
            "{step_mm}"
        );
        // Full acceleration at that speed, at most.
        let bound_w = 0.14 * (50.0 * 2.0 + 50.0);
        assert!(middle.iter().all(|row| row.peak_w < bound_w * (1.0 + 1e-9)));
    }
}

/// A full circle that bulges less than Q, by its diameter, is two chords. What would come back
/// to the start of a line is not joined to it, and the second chord is joined to what comes after.
#[test]
fn a_full_circle_within_the_tolerance_goes_there_and_back() {
    let machine = rig([20, 500, 50], 10, "");
    let time_s = |program: &str| {
        let all = rows_of(&machine, program);
        all.iter().map(|row| row.duration_s).sum::<f64>()
    };
    let circle = time_s("G21 G90 G17 G94 G64 P2\nF3000\nG2 I0 J-0.9799\nG1 X30\nM2\n");
    let lines = time_s("G21 G90 G17 G94 G64 P2 Q0\nF3000\nG1 Y-1.9598\nG1 X30 Y0\nM2\n");
    let none = time_s("G21 G90 G17 G94 G64 P2 Q0\nF3000\nG1 X30\nM2\n");
    assert_close(circle, lines);
    assert!(circle > none + 0.02, "{circle} {none}");
}

/// X 20 kg and Y 500 kg at 100 mm/s, and a bend by 0.001 rad, which takes 4 % of the
/// acceleration of an axis for a cycle of 1 ms: it is passed as it is. What Y gains in speed and
/// X loses, in two cycles, is drawn next to the friction of 10 N. The next joint is none.
#[test]
fn a_bend_that_is_passed_takes_its_step() {
    let program = "G21 G90 G17 G94 G64 P0.01 Q0\nF6000\nG1 X30 Y40\nG1 X59.96 Y80.03\n\
         G1 X89.92 Y120.06\nG1 X119.88 Y160.09\nM2\n";
    let second_mm = libm::hypot(29.96, 40.03);
    let (x, y) = (29.96 / second_mm, 40.03 / second_mm);
    let steady_w = 0.1 * (x + y) * 10.0;
    let stepped_w =
        0.1 * (x * (20.0 * (x - 0.6) * 50.0 + 10.0) + y * (500.0 * (y - 0.8) * 50.0 + 10.0));
    assert!(stepped_w > 1.8 * steady_w);
    for mode in ["", "G61\n"] {
        let found = rows_of(
            &rig([20, 500, 50], 10, ""),
            &program.replace("F6000", &format!("F6000\n{mode}")),
        );
        // Means are bounded over a quarter of their time at once.
        let off = found[1].peak_w / stepped_w - 1.0;
        assert!((-1e-9..1e-4).contains(&off), "{off}");
        assert_close(found[2].peak_w, steady_w);
    }
}

/// The same where a line leaves an arc of 200 mm by 0.0008 rad off its tangent: the last mean in the
/// arc takes in the whole step.
#[test]
fn bends_after_an_arc_count() {
    let machine = rig([20, 500, 50], 0, "");
    let angle = libm::asin(0.3);
    let (sin, cos) = libm::sincos(angle);
    // A joint off by 0.0008 rad from the tangent, and one that is not.
    let peak_w = |off_rad: f64| {
        let (sy, sx) = libm::sincos(angle + off_rad);
        let program = format!(
            "G21 G90 G17 G94 G64 P0.01 Q0\nF6000\nG1 X20\nG3 X{:.9} Y{:.9} I0 J200\nG1 X{:.9} Y{:.9}\nM2\n",
            20.0 + 200.0 * sin,
            200.0 - 200.0 * cos,
            20.0 + 200.0 * sin + 60.0 * sx,
            200.0 - 200.0 * cos + 60.0 * sy
        );
        rows_of(&machine, &program)[1].peak_w
    };
    // The arc alone: at its end, and Y is pulled by v²/r·cos.
    let turning_w = 0.1 * sin * 500.0 * 0.01 / 0.2 * cos;
    let off = (peak_w(0.0) / turning_w - 1.0).abs();
    assert!(off < 1e-4, "{off}");
    let (last, _) = libm::sincos(angle + 0.0008);
    let step_w = 0.1 * last * 500.0 * (0.1 * (last - sin) / 0.002);
    let bent_w = peak_w(0.0008);
    let both_w = step_w + turning_w;
    assert!(
        bent_w > 0.97 * both_w && bent_w < 1.01 * both_w,
        "{bent_w} {both_w}"
    );
}
