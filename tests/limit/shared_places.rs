//! Places at which several canned cycles drill, in a subprogram or a section that is repeated.

use insta::assert_snapshot;

use super::same_moves::same_moves;
use crate::shop::Shop;

/// What `limit` writes, which goes to the same places.
#[track_caller]
pub(super) fn limited(shop: &Shop, program: &str) -> String {
    let text = shop.limited(program, "--allow feed");
    same_moves(shop, &text);
    text
}

const TWO_CYCLES: &str = "O1\nG21 G90 G54\nG0 X0. Y0. Z50.\nG99 G81 Z-12. R40. F200. L0\n\
                          N50 M98 P100 (BOTH)\nG80\nG0 X500. Z50.\n\
                          G99 G83 X500. Y0. Z-20. R40. Q30. F100.\nM98 P100\nG80\nM30\n\
                          O100 (HOLES)\nN10 X400. Y300.\nX0. (EDGE)\nM99\n";

#[test]
fn blocks_take_the_place_of_each_call() {
    assert_snapshot!(limited(&Shop::straight("fanuc", 600.0), TWO_CYCLES), @r"
    O1
    G21 G90 G54
    G0 X0. Y0. Z50.
    G99 G81 Z-12. R40. F200. L0
    N50 (M98 P100 written out) (BOTH)
    (HOLES)
    G4 P1
    G9 G1 X400. Y300. F26966.
    G0 F200.
    G81 G99 X400. Y300. R40. Z-12.
    G0 X0.
    G81 G99 X0. R40. Z-12. (EDGE)
    G80
    G0 X500. Z50.
    G0 X500. Y0.
    G99 G83 X500. Y0. Z-20. R40. Q30. F100.
    (M98 P100 written out)
    (HOLES)
    G0 X400. Y300.
    G83 G99 X400. Y300. Q30. R40. Z-20.
    G0 X0.
    G83 G99 X0. Q30. R40. Z-20. (EDGE)
    G80
    M30
    O100 (HOLES)
    N10 X400. Y300.
    X0. (EDGE)
    M99
    ");
    let local = TWO_CYCLES
        .replace("M98 P100", "M97 P10")
        .replace("O100 (HOLES)\n", "");
    assert_snapshot!(limited(&Shop::straight("haas", 600.0), &local), @r"
    O1
    G21 G90 G54
    G0 X0. Y0. Z50.
    G99 G81 Z-12. R40. F200. L0
    N50 (M97 P10 written out) (BOTH)
    G4 P1
    G9 G1 X400. Y300. F26966.
    G0 F200.
    G81 G99 X400. Y300. R40. Z-12.
    G0 X0.
    G81 G99 X0. R40. Z-12. (EDGE)
    G80
    G0 X500. Z50.
    G0 X500. Y0.
    G99 G83 X500. Y0. Z-20. R40. Q30. F100.
    (M97 P10 written out)
    G0 X400. Y300.
    G83 G99 X400. Y300. Q30. R40. Z-20.
    G0 X0.
    G83 G99 X0. Q30. R40. Z-20. (EDGE)
    G80
    M30
    N10 X400. Y300.
    X0. (EDGE)
    M99
    ");
}

/// The file stays as it is, for other programs; only calls whose places are asked for change.
#[test]
fn places_may_stand_in_a_file() {
    let shop = Shop::straight("fanuc", 600.0);
    let (program, file) = TWO_CYCLES.split_once("O100").unwrap();
    shop.put("O100.nc", &format!("O100{file}"));
    assert_snapshot!(limited(&shop, program), @r"
    O1
    G21 G90 G54
    G0 X0. Y0. Z50.
    G99 G81 Z-12. R40. F200. L0
    N50 (M98 P100 written out) (BOTH)
    (HOLES)
    G4 P1
    G9 G1 X400. Y300. F26966.
    G0 F200.
    G81 G99 X400. Y300. R40. Z-12.
    G0 X0.
    G81 G99 X0. R40. Z-12. (EDGE)
    G80
    G0 X500. Z50.
    G0 X500. Y0.
    G99 G83 X500. Y0. Z-20. R40. Q30. F100.
    (M98 P100 written out)
    (HOLES)
    G0 X400. Y300.
    G83 G99 X400. Y300. Q30. R40. Z-20.
    G0 X0.
    G83 G99 X0. Q30. R40. Z-20. (EDGE)
    G80
    M30
    ");
    assert_eq!(shop.get("O100.nc"), format!("O100{file}"));
}

#[test]
fn a_subroutine_of_linuxcnc() {
    let program = "G21 G90 G64\no100 sub\nX400 Y300\nX0\no100 endsub\nG0 X0 Y0 Z50\n\
                   G99 G81 X0 Y0 Z-12 R40 F200\no100 call\nG80\n\
                   G99 G82 X0 Y300 Z-14 R40 P1\no100 call\nG80\nM2\n";
    assert_snapshot!(limited(&Shop::straight("linuxcnc", 600.0), program), @r"
    G21 G90 G64
    o100 sub
    X400 Y300
    X0
    o100 endsub
    G0 X0 Y0 Z50
    G99 G81 X0 Y0 Z-12 R40 F200
    (o100 call written out)
    G4 P0
    G0 X400. Y300.
    G4 P0
    G81 X400 Y300 R40 Z-12
    G4 P0
    G0 X0.
    G4 P0
    G81 X0 R40 Z-12
    G80
    G99 G82 X0 Y300 Z-14 R40 P1
    (o100 call written out)
    G4 P0
    G0 X400. Y300.
    G4 P0
    G82 X400 Y300 P1 R40 Z-14
    G4 P0
    G0 X0.
    G4 P0
    G82 X0 P1 R40 Z-14
    G80
    M2
    ");
}

/// `ShopMill` writes its positions as a section with a label.
#[test]
fn a_section_of_sinumerik_that_is_repeated() {
    let program = "G17 G54 G90 G60 F200\nG0 X0 Y0 Z50\nN30 MCALL CYCLE81(50,0,2,-10)\n\
                   N40 POS: X200 Y150\nN50 X10 Y20\nN60 ENDLABEL:\nN70 MCALL\nF100\n\
                   N80 MCALL CYCLE82(50,0,2,-12,,1)\nN90 REPEAT POS ; AGAIN\nN100 MCALL\n\
                   G0 Z100\nM30\n";
    assert_snapshot!(limited(&Shop::straight("siemens", 600.0), program), @r"
    G17 G54 G90 G60 F200
    G0 X0 Y0 Z50
    N30 ;MCALL CYCLE81(50,0,2,-10)
    N40 POS: G1 X200 Y150 F26966
    G0 F200
    CYCLE81(50,0,2,-10)
    N50 G1 X10 Y20 F27713
    G0 F200
    CYCLE81(50,0,2,-10)
    N60 ENDLABEL:
    N70 MCALL
    F100
    N80 ;MCALL CYCLE82(50,0,2,-12,,1)
    N90 ; REPEAT POS written out ; AGAIN
    G1 X200 Y150 F27713
    G0 F100
    CYCLE82(50,0,2,-12,,1)
    G1 X10 Y20 F27713
    G0 F100
    CYCLE82(50,0,2,-12,,1)
    N100 MCALL
    G0 Z100
    M30
    ");
}

/// Why the blocks cannot take the place of the calls.
#[test]
fn what_keeps_blocks_from_the_place_of_the_call() {
    let shop = Shop::straight("fanuc", 600.0);
    for (from, to, why) in [
        ("X0. (EDGE)", "X[#1] (EDGE)", "values that are worked out"),
        (
            "N10 X400.",
            "IF[#2 EQ #0]GOTO10\nN10 X400.",
            "a branch, a loop or a macro",
        ),
        ("M98 P100", "/M98 P100", "its call may be skipped"),
        (
            "M98 P100",
            "M98 P100 M8",
            "the block of its call does more than call it",
        ),
    ] {
        let program = TWO_CYCLES.replace("O1\n", "O1\n#1=0.\n").replace(from, to);
        let (code, _, errors) = shop.limit(&program, "--allow feed,expand");
        assert_eq!(code, 1, "{why}: {errors}");
        let message = format!(
            "it does something else each time it runs, and what keeps its blocks from the place of \
             the call is {why}"
        );
        assert!(errors.contains(&message), "{message}\n{errors}");
    }
}
