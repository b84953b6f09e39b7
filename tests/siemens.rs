//! SINUMERIK 840D: what each word means, by hand-worked programs. The sections
//! named are those of the programming manuals "Fundamentals" and "Job Planning"
//! (840D sl) and "Cycles".

use std::fmt::Write as _;
use std::io::Cursor;

use gwatt::machine::Machine;
use gwatt::pipeline::{self, Failure, Options, Reading};
use insta::assert_snapshot;

/// A machine with linear axes X Y Z and rotary axes A C.
fn machine() -> Machine {
    let mut text = String::from(
        "schema = 1\nname = \"test\"\ncontroller = \"siemens\"\n[converter]\npeak_power_w = 1e5\n",
    );
    for axis in ["X", "Y", "Z"] {
        let _ = writeln!(
            text,
            "[axes.{axis}]\nrapid_mm_min = 6000\naccel_mm_s2 = 1000\nmass_kg = 10"
        );
    }
    for axis in ["A", "C"] {
        let _ = writeln!(
            text,
            "[axes.{axis}]\nkind = \"rotary\"\nrapid_deg_min = 3600\naccel_deg_s2 = 500\ninertia_kg_m2 = 1"
        );
    }
    Machine::from_toml("test.toml", &text)
        .expect("a valid machine")
        .0
}

fn options(folder: Option<&std::path::Path>) -> Options {
    Options {
        reading: Reading {
            sub_paths: folder.iter().map(|folder| folder.to_path_buf()).collect(),
            ..Reading::default()
        },
        ..Options::default()
    }
}

/// The moves of a program, a line each: line, kind, the axes that differ from
/// the start, arc, feed in mm/min; and what is said about it.
fn run(program: &str, options: &Options) -> String {
    let machine = machine();
    let mut out = String::new();
    let result = pipeline::moves(Cursor::new(program), &machine, options, &mut |mv, _| {
        let _ = write!(out, "{} {}", mv.line, mv.kind.name());
        for axis in mv.moving.iter() {
            let letter = gwatt::machine::ALL_AXES[axis].letter() as char;
            let value = (mv.end[axis] * 1e4).round() / 1e4 + 0.0;
            let _ = write!(out, " {letter}{value}");
        }
        if let Some(arc) = &mv.arc {
            let turns = (arc.sweep_rad / std::f64::consts::TAU * 1e4).round() / 1e4;
            let center = arc.center.map(|value| (value * 1e4).round() / 1e4 + 0.0);
            let _ = write!(out, " center {},{} turns {turns}", center[0], center[1]);
        }
        if mv.feed_mm_s.is_finite() {
            let _ = write!(out, " F{}", (mv.feed_mm_s * 6e5).round() / 1e4);
        }
        if mv.dwell_s > 0.0 {
            let _ = write!(out, " {} s", mv.dwell_s);
        }
        out.push('\n');
        Ok(())
    });
    if let Err(Failure::Refused { diagnostics, .. }) = result {
        for found in diagnostics
            .iter()
            .filter(|found| found.severity == gwatt::diagnostic::Severity::Error)
        {
            let _ = writeln!(out, "{} {}: {}", found.line, found.rule, found.message);
        }
    }
    out
}

fn moves(program: &str) -> String {
    run(program, &options(None))
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
    let machine = machine();
    let mut ends = Vec::new();
    let program = format!("G0\n{lines}");
    pipeline::moves(
        Cursor::new(program),
        &machine,
        &options(None),
        &mut |mv, _| {
            ends.push((mv.end[0] * 1e6).round() / 1e6);
            Ok(())
        },
    )
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

/// "Program jumps", "Program branch (CASE)", "Check structures".
#[test]
fn jumps_and_structures() {
    let program = "\
G0 R1=1 R2=3
AGAIN: X=R1 ; a label
R1=R1+1
IF R1<R2 GOTOB AGAIN
N50 GOTOF N70
N60 X99
N70 GOTOC NOWHERE
CASE (R1) OF 1 GOTOF ONE 3 GOTOF THREE DEFAULT GOTOF NEITHER
ONE: X98
NEITHER: X97
THREE: IF R1==3
  IF R1==4
    X96
  ELSE
    Y1
  ENDIF
ELSE
  X95
ENDIF
FOR R3=1 TO 2
  FOR R4=8 TO 9
    Y=R3*10+R4
  ENDFOR
ENDFOR
WHILE R1>2
  R1=R1-1
  Z=R1
ENDWHILE
REPEAT
  R1=R1+1
  Z=R1*10
UNTIL R1>=4
LOOP
  R1=R1+1
  IF R1>6 GOTOF OUT
  Z=R1
ENDLOOP
OUT: GOTO 1000
X94
:1000 Z0
M30
X93
";
    assert_snapshot!(moves(program), @r"
2 rapid X1
2 rapid X2
15 rapid Y1
22 rapid Y18
22 rapid Y19
22 rapid Y28
22 rapid Y29
27 rapid Z2
31 rapid Z30
31 rapid Z40
36 rapid Z5
36 rapid Z6
40 rapid Z0
");
}

/// "Repeat program section (REPEAT, REPEATB, ENDLABEL)".
#[test]
fn sections_are_repeated() {
    let program = "\
G0 G91
FIRST: X1
SECOND: X10
REPEATB FIRST P=2
REPEAT FIRST SECOND P=1
REPEAT FIRST P1
GOTOF DONE
LATER: Y1
Y10
ENDLABEL:
Y100
DONE: REPEAT LATER P2
M30
";
    let said = moves(program);
    // X: 1 11 | 12 13 | 14 24 | then the section up to the REPEAT itself.
    let ends: Vec<&str> = said.lines().collect();
    assert_eq!(ends.len(), 6 + 6 + 4, "{said}");
    assert_snapshot!(moves("G0 G91\nA: X1\nB: Y1\nREPEAT A B P2\nREPEATB A\n"), @r"
2 rapid X1
3 rapid Y1
2 rapid X2
3 rapid Y2
2 rapid X3
3 rapid Y3
2 rapid X4
");
}

/// "Subprogram technique": in the same file, behind `%_N_NAME_SPF`.
#[test]
fn subprograms_in_the_same_file() {
    let program = "\
%_N_MAIN_MPF
;$PATH=/_N_MPF_DIR
EXTERN BOX(REAL, REAL, VAR REAL)
DEF REAL SIDE=4, SUM
G0 X1
BOX(SIDE,,SUM) P2
X=SUM
CALL \"L5\"
L5 P2
MCALL L5
X0
MCALL
X20
M30
%_N_BOX_SPF
PROC BOX(REAL A, REAL B=2, VAR REAL C) SAVE
G91 X=A Y=B
C=A+B
RET
%_N_L5_SPF
Z=$AA_IW[Z]+1
M17
";
    assert_snapshot!(moves(program), @r"
5 rapid X1
17 rapid X5 Y2
17 rapid X9 Y4
7 rapid X6
21 rapid Z1
21 rapid Z2
21 rapid Z3
11 rapid X0
21 rapid Z4
13 rapid X20
");
}

#[test]
fn subprograms_in_files_of_their_own() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(
        folder.path().join("Hole.spf"),
        "PROC HOLE(REAL D)\nG1 Z=-D F100\nG0 Z1\nENDPROC\n",
    )
    .unwrap();
    let options = options(Some(folder.path()));
    assert_snapshot!(run("G0 X5\nhole(3)\nNONE\n", &options), @r"
1 rapid X5
2 feed Z-3 F100
3 rapid Z1
3 no-such-subprogram: there is no subprogram NONE, and no word of this name
");
    std::fs::write(folder.path().join("OPEN.SPF"), "G0 X1\n").unwrap();
    assert_snapshot!(run("OPEN\n", &options), @r"
1 rapid X1
1 subprogram: the subprogram ends without a return
");
}

/// "Drilling cycles".
#[test]
fn drilling_cycles_as_moves() {
    let program = "\
G0 X5 Z50 S1000 M3 F200
CYCLE81(20,10,2,-5)
CYCLE82(20,10,2,,15,1.5)
CYCLE85(20,10,2,,15,,100,300)
CYCLE84(20,10,2,,15,0,3,12,,0,400,800)
CYCLE840(20,10,2,,15,,4,3,0,,1.5)
CYCLE86(20,10,2,-5,,1,3,-1,0,0.5)
";
    // M12 has a pitch of 1.75: 700 in, 1400 out.
    assert_snapshot!(moves(program), @r"
1 rapid X5 Z50
2 rapid Z12
2 feed Z-5 F200
2 rapid Z20
3 rapid Z12
3 feed Z-5 F200
3 dwell 1.5 s
3 rapid Z20
4 rapid Z12
4 feed Z-5 F100
4 feed Z12 F300
4 rapid Z20
5 rapid Z12
5 tap Z-5 F700
5 tap Z12 F1400
5 rapid Z20
6 rapid Z12
6 tap Z-5 F1500
6 tap Z12 F1500
6 rapid Z20
7 rapid Z12
7 feed Z-5 F200
7 dwell 1 s
7 rapid X4 Z-4.5
7 rapid Z12
7 rapid X5 Z20
");
}

/// "Deep-hole drilling (CYCLE83)": 20 deep, first 10, each stroke 4 shorter.
#[test]
fn deep_holes_in_strokes() {
    let out = "G0 Z50 F100\nCYCLE83(5,0,1,-20,,-10,,4,1,2,0.5,1)\n";
    assert_snapshot!(moves(out), @r"
1 rapid Z50
2 rapid Z1
2 feed Z-10 F50
2 dwell 1 s
2 rapid Z1
2 dwell 2 s
2 rapid Z-9.4
2 feed Z-15 F100
2 dwell 1 s
2 rapid Z1
2 dwell 2 s
2 rapid Z-14.4
2 feed Z-20 F100
2 dwell 1 s
2 rapid Z5
");
    let break_chips = "G0 Z50 F100\nCYCLE83(5,0,1,-12,,,6,0,,,1,0)\n";
    assert_snapshot!(moves(break_chips), @r"
1 rapid Z50
2 rapid Z1
2 feed Z-6 F100
2 feed Z-5 F100
2 feed Z-12 F100
2 rapid Z5
");
}

/// "Row of holes (HOLES1)", "Circle of holes (HOLES2)", "Modal call (MCALL)".
#[test]
fn patterns_of_holes() {
    let program = "\
G0 X100 Z10 F100
MCALL CYCLE81(10,0,1,-2)
HOLES1(0,0,0,10,20,2)
HOLES2(0,0,10,90,0,2)
Y5
MCALL
Y6
";
    // The row begins at its nearer end.
    assert_snapshot!(moves(program), @r"
1 rapid X100 Z10
3 rapid X30
3 rapid Z1
3 feed Z-2 F100
3 rapid Z10
3 rapid X10
3 rapid Z1
3 feed Z-2 F100
3 rapid Z10
4 rapid X0 Y10
4 rapid Z1
4 feed Z-2 F100
4 rapid Z10
4 rapid Y-10
4 rapid Z1
4 feed Z-2 F100
4 rapid Z10
5 rapid Y5
5 rapid Z1
5 feed Z-2 F100
5 rapid Z10
7 rapid Y6
");
}

#[test]
fn a_pattern_calls_a_subprogram_at_each_place() {
    let program = "\
%_N_MAIN_MPF
G0 X100
MCALL DOWN(3)
HOLES1(0,0,0,0,10,3)
MCALL
X50
M30
%_N_DOWN_SPF
PROC DOWN(REAL D)
Z=-D
Z0
M17
";
    assert_snapshot!(moves(program), @r"
2 rapid X100
4 rapid X20
10 rapid Z-3
11 rapid Z0
4 rapid X10
10 rapid Z-3
11 rapid Z0
4 rapid X0
10 rapid Z-3
11 rapid Z0
6 rapid X50
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
    let without_lines = |program: &str| {
        let said = moves(program);
        let lines = said.lines();
        lines
            .map(|line| line.split_once(' ').unwrap_or_default().1.to_owned())
            .collect::<Vec<_>>()
    };
    let moves = without_lines(&expanded);
    assert_eq!(moves.len(), 6 * 6 + 2, "{moves:?}");
    assert_eq!(without_lines(parametrised), moves);
}

/// What is not followed is refused by its name.
#[test]
#[allow(clippy::too_many_lines, reason = "a table")]
fn refusals_name_the_construct() {
    let mut wrong = String::new();
    let cases = [
        (
            "CT X10 Y10",
            "1 unsupported-word: CT is an arc tangential to the move before, which gwatt does not follow",
        ),
        (
            "G58 X10",
            "1 unsupported-code: G58 is an offset of single axes, which gwatt does not support",
        ),
        (
            "G12345",
            "1 unknown-code: G12345 is not known to this controller profile",
        ),
        (
            "X10 A3=1",
            "1 unsupported-word: A3 is a tool vector, which turns axes as the machine is built, which gwatt does not follow",
        ),
        (
            "POCKET3(1,2)",
            "1 unsupported-word: POCKET3 is a pocket cycle, which gwatt does not follow",
        ),
        (
            "MCALL CYCLE72(1)",
            "1 unsupported-word: CYCLE72 is a milling cycle, which gwatt does not follow",
        ),
        (
            "CYCLE800(1,\"T\")",
            "1 unsupported-word: CYCLE800 is a swivelled plane, which turns axes as the machine is built, which gwatt does not follow",
        ),
        (
            "DIAM90",
            "1 unsupported-word: DIAM90 is diameters under G90 only, which gwatt does not follow",
        ),
        (
            "ID=1 DO $AC_OVR=50",
            "1 unsupported-word: ID is a synchronized action, which gwatt does not follow",
        ),
        (
            "RET(\"A\")",
            "1 unsupported-word: RET( ) is a return to another place, which gwatt does not follow",
        ),
        (
            "$P_UIFR[1,X,TR]=10",
            "1 unsupported-word: $P_UIFR belongs to the control, and may change offsets or limits",
        ),
        (
            "PROC A(REAL B[3])",
            "1 unsupported-word: an array as the parameter of a subprogram is not supported",
        ),
        (
            "PROC A BLSYNC",
            "1 unsupported-word: PROC with BLSYNC, which gwatt does not follow",
        ),
        ("X1=10", "1 no-such-axis: the machine has no axis X1"),
        ("G0 B10", "1 no-such-axis: the machine has no B axis"),
        (
            "G0 X=R7",
            "1 unknown-value: R7 has no value yet: what it holds, only the control knows",
        ),
        (
            "G0 X=WIDTH",
            "1 unknown-value: WIDTH is not defined in this program",
        ),
        (
            "G0 X=$A_IN[1]",
            "1 unknown-value: $A_IN is the control's, and gwatt does not know its value",
        ),
        (
            "G0 X=R99999",
            "1 no-such-parameter: there is no R parameter 99999",
        ),
        (
            "WIDTH=0.5",
            "1 assignment: WIDTH is not defined in this program, so that its type is not known",
        ),
        (
            "R1=\"A\"",
            "1 assignment: R1 cannot take this value: a text is no number",
        ),
        (
            "DEF REAL A=\"B\"",
            "1 assignment: A cannot take this value: a text is no number",
        ),
        (
            "DEF REAL A[400,400]",
            "1 assignment: A cannot take this value: it has more than 100000 elements",
        ),
        (
            "DEF REAL A[2]=SET(1,2,3)",
            "1 assignment: A cannot take this value: there are more values than elements",
        ),
        (
            "DEF REAL A[2]=REP()",
            "1 assignment: A cannot take this value: REP takes a value and a number of elements",
        ),
        (
            "DEF FRAME A",
            "1 definition: DEF with FRAME, which is no type that gwatt knows",
        ),
        (
            "DEF REAL",
            "1 definition: DEF without the name of a variable",
        ),
        (
            "DEF REAL A[2]\nG0 X=A[2]",
            "2 array-index: an index of A is outside its array",
        ),
        (
            "DEF REAL A[2]\nG0 X=A[0.5]",
            "2 array-index: 0.5 is no index",
        ),
        ("G0 X=1/0", "1 arithmetic: a division by zero"),
        (
            "G0 X=EXP(1000)",
            "1 arithmetic: a result beyond all numbers",
        ),
        ("G0 X=SQRT(-1)", "1 arithmetic: SQRT of a negative number"),
        (
            "G0 X=ASIN(2)",
            "1 arithmetic: ASIN of a number beyond -1 and 1",
        ),
        (
            "G0 X=ACOS(2)",
            "1 arithmetic: ACOS of a number beyond -1 and 1",
        ),
        (
            "G0 X=LN(0)",
            "1 arithmetic: LN of a number that is not positive",
        ),
        (
            "G0 X=1EX300 B_AND 1",
            "1 arithmetic: a logical operation on a number of more than 32 bits",
        ),
        (
            "G0 X=FOO(1)",
            "1 expression: FOO is no function that gwatt knows",
        ),
        ("G0 X=", "1 expression: a value is missing here"),
        ("G0 X=(1", "1 expression: `)` is missing here"),
        (
            "G0 X=\"A\"",
            "1 expression: a text stands where a number is needed",
        ),
        (
            "G0 X=1+\"A\"",
            "1 expression: an operator between a text and a number",
        ),
        ("G0 X='Q1'", "1 expression: this is no constant"),
        ("R1=\"A", "1 expression: a text in quotes is not closed"),
        ("X10 (what)", "1 syntax: `(` has no meaning here"),
        ("X10 R5", "1 syntax: an R parameter needs `=` and its value"),
        (
            "X10 N5 L",
            "1 syntax: a block number stands at the beginning of its block",
        ),
        (
            "X10 P5",
            "1 syntax: P repeats a call, and stands behind its name",
        ),
        ("G2 F=AC(3)", "1 syntax: F takes a plain value"),
        ("CR 5", "1 syntax: CR has no value"),
        ("CALL 5", "1 syntax: a text is needed here"),
        ("R1=1 X", "1 missing-number: X has no number"),
        ("OVR=300", "1 override: OVR of 300 %"),
        ("ACC[X]=150", "1 override: ACC of 150 %"),
        ("TRANS Q5", "1 frame: TRANS with Q5"),
        ("SCALE X0", "1 frame: a scale of 0"),
        (
            "DIAMON TRANS X5",
            "1 frame: a shift of X where X words are diameters (DIAMON)",
        ),
        ("FOR R1=1 3", "1 flow: FOR without TO"),
        ("GOTOF", "1 flow: a jump without its destination"),
        ("REPEATB A B", "1 flow: REPEATB with two labels"),
        ("CASE (1) OF 1", "1 flow: CASE is not complete here"),
        (
            "RET RET",
            "1 flow: two words of a block say where the program goes on",
        ),
        (
            "L1 P=-2",
            "1 flow: a repetition of less than 0 or more than 1000000 times",
        ),
        ("CALL \"CYCLE81\"", "1 flow: a cycle that is called by CALL"),
        (
            "A: X1\nREPEAT B A",
            "2 no-such-block: there is no B to repeat",
        ),
        (
            "B: X1\nA: X2\nREPEAT A B",
            "3 flow: a section that ends before it begins, or repeats itself",
        ),
        (
            "GOTOB THERE\nTHERE: X1",
            "1 no-such-block: there is no THERE to jump to in this direction",
        ),
        ("IF 0\nX1", "1 structure: there is no ENDIF for this"),
        (
            "WHILE 0\nX1",
            "1 structure: there is no ENDWHILE or ENDFOR for this",
        ),
        ("X1\nENDLOOP", "2 structure: there is no beginning for this"),
        ("UNTIL 0", "1 structure: there is no REPEAT for this"),
        (
            "A: GOTOB A",
            "1 endless: 10000000 lines in a row have been executed without a move",
        ),
        (
            "G0 G2 X10",
            "1 modal-group-twice: two G words of one modal group in a block",
        ),
        (
            "G2 X10 Y0 I5 CR=5",
            "1 arc-center: an arc with two of centre, CR and AR",
        ),
        (
            "G2 X10 Y0 F100 OVR=50",
            "1 arc-center: an arc without a centre (I J K), CR or AR",
        ),
        (
            "G2 X10 AR=400",
            "1 arc-center: an opening angle (AR) that is not between 0 and 360",
        ),
        (
            "CIP X10 Y0 I1=5 J1=0",
            "1 arc-center: the three points of CIP lie on a line",
        ),
        (
            "CIP X10 Y0 I1=5 J1=5 K1=5",
            "1 arc-in-space: an arc through a point (CIP) that leaves its plane",
        ),
        (
            "G2 X10 CR=5 TURN=0.5",
            "1 arc-turns: TURN of an arc must be a whole number from 0",
        ),
        (
            "SUPA G2 X10 CR=5",
            "1 arc-in-g53: an arc with G53, G153 or SUPA",
        ),
        (
            "ROT X30\nG2 X10 CR=5",
            "2 arc-turned: an arc that is no circle in a plane of the machine, as the coordinates are turned or scaled",
        ),
        (
            "X=DC(5)",
            "1 rotary-target: DC, ACP and ACN go with rotary axes whose position is known",
        ),
        (
            "X1=2\nX=1EX10",
            "1 no-such-axis: the machine has no axis X1",
        ),
        (
            "X=1EX10",
            "1 position-range: the position is beyond any machine",
        ),
        (
            "AP=5 RP=5 X1",
            "1 polar-mixed: polar coordinates with the axes of the plane",
        ),
        (
            "AP=5 RP=-5",
            "1 polar-radius: a polar radius that is negative",
        ),
        (
            "SUPA AP=5 RP=5",
            "1 polar-suppressed: polar coordinates with G53, G153 or SUPA",
        ),
        ("G74", "1 reference-axes: G74 without axes"),
        ("G4", "1 dwell-time: G4 without a time"),
        (
            "G4 S5",
            "1 dwell-time: G4 S, but no spindle speed is in force",
        ),
        (
            "G4 F-1",
            "1 dwell-time: the time of G4 is negative or beyond reason",
        ),
        (
            "G96 S100",
            "1 surface-speed: G96 without a limit of the spindle's speed",
        ),
        (
            "CYCLE81(10,0,1)",
            "1 cycle: a cycle without a depth (DP or DPR)",
        ),
        (
            "CYCLE81(10,0,1,5)",
            "1 cycle: a cycle whose depth lies above its reference plane",
        ),
        (
            "CYCLE81(10,10,1,5)",
            "1 cycle: a cycle whose retraction plane is its reference plane",
        ),
        (
            "CYCLE81()",
            "1 cycle: a cycle without a retraction plane (RTP) and a reference plane (RFP)",
        ),
        (
            "SUPA CYCLE81(10,0,1,-5)",
            "1 cycle: a cycle with G53, G153 or SUPA",
        ),
        (
            "CYCLE83(10,0,1,-5)",
            "1 cycle: CYCLE83 without a first depth, or with a factor (DAM below 0)",
        ),
        (
            "CYCLE83(10,0,1,-500,,,0.01)",
            "1 cycle: CYCLE83 with more than 10000 strokes",
        ),
        (
            "CYCLE84(10,0,1,-5)",
            "1 cycle: a tapping cycle without its pitch (MPIT 3 to 48 or PIT) or speed",
        ),
        (
            "HOLES2(0,0,10,0,0,0)",
            "1 cycle: a pattern of fewer than 1 or more than 10000 holes",
        ),
        (
            "MCALL HOLES1(0,0,0,0,1,2)\nHOLES2(0,0,10,0,0,3)",
            "2 cycle: a pattern of patterns of holes",
        ),
    ];
    for (line, expected) in cases {
        let said = refusal(line);
        if said != expected {
            let _ = writeln!(wrong, "{line}: {said}");
        }
    }
    assert_eq!(wrong, "");
}

/// Whatever a program holds, reading it ends and does not panic.
#[test]
fn garbage_is_refused() {
    let bits = [
        "(", ")", "[", "]", "=", "\"", "'", "$", "_", ":", "%", ";", "N", "X", "R", "1", "-", ".",
        "DEF ", "REAL ", "PROC ", "IF ", "GOTOB ", "FOR ", "CASE ", "MCALL ", "CYCLE83", "TRANS ",
        "G2", "AC(", "EX9", "<<", "é", "REP(", "SET", ",",
    ];
    let mut state = 7_u64;
    for _ in 0..3000 {
        let mut program = String::from("G1 X1 F100\n");
        for _ in 0..12 {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            program.push_str(bits[(state >> 33) as usize % bits.len()]);
        }
        moves(&program);
    }
    moves(&format!("X={}", "(".repeat(100_000)));
    moves(&format!("X={}1", "-".repeat(100_000)));
    moves(&format!("X=1{}", "+1".repeat(50_000)));
}
