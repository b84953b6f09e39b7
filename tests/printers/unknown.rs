//! Macros of which nothing is known, and parts that the machine may leave out.

use super::{klipper, load, machine_with, marlin, run};
use insta::assert_snapshot;

/// Slicers' `START_PRINT`: every axis at full speed, every load on, the limits of the machine
/// file again; feed and modes have to be stated after it.
#[test]
fn after_a_macro_the_program_states_its_modes() {
    assert_snapshot!(klipper(
        "SET_VELOCITY_LIMIT ACCEL=500\nG1 X1 F60\nSTART_PRINT BED=60\nG90\nM83\nG1 X2\nG1 X3 E1 F120\nG91\nG1 X1 E1\n"
    ), @r"
    2 feed X0.000>1.000 v1.000 a500
    3 feed from anywhere XYZE a1000 loads 111
    6 feed from anywhere X a1000 loads 111
    7 feed X2.000>3.000 E0.000>1.000 v2.000 a1000 loads 111
    9 feed X3.000>4.000 E1.000>2.000 v2.000 a1000 loads 111
    note macro-heaters
    note unknown-moves
    note macro-settings
    note no-feed-yet
    ");
    let refused = |program: &str| klipper(&format!("START_PRINT\n{program}"));
    assert_snapshot!(refused("G1 X2 F60\n"), @"unstated-mode: whether X is absolute is not known after a macro of the machine");
    assert_snapshot!(refused("G90\nG1 X2 F60\nG1 E1\n"), @"unstated-mode: whether E is absolute is not known after a macro of the machine");
    // Under G91 the extruder is relative too, whatever M82 and M83 say.
    assert_snapshot!(refused("G91\nG1 X2 E1 F60\n"), @r"
    1 feed from anywhere XYZE a1000 loads 111
    3 feed X0.000>2.000 E0.000>1.000 v1.000 a1000 loads 111
    note macro-heaters
    note unknown-moves
    note macro-settings
    ");
    // A state that was kept before states all.
    assert_snapshot!(klipper("SAVE_GCODE_STATE\nG1 X1 F60\nEND_PRINT\nRESTORE_GCODE_STATE\nG1 X2 F60\n"), @r"
    2 feed X0.000>1.000 v1.000 a1000
    3 feed from anywhere XYZE a1000 loads 111
    5 feed from anywhere X v1.000 a1000 loads 111
    note macro-heaters
    note unknown-moves
    note macro-settings
    ");
    // The machine file's word stands: it moves nothing.
    let own = machine_with("klipper", "[language]\nignored_macros = [\"START_*\"]\n");
    assert_snapshot!(run(&own, "START_PRINT\nG1 X2 F60\n"), @"2 feed X0.000>2.000 v1.000 a1000");
    // A macro of this machine in place of a command that the profile ignores.
    let own = machine_with(
        "klipper",
        "[language]\nunknown_macros = [\"BED_MESH_PROFILE\", \"M9833.2\", \"M620.11\"]\n",
    );
    assert_snapshot!(run(&own, "BED_MESH_PROFILE LOAD=a\nM9833.2\nM620.11 S1\nG90\nG1 X2 F60\n"), @r"
    1 feed from anywhere XYZE a1000 loads 111
    2 feed from anywhere XYZE a1000 loads 111
    3 feed from anywhere XYZE a1000 loads 111
    5 feed from anywhere X v1.000 a1000 loads 111
    note macro-heaters
    note unknown-moves
    note bed-levelling
    note macro-settings
    ");
}

/// Marlin: G90 states the extruder's mode too.
#[test]
fn g90_states_what_it_sets() {
    assert_snapshot!(marlin("M201.2 K1.0\nG1 X1 F60\n"), @"unstated-mode: whether X is absolute is not known after a macro of the machine");
    assert_snapshot!(marlin("M201.2 K1.0\nG90\nG1 X1 E1 F60\n"), @r"
    1 feed from anywhere XYZE loads 111
    3 feed from anywhere XE v1.000 loads 111
    note macro-heaters
    note unknown-moves
    note macro-settings
    ");
}

/// Bambu Lab's M622 to M623: done where a flag says so. What holds after it is what either
/// way may leave: the faster F, each heater that one leaves on, modes that have to be stated.
#[test]
fn a_part_that_may_be_left_out_counts_both_ways() {
    assert_snapshot!(marlin(
        "M1002 judge_flag a\nM104 S200\nM83\nG1 X1 F60\nM622.1 S1\nM622 J1\nG1 X2 F30\nM104 S0\nM140 S60\nM623\nG1 X3 E1\nG1 X4 F60\nG1 X5\n"
    ), @r"
    4 feed X0.000>1.000 v1.000 loads 001
    6 feed from anywhere XYZE loads 001
    7 feed from anywhere X v0.500 loads 001
    10 feed from anywhere XYZE loads 011
    11 feed E0.000>1.000 from anywhere X loads 011
    12 feed X3.000>4.000 v1.000 loads 011
    13 feed X4.000>5.000 v1.000 loads 011
    note optional-part
    note no-feed-yet
    ");
    // The same F on either way.
    assert_snapshot!(marlin("G1 X1 F60\nM622 J1\nG1 X2\nM623\nG1 X3\n"), @r"
    1 feed X0.000>1.000 v1.000
    2 feed from anywhere XYZE
    3 feed from anywhere X v1.000
    4 feed from anywhere XYZE
    5 feed from anywhere X v1.000
    note optional-part
    ");
    assert_snapshot!(marlin("G90\nM622 J1\nG91\nM623\nG1 X3 F60\n"), @"unstated-mode: whether X is absolute is not known after a macro of the machine");
    assert_snapshot!(marlin("M204 P500\nM622 J1\nM204 P100\nM623\nG1 X3 F60\n"), @r"
    2 feed from anywhere XYZE a500
    4 feed from anywhere XYZE a500
    5 feed from anywhere X v1.000
    note optional-part
    ");
    assert_snapshot!(marlin("M622 J1\nG20\nM623\n"), @"optional-part: the unit changes in a part that may be left out");
    assert_snapshot!(marlin("M623\n"), @"optional-part: M623 without an M622 before it");
    assert_snapshot!(marlin(&"M622 J1\n".repeat(17)), @"optional-part: more than 16 parts that may be left out in one another");
    assert_snapshot!(marlin("M1006 A0 B0 L100 C37 D10 M100 E37 F10 N100\n"), @"");
}

#[test]
fn what_is_no_command_is_no_macro() {
    let text = "schema = 1\nname = \"t\"\ncontroller = \"klipper\"\n[converter]\npeak_power_w = 1e5\n\
                [axes.X]\nrapid_mm_min = 6000\naccel_mm_s2 = 1000\nmass_kg = 10\n";
    assert_snapshot!(run(&load(text), "M9833\n"), @"unknown-code: M9833 is not a valid word");
}

/// What moves with another drive draws too, and the machine file does not say what.
#[test]
fn drives_that_are_coupled_are_refused() {
    let refused = |program: &str, what: &str| {
        let found = if program.starts_with('M') {
            marlin(program)
        } else {
            klipper(program)
        };
        let name = program.split(' ').next().unwrap();
        let expected =
            format!("unsupported-word: `{name}` here is {what}: what its drive draws is not known");
        assert_eq!(found.trim_end(), expected);
    };
    let carriage = "a second carriage that moves with the first one";
    refused("SET_DUAL_CARRIAGE CARRIAGE=1 MODE=copy", carriage);
    refused("SET_DUAL_CARRIAGE CARRIAGE=1 MODE=MIRROR", carriage);
    let extruder = "an extruder that moves with another one";
    refused(
        "SYNC_EXTRUDER_MOTION EXTRUDER=extruder1 MOTION_QUEUE=extruder",
        extruder,
    );
    for alone in [
        "SET_DUAL_CARRIAGE CARRIAGE=0 MODE=PRIMARY\n",
        "SET_DUAL_CARRIAGE CARRIAGE=1\n",
        "SYNC_EXTRUDER_MOTION EXTRUDER=extruder1 MOTION_QUEUE=\n",
        "SYNC_EXTRUDER_MOTION EXTRUDER=extruder1 MOTION_QUEUE=extruder1\n",
    ] {
        assert!(!klipper(alone).contains("unsupported-word"), "{alone}");
    }
    refused("M605 S2 X100", carriage);
    assert!(!marlin("M605 S1\n").contains("unsupported-word"));
}

/// Marlin and Klipper have no G93 and no G95: F stays in mm/min there, which would be read slower.
#[test]
fn feed_modes_of_machine_tools_are_refused() {
    for mode in ["G93", "G95"] {
        for found in [marlin(mode), klipper(mode)] {
            let expected = "is a feed mode that not all firmware of printers has";
            let expected = format!("unsupported-code: {mode} {expected}");
            assert!(found.starts_with(&expected), "{found}");
        }
    }
}

/// Prusa's tool changers park a tool with P0; other such words are macros that the machine file
/// may list.
#[test]
fn p0_parks_the_tool() {
    assert_snapshot!(marlin("G1 X1 F60\nP0 S1 L1 D0; park the tool\nG1 X2\n"), @r"
    1 feed X0.000>1.000 v1.000
    2 feed from anywhere XYZE
    3 feed from anywhere X v1.000
    note unknown-moves
    ");
    let refused = marlin("P7 S1\n");
    assert!(
        refused.starts_with("unknown-macro: `P7` is a macro"),
        "{refused}"
    );
}
