//! Programs that jump to a block which is changed: lines that are put before it are executed by
//! a jump there too.

use insta::assert_snapshot;

use crate::shop::Shop;

/// The dwell that keeps a corner sharp stands after the number that the jump looks for.
#[test]
fn a_dwell_is_where_the_jump_leads() {
    let program = "G21 G90 G54\n#1=0\nN10 G0 X1000. Y800.\nG1 X990. F500.\n#1=#1+1\n\
                   IF [#1 LT 3] GOTO 10\nM30\n";
    assert_snapshot!(Shop::straight("fanuc", 600.0).limited(program, ""), @r"
    G21 G90 G54
    #1=0
    N10 G4 P1
    G9 G1 X1000. Y800. F26404.
    G0
    G1 X990. F500.
    #1=#1+1
    IF [#1 LT 3] GOTO 10
    M30
    ");
    // Of subprograms that are called by a number too.
    let program = "G21 G90 G54\nM97 P100\nM30\nN100 G0 X1000. Y800.\nG1 X990. F500.\nM99\n";
    assert_snapshot!(Shop::straight("haas", 600.0).limited(program, ""), @r"
    G21 G90 G54
    M97 P100
    M30
    N100 G4 P1
    G9 G1 X1000. Y800. F26404.
    G0
    G1 X990. F500.
    M99
    ");
}

/// Names with a colon go along as well, after the number that stands before them.
#[test]
fn names_go_along() {
    let program = "G71 G90 G54 G64\nR1=0\nN5 LB1: G0 X=IC(1000) Y=IC(800)\nG1 X0 F500\nR1=R1+1\n\
                   IF R1<3 GOTOB LB1\nM30\n";
    assert_snapshot!(Shop::straight("siemens", 600.0).limited(program, "--allow unverified"), @r"
    G71 G90 G54 G64
    R1=0
    N5 LB1: ACC[X]=57 ACC[Y]=57 ACC[Z]=57
    G0 X=IC(1000) Y=IC(800)
    ACC[X]=100 ACC[Y]=100 ACC[Z]=100
    ACC[X]=57 ACC[Y]=57 ACC[Z]=57
    G1 X0 F500
    ACC[X]=100 ACC[Y]=100 ACC[Z]=100
    R1=R1+1
    IF R1<3 GOTOB LB1
    M30
    ");
}

/// The mark for block delete stands where it stood, as it was written; the number of a program is
/// its first word; labels of the ISG kernel have a colon.
#[test]
fn marks_and_numbers_keep_their_order() {
    let loops = |block: &str| {
        format!(
            "G21 G90 G54\n#1=0\n{block}\nG1 X990. F500.\n#1=#1+1\nIF [#1 LT 3] GOTO 10\nG1 X1.\nM30\n"
        )
    };
    let third = |text: &str| text.lines().nth(2).unwrap().to_owned();
    let shop_of = Shop::straight("fanuc", 600.0);
    let number_first = shop_of.limited(&loops("N10 /G0 X1000. Y800."), "");
    assert_eq!(third(&number_first), "N10 /G4 P1", "{number_first}");
    let mark_first = shop_of.limited(&loops("/2 N10 G0 X1000. Y800."), "");
    assert_eq!(third(&mark_first), "/2N10 G4 P1", "{mark_first}");
    let program = "O1000 G21 G90 G54 G0 X1000. Y800.\nG1 X990. F500.\nM30\n";
    let text = shop_of.limited(program, "");
    assert!(
        text.starts_with("O1000 G4 P1\nG9 G21 G90 G54 G1 X1000. Y800."),
        "{text}"
    );
    let isg = "G71 G90\nP1=0\nN10: G0 X1000 Y800\nG1 X990 F500\nP1=P1+1\n$IF P1<3\n$GOTO N10\n$ENDIF\nM30\n";
    let text = Shop::straight("isg", 600.0).limited(isg, "");
    assert!(text.contains("\nN10: G"), "{text}");
}

/// Without a line before it a block keeps its label, and so does one that nothing changes.
#[test]
fn labels_stay_where_nothing_stands_before() {
    let program = "G21 G90 G61\n#1=0\nG1 X1. F500.\nN10 G0 X1000. Y800.\nN20 G1 X990. F500.\n\
                   #1=#1+1\nIF [#1 LT 3] GOTO 10\nM30\n";
    assert_snapshot!(Shop::straight("fanuc", 600.0).limited(program, ""), @r"
    G21 G90 G61
    #1=0
    G1 X1. F500.
    N10 G1 X1000. Y800. F26395.
    G0 F500.
    N20 G1 X990. F500.
    #1=#1+1
    IF [#1 LT 3] GOTO 10
    M30
    ");
}

/// A modal macro is called by blocks that move axes, not by a dwell (B-63944EN, "Modal Call").
#[test]
fn a_dwell_calls_no_macro() {
    let program = "O6\nG21 G90 G54 G0 X0 Y0 Z50.\nG66 P9001 Z-5.\nX1000. Y800.\nG4 P100\nG67\n\
                   G0 X0 Y0\nM30\nO9001\nG91 G1 Z#26 F100\nG1 Z-#26\nG90\nM99\n";
    let shop = Shop::straight("fanuc", 600.0);
    shop.put("a.nc", program);
    let (_, out, _) = shop.run("moves a.nc");
    assert_eq!(out.matches("\"line\":10,").count(), 1, "{out}");
    assert_snapshot!(shop.limited(program, ""), @r"
    O6
    G21 G90 G54 G0 X0 Y0 Z50.
    G66 P9001 Z-5.
    G4 P1
    G9 G1 X1000. Y800. F26404.
    G0
    G4 P100
    G67
    G4 P1
    G9 G1 X0 Y0 F26404.
    G0 F100
    M30
    O9001
    G91 G1 Z#26 F100
    G1 Z-#26
    G90
    M99
    ");
}
