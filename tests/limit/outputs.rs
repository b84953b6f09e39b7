//! LinuxCNC: accelerations over HAL, where the machine file says which output they are
//! wired to.

use super::{EXACT_STOP, RIG, Rig};
use gwatt::machine::Machine;
use gwatt::pipeline::Strategy;

const WIRED: &str = "[outputs]\nacceleration = 2\nchange_s = 0.01";

const HAL: Rig = Rig {
    controller: "linuxcnc",
    rest: WIRED,
    ..RIG
};

/// 1250 W of 1000 W: 0.8 of the acceleration, rounded down. 400 mm at 0.5 m/s take 0.8 s +
/// 0.1 s before and 0.8 s + 0.125 s after, and the axes stand for 10 ms at each change.
#[test]
fn a_rapid_keeps_its_speed() {
    let (text, summary) = HAL
        .limit(b"G64\nG0 X400\nG1 X401 F100\nM2\n")
        .expect("a program");
    assert!(summary.certified, "{:?}", summary.reasons);
    assert_eq!(
        String::from_utf8(text).expect("text"),
        "G64\nM68 E2 Q0.799\nM66 P0 L0\nG61.1\nG0 X400\nG64\nM68 E2 Q1\nM66 P0 L0\nG1 X401 F100\nM2\n"
    );
    let longer_s = summary.after.duration_s - summary.before.duration_s;
    assert!(
        (longer_s - 0.1 * (1.0 / 0.799 - 1.0) - 0.02).abs() < 2e-3,
        "{longer_s}"
    );
    let conditions = summary.after.conditions.join("\n");
    assert!(
        conditions.contains("analog output 2 sets the share of all accelerations"),
        "{conditions}"
    );
}

/// Where every block stops, feeds get it too, without a permission, and blocks with the same
/// share one pair of lines.
#[test]
fn blocks_with_one_share_get_one_change() {
    let rig = Rig {
        rest: "[outputs]\nacceleration = 0\n[path]\nmode = \"exact-stop\"",
        ..HAL
    };
    assert_eq!(
        rig.strategy(Strategy::Accel)
            .fits("G0 X400\nG1 X0 F30000\nX1 F100\nM2\n"),
        "M68 E0 Q0.799\nM66 P0 L0\nG0 X400\nG1 X0 F30000\nM68 E0 Q1\nM66 P0 L0\nX1 F100\nM2\n"
    );
}

/// What the program itself has set comes back.
#[test]
fn a_share_of_the_program_comes_back() {
    let rig = Rig {
        rest: "[outputs]\nacceleration = 0\nchange_s = 0\n[path]\nmode = \"exact-stop\"",
        ..HAL
    };
    assert_eq!(
        rig.strategy(Strategy::Accel)
            .fits("M68 E0 Q0.9\nM66 P0 L0\nG0 X400\nG0 X401\nM2\n"),
        "M68 E0 Q0.9\nM66 P0 L0\nM68 E0 Q0.799\nM66 P0 L0\nG0 X400\nM68 E0 Q0.9\nM66 P0 L0\nG0 X401\nM2\n"
    );
}

/// A short rapid is sooner with a lower speed than with 20 ms for the words.
#[test]
fn the_time_of_a_change_counts() {
    let rig = Rig {
        rest: "[outputs]\nacceleration = 2\nchange_s = 5",
        ..HAL
    };
    let text = rig.fits("G64\nG0 X400\nG1 X401 F100\nM2\n");
    assert!(
        !text.contains("M68") && text.contains("G1 X400 F"),
        "{text}"
    );
}

#[test]
fn a_line_that_runs_again_carries_its_own_words() {
    let text = HAL.fits(
        "G64\nF100\no1 repeat [3]\nG0 X400\nG1 X401 F100\nG0 X0\nG1 X1 F100\no1 endrepeat\nM2\n",
    );
    let sets = text.matches("M68 E2 Q0.").count();
    assert_eq!(sets, 2, "{text}");
    assert_eq!(text.matches("M68 E2 Q1\n").count(), 2, "{text}");
}

#[test]
fn nothing_comes_between_blocks_under_compensation() {
    let program = "G64\nG1 F1000 X0 Y0\nG41.1 D6\nG1 X10 Y10\nG0 X400\nG1 X400 Y50\nG40\nM2\n";
    let (text, _) = HAL.limit(program.as_bytes()).expect("a program");
    let text = String::from_utf8(text).expect("text");
    let between = text.split("G41.1").nth(1).expect("the compensation");
    let between = between.split("G40").next().expect("its end");
    assert!(!between.contains("M68"), "{text}");
}

/// Without the wiring nothing is written, and the strategy is refused.
#[test]
fn an_output_acts_only_where_it_is_wired() {
    let rig = Rig { rest: "", ..HAL };
    let text = rig.fits("G64\nG0 X400\nG1 X401 F100\nM2\n");
    assert!(!text.contains("M68"), "{text}");
    let refused = rig.strategy(Strategy::Accel).limit(b"G0 X400\nM2\n");
    assert!(format!("{refused:?}").contains("no word for acceleration"));
    // Another output than the one that is wired says nothing of accelerations.
    HAL.fits("M68 E1 Q0.5\nG0 X400\nM67 E1 Q7\nG0 X0\nM2\n");
}

#[test]
fn words_that_leave_the_acceleration_open_are_refused() {
    let rig = Rig { peak_w: 1e6, ..HAL };
    for (program, reason) in [
        (
            "M67 E2 Q0.5\nG0 X400\nM2\n",
            "knob-value: M67 changes the acceleration of blocks",
        ),
        (
            "M68 E2 Q0\nM66 P0 L0\nG0 X400\nM2\n",
            "knob-value: the share of the acceleration is not",
        ),
        (
            "M68 E2 Q1.5\nM66 P0 L0\nG0 X400\nM2\n",
            "knob-value: the share of the acceleration is not",
        ),
        (
            "M68 E2\nM66 P0 L0\nG0 X400\nM2\n",
            "knob-value: the share of the acceleration is not",
        ),
        (
            "M68 E2 Q0.5\nG0 X400\nM2\n",
            "knob-value: whether the acceleration that M68 has set",
        ),
        (
            "M68 E2 Q0.5\nG4 P1\nG1 X400 F100\nM2\n",
            "knob-value: whether the acceleration that M68 has set",
        ),
        (
            "G1 F1000 X0 Y0\nG41.1 D6\nG1 X10 Y10\nM68 E2 Q0.5\nM66 P0 L0\nG1 X20\nG40\nM2\n",
            "knob-value: the acceleration changes under cutter compensation",
        ),
        (
            "G1 F1000 X0 Y0\nM68 E2 Q0.5\nG41.1 D6\nM66 P0 L0\nG1 X10 Y10\nG1 X20\nG40\nM2\n",
            "knob-value: the acceleration changes under cutter compensation",
        ),
    ] {
        let said = rig.first_refusal(program);
        assert!(said.starts_with(reason), "{program}: {said}");
    }
}

/// A control that has no such word cannot have it wired.
#[test]
fn only_linuxcnc_has_it() {
    let text = format!(
        "schema = 1\nname = \"m\"\ncontroller = \"iso\"\n[converter]\npeak_power_w = 1000\n{WIRED}\n\
         [axes.X]\nrapid_mm_min = 30000\naccel_mm_s2 = 5000\nmass_kg = 500\n"
    );
    let found = Machine::from_toml("m.toml", &text).expect_err("a mistake");
    let found = format!("{found:?}");
    assert!(
        found.contains("the controller `iso` has no word for an output that acts on accelerations"),
        "{found}"
    );
}

/// G61.1 needs what was in force written back; in exact stop by the machine nothing does.
#[test]
fn exact_stop_by_the_machine_needs_no_further_word() {
    let rig = Rig {
        rest: "[outputs]\nacceleration = 2\n[path]\nmode = \"exact-stop\"",
        ..HAL
    };
    assert!(rig.rest.contains(EXACT_STOP));
    let text = rig.strategy(Strategy::Accel).fits("/G0 X400\n/G0 X0\nM2\n");
    assert!(
        text.contains("/M68 E2 Q0.") && text.contains("/M66 P0 L0"),
        "{text}"
    );
    assert!(!text.contains("G61.1"), "{text}");
}
