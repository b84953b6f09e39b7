//! The questions of `gwatt machine new`: answers become the options that would say the same.

use anyhow::{Context, Result};
use dialoguer::{Input, Select};
use gwatt::draft::{DraftAxis, KEYS, MachineKind};

use crate::cli::{Kind, NewArgs};

/// Somebody who answers.
pub trait Answers {
    /// A line of text that `check` takes; it may be empty if `check` takes that.
    fn text(
        &mut self,
        question: &str,
        check: &dyn Fn(&str) -> Result<(), String>,
    ) -> Result<String>;

    /// The number of one of several answers.
    fn choice(&mut self, question: &str, answers: &[&str]) -> Result<usize>;
}

/// Somebody at the terminal.
pub struct OnTerminal;

const NO_ANSWER: &str = "no answer came; options say the same (gwatt machine new --help)";

impl Answers for OnTerminal {
    fn text(
        &mut self,
        question: &str,
        check: &dyn Fn(&str) -> Result<(), String>,
    ) -> Result<String> {
        Input::new()
            .with_prompt(question)
            .allow_empty(true)
            .validate_with(|answer: &String| check(answer.trim()))
            .interact_text()
            .map(|answer| answer.trim().to_owned())
            .context(NO_ANSWER)
    }

    fn choice(&mut self, question: &str, answers: &[&str]) -> Result<usize> {
        Select::new()
            .with_prompt(question)
            .items(answers)
            .default(0)
            .interact()
            .context(NO_ANSWER)
    }
}

/// Asks for what the options do not say.
pub fn ask(mut args: NewArgs, answers: &mut impl Answers) -> Result<NewArgs> {
    let kind = match args.kind {
        Some(kind) => kind,
        None => ask_kind(answers)?,
    };
    args.kind = Some(kind);
    if args.name.is_none() {
        let usual = format!(
            "Name of the machine (empty: My {})",
            MachineKind::from(kind)
        );
        let name = answers.text(&usual, &|_| Ok(()))?;
        args.name = Some(name).filter(|name| !name.is_empty());
    }
    if args.supply.is_none() {
        let question = "Most that the supply of the drives delivers, in W";
        args.supply = Some(watts(answers, question, false)?.unwrap_or_default());
    }
    if args.feeds_back.is_none() {
        let question = "What it takes back, in W (empty: not checked, as for small drives)";
        args.feeds_back = watts(answers, question, true)?;
    }
    if args.base_load.is_none() {
        let question = "Control, fans and pumps that always run on it, in W (empty: not known)";
        args.base_load = watts(answers, question, true)?;
    }
    let letters = answers.text("Letters of the axes that slide, such as XYZ", &|answer| {
        let mut seen = String::new();
        for letter in answer.chars() {
            if !"XYZUVW".contains(letter) || seen.contains(letter) {
                return Err("write letters out of XYZUVW, each once".to_owned());
            }
            seen.push(letter);
        }
        if seen.is_empty() {
            Err("a machine needs an axis".to_owned())
        } else {
            Ok(())
        }
    })?;
    for letter in letters.chars() {
        args.axes.push(ask_axis(letter, kind.into(), answers)?);
    }
    Ok(args)
}

fn ask_kind(answers: &mut impl Answers) -> Result<Kind> {
    let kinds = [Kind::Mill, Kind::Lathe, Kind::Router, Kind::Printer];
    let names = kinds.map(|kind| MachineKind::from(kind).name());
    let chosen = answers.choice("Kind of machine", &names)?;
    Ok(kinds.get(chosen).copied().unwrap_or(Kind::Mill))
}

/// A power; `None` for no answer, where that is one.
fn watts(answers: &mut impl Answers, question: &str, may_lack: bool) -> Result<Option<f64>> {
    let number = |answer: &str| answer.parse::<f64>().ok().filter(|it| it.is_finite());
    let answer = answers.text(question, &|answer| match number(answer) {
        Some(watts) if watts > 0.0 || may_lack && watts == 0.0 => Ok(()),
        None if answer.is_empty() && may_lack => Ok(()),
        _ => Err("write a number of watts".to_owned()),
    })?;
    Ok(number(&answer))
}

/// What drives an axis: what is asked, its key, and the form of its size.
const DRIVES: [(&str, &str, &str); 4] = [
    (
        "a screw",
        "screw",
        "diameter, length and lead in mm, such as 20x800x10",
    ),
    (
        "a pinion on a rack",
        "pinion",
        "pitch diameter and width in mm, such as 40x20",
    ),
    (
        "a toothed belt",
        "belt",
        "teeth of its pulleys, pitch and width in mm, such as 20x2x9",
    ),
    ("a linear motor", "drive", ""),
];

/// An axis as `--axis` has it.
fn ask_axis(letter: char, kind: MachineKind, answers: &mut impl Answers) -> Result<String> {
    let chosen = answers.choice(&format!("{letter}: driven by"), &DRIVES.map(|it| it.0))?;
    let (_, drive, form) = DRIVES.get(chosen).copied().unwrap_or(DRIVES[0]);
    let needed = ["rapid_mm_min", "accel_mm_s2", "table_kg"];
    // What the parser needs to judge an answer by itself.
    let stand_in = |name: &str| {
        let others = needed.iter().filter(|it| **it != name);
        let others: Vec<String> = others.map(|it| format!("{it}=1")).collect();
        others.join(",")
    };
    let judged = |name: &str, part: &str| {
        let extra = if part.starts_with("screw=")
            || part.starts_with("pinion=")
            || part.starts_with("belt=")
        {
            String::new()
        } else if drive == "drive" {
            ",drive=linear-motor".to_owned()
        } else {
            ",belt=20x2x9".to_owned()
        };
        let text = format!("{letter}:{}{extra},{part}", stand_in(name));
        DraftAxis::parse(&text, kind)
            .map(|_| ())
            .map_err(|error| error.to_string())
    };
    let mut parts = Vec::new();
    if drive == "drive" {
        parts.push("drive=linear-motor".to_owned());
    } else {
        let question = format!("{letter}: {form}");
        let size = answers.text(&question, &|answer| {
            judged("", &format!("{drive}={answer}"))
        })?;
        parts.push(format!("{drive}={size}"));
    }
    for key in KEYS {
        let name = key.name;
        let asks = match name {
            "rotor_kg_m2" | "gear_ratio" => drive != "drive",
            // One of the two says its friction, and jerk is rare.
            "guide_friction" | "jerk_mm_s3" => false,
            "counterweight_kg" => kind.is_vertical(letter),
            _ => true,
        };
        if !asks {
            continue;
        }
        let is_needed = needed.contains(&name);
        // In place of its inertia a motor can be named.
        let part = |answer: &str| match name {
            "rotor_kg_m2" if answer.parse::<f64>().is_err() => format!("motor={answer}"),
            _ => format!("{name}={answer}"),
        };
        let or_motor = match name {
            "rotor_kg_m2" => ", or a name of `gwatt machine motors`",
            _ => "",
        };
        let empty = if is_needed { "" } else { " (empty: not known)" };
        let answer = answers.text(
            &format!("{letter}: {}{or_motor}{empty}", key.what),
            &|answer| {
                if answer.is_empty() && !is_needed {
                    return Ok(());
                }
                judged(name, &part(answer))
            },
        )?;
        if !answer.is_empty() {
            parts.push(part(&answer));
        }
    }
    Ok(format!("{letter}:{}", parts.join(",")))
}

#[cfg(test)]
mod tests {
    use std::collections::VecDeque;

    use anyhow::{Context, Result};
    use clap::Parser;

    use super::{Answers, ask};
    use crate::cli::{Cli, Command, MachineCommand, NewArgs};

    /// Answers in their order; a wrong one is followed by a better one.
    struct Script {
        answers: VecDeque<&'static str>,
        shown: String,
    }

    impl Script {
        fn say(&mut self, line: &str) {
            self.shown.push_str(line);
            self.shown.push('\n');
        }

        fn next(&mut self) -> Result<&'static str> {
            self.answers.pop_front().context("no answer is left")
        }
    }

    impl Answers for Script {
        fn text(
            &mut self,
            question: &str,
            check: &dyn Fn(&str) -> Result<(), String>,
        ) -> Result<String> {
            loop {
                let answer = self.next()?;
                self.say(&format!("{question}: {answer}"));
                match check(answer) {
                    Ok(()) => return Ok(answer.to_owned()),
                    Err(wrong) => self.say(&format!("  {wrong}")),
                }
            }
        }

        fn choice(&mut self, question: &str, answers: &[&str]) -> Result<usize> {
            let answer = self.next()?;
            self.say(&format!("{question}: {answer}"));
            let found = answers.iter().position(|it| *it == answer);
            found.context("no such answer")
        }
    }

    fn args(words: &[&str]) -> NewArgs {
        let words = [&["gwatt", "machine", "new"], words].concat();
        match Cli::parse_from(words).command {
            Command::Machine {
                command: MachineCommand::New(args),
            } => args,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn answers_become_options() {
        let answers = "router;My mill;-5;400;;0;XX;XZ;a screw;16x900;16x900x10;12000;fast;1500;20;;\
                       0.00003;;8;0.8;a linear motor;4000;800;6;1;5;2;";
        let mut script = Script {
            answers: answers.split(';').collect(),
            shown: String::new(),
        };
        let asked = ask(args(&[]), &mut script).unwrap();
        let x = "X:screw=16x900x10,rapid_mm_min=12000,accel_mm_s2=1500,table_kg=20,\
                 rotor_kg_m2=0.00003,coulomb_n=8,efficiency=0.8";
        let z = "Z:drive=linear-motor,rapid_mm_min=4000,accel_mm_s2=800,table_kg=6,\
                 workpiece_kg=1,coulomb_n=5,counterweight_kg=2";
        assert_eq!(asked.axes, [x, z], "{}", script.shown);
        assert_eq!(asked.name.as_deref(), Some("My mill"));
        let powers = [asked.supply, asked.feeds_back, asked.base_load];
        assert_eq!(powers, [Some(400.0), None, Some(0.0)]);
        for wrong in [
            "write a number of watts",
            "write letters out of XYZUVW, each once",
            "axis `X`: `screw=16x900`: write screw=DIAMETERxLENGTHxLEAD in mm, each above 0",
            "axis `X`: `accel_mm_s2=fast`: this is no number",
        ] {
            assert!(
                script.shown.contains(&format!("  {wrong}\n")),
                "{}",
                script.shown
            );
        }
        assert!(script.answers.is_empty());
    }

    /// A motor is named in place of its inertia.
    #[test]
    fn a_motor_answers_for_its_rotor() {
        let given = args(&["--kind", "router", "--supply", "900", "--name", "R"]);
        let mut script = Script {
            answers: ";;X;a screw;16x900x10;9000;500;3;;nema;as1050;;;"
                .split(';')
                .collect(),
            shown: String::new(),
        };
        let asked = ask(given, &mut script).unwrap();
        let x = "X:screw=16x900x10,rapid_mm_min=9000,accel_mm_s2=500,table_kg=3,motor=as1050";
        assert_eq!(asked.axes, [x], "{}", script.shown);
        let wrong = "`motor=nema`: there is no such motor in `gwatt machine motors`";
        assert!(script.shown.contains(wrong), "{}", script.shown);
    }

    /// What options say is not asked for.
    #[test]
    fn options_answer_questions() {
        let given = args(&[
            "--kind",
            "lathe",
            "--supply",
            "900",
            "--name",
            "L",
            "--base-load",
            "5",
        ]);
        let mut script = Script {
            answers: "0;;X;a toothed belt;20x2x9;9000;500;3;;;;;"
                .split(';')
                .collect(),
            shown: String::new(),
        };
        let asked = ask(given, &mut script).unwrap();
        let x = "X:belt=20x2x9,rapid_mm_min=9000,accel_mm_s2=500,table_kg=3";
        assert_eq!(asked.axes, [x], "{}", script.shown);
        assert_eq!((asked.supply, asked.feeds_back), (Some(900.0), Some(0.0)));
        assert!(
            script.shown.contains("a machine needs an axis\n"),
            "{}",
            script.shown
        );
    }
}
