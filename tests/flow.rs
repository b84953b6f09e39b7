//! The order of execution: calls, branches, loops, and where they stop.
//!
//! O-words: LinuxCNC, "O Codes"; M98, M99 and macros: B-63944EN, "Custom Macro".
//! What LinuxCNC makes of O-words is compared with it in `conformance.rs`; here
//! stand the messages, the limits and what must hold for any program.

mod random;

use std::io::Cursor;

use gwatt::diagnostic::Severity;
use gwatt::interpret::ParameterFile;
use gwatt::machine::Machine;
use gwatt::pipeline::{Failure, Limits, Options, moves};

use crate::machines::{linear_axes, machine_from};

fn machine(controller: &str, peak_w: f64) -> Machine {
    machine_from(&format!(
        "schema = 1\nname = \"test\"\ncontroller = \"{controller}\"\n[converter]\n\
         peak_power_w = {peak_w:?}\n[path]\nmode = \"exact-stop\"\n[limits]\nmargin = 0\n{}",
        linear_axes("XY", [30000.0, 5000.0, 500.0], "")
    ))
}

fn options(depth: usize, repeated_moves: u64, idle_lines: u64) -> Options {
    let mut options = Options::default();
    options.reading.parameters = Some(ParameterFile::default().into());
    options.reading.limits = Limits {
        depth,
        repeated_moves,
        idle_lines,
    };
    options
}

/// X and feed at the end of each move; or line, rule and message of the first
/// error.
fn run(controller: &str, program: &str, options: &Options) -> Result<Vec<(f64, f64)>, String> {
    let mut ends = Vec::new();
    let result = moves(
        Cursor::new(program),
        &machine(controller, 1e9),
        options,
        &mut |mv, _| {
            ends.push((mv.end[0], mv.feed_mm_s));
            Ok(())
        },
    );
    match result {
        Ok(_) => Ok(ends),
        Err(Failure::Refused { diagnostics, .. }) => {
            let mut found = diagnostics.iter();
            let found = found.find(|found| found.severity == Severity::Error);
            let found = found.expect("an error");
            Err(format!("{} {}: {}", found.line, found.rule, found.message))
        }
        Err(other) => panic!("{other}"),
    }
}

/// X at the end of each move.
fn ends(controller: &str, program: &str) -> Vec<f64> {
    let found = run(controller, program, &options(20, 1000, 1000));
    let ends = found.unwrap_or_else(|error| panic!("{error}\n{program}"));
    ends.into_iter().map(|(x, _)| x).collect()
}

#[track_caller]
fn fails(controller: &str, program: &str, expected: &str) {
    let found = run(controller, program, &options(20, 1000, 1000));
    assert_eq!(found, Err(expected.to_owned()), "{program}");
}

/// B-63944EN, "Branch and Repetition".
#[test]
fn loops_and_jumps_of_macros() {
    let program = "#1=1\nWHILE[#1 LE 3]DO1\nG0 X#1\n#1=#1+1\nEND1\nX9\nM30\n";
    assert_eq!(ends("iso", program), [1.0, 2.0, 3.0, 9.0]);
    let program = "#1=1\nWHILE[#1 LE 2]DO1\n#2=1\nWHILE[#2 LE 2]DO2\nG0 X[#1*10+#2]\n#2=#2+1\nEND2\n#1=#1+1\nEND1\nM30\n";
    assert_eq!(ends("iso", program), [11.0, 12.0, 21.0, 22.0]);
    let program = "#1=0\nN10 #1=#1+1\nG0 X#1\nIF[#1 LT 3]GOTO10\nGOTO30\nX99\nN30 X7\nM30\n";
    assert_eq!(ends("iso", program), [1.0, 2.0, 3.0, 7.0]);
    let program = "G0 X1\nDO1\n#1=#1+1\nIF[#1 GT 2]GOTO5\nX[#1*2]\nEND1\nN5 X0\nM30\n";
    assert_eq!(ends("iso", program), [1.0, 2.0, 4.0, 0.0]);
}

/// grbl's `$G` shows G0 at power-on; `FluidNC` ("Flow control") finds an O word
/// by its next partner, so that a label may serve again.
#[test]
fn grbl_begins_with_g0_and_labels_may_repeat() {
    let program = "X5\no1 if [1]\nX6\no1 endif\no1 repeat [2]\nG91 X1\no1 endrepeat\no1 if [0]\nX99\no1 else\nX2\no1 endif\n";
    let moves = "X5 X6 X7 X8 X10";
    let found = crate::listing::listing(program, &crate::listing::machine("grbl"), None);
    let ends: Vec<&str> = found
        .lines()
        .filter_map(|line| line.rsplit(' ').next())
        .collect();
    assert_eq!(ends.join(" "), moves, "{found}");
    assert!(
        found.lines().all(|line| line.contains(" rapid ")),
        "{found}"
    );
}

/// B-63944EN, "Subprogram (M98, M99)", "Macro Call": G65 and its letters.
#[test]
fn calls_of_programs_and_macros() {
    let program = "O1\nG0 X1\nM98 P2 L2\nX5\nM30\nO2\nG91 X10\nG90\nM99\n";
    assert_eq!(ends("iso", program), [1.0, 11.0, 21.0, 5.0]);
    let program = "O1\nG65 P9000 A3 B4\nG0 X[#1+1]\nM30\nO9000\nG0 X[#1*10+#2]\nM99\n";
    assert_eq!(ends("iso", program)[0], 34.0);
    // Without a value for #1 its caller reads 0 in brackets.
    assert_eq!(ends("iso", program)[1], 1.0);
    // M99 with a block number: the caller goes on there.
    let program = "O1\nM98 P2\nG0 X1\nN50 G0 X2\nM30\nO2\nG0 X9\nM99 P50\n";
    assert_eq!(ends("iso", program), [9.0, 2.0]);
}

/// B-63944EN, "Modal Call (G66)": the macro runs after each block that moves, to
/// G67. Haas mill operator's manual, "M97 Local Sub-Program Call": to a block of the
/// same program, L times.
#[test]
fn modal_calls_and_calls_of_blocks() {
    let program = "G0\nG66 P9 A3.\nX10.\nG67\nX30.\nM30\nO9\nX[#1+#5001]\nM99\n";
    assert_eq!(ends("fanuc", program), [10.0, 13.0, 30.0]);
    let program = "G0 X0.\nM97 P50 L2\nX5.\nM30\nN50 G91 X1.\nG90\nM99\n";
    assert_eq!(ends("haas", program), [0.0, 1.0, 2.0, 5.0]);
    let message = "2 unsupported-code: G66.1 is a macro call, which gwatt does not support";
    fails("fanuc", "G0 X1.\nG66.1 P9 A3.\nM30\n", message);
}

/// B-64304EN, "Subprogram Call" (M98 P Q): from a block on, of the own program without P,
/// K or L times, and back. Mitsubishi, "Subprogram Control": the word is H.
#[test]
fn calls_that_begin_at_a_block() {
    let program = "O1\nG0 X1.\nM98 Q100\nX2.\nM98 Q100 L2\nM30\nN100 G91 X10.\nG90\nM99\n";
    assert_eq!(ends("fanuc", program), [1.0, 11.0, 2.0, 12.0, 22.0]);
    let other = "O1\nM98 P2 Q20\nX9.\nM30\nO2\nN20 G0 X1.\nN30 G0 X2.\nM99\nO3\nN20 X77.\nM99\n";
    assert_eq!(ends("fanuc", &other.replace("Q20", "Q30")), [2.0, 9.0]);
    // Diameters.
    assert_eq!(
        ends("fanuc-lathe-b", &other.replace("Q20", "Q30")),
        [1.0, 4.5]
    );
    let by_h = other.replace("Q20", "H30");
    assert_eq!(ends("mitsubishi", &by_h), [2.0, 9.0]);
    // The short form of repeats and number.
    let short = other.replace("P2 Q20", "P20002 Q30");
    assert_eq!(ends("fanuc", &short), [2.0, 2.0, 9.0]);
    let fails = |program: &str, expected: &str| fails("fanuc", program, expected);
    fails(
        &other.replace("Q20", "Q40"),
        "2 no-such-block: there is no block N40 in the program that is called",
    );
    fails(
        &other.replace("N30", "N20"),
        "2 no-such-block: block N20 is called, which stands in lines 6 and 7 of its program",
    );
    fails(
        &other.replace("Q20", "Q2.5"),
        "2 subprogram: Q of M98 is not the number of a block",
    );
    fails(
        "O1\nM98 L2\nM30\n",
        "2 subprogram: a call without the number of a program",
    );
    // Haas has M97 for that.
    let haas = run("haas", "O1\nM98 Q100\nM30\nN100 M99\n", &options(9, 9, 9));
    assert!(haas.is_err());
}

#[test]
fn every_message_of_o_words() {
    let fails = |program: &str, expected: &str| fails("linuxcnc", program, expected);
    fails(
        "o-1 sub\n",
        "1 o-word: -1 is not the number of a subroutine",
    );
    fails(
        "o1 loop\n",
        "1 o-word: this O-word says nothing that is known",
    );
    fails(
        "o1 if [1] x5\n",
        "1 o-word: nothing may follow an O-word in its block",
    );
    fails(
        "g0 x5 o1 call\n",
        "1 o-word: an O-word stands after other words",
    );
    fails("o1 if\n", "1 expression: `[` is missing here");
    let call = format!("o1 call {}\n", "[1]".repeat(31));
    fails(&call, "1 o-word: a call has at most 30 arguments");
    fails("o1 if [0]\n", "1 o-word: there is no `O1 endif` after this");
    fails(
        "o<a> while [0]\n",
        "1 o-word: there is no `o<a> endwhile` after this",
    );
    fails("o1 sub\n", "1 o-word: there is no `O1 endsub` after this");
    fails(
        "o1 repeat [0]\n",
        "1 o-word: there is no `O1 endrepeat` after this",
    );
    fails("o1 repeat [1e13]\n", "1 expression: `]` is missing here");
    fails(
        "o1 repeat [10**13]\n",
        "1 endless: 10000000000000 is too many repetitions",
    );
    for stray in [
        "endif",
        "else",
        "elseif [1]",
        "endwhile",
        "endrepeat",
        "endsub",
        "return",
        "break",
        "continue",
    ] {
        let name = match stray {
            "return" => "endsub",
            other => other.split(' ').next().unwrap_or_default(),
        };
        let expected = format!("1 o-word: {name} without what it belongs to");
        fails(&format!("o1 {stray}\n"), &expected);
    }
    fails(
        "o1 call\n",
        "1 no-such-subprogram: there is no subprogram O1",
    );
    fails(
        "o<a/b> call\n",
        "1 no-such-subprogram: there is no subprogram o<a/b>",
    );
    fails(
        "o1 call\nm2\no1\nm99\n",
        "1 o-word: `call` calls the program O1, which has no `sub`",
    );
    fails(
        "m98 p1\nm2\no1 sub\no1 endsub\n",
        "1 subprogram: M98 calls a subroutine that begins with `sub`",
    );
    fails(
        "m98 p1\nm2\no1\no1 endsub\n",
        "4 o-word: a program that M98 has called ends with M99",
    );
    fails(
        "o1 sub\nm99\no1 endsub\no1 call\n",
        "2 subprogram: M99 ends a program that M98 has called",
    );
}

#[test]
fn every_message_of_subroutines_and_labels() {
    let fails = |program: &str, expected: &str| fails("linuxcnc", program, expected);
    fails(
        "m98 p1 g0 x1\n",
        "1 subprogram: LinuxCNC does not execute the other words of this block",
    );
    fails(
        "m98\n",
        "1 subprogram: a call without the number of a program",
    );
    fails(
        "m98 p1 l10000000\n",
        "1 subprogram: a call that is repeated less than 0 or more than 1000000 times",
    );
    fails(
        "o1 sub\no2 sub\no2 endsub\no1 endsub\n",
        "1 o-word: a subroutine begins inside another",
    );
    fails(
        "o1 call\nm2\no1 sub\no2 sub\no2 endsub\no1 endsub\n",
        "4 o-word: a subroutine begins inside another",
    );
    fails(
        "o7\no1 sub\no1 endsub\n",
        "2 o-word: a subroutine begins inside a program with an O number",
    );
    fails(
        "o1 sub\no1 endsub\no1 sub\no1 endsub\n",
        "3 o-word: the label O1 is used for two things, before in line 1",
    );
    fails(
        "o1 if [1]\no1 endif\no1 do\no1 while [0]\n",
        "3 o-word: the label O1 is used for two things, before in line 1",
    );
    fails(
        "o1 if [0]\no1 if [1]\no1 endif\no1 endif\n",
        "1 o-word: the label O1 is used for two things, before in line 1",
    );
    fails(
        "o1 do\no1 continue\no1 break\no1 while [0]\n",
        "2 o-word: after this continue stands a break of the same do loop, which LinuxCNC would take",
    );
    fails(
        "o1 while [1]\no1 break\no1 endwhile\no2 do\no2 while [1]\n",
        "5 o-word: a break has left a while loop before, which ends this do loop on LinuxCNC 2.9",
    );
    fails(
        "m98 p1\nm2\no1\n",
        "3 subprogram: the subprogram ends without a return",
    );
    fails(
        "(abort, enough)\n",
        "1 abort: the program ends itself with an error here",
    );
}

#[test]
fn every_message_of_macros() {
    let fails = |program: &str, expected: &str| fails("iso", program, expected);
    fails("IF[1]\n", "1 macro: IF without THEN or GOTO");
    fails("WHILE[1]\n", "1 macro: WHILE without DO");
    fails("IF[1]THEN#1\n", "1 macro: THEN takes an assignment");
    fails("GOTO1.5\n", "1 macro: GOTO needs the number of a block");
    fails("DO4\n", "1 macro: loops are numbered 1, 2 and 3");
    fails(
        "GOTO5\n",
        "1 no-such-block: there is no block N5 in this program",
    );
    fails("WHILE[0]DO1\n", "1 loop: there is no END1 for this loop");
    fails("END1\n", "1 loop: there is no DO1 for this END");
    fails(
        "M98 P7\n",
        "1 no-such-subprogram: there is no subprogram O7",
    );
    fails(
        "G65 A1\n",
        "1 subprogram: a macro call without the number of a program",
    );
    fails(
        "O1\nM98 P2\nM30\nO2\nG0 X1\n",
        "5 subprogram: the subprogram ends without a return",
    );
}

/// Depth of calls, moves by repetition and lines without a move have limits.
#[test]
fn what_runs_away_is_stopped() {
    let limited = |program: &str| run("linuxcnc", program, &options(5, 20, 50));
    let error = |text: &str| Err(text.to_owned());
    let deep = "o1 sub\no1 call\no1 endsub\no1 call\n";
    assert_eq!(
        limited(deep),
        error("2 call-depth: more than 5 calls inside one another")
    );
    let idle = "o1 while [1]\no1 endwhile\n";
    let found = limited(idle).expect_err("endless");
    assert!(
        found.ends_with("endless: 50 lines in a row have been executed without a move"),
        "{found}"
    );
    // A dwell is no move: it waits for a value that nothing here writes.
    let waits = "#1=0\no1 while [#1 EQ 0]\ng4 p1\no1 endwhile\n";
    assert_eq!(
        limited(waits).err().map(|it| it[2..].to_owned()),
        Some(found[2..].to_owned())
    );
    let moving = "g91\no1 while [1]\ng0 x1\no1 endwhile\n";
    assert_eq!(
        limited(moving),
        error("3 endless: more than 20 moves by repetition")
    );
    let repeat = "g91\no1 repeat [1000]\ng0 x1\no1 endrepeat\n";
    assert_eq!(
        limited(repeat),
        error("3 endless: more than 20 moves by repetition")
    );
    // Just as many as are allowed: the first run of a line is none.
    let repeat = "g91\no1 repeat [21]\ng0 x1\no1 endrepeat\n";
    assert_eq!(limited(repeat).map(|moves| moves.len()), Ok(21));
    // A flat program is not limited.
    let flat = format!("g91\n{}", "g0 x1\n".repeat(100));
    assert_eq!(limited(&flat).map(|moves| moves.len()), Ok(100));
    let found = run("iso", "N1 #1=1\nGOTO1\n", &options(5, 20, 50)).expect_err("endless");
    assert!(found.contains("endless: 50 lines in a row"), "{found}");
    let found = run("iso", "O1\nM98 P1\nM30\n", &options(5, 20, 50)).expect_err("deep");
    assert_eq!(found, "2 call-depth: more than 5 calls inside one another");
    // A main program that ends with M99 begins again; once is enough.
    assert_eq!(ends("iso", "O1\nG0 X1\nX2\nM99\n"), [1.0, 2.0, 1.0, 2.0]);
}
