//! Holes of a canned cycle that differ from the others: rigid taps, blocks that may be skipped,
//! and blocks that stay as they are.

use insta::assert_snapshot;

use super::same_moves::same_moves;
use super::shared_places::limited;
use crate::shop::Shop;

/// Any motion word ends rigid tapping: M29 comes again before each tap whose way is gone by
/// itself, and nothing comes between the two.
#[test]
fn rigid_taps_are_announced_again() {
    let program = "G21 G90 G54\nG0 X0. Y0. Z50.\nN10 M29 S500\nN20 G99 G84 X400. Y300. Z-8. R40. F500.\n\
                   X410.\nN30 X0. Y0. (LAST)\nG80\nM29 S300\nG84 Z-8. R40. F300. K0\nX400. Y300.\n\
                   G80 G0 Z50.\nM30\n";
    assert_snapshot!(limited(&Shop::straight("fanuc", 600.0), program), @r"
    G21 G90 G54
    G0 X0. Y0. Z50.
    G9 G1 X400. Y300. F26966.
    G0
    N10 M29 S500
    N20 G99 G84 X400. Y300. Z-8. R40. F500.
    G0 X410.
    M29 S500
    G84 G99 X410. R40. Z-8.
    G4 P1
    G9 G1 X0. Y0. F27173.
    G0 F500.
    M29 S500
    N30 G84 G99 X0. Y0. R40. Z-8. (LAST)
    G80
    M29 S300
    G84 Z-8. R40. F300. K0
    G4 P1
    G9 G1 X400. Y300. F26966.
    G0 F300.
    M29 S300
    G84 G99 X400. Y300. R40. Z-8.
    G80 G0 Z50.
    M30
    ");
}

/// A tap that has to change no way is announced again too, where one before it, of the same M29, has
/// ended that: the way back to the level of G98 is a block of its own.
#[test]
fn no_rigid_tap_becomes_another() {
    let program = "G21 G90 G54\nG0 X0. Y0. Z100.\nM29 S300\nG98 G84 X400. Y300. Z-12. R5. F300.\n\
                   G84 X400. Y301. Z-12. R98. F300.\nX410. K2\nG80\nG1 X50.\nM30\n";
    let shop = Shop::mill(
        "fanuc",
        "peak_power_w = 300",
        "[path]\nrapid = \"linear\"",
        "",
    );
    let (code, _, errors) = shop.limit(program, "--allow feed,expand");
    assert!(code == 1 && errors.contains("it taps"), "{errors}");
    let text = shop.limited(&program.replace("X410. K2\n", ""), "--allow feed,expand");
    same_moves(&shop, &text);
    let lines: Vec<&str> = text.lines().collect();
    let taps = lines.windows(2).filter(|pair| pair[1].contains("G84"));
    let announced = taps.clone().filter(|pair| pair[0] == "M29 S300");
    assert_eq!((taps.count(), announced.count()), (2, 2), "{text}");
}

/// The way to a hole that may be skipped is skipped with it.
#[test]
fn a_hole_that_may_be_skipped() {
    let program = "G21 G90 G54\nG0 X0. Y0. Z50.\nG99 G81 X10. Z-12. R40. F200.\n\
                   /2 X400. Y300.\nX20. Y10.\nG80 G0 Z50.\nM30\n";
    assert_snapshot!(limited(&Shop::straight("fanuc", 600.0), program), @r"
    G21 G90 G54
    G0 X0. Y0. Z50.
    G0 X10.
    G99 G81 X10. Z-12. R40. F200.
    /2G4 P1
    /2 G9 G1 X400. Y300. F26749.
    /2G0 F200.
    /2 G81 G99 X400. Y300. R40. Z-12.
    G4 P1
    G9 G1 X20. Y10. F26817.
    G0 F200.
    G81 G99 X20. Y10. R40. Z-12.
    G80 G0 Z50.
    M30
    ");
}

/// A hole that repeats stays, with all words of its cycle; those around it change.
#[test]
fn a_hole_that_stays_keeps_the_others_from_nothing() {
    let program = "G21 G90 G54\nG0 X0. Y0. Z50.\nG98 G81 X400. Y300. Z-12. R40. F200.\n\
                   X420. K2\nX0. Y0.\nG80\nM30\n";
    assert_snapshot!(limited(&Shop::straight("fanuc", 600.0), program), @r"
    G21 G90 G54
    G0 X0. Y0. Z50.
    G9 G1 X400. Y300. F26966.
    G0
    G98 G81 X400. Y300. Z-12. R40. F200.
    G81 X420. K2 R40. Z-12.
    G9 G1 X0. Y0. F27371.
    G0 F200.
    G81 X0. Y0. R40. Z-12.
    G80
    M30
    ");
}
