//! Turning cycles of Fanuc's lathes written out, and returns to the reference point with the
//! offsets of a lathe's tools.

use insta::assert_snapshot;
use serde_json::Value;

use crate::shop::Shop;

pub(super) const READ: &str = "--tool-table tools.tbl --allow feed,expand";

/// What `limit` writes; the moves are those of the program before.
#[track_caller]
pub(super) fn limited(shop: &Shop, program: &str) -> String {
    let text = shop.written(program, READ);
    let [before, after] = ["a.nc", "out.nc"].map(|name| ends(shop, name));
    assert_eq!(before.len(), after.len(), "{text}");
    for (a, b) in before.iter().zip(&after) {
        let near = a.iter().zip(b).all(|(a, b)| (a - b).abs() < 2e-5);
        assert!(near, "{a:?} {b:?}\n{text}");
    }
    text
}

/// Ends of the moves that take time: X, Z, and the feed of cutting moves by the revolution.
fn ends(shop: &Shop, name: &str) -> Vec<[f64; 2]> {
    let (code, out, errors) = shop.run(&format!("moves {name} --tool-table tools.tbl"));
    assert_eq!(code, 0, "{errors}");
    let moves = out.lines().map(|line| serde_json::from_str(line).unwrap());
    let place = |mv: &Value, name: &str| ["X", "Z"].map(|axis| mv[name][axis].as_f64().unwrap());
    moves
        .filter(|mv: &Value| mv["kind"] != "dwell" && place(mv, "start") != place(mv, "end"))
        .map(|mv| place(&mv, "end"))
        .collect()
}

/// The blocks of the contour are no longer jumped over: they become comments, and the
/// finishing cycle that reads them again is written out with their own words.
#[test]
fn stock_removal_and_finishing() {
    let program = "O1 (SHAFT)\nN1 G21 G40 G99 G54 T0300\nN2 G97 S500 M3\nN3 G0 X64. Z3. M8\n\
                   N4 G71 U8. R0.5\nN5 G71 P10 Q20 U0.4 W0.1 F0.25 (ROUGH)\n\
                   N10 G0 X30. S600 (START)\nG1 Z-20. F0.12\nG2 X40. Z-25. R5.\n\
                   \n(STEP)\nG1 W-15.\nN20 U24. W-5.\nN25 G70 P10 Q20\nN30 G0 X150. Z100. M9\n\
                   N31 M30\n";
    assert_snapshot!(limited(&Shop::lathe("fanuc-lathe", 400.0, ""), program), @r"
    O1 (SHAFT)
    N1 G21 G40 G99 G54 T0300
    N2 G97 S500 M3
    G98
    G4 P1
    N3 G9 G1 X64. Z3. M8 F19314.
    G0 G99
    N4 G71 U8. R0.5
    N5 F0.25 (ROUGH) (G71 written out)
    G0 X64.4 Z3.1
    G0 X48.4
    G1 Z-41.566667
    G0 X49.4 Z-41.066667
    G98
    G9 G1 Z3.1 F19999.
    G0 G99 F0.25
    G0 X32.4
    G1 Z-22.9
    G0 X33.4 Z-22.4
    G98
    G9 G1 Z3.1 F20000.
    G0 G99 F0.25
    G0 X30.4
    G1 Z-19.9
    G2 X40.4 Z-24.9 K0. I5.
    G1 Z-39.9
    G1 X64.4 Z-44.9
    G98
    G4 P1
    G9 G1 X64. Z3. F19985.
    G0 G99 F0.25
    (N10 G0 X30. S600 [START])
    (G1 Z-20. F0.12)
    (G2 X40. Z-25. R5.)

    (STEP)
    (G1 W-15.)
    (N20 U24. W-5.)
    N25 (G70 written out)
    G0 X30. S600 (START)
    G1 Z-20. F0.12
    G2 X40. Z-25. R5.

    (STEP)
    G1 W-15.
    U24. W-5.
    G98
    G4 P1
    G9 G1 Z3. F19999.
    G0 G99 F0.12
    G98
    G4 P1
    N30 G9 G1 X150. Z100. M9 F17676.
    G0 G99 F0.12
    N31 M30
    ");
    // Where all fits, nothing is touched.
    let shop = Shop::lathe("fanuc-lathe", 5000.0, "");
    assert_eq!(limited(&shop, program), program);
}

/// The motion word before it is in force again.
#[test]
fn a_pattern_along_a_contour() {
    let program = "G21 G99 G54 T0300\nG97 S800 M3\nG0 X60. Z10.\nG1 X58. F0.5\n\
                   G73 U6. W3. R2\nG73 P100 Q200 U0.5 W0.1 F0.3\nN100 G0 X20. Z2.\nG1 Z-15.\n\
                   N200 X40. Z-40.\nX59.\nM30\n";
    assert_snapshot!(limited(&Shop::lathe("fanuc-lathe", 400.0, ""), program), @r"
    G21 G99 G54 T0300
    G97 S800 M3
    G98
    G4 P1
    G9 G1 X60. Z10. F19337.
    G0 G99
    G1 X58. F0.5
    G73 U6. W3. R2
    F0.3 (G73 written out)
    G0 X70.5 Z13.1
    G98
    G9 G1 X32.5 Z5.1 F17817.
    G0 G99 F0.3
    G1 Z-11.9
    G1 X52.5 Z-36.9
    G98
    G4 P1
    G9 G1 X58.5 Z10.1 F19763.
    G0 G99 F0.3
    G98
    G4 P1
    G9 G1 X20.5 Z2.1 F17817.
    G0 G99 F0.3
    G1 Z-14.9
    G1 X40.5 Z-39.9
    G98
    G4 P1
    G9 G1 X58. Z10. F19249.
    G0 G99 F0.3
    G1
    (N100 G0 X20. Z2.)
    (G1 Z-15.)
    (N200 X40. Z-40.)
    X59.
    M30
    ");
}

#[test]
fn cycles_of_one_block() {
    let program = "G21 G99 G54 T0300\nG97 S800 M3\nG0 X62. Z2.\nG90 X56. Z-80. F0.25\n\
                   X52. M8\nU-14. W-70. R-2.\nG0 X100. Z50.\nG94 X20. Z-2. F0.15\nZ-4.\n\
                   G0 X120. Z52.\nM30\n";
    assert_snapshot!(limited(&Shop::lathe("fanuc-lathe", 400.0, ""), program), @r"
    G21 G99 G54 T0300
    G97 S800 M3
    G98
    G4 P1
    G9 G1 X62. Z2. F19343.
    G0 G99
    F0.25 (G90 written out)
    G0 X56.
    G1 Z-80.
    G1 X62.
    G98
    G4 P1
    G9 G1 Z2. F19999.
    G0 G99 F0.25
    M8 (G90 written out)
    G0 X52.
    G1 Z-80.
    G1 X62.
    G98
    G4 P1
    G9 G1 Z2. F19999.
    G0 G99 F0.25
    (G90 written out)
    G0 X44.
    G1 X48. Z-68.
    G1 X62.
    G98
    G4 P1
    G9 G1 Z2. F19999.
    G0 G99 F0.25
    G98
    G4 P1
    G9 G1 X100. Z50. F17976.
    G0 G99 F0.25
    F0.15 (G94 written out)
    G98
    G4 P1
    G9 G1 Z-2. F19999.
    G0 G99 F0.15
    G1 X20.
    G1 Z50.
    G98
    G4 P1
    G9 G1 X100. F19999.
    G0 G99 F0.15
    (G94 written out)
    G98
    G4 P1
    G9 G1 Z-4. F19999.
    G0 G99 F0.15
    G1 X20.
    G1 Z50.
    G98
    G4 P1
    G9 G1 X100. F19999.
    G0 G99 F0.15
    G0 X120. Z52.
    M30
    ");
}

#[test]
fn pecking() {
    let program = "G21 G98 G54 T0300\nG97 S900 M3\nG0 X0. Z4.\nG74 R1.\n\
                   G74 Z-80. Q60000 F90.\nG0 X40. Z-20.\nM30\n";
    assert_snapshot!(limited(&Shop::lathe("fanuc-lathe", 400.0, ""), program), @r"
    G21 G98 G54 T0300
    G97 S900 M3
    G4 P1
    G9 G1 X0. Z4. F19999.
    G0
    G74 R1.
    F90. (G74 written out)
    G1 Z-56.
    G0 Z-55.
    G1 Z-80.
    G4 P1
    G9 G1 Z4. F19999.
    G9 G1 X40. Z-20. F15157.
    G0 F90.
    M30
    ");
}

/// System B has increments in G91, and other numbers.
#[test]
fn cycles_of_system_b() {
    let program = "G21 G95 G54 T0300\nG97 S800 M3\nG0 X62. Z2.\nG91\nG77 X-6. Z-80. F0.25\n\
                   X-10.\nG90 G0 X100. Z50.\nM30\n";
    let shop = Shop::lathe("fanuc-lathe-b", 400.0, "");
    assert_snapshot!(limited(&shop, program), @r"
    G21 G95 G54 T0300
    G97 S800 M3
    G94
    G4 P1
    G9 G1 X62. Z2. F19343.
    G0 G95
    G91
    F0.25 (G77 written out)
    G0 X-6.
    G1 Z-80.
    G1 X6.
    G94
    G4 P1
    G9 G1 Z80. F19999.
    G0 G95 F0.25
    (G77 written out)
    G0 X-10.
    G1 Z-80.
    G1 X10.
    G94
    G4 P1
    G9 G1 Z80. F19999.
    G0 G95 F0.25
    G94
    G4 P1
    G9 G90 G1 X100. Z50. F17976.
    G0 G95 F0.25
    M30
    ");
}

#[test]
fn what_is_not_written_out_is_said() {
    let stays = |program: &str, why: &str| {
        let begin = "G21 G99 G54 T0300\nG97 S500 M3\nG0 X64. Z3.\n";
        let errors =
            Shop::lathe("fanuc-lathe", 400.0, "").refused(&format!("{begin}{program}"), READ);
        let note = format!("the turning cycle is not written out: {why}\n");
        assert!(errors.contains(&note), "{program}\n{errors}");
        assert_eq!(
            errors.matches("note[not-written-out]").count(),
            1,
            "{errors}"
        );
    };
    let contour = "N10 G0 X30.\nG1 Z-60.\nN20 X60. Z-70.\nG0 X66. Z4.\n";
    let parameter = "its return, escape or chamfer is a parameter of the control: give it in the \
                     program (R), or escape_mm and groove_return_mm under [language] of the machine \
                     file";
    stays("G92 X50. Z-80. F2.\nG0 X66. Z4.\n", "it cuts a thread");
    stays(
        "G76 P010060 Q100 R0.05\nG76 X50. Z-80. P1300 Q900 F2.\nG0 X66. Z4.\n",
        "it cuts a thread",
    );
    stays(&format!("G71 P10 Q20 U0.4 D8. F0.3\n{contour}"), parameter);
    stays("G74 Z-80. Q60000 F0.1\nG0 Z4.\n", parameter);
    let two = contour.replace("X30.", "X30. Z2.");
    stays(
        &format!("G71 P10 Q20 U0.4 D8. R1. F0.3\n{two}"),
        "the first block of the contour names X and Z (type II): how the tool goes from pass to \
         pass is a matter of the control; where the contour has no pocket leave out the axis that \
         does not move there, or write under [language] of the machine file type_2 = \"as-type-1\" \
         or \"along-contour\", as the control goes",
    );
    // A way out that is not the cycle's own return.
    let out = contour.replace("N20 X60. Z-70.\n", "X60. Z-70.\nN20 G0 Z1.\n");
    stays(
        &format!("G71 P10 Q20 U0.4 D8. R1. F0.3\n{out}"),
        "its contour ends with a rapid back along the cut",
    );
    stays(
        &format!("G71 P10 Q20 U0.4 D8. R1. F0.3\n{contour}")
            .replace("G71", "G42 G1 X63. F0.2\nG71"),
        "it runs under tool nose radius compensation",
    );
    stays(
        "/G90 X50. Z-80. F0.2\nG0 X66. Z4.\n",
        "its block may be skipped",
    );
    // It needs permission.
    let program = "G21 G99 G54 T0300\nG97 S500 M3\nG0 X64. Z3.\nG90 X50. Z-80. F0.2\n";
    let errors = Shop::lathe("fanuc-lathe", 400.0, "")
        .refused(program, "--tool-table tools.tbl --allow feed");
    let help =
        "--allow expand writes turning cycles out as single blocks, where they cut no thread";
    assert!(errors.contains(help), "{errors}");
}

/// The way to the reference point is gone before, where the tool's offsets are known.
#[test]
fn returns_of_lathes() {
    let program = "G21 G98 G54\nT0101\nG0 X50. Z2.\nG1 Z-30. F120.\nG28 U20. W0. M5\nT0202\n\
                   G0 X50. Z2.\nG53 X0 Z0 M0\nT0200\nG0 X60.\nM30\n";
    assert_snapshot!(limited(&Shop::lathe("fanuc-lathe", 400.0, ""), program), @r"
    G21 G98 G54
    T0101
    G4 P1
    G9 G1 X50. Z2. F19924.
    G1 Z-30. F120.
    G0 X70. M5
    G9 G1 X40. Z230. F19788.
    G28 U0. W0.
    G1
    F120.
    T0202
    G4 P1
    G9 G1 X50. Z2. F19999.
    G9 G1 Z210.
    G0 F120.
    G53 X0 Z0 M0
    T0200
    G4 P1
    G9 G1 X60. F19999.
    G0 F120.
    M30
    ");
    let why = "the way to the reference point is not gone by a feed: the offsets of the lathe's \
               tool are not known: give them with --tool-table";
    assert!(
        Shop::lathe("fanuc-lathe", 400.0, "")
            .refused(program, "--allow feed")
            .contains(why)
    );
    let other = program.replace("T0202", "T0909");
    let errors = Shop::lathe("fanuc-lathe", 400.0, "").refused(&other, READ);
    assert!(errors.contains(why), "{errors}");
    let note = "note[no-tool-offset]: offsets of tools that the table does not have are taken as 0";
    assert!(errors.contains(note), "{errors}");
    // Neither where it leads may be guessed.
    let shop = Shop::lathe("fanuc-lathe", 400.0, "");
    let machine = shop.get("mill.toml").replace("reference_mm = 0\n", "");
    shop.put("mill.toml", &machine);
    let errors = shop.refused(program, READ);
    let why = "where it leads is not known: give reference_mm of the axes in the machine file";
    assert!(errors.contains(why), "{errors}");
}

/// The offsets of T are radii in X; those that T0100 takes back are gone.
#[test]
fn offsets_of_tools_move_the_coordinates() {
    let shop = Shop::lathe("fanuc-lathe", 5000.0, "");
    shop.put(
        "a.nc",
        "G21 G98\nG0 X50. Z2.\nT0101\nX50. Z2.\nT202 U10. Z3.\nT0100\nG0 X50.\nT9 Z5.\nM30\n",
    );
    let places: Vec<[f64; 2]> = ends(&shop, "a.nc");
    let expected = [
        [25.0, 2.0],
        [5.0, -28.0],
        [10.0, -7.0],
        [25.0, -7.0],
        [25.0, 5.0],
    ];
    assert_eq!(places, expected.map(|[x, z]| [x, z - 200.0]));
}

/// Drilling cycles: pecks along Z and X, and bores whose way out is twice as fast.
#[test]
fn drilling() {
    let program = "O1\nG21 G40 G98 G54\nT0300\nG97 S500 M3\nG0 X60. Z5.\n\
                   G83 X40. Z-30. R-3. Q10000 F100.\nX30.\nG80\nG0 X100. Z5.\n\
                   G85 X40. Z-20. R-3. P500 F80.\nG80\nG0 X100. Z-10.\n\
                   G87 X20. Z-20. R-10. F50.\nG80\nG0 X100. Z50.\nM30\n";
    let known = "[language]\npecks_return_to_r = true";
    let shop = Shop::lathe("fanuc-lathe", 300.0, known);
    let text = limited(&shop, program);
    assert_eq!(text.matches("(G83 written out)").count(), 2, "{text}");
    for lines in [
        // 10 mm from R on, then 10 mm more from 1 mm above.
        "G1 Z-8. F100.",
        "G1 Z-18.",
        "G1 Z-30.",
        "(G85 written out)",
        "G4 P500\nG1 Z2. F160.",
        "(G87 written out)",
        "G1 X20.",
    ] {
        assert!(text.contains(lines), "{lines}\n{text}");
    }
    // Feeds by the revolution stay the same.
    let turning = "O1\nG21 G40 G99 G54\nT0300\nG97 S500 M3\nG0 X60. Z5.\n\
                   G83 X40. Z-30. R-3. Q10000 F0.1\nG80\nG0 X100. Z50.\nM30\n";
    let text = limited(&shop, turning);
    assert!(text.contains("G0 G99 F0.1\nG1 Z-28.\n"), "{text}");
}

/// How far pecks return is a parameter; taps stay, and a way out that is faster than an F by
/// the revolution.
#[test]
fn drilling_cycles_that_stay() {
    let program = |cycle: &str| {
        format!("O1\nG21 G40 G99 G54\nT0300\nG97 S500 M3\nG0 X60. Z5.\n{cycle}\nG80\nM30\n")
    };
    let cases = [
        (
            "G83 X40. Z-30. R-3. Q10000 F0.1",
            "how far its pecks return is a parameter of the control",
        ),
        (
            "G85 X-300. Z-20. R-3. F0.1",
            "its way out is faster than its F, which is per revolution",
        ),
        ("G84 X-300. Z-20. R-3. F0.1", "it taps"),
    ];
    for (cycle, why) in cases {
        let shop = Shop::lathe("fanuc-lathe", 300.0, "");
        let errors = shop.refused(&program(cycle), READ);
        assert!(errors.contains(why), "{why}\n{errors}");
    }
}
