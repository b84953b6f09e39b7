//! ISG kernel, `TwinCAT` CNC: what each word means, by hand-worked programs.
//! The sections named are those of Beckhoff's TF5200 programming manual.

mod dynamics;
mod programs;

use std::fmt::Write as _;

use insta::assert_snapshot;

use crate::listing::{listing, machine, refusals, wrong_values};

fn moves(program: &str) -> String {
    listing(program, &machine("isg"), None)
}

fn refused(program: &str) -> String {
    refusals(program, &machine("isg"))
}

/// "Arithmetic expressions <expr>", "Programming of coordinates by parameters",
/// "Indirect parameters".
#[test]
fn expressions_have_the_values_of_the_manual() {
    let cases: [(&str, f64); 30] = [
        ("X[2+3*4]", 14.0),
        ("X=[2+3]*-4", -20.0),
        ("X 2**3", 8.0),
        ("X 45 MOD 12", 9.0),
        ("X SIN[30]*10", 5.0),
        ("X10*COS[60]", 5.0),
        ("X TAN[45]", 1.0),
        ("X COT[45]", 1.0),
        ("X ASIN[0.5]", 30.0),
        ("X ACOS[0.5]", 60.0),
        ("X ATAN[1]", 45.0),
        ("X ACOT[1]", 45.0),
        ("X SQRT[SQR[3]+SQR[4]]", 5.0),
        ("X ABS[-3]", 3.0),
        ("X INT[2.9]+ROUND[2.5]", 5.0),
        ("X 10*FRACT[2.5]", 5.0),
        ("X EXP[LN[7]]", 7.0),
        ("X DEXP[LOG[7]]", 7.0),
        ("X MIN[2,3]+10*MAX[2,3]", 32.0),
        ("X[6&3]+10*[6|3]+100*[6^3]", 572.0),
        ("X 10*[1==1]+[2!=2]", 10.0),
        ("X 1+[2>=2 && 1<0 || 1]", 2.0),
        ("X 1+[NOT 0 AND TRUE]", 2.0),
        ("X 100*[PI>3.14]", 100.0),
        // The examples of "Indirect parameters".
        ("P120=10\nPP120=123.5\nX P10", 123.5),
        ("P1=20 P2=40\nPP1=50\nPP2=PP1\nXP40", 50.0),
        ("P1=4\nP[P1+1]=7\nXP5", 7.0),
        ("P1=2\nP1+=3\nP1*=2\nX-P1", -10.0),
        (
            "#VAR\nV.S.VAR[5] = [5,10,10,15,20]\n#ENDVAR\nXV.S.VAR[4]",
            20.0,
        ),
        (
            "#VAR\nP20[2][3] : REAL64 = [1,2,3,4,5,6]\nV.L.A\n#ENDVAR\nX=P20[1][0]+V.L.A",
            4.0,
        ),
    ];
    assert_eq!(wrong_values(&cases, moves), "");
}

/// "The IF - ELSE branch", "Switch branching", "Counting loop", loops with a
/// condition at their beginning and end, "The $GOTO statement".
#[test]
fn statements_choose_the_blocks() {
    assert_snapshot!(moves("\
G0 P1=0.4 P2=3
$IF P1 (less than 0.5: false)
X1
$ELSEIF P2 == 3
X2
$IF P1 > 7
X3
$ENDIF
$ELSE
X4
$ENDIF
$FOR P3 = 6, 2, -2
Y P3
$IF P3 == 4 $GOTO N100
$ENDFOR
N100: Z1
$WHILE P2 > 0
P2 = P2 - 1
$IF P2 == 1
$CONTINUE
$ENDIF
ZP2
$ENDWHILE
$SWITCH 5.0004
$CASE 4
A4
$BREAK
$CASE 2+3
A5
$BREAK
$DEFAULT
A6
$ENDSWITCH
$DO
P2 = P2 + 1
CP2
$ENDDO P2 < 2
$REPEAT
P2 = P2 + 1
$IF P2 == 4
$BREAK
$ENDIF
$UNTIL P2 > 7
X=P2
$GOTO [LAST]
X99
[LAST] Y0
M30
"), @r"
5 rapid X2
13 rapid Y6
13 rapid Y4
16 rapid Z1
22 rapid Z2
22 rapid Z0
29 rapid A5
36 rapid C1
36 rapid C2
44 rapid X4
47 rapid Y0
");
}

/// "Local subroutines (Call LL)", "Global sub-routines (Call L)", "Local, valid
/// throughout subroutine (V.L.)", "Global, valid to program end (V.P.)".
#[test]
fn subprograms_are_called_and_keep_their_variables() {
    let folder = tempfile::tempdir().expect("a folder");
    let global = "%L INNER\nG0 Z[P1+V.P.A]\nM17\n%MAIN\nLL INNER\nV.P.A=V.P.A+1\nM29\n";
    std::fs::write(folder.path().join("gup_1.nc"), global).expect("written");
    let program = "\
%L UP1 (first)
#VAR
V.L.DEEP = 3
#ENDVAR
X=V.L.DEEP
LL UP2
X=V.L.DEEP
M17
%L UP2
V.L.DEEP = V.L.DEEP + 1
Y=V.L.DEEP
%PART
#VAR
V.P.A = 10 V.L.DEEP = 1
#ENDVAR
G0 P1=0.5
LL UP1
Z=V.L.DEEP
L gup_1.nc
L D:\\prog\\gup_1.nc
M30
";
    let found = listing(program, &machine("isg"), Some(folder.path()));
    assert_snapshot!(found, @r"
5 rapid X3
11 rapid Y4
7 rapid X4
18 rapid Z1
2 rapid Z10.5
2 rapid Z11.5
");
}

/// "Cycles as global or local subroutines (Call L | LL CYCLE)": @P belong to the
/// cycle, @X, @Y and @Z are the first, second and third axis of the plane.
#[test]
fn cycles_get_parameters_of_their_own() {
    let folder = tempfile::tempdir().expect("a folder");
    let drill = "\
(a hole at @P4, @P5 to the depth @P1, by steps of @P2)
#VAR
V.L.DEPTH = 0
#ENDVAR
G0 @X@P4 @Y=@P5 @Z@P3
$WHILE V.L.DEPTH < @P1
V.L.DEPTH = MIN[V.L.DEPTH+@P2, @P1]
G1 @Z[-V.L.DEPTH] F100
@P3 = @P3 + 1
G0 @Z@P3
$ENDWHILE
LL OTHER
G2 @X[@P4+2] @I1 @J0
M29
%L OTHER
G0 A1
M29
";
    std::fs::write(folder.path().join("drill.cyc"), drill).expect("written");
    let program = "\
%L LOCAL
G0 @X@P1
M17
%MAIN
P1=4
L CYCLE [NAME=drill.cyc @P1=P1+1 @P2=3 @P3=10 @P4=7 @P5=8]
G18
L CYCLE [NAME=drill.cyc, @P1=1, @P2=3, @P3=20, @P4=17, @P5=18]
LL CYCLE [NAME=LOCAL @P1=30]
M30
";
    let found = listing(program, &machine("isg"), Some(folder.path()));
    assert_snapshot!(found, @r"
5 rapid X7 Y8 Z10
8 feed Z-3 F100
10 rapid Z11
8 feed Z-5 F100
10 rapid Z12
16 rapid A1
13 arc X9 Y8 center 8,8 turns -0.5 F100
5 rapid X18 Y20 Z17
8 feed Y-1 F100
10 rapid Y21
16 rapid
13 arc X18 Z19 center 18,18 turns -0.5 F100
2 rapid Z30
");
}

/// A cycle does not see the parameters of another one, nor those of its caller.
#[test]
fn parameters_of_cycles_are_not_seen_elsewhere() {
    assert_snapshot!(refused("\
%L INNER
G0 X@P1
M17
%L OUTER
LL INNER
M17
%MAIN
LL CYCLE [NAME=OUTER @P1=30]
M30
"), @"2 unknown-value: @P1 is given by no call of a cycle: what it holds, only the machine knows");
}

/// "Cycles as global or local subroutines (Call L | LL CYCLE)": what is not followed.
#[test]
fn cycles_that_are_refused() {
    let cases = [
        "L CYCLE.CYC [@P1=5]",
        "L CYCLE [NAME=SysDrillDeepHole.ecy @P1=5]",
        "L CYCLE [NAME=a.cyc MODAL_MOVE @P1=5]",
        "L CYCLE [NAME=a.cyc @P201=5]",
        "L CYCLE [@P1=5]",
        "L CYCLE [NAME=a.cyc Q=5]",
        "G0 L CYCLE [NAME=a.cyc]",
        "X@P1",
        "@P1=3",
        "@X5",
    ];
    let mut said = String::new();
    for case in cases {
        let _ = writeln!(said, "{case}: {}", refused(&format!("{case}\n")));
    }
    assert_snapshot!(said, @r"
L CYCLE.CYC [@P1=5]: 1 subprogram: parameters after the name of a subprogram
L CYCLE [NAME=SysDrillDeepHole.ecy @P1=5]: 1 unsupported-word: SysDrillDeepHole.ecy is a cycle of the control's maker, which gwatt does not follow
L CYCLE [NAME=a.cyc MODAL_MOVE @P1=5]: 1 unsupported-word: MODAL is a cycle after each block that moves, which gwatt does not follow
L CYCLE [NAME=a.cyc @P201=5]: 1 no-such-parameter: the parameters of a cycle are @P1 to @P200
L CYCLE [@P1=5]: 1 subprogram: a cycle without its name
L CYCLE [NAME=a.cyc Q=5]: 1 subprogram: after CYCLE stand NAME= and the parameters @P1= and so on
G0 L CYCLE [NAME=a.cyc]: 1 subprogram: a cycle after other words
X@P1: 1 unknown-value: @P1 is given by no call of a cycle: what it holds, only the machine knows
@P1=3: 1 unsupported-word: @P1 belongs to the control or the PLC, and may change offsets
@X5: 1 syntax: @ stands before P, X, Y, Z, I, J, K and S in cycles
");
}

/// "Dwell time (G04), (#TIME)", "Reference point offset (G92)", "Zero offsets
/// (G53/G54/...G59)", "Specifying centre point (G161/G162)", "Rotate the
/// coordinate system in the plane (#ROTATION ON/OFF)", "Comments".
#[test]
fn words_of_the_kernel() {
    assert_snapshot!(moves("\
%MAIN
G04 X4.13
P1=2
G04 P1
#TIME 2.5
G04 3.0
G0 X10 Y0
G92 X5
X10
G91 G92 X1
G90 X10 F600
G53 X0
#COMMENT BEGIN
X500
#COMMENT END
G92 X0
G1 X10 Y0
G161 G2 X20 I15 J0
G162 G3 X10 I-5 J0
#ROTATION ON [ANGLE=90 CENTER1=10 CENTER2=0]
G1 X20
#ROTATION OFF
X10 Y0
#MSG [\"what \\%d\", 5]
#SLOPE [TYPE=STEP]
#CONTOUR MODE [DEV PATH_DEV=0.1]
G60 G08 X0 (end
M30
"), @r"
2 dwell 4.13 s
4 dwell 2 s
5 dwell 2.5 s
6 dwell 3 s
7 rapid X10
9 rapid X15
11 rapid X16
12 rapid X6
17 feed X10 F600
18 arc X20 Y0 center 15,0 turns -0.5 F600
19 arc X10 Y0 center 15,0 turns 0.5 F600
21 feed Y10 F600
23 feed Y0 F600
27 feed X0 F600
");
}

/// "Defining a machining coordinate system (#CS DEF, #CS ON/OFF)": turned by 90°
/// about Z and set off to X10, X points to +Y; in it another, 5 along that X;
/// about X by 90° the new Y is up; `P-CHAN-00394`: ZYX.
#[test]
fn coordinate_systems_stand_in_one_another() {
    assert_snapshot!(moves("\
G0 X0 Y0 Z0
#CS DEF [1] [10,0,0,0,0,90]
#CS ON [1]
X1 Y0 Z0
#CS ON [5,,,]
X1 Y0 Z0
#CS OFF
X2 Y0 Z0
#CS OFF ALL
X0 Y0 Z0
#CS ON [0,0,0,90]
X0 Y3 Z0
#CS OFF
#CS ON [0,0,0,90,0,90]
X0 Y0 Z2
"), @r"
1 rapid
4 rapid X10 Y1
6 rapid Y6
8 rapid Y2
10 rapid X0 Y0
12 rapid Z3
15 rapid X2 Z0
");
}

/// A jump after other words is the last action of its block ("The $GOTO
/// statement"); lines of a comment or a declaration do not move.
#[test]
fn plain_moves_beside_what_is_more() {
    let program =
        "G1 F100 X1\nX2 $GOTO N9\nX3\nN9: X4\n#COMMENT BEGIN\nX5\n#COMMENT END\nX6\n%L A\nX7\n";
    assert_snapshot!(moves(program), @r"
1 feed X1 F100
2 feed X2 F100
4 feed X4 F100
8 feed X6 F100
");
}

/// What depends on what the control alone knows, or moves in another way.
#[test]
fn what_is_not_followed_is_named() {
    let cases = [
        "X=V.E.POS",
        "XP7",
        "V.G.NP[1].V.X=10",
        "#CS ON [2]",
        "#CS DEF",
        "#CS MODE ON [ROTATION_SEQUENCE=XYZ]",
        "#CS ON [1,2,3,4,5,6,7]",
        "#TRAFO ON",
        "#CYL [EDGES=0]",
        "#HSC ON [OPMODE=2]",
        "#OVERRIDE [FEED_FACT=150]",
        "#MACHINE DATA [AX=X P-AXIS-00008=1]",
        "#SOMETHING [1]",
        "X[OVERRIDE FEED_FACT=20]",
        "X1=10",
        "G80",
        "$IF P1",
        "$JUMP",
        "$BREAK",
        "LL NOWHERE",
        "L nowhere.nc",
        "$GOTO N77",
        "P1=1 XP1",
        "X[1/0]",
        "X\"MACRO\"",
        "G133=0",
        "G132 X200 G1",
        "#set paramPathDynamics( 700; 700; 3000 )#",
        "DynOvr=0.4",
        "#KIN ID [9]",
        "#TRAFO [KIN_ID=9]",
        "#TOOL ORI CS",
        "#ACS ON [0,0,1]",
        "#CS ADD [A] [0,0,1]",
        "$FOR P1=0,1,0",
        "#ROTATION ON [ANGLE=30]\nG18",
    ];
    let mut said = String::new();
    for case in cases {
        let _ = writeln!(said, "{case}: {}", refused(&format!("{case}\n")));
    }
    assert_snapshot!(said, @r##"
X=V.E.POS: 1 unknown-value: V.E.POS comes from the PLC: what it holds, only the machine knows
XP7: 1 unknown-value: P7 has no value in this program: what it holds, only the machine knows
V.G.NP[1].V.X=10: 1 unsupported-word: V.G.NP[1] belongs to the control or the PLC, and may change offsets
#CS ON [2]: 1 coordinate-system: a coordinate system that is not stored
#CS DEF: 1 coordinate-system: #CS DEF without shifts and angles
#CS MODE ON [ROTATION_SEQUENCE=XYZ]: 1 unsupported-word: #CS MODE ON is a coordinate system of another mode, which gwatt does not follow
#CS ON [1,2,3,4,5,6,7]: 1 coordinate-system: more than three shifts and three angles
#TRAFO ON: 1 unsupported-word: #TRAFO ON is a kinematic transformation, which gwatt does not follow
#CYL [EDGES=0]: 1 unsupported-word: #CYL is machining on a cylinder, which gwatt does not follow
#HSC ON [OPMODE=2]: 1 unsupported-word: #HSC ON [OPMODE=2] is a spline, which gwatt does not follow
#OVERRIDE [FEED_FACT=150]: 1 unsupported-word: #OVERRIDE with more than 100 percent
#MACHINE DATA [AX=X P-AXIS-00008=1]: 1 unsupported-word: #MACHINE DATA is new data of the machine's axes, which gwatt does not follow
#SOMETHING [1]: 1 unsupported-word: #SOMETHING is a command of this control, which gwatt does not follow
X[OVERRIDE FEED_FACT=20]: 1 unsupported-word: X[OVERRIDE …] is a command to one axis or spindle, which gwatt does not follow
X1=10: 1 unsupported-word: X1 is an axis or spindle by a name, which gwatt does not follow
G80: 1 unknown-code: G80 is not known to this controller profile
$IF P1: 1 unknown-value: P1 has no value in this program: what it holds, only the machine knows
$JUMP: 1 flow: $JUMP is no statement of this language
$BREAK: 1 structure: there is no loop around this
LL NOWHERE: 1 no-such-subprogram: there is no local subprogram NOWHERE in this file
L nowhere.nc: 1 no-such-subprogram: there is no subprogram nowhere.nc
$GOTO N77: 1 no-such-block: there is no N77 to jump to in this program
P1=1 XP1: 1 assignment: the block assigns P1 and uses it
X[1/0]: 1 arithmetic: a division by zero
X"MACRO": 1 expression: a value is missing here
G133=0: 1 knob-value: a ramp time is a percentage above 0, in a block of its own
G132 X200 G1: 1 knob-value: a ramp time is a percentage above 0, in a block of its own
#set paramPathDynamics( 700; 700; 3000 )#: 1 unsupported-word: #SET PARAMPATHDYNAMICS is a command of this control, which gwatt does not follow
DynOvr=0.4: 1 unsupported-word: DynOvr is a word of TwinCAT NC I, another interpreter, which gwatt does not follow
#KIN ID [9]: 1 unsupported-word: #KIN ID is a kinematic transformation, which gwatt does not follow
#TRAFO [KIN_ID=9]: 1 unsupported-word: #TRAFO is a kinematic transformation, which gwatt does not follow
#TOOL ORI CS: 1 unsupported-word: #TOOL ORI CS is a command of this control, which gwatt does not follow
#ACS ON [0,0,1]: 1 unsupported-word: #ACS ON is another coordinate system, which gwatt does not follow
#CS ADD [A] [0,0,1]: 1 unsupported-word: #CS ADD is a coordinate system of another mode, which gwatt does not follow
$FOR P1=0,1,0: 1 endless: $FOR with the step 0 never ends
#ROTATION ON [ANGLE=30]
G18: 2 turned-system: another coordinate system while the program is turned or scaled
"##);
}
