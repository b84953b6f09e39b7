//! Heaters and fans: loads that words switch by their value.

use gwatt::machine::Machine;
use insta::assert_snapshot;

use super::*;

/// Loads by value (Marlin M104, M140, M106, M107): S0 switches off, after the
/// block; a second fan or tool keeps its load on.
#[test]
fn heaters_and_fans() {
    assert_snapshot!(marlin(
        "M140 S60\nM104 S200\nG1 X1 F60\nM109 S0\nM106 S255\nG1 X2\nM106 P1\nM107\nG1 X3\n\
         M107 P1\nM190 R0\nG1 X4\nM104 T1 S9\nM104 S0\nG1 X5\nM81\nG1 X6\n"
    ), @r"
    3 feed X0.000>1.000 v1.000 loads 011
    6 feed X1.000>2.000 v1.000 loads 110
    9 feed X2.000>3.000 v1.000 loads 110
    12 feed X3.000>4.000 v1.000
    15 feed X4.000>5.000 v1.000 loads 001
    17 feed X5.000>6.000 v1.000
    ");
    assert_snapshot!(klipper(
        "SET_HEATER_TEMPERATURE HEATER=heater_bed TARGET=60\nSET_FAN_SPEED FAN=aux SPEED=0.5\n\
         G1 X1 F60\nTURN_OFF_HEATERS\nSET_FAN_SPEED FAN=aux SPEED=0\nG1 X2\n"
    ), @r"
    3 feed X0.000>1.000 v1.000 a1000 loads 110
    6 feed X1.000>2.000 v1.000 a1000 loads 100
    ");
    let bare = load(
        "schema = 1\nname = \"t\"\ncontroller = \"marlin\"\n[converter]\npeak_power_w = 1e5\n\
         [axes.X]\nrapid_mm_min = 6000\naccel_mm_s2 = 1000\nmass_kg = 10\n",
    );
    assert_snapshot!(run(&bare, "M104 S200\nM109 S0\n"), @"note heaters");
}

/// Where all words switch by their value no other word is needed to switch off.
#[test]
fn heaters_follow_their_target() {
    let text = |controller: &str, load: &str| {
        format!(
            "schema = 1\nname = \"t\"\ncontroller = \"{controller}\"\n[converter]\npeak_power_w = 1e5\n\
             [axes.X]\nrapid_mm_min = 6000\naccel_mm_s2 = 1000\nmass_kg = 10\n[[load]]\n{load}\npower_w = 40\n"
        )
    };
    let heater = text("marlin", "on = [\"M104\", \"M109\"]");
    assert_snapshot!(run(&load(&heater), "M104 S200\nG1 X1 F60\nM104 S0\nG1 X2\nM109 R180\nG1 X3\n"), @r"
    2 feed X0.000>1.000 v1.000 loads 001
    4 feed X1.000>2.000 v1.000
    6 feed X2.000>3.000 v1.000 loads 001
    ");
    // Elsewhere, and with words that only switch on, something must switch it off.
    for file in [
        text("fanuc", "on = \"M104\""),
        text("marlin", "on = [\"M104\", \"M80\"]"),
    ] {
        let (errors, missing) = (
            Machine::from_toml("test.toml", &file),
            "`off` is missing in `load`",
        );
        let errors = errors.expect_err("nothing switches it off");
        assert!(errors.iter().any(|it| it.message == missing), "{errors:?}");
    }
}

/// What a macro switches on only the machine knows: nozzle, bed and fan count as on from there,
/// a heater until its target is 0 for certain.
#[test]
fn heaters_may_be_on_after_a_macro() {
    let own = machine_with("klipper", "[language]\nunknown_moves = [\"START_PRINT\"]\n");
    assert_snapshot!(run(&own,
        "G1 X1 F60\nSTART_PRINT BED=60\nG1 X2\nM104 S0\nG1 X3\nM140 S0\nG1 X4\nM107\nG1 X5\n"
    ), @r"
    1 feed X0.000>1.000 v1.000 a1000
    2 feed from anywhere XYZE a1000 loads 111
    3 feed from anywhere X v1.000 a1000 loads 111
    5 feed X2.000>3.000 v1.000 a1000 loads 110
    7 feed X3.000>4.000 v1.000 a1000 loads 100
    9 feed X4.000>5.000 v1.000 a1000 loads 100
    note macro-heaters
    note unknown-moves
    note macro-settings
    ");
    // Of several tools one target says nothing of the others; this ends all.
    assert_snapshot!(run(&own,
        "START_PRINT\nM104 T0 S0\nG1 X3 F60\nT1\nM104 S0\nG1 X4\nTURN_OFF_HEATERS\nG1 X5\n"
    ), @r"
    1 feed from anywhere XYZE a1000 loads 111
    3 feed from anywhere X v1.000 a1000 loads 111
    4 feed from anywhere XYZE a1000 loads 111
    6 feed from anywhere X v1.000 a1000 loads 111
    8 feed X4.000>5.000 v1.000 a1000 loads 100
    note macro-heaters
    note unknown-moves
    note macro-settings
    ");
    // What Marlin does of itself heats nothing but under G26; RepRapFirmware runs files.
    assert_snapshot!(marlin("G29\nG1 X1 F60\nG26\n"), @r"
    1 feed from anywhere XYZE
    2 feed from anywhere X v1.000
    3 feed from anywhere XYZE loads 111
    note unknown-moves
    note bed-levelling
    note macro-heaters
    note macro-settings
    ");
    let bare = load(
        "schema = 1\nname = \"t\"\ncontroller = \"klipper\"\n[converter]\npeak_power_w = 1e5\n\
         [language]\nunknown_moves = [\"START_PRINT\"]\n\
         [axes.X]\nrapid_mm_min = 6000\naccel_mm_s2 = 1000\nmass_kg = 10\n",
    );
    assert!(run(&bare, "START_PRINT\n").contains("note heaters"));
}
