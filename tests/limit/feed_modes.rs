//! Rapids where F is no length per minute: they get a feed per minute of their own, between the
//! words for it and for what was in force.

use insta::assert_snapshot;

use crate::shop::Shop;

fn shop(controller: &str, power_w: f64) -> Shop {
    let converter = format!("peak_power_w = {power_w}");
    Shop::mill(controller, &converter, "[path]\nrapid = \"linear\"", "")
}

/// Each mode of SINUMERIK has a kin with a feed per minute and the same rule for the spindle, so
/// that constant surface speed goes on.
#[test]
fn sinumerik_keeps_the_rule_for_the_spindle() {
    let program = |mode: &str| {
        format!("G18 G54 G90 G60\nLIMS=3000\n{mode}\nG0 X400 Z300\nG1 Z250 F0.2\nG0 X0 Z0\nM30\n")
    };
    let shop = shop("siemens", 600.0);
    assert_snapshot!(shop.limited(&program("G96 S200 M3"), ""), @r"
    G18 G54 G90 G60
    LIMS=3000
    G96 S200 M3
    G961
    G1 X400 Z300 F26966
    G0 G96
    G1 Z250 F0.2
    G961
    G1 X0 Z0 F28390.
    G0 G96 F0.2
    M30
    ");
    assert_snapshot!(shop.limited(&program("G97 S2000 M3"), ""), @r"
    G18 G54 G90 G60
    LIMS=3000
    G97 S2000 M3
    G971
    G1 X400 Z300 F26966
    G0 G97
    G1 Z250 F0.2
    G971
    G1 X0 Z0 F28390.
    G0 G97 F0.2
    M30
    ");
    assert_snapshot!(shop.limited(&program("S2000 M3 G95"), ""), @r"
    G18 G54 G90 G60
    LIMS=3000
    S2000 M3 G95
    G94
    G1 X400 Z300 F26966
    G0 G95
    G1 Z250 F0.2
    G94
    G1 X0 Z0 F28390.
    G0 G95 F0.2
    M30
    ");
}

/// Under an inverse time each block has its own F, so that none is put back.
#[test]
fn an_inverse_time_has_no_feed_to_put_back() {
    let program = "G21 G90 G54 G93\nG0 X400. Y300.\nG1 X390. F100.\nG0 X0. Y0.\nM30\n";
    assert_snapshot!(shop("fanuc", 600.0).limited(program, ""), @r"
    G21 G90 G54 G93
    G94
    G4 P1
    G9 G1 X400. Y300. F26966.
    G0 G93
    G1 X390. F100.
    G94
    G4 P1
    G9 G1 X0. Y0. F26749.
    G0 G93
    M30
    ");
    assert_snapshot!(shop("linuxcnc", 600.0).limited(program, ""), @r"
    G21 G90 G54 G93
    G94
    G4 P0
    G1 X400. Y300. F37500
    G4 P0
    G0 G93
    G1 X390. F100.
    G0 X0. Y0.
    M30
    ");
    assert_snapshot!(shop("grbl", 600.0).limited(program, ""), @r"
    G21 G90 G54 G93
    G94
    G1 X400. Y300. F26966
    G0 G93
    G1 X390. F100.
    G94
    G1 X0. Y0. F26749.
    G0 G93
    M30
    ");
}

/// A block that says itself what F means stays as it is.
#[test]
fn the_word_of_the_block_itself() {
    let shop = shop("siemens", 600.0);
    shop.put(
        "a.nc",
        "G18 G54 G90 G60 S2000 M3\nG0 G95 X400 Z300\nG1 Z250 F0.2\nM30\n",
    );
    let (code, _, errors) = shop.run("limit a.nc");
    assert_eq!(code, 1, "{errors}");
    assert!(
        errors.contains("the feed in force is per revolution"),
        "{errors}"
    );
}
