//! Corners by values that programs set: M205, M566.

use super::*;
use crate::runs::summary_of;

/// Short lines to and fro along X and Y, which corners decide.
fn zigzag() -> String {
    (0..40).fold("G28\n".to_owned(), |mut text, number| {
        let _ = writeln!(text, "G1 X{} Y{} F6000", number + 1, number % 2);
        text
    })
}

/// A machine whose corners are by this rule.
fn by(controller: &str, rule: &str) -> Machine {
    machine_with(controller, &format!("[look_ahead.{rule}\n"))
}

/// What a program sets is planned as if the machine file had it.
#[track_caller]
fn same(controller: &str, rules: [&str; 2], word: &str) {
    let [own, set] = rules.map(|rule| by(controller, rule));
    let program = zigzag();
    let figures = |machine: &Machine, program: &str| {
        let found = summary_of(machine, program);
        (found.duration_s, found.peak_w)
    };
    let expected = figures(&set, &program);
    assert_ne!(expected, figures(&own, &program), "{word}");
    let after_home = program.replacen("G28\n", &format!("G28\n{word}\n"), 1);
    assert_eq!(figures(&own, &after_home), expected, "{word}");
}

#[test]
fn classic_jerk() {
    let rule = |step: &str| {
        format!("classic_jerk]\nstep_mm_s = {{ X = {step}, Y = {step}, Z = 1, E = 5 }}")
    };
    let (slow, fast) = (rule("2"), rule("30"));
    same("marlin", [&slow, &fast], "M205 X30 Y30");
    same("marlin", [&fast, &slow], "M205 X2 Y2");
}

#[test]
fn junction_deviation() {
    let rule = |deviation: &str| {
        format!(
            "junction_deviation]\ndeviation_mm = {deviation}\nper_axis = true\nblock_accel = true\nsmall_block_mm = 1"
        )
    };
    let (slow, fast) = (rule("0.02"), rule("0.2"));
    same("marlin", [&slow, &fast], "M205 J0.2");
    // Marlin refuses values outside of 0.01 to 0.3.
    let figures = |program: &str| summary_of(&by("marlin", &slow), program).duration_s;
    let program = zigzag();
    assert_eq!(
        figures(&program.replacen("G28\n", "G28\nM205 J0.5\n", 1)),
        figures(&program)
    );
}

#[test]
fn steps_of_reprapfirmware() {
    let rule = |step: &str| {
        format!(
            "speed_step]\nstep_mm_s = {{ X = {step}, Y = {step}, Z = 1, E = 5 }}\nsame_kind_only = true"
        )
    };
    let (slow, fast) = (rule("2"), rule("30"));
    same("reprap", [&slow, &fast], "M566 X1800 Y1800");
    same("reprap", [&slow, &fast], "M205 X30 Y30");
}
