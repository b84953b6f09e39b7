//! Programs whose lines run more than once: one change for all runs of a line.

use super::RIG;
use gwatt::pipeline::Strategy;

/// A loop over a rapid and a feed: each is changed once, and put back at once.
#[test]
fn a_line_in_a_loop_gets_one_change_and_puts_it_back() {
    let program = "\
O1
#1=3
WHILE [#1 GT 0] DO1
G1 X[400-#1*10] F60000
X0
G0 X300
G1 X0 F600
#1=#1-1
END1
M30
";
    let (text, summary) = RIG
        .strategy(Strategy::Speed)
        .limit(program.as_bytes())
        .expect("a program");
    assert!(summary.certified, "{:?}", summary.reasons);
    assert_eq!(summary.before.moves, 12);
    assert_eq!(summary.after.moves, 12);
    assert!(summary.after.fits());
    let text = String::from_utf8(text).expect("text");
    let words: Vec<&str> = text.lines().collect();
    // After each changed line stands what puts its words back.
    assert_eq!(words[0..3], ["O1", "#1=3", "WHILE [#1 GT 0] DO1"]);
    assert!(words[3].starts_with("G1 X[400-#1*10] F"), "{text}");
    assert_eq!(words[4], "F60000");
    assert!(words[5].starts_with("X0 F"), "{text}");
    assert_eq!(words[6], "F60000");
    assert!(words[7].starts_with("G1 X300 F"), "{text}");
    assert_eq!(words[8], "G0 F60000");
    assert_eq!(words[9..], ["G1 X0 F600", "#1=#1-1", "END1", "M30"]);
}

/// A subprogram that runs under different feeds gets the lowest of both, or less.
#[test]
fn runs_that_differ_get_the_lowest_feed() {
    let program = "O1\nF60000\nM98 P2\nF50000\nM98 P2\nM30\nO2\nG1 X400\nX0\nM99\n";
    let (text, summary) = RIG
        .strategy(Strategy::Speed)
        .limit(program.as_bytes())
        .expect("a program");
    assert!(summary.certified, "{:?}", summary.reasons);
    let text = String::from_utf8(text).expect("text");
    let (main, sub) = text.split_once("O2\n").expect("a subprogram");
    assert_eq!(main, "O1\nF60000\nM98 P2\nF50000\nM98 P2\nM30\n");
    let feeds: Vec<f64> = sub
        .lines()
        .filter_map(|line| line.split_once(" F")?.1.parse().ok())
        .collect();
    assert!(
        feeds.len() == 2 && feeds.iter().all(|feed| *feed <= 50_000.0),
        "{text}"
    );
}

/// With one feed in force for all calls, the subprogram is edited.
#[test]
fn runs_that_agree_are_edited() {
    let program = "O1\nF60000\nM98 P2 L2\nX10\nM98 P2\nM30\nO2\nG1 X400\nX0\nM99\n";
    let (text, summary) = RIG
        .strategy(Strategy::Speed)
        .limit(program.as_bytes())
        .expect("a program");
    assert!(summary.certified, "{:?}", summary.reasons);
    let text = String::from_utf8(text).expect("text");
    assert!(text.contains("O2\nG1 X400 F"), "{text}");
}

/// The worst moves list a line once, with the number of its runs.
#[test]
fn a_line_is_listed_once_among_the_worst() {
    let program = "O1\nM98 P2 L5\nM30\nO2\nG1 X400 F60000\nX0\nM99\n";
    let (_, summary) = RIG.limit(program.as_bytes()).expect("a program");
    let before = &summary.before;
    assert_eq!(before.unfit_count, 10);
    let worst: Vec<_> = before
        .worst
        .iter()
        .map(|unfit| (unfit.line, unfit.runs))
        .collect();
    assert_eq!(worst, [(5, 5), (6, 5)]);
}

/// A rapid that keeps its stops as a feed has one before it, whatever line
/// stands above: one that was not edited, or one that another place jumps over.
#[test]
fn stops_do_not_depend_on_the_line_above() {
    let rig = super::Rig {
        controller: "linuxcnc",
        ..RIG
    };
    for program in [
        "o1 sub\no1 endsub\nF1200\nG0 X400\nG1 X1\nG0 X401 Y300\nM2\n",
        "o1 sub\nG0 X400\nG0 X1\no1 endsub\nF1200\no1 call\nG1 X9\no1 call\nM2\n",
    ] {
        let text = rig.fits(program);
        let lines: Vec<&str> = text.lines().collect();
        for (index, line) in lines.iter().enumerate() {
            let edited = line.starts_with("G1 ") && !program.contains(line);
            if edited {
                assert_eq!(lines[index - 1], "G4 P0", "{text}");
                assert_eq!(lines[index + 1], "G4 P0", "{text}");
            }
        }
        assert!(text.contains("G4 P0"), "{text}");
    }
}
