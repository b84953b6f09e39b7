//! Drilling cycles and patterns of holes ("Cycles").

use insta::assert_snapshot;

use super::moves;
/// Both planes may be one where the depth is absolute (alarm 61101 is of a relative one).
#[test]
fn a_retraction_plane_may_be_the_reference_plane() {
    assert_snapshot!(moves("G0 X5 Z5 F200\nCYCLE82(3,3,,-1,,1)\n"), @r"
    1 rapid X5 Z5
    2 rapid Z3
    2 feed Z-1 F200
    2 dwell 1 s
    2 rapid Z3
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

/// "Programming cycles externally": _PITA 1 is mm, 2 threads per inch, 3 inch; 0 the unit of the
/// program. Texts of screens, and values that are as without, change nothing.
#[test]
fn the_unit_of_a_pitch() {
    let program = "\
G0 X5 Z50 S1000 M3
CYCLE84(20,10,2,5,,,3,,0.25,,1000,1000,0,1)
CYCLE84(20,10,2,5,,,3,,20,,1000,1000,3,2,1000,0,5,1,,\"UNC\",\"\",0,1,1001002)
CYCLE84(20,10,2,5,,,3,,0.25,,1000,1000,0,3)
CYCLE840(20,10,2,5,,,4,3,11,,0.1,0,3,0,\"\")
";
    // 250; 25.4 / 20 = 1.27 mm; 6.35 mm; 2.54 mm.
    assert_snapshot!(moves(program), @r"
    1 rapid X5 Z50
    2 rapid Z12
    2 tap Z5 F250
    2 tap Z12 F250
    2 rapid Z20
    3 rapid Z12
    3 tap Z5 F1270
    3 tap Z12 F1270
    3 rapid Z20
    4 rapid Z12
    4 tap Z5 F6350
    4 tap Z12 F6350
    4 rapid Z20
    5 rapid Z12
    5 tap Z5 F2540
    5 tap Z12 F2540
    5 rapid Z20
    ");
}

/// "HOLES2": _VARI 1000 is the whole circle, which 4 steps of 90 degrees are too.
#[test]
fn divisions_of_a_circle_that_agree() {
    let program = "G0 X20 Z10 F100\nHOLES2(0,0,20,0,90,4,1000,0,,,1)\nHOLES2(0,0,20,0,30,2,2000)\n";
    assert_snapshot!(moves(program), @r"
    1 rapid X20 Z10
    2 rapid
    2 rapid X0 Y20
    2 rapid X-20 Y0
    2 rapid X0 Y-20
    3 rapid X20 Y0
    3 rapid X17.3205 Y10
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

/// "Modal call (MCALL)" of a subprogram, at the places of HOLES2.
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
