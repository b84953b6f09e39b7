//! Moves that only the firmware knows: words before them lower its limits.

use gwatt::pipeline::{LimitOptions, Options};

use crate::machines::{linear_axes, machine_from};
use crate::runs::{WITH_FEEDS, limited, made_to_fit, summary_of};

fn text(controller: &str, peak_w: f64) -> String {
    let home = "reference_mm = 0\nreference_mm_min = 600";
    format!(
        "schema = 1\nname = \"test\"\ncontroller = \"{controller}\"\n\
         [converter]\npeak_power_w = {peak_w:?}\n[limits]\nmargin = 0.0\n{}{}{}",
        linear_axes("XY", [12000.0, 1000.0, 1.0], home),
        linear_axes("Z", [600.0, 100.0, 1.0], home),
        linear_axes("E", [3000.0, 1000.0, 0.1], "")
    )
}

const PROGRAM: &str = "M203 X150 Y150 Z8 E40\nG28\nG29\nG1 X0 Y-2 Z3 F2400\nG1 X50 F6000\n";

/// Marlin's planner holds M201 and M203 for the moves of G29 too; the line itself stays.
#[test]
fn probing_fits_by_words_before_it() {
    let own = summary_of(&machine_from(&text("marlin", 1e6)), PROGRAM).peak_w;
    for share in [0.4, 0.6, 0.8] {
        let machine = machine_from(&text("marlin", share * own));
        let how = LimitOptions::USUAL;
        let (limited, summary) = made_to_fit(&machine, &Options::default(), how, PROGRAM);
        assert!(summary.after.peak_w <= share * own);
        assert!(limited.contains("\nG29\n"), "{limited}");
        let others = |text: &str| -> Vec<String> {
            let lines = text.lines().filter(|line| !line.starts_with("M20"));
            lines.map(str::to_owned).collect()
        };
        assert_eq!(others(&limited), others(PROGRAM), "{limited}");
        let again = made_to_fit(&machine, &Options::default(), how, &limited);
        assert_eq!(again.0, limited);
    }
}

/// RepRapFirmware runs a file of the machine for it, which may set limits itself.
#[test]
fn files_of_the_machine_are_not_lowered() {
    let program = "G28\nG32\nG1 X50 F6000\n";
    let own = summary_of(&machine_from(&text("reprap", 1e6)), program).peak_w;
    let machine = machine_from(&text("reprap", 0.5 * own));
    let (_, summary) =
        limited(&machine, &Options::default(), WITH_FEEDS, program).expect("a program");
    let reasons: Vec<_> = summary
        .reasons
        .iter()
        .map(|it| it.message.as_str())
        .collect();
    assert!(!summary.certified);
    assert!(
        reasons
            .iter()
            .any(|it| it.contains("the machine runs a file or a macro of its own for it")),
        "{reasons:?}"
    );
    // Nor do limits that the program has set hold in it.
    let before = summary_of(&machine, program).peak_w;
    let lower = summary_of(&machine, &format!("M203 X60 Y60 Z6 E6\n{program}")).peak_w;
    assert_eq!(before, lower);
}

/// Lines that end in CR CR LF: what is inserted ends so too, and joins no lines.
#[test]
fn line_ends_of_two_conversions_are_kept() {
    let machine = machine_from(&text("klipper", 0.1));
    let program = "G28\r\r\nG1 X0 Y0 F600\r\r\nG1 X100 Y100 F12000\r\r\nG1 X0 F600\r\r\n";
    let (limited, summary) = made_to_fit(&machine, &Options::default(), WITH_FEEDS, program);
    assert!(summary.edited_lines > 0);
    assert_eq!(
        limited.matches("\r\r\n").count(),
        limited.matches('\n').count()
    );
    assert!(
        limited.replace("\r\r\n", "").find('\r').is_none(),
        "{limited:?}"
    );
}
