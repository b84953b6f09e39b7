//! Cycles that SINUMERIK calls by name: the call after each place, or the moves of the cycle.

use insta::assert_snapshot;

use crate::shop::Shop;

/// The message of a program that stays as it is.
fn stays(program: &str, options: &str) -> String {
    let shop = Shop::straight("siemens", 400.0);
    shop.put("a.nc", program);
    let (code, text, errors) = shop.run(format!("limit a.nc {options}").trim_end());
    assert_eq!((code, text.as_str()), (1, ""), "{errors}");
    errors
}

const HOLES: &str = "G17 G54 G90 G60 F200\nG0 X0 Y0 Z50\nN30 MCALL CYCLE81(50,0,2,-10) ; 6H7\n\
                     N40 X200 Y150\nN50 X0 Y0\nN60 MCALL\nG0 Z100\nM30\n";

/// 700 W are enough for one axis, not for two: the ways between the holes are gone more slowly,
/// and the cycle is called at each place.
#[test]
fn the_way_from_hole_to_hole() {
    assert_snapshot!(Shop::straight("siemens", 700.0).limited(HOLES, ""), @r"
    G17 G54 G90 G60 F200
    G0 X0 Y0 Z50
    N30 ;MCALL CYCLE81(50,0,2,-10) ; 6H7
    N40 G1 X200 Y150 F32359
    G0 F200
    CYCLE81(50,0,2,-10)
    N50 G1 X0 Y0 F32359
    G0 F200
    CYCLE81(50,0,2,-10)
    N60 MCALL
    G0 Z100
    M30
    ");
}

/// With `--allow expand` the moves of the cycle stand there, and a comment names it.
#[test]
fn cycles_are_written_out() {
    assert_snapshot!(Shop::straight("siemens", 450.0).limited(HOLES, "--allow expand"), @r"
    G17 G54 G90 G60 F200
    G0 X0 Y0 Z50
    N30 ;MCALL CYCLE81(50,0,2,-10) ; 6H7
    N40 G1 X200 Y150 F18876
    G0 Z2.
    G1 Z-10. F200
    G1 Z50. F23999
    N50 X0 Y0 F18876
    G0 Z2.
    G1 Z-10. F200
    G1 Z50. F23999
    N60 MCALL
    G0 Z100
    F200
    M30
    ");
    // Feeds of its own, a dwell, and a call without MCALL.
    let bore = "G17 G54 G90 G60 F200\nG0 X0 Y0 Z50\nCYCLE85(50,0,2,-10,,0.5,120,300)\nG1 X5\nM30\n";
    assert_snapshot!(Shop::straight("siemens", 350.0).limited(bore, "--allow expand"), @r"
    G17 G54 G90 G60 F200
    G1 X0 Y0 Z50 F17142
    ;CYCLE85(50,0,2,-10,,0.5,120,300)
    G1 Z2.
    G1 Z-10. F120.
    G4 F0.5
    G1 Z2. F300.
    G1 Z50. F17142.
    F200.
    G1 X5
    M30
    ");
    let deep = "G17 G54 G90 G60 F200\nG0 X0 Y0 Z50\nMCALL CYCLE83(50,0,2,-20,,-8,,2,,,0.5,1)\n\
                G1 X3\nMCALL\nM30\n";
    assert_snapshot!(Shop::straight("siemens", 450.0).limited(deep, "--allow expand"), @r"
    G17 G54 G90 G60 F200
    G0 X0 Y0 Z50
    ;MCALL CYCLE83(50,0,2,-20,,-8,,2,,,0.5,1)
    G1 X3
    G0 Z2.
    G1 Z-8. F100.
    G0 Z2.
    G0 Z-7.4
    G1 Z-14. F200.
    G0 Z2.
    G0 Z-13.4
    G1 Z-17.
    G0 Z2.
    G0 Z-16.4
    G1 Z-20.
    G1 Z50. F24000.
    G1
    MCALL
    F200.
    M30
    ");
}

/// A pattern of holes becomes its holes; under a turned frame too, and in diameters.
#[test]
fn patterns_are_written_out() {
    let row = "G17 G54 G90 G60 F200\nG0 X0 Y0 Z50\nTRANS X10 Y20\nAROT Z30\n\
               MCALL CYCLE82(50,0,2,-10,,0.2)\nHOLES1(0,0,0,10,100,3)\nMCALL\nM30\n";
    assert_snapshot!(Shop::straight("siemens", 450.0).limited(row, "--allow expand"), @r"
    G17 G54 G90 G60 F200
    G0 X0 Y0 Z50
    TRANS X10 Y20
    AROT Z30
    ;MCALL CYCLE82(50,0,2,-10,,0.2)
    ;HOLES1(0,0,0,10,100,3)
    G1 X10. Y0. F18904
    G0 Z2.
    G1 Z-10. F200
    G4 F0.2
    G1 Z50. F23999
    G1 X110. F20255
    G0 Z2.
    G1 Z-10. F200
    G4 F0.2
    G1 Z50. F23999
    G1 X210. F20255
    G0 Z2.
    G1 Z-10. F200
    G4 F0.2
    G1 Z50. F23999
    MCALL
    G0 F200
    M30
    ");
}

/// What cannot be said in single blocks stays, with its reason.
#[test]
fn cycles_that_stay() {
    let program = |call: &str, block: &str| {
        format!("G17 G54 G90 G60 F200 S500 M3\nG0 Z50\nR1=-10\n{call}\n{block}\nMCALL\nM30\n")
    };
    let tap = program("MCALL CYCLE84(50,0,2,-10,,,5,,1)", "X100");
    let errors = stays(&tap, "--allow expand");
    assert!(
        errors.contains(
            "the canned cycle is not written out: it taps, or turns the spindle to a place"
        ),
        "{errors}"
    );
    let worked_out = program("MCALL CYCLE81(50,0,2,R1)", "X400 Y300");
    let errors = stays(&worked_out, "");
    assert!(
        errors.contains("its arguments are worked out by the program"),
        "{errors}"
    );
    let errors = stays(
        &program("MCALL CYCLE81(50,0,2,-10)", "G2 X100 Y0 I50"),
        "--allow expand",
    );
    assert!(
        errors.contains("the motion word in force is neither G0 nor G1"),
        "{errors}"
    );
    let errors = stays(
        &program("MCALL CYCLE81(50,0,2,-10)", "/X400 Y300"),
        "--allow expand",
    );
    assert!(errors.contains("its block may be skipped"), "{errors}");
}
