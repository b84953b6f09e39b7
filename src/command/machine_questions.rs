//! The questions of `gwatt machine new`: answers become the options that would say the same.

use anyhow::{Context, Result};
use dialoguer::{Input, Select};
use gwatt::draft::{DraftAxis, Form, KEYS, MachineKind};

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
    if args.controller.is_none() {
        args.controller = ask_controller(kind.into(), answers)?;
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
    let known = MachineKind::from(kind).letters();
    let question = format!("Letters of the axes, out of {known}, such as XYZ");
    let letters = answers.text(&question, &|answer| {
        let mut seen = String::new();
        for letter in answer.chars() {
            if !known.contains(letter) || seen.contains(letter) {
                return Err(format!("write letters out of {known}, each once"));
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
    if kind == Kind::Printer {
        ask_heaters(&mut args, answers)?;
    } else if args.spindle.is_none() {
        args.spindle = ask_spindle(answers)?;
    }
    Ok(args)
}

fn ask_controller(kind: MachineKind, answers: &mut impl Answers) -> Result<Option<String>> {
    let usual = kind.usual_controller();
    let profiles = gwatt::machine::builtin::controllers();
    let question = format!("Controller profile, one of `gwatt machine list` (empty: {usual})");
    let name = answers.text(&question, &|answer| {
        if answer.is_empty() || profiles.iter().any(|profile| profile.name == answer) {
            return Ok(());
        }
        let names: Vec<&str> = profiles.iter().map(|profile| profile.name).collect();
        Err(format!("there are {}", names.join(", ")))
    })?;
    Ok(Some(name).filter(|name| !name.is_empty()))
}

fn ask_heaters(args: &mut NewArgs, answers: &mut impl Answers) -> Result<()> {
    for (word, what) in [("M104", "nozzle"), ("M140", "bed")] {
        let begins = |load: &String| load.to_ascii_uppercase().starts_with(word);
        if args.loads.iter().any(begins) {
            continue;
        }
        let question = format!("Heater of the {what}, in W (empty: none)");
        if let Some(power) = watts(answers, &question, true)?.filter(|power| *power > 0.0) {
            args.loads.push(format!("{word}={power}"));
        }
    }
    Ok(())
}

/// What is asked of a spindle.
const SPINDLE: [(&str, &str); 3] = [
    (
        "max_rpm",
        "Spindle: highest speed in rpm (empty: no spindle)",
    ),
    ("accel_time_s", "Spindle: time from rest to that speed in s"),
    (
        "inertia_kg_m2",
        "Spindle: inertia of rotor, chuck and tool in kg m2",
    ),
];

fn ask_spindle(answers: &mut impl Answers) -> Result<Option<String>> {
    let mut parts = Vec::new();
    for (name, question) in SPINDLE {
        let answer = answers.text(question, &|answer| match answer.parse::<f64>() {
            Ok(number) if number > 0.0 && number <= 1e9 => Ok(()),
            _ if answer.is_empty() && name == "max_rpm" => Ok(()),
            _ => Err("write a number above 0".to_owned()),
        })?;
        if answer.is_empty() {
            return Ok(None);
        }
        parts.push(format!("{name}={answer}"));
    }
    Ok(Some(parts.join(",")))
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
    let form = Form::of(letter).unwrap_or(Form::Slide);
    let mut parts = Vec::new();
    if let Some(drive) = ask_drive(letter, form, kind, answers)? {
        parts.push(drive);
    }
    let direct = parts.iter().any(|part| part.starts_with("drive="));
    let drive = parts.first().cloned().unwrap_or_default();
    let needed = form.needed();
    for key in KEYS.iter().filter(|key| key.forms.contains(&form)) {
        let name = key.name;
        let asks = match name {
            "rotor_kg_m2" | "gear_ratio" => !direct,
            // One of the two says its friction, and jerk is rare.
            "guide_friction" | "jerk_mm_s3" | "jerk_deg_s3" => false,
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
                judged(letter, form, kind, &drive, (name, &part(answer)))
            },
        )?;
        if !answer.is_empty() {
            parts.push(part(&answer));
        }
    }
    Ok(format!("{letter}:{}", parts.join(",")))
}

/// What drives an axis, as `--axis` has it; `None` for one that turns.
fn ask_drive(
    letter: char,
    form: Form,
    kind: MachineKind,
    answers: &mut impl Answers,
) -> Result<Option<String>> {
    let (drive, size) = match form {
        Form::Turn => return Ok(None),
        Form::Extruder => (
            "filament",
            "filament that a revolution of its wheels pushes, in mm",
        ),
        Form::Slide => {
            let chosen = answers.choice(&format!("{letter}: driven by"), &DRIVES.map(|it| it.0))?;
            let (_, drive, size) = DRIVES.get(chosen).copied().unwrap_or(DRIVES[0]);
            (drive, size)
        }
    };
    if drive == "drive" {
        return Ok(Some("drive=linear-motor".to_owned()));
    }
    let size = answers.text(&format!("{letter}: {size}"), &|answer| {
        let part = format!("{drive}={answer}");
        judged(letter, form, kind, &part, ("", ""))
    })?;
    Ok(Some(format!("{drive}={size}")))
}

/// Whether the parser takes an answer: with figures that stand in for those that it needs
/// besides.
fn judged(
    letter: char,
    form: Form,
    kind: MachineKind,
    drive: &str,
    (name, part): (&str, &str),
) -> Result<(), String> {
    let others = form.needed().iter().filter(|it| **it != name);
    let mut parts: Vec<String> = others.map(|it| format!("{it}=1")).collect();
    let given = [drive, part].into_iter().filter(|it| !it.is_empty());
    parts.extend(given.map(str::to_owned));
    DraftAxis::parse(&format!("{letter}:{}", parts.join(",")), kind)
        .map(|_| ())
        .map_err(|error| error.to_string())
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
        let answers = "router;My mill;grebl;grbl;-5;400;;0;XX;XZ;a screw;16x900;16x900x10;12000;fast;1500;20;;\
                       0.00003;;8;0.8;a linear motor;4000;800;6;1;5;2;;24000;fast;2;0.0004";
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
        assert_eq!(asked.controller.as_deref(), Some("grbl"));
        let spindle = "max_rpm=24000,accel_time_s=2,inertia_kg_m2=0.0004";
        assert_eq!(asked.spindle.as_deref(), Some(spindle));
        let powers = [asked.supply, asked.feeds_back, asked.base_load];
        assert_eq!(powers, [Some(400.0), None, Some(0.0)]);
        for wrong in [
            "write a number of watts",
            "write letters out of XYZUVWABC, each once",
            "write a number above 0",
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
            answers: ";;;X;a screw;16x900x10;9000;500;3;;nema;as1050;;;;"
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
            answers: ";0;;X;a toothed belt;20x2x9;9000;500;3;;;;;;"
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

    /// A printer has an extruder and heaters, a mill axes that turn.
    #[test]
    fn extruders_heaters_and_axes_that_turn_are_asked_for() {
        let given = args(&[
            "--kind", "printer", "--supply", "350", "--name", "P", "-c", "klipper",
        ]);
        let mut script = Script {
            answers: "0;;A;E;-1;33.683;3000;800;0.0000054;;20;0.5;40;220"
                .split(';')
                .collect(),
            shown: String::new(),
        };
        let asked = ask(given, &mut script).unwrap();
        let e = "E:filament=33.683,rapid_mm_min=3000,accel_mm_s2=800,rotor_kg_m2=0.0000054,\
                 coulomb_n=20,efficiency=0.5";
        assert_eq!(asked.axes, [e], "{}", script.shown);
        assert_eq!(asked.loads, ["M104=40", "M140=220"]);
        let wrong = "`filament=-1`: write filament=MM, what a revolution of its wheels pushes";
        assert!(script.shown.contains(wrong), "{}", script.shown);

        let given = args(&[
            "--kind", "mill", "--supply", "3500", "--name", "M", "-c", "fanuc",
        ]);
        let mut script = Script {
            answers: "0;;A;7200;1000;0.1;0.2;0.0002;90;1;0.8;"
                .split(';')
                .collect(),
            shown: String::new(),
        };
        let asked = ask(given, &mut script).unwrap();
        let a = "A:rapid_deg_min=7200,accel_deg_s2=1000,table_kg_m2=0.1,workpiece_kg_m2=0.2,\
                 rotor_kg_m2=0.0002,gear_ratio=90,friction_nm=1,efficiency=0.8";
        assert_eq!(asked.axes, [a], "{}", script.shown);
        assert_eq!(asked.spindle, None);
    }
}
