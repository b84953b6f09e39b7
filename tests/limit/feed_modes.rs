//! Rapids where F is no length per minute: they get a feed per minute of their own, between the
//! words for it and for what was in force.

use insta::assert_snapshot;

use crate::shop::Shop;

/// Each mode of SINUMERIK has a kin with a feed per minute and the same rule for the spindle, so
/// that constant surface speed goes on.
#[test]
fn sinumerik_keeps_the_rule_for_the_spindle() {
    let program = |mode: &str| {
        format!("G18 G54 G90 G60\nLIMS=3000\n{mode}\nG0 X400 Z300\nG1 Z250 F0.2\nG0 X0 Z0\nM30\n")
    };
    let shop = Shop::straight("siemens", 600.0);
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
    assert_snapshot!(Shop::straight("fanuc", 600.0).limited(program, ""), @r"
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
    assert_snapshot!(Shop::straight("linuxcnc", 600.0).limited(program, ""), @r"
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
    assert_snapshot!(Shop::straight("grbl", 600.0).limited(program, ""), @r"
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

/// F is blocks a minute under G93: a lower one makes its own block last longer, and no other.
/// From 400 mm in 0.6 s, F100, to what 300 W leave: the F of a block of twice the way is half.
#[test]
fn an_inverse_time_is_lowered_block_by_block() {
    let lowered = |controller: &str, program: &str| {
        let shop = Shop::straight(controller, 300.0);
        shop.limited(program, "--allow feed")
    };
    let f = |text: &str, line: usize| -> f64 {
        let line = text.lines().nth(line).expect("a line");
        let number = line.split_once('F').expect(line).1;
        number.trim_end_matches('.').parse().expect(line)
    };
    for controller in ["linuxcnc", "fanuc", "haas", "siemens", "grbl"] {
        let head = if controller == "siemens" {
            "G71 G90 G60 G93"
        } else {
            "G21 G90 G61.1 G93"
        };
        let head = match controller {
            "fanuc" | "haas" => "G21 G90 G61 G93",
            "grbl" => "G21 G90 G93",
            _ => head,
        };
        let program = format!("{head}\nG1 X400. F100.\nX0. F2.\nG1 X800. F50.\nG94\nM30\n");
        let text = lowered(controller, &program);
        let (first, twice) = (f(&text, 1), f(&text, 3));
        assert!(first < 99.0 && text.contains("\nX0. F2.\nG1"), "{text}");
        assert!(
            (2.0 * twice / first - 1.0).abs() < 2e-4,
            "{controller}: {text}"
        );
        // Nothing else is touched.
        let others = |text: &str| -> Vec<String> {
            let lines = text
                .lines()
                .map(|line| line.split('F').next().unwrap_or(""));
            lines.map(str::to_owned).collect()
        };
        assert_eq!(others(&text), others(&program));
    }
    // In inches too, and with rotary axes next to linear ones: the way is that of all.
    let inches = lowered("linuxcnc", "G20 G90 G61.1 G93\nG1 X16 Y4 F100\nG94\nM2\n");
    let mm = lowered(
        "linuxcnc",
        "G21 G90 G61.1 G93\nG1 X406.4 Y101.6 F100\nG94\nM2\n",
    );
    assert!(
        (f(&inches, 1) / f(&mm, 1) - 1.0).abs() < 1e-4,
        "{inches}{mm}"
    );
    // Under compensation the shifted way counts, and the block stays.
    let shop = Shop::straight("siemens", 300.0);
    let (code, _, errors) = shop.limit(
        "G71 G90 G60\n$TC_DP6[1,1]=5\nT1 D1\nG1 G41 X10 Y10 F1000\nG93 X400 F100\nG94 G40 X410 Y30 \
         F500\nM30\n",
        "--allow feed",
    );
    assert_ne!(code, 0, "{errors}");
}

/// A block that says itself that F is by the revolution gets the word for feeds per minute in its
/// place; one with an inverse time stays as it is.
#[test]
fn the_word_of_the_block_itself() {
    let program = "G18 G54 G90 G60 S2000 M3\nG0 G95 X400 Z300\nG1 Z250 F0.2\nM30\n";
    assert_snapshot!(Shop::straight("siemens", 600.0).limited(program, ""), @r"
    G18 G54 G90 G60 S2000 M3
    G1 G94 X400 Z300 F26966
    G0 G95
    G1 Z250 F0.2
    M30
    ");
    let shop = Shop::straight("fanuc", 600.0);
    shop.put(
        "a.nc",
        "G21 G90 G54\nG93 G0 X400. Y300.\nG1 X390. F100.\nM30\n",
    );
    let (code, _, errors) = shop.run("limit a.nc");
    assert_eq!(code, 1, "{errors}");
    assert!(errors.contains("its feed is an inverse time"), "{errors}");
}
