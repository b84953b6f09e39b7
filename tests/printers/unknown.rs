//! Macros of which nothing is known, and parts that the machine may leave out.

use super::{klipper, load, machine_with, marlin, run};
use insta::assert_snapshot;

/// Slicers' `START_PRINT`: every axis at full speed, every load on, the limits of the machine
/// file again; feed and modes have to be stated after it.
#[test]
fn after_a_macro_the_program_states_its_modes() {
    assert_snapshot!(klipper(
        "SET_VELOCITY_LIMIT ACCEL=500\nG1 X1 F60\nSTART_PRINT BED=60\nG90\nM83\nG1 X2\nG1 X3 E1 F120\nG91\nG1 X1 E1\n"
    ), @"");
    let refused = |program: &str| klipper(&format!("START_PRINT\n{program}"));
    assert_snapshot!(refused("G1 X2 F60\n"), @"");
    assert_snapshot!(refused("G90\nG1 X2 F60\nG1 E1\n"), @"");
    // Under G91 the extruder is relative too, whatever M82 and M83 say.
    assert_snapshot!(refused("G91\nG1 X2 E1 F60\n"), @"");
    // A state that was kept before states all.
    assert_snapshot!(klipper("SAVE_GCODE_STATE\nG1 X1 F60\nEND_PRINT\nRESTORE_GCODE_STATE\nG1 X2 F60\n"), @"");
    // The machine file's word stands: it moves nothing.
    let own = machine_with("klipper", "[language]\nignored_macros = [\"START_*\"]\n");
    assert_snapshot!(run(&own, "START_PRINT\nG1 X2 F60\n"), @"");
    // A macro of this machine in place of a command that the profile ignores.
    let own = machine_with(
        "klipper",
        "[language]\nunknown_macros = [\"BED_MESH_PROFILE\", \"M9833.2\", \"M620.11\"]\n",
    );
    assert_snapshot!(run(&own, "BED_MESH_PROFILE LOAD=a\nM9833.2\nM620.11 S1\nG90\nG1 X2 F60\n"), @"");
}

/// Marlin: G90 states the extruder's mode too.
#[test]
fn g90_states_what_it_sets() {
    assert_snapshot!(marlin("M201.2 K1.0\nG1 X1 F60\n"), @"");
    assert_snapshot!(marlin("M201.2 K1.0\nG90\nG1 X1 E1 F60\n"), @"");
}

/// Bambu Lab's M622 to M623: done where a flag says so. What holds after it is what either
/// way may leave: the faster F, each heater that one leaves on, modes that have to be stated.
#[test]
fn a_part_that_may_be_left_out_counts_both_ways() {
    assert_snapshot!(marlin(
        "M1002 judge_flag a\nM104 S200\nM83\nG1 X1 F60\nM622.1 S1\nM622 J1\nG1 X2 F30\nM104 S0\nM140 S60\nM623\nG1 X3 E1\nG1 X4 F60\nG1 X5\n"
    ), @"");
    // The same F on either way.
    assert_snapshot!(marlin("G1 X1 F60\nM622 J1\nG1 X2\nM623\nG1 X3\n"), @"");
    assert_snapshot!(marlin("G90\nM622 J1\nG91\nM623\nG1 X3 F60\n"), @"");
    assert_snapshot!(marlin("M204 P500\nM622 J1\nM204 P100\nM623\nG1 X3 F60\n"), @"");
    assert_snapshot!(marlin("M622 J1\nG20\nM623\n"), @"");
    assert_snapshot!(marlin("M623\n"), @"");
    assert_snapshot!(marlin(&"M622 J1\n".repeat(17)), @"");
    assert_snapshot!(marlin("M1006 A0 B0 L100 C37 D10 M100 E37 F10 N100\n"), @"");
}

#[test]
fn what_is_no_command_is_no_macro() {
    let text = "schema = 1\nname = \"t\"\ncontroller = \"klipper\"\n[converter]\npeak_power_w = 1e5\n\
                [axes.X]\nrapid_mm_min = 6000\naccel_mm_s2 = 1000\nmass_kg = 10\n";
    assert_snapshot!(run(&load(text), "M9833\n"), @"");
}
