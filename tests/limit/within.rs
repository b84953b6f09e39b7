//! Blocks under compensation: what changes stands in the blocks themselves, and no line comes
//! between them.

use insta::assert_snapshot;
use proptest::prelude::*;

use crate::shop::Shop;

fn shop(controller: &str, power_w: f64) -> Shop {
    let shop = Shop::straight(controller, power_w);
    shop.put("tools.tbl", "T1 P1 D8\nT2 P2 D4\n");
    shop
}

/// Exit code, what is written, and what is said; what is written fits, and stays as it is when it
/// is limited again.
#[track_caller]
fn run(shop: &Shop, program: &str, options: &str) -> (i32, String, String) {
    shop.put("a.nc", program);
    let how = format!("--tool-table tools.tbl --allow feed{options} -o out.nc");
    let (code, _, errors) = shop.run(&format!("limit a.nc {how}"));
    if code != 0 {
        return (code, String::new(), errors);
    }
    let text = shop.get("out.nc");
    let (code, out, _) = shop.run("check out.nc --tool-table tools.tbl");
    assert_eq!(code, 0, "{text}{out}");
    shop.put("a.nc", &text);
    let (code, _, again) = shop.run(&format!("limit a.nc {how}"));
    assert_eq!(code, 0, "{text}{again}");
    assert_eq!(shop.get("out.nc"), text);
    (0, text, errors)
}

#[track_caller]
fn limited(shop: &Shop, program: &str, options: &str) -> String {
    let (code, text, errors) = run(shop, program, options);
    assert_eq!(code, 0, "{program}{errors}");
    text
}

/// A rapid leads in and out: G1, the feed by the minute and an exact stop stand in its block,
/// the stop in the block before it too, and what was in force in the one after it.
#[test]
fn rapids_of_a_lathe() {
    let program = "G21 G99 G54 T0404\nG97 S500 M3\nG0 X64. Z3.\nG1 X62. F0.2\nG0 G42 X30. Z2.\n\
                   G1 Z-20. F0.12\nX40. Z-25.\nM8\nG0 X60.\nZ-30.\nG1 X62. Z-31.\n\
                   G0 G40 X70. Z3.\nG1 X68. Z2.\nG0 X80.\nM30\n";
    let shop = Shop::lathe("fanuc-lathe", 400.0, "");
    assert_snapshot!(limited(&shop, program, ""), @r"
    G21 G99 G54 T0404
    G97 S500 M3
    G98
    G4 P1
    G9 G1 X64. Z3. F19314.
    G0 G99
    G1 X62. F0.2
    G0 G42 X30. Z2.
    G1 Z-20. F0.12
    X40. Z-25.
    M8
    G0 X60.
    Z-30.
    G9 G1 X62. Z-31.
    G9 G98 G1 G40 X70. Z3. F19515.
    G0 G99 F0.12
    G1 X68. Z2.
    G0 X80.
    M30
    ");
    // Where a dwell stops the axes none may stand between these blocks either.
    let shop = Shop::lathe("haas-lathe", 400.0, "");
    assert_snapshot!(limited(&shop, program, ""), @r"
    G21 G99 G54 T0404
    G97 S500 M3
    G98
    G4 P1
    G9 G1 X64. Z3. F19314.
    G0 G99
    G1 X62. F0.2
    G0 G42 X30. Z2.
    G1 Z-20. F0.12
    X40. Z-25.
    M8
    G0 X60.
    Z-30.
    G9 G1 X62. Z-31.
    G9 G98 G1 G40 X70. Z3. F19515.
    G0 G99 F0.12
    G1 X68. Z2.
    G0 X80.
    M30
    ");
}

/// Feeds are lowered on every control that compensates; G9 is written where the control has it.
#[test]
fn feeds_of_mills() {
    let program = "G17 G90 G40 G94\nG0 X5 Y5\nT1 M6\nG1 Z-2 F300\nG41 D1 X40 Y0 F30000\nY100\n\
                   G3 X20 Y120 I-20\nG1 X-40 F20000\nG40 Y60\nG1 X0 F500\nM30\n";
    for controller in ["fanuc", "haas", "mazak", "mitsubishi", "syntec", "linuxcnc"] {
        let text = limited(&shop(controller, 500.0), program, "");
        let inside: Vec<_> = text
            .lines()
            .skip_while(|line| !line.contains("G41"))
            .collect();
        let end = inside.iter().position(|line| line.contains("G40")).unwrap();
        assert_eq!(end, 4, "{controller}: {text}");
        assert!(inside[1].starts_with("Y100 F"), "{controller}: {text}");
    }
    let siemens = program.replace("T1 M6", "T1 D1").replace("G41 D1", "G41");
    let text = limited(&shop("siemens", 500.0), &siemens, ",stop");
    assert!(text.contains("\nY100 F"), "{text}");
    assert!(text.contains("\nG9 G3 X20"), "{text}");
}

/// In a subprogram a line comes next to others in each run: those that may come next state what
/// is in force before them.
#[test]
fn contours_in_subprograms() {
    let program = "O1\nG21 G17 G90 G40 G94\nG54 G0 X0 Y0\nT1\nM98 P100\nG0 X200. Y0\nM98 P100\n\
                   G0 Z50.\nM30\nO100\nG91\nG1 Z-7. F300\nG41 D1 G0 X60. Y0\nY300. Z1.\n\
                   G1 Y50. F20000\nM8\nG3 X-20. Y20. I-20.\nG1 X-40. F15000\nG0 G40 X-40. Y-420.\n\
                   Z6.\nG90\nM99\n";
    assert_snapshot!(limited(&shop("fanuc", 400.0), program, ""), @r"
    O1
    G21 G17 G90 G40 G94
    G54 G0 X0 Y0
    T1
    M98 P100
    G4 P1
    G9 G1 X200. Y0 F19694.
    G0 F15000
    M98 P100
    G4 P1
    G9 G1 Z50. F20571.
    G0 F15000
    M30
    O100
    G91
    G9 G1 Z-7. F300
    G9 G41 D1 G1 X60. Y0 F20571.
    G9 G1 Y300. Z1. F20561.
    G1 Y50. F8367.6
    M8
    G3 X-20. Y20. I-20. F8367.6
    G9 G1 X-40. F12203
    G9 G1 G40 X-40. Y-420. F20228.
    G0 F15000
    Z6.
    G90
    M99
    ");
}

/// A block that may be skipped takes no words; next to one that does not move nothing is needed.
#[test]
fn blocks_that_may_be_skipped() {
    let program = "G17 G90 G94\nG0 X5. Y5.\nT1\nG41 D1 G0 X300. Y0\nY50.\nG1 Y100. F5000\n/ M8\nX80. \
                   F500\nG0 G40 X0 Y0\n/ G0 X300.\nM30\n";
    assert_snapshot!(limited(&shop("fanuc", 400.0), program, ""), @r"
    G17 G90 G94
    G0 X5. Y5.
    T1
    G9 G41 D1 G1 X300. Y0 F20518.
    G9 G1 Y50. F20571.
    G1 Y100. F5000
    / M8
    G9 X80. F500
    G9 G1 G40 X0 Y0 F15620.
    G0 F500
    /G4 P1
    / G9 G1 X300. F20571.
    /G0 F500
    M30
    ");
    let moves = program
        .replace("/ M8\n", "/ M8 G1 Y105.\n")
        .replace("F5000", "F30000");
    let (code, _, errors) = run(&shop("fanuc", 400.0), &moves, "");
    assert_eq!(code, 1, "{errors}");
    let reason = "it is under cutter compensation in a program with calls, loops or blocks that may \
                  be skipped";
    assert!(errors.contains(reason), "{errors}");
}

#[test]
fn what_stays() {
    let begin = "G17 G90 G94\nG0 X5 Y5\nT1 M6\n";
    for (controller, program, reason) in [
        // Round an outside corner the rapid is several moves, each of which stops.
        (
            "fanuc",
            "G41 D1 G1 X40 Y0 F500\nY50\nG0 X400 Y-300\nG40 Y0\nM30\n",
            "without its stop the corner would be rounded",
        ),
        (
            "siemens",
            "D1\nG41 G0 X60 Y20\nX200\nY-300\nG40 G1 X0 Y0 F500\nM30\n",
            "it goes round a corner under compensation",
        ),
        // No word stops a block there.
        (
            "linuxcnc",
            "G64\nG41 D1 G1 X40 Y0 F500\nG0 Y300\nG40 X0\nM2\n",
            "without its stop the corner would be rounded",
        ),
        // M1 would have to stand by itself.
        (
            "fanuc",
            "G41 D1 G1 X40 Y0 F30000 M1\nY300\nG40 X0 F500\nM30\n",
            "it is under cutter compensation, where no line may come between",
        ),
    ] {
        let (code, _, errors) = run(&shop(controller, 250.0), &format!("{begin}{program}"), "");
        assert_eq!(code, 1, "{program}{errors}");
        assert!(errors.contains(reason), "{program}{errors}");
    }
    // It shows the F in force, which would be another one's.
    let program = format!("{begin}G41 D1 G1 X40 Y0 F30000\n#1=#4109\nY300 F500\nG40 X0\nM30\n");
    let (code, _, errors) = run(&shop("fanuc", 250.0), &program, "");
    assert_eq!(code, 1, "{errors}");
}

/// What stands in lines around a block would stand between others in the runs under compensation.
#[test]
fn lines_that_run_with_compensation_and_without() {
    let program = "G21 G17 G90 G94\nG0 X5. Y5.\nT1\n#1=0\nWHILE [#1 LT 2] DO1\nIF [#1 EQ 0] GOTO 10\n\
                   G41 D1 G1 X40. Y0 F500\nN10 G1 X60. F20000\nX300.\nX310. F500\nG40 X320. Y-9.\n\
                   X5. Y5.\n#1=#1+1\nEND1\nM30\n";
    let (code, _, errors) = run(&shop("fanuc", 300.0), program, "");
    assert_eq!(code, 1, "{errors}");
    assert!(
        errors.contains("it is under cutter compensation in a program"),
        "{errors}"
    );
    assert!(!errors.contains("fault of gwatt"), "{errors}");
    // G40 by itself belongs to the stretch.
    let program = "G21 G17 G90 G94\nG0 X5. Y5.\nT1\n#1=0\nWHILE [#1 LT 2] DO1\nG41 D1 G1 X40. Y0 \
                   F500\nX300. F20000\nM8\nG40\nX5. Y5. F500\n#1=#1+1\nEND1\nM30\n";
    assert_snapshot!(limited(&shop("fanuc", 300.0), program, ""), @r"
    G21 G17 G90 G94
    G4 P1
    G9 G1 X5. Y5. F9697.4
    G0
    T1
    #1=0
    WHILE [#1 LT 2] DO1
    G41 D1 G1 X40. Y0 F342.5
    G1 X300. F13700
    M8
    G1 G40 F20000
    X5. Y5. F500
    #1=#1+1
    END1
    M30
    ");
}

/// Where the program stops, and at its end, all is as in the original.
#[test]
fn stops_under_compensation() {
    let program = "G21 G99 G54 T0300\nG97 S500 M3\nG1 X64. Z3. F0.2\nG42 X60. Z2.\nZ-20.\nG0 X150.\n\
                   M1\nG1 Z-100.\nG0 X160.\nM30\n";
    let shop = Shop::lathe("fanuc-lathe", 300.0, "");
    assert_snapshot!(limited(&shop, program, ""), @r"
    G21 G99 G54 T0300
    G97 S500 M3
    G1 X64. Z3. F0.2
    G42 X60. Z2.
    G9 Z-20.
    G9 G98 G1 X150. F14999.
    M1 G99 F0.2 G0
    G1 Z-100.
    G0 X160.
    M30
    ");
}

/// One F for a line that runs under two: the lower one of the program's own is not exceeded.
#[test]
fn feeds_that_differ_between_runs() {
    let program = "G21 G17 G90 G94\nF20000\nM98 P2\nX0\nF2000\nM98 P2\nM30\nO2\nG1 X300.\nM99\n";
    let text = limited(&shop("fanuc", 200.0), program, "");
    assert!(text.contains("G1 X300. F2000\n"), "{text}");
}

/// The finishing cycle gets its contour with the words for compensation, where it ends in it or
/// G40 comes next.
#[test]
fn contours_of_finishing_cycles() {
    let begin = "G21 G99 G54 T0300\nG97 S500 M3\nG0 X64. Z3.\n";
    let contour = "N10 G0 G42 X30.\nG1 Z-60.\nN20 G40 X60. Z-70.\n";
    let cycles = format!("G71 P10 Q20 U0.4 D8. R1. F0.3\n{contour}G70 P10 Q20 F0.1\nM30\n");
    let shop = Shop::lathe("haas-lathe", 400.0, "");
    assert_snapshot!(limited(&shop, &format!("{begin}{cycles}"), ",expand"), @r"
    G21 G99 G54 T0300
    G97 S500 M3
    G98
    G4 P1
    G9 G1 X64. Z3. F19314.
    G0 G99
    F0.3 (G71 written out)
    G0 X64.4
    G0 X48.4
    G1 Z-66.
    G0 X50.4 Z-65.
    G98
    G9 G1 Z3. F19999.
    G0 G99 F0.3
    G0 X32.4
    G1 Z-60.666667
    G0 X34.4 Z-59.666667
    G98
    G9 G1 Z3. F19999.
    G0 G99 F0.3
    G0 X30.4
    G1 Z-60.
    G1 X60.4 Z-70.
    G98
    G4 P1
    G9 G1 X64. Z3. F19914.
    G0 G99 F0.3
    (N10 G0 G42 X30.)
    (G1 Z-60.)
    (N20 G40 X60. Z-70.)
    F0.1 (G70 written out)
    G0 G42 X30.
    G1 Z-60.
    G40 X60. Z-70.
    G98
    G4 P1
    G9 G1 X64. Z3. F19904.
    G0 G99 F0.1
    M30
    ");
    let after = cycles
        .replace("N20 G40", "N20")
        .replace("M30", "S400 M3\nG0 G40 X80.\nM30");
    assert_snapshot!(limited(&shop, &format!("{begin}{after}"), ",expand"), @r"
    G21 G99 G54 T0300
    G97 S500 M3
    G98
    G4 P1
    G9 G1 X64. Z3. F19314.
    G0 G99
    F0.3 (G71 written out)
    G0 X64.4
    G0 X48.4
    G1 Z-66.
    G0 X50.4 Z-65.
    G98
    G9 G1 Z3. F19999.
    G0 G99 F0.3
    G0 X32.4
    G1 Z-60.666667
    G0 X34.4 Z-59.666667
    G98
    G9 G1 Z3. F19999.
    G0 G99 F0.3
    G0 X30.4
    G1 Z-60.
    G1 X60.4 Z-70.
    G98
    G4 P1
    G9 G1 X64. Z3. F19914.
    G0 G99 F0.3
    (N10 G0 G42 X30.)
    (G1 Z-60.)
    (N20 X60. Z-70.)
    F0.1 (G70 written out)
    G0 G42 X30.
    G1 Z-60.
    G9 X60. Z-70.
    G9 G98 G1 G40 X64. Z3. F19904.
    G0 G99 F0.1
    S400 M3
    G0 G40 X80.
    M30
    ");
    let moves = after.replace("S400 M3", "G1 X66.");
    let (code, _, errors) = run(&shop, &format!("{begin}{moves}"), ",expand");
    assert_eq!(code, 1, "{errors}");
    let why = "the turning cycle is not written out: it runs under tool nose radius compensation";
    assert!(errors.contains(why), "{errors}");
}

fn block() -> impl Strategy<Value = String> {
    let word = prop::sample::select(vec!["", "G0 ", "G1 ", "G1 ", "M8 ", "(x) "]);
    let feed = prop::sample::select(vec!["", "", " F30000", " F900"]);
    // Always on to the right and up: no inside corner is too narrow.
    (word, 8..200, prop::sample::select(vec!['X', 'Y']), feed)
        .prop_map(|(word, way, axis, feed)| format!("{word}{axis}{way}.{feed}\n"))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Whatever the contour: what is written fits, has as many blocks between G41 and G40, and
    /// says no word twice.
    #[test]
    fn no_line_comes_between(
        blocks in prop::collection::vec(block(), 1..12),
        controller in prop::sample::select(vec!["fanuc", "haas", "mazak"]),
        skip in any::<bool>(),
    ) {
        let skip = if skip { "/M7\n" } else { "" };
        let body = blocks.concat();
        let program = format!(
            "G17 G90 G94\nG0 X5. Y5.\nT1\nG1 F800\nG41 D1 X20. Y20.\nG91\n{body}{skip}\
             G90 G1 G40 X0 Y0\nX9.\nM30\n"
        );
        let (code, text, _) = run(&shop(controller, 450.0), &program, "");
        if code == 0 {
            let inside = |text: &str| {
                let lines = text.lines().skip_while(|line| !line.contains("G41"));
                lines.take_while(|line| !line.contains("G40")).count()
            };
            prop_assert_eq!(inside(&text), inside(&program), "{}", text);
            let twice = |line: &str| line.matches('F').count() > 1;
            prop_assert!(!text.lines().any(twice), "{}", text);
        }
    }
}
