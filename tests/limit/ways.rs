//! Programs that can go on in several ways: blocks that may be skipped, and probes that
//! touch or do not. One change is right for all of them.

use std::fmt::Write as _;
use std::io::Cursor;

use super::reader::read;
use super::{EXACT_STOP, RIG, Rig, options};
use gwatt::interpret::{BlockDelete, ProbeResult, ProbeWay};
use gwatt::pipeline::{LimitOptions, LimitSummary, Options, analyze};
use proptest::prelude::*;

use crate::runs::{self, WITH_FEEDS};

/// The program as a control reads it with these switches on.
fn with_switches(program: &str, on: &[&str]) -> String {
    let mut read = String::new();
    for line in program.lines() {
        let level = match line.as_bytes() {
            [b'/', digit @ b'1'..=b'9', ..] => &line[1..=usize::from(digit.is_ascii_digit())],
            [b'/', ..] => "1",
            _ => "",
        };
        if level.is_empty() {
            let _ = writeln!(read, "{line}");
        } else if !on.contains(&level) {
            let _ = writeln!(read, "{}", line[1..].trim_start_matches(level));
        }
    }
    read
}

/// No switch, the first, the second, both.
const SETTINGS: [&[&str]; 4] = [&[], &["1"], &["2"], &["1", "2"]];

/// The written program moves as the original does, no faster, and fits, whatever switches
/// are on. How many lines that may be skipped were changed.
fn holds_either_way(rig: &Rig, program: &str, text: &str) -> Result<usize, TestCaseError> {
    for on in SETTINGS {
        let [before, after] = [program, text].map(|text| read(&with_switches(text, on)));
        prop_assert_eq!(before.len(), after.len(), "{:?}\n{}\n{}", on, program, text);
        for (before, after) in before.iter().zip(&after) {
            prop_assert_eq!(
                before.path(),
                after.path(),
                "{:?}\n{}\n{}",
                on,
                program,
                text
            );
            let slower = match (before.feed, after.feed) {
                (Some(before), Some(after)) => after <= before,
                (None, _) => true,
                (Some(_), None) => false,
            };
            prop_assert!(slower, "{:?}\n{}\n{}", on, program, text);
        }
        let mut options = options(rig.options);
        for level in on {
            let switches = options.reading.block_delete;
            options.reading.block_delete = switches.with(level.parse().expect("a digit"));
        }
        let summary = analyze(Cursor::new(text), &rig.machine(), &options, None).expect("read");
        prop_assert!(summary.fits(), "{:?} {:?}\n{}", on, summary.unfit, text);
    }
    let skipped = |text: &str| -> Vec<String> {
        let lines = text.lines().filter(|line| line.starts_with('/'));
        lines.map(str::to_owned).collect()
    };
    let before = skipped(program);
    Ok(skipped(text)
        .iter()
        .filter(|line| !before.contains(line))
        .count())
}

/// A program of lines, each with its level of block delete (0: none), the place in X or Y
/// in mm, and perhaps a motion word and an F.
fn program(lines: &[(u8, bool, i16, u8, u16)]) -> String {
    let mut program = "G21 G90\nG1 F600 X0\n".to_owned();
    for (level, along_x, to, word, feed) in lines {
        program.push_str(["", "/", "/2"][usize::from(*level)]);
        // The last words decide: mostly they are there.
        program.push_str(["G0", "G1", "G0", "G1", ""][usize::from(*word)]);
        let _ = write!(program, " {}{to}", if *along_x { 'X' } else { 'Y' });
        if *feed > 20_000 {
            let _ = write!(program, " F{feed}");
        }
        program.push('\n');
    }
    program.push_str("M30\n");
    program
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn random_programs_hold_with_blocks_and_without(
        lines in prop::collection::vec(
            (0..3_u8, any::<bool>(), -900..900_i16, 0..5_u8, 0..40_000_u16), 1..9
        ),
    ) {
        let program = program(&lines);
        let (text, summary) = RIG.limit(program.as_bytes()).expect("a program");
        let text = String::from_utf8(text).expect("text");
        if summary.certified {
            // Else the warning says that it holds only as the switches were asked for.
            let notes = &summary.before.notes;
            if !notes.iter().any(|note| note.rule == "holds-one-way") {
                holds_either_way(&RIG, &program, &text)?;
            }
        }
    }
}

/// With explicit words each line is right by itself, so nearly all can be made to fit.
#[test]
fn lines_that_may_be_skipped_are_lowered() {
    let program =
        "G21 G90\nG1 F600 X0 Y0\n/G0 X400\n/2G1 X0 F600\nG0 X400 Y300\n/ Y0\nG0 X0\nM30\n";
    let text = RIG.fits(program);
    assert_eq!(
        text,
        "G21 G90\nG1 F600 X0 Y0\n/G1 X400 F24000\n/G0 F600\n/2G1 X0 F600\n\
         G1 X400 Y300 F19200\nG0 F600\n/ G1 Y0 F24000\n/G0 F600\nG1 X0 F24000\nG0 F600\nM30\n"
    );
    let changed = holds_either_way(&RIG, program, &text).expect("it holds");
    assert_eq!(changed, 4);
}

/// A block after one that may be skipped has the motion word, or the F, of either.
#[test]
fn what_depends_on_a_skipped_word_is_refused() {
    let differs = "it runs under feeds or modes that differ";
    for program in [
        "G21 G90\nG1 F600 X0\n/G0 X400\nX1\nM30\n",
        // Where the block before is skipped this one moves nothing, but is no rapid either.
        "G21 G90\nG1 F600 X0\n/G0 X400\nX0\nY9\nM30\n",
    ] {
        let reasons = RIG.reasons(program);
        let differ = reasons.iter().any(|it| it.message.contains(differs));
        assert!(differ, "{reasons:?}");
    }
    // What can be written for the switches that were asked for is, with a warning.
    let program = "G21 G90\nG1 F600 X0\n/G1 X9 F700\nG0 X400\nM30\n";
    let (text, summary) = RIG.limit(program.as_bytes()).expect("a program");
    assert!(summary.certified && String::from_utf8_lossy(&text).contains("G1 X400 F"));
    let warning = &summary.before.notes[0];
    assert_eq!((warning.rule, warning.line), ("holds-one-way", 4));
    assert!(warning.message.contains(differs), "{}", warning.message);
    // Without its only block there is no program, and nothing to be looked at.
    let (_, summary) = RIG.limit(b"/G0 X4\n").expect("a program");
    assert!(summary.certified && summary.before.notes.is_empty());
}

/// A program that cannot be read without these blocks is limited as it was asked for.
#[test]
fn a_program_that_is_only_read_one_way_says_so() {
    let program = "G21 G90\n/G1 F600\nG1 X9\nG0 X400\nM30\n";
    let (_, summary) = RIG.limit(program.as_bytes()).expect("a program");
    assert!(summary.certified);
    let warning = &summary.before.notes[0];
    assert_eq!(warning.rule, "holds-one-way");
    assert!(
        warning
            .message
            .ends_with("otherwise a feed move, but no F is in force")
    );
}

const MILL: Rig = Rig {
    controller: "linuxcnc",
    rest: EXACT_STOP,
    ..RIG
};

fn probing() -> Options {
    let mut options = options(MILL.options);
    options.reading.probe = Some(ProbeResult::Either(ProbeWay::default()));
    options
}

fn limited(program: &str) -> (String, LimitSummary) {
    let how = LimitOptions {
        strategy: MILL.options.strategy,
        law: MILL.options.law,
        ..WITH_FEEDS
    };
    runs::limited(&MILL.machine(), &probing(), how, program).expect("a program")
}

/// On the first way X alone runs, on the second X and Y at once, on the third Y.
const PROBES: &str = "G21 G90\nG38.3 Y-2 F60\no1 if [#5070 EQ 1]\nG0 X400\no1 else\n\
                      G38.3 Y-4\no2 if [#5070]\nG91 G0 X-400 Y300\no2 else\nG0 Y500\no2 endif\no1 endif\nM2\n";

#[test]
fn each_result_of_a_probe_is_followed() {
    let machine = MILL.machine();
    let summary = analyze(Cursor::new(PROBES), &machine, &probing(), None).expect("read");
    let lines: Vec<u64> = summary.unfit.iter().map(|it| it.line).collect();
    assert_eq!(lines, [4, 8, 10]);
    assert_eq!(summary.peak_line, 8);
    assert!(
        summary.conditions.iter().any(|it| it.contains("3 ways")),
        "{:?}",
        summary.conditions
    );
    let (text, summary) = limited(PROBES);
    assert!(summary.certified, "{:?}", summary.reasons);
    for way in ["G1 X400 F24000", "G1 Y500 F24000"] {
        assert!(text.contains(way), "{text}");
    }
    let summary = analyze(Cursor::new(text), &machine, &probing(), None).expect("read");
    assert!(summary.fits());
}

/// The parameter is asked for once a probe; a probe whose result nobody asks for opens no
/// second way, nor does one that stops the program where it finds nothing.
#[test]
fn only_results_that_are_asked_for_open_ways() {
    for probe in ["G38.3 Y-2 F60\n", "G38.2 Y-2 F60\n#1=#5070\n"] {
        let program = format!("G21 G90\n{}G0 X10\nM2\n", probe.repeat(70));
        let program = program.replace("Y-2", "G91 Y-2");
        let summary = analyze(Cursor::new(program), &MILL.machine(), &probing(), None);
        assert!(
            !summary
                .expect("read")
                .conditions
                .iter()
                .any(|it| it.contains("ways"))
        );
    }
    let often = format!(
        "G21 G91\n{}M2\n",
        "G38.3 Y-2 F60\n#1=[#5070+#5070]\n".repeat(6)
    );
    let summary = analyze(Cursor::new(often), &MILL.machine(), &probing(), None).expect("read");
    assert!(
        summary.conditions.iter().any(|it| it.contains("64 ways")),
        "{:?}",
        summary.conditions
    );
    let more = format!("G21 G91\n{}M2\n", "G38.3 Y-2 F60\n#1=#5070\n".repeat(7));
    let refused = analyze(Cursor::new(more), &MILL.machine(), &probing(), None);
    assert!(
        format!("{refused:?}").contains("in more than 64 ways"),
        "{refused:?}"
    );
}

/// A way that cannot be read refuses the program, and says which it is.
#[test]
fn a_refusal_names_its_way() {
    let program = "G38.3 Y-2 F60\no1 if [#5070 EQ 0]\nG0 X#5061\nG0 Q1\no1 endif\nM2\n";
    let refused = format!(
        "{:?}",
        analyze(Cursor::new(program), &MILL.machine(), &probing(), None)
    );
    assert!(
        refused.contains("this is so where the probes find: miss"),
        "{refused}"
    );
}

/// Every way comes once, and no other: of `n` answers without a condition 2ⁿ.
#[test]
fn ways_are_counted_through() {
    let mut seen = Vec::new();
    let mut next = Some(ProbeWay::default());
    while let Some(way) = next {
        let answers: Vec<bool> = (0..5).map(|answer| way.misses(answer)).collect();
        assert!(!seen.contains(&answers));
        seen.push(answers);
        next = way.next(5);
    }
    assert_eq!(seen.len(), 32);
    assert_eq!(ProbeWay::default().next(0), None);
    assert!(BlockDelete::NONE.turned(2).passes(2) && !BlockDelete::ALL.turned(1).passes(1));
}

/// Firmware without block delete executes all blocks: one setting, and they are lowered as
/// any other.
#[test]
fn controls_without_block_delete_have_one_setting() {
    let rig = Rig {
        controller: "grbl",
        ..RIG
    };
    let (_, summary) = rig.limit(b"/G0 X400\n").expect("a program");
    assert!(summary.certified && summary.edited_lines > 0);
    let said = summary
        .before
        .conditions
        .iter()
        .any(|it| it.contains("executed or skipped"));
    assert!(!said, "{:?}", summary.before.conditions);
}
