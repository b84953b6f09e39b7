//! Okuma OSP: what each word means, by hand-worked programs. The sections named
//! are those of the OSP programming manuals.

use std::fmt::Write as _;

use insta::assert_snapshot;
use proptest::prelude::*;

use crate::listing::{listing, machine, refusals, without_lines, wrong_values};

fn moves(program: &str) -> String {
    listing(program, &machine("okuma"), None)
}

fn refused(program: &str) -> String {
    refusals(program, &machine("okuma"))
}

/// "User Task": arithmetic operations, common and local variables.
#[test]
fn expressions_have_the_values_of_the_manual() {
    let cases: [(&str, f64); 16] = [
        ("X=2+3*4", 14.0),
        ("X=[2+3]*-4", -20.0),
        ("X=SIN[30]*10", 5.0),
        ("X=ATAN2[1,1]", 45.0),
        ("X=SQRT[16]+ABS[-3]", 7.0),
        ("X=FIX[2.9]+10*FUP[2.1]+100*ROUND[2.5]", 332.0),
        ("X=MOD[7,4]", 3.0),
        ("X=[6 AND 3]+10*[6 OR 3]+100*[6 EOR 3]", 572.0),
        ("X=1+[2 GE 2]+[1 LT 0]", 2.0),
        ("V1=5 VC2=6\nX=V1*VC2", 30.0),
        ("V1=3\nV[V1+1]=7\nX=V4", 7.0),
        ("DEPT=5\nX=-DEPT+1", -4.0),
        ("V1=5\nV1=V1+1\nX=V1", 6.0),
        ("NOEX V7=8\nX=V7", 8.0),
        ("N10 LEN1=4 LEN2=5\nX=LEN1*LEN2", 20.0),
        ("/V1=2\nX=V1", 2.0),
    ];
    assert_eq!(wrong_values(&cases, moves), "");
}

/// "Branch Function (GOTO, IF)", "Subprogram Functions (CALL, RTS, MODIN,
/// MODOUT)", "Program Name and Sequence Name".
#[test]
fn branches_and_calls_choose_the_blocks() {
    assert_snapshot!(moves("\
$PART.MIN%
OMAIN
G15 H1
G0 X0 V1=0
NLOOP V1=V1+1
X=V1
IF [V1 LT 3] NLOOP
GOTO N0030
X99
N30 CALL OHOLE DEPT=4 LEN2=1
CALL OZ Q2
MODIN O0200
Y5
Y6
MODOUT
Y7
M02
OHOLE
Z=-DEPT
DEPT=DEPT+LEN2
IF [V1 EQ 3] GOTO NEND
Z99
NEND RTS
OZ
G91 Z-1
G90
RTS
O0200
Z1
Z0
RTS
"), @r"
4 rapid
6 rapid X1
6 rapid X2
6 rapid X3
19 rapid Z-4
25 rapid Z-5
25 rapid Z-6
13 rapid Y5
29 rapid Z1
30 rapid Z0
14 rapid Y6
29 rapid Z1
30 rapid Z0
16 rapid Y7
");
}

/// "Fixed Cycle Functions": G71, M53, M54, NCYL, P in seconds; "Selection of work
/// coordinate system (G15, G16)", "Tool length offset (G53, G56)".
#[test]
fn cycles_return_where_m53_and_m54_say() {
    assert_snapshot!(moves("\
G15 H=1
G0 X0 Y0 S1000 M3
G56 Z50 H2
G71 Z20
NCYL G81 Z-5 R2 F100 M53
X10
X20 Z=-5-1 M54
G82 X30 Z-5 R2 P1.5 F100 M53
G83 X40 Z-5 R2 Q4 F100
G80
G0 Z100
G16 H0 Z200
M02
"), @r"
2 rapid
3 rapid Z50
6 rapid X10
6 rapid Z2
6 feed Z-5 F100
6 rapid Z20
7 rapid X20
7 rapid Z2
7 feed Z-6 F100
7 rapid Z2
8 rapid X30
8 feed Z-5 F100
8 dwell 1.5 s
8 rapid Z20
9 rapid X40
9 rapid Z2
9 feed Z-2 F100
9 rapid Z2
9 rapid Z-1
9 feed Z-5 F100
9 rapid Z20
11 rapid Z100
12 rapid Z200
");
}

/// What depends on what the control alone knows, or moves in another way.
#[test]
fn what_is_not_followed_is_named() {
    let cases = [
        "X=XPOS",
        "X=VZOFX[1]",
        "VZOFX[1]=5",
        "G0 X0 Y0 Z9\nG81 X1 Z-5 R2 F100",
        "G0 X0 Y0 Z9\nG81 X1 Z-5 R2 F100 M52",
        "G0 X0 Y0 Z9\nG81 X1 Z-5 R2 F100 M53",
        "NCYL G0 X1",
        "BHC X=1 Y=2 I35 J45 K4",
        "PMIL X1",
        "G85 N0207 D7 F0.4 U0.4 W0.1",
        "G30",
        "G54 H1",
        "G62",
        "G16 H2",
        "G11",
        "CALL ONONE",
        "CALL OA Q2 DEPT=1",
        "GOTO NNONE",
        "IF V1 EQ 2 N10",
        "NOEX G0 X1",
        "G0 X[1]",
        "FOO X1",
        "OA\nCALL OB\nM02\nOB\nG0 X1\nOC\nRTS",
    ];
    let mut said = String::new();
    for case in cases {
        let _ = writeln!(said, "{case}: {}", refused(&format!("{case}\n")));
    }
    assert_snapshot!(said, @r"
X=XPOS: 1 unknown-value: XPOS has no value in this program: what it holds, only the control knows
X=VZOFX[1]: 1 unknown-value: VZOFX[1] has no value in this program: what it holds, only the control knows
VZOFX[1]=5: 1 unsupported-word: VZOFX[1] belongs to the control, and may change offsets
G0 X0 Y0 Z9
G81 X1 Z-5 R2 F100: 2 return-level: where the cycle returns to is not said: M52, M53 and M54 are missing
G0 X0 Y0 Z9
G81 X1 Z-5 R2 F100 M52: 2 return-level: M52 returns to the upper limit of the axis, which only the machine knows
G0 X0 Y0 Z9
G81 X1 Z-5 R2 F100 M53: 2 return-level: M53, but no G71 has set the level that it returns to
NCYL G0 X1: 1 unsupported-word: NCYL without a canned cycle
BHC X=1 Y=2 I35 J45 K4: 1 unsupported-word: BHC is a pattern of holes, which gwatt does not follow
PMIL X1: 1 unsupported-word: PMIL is area machining, which gwatt does not follow
G85 N0207 D7 F0.4 U0.4 W0.1: 1 unsupported-word: G85 N… is automatic turning (LAP), which gwatt does not follow
G30: 1 unsupported-code: G30 is a move to a home position that only the control knows, which gwatt does not support
G54 H1: 1 unsupported-code: G54 is a tool length in another axis than Z, which gwatt does not support
G62: 1 unsupported-code: G62 is mirroring, which gwatt does not support
G16 H2: 1 work-offset: a work coordinate system for one block is not supported
G11: 1 unsupported-code: G11 is a shift and turn of the coordinates, which gwatt does not support
CALL ONONE: 1 no-such-subprogram: there is no subprogram ONONE
CALL OA Q2 DEPT=1: 1 subprogram: a call with repetitions and variables
GOTO NNONE: 1 no-such-block: there is no NNONE to jump to in this program
IF V1 EQ 2 N10: 1 flow: IF without its condition in [ ]
NOEX G0 X1: 1 unsupported-word: NOEX with words: whether they move, the control's mode says
G0 X[1]: 1 syntax: a value that is worked out needs `=` before it
FOO X1: 1 unknown-word: FOO is no word of this language
OA
CALL OB
M02
OB
G0 X1
OC
RTS: 6 subprogram: the subprogram ends without RTS
");
}

/// Lathes: diameters, F per revolution, G50 S, G96 and G97; LAP by name.
#[test]
fn lathes_turn_in_diameters() {
    let lathe = machine("okuma-lathe");
    let program = "\
$A.MIN%
O0137
VGRIN[1]=1 VGRA2[1]=3
DEF WORK
PT LF,LC,[0,0],[80,80],[602,0]
END
CLEAR
DRAW
N0002 G50 S3000
NAT00
G00 X100 Z5
N0203 G97 S1000 M42 M03 M08
N0204 X80 TG=01 OG=1
G01 Z-10 F0.2 G42
G94 X100 F100
M02
";
    assert_snapshot!(listing(program, &lathe, None), @r"
11 rapid X50 Z5
13 rapid X40
14 feed Z-10 F200
15 feed X50 F100
");
    assert_snapshot!(refusals("G85 N0207 D7 F0.4\nG71\nG33\nG75\nG76\n", &lathe), @r"
1 unsupported-word: G85 N… is automatic turning (LAP), which gwatt does not follow
2 unsupported-code: G71 is a turning or threading cycle, which gwatt does not support
3 unsupported-code: G33 is thread cutting, which gwatt does not support
4 unsupported-code: G75 is a chamfer or a rounded corner, which gwatt does not support
5 unsupported-code: G76 is a chamfer or a rounded corner, which gwatt does not support
");
}

/// The plane of a lathe is ZX, L is an arc's radius (OSP-P200L 5238-E, "Circular Interpolation"),
/// and another tool offset, which is not known, moves all.
#[test]
fn lathes_have_arcs_in_their_plane() {
    let lathe = machine("okuma-lathe");
    let program = "G0 X60 Z2\nG1 X40 Z-10 F0.2 S500 M3\nG3 X50 Z-15 L5\nG2 X60 Z-20 I5\nM2\n";
    assert_snapshot!(listing(program, &lathe, None), @r"
1 rapid X30 Z2
2 feed X20 Z-10 F100
3 arc X25 Z-15 center -15,20 turns 0.25 F100
4 arc X30 Z-20 center -15,30 turns -0.25 F100
");
    let peak_w = |tool: &str| {
        let program = format!("T0101\nG0 X50 Z5\n{tool}\nG0 X50 Z6\nM2\n");
        gwatt::check(program.as_str(), &lathe).unwrap().peak_w
    };
    let [same, other, none] = ["T0101", "T0202", "T0200"].map(peak_w);
    assert!(other > same && none == other, "{other} {same} {none}");
}

/// Rows of holes, once with variables and a subprogram, once as moves.
#[test]
fn parametrised_and_expanded_twins_move_alike() {
    let parametrised = "\
O1000
V1=0 PITC=12.5
G0 G90 X0 Y0 Z5
NROW V2=0
NHOL CALL OHOL XPOS=V2*PITC YPOS=V1*PITC DEPT=1+V1
V2=V2+1
IF [V2 LE 2] NHOL
V1=V1+1
IF [V1 LT 2] GOTO NROW
G0 X=-[V1+V2] Y0
M02
OHOL
G0 X=XPOS Y=YPOS
G1 Z=-DEPT F=60*5
G0 Z5
RTS
";
    let mut expanded = String::from("G0 X0 Y0 Z5\n");
    for (y, deep) in [(0.0, 1.0), (12.5, 2.0)] {
        for x in [0.0, 12.5, 25.0] {
            let _ = write!(expanded, "G0 X{x} Y{y}\nG1 Z-{deep} F300\nG0 Z5\n");
        }
    }
    expanded.push_str("G0 X-5 Y0\nM02\n");
    let [parametrised, expanded] = [parametrised, &expanded].map(moves);
    assert_eq!(without_lines(&parametrised), without_lines(&expanded));
}

/// Pieces that programs are made of, right and wrong.
const PIECES: [&str; 32] = [
    "\n",
    "\n",
    "\n",
    " ",
    "X1",
    "G1 Y=V1",
    "V1=1",
    "V1=V1+1",
    "LEN=V1*2",
    "IF [V1 GT 1] N5",
    "IF [V1 LT 3] GOTO NEND",
    "GOTO N5",
    "N5 ",
    "NEND ",
    "CALL OSUB",
    "CALL OSUB Q2",
    "CALL OSUB DEPT=3",
    "OSUB",
    "OTWO",
    "RTS",
    "MODIN OSUB",
    "MODOUT",
    "NOEX V2=1",
    "DEF WORK",
    "END",
    "$A.MIN%",
    "G81 Z-1 R1",
    "NCYL G82 Z-1 R1 P1",
    "M54",
    "G71 Z5",
    "G15 H1",
    "[",
];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    /// Any program ends, in moves or in a message.
    #[test]
    fn any_program_ends(pieces in prop::collection::vec(prop::sample::select(&PIECES[..]), 0..40)) {
        let _ = moves(&pieces.concat());
    }

    /// Any text has a value or a message.
    #[test]
    fn any_text_is_read(text in "[0-9.VNO\\[\\]=+*/ XGMLCa-z(),$'-]{0,40}") {
        let _ = moves(&format!("{text}\nV1={text}\nX={text}\nIF [{text}] N1\nCALL O{text}\n"));
    }
}
