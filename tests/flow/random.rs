//! Random programs of statements, and the same unrolled.

use std::fmt::Write as _;
use std::io::Cursor;

use gwatt::pipeline::{LimitOptions, Strategy as How, analyze};
use proptest::prelude::*;

use super::{machine, options, run};
use crate::runs::{WITH_FEEDS, limited};

/// A statement of a random program.
#[derive(Debug, Clone)]
enum Statement {
    /// To this X, in steps of the number of variables that are set.
    Go(i32, Option<u16>),
    Add(usize, i32),
    If(usize, i32, Vec<Statement>, Vec<Statement>),
    Repeat(u8, Vec<Statement>),
    While(u8, Vec<Statement>),
    Call(i32),
}

/// Variables that statements use; loops use others.
const VARIABLES: usize = 3;

fn statement() -> impl Strategy<Value = Statement> {
    let leaf = prop_oneof![
        4 => (-3000..3000_i32, prop::option::of(50..30_000_u16))
            .prop_map(|(x, feed)| Statement::Go(x, feed)),
        2 => (0..VARIABLES, -5..6_i32).prop_map(|(variable, by)| Statement::Add(variable, by)),
        1 => (-50..50_i32).prop_map(Statement::Call),
    ];
    leaf.prop_recursive(4, 24, 4, |inner| {
        let some = || prop::collection::vec(inner.clone(), 0..4);
        prop_oneof![
            (0..VARIABLES, -4..5_i32, some(), some())
                .prop_map(|(variable, than, yes, no)| Statement::If(variable, than, yes, no)),
            (0..4_u8, some()).prop_map(|(times, body)| Statement::Repeat(times, body)),
            (0..4_u8, some()).prop_map(|(times, body)| Statement::While(times, body)),
        ]
    })
}

/// Writes a random program, and the same without flow.
#[derive(Default)]
struct Writer {
    text: String,
    labels: usize,
}

impl Writer {
    fn block(&mut self, statements: &[Statement]) {
        for statement in statements {
            self.labels += 1;
            let label = self.labels;
            let out = &mut self.text;
            match statement {
                Statement::Go(x, feed) => {
                    let feed = feed.map_or(String::new(), |feed| format!(" f{feed}"));
                    writeln!(out, "g1 x[{x}+#101*10]{feed}")
                }
                Statement::Add(variable, by) => {
                    let number = 101 + variable;
                    writeln!(out, "#{number}=[#{number}+[{by}]]")
                }
                Statement::Call(by) => writeln!(out, "o<step> call [{by}]"),
                Statement::If(variable, than, yes, no) => {
                    writeln!(out, "o{label} if [#{} gt {than}]", 101 + variable).expect("memory");
                    self.block(yes);
                    let _ = writeln!(self.text, "o{label} else");
                    self.block(no);
                    writeln!(self.text, "o{label} endif")
                }
                Statement::Repeat(times, body) => {
                    writeln!(out, "o{label} repeat [{times}]").expect("memory");
                    self.block(body);
                    writeln!(self.text, "o{label} endrepeat")
                }
                Statement::While(times, body) => {
                    let count = 1000 + label;
                    writeln!(
                        out,
                        "#{count}=0\no{label} while [#{count} lt {times}]\n#{count}=[#{count}+1]"
                    )
                    .expect("memory");
                    self.block(body);
                    writeln!(self.text, "o{label} endwhile")
                }
            }
            .expect("memory");
        }
    }
}

fn program(statements: &[Statement]) -> String {
    let mut writer = Writer::default();
    writer.text += "g21 g90 f3000\no<step> sub\ng0 x[#101+#1]\n#101=[#101+1]\no<step> endsub\n";
    writer.block(statements);
    writer.text + "m2\n"
}

/// The same program written out.
fn unrolled(statements: &[Statement], variables: &mut [i32; VARIABLES], out: &mut String) {
    for statement in statements {
        match statement {
            Statement::Go(x, feed) => {
                let feed = feed.map_or(String::new(), |feed| format!(" f{feed}"));
                let _ = writeln!(out, "g1 x{}{feed}", x + variables[0] * 10);
            }
            Statement::Add(variable, by) => variables[*variable] += by,
            Statement::Call(by) => {
                let _ = writeln!(out, "g0 x{}", variables[0] + by);
                variables[0] += 1;
            }
            Statement::If(variable, than, yes, no) => {
                let taken = if variables[*variable] > *than {
                    yes
                } else {
                    no
                };
                unrolled(taken, variables, out);
            }
            Statement::Repeat(times, body) | Statement::While(times, body) => {
                for _ in 0..*times {
                    unrolled(body, variables, out);
                }
            }
        }
    }
}

fn flat(statements: &[Statement]) -> String {
    let mut out = "g21 g90 f3000\n".to_owned();
    unrolled(statements, &mut [0; VARIABLES], &mut out);
    out + "m2\n"
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn a_program_and_its_unrolled_twin_move_alike(statements in prop::collection::vec(statement(), 1..8)) {
        let (program, flat) = (program(&statements), flat(&statements));
        let options = options(20, 100_000, 100_000);
        prop_assert_eq!(
            run("linuxcnc", &program, &options),
            run("linuxcnc", &flat, &options),
            "{}\n{}", program, flat
        );
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    /// What is certified fits in every run, and no feed has gone up.
    #[test]
    fn loops_that_are_limited_fit(
        statements in prop::collection::vec(statement(), 1..6),
        peak_w in 200.0..1500.0_f64,
        by_speed in any::<bool>(),
    ) {
        let program = program(&statements);
        let machine = machine("linuxcnc", peak_w);
        let options = options(20, 100_000, 100_000);
        let how = LimitOptions {
            strategy: if by_speed { How::Speed } else { How::Optimal },
            ..WITH_FEEDS
        };
        let (text, summary) = limited(&machine, &options, how, &program).expect("a program");
        if !summary.certified {
            prop_assert!(!summary.reasons.is_empty(), "{}", program);
            return Ok(());
        }
        let after = analyze(Cursor::new(&text), &machine, &options, None).expect("a program");
        prop_assert!(after.fits(), "{}\n{}", program, text);
        prop_assert_eq!(after.moves, summary.before.moves);
        let old = run("linuxcnc", &program, &options).expect("a program");
        let new = run("linuxcnc", &text, &options).expect("a program");
        for (old, new) in old.iter().zip(&new) {
            prop_assert_eq!(old.0, new.0);
            prop_assert!(new.1 <= old.1 * (1.0 + 1e-9), "{:?} {:?}\n{}\n{}", old, new, program, text);
        }
        // Each change is one line changed, and at most one that puts it back.
        let changed = text.lines().filter(|line| !program.lines().any(|other| other == *line)).count();
        prop_assert!(changed as u64 <= 2 * summary.edited_lines, "{}\n{}", program, text);
    }
}
