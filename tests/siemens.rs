//! SINUMERIK 840D: what each word means, by hand-worked programs. The sections
//! named are those of the programming manuals "Fundamentals" and "Job Planning"
//! (840D sl) and "Cycles".

mod cycles;
mod flow;
mod limits;
mod refusals;
mod spindles;

use std::fmt::Write as _;
use std::io::Cursor;

use gwatt::pipeline::{self, Options};
use insta::assert_snapshot;

use crate::listing::{listing, machine, without_lines};
use crate::random::Dice;
use crate::runs::rows_of;

fn moves(program: &str) -> String {
    listing(program, &machine("siemens"), None)
}

/// What a program of one line is refused for.
fn refusal(line: &str) -> String {
    let said = moves(&format!("{line}\n"));
    match said.lines().find(|line| line.contains(": ")) {
        Some(line) => line.to_owned(),
        None => format!("accepted: {said}"),
    }
}

/// Ends of the moves along X, for expressions.
fn values(lines: &str) -> Vec<f64> {
    let machine = machine("siemens");
    let options = Options::default();
    let mut ends = Vec::new();
    let program = format!("G0\n{lines}");
    pipeline::moves(Cursor::new(program), &machine, &options, &mut |mv, _| {
        ends.push((mv.end[0] * 1e6).round() / 1e6);
        Ok(())
    })
    .map_or_else(|_| vec![f64::NAN], |_| ends.clone())
}

/// "Arithmetic operations", "Priority of the operations", "Precision correction
/// on comparison errors (TRUNC)".
#[test]
fn expressions_have_the_values_of_the_manual() {
    let mut wrong = String::new();
    let cases: [(&str, f64); 32] = [
        ("X=2+3*4", 14.0),
        ("X=(2+3)*-4", -20.0),
        ("X=7 DIV 2", 3.0),
        ("X=-7 DIV 2", -3.0),
        ("X=7 MOD 4", 3.0),
        ("X=7/2", 3.5),
        ("X=SIN(30)*10", 5.0),
        ("X=COS(60)*10", 5.0),
        ("X=TAN(45)", 1.0),
        ("X=ASIN(0.5)", 30.0),
        ("X=ACOS(0.5)", 60.0),
        // The example of the manual: 20.8455 degrees.
        ("X=ATAN2(30.5,80.1)", 20.845_534),
        ("X=SQRT(POT(3)+POT(4))", 5.0),
        ("X=ABS(-3)", 3.0),
        ("X=TRUNC(2.9)+ROUND(2.5)+ROUNDUP(2.1)", 8.0),
        ("X=TRUNC(0.29*100)", 29.0),
        ("X=EXP(LN(7))", 7.0),
        ("X=MINVAL(2,3)+10*MAXVAL(2,3)", 32.0),
        ("X=BOUND(1,5,9)", 5.0),
        ("X=(6 B_AND 3)+10*(6 B_OR 3)+100*(6 B_XOR 3)", 572.0),
        ("X=10*(1==1)+(2<>2)", 10.0),
        ("X=1+(0.1*3==0.3)", 2.0),
        ("X=1+(NOT 0 AND 1)", 2.0),
        // Comparisons bind loosest: 2 == (2 AND 1) is false.
        ("X=1+(2==2 AND 1)", 1.0),
        ("X=1+(1 XOR 1)+(0 OR 1)", 2.0),
        ("X='H1F'+'B101'", 36.0),
        ("X=1.5EX1", 15.0),
        ("R1=4 R[2]=R1*2 X=R[1+1]+R1", 12.0),
        ("DEF INT I=2.5\nX=I", 3.0),
        ("DEF BOOL B=7\nX=B+1", 2.0),
        ("DEF REAL F[2,3]=SET(1,2,3,,5)\nX=F[0,2]*10+F[1,1]", 35.0),
        ("DEF INT F[4]=REP(6,2)\nX=F[1]+F[2]+1", 7.0),
    ];
    for (program, expected) in cases {
        let found = values(program);
        if found != [expected] {
            let _ = writeln!(wrong, "{program}: {found:?}");
        }
    }
    assert_eq!(wrong, "");
}

/// "Absolute dimensions (G90, AC)", "Incremental dimensions (G91, IC)", "Circular
/// interpolation" (CR, AR, CIP, TURN), "Deselect work offset (SUPA)".
#[test]
fn words_of_axes_and_arcs() {
    let program = "\
G0 G90 X10 Y=5+5 Z=AC(2)
X=IC(5) G91 Y-1
G90 G1 X0 Y0 F=100*5
G2 X100 Y0 I50 J0
G3 X0 Y0 I=AC(50) J=AC(0)
G2 X20 Y0 CR=10
G3 X0 Y0 AR=180
G2 I=AC(10) J0 AR=90
G1 X0 Y0
CIP X20 Y0 I1=10 J1=10
G1 X0
G3 X0 Y0 Z-6 I5 J0 TURN=2
G18 G2 X0 Z4 K5 I0
";
    // AR=90 about (10, 0) from (0, 0), clockwise: to (10, 10).
    assert_snapshot!(moves(program), @r"
1 rapid X10 Y10 Z2
2 rapid X15 Y9
3 feed X0 Y0 F500
4 arc X100 Y0 center 50,0 turns -0.5 F500
5 arc X0 Y0 center 50,0 turns 0.5 F500
6 arc X20 Y0 center 10,0 turns -0.5 F500
7 arc X0 Y0 center 10,0 turns 0.5 F500
8 arc X10 Y10 center 10,0 turns -0.25 F500
9 feed X0 Y0 F500
10 arc X20 Y0 center 10,0 turns -0.5 F500
11 feed X0 F500
12 arc X0 Y0 Z-6 center 5,0 turns 3 F500
13 arc X0 Z4 center -1,0 turns -0.5 F500
");
}

/// "Absolute dimension for rotary axes (DC, ACP, ACN)".
#[test]
fn rotary_axes_go_the_way_that_is_asked_for() {
    let program = "G0 A350\nA=DC(10)\nA20\nA=ACN(350)\nA=ACP(340)\nA=IC(-40) C=DC(180)\n";
    // 350 and 20 more are 370, that is 10; 20 is at 380; back by 30 to 350.
    assert_snapshot!(moves(program), @r"
1 rapid A350
2 rapid A370
3 rapid A380
4 rapid A350
5 rapid A700
6 rapid A660 C180
");
}

/// "Coordinate transformations (frames)".
#[test]
fn frames_are_put_into_one_another() {
    let program = "\
G1 F600 X10 Y0
TRANS X100 Y=20
X10 Y0
ATRANS X1
X10
ROT Z90
X10 Y5
G2 X20 Y5 I5 J0
ATRANS X3
G1 X=IC(1)
TRANS
MIRROR X0
G1 X20 Y0
G2 X30 Y10 I0 J10
SCALE X2 Y2
G1 X5 Y0
G3 X10 Y5 CR=5
TRANS X5
SUPA G1 X1
X1
";
    assert_snapshot!(moves(program), @r"
1 feed X10 F600
3 feed X110 Y20 F600
5 feed X111 F600
7 feed X-5 Y10 F600
8 arc X-5 Y20 center -5,15 turns -0.5 F600
10 feed Y24 F600
13 feed X-20 Y0 F600
14 arc X-30 Y10 center -20,10 turns 0.75 F600
16 feed X10 Y0 F600
17 arc X20 Y10 center 10,10 turns 0.25 F600
19 feed X1 F600
20 feed X6 F600
");
}

/// "Settable work offset (G54 ... G57, G505 ... G599, G53, G500, SUPA, G153)":
/// without a parameter file all are 0. "Continuous-path mode (G64, G641 to G645,
/// ADIS, ADISPOS)", "Exact stop mode (G60, G9)", "Programmable limits of dynamics
/// (ACC, VELOLIM, JERKLIM)", TRAORI, TRAFOOF: no motion of their own; under TRAORI
/// the words are those of the axes.
#[test]
fn offsets_path_modes_and_dynamics_move_nothing() {
    assert_snapshot!(moves("\
G500 G1 F1000 X1
G54
X2
G505 X3
G599 X4
G641 ADIS=0.5 X5
G642 X6
G645 X7
G60 X8
G9 X9
G64 X10
ACC[X]=50 VELOLIM[X]=60 JERKLIM[X]=70
X11
TRAORI
X12 A5
TRAFOOF
X13
M30
"), @r"
1 feed X1 F1000
3 feed X2 F1000
4 feed X3 F1000
5 feed X4 F1000
6 feed X5 F1000
7 feed X6 F1000
8 feed X7 F1000
9 feed X8 F1000
10 feed X9 F1000
11 feed X10 F1000
13 feed X11 F1000
15 feed X12 A5 F1000
17 feed X13 F1000
");
}

/// "Programmable rotation (ROT, AROT)", "Programmable scaling (SCALE, ASCALE)",
/// "Programmable mirroring (MIRROR, AMIRROR)": the second of each adds to what is
/// in force. TRANS X10, then 90° about Z: the axes stand at Y10 there, and X5 is
/// (0, 5); ASCALE X2: X6 is (0, 12); AMIRROR X0: X7 is (0, -14).
#[test]
fn frames_are_added() {
    assert_snapshot!(moves("\
G0 TRANS X10
AROT Z90
X5
ASCALE X2
X6
AMIRROR X0
X7
M30
"), @r"
3 rapid Y5
5 rapid Y12
7 rapid Y-14
");
}

/// "Return jump to start of program (GOTOS)".
#[test]
fn a_program_begins_anew() {
    assert_snapshot!(moves("\
%_N_MAIN_MPF
R1=0
UP
M30
%_N_UP_SPF
G0 X=R1
R1=R1+1
IF R1 < 3 GOTOS
RET
"), @r"
6 rapid
6 rapid X1
6 rapid X2
");
}

/// "Travel commands with polar coordinates".
#[test]
fn polar_coordinates_start_at_the_pole() {
    let program = "\
G0 G111 X10 Y10
AP=0 RP=10
AP=IC(90)
G1 RP=20 F100
G110 X0 Y-20
G3 AP=180 RP=20
";
    assert_snapshot!(moves(program), @r"
2 rapid X20 Y10
3 rapid X10 Y20
4 feed Y30 F100
6 arc X-10 Y10 center 10,10 turns 0.25 F100
");
}

/// "Feed rate", "Dwell time (G4)", "Inch or metric dimensions", "Constant
/// cutting rate", "Programmable feedrate override (OVR)".
#[test]
fn feeds_units_and_dwells() {
    let program = "\
G1 X10 F100 S1000 M3
OVR=50
X20
OVR=100
G4 F2.5
G4 S500
G95 F0.2 X30
G94 F100 G70 X2
G700 F10 X3
G71 X0
LIMS=2000
G96 S100 F0.1 X10
G97 S500 X20
G971 F60 X0
G93 F2 X10
";
    // G70 leaves F in mm; G700 does not. Under G96: 0.1 mm at 2000 1/min.
    assert_snapshot!(moves(program), @r"
1 feed X10 F100
3 feed X20 F50
5 dwell 2.5 s
6 dwell 30 s
7 feed X30 F200
8 feed X50.8 F100
9 feed X76.2 F254
10 feed X0 F254
12 feed X10 F200
13 feed X20 F50
14 feed X0 F60
15 feed X10 F20
");
}

/// The same part, with parameters and written out.
#[test]
fn parametrised_and_expanded_twins_move_alike() {
    let parametrised = "\
; a grid of slots
DEF INT ROWS=2, COLUMNS=3, I
DEF REAL PITCH=12.5, DEPTH[2]=SET(1,2.5), SAFE=2
G17 G54 G90 G0 X0 Y0 Z=SAFE F=60*10
FOR R1=0 TO ROWS-1
  FOR I=0 TO COLUMNS-1
    TRANS X=I*PITCH Y=R1*PITCH
    SLOT(DEPTH[R1], SAFE)
    TRANS
  ENDFOR
ENDFOR
IF ROWS*COLUMNS>5 GOTOF CORNER
X99
CORNER: G0 X=-SAFE Y=-SAFE
M30
%_N_SLOT_SPF
PROC SLOT(REAL DEEP, REAL UP)
DEF REAL LENGTH=5
G0 X0 Y0
G1 Z=-DEEP
X=LENGTH
G3 X=LENGTH Y=IC(2) CR=1
G1 X0
G0 Z=UP
RET
";
    let mut expanded = String::from("G0 X0 Y0 Z2 F600\n");
    for (y, deep) in [(0.0, 1.0), (12.5, 2.5)] {
        for x in [0.0, 12.5, 25.0] {
            let _ = write!(
                expanded,
                "G0 X{x} Y{y}\nG1 Z-{deep}\nX{}\nG3 X{} Y{} I0 J1\nG1 X{x}\nG0 Z2\n",
                x + 5.0,
                x + 5.0,
                y + 2.0
            );
        }
    }
    expanded.push_str("G0 X-2 Y-2\nM30\n");
    let [parametrised, expanded] = [parametrised, &expanded].map(moves);
    let expanded = without_lines(&expanded);
    assert_eq!(expanded.len(), 6 * 6 + 2, "{expanded:?}");
    assert_eq!(without_lines(&parametrised), expanded);
}

/// Whatever a program holds, reading it ends and does not panic.
#[test]
fn garbage_is_refused() {
    let bits = [
        "(", ")", "[", "]", "=", "\"", "'", "$", "_", ":", "%", ";", "N", "X", "R", "1", "-", ".",
        "DEF ", "REAL ", "PROC ", "IF ", "GOTOB ", "FOR ", "CASE ", "MCALL ", "CYCLE83", "TRANS ",
        "G2", "AC(", "EX9", "<<", "é", "REP(", "SET", ",",
    ];
    let mut dice = Dice(7);
    for _ in 0..3000 {
        let mut program = String::from("G1 X1 F100\n");
        for _ in 0..12 {
            program.push_str(bits[dice.below(bits.len())]);
        }
        moves(&program);
    }
    moves(&format!("X={}", "(".repeat(100_000)));
    moves(&format!("X={}1", "-".repeat(100_000)));
    moves(&format!("X=1{}", "+1".repeat(50_000)));
}

/// "Variable axis identifiers": AX, variables of the type AXIS, AXNAME, and the axes of the
/// plane, `$P_AXN1` to `$P_AXN3`.
#[test]
fn axes_by_computed_names() {
    let program = "DEF AXIS WHICH\nWHICH=X\nG0 AX[WHICH]=5\nWHICH=$P_AXN2\nAX[WHICH]=IC(3) Z1\nG18\nAX[$P_AXN1]=7\nWHICH=AXNAME(\"x\")\nIF WHICH==X\nG1 AX[WHICH]=$AA_IW[WHICH]+1 F=$AA_IW[$P_AXN1]*100\nENDIF\nAX[C]=90\n";
    assert_snapshot!(moves(program), @r"
3 rapid X5
5 rapid Y3 Z1
7 rapid Z7
10 feed X6 F700
12 feed C90 F700
");
    let refused = [
        (
            "AX[3]=1",
            "1 no-such-axis: this is the name of no axis of the machine",
        ),
        (
            "AX[B]=1",
            "1 unknown-value: B is not defined in this program",
        ),
        (
            "G0 X=AXNAME(\"B\")",
            "1 no-such-axis: AXNAME of a text that names no axis of the machine",
        ),
        (
            "G0 X=$P_AXN1",
            "1 expression: a text stands where a number is needed",
        ),
        (
            "G0 X=$P_AXN4",
            "1 unknown-value: $P_AXN4 is the control's, and gwatt does not know its value",
        ),
        (
            "$P_AXN1=3",
            "1 unsupported-word: $P_AXN1 belongs to the control, and may change offsets or limits",
        ),
    ];
    for (line, expected) in refused {
        assert_eq!(refusal(line), expected, "{line}");
    }
}

/// "Channel-specific diameter/radius programming (DIAMON, DIAM90, DIAMOF, DIAMCYCOF)": under
/// DIAM90 places of X are diameters, increments radii, word by word too.
#[test]
fn diam90_halves_places_and_no_increments() {
    let ends = values(
        "G90 DIAM90\nX50\nG91 X10\nG90 X=IC(-5)\nG91 X=AC(20)\nG90 DIAMON\nX=IC(20)\nDIAMOF X7\n\
         DIAM90 X8\nDIAMCYCOF X9\n",
    );
    assert_eq!(ends, [25.0, 35.0, 30.0, 10.0, 20.0, 7.0, 4.0, 9.0]);
    // Actual values are diameters under G91 too.
    // So is the place of a centre; as an increment it is a radius.
    let arcs = "G18 G90 DIAM90 F100\nG0 Z36 X13.8441\nG3 Z37.6614 X15.5951 K=AC(36.096) I=AC(17.5082)\n\
                G3 Z37.6614 X15.5951 K=AC(36.096) I=IC(0.9566)\n";
    assert_snapshot!(moves(arcs), @r"
    2 rapid X6.9221 Z36
    3 arc X7.7976 Z37.6614 center 36.096,8.7541 turns 0.171 F100
    4 arc X7.7976 Z37.6614 center 36.096,8.7542 turns 1 F100
    ");
    // "Circular interpolation with intermediate point and end point (CIP)": 93.33 / 2 - 20.
    let start = "G18 G90 DIAMON F100\nG0 X40 Z-25\nCIP X70 Z-75";
    let through = moves(&format!("{start} I1=93.33 K1=-54.25\n"));
    assert_snapshot!(through, @r"
    2 rapid X20 Z-25
    3 arc X35 Z-75 center -52.4809,19.2303 turns 0.3983 F100
    ");
    let twin = moves(&format!("{start} I1=IC(26.665) K1=IC(-29.25)\n"));
    assert_eq!(through, twin);
    let read = values("DIAM90 X50\nR1=$AA_IW[X]\nG91\nR2=$AA_IW[X]\nDIAMOF G90 X=R1+R2\n");
    assert_eq!(read, [25.0, 100.0]);
}

/// "Constraints when selecting a transformation": the frame in force is deselected, as by G500,
/// and where the work offset is not known, the way to the next place is not either.
#[test]
fn a_transformation_deselects_frames() {
    for word in ["TRAORI", "TRAFOOF"] {
        let rows = rows_of(
            &machine("siemens"),
            &format!("G500 G1 X0 F1000\nTRANS X200\nX0\n{word}\nX0\nM30\n"),
        );
        let last = rows.last().expect("a row");
        assert!(
            (last.duration_s - 12.0).abs() < 0.1,
            "{word}: {}",
            last.duration_s
        );
    }
}
