//! What is refused of the language of SINUMERIK, and by which name.

use std::fmt::Write as _;

use super::{moves, refusal};

/// What is not followed is refused by its name.
#[test]
fn refusals_name_the_construct() {
    let mut wrong = String::new();
    let cases = [
        (
            "CT X10 Y10",
            "1 unsupported-word: CT is an arc tangential to the move before, which gwatt does not follow",
        ),
        (
            "PRESETON(X,100)",
            "1 unsupported-word: PRESETON is another value of a place where the axis stands, which gwatt does not follow",
        ),
        (
            "CONTPRON(TAB,\"L\")",
            "1 unsupported-word: CONTPRON is a table of a contour, whose blocks are stored and not run, which gwatt does not follow",
        ),
        (
            "PTP",
            "1 unsupported-word: PTP is travel that is not along the path, which gwatt does not follow",
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
            "1 syntax: P repeats a call, and stands after its name",
        ),
        ("G2 F=AC(3)", "1 syntax: F takes a plain value"),
        ("CR 5", "1 syntax: CR has no value"),
        ("CALL 5", "1 syntax: a text is needed here"),
        ("R1=1 X", "1 missing-number: X has no number"),
        ("OVR=300", "1 override: OVR of 300 %"),
        ("TRANS Q5", "1 frame: TRANS with Q5"),
        ("SCALE X0", "1 frame: a scale of 0"),
        (
            "DIAMON TRANS X5",
            "1 frame: a shift of X where X words are diameters (DIAMON, DIAM90)",
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
            "1 endless: 10000 lines in a row have been executed without a move",
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
            "SCALE X2\nG2 X10 CR=5",
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
            "CYCLE81(10,10,1,,5)",
            "1 cycle: a cycle whose retraction plane is its reference plane, without a depth DP",
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
            "CYCLE84(10,0,1,-5,,,3,,1,,500,500,1)",
            "1 cycle: argument 13 of the cycle (_AXN) has a value that is not followed",
        ),
        (
            "CYCLE84(10,0,1,-5,,,3,,1,,500,500,,4)",
            "1 cycle: argument 14 of the cycle (_PITA) has a value that is not followed",
        ),
        (
            "CYCLE84(10,0,1,-5,,,3,,1,,500,500,,,20)",
            "1 cycle: argument 15 of the cycle (_TECHNO) has a value that is not followed",
        ),
        (
            "CYCLE84(10,0,1,-5,,,3,,1,,500,500,,,,2,5,1)",
            "1 cycle: argument 16 of the cycle (_VARI) has a value that is not followed",
        ),
        (
            "CYCLE84(10,0,1,-5,,,3,,1,,500,500,,,,,,,,,,,,1)",
            "1 cycle: argument 24 of the cycle (_AMODE) has a value that is not followed",
        ),
        (
            "CYCLE840(10,0,1,-5,,,4,3,1,,1)",
            "1 cycle: argument 9 of the cycle (ENC) has a value that is not followed",
        ),
        (
            "CYCLE840(10,0,1,-5,,,4,3,0,,1,2)",
            "1 cycle: argument 12 of the cycle (_AXN) has a value that is not followed",
        ),
        (
            "CYCLE86(10,0,1,-5,,,3,1,1,1,0,12)",
            "1 cycle: argument 12 of the cycle (_GMODE) has a value that is not followed",
        ),
        (
            "CYCLE85(10,0,1,-5,,,1,1,,3)",
            "1 cycle: argument 10 of the cycle (_DMODE) has a value that is not followed",
        ),
        (
            "CYCLE82(10,0,1,,5,,,,2)",
            "1 cycle: argument 9 of the cycle (_AMODE) has a value that is not followed",
        ),
        (
            "CYCLE83(10,0,1,-5,,-3,,,,,,,,,,1)",
            "1 cycle: argument 16 of the cycle (_DTD) has a value that is not followed",
        ),
        (
            "HOLES1(0,0,0,0,1,2,1)",
            "1 cycle: argument 7 of the cycle (_VARI) has a value that is not followed",
        ),
        (
            "HOLES1(0,0,0,0,1,2,,1)",
            "1 cycle: argument 8 of the cycle (_UMODE) has a value that is not followed",
        ),
        (
            "HOLES2(0,0,20,0,30,4,1000)",
            "1 cycle: argument 7 of the cycle (_VARI) has a value that is not followed",
        ),
        (
            "HOLES2(0,0,20,0,30,4,,,1)",
            "1 cycle: argument 9 of the cycle (_HIDE) has a value that is not followed",
        ),
        (
            "HOLES2(0,0,20,0,30,4,,,,1)",
            "1 cycle: argument 10 of the cycle (_NSP) has a value that is not followed",
        ),
        (
            "HOLES2(0,0,20,0,30,4,,,,,,1)",
            "1 cycle: argument 12 of the cycle has a value that is not followed",
        ),
        (
            "SVC=3",
            "1 unsupported-word: SVC is a cutting speed that sets the speed of the spindle, which gwatt does not follow",
        ),
        (
            "FAD=3",
            "1 unsupported-word: FAD is a feed of a smooth approach, which gwatt does not follow",
        ),
        (
            "DISCL=3",
            "1 unsupported-word: DISCL is a distance of a smooth approach, which gwatt does not follow",
        ),
        (
            "DISR=3",
            "1 unsupported-word: DISR is a distance of a smooth approach, which gwatt does not follow",
        ),
        (
            "ISD=3",
            "1 unsupported-word: ISD is an insertion depth of a tool, which gwatt does not follow",
        ),
        (
            "SR=3",
            "1 unsupported-word: SR is a retraction of another feed, which gwatt does not follow",
        ),
        (
            "ALF=3",
            "1 unsupported-word: ALF is a direction of a fast retraction, which gwatt does not follow",
        ),
        (
            "SD=3",
            "1 unsupported-word: SD is the degree of a spline, which gwatt does not follow",
        ),
        (
            "PW=3",
            "1 unsupported-word: PW is the weight of a point of a spline, which gwatt does not follow",
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

/// Words of the control move nothing or are refused, whatever file there is; as labels they are
/// what the program says.
#[test]
fn words_of_the_control_are_no_subprograms() {
    let program = "G0 X1\nDRFOF\nMMC(\"CYCLES,PICTURE_ON,A.COM\",\"A\")\nTRAILOF(Y,X)\nGOTOF START\nX5\nSTART:\nX2\nM30\n";
    assert_eq!(moves(program), "1 rapid X1\n8 rapid X2\n");
    for word in [
        "PRESETON(X,100)",
        "WRITE(ERR,\"A\",\"B\")",
        "CTABDEF(X,Y,1,0)",
        "GET(X)",
    ] {
        let found = refusal(word);
        let name = word.split('(').next().unwrap();
        assert!(
            found.starts_with(&format!("1 unsupported-word: {name} is ")),
            "{found}"
        );
    }
}
