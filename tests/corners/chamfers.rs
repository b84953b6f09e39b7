//! Chamfers and rounded corners, compensated or not.

use insta::assert_snapshot;

use super::{moves, moves_on};
use crate::listing::machine_of;

/// B-63944EN, "Optional Chamfering and Corner R".
#[test]
fn chamfers_and_rounded_corners() {
    // A radius of 5 in the corner (40, 0), a chamfer of 3 in (40, 30). Between
    // the arc about (10, 20) and the line along Y20: the centre is 2 above the
    // line and 12 from (10, 20), at 10 - √140; it touches the arc at
    // (10, 20) + 10/12·(-√140, 2).
    let program =
        "G0 X0. Y0.\nG1 X40. ,R5. F600\nY30.,C3. F300\nX10.\nG3 X0. Y20. R10.,R2.\nG1 X-20.\nM30\n";
    let expected = "1 rapid\n\
        2 feed X35.0000 F600.00\n\
        2 arc X40.0000 Y5.0000 about 35.0000,5.0000 by 90.000 F600.00\n\
        3 feed Y27.0000 F300.00\n\
        3 feed X37.0000 Y30.0000 F300.00\n\
        4 feed X10.0000 F300.00\n\
        5 arc X0.1399 Y21.6667 about 10.0000,20.0000 by 80.406 F300.00\n\
        5 arc X-1.8322 Y20.0000 about -1.8322,22.0000 by -80.406 F300.00\n\
        6 feed X-20.0000 F300.00\n";
    assert_eq!(moves("fanuc", program), expected);
    // Without points the numbers are least increments on some machines.
    let least = machine_of(
        "fanuc",
        "[language]\ndecimal_point = \"least-increment\"\n",
        "XYZ",
        "",
    );
    let whole = program.replace(",R5.", ",R5000").replace(",C3.", ",C3000");
    assert_eq!(moves_on(&least, "", &whole), expected);
    // On lathes they are lengths of a radius.
    let turned = "G98 G0 X40. Z2.\nG1 Z-20.,R3. F100\nX60.,C1.\nZ-40.\nM30\n";
    assert_snapshot!(moves("fanuc-lathe", turned), @r"
1 rapid X20.0000 Z2.0000
2 feed Z-17.0000 F100.00
2 arc X23.0000 Z-20.0000 about -17.0000,23.0000 by -90.000 F100.00
3 feed X29.0000 F100.00
3 feed X30.0000 Z-21.0000 F100.00
4 feed Z-40.0000 F100.00
");
}

#[test]
fn chamfers_and_rounded_corners_under_compensation() {
    // Radius 2 outside: the rounded corner has 5 + 2, the chamfer's ends meet
    // the shifted lines 2·tan 22.5° beyond it. Inside: 5 - 2.
    let program = "G10 L12 P1 R2.\nG0 X0. Y-10.\nG42 D1 G1 X0. Y0. F600\nX40. ,R5.\nY30.,C3.\nX10.\nG40 X0.\nM30\n";
    assert_snapshot!(moves("fanuc", program), @r"
2 rapid Y-10.0000
3 feed Y-2.0000 F600.00
4 feed X35.0000 F600.00
4 arc X42.0000 Y5.0000 about 35.0000,5.0000 by 90.000 F600.00
5 feed Y27.8284 F600.00
5 feed X37.8284 Y32.0000 F600.00
6 feed X10.0000 F600.00
7 feed X0.0000 Y30.0000 F600.00
");
    let inside = program
        .replace("G42", "G41")
        .replace("X0. Y-10.", "X20. Y10.")
        .replace("X0. Y0.", "X20. Y0.");
    assert_snapshot!(moves("fanuc", &inside), @r"
2 rapid X20.0000 Y10.0000
3 feed Y2.0000 F600.00
4 feed X35.0000 F600.00
4 arc X38.0000 Y5.0000 about 35.0000,5.0000 by 90.000 F600.00
5 feed Y26.1716 F600.00
5 feed X36.1716 Y28.0000 F600.00
6 feed X10.0000 F600.00
7 feed X0.0000 Y30.0000 F600.00
");
}

/// "Chamfer, rounding (CHF, CHR, RND, RNDM)".
#[test]
fn chamfers_and_roundings_of_sinumerik() {
    // CHF is the chamfer's length: 2 across a right angle are legs of √2. CHR
    // are the legs. RND rounds one corner, RNDM all until RNDM=0.
    let program = "G0 X0 Y0\nG1 X40 CHF=2 F600\nY30 RND=4\nX20 CHR=3\nY10\nRNDM=2\nX0\nM8\nY0\nX-20\nRNDM=0\nG0 X50\nM30\n";
    let found = moves("siemens", &program.replace("M8\n", ""));
    assert_snapshot!(found, @r"
1 rapid
2 feed X38.5858 F600.00
2 feed X40.0000 Y1.4142 F600.00
3 feed Y26.0000 F600.00
3 arc X36.0000 Y30.0000 about 36.0000,26.0000 by 90.000 F600.00
4 feed X23.0000 F600.00
4 feed X20.0000 Y27.0000 F600.00
5 feed Y10.0000 F600.00
7 feed X2.0000 F600.00
7 arc X0.0000 Y8.0000 about 2.0000,8.0000 by 90.000 F600.00
8 feed Y2.0000 F600.00
8 arc X-2.0000 Y0.0000 about -2.0000,2.0000 by -90.000 F600.00
9 feed X-20.0000 F600.00
11 rapid X50.0000
");
    assert_eq!(
        moves("siemens", program),
        "8 corner-word: after a chamfer or a rounded corner comes no feed move\n"
    );
}

#[test]
fn corners_that_cannot_be() {
    let mut all = String::new();
    for rest in [
        "X40.,R5.\nM30",
        "X40.,R5.\nY3.",
        "X40.,R5.\nX60.",
        "X40.,C5.\nX10.",
        ",R5.",
        "M8 ,R5.",
        "G0 X40.,R5.\nG1 Y30.",
        "X40.,R5.\nG0 Y30.",
        "X40.,R5.\nZ3.",
        "X40.,C5.\nG2 X60. Y0. R10.",
        "X40.,C5.,R2.\nY10.",
        "X40.,R-5.\nY10.",
        "X40.,A45.",
        "X40.,R5.",
    ] {
        all.push_str(&moves("fanuc", &format!("G1 F600\n{rest}\n")));
    }
    assert_snapshot!(all, @r"
3 corner-word: after a chamfer or a rounded corner comes no feed move
3 corner-word: a chamfer or a rounded corner that does not fit between its moves
3 corner-word: a chamfer or a rounded corner where the path goes straight on or back
3 corner-word: a chamfer or a rounded corner where the path goes straight on or back
2 corner-word: a chamfer or a rounded corner after a block that is not one feed move
2 corner-word: a chamfer or a rounded corner after a block that is not one feed move
2 corner-word: a chamfer or a rounded corner after a block that is not one feed move
3 corner-word: after a chamfer or a rounded corner comes no feed move
3 corner-word: a chamfer or a rounded corner where a move leaves the plane
3 corner-word: a chamfer where an arc begins or ends
2 corner-word: a block takes one chamfer or rounded corner, from 0 on
2 corner-word: a block takes one chamfer or rounded corner, from 0 on
2 corner-word: an angle of a drawing (,A) is not supported
0 corner-word: the program ends before the second move of a corner
");
}
