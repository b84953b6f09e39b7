//! Cutter radius compensation: paths worked by hand and checked with LinuxCNC
//! 2.9, refusals, and what `limit` does with such blocks.

mod refusals;

use std::fmt::Write as _;

use gwatt::interpret::{Move, MoveKind};
use gwatt::machine::ALL_AXES;
use gwatt::pipeline::{self, Failure, Options};
use insta::assert_snapshot;
use proptest::prelude::*;

use crate::limit::{EXACT_STOP, RIG, Rig};
use crate::listing::machine_of;
use crate::runs::moves_of;

fn read(controller: &str, options: &Options, program: &str) -> (Vec<Move>, Option<Failure>) {
    moves_of(&machine_of(controller, "", "XYZ", "A"), options, program)
}

/// The moves, a line each: line, kind, ends of the axes that move, centre and
/// sweep in degrees; or the messages of a refusal.
fn moves(program: &str) -> String {
    shown("linuxcnc", &Options::default(), program)
}

fn shown(controller: &str, options: &Options, program: &str) -> String {
    let mut out = String::new();
    let (moves, failure) = read(controller, options, program);
    match failure {
        None => {
            for mv in &moves {
                let _ = write!(out, "{} {}", mv.line, mv.kind.name());
                for axis in mv.moving.iter() {
                    let letter = ALL_AXES[axis].letter() as char;
                    let _ = write!(out, " {letter}{:.6}", mv.end[axis] + 0.0);
                }
                if let Some(arc) = &mv.arc {
                    let _ = write!(
                        out,
                        " about {:.6},{:.6} by {:.4}",
                        arc.center[0] + 0.0,
                        arc.center[1] + 0.0,
                        arc.sweep_rad.to_degrees()
                    );
                }
                if mv.feed_mm_s.is_finite() {
                    let _ = write!(out, " F{:.2}", mv.feed_mm_s * 60.0);
                }
                out.push('\n');
            }
        }
        Some(Failure::Refused { diagnostics, .. }) => {
            for found in diagnostics {
                let help = found.help.as_deref().unwrap_or("");
                let _ = writeln!(
                    out,
                    "{} {}: {} | {help}",
                    found.line, found.rule, found.message
                );
            }
        }
        Some(other) => panic!("{other:?}"),
    }
    out
}

/// LinuxCNC, "Cutter Compensation", "G41, G42": outside corners by arcs.
#[test]
fn outside_a_square() {
    // Clockwise with the tool on the left: corners are rounded by arcs about
    // them, with the feed of the block after the corner.
    let program =
        "G21 F600\nG0 X0 Y-10\nG41.1 D4\nG1 X0 Y0\nY20\nX20 F300\nY0\nX0\nG40\nG1 X-10 Y-10\nM2\n";
    assert_snapshot!(moves(program), @r#"
2 rapid Y-10.000000
4 feed X-2.000000 Y0.000000 F600.00
5 feed Y20.000000 F600.00
6 arc X0.000000 Y22.000000 about 0.000000,20.000000 by -90.0000 F300.00
6 feed X20.000000 F300.00
7 arc X22.000000 Y20.000000 about 20.000000,20.000000 by -90.0000 F300.00
7 feed Y0.000000 F300.00
8 arc X20.000000 Y-2.000000 about 20.000000,0.000000 by -90.0000 F300.00
8 feed X0.000000 F300.00
10 feed X-10.000000 Y-10.000000 F300.00
"#);
}

/// "Cutter Compensation": inside corners where the shifted lines meet.
#[test]
fn inside_a_square() {
    // Counter-clockwise with the tool on the left: the corners of the pocket
    // are those of a pocket smaller by the radius.
    let program = "G21 F600\nG0 X10 Y10\nG41.1 D4 G1 X0 Y10\nY0\nX20\nY20\nX0\nY10\nG40 X10\nM2\n";
    assert_snapshot!(moves(program), @r#"
2 rapid X10.000000 Y10.000000
3 feed X2.000000 Y8.000000 F600.00
4 feed Y2.000000 F600.00
5 feed X18.000000 F600.00
6 feed Y18.000000 F600.00
7 feed X2.000000 F600.00
8 feed Y10.000000 F600.00
9 feed X10.000000 F600.00
"#);
}

#[test]
fn the_other_side_is_the_mirror_image() {
    let left =
        "G21 F600\nG0 X0 Y-10\nG41.1 D4\nG1 X0 Y0\nY20\nG2 X6 Y26 I6\nG1 X20\nG40\nG1 X0\nM2\n";
    let right =
        "G21 F600\nG0 X0 Y-10\nG42.1 D4\nG1 X0 Y0\nY20\nG3 X-6 Y26 I-6\nG1 X-20\nG40\nG1 X0\nM2\n";
    let by_sign = left.replace("G41.1 D4", "G42.1 D-4");
    let plain = read("linuxcnc", &Options::default(), left).0;
    let mirrored = read("linuxcnc", &Options::default(), right).0;
    assert_eq!(plain.len(), 6);
    assert_eq!(plain.len(), mirrored.len());
    for (a, b) in plain.iter().zip(&mirrored) {
        assert!((a.end[0] + b.end[0]).abs() < 1e-12 && (a.end[1] - b.end[1]).abs() < 1e-12);
        assert_eq!(
            a.arc.map(|arc| arc.sweep_rad > 0.0),
            b.arc.map(|arc| arc.sweep_rad < 0.0)
        );
    }
    assert_eq!(moves(left), moves(&by_sign));
}

/// "Cutter Compensation": lines and arcs, "concave corners".
#[test]
fn inside_corners_of_lines_and_arcs() {
    // Arc of radius 5 about (4, 3) from the origin, the tool (r = 1) outside
    // it at 6: the line y = 1 reaches that circle at x = 4 - sqrt(6² - 2²).
    let line_arc = "F600\nG0 X-20 Y0\nG41.1 D2\nG1 X-10 Y0\nX0\nG2 X9 Y3 I4 J3\nG40\nG1 Y20\nM2\n";
    assert_snapshot!(moves(line_arc), @r#"
2 rapid X-20.000000
4 feed X-10.000000 Y1.000000 F600.00
5 feed X-1.656854 F600.00
6 arc X10.000000 Y3.000000 about 4.000000,3.000000 by -199.4712 F600.00
8 feed X9.000000 Y20.000000 F600.00
"#);
    // The same the other way round, on the other side.
    let arc_line =
        "F600\nG0 X9 Y-20\nG42.1 D2\nG1 X9 Y-10\nY3\nG3 X0 Y0 I-5\nG1 X-10\nG40\nG1 X-20\nM2\n";
    assert_snapshot!(moves(arc_line), @r#"
2 rapid X9.000000 Y-20.000000
4 feed X10.000000 Y-10.000000 F600.00
5 feed Y3.000000 F600.00
6 arc X-1.656854 Y1.000000 about 4.000000,3.000000 by 199.4712 F600.00
7 feed X-10.000000 F600.00
9 feed X-20.000000 Y0.000000 F600.00
"#);
    // Two arcs of radius 5 about (0, 0) and (6, 0) that meet in (3, 4): outside
    // both at radius 6 the tool changes in (3, sqrt(6² - 3²)).
    let arc_arc = "F600\nG0 X-5 Y-20\nG41.1 D2\nG1 X-5 Y-10\nY0\nG2 X3 Y4 I5\nG2 X11 Y0 I3 J-4\nG40\nG1 Y-9\nM2\n";
    assert_snapshot!(moves(arc_arc), @r#"
2 rapid X-5.000000 Y-20.000000
4 feed X-6.000000 Y-10.000000 F600.00
5 feed Y0.000000 F600.00
6 arc X3.000000 Y5.196152 about 0.000000,0.000000 by -120.0000 F600.00
7 arc X12.000000 Y0.000000 about 6.000000,0.000000 by -120.0000 F600.00
9 feed X11.000000 Y-9.000000 F600.00
"#);
}

#[test]
fn small_bends_count_as_none() {
    // 0.05 rad are 0.5002 in ten: below, the next line begins where the one
    // before ends; above, a corner is rounded or cut short.
    let ends = |y: &str| {
        let program = format!("F600\nG0 X0 Y0\nG41.1 D4\nG1 X10\nX20 Y{y}\nG40\nG1 X0 Y0\nM2\n");
        let moves = read("linuxcnc", &Options::default(), &program).0;
        (moves.len(), moves[1].end)
    };
    for y in ["0.5", "-0.5"] {
        let (count, first) = ends(y);
        assert_eq!((count, first[0], first[1]), (4, 10.0, 2.0));
    }
    assert_eq!(ends("-0.501").0, 5);
    let (count, first) = ends("0.501");
    assert!(count == 4 && first[0] < 9.95 && first[1] == 2.0);
}

#[test]
fn what_lies_between_moves_keeps_its_order() {
    // Z, a dwell and a rotary axis wait with the move before them and stay in
    // its place; in a corner the rotary axis turns on the way round it.
    let program = "F600\nG0 X0 Y0\nG41.1 D4\nG1 X10\nG4 P1\nZ-3 F60\nG1 A30\nX20 Y-10 F100\nY10 A40\nG40\nG0 X0\nM2\n";
    assert_snapshot!(moves(program), @r#"
2 rapid
4 feed X10.000000 Y2.000000 F600.00
5 dwell
6 feed Z-3.000000 F60.00
7 feed A30.000000 F60.00
8 arc X11.414214 Y1.414214 about 10.000000,0.000000 by -45.0000 F100.00
8 feed X18.000000 Y-5.171573 F100.00
9 feed Y10.000000 A40.000000 F100.00
11 rapid X0.000000
"#);
}

#[test]
fn rapids_go_round_corners_straight() {
    let program = "F600\nG0 X0 Y0\nG41.1 D4\nG0 X10\nG0 Y-10 Z5\nG1 X20\nG40\nG1 X0\nM2\n";
    assert_snapshot!(moves(program), @r#"
2 rapid
4 rapid X10.000000 Y2.000000
5 rapid X12.000000 Y0.000000
5 rapid Y-8.000000 Z5.000000
6 feed X20.000000 F600.00
8 feed X0.000000 Y-10.000000 F600.00
"#);
}

/// LinuxCNC, "Lathe User Information", "Tool Orientations".
#[test]
fn a_lathe_tool_by_its_orientation() {
    // Orientation 2: the controlled point lies at smaller X and smaller Z than
    // the nose's centre, each by its radius. So it is on the path along the
    // face and next to it by the radius along Z.
    let program = "G18 F600\nG0 X0 Z10\nG42.1 D2 L2\nG1 X0 Z0\nX10\nZ-20\nG40\nG0 X20 Z10\nM2\n";
    assert_snapshot!(moves(program), @r#"
2 rapid Z10.000000
4 feed Z0.000000 F600.00
5 feed X9.000000 F600.00
6 arc X10.000000 Z-1.000000 about -1.000000,9.000000 by 90.0000 F600.00
6 feed Z-21.000000 F600.00
8 rapid X20.000000 Z10.000000
"#);
}

#[test]
fn helices_and_arcs_as_first_moves() {
    // The first arc would end 2 mm next to the programmed end, in (12, 0); its
    // centre moves so that it passes where the tool is. The next arc turns back
    // there: both circles meet at 6 + (6² + 14² - 12²)/(2·14). The helix has two
    // turns, less what is cut off.
    let program = "F600\nG0 X0 Y0\nG41.1 D4\nG2 X10 Y0 I5\nG2 X30 Y0 I10 Z-4 P2\nG40\nG1 X0\nM2\n";
    assert_snapshot!(moves(program), @r#"
2 rapid
4 arc X9.142857 Y5.111013 about 6.000000,0.000000 by -121.5881 F600.00
5 arc X32.000000 Y0.000000 Z-4.000000 about 20.000000,0.000000 by -514.7912 F600.00
7 feed X0.000000 F600.00
"#);
}

/// LinuxCNC, "G40": the move after it leads back.
#[test]
fn the_ends_of_compensation() {
    // M2 ends it; G40 without motion and D0 change nothing.
    let program =
        "F600\nG0 X0 Y0\nG41.1 D0\nG1 X5\nG40\nG41.1 D4\nG40\nG1 X0\nG41.1 D4\nG1 X10\nY10\nM2\n";
    assert_snapshot!(moves(program), @r#"
2 rapid
4 feed X5.000000 F600.00
8 feed X0.000000 F600.00
10 feed X8.000000 Y2.000000 F600.00
11 feed Y10.000000 F600.00
"#);
    // Incremental moves after G40 count from the programmed place.
    let program = "F600\nG0 X0 Y0\nG41.1 D4 G1 X10\nG40\nG91 G1 Y5\nM2\n";
    assert_snapshot!(moves(program), @r#"
2 rapid
3 feed X10.000000 Y2.000000 F600.00
5 feed Y5.000000 F600.00
"#);
    assert_snapshot!(moves("F600\nG41.1 D4\nG1 X10\nX20\n"), @r#"
    0 no-units: neither the program (G20, G21) nor the machine file says whether lengths are millimetres or inches: taken as millimetres, of which the control may make inches | write G21 or G20 at the beginning, or say units = "mm" or "inch" under [language] of the machine file
    0 compensation: the program ends under cutter compensation: where its last move ends is not known | write G40 and a move, or the end of the program: M2 or M30
    "#);
}

/// How far a point lies to the left of a line.
fn left_of(line: [[f64; 2]; 2], point: [f64; 2]) -> f64 {
    let [a, b] = line;
    let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
    (dx * (point[1] - a[1]) - dy * (point[0] - a[0])) / (dx * dx + dy * dy).sqrt()
}

/// Distance of a point from a piece of line.
fn distance(line: [[f64; 2]; 2], point: [f64; 2]) -> f64 {
    let [a, b] = line;
    let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
    let square = (dx * dx + dy * dy).max(f64::MIN_POSITIVE);
    let share = ((point[0] - a[0]) * dx + (point[1] - a[1]) * dy) / square;
    let share = share.clamp(0.0, 1.0);
    ((point[0] - a[0] - share * dx).powi(2) + (point[1] - a[1] - share * dy).powi(2)).sqrt()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    /// Each end of a shifted line lies at the tool's radius from the programmed
    /// line, on the right side of it; no point of a move comes nearer to the
    /// piece that it belongs to; arcs keep the radius from their corner.
    #[test]
    fn shifted_polygons_keep_their_distance(
        radii in prop::collection::vec(20.0..40.0f64, 4..12),
        diameter in 0.5..3.0f64,
        left in any::<bool>(),
    ) {
        let count = radii.len();
        let corner = |index: usize| {
            let angle = std::f64::consts::TAU * index as f64 / count as f64;
            let radius = radii[index % count];
            [libm::cos(angle), libm::sin(angle)].map(|share| (radius * share * 1e3).round() / 1e3)
        };
        let start = [60.0, -1.0];
        let mut points = vec![start];
        points.extend((0..=count).map(corner));
        // Bends below 0.05 rad count as none.
        let bent = points.windows(3).all(|three| {
            let length = distance([three[1], three[1]], three[2]);
            left_of([three[0], three[1]], three[2]).abs() > 0.06 * length
        });
        prop_assume!(bent);
        let code = if left { "G41.1" } else { "G42.1" };
        let mut program = format!("F600\nG0 X60 Y-1\n{code} D{diameter:.3}\n");
        for point in &points[1..] {
            let _ = writeln!(program, "G1 X{} Y{}", point[0], point[1]);
        }
        program.push_str("G40\nG1 X80\nM2\n");
        let radius = (diameter * 1e3).round() / 2e3;
        let (found, failure) = read("linuxcnc", &Options::default(), &program);
        // An acute corner may take more of a line than there is.
        prop_assume!(failure.is_none());
        let first_line = 4;
        let last_line = first_line + points.len() as u64 - 2;
        let mut at = start;
        for mv in found.iter().filter(|mv| (first_line..=last_line).contains(&mv.line)) {
            let end = [mv.end[0], mv.end[1]];
            prop_assert!((mv.start[0] - at[0]).abs() < 1e-9 && (mv.start[1] - at[1]).abs() < 1e-9);
            let index = (mv.line - first_line) as usize;
            let line = [points[index], points[index + 1]];
            if mv.kind == MoveKind::Arc {
                prop_assert_eq!(mv.arc.map(|arc| arc.center), Some(points[index]));
                for point in [at, end] {
                    let [x, y] = [point[0] - line[0][0], point[1] - line[0][1]];
                    prop_assert!((libm::hypot(x, y) - radius).abs() < 1e-9);
                }
            } else if index > 0 {
                let side = if left { radius } else { -radius };
                for point in [at, end] {
                    prop_assert!((left_of(line, point) - side).abs() < 1e-9);
                    prop_assert!(distance(line, point) >= radius - 1e-9);
                }
            }
            at = end;
        }
    }
}

const MILL: Rig = Rig {
    controller: "linuxcnc",
    rest: EXACT_STOP,
    ..RIG
};

#[test]
fn limit_leaves_its_blocks_and_their_feeds_alone() {
    // F30000 is 1250 W at the end of a long ramp; F24000 fits 1000 W. The feed
    // is put back before the compensation begins, since its moves obey it.
    let program =
        "G1 X400 F30000\nG41.1 D4\nG1 X410 F600\nY20\nX430\nG40\nG1 X400 F30000\nX0\nM2\n";
    let text = MILL.fits(program);
    assert_snapshot!(text, @r#"
G1 X400 F24000
F30000
G41.1 D4
G1 X410 F600
Y20
X430
G40
G1 X400 F30000
X0 F24000
F30000
M2
"#);
}

#[test]
fn what_does_not_fit_is_told_with_its_own_line() {
    // Line 4 is known when line 5 is read, and line 5 with the end of line 6.
    let program = "F600\nG41.1 D4\nG1 X10\nX400 F30000\nY20 F600\nG40\nG1 X0\nM2\n";
    let text = MILL.fits(program);
    assert_eq!(text, program.replace("F30000", "F24000"));
    // M0 would have to stand on a line of its own.
    let program = program.replace("F30000", "F30000 M0");
    let program = program.as_str();
    let reasons = MILL.reasons(program);
    let first = &reasons[0];
    assert_eq!(
        (reasons.len(), first.line, first.rule),
        (1, 4, "untouchable")
    );
    assert_eq!(first.text, b"X400 F30000 M0");
    assert_eq!(
        first.message,
        "the block may not be changed: it is under cutter compensation, where no line may come between"
    );
    let summary = pipeline::analyze(
        std::io::Cursor::new(program),
        &MILL.machine(),
        &Options::default(),
        None,
    )
    .expect("a program");
    assert_eq!(summary.unfit.len(), 1);
    assert_eq!(
        (summary.unfit[0].line, summary.unfit[0].text.as_slice()),
        (4, b"X400 F30000 M0".as_slice())
    );
    // By itself: whether the program has a way for it is looked at by `limit`.
    assert_eq!(
        summary.unfit[0].help,
        "fits with F24000 (limit --allow feed)"
    );
}

#[test]
fn in_loops_and_subprograms() {
    let program = "o1 sub\nG41.1 D#1\nG1 X10 Y0\nY10\nX0\no1 endsub\nF600\no2 repeat [2]\nG0 X0 Y0\no1 call [2]\nG40\nG0 X-10\no2 endrepeat\nM2\n";
    let found = moves(program);
    let lines: Vec<&str> = found.lines().collect();
    assert_eq!(lines.len(), 10, "{found}");
    assert_eq!(lines[1], "3 feed X9.000000 Y1.000000 F600.00");
    assert_eq!(lines[2], "4 feed Y9.000000 F600.00");
    assert_eq!(lines[3], "5 feed X0.000000 F600.00");
    assert_eq!(lines[4], "12 rapid X-10.000000 Y10.000000");
    // Its lines stay, whatever runs of them come; the others may change.
    let fast = program
        .replace("G0 X-10", "G1 X-400 F30000\nF600")
        .replace("G0 X0 Y0", "G1 X0 Y0");
    let text = MILL.fits(&fast);
    assert!(text.contains("G1 X-400 F23999\nF30000\nF600\n"), "{text}");
}
