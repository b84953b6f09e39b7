//! `--mark-rapids`: rapids that are written as feeds say so, and are lowered again as what
//! they stand for.

mod again;

use gwatt::machine::Machine;
use gwatt::pipeline::{Failure, LimitOptions, LimitSummary, Options, RapidMark, Strategy};

use super::{RIG, Rig};
use crate::runs::limited;

/// Limits with the usual mark, and cutting feeds as they are.
pub(super) fn marking(
    machine: &Machine,
    how: LimitOptions,
    mark: &str,
    program: &str,
) -> Result<(String, LimitSummary), Failure> {
    let options = Options {
        rapid_mark: (!mark.is_empty()).then(|| RapidMark::new(mark).expect("a mark")),
        ..Options::default()
    };
    limited(machine, &options, how, program)
}

/// A program that fits in the end.
#[track_caller]
fn fits(rig: Rig, program: &str) -> (String, u64) {
    let done = marking(&rig.machine(), LimitOptions::USUAL, "RAPID", program);
    let (text, summary) = done.expect("a program");
    assert!(summary.certified, "{text}: {:?}", summary.reasons);
    (text, summary.edited_lines)
}

/// Why one does not.
#[track_caller]
fn reasons(rig: Rig, mark: &str, program: &str) -> Vec<(u64, &'static str)> {
    let done = marking(&rig.machine(), LimitOptions::USUAL, mark, program);
    let (_, summary) = done.expect("a program");
    assert!(!summary.certified);
    let reasons = summary.reasons.iter();
    reasons.map(|reason| (reason.line, reason.rule)).collect()
}

fn rig(controller: &'static str, peak_w: f64) -> Rig {
    Rig {
        controller,
        peak_w,
        rest: "[path]\nmode = \"exact-stop\"\nrapid = \"linear\"",
        ..RIG
    }
}

/// X alone takes v·500 kg·5 m/s²: 1000 W are 0.4 m/s (F24000), 800 W are 0.32 m/s (F19200).
#[test]
fn a_written_program_is_limited_again() {
    let program = "G21 G90\nG0 X400\nX0\nG1 Y1 F1000\nG0 X400 (out)\nX399\nG1 Y2\nM30\n";
    let (first, edited) = fits(rig("iso", 1000.0), program);
    assert_eq!(
        first,
        "G21 G90\nG1 X400 F24000 (RAPID)\nX0 (RAPID)\nG1 Y1 F1000\n\
         G1 X400 F24000 (RAPID) (out)\nG0 X399\nG1 Y2 F1000\nM30\n"
    );
    assert_eq!(edited, 5);
    // On the same converter, and on a larger one, every byte stays.
    for peak_w in [1000.0, 2000.0] {
        assert_eq!(fits(rig("iso", peak_w), &first), (first.clone(), 0));
    }
    assert_eq!(
        fits(rig("iso", 800.0), &first).0,
        "G21 G90\nG1 X400 F19200 (RAPID)\nX0 (RAPID)\nG1 Y1 F1000\n\
         G1 X400 F19200 (RAPID) (out)\nG0 X399\nG1 Y2 F1000\nM30\n"
    );
    // Without the option, or with another text, they are cutting feeds.
    let cutting = [2, 3, 5].map(|line| (line, "feed-not-allowed"));
    for mark in ["", "rapid", "RAPIDS"] {
        assert_eq!(reasons(rig("iso", 800.0), mark, &first), cutting);
    }
}

/// What is not marked stays what it is: other feeds, and arcs whatever they say.
#[test]
fn only_marked_lines_count() {
    let program = "G1 X400 F24000\nX0 (RAPID)\nX400 (rapid)\nG2 X0 I-200 (RAPID)\nM30\n";
    let cutting = [1, 3, 4].map(|line| (line, "feed-not-allowed"));
    assert_eq!(reasons(rig("iso", 600.0), "RAPID", program), cutting);
}

/// No floor of `[limits]` holds a rapid.
#[test]
fn floors_are_those_of_cutting() {
    let floors = Rig {
        rest: "min_feed_mm_min = 22000\n[path]\nmode = \"exact-stop\"",
        ..rig("iso", 800.0)
    };
    let (text, _) = fits(floors, "G1 X400 F24000 (RAPID)\n");
    assert_eq!(text, "G1 X400 F19200 (RAPID)\nF24000\n");
}

#[test]
fn each_language_has_its_comment() {
    let cases = [
        ("iso", "N1G0X400;go\n", "N1G1X400F24000(RAPID);go\n"),
        ("iso", "G0 X400(go)\n", "G1 X400 F24000 (RAPID) (go)\n"),
        (
            "haas",
            "G0 X400. (go)\r\n",
            "G1 X400. F24000. (RAPID) (go)\r\n",
        ),
        ("grbl", "g0 x400\n", "g1 x400 f24000 (RAPID)\n"),
        // The last comment is the one that acts.
        (
            "linuxcnc",
            "G0 X400 (MSG, go)\n",
            "G1 X400 F24000 (RAPID) (MSG, go)\n",
        ),
        (
            "linuxcnc",
            "(MSG, go) G0 X400\n",
            "(RAPID) (MSG, go) G1 X400 F24000\n",
        ),
        ("siemens", "N1 G0 X400\n", "N1 G1 X400 F24000 ; RAPID\n"),
        (
            "siemens",
            "G0 X=IC(400) ; go\n",
            "G1 X=IC(400) F24000 ; RAPID ; go\n",
        ),
    ];
    for (controller, line, marked) in cases {
        let program = format!("{line}M30\n");
        let (text, _) = fits(rig(controller, 1000.0), &program);
        let first = text.lines().next().expect("a line");
        assert_eq!(first, marked.trim_end(), "{controller}");
        // Once, and still there when it is lowered again.
        let (again, _) = fits(rig(controller, 800.0), &text);
        let lowered = first.replace("24000", "19200");
        assert_eq!(again.lines().next(), Some(lowered.as_str()), "{controller}");
        assert_eq!(again.matches("RAPID").count(), 1, "{controller}");
    }
}

/// A line that has the comment already gets no second one; a stop stands on its own line.
#[test]
fn a_mark_stands_once() {
    let (text, _) = fits(rig("iso", 1000.0), "G0 X400 (RAPID)\nX0 M30");
    assert_eq!(text, "G1 X400 F24000 (RAPID)\nG0\nG1 X0 (RAPID)\nG0\nM30");
}

/// Lines that run again: the mark is in the table's one decision.
#[test]
fn subprograms_of_the_program_are_marked() {
    let program = "G0 X400\nM98 P10 L2\nM30\nO10\nG0 X0\nG0 X400\nM99\n";
    let (first, _) = fits(rig("fanuc", 1000.0), program);
    assert_eq!(first.matches(" (RAPID)\n").count(), 3, "{first}");
    let (again, _) = fits(rig("fanuc", 800.0), &first);
    // What was in force after such a line is put back: others may count on it.
    assert_eq!(
        again,
        first.replace("F24000. (RAPID)\n", "F19200. (RAPID)\nF24000.\n")
    );
    assert_eq!(fits(rig("fanuc", 800.0), &again), (again.clone(), 0));
}

/// The pieces of a feed that stands for a rapid say so as well, those of others do not.
#[test]
fn pieces_are_marked() {
    let printer = Rig {
        controller: "reprap",
        peak_w: 800.0,
        ..RIG
    };
    let split = LimitOptions {
        strategy: Strategy::Split,
        ..LimitOptions::USUAL
    };
    let program = "G1 X300 F30000 ; RAPID\nG1 X200 Y180\n";
    let done = marking(&printer.machine(), split, "RAPID", program);
    let (text, summary) = done.expect("a program");
    assert!(summary.certified, "{:?}", summary.reasons);
    let feeds = text.lines().filter(|line| line.starts_with("G1 X"));
    let (first, second): (Vec<&str>, Vec<&str>) = feeds.partition(|line| !line.contains('Y'));
    assert!(first.len() > 1 && second.len() > 1, "{text}");
    assert!(
        first.iter().all(|line| line.ends_with(" ; RAPID")),
        "{text}"
    );
    assert!(!second.iter().any(|line| line.contains(';')), "{text}");
}

/// Programs of a set that read marks otherwise could not share a file.
#[test]
fn programs_of_a_set_have_one_mark() {
    use gwatt::pipeline::{SetProgram, limit_set};
    let program = |mark: Option<RapidMark>| SetProgram {
        name: "a.nc".to_owned(),
        path: "a.nc".into(),
        text: b"G0 X1\nM30\n".to_vec().into(),
        options: Options {
            rapid_mark: mark,
            ..Options::default()
        },
    };
    let programs = [program(None), program(Some(RapidMark::default()))];
    let machine = rig("iso", 1000.0).machine();
    let refused = limit_set(&programs, &machine, LimitOptions::USUAL, None);
    let failure = refused.expect_err("two marks").failure;
    assert_eq!(
        failure.to_string(),
        "programs that share files take one mark for rapids"
    );
}
