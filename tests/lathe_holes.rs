//! Drilling cycles of lathes, each by a case worked by hand. Positions are those of the slides: X
//! is half of what the program says.
//!
//! Sources: Fanuc B-63604EN and B-64304EN-1, "Canned Cycle for Drilling"; Haas lathe operator's
//! manual 96-8900, "Canned Cycles".

use insta::assert_snapshot;

use crate::fanuc::{messages, moves};

/// B-63604EN, "Canned Cycle for Drilling (G80 to G89)".
#[test]
fn drilling_along_z_and_x() {
    let program = "G97 S500 M3\nG0 X0 Z10.\nG83 Z-10. R-8. Q8000 F0.1 P200\nG80 G0 X50. C0\nG98 G87 X30. R-2. F100. C90.\nG80 G99\nG85 Z-5. R-8. F0.2\nG84 Z-6. R-8. F1.5\n";
    assert_snapshot!(moves("fanuc-lathe", program), @r"
2 rapid Z10.0000
3 rapid
3 rapid Z2.0000
3 feed Z-6.0000 F50.0000
3 rapid Z2.0000
3 rapid Z-5.0000
3 feed Z-10.0000 F50.0000
3 dwell 0.2 s
3 rapid Z10.0000
4 rapid X25.0000
5 rapid C90.0000
5 rapid X23.0000
5 feed X15.0000 F100.0000
5 rapid X25.0000
7 rapid
7 rapid Z2.0000
7 feed Z-5.0000 F100.0000
7 feed Z2.0000 F200.0000
7 rapid Z10.0000
8 rapid
8 rapid Z2.0000
8 tap Z-6.0000 F750.0000
8 tap Z2.0000 F750.0000
8 rapid Z10.0000
");
}

/// B-64304EN-1, "Canned Cycle for Drilling": in G-code systems B and C the tool returns to the
/// initial level under G98, to R under G99; the initial level is that of the first hole.
#[test]
fn the_level_that_a_hole_of_a_lathe_returns_to() {
    let program = "G97 S1000 M3\nG90 G0 X20. Z50.\nG99 G83 Z-20. R-48. F0.1\nX10.\nG98 X6.\n\
                   G99 G85 X4. Z-5. R-40.\nG83 X2. Z-6. R-48.\nG80\n";
    assert_snapshot!(moves("fanuc-lathe-b", program), @r"
    2 rapid X10.0000 Z50.0000
    3 rapid
    3 rapid Z2.0000
    3 feed Z-20.0000 F100.0000
    3 rapid Z2.0000
    4 rapid X5.0000
    4 rapid
    4 feed Z-20.0000 F100.0000
    4 rapid Z2.0000
    5 rapid X3.0000
    5 rapid
    5 feed Z-20.0000 F100.0000
    5 rapid Z50.0000
    6 rapid X2.0000
    6 rapid Z10.0000
    6 feed Z-5.0000 F100.0000
    6 feed Z10.0000 F200.0000
    7 rapid X1.0000
    7 rapid Z2.0000
    7 feed Z-6.0000 F100.0000
    7 rapid Z2.0000
    ");
}

/// "G81 Drill Canned Cycle" to "G89": along Z from the place R, back to where they began; G85 and
/// G89 come out at the feed, after G87 and G88 the operator has retracted the tool.
#[test]
fn holes_of_a_haas_lathe() {
    let program = "G97 S500 M3\nG0 X0 Z10.\nG81 Z-10. R2. F0.1\nG82 Z-8. R3. P500\n\
                   G83 Z-10. R2. Q8.\nG85 Z-5. R2.\nG86 Z-5. R2.\nG87 Z-5. R2.\n\
                   G88 Z-5. R2. P1000\nG89 Z-5. R2. P1000\nG84 Z-6. R2. F1.5\nG80 G0 Z20.\n";
    assert_snapshot!(moves("haas-lathe", program), @r"
    2 rapid Z10.0000
    3 rapid
    3 rapid Z2.0000
    3 feed Z-10.0000 F50.0000
    3 rapid Z10.0000
    4 rapid
    4 rapid Z3.0000
    4 feed Z-8.0000 F50.0000
    4 dwell 0.5 s
    4 rapid Z10.0000
    5 rapid
    5 rapid Z2.0000
    5 feed Z-6.0000 F50.0000
    5 rapid Z2.0000
    5 rapid Z-5.0000
    5 feed Z-10.0000 F50.0000
    5 rapid Z10.0000
    6 rapid
    6 rapid Z2.0000
    6 feed Z-5.0000 F50.0000
    6 feed Z2.0000 F50.0000
    6 rapid Z10.0000
    7 rapid
    7 rapid Z2.0000
    7 feed Z-5.0000 F50.0000
    7 rapid Z10.0000
    8 rapid
    8 rapid Z2.0000
    8 feed Z-5.0000 F50.0000
    8 rapid
    9 rapid
    9 rapid Z2.0000
    9 feed Z-5.0000 F50.0000
    9 dwell 1 s
    9 rapid
    10 rapid
    10 rapid Z2.0000
    10 feed Z-5.0000 F50.0000
    10 dwell 1 s
    10 feed Z2.0000 F50.0000
    10 rapid Z10.0000
    11 rapid
    11 rapid Z2.0000
    11 tap Z-6.0000 F750.0000
    11 tap Z2.0000 F750.0000
    11 rapid Z10.0000
    12 rapid Z20.0000
    ");
    let message = messages(
        "haas-lathe",
        "G97 S500 M3\nG0 X0 Z10.\nG83 Z-10. R2. Q4. F0.1\n",
    );
    assert_snapshot!(message.join("\n"), @"G83 is taken to come out to R after each peck and to stay 1 mm off the last depth: Settings 52 and 22 of the control; say pecks_return_to_r = true and peck_clearance_mm under [language] of the machine file");
}
