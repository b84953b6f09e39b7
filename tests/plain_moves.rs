//! No move is lost in silence: programs whose moves stand in plain words, with anything
//! around them that a language knows, keep every move, or are refused.

use std::fmt::Write as _;

use gwatt::machine::Machine;
use gwatt::pipeline::Options;

use crate::listing::machine;
use crate::random::Dice;
use crate::runs::moves_of;

/// How a language writes what stands around moves; `@` is a number of its own.
struct Language {
    controller: &'static str,
    /// Lines that move nothing.
    lines: &'static [&'static str],
    /// Words that may stand in a block with a move.
    words: &'static [&'static str],
    /// What is around some moves: they run once.
    around: &'static [[&'static str; 2]],
    /// What is around some moves, and how often they run.
    repeated: &'static [([&'static str; 2], usize)],
    comment: [&'static str; 2],
    end: &'static str,
}

const RS274: Language = Language {
    controller: "linuxcnc",
    lines: &[
        "",
        "(a comment)",
        "; rest",
        "#1=5",
        "#<a>=[2+3]",
        "M8",
        "M9",
        "T1",
        "S500",
        "G64 P0.1",
        "G61",
        "G17",
        "G40",
        "G49",
        "(MSG, G0 X99)",
        "(PRINT, X99)",
        "N7",
        "M48",
        "F700",
    ],
    words: &["M8", "M9", "S600", "T2", "F900", "G94", "(G1 X99)"],
    around: &[
        ["o@ if [1 GT 0]", "o@ endif"],
        ["o@ if [0 GT 1]\nG0 X77\no@ else", "o@ endif"],
        ["#9=0\no@ while [#9 LT 1]\n#9=[#9+1]", "o@ endwhile"],
        ["o@ do", "o@ while [0]"],
        ["o@ repeat [1]", "o@ endrepeat"],
    ],
    repeated: &[
        (["o@ repeat [3]", "o@ endrepeat"], 3),
        (["o@ repeat [0]", "o@ endrepeat"], 0),
    ],
    comment: ["(", ")"],
    end: "M2",
};

const FANUC: Language = Language {
    controller: "fanuc",
    lines: &[
        "",
        "(A COMMENT)",
        "#1=5.",
        "#101=[2.+3.]",
        "M8",
        "M9",
        "T1",
        "S500",
        "G64",
        "G17",
        "G40",
        "G49",
        "N7",
        "#105=#0",
        "G61",
        "F700.",
        "M98 P900",
        "#3006=1(G0 X99.)",
    ],
    words: &["M8", "M9", "S600", "F900.", "G94", "(G1 X99.)"],
    around: &[
        ["IF[1 EQ 0]GOTO@", "N@"],
        ["#9=0\nWHILE[#9 LT 1]DO1\n#9=#9+1", "END1"],
        ["GOTO@\nG0 X77.\nN@", ""],
    ],
    repeated: &[(["#9=0\nWHILE[#9 LT 3]DO2\n#9=#9+1", "END2"], 3)],
    comment: ["(", ")"],
    end: "M30\nO900\n#110=3\nM99",
};

const SIEMENS: Language = Language {
    controller: "siemens",
    lines: &[
        "",
        "; a comment",
        "R1=5",
        "R2=R1*2",
        "M8",
        "M9",
        "T1",
        "S500",
        "G64",
        "G17",
        "G40",
        "N7",
        "MSG(\"G0 X99\")",
        "MSG()",
        "STOPRE",
        "F700",
    ],
    words: &["M8", "M9", "S600", "F900", "G94", "; G1 X99"],
    around: &[
        ["IF 1 > 0", "ENDIF"],
        ["IF 0 > 1\nG0 X77\nELSE", "ENDIF"],
        ["R9=0\nWHILE R9 < 1\nR9=R9+1", "ENDWHILE"],
        ["GOTOF L@\nG0 X77\nL@:", ""],
    ],
    repeated: &[
        (["FOR R9=1 TO 3", "ENDFOR"], 3),
        (["R9=0\nREPEAT\nR9=R9+1", "UNTIL R9 >= 2"], 2),
    ],
    comment: ["; ", ""],
    end: "M30",
};

const OKUMA: Language = Language {
    controller: "okuma",
    lines: &[
        "",
        "(A COMMENT)",
        "VC1=5",
        "V1=2+3",
        "M8",
        "M9",
        "S500",
        "G64",
        "G17",
        "G40",
        "F700",
    ],
    words: &["M8", "M9", "S600", "F900", "(G1 X99)"],
    around: &[["IF [1 EQ 0] N@", "N@"], ["GOTO N@\nG0 X77\nN@", ""]],
    repeated: &[],
    comment: ["(", ")"],
    end: "M2",
};

const GRBL: Language = Language {
    controller: "grbl",
    lines: &[
        "",
        "(a comment)",
        "; rest",
        "M8",
        "M9",
        "S500",
        "G17",
        "G40",
        "N7",
        "M3 S100",
        "F700",
    ],
    words: &["M8", "M9", "S600", "F900", "G94", "(G1 X99)"],
    around: &[],
    repeated: &[],
    comment: ["(", ")"],
    end: "M2",
};

const MARLIN: Language = Language {
    controller: "marlin",
    lines: &[
        "",
        "; a comment",
        "M105",
        "M117 G0 X99",
        "M118 X99",
        "G92 E0",
        "M82",
        "M106 S255",
        "M107",
        "T0",
    ],
    words: &["F900", "; G1 X99"],
    around: &[],
    repeated: &[],
    comment: ["; ", ""],
    end: "",
};

const ISG: Language = Language {
    controller: "isg",
    lines: &[
        "",
        "; a comment",
        "(a comment)",
        "P1=5",
        "P2=P1+1",
        "M8",
        "M9",
        "S500",
        "G17",
        "G40",
        "F700",
        "#MSG [\"G0 X99\"]",
    ],
    words: &["M8", "M9", "F900", "(G1 X99)"],
    around: &[
        ["$IF 1 > 0", "$ENDIF"],
        ["$IF 0 > 1\nG0 X77\n$ELSE", "$ENDIF"],
        ["P9=0\n$WHILE P9 < 1\nP9=P9+1", "$ENDWHILE"],
    ],
    repeated: &[(["$FOR P9=1, 3, 1", "$ENDFOR"], 3)],
    comment: ["(", ")"],
    end: "M30",
};

/// A program, and where its moves end.
struct Written {
    text: String,
    ends: Vec<[f64; 2]>,
    numbers: usize,
}

impl Written {
    fn line(&mut self, line: &str) {
        self.text.push_str(line);
        self.text.push('\n');
    }

    /// What has a number of its own.
    fn lines(&mut self, lines: &str, number: usize) {
        if !lines.is_empty() {
            self.line(&lines.replace('@', &number.to_string()));
        }
    }

    /// A plain move to a new place.
    fn a_move(&mut self, dice: &mut Dice, language: &Language) {
        let place = [0, 1]
            .map(|_| 1 + dice.below(60_000))
            .map(|it| it as f64 / 1000.0);
        let space = *dice.of(&["", " ", "  ", "\t"]);
        let motion = *dice.of(&["G0", "G1", "G00", "G01", "g1"]);
        let zeros = *dice.of(&["", "0", "00"]);
        let mut line = String::new();
        if language.controller != "okuma" && dice.below(100) < 15 {
            let _ = write!(line, "N{}{space}", dice.below(90));
        }
        let [x, y] = place;
        let _ = write!(line, "{motion}{space}X{x:.3}{zeros}{space} Y{y:.3}");
        if motion.ends_with('1') {
            let _ = write!(line, "{space} F{}.", 100 + dice.below(3000));
        }
        if dice.below(100) < 20 {
            let word = *dice.of(language.words);
            if !(word.starts_with('F') && line.contains('F')) {
                let _ = write!(line, " {word}");
            }
        }
        if dice.below(100) < 10 {
            let [open, close] = language.comment;
            let _ = write!(line, " {open}{}{close}", "long ".repeat(dice.below(60)));
        }
        self.line(&line);
        self.ends.push(place);
    }

    fn piece(&mut self, dice: &mut Dice, language: &Language, depth: usize) {
        for _ in 0..=dice.below(4) {
            match dice.below(10) {
                0..=2 => {
                    let line = *dice.of(language.lines);
                    self.line(line);
                }
                3 if depth == 0 && !language.around.is_empty() => {
                    let [before, after] = language.around[dice.below(language.around.len())];
                    let number = self.number();
                    self.lines(before, number);
                    self.piece(dice, language, 1);
                    self.lines(after, number);
                }
                4 if depth == 0 && !language.repeated.is_empty() => {
                    let ([before, after], times) =
                        language.repeated[dice.below(language.repeated.len())];
                    let number = self.number();
                    self.lines(before, number);
                    let from = self.ends.len();
                    self.a_move(dice, language);
                    self.a_move(dice, language);
                    self.lines(after, number);
                    let run = self.ends.split_off(from);
                    (0..times).for_each(|_| self.ends.extend_from_slice(&run));
                }
                _ => self.a_move(dice, language),
            }
        }
    }

    fn number(&mut self) -> usize {
        self.numbers += 1;
        1000 + self.numbers
    }
}

/// Where the moves end that gwatt reads; `None` where it refuses the program.
fn read(machine: &Machine, text: &str) -> Option<Vec<[f64; 2]>> {
    let (moves, failure) = moves_of(machine, &Options::default(), text);
    let ends = moves.iter().map(|mv| [mv.end[0], mv.end[1]]).collect();
    failure.is_none().then_some(ends)
}

/// Programs of a language: how many are read, of how many.
fn keeps(language: &Language, seed: u64, programs: usize) -> usize {
    let machine = machine(language.controller);
    let mut dice = Dice(seed);
    let mut accepted = 0;
    for _ in 0..programs {
        let begin = match language.controller {
            "siemens" => "G71 G90\n",
            "okuma" | "isg" => "G90\n",
            _ => "G21 G90\n",
        };
        let mut written = Written {
            text: begin.to_owned(),
            ends: Vec::new(),
            numbers: 0,
        };
        for _ in 0..4 {
            written.piece(&mut dice, language, 0);
        }
        written.lines(language.end, 0);
        let Some(ends) = read(&machine, &written.text) else {
            continue;
        };
        accepted += 1;
        let mut kept = ends.iter();
        let near = |a: &[f64; 2], b: &[f64; 2]| (a[0] - b[0]).abs() + (a[1] - b[1]).abs() < 1e-6;
        let lost = written
            .ends
            .iter()
            .find(|end| !kept.any(|it| near(it, end)));
        assert_eq!(
            lost, None,
            "{}:\n{}\n{ends:?}",
            language.controller, written.text
        );
        let more = ends
            .iter()
            .find(|end| !written.ends.iter().any(|it| near(it, end)));
        assert_eq!(more, None, "{}:\n{}", language.controller, written.text);
    }
    accepted
}

const LANGUAGES: [&Language; 7] = [&RS274, &FANUC, &SIEMENS, &OKUMA, &GRBL, &MARLIN, &ISG];

#[test]
fn plain_moves_are_kept_or_the_program_is_refused() {
    for language in LANGUAGES {
        let accepted = keeps(language, 1, 150);
        assert!(accepted >= 75, "{}: {accepted}", language.controller);
    }
}

#[test]
#[ignore = "many programs; run it after changes of what is read"]
fn plain_moves_of_many_programs_are_kept() {
    for language in LANGUAGES {
        (2..102).for_each(|seed| {
            keeps(language, seed, 500);
        });
    }
}
