//! Blocks that select a tool or end the program move too: their motion is changed, and
//! anyone who looks at the state where the program stops finds the original's.

use insta::assert_snapshot;

use crate::shop::Shop;

/// A dwell in the block comes before its motion, which stops as it did.
#[test]
fn a_dwell_before_the_rapid() {
    let program = "G21 G90 G64\nG4 P0.1 G0 X400 Y300\nG1 X0 F900\nM2\n";
    assert_snapshot!(Shop::straight("linuxcnc", 520.0).written(program, "--allow feed"), @r"
    G21 G90 G64
    G4 P0
    G4 P0.1 G1 X400 Y300 F37500
    G4 P0
    G1 X0 F900
    M2
    ");
}

#[test]
fn tools_stops_and_ends() {
    let program = "G21 G90 G54\nG0 X400 Y300 T3 M8\nX0 Y50 Z40 M0 (LOOK)\nM1 G0 X300\n\
                   G1 Z30 F400\nG0 X0 Y300 M9 M30";
    assert_snapshot!(Shop::straight("fanuc", 520.0).written(program, "--allow feed"), @r"
    G21 G90 G54
    G4 P1
    G9 G1 X400 Y300 T3 M8 F22651.
    G0
    G9 G1 X0 Y50 Z40 F23555. (LOOK)
    G0
    M0
    G9 G1 X300 F28799.
    G0
    M1
    G1 Z30 F400
    G4 P1
    G9 G1 X0 Y300 M9 F21868.
    G0 F400
    M30
    ");
    assert_snapshot!(Shop::straight("linuxcnc", 520.0).written(program, "--allow feed"), @r"
    G21 G90 G54
    G4 P0
    G1 X400 Y300 T3 M8 F37500
    G4 P0
    G0
    X0 Y50 Z40 M0 (LOOK)
    M1 G0 X300
    G1 Z30 F400
    G4 P0
    G1 X0 Y300 M9 F37940
    G4 P0
    G0 F400
    M30
    ");
    // Of a feed alone F changes.
    let program = "G1 X400 F40000 M1\nX0 Y10\nG0 T2 Y300\nM2\n";
    assert_snapshot!(Shop::straight("linuxcnc", 300.0).written(program, "--allow feed"), @r"
    G1 X400 F23995
    F40000
    M1
    X0 Y10 F23842
    F40000
    G4 P0
    G1 T2 Y300 F23999
    G4 P0
    G0 F40000
    M2
    ");
}

#[test]
fn with_blocks_that_may_be_skipped() {
    let program = "G21 G90\nG0 X10\n/G0 X400 Y300 M1\nG0 X20 Y0\nM30\n";
    assert_snapshot!(Shop::straight("haas", 520.0).written(program, "--allow feed"), @r"
    G21 G90
    G0 X10
    /G4 P1
    /G9 G1 X400 Y300 F22469.
    /G0
    /M1
    G4 P1
    G9 G1 X20 Y0 F22278.
    G0
    M30
    ");
}

#[test]
fn sinumerik() {
    let program = "G17 G90 G94 G64\nT1 D1 G0 X400 Y300\nM3 S1000 M8 G0 X200 Y10\n\
                   SUPA G0 X0 Y300 Z300 D0\nG153 X400 Y10\nG0 X10 Y300 M0\nY0 M30\n";
    assert_snapshot!(Shop::straight("siemens", 520.0).written(program, "--allow feed"), @r"
    G17 G90 G94 G64
    T1 D1 G1 X400 Y300 F12000
    M3 S1000 M8 G1 X200 Y10 F11661
    SUPA G1 X0 Y300 Z300 D0 F2012
    G153 X400 Y10 F10979
    G0
    G1 X10 Y300 F8889.1
    G0
    M0
    G1 Y0 F19910
    G0
    M30
    ");
}

#[test]
fn what_stays() {
    let refused = |controller: &str, program: &str, reason: &str| {
        let shop = Shop::straight(controller, 520.0);
        let errors = shop.refused(program, "--allow feed");
        assert!(errors.contains(reason), "{errors}");
    };
    // What M6 runs may look at the state.
    refused(
        "fanuc",
        "G21 G90\nG0 X400 Y300 T1 M6\nM30\n",
        "it changes the tool, before or after its motion",
    );
    // Two words at which the program stops.
    refused(
        "fanuc",
        "G21 G90\nG0 X400 Y300 M1 M30\n",
        "it stops, changes the tool or ends the program",
    );
    // Nothing may come between blocks under compensation.
    refused(
        "fanuc",
        "G21 G90\nG0 X5\nG41 D1 G1 X10 F500\nX400 Y300 F30000 M1\nY0 F500\nG40 X0\nM30\n",
        "it is under cutter compensation, where no line may come between",
    );
}

/// The way to the reference point of SINUMERIK in coordinates of the machine, whatever the
/// frames are; not while a tool is in force.
#[test]
fn reference_point_of_sinumerik() {
    let known = "[path]\nrapid = \"linear\"";
    let shop = Shop::mill("siemens", "peak_power_w = 700", known, "reference_mm = 300");
    let program = "G17 G90 G94 G54\nG0 X10\nG1 X20 Y10 F500\nG74 X1=0 Y1=0\nX310\nM30\n";
    assert_snapshot!(shop.written(program, "--allow feed"), @r"
    G17 G90 G94 G54
    G1 X10 F20571
    G1 X20 Y10 F500
    SUPA G1 X=AC(300.) Y=AC(300.) F20571
    G1
    G74 X1=0 Y1=0
    X310 F500
    M30
    ");
    let refused = |shop: &Shop, program: &str, why: &str| {
        shop.put("a.nc", program);
        let (code, _, errors) = shop.run("limit a.nc --allow feed -o out.mpf");
        assert_eq!(code, 1, "{errors}");
        assert!(errors.contains(why), "{errors}");
    };
    let tool = program.replace("G0 X10", "T1 D1 G0 X10");
    refused(
        &shop,
        &tool,
        "the length of the tool is in force: write D0 before it",
    );
    shop.written(&tool.replace("G74", "D0\nG74"), "--allow feed");
    let fixed = program.replace("G74", "G75");
    refused(&shop, &fixed, "give further_reference_mm of the axes");
    let none = program.replace("G0 X10\nG1 X20 Y10 F500\n", "");
    refused(
        &shop,
        &none,
        "the motion word before it is neither G0 nor G1",
    );
    let switches = program.replace("G74", "M9 G74");
    refused(&shop, &switches, "it switches something too");
    // Slowly enough, it fits as it is.
    let slow = "reference_mm = 300\nreference_mm_min = 3000";
    let shop = Shop::mill("siemens", "peak_power_w = 700", known, slow);
    assert_eq!(shop.written(program, "--allow feed"), program);
}

/// RS274/NGC changes the tool before all else but S: the words stand on a line before the
/// motion then.
#[test]
fn tools_that_are_changed_before_the_motion() {
    let program = "G21 G90\nN10 T2 M6 G0 X400 Y300\nG1 Z30 F400\nG0 M6 X0 T3 Y300\nM6 G1 X100 F30000\nG0 X110\nM2\n";
    assert_snapshot!(Shop::straight("linuxcnc", 520.0).written(program, "--allow feed"), @r"
    G21 G90
    T2 M6
    G4 P0
    N10 G1 X400 Y300 F37500
    G4 P0
    G1 Z30 F400
    G0 M6 X0 T3 Y300
    M6
    G1 X100 F28799
    G0 X110
    F30000
    M2
    ");
    // With S the tool is changed in between.
    let refused = Shop::straight("linuxcnc", 520.0);
    let errors = refused.refused(
        "G21 G90\nT2 M6 S500 G0 X400 Y300\nG1 Z30 F400\nM30\n",
        "--allow feed",
    );
    assert!(errors.contains("changes the tool"), "{errors}");
}

/// M6 of a Haas takes Z to machine zero: that way is gone by a feed before it, with the selection
/// of the tool. Next to axes the block stays as it is.
#[test]
fn a_change_of_the_tool_that_moves_z() {
    let rest = "[path]\nrapid = \"linear\"\n[language]\ntool_change = \"before-motion\"\n\
                [offsets]\nG54 = {}\n";
    let shop = Shop::mill("haas", "peak_power_w = 520", rest, "reference_mm = 300");
    assert_snapshot!(shop.written("G21 G90 G54\nG1 Z30. F400\nM6 T2\nG0 X10.\nM30\n", "--allow feed"), @r"
    G21 G90 G54
    G1 Z30. F400
    G4 P1
    G9 G1 Z300. T2 F28799.
    G0 F400
    M6
    G1
    G0 X10.
    M30
    ");
    for order in ["before-motion", "after-motion"] {
        let rest = rest.replace("before-motion", order);
        let shop = Shop::mill("haas", "peak_power_w = 520", &rest, "reference_mm = 300");
        let errors = shop.refused(
            "G21 G90 G54\nG1 Z30. F400\nG0 X400. Y290. M6 T2\nM30\n",
            "--allow feed",
        );
        let why = "the machine moves axes of itself in it";
        let help = "write a change of the tool on a line of its own";
        assert!(errors.contains(why) && errors.contains(help), "{errors}");
    }
}

/// Elsewhere the order is the builder's: until the machine file says it, the block stays as
/// it is, and the return too, whose way would be gone before the tool changes or after.
#[test]
fn tools_that_change_when_the_machine_file_says() {
    let shop = |controller: &str, order: &str| {
        let order = match order {
            "" => "[language]\ntool_change_moves = []\n".to_owned(),
            order => format!("[language]\ntool_change = \"{order}\"\n"),
        };
        let rest = format!("[path]\nrapid = \"linear\"\n{order}[offsets]\nG54 = {{}}\n");
        Shop::mill(
            controller,
            "peak_power_w = 520",
            &rest,
            "reference_mm = 300",
        )
    };
    let program = "G21 G90 G54\nG1 Z30. F400\nG0 X400. Y290. M6 T2\nG91 G28 X0 Y0 T3 M6\nM30\n";
    for controller in ["fanuc", "haas"] {
        let refused = shop(controller, "");
        let errors = refused.refused(program, "--allow feed");
        assert_eq!(
            errors
                .matches("it changes the tool, before or after its motion")
                .count(),
            3,
            "{errors}"
        );
        let help = "the machine's builder decides which: tool_change = \"before-motion\" or \
                    \"after-motion\" under [language] of the machine file";
        assert!(errors.contains(help), "{errors}");
    }
    assert_snapshot!(shop("fanuc", "before-motion").written(program, "--allow feed"), @r"
    G21 G90 G54
    G1 Z30. F400
    T2 M6
    G4 P1
    G9 G1 X400. Y290. F22889.
    G0 F400
    T3 M6
    G4 P1
    G9 G1 X300. Y300. F28296.
    G91 G28 X0 Y0
    G0 F400
    M30
    ");
    assert_snapshot!(shop("fanuc", "after-motion").written(program, "--allow feed"), @r"
    G21 G90 G54
    G1 Z30. F400
    G4 P1
    G9 G1 X400. Y290. F22889.
    G0 F400
    T2 M6
    G9 G1 X300. Y300. F28296.
    G0 F400
    G91 G28 X0 Y0 T3 M6
    M30
    ");
    // S may come before the change or after it.
    let refused = shop("fanuc", "after-motion");
    let errors = refused.refused(&program.replace("M6 T2", "M6 T2 S500"), "--allow feed");
    assert!(errors.contains("it stops, changes the tool"), "{errors}");
}
