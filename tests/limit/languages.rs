//! Programs that are read as another control than the machine's own reads them.

use gwatt::machine::{Machine, builtin_controller};
use gwatt::pipeline::{LimitOptions, LimitSummary, Options, Strategy};

use crate::machines::machine_from;
use crate::runs::{self, WITH_FEEDS};

/// 2500 W by X at full speed and force, which 1000 W are not enough for.
fn machine(controller: &str, dialect: &str) -> Machine {
    let text = format!(
        "schema = 1\nname = \"test\"\ncontroller = \"{controller}\"\n[converter]\n\
         peak_power_w = 1000\n[limits]\nmargin = 0\n[path]\nmode = \"exact-stop\"\n\
         [axes.X]\nrapid_mm_min = 30000\naccel_mm_s2 = 5000\nmass_kg = 1000\n\
         [axes.Y]\nrapid_mm_min = 30000\naccel_mm_s2 = 5000\nmass_kg = 500\n"
    );
    let mut machine = machine_from(&text);
    machine.controller.language = builtin_controller(dialect).expect("a profile").language;
    machine
}

fn limited(machine: &Machine, strategy: Strategy) -> Result<(String, LimitSummary), String> {
    let how = LimitOptions {
        strategy,
        ..WITH_FEEDS
    };
    let program = "G21\nG90\nG1 X400 F30000\nG1 X0 F30000\n";
    let found = runs::limited(machine, &Options::default(), how, program);
    found.map_err(|failure| failure.to_string())
}

/// Words that the dialect does not read are not written; feeds are.
#[test]
fn words_that_are_not_read_are_not_written() {
    for (controller, dialect, unread) in [
        ("isg", "marlin", "G131, G231, G129"),
        (
            "klipper",
            "grbl",
            "SET_VELOCITY_LIMIT ACCEL, SET_VELOCITY_LIMIT MINIMUM_CRUISE_RATIO, \
             SET_VELOCITY_LIMIT VELOCITY",
        ),
        ("marlin", "klipper", "M201, M203"),
        // It reads it, in mm/min where Marlin has mm/s.
        ("marlin", "reprap", "M203"),
    ] {
        let machine = machine(controller, dialect);
        let (text, summary) = limited(&machine, Strategy::Optimal).expect("a program");
        assert!(summary.certified, "{controller}: {:?}", summary.reasons);
        let mut notes = summary.before.notes.iter();
        let note = notes
            .find(|note| note.rule == "unread-word")
            .expect(dialect);
        assert_eq!(
            note.message,
            format!(
                "programs are read as `{dialect}` reads them, which does not have {unread} as \
                 `{controller}` does: it is not written"
            )
        );
        if dialect == "reprap" {
            // M201 is the same.
            assert!(text.contains("M201 X") && !text.contains("M203"), "{text}");
            continue;
        }
        if controller == "isg" {
            // G130 and G230 are.
            assert!(text.contains("G130 X"), "{text}");
            continue;
        }
        assert!(text.contains("G1 X400 F"), "{text}");
        assert_eq!(
            limited(&machine, Strategy::Accel).expect_err("no word is left"),
            format!(
                "--strategy accel: the controller `{controller}` has no word for acceleration \
                 that `{dialect}` reads; use speed or optimal"
            )
        );
    }
}

/// Those that it reads are.
#[test]
fn words_that_are_read_are_written() {
    let (text, summary) = limited(&machine("isg", "iso"), Strategy::Accel).expect("a program");
    assert!(summary.certified);
    let unread = |rule: &str| rule == "unread-word";
    assert!(!summary.before.notes.iter().any(|note| unread(note.rule)));
    assert!(text.contains("G131 = 39.9\n"), "{text}");
}
