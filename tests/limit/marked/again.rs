//! Limited for 80 % of the power and then for 60 %: wherever the original can be made to fit
//! 60 % by its rapids alone, what was written for 80 % can.

use std::fmt::Write as _;

use gwatt::machine::{Machine, builtin};
use gwatt::pipeline::LimitOptions;

use super::marking;
use crate::machines::{linear_axes, machine_from};
use crate::random::Random;

/// How often a random program is made for each machine.
const PROGRAMS: u64 = 12;

/// A machine with a share of its power.
fn with_share(machine: &Machine, share: f64) -> Machine {
    let mut machine = machine.clone();
    for converter in &mut machine.converters {
        converter.peak_power_w *= share;
    }
    machine
}

/// X, Y and Z of this controller, which stop at each block or not.
fn own(controller: &str, path: &str) -> Machine {
    machine_from(&format!(
        "schema = 1\nname = \"own\"\ncontroller = \"{controller}\"\n[converter]\n\
         peak_power_w = 1000\nbase_load_w = 100\n[limits]\nmargin = 0\n[path]\n{path}\n{}",
        linear_axes("XYZ", [24000.0, 3000.0, 400.0], "coulomb_n = 200")
    ))
}

/// The axes of a control's programs, and ways to begin them: feeds by the minute, and on
/// lathes by the revolution.
fn header(name: &str) -> (&'static str, [&'static str; 2]) {
    match name {
        "fanuc-lathe" | "haas-lathe" | "lathe" => ("XZ", ["G98 F500.", "G97 S600 M3\nG99 F0.5"]),
        name if name.contains("lathe") => ("XZ", ["G94 F500.", "G97 S600 M3\nG95 F0.5"]),
        _ => ("XYZ", ["F500.", "G91\nF500."]),
    }
}

/// Rapids over long ways and slow feeds over short ones.
fn program(random: &mut Random, axes: &str, header: &str) -> String {
    let mut text = format!("G90\n{header}\n");
    let mut word = "";
    for _ in 0..random.within(6.0, 14.0) as usize {
        let rapid = random.within(0.0, 1.0) < 0.6;
        let own = if rapid { "G0" } else { "G1" };
        if own != word || random.within(0.0, 1.0) < 0.5 {
            let _ = write!(text, "{own} ");
        }
        word = own;
        let reach = if rapid { 300.0 } else { 20.0 };
        for axis in axes.chars() {
            if random.within(0.0, 1.0) < 0.6 || axis == 'X' {
                let _ = write!(text, "{axis}{:.1} ", random.within(10.0, 10.0 + reach));
            }
        }
        if random.once_in(5) && !rapid && !header.contains("S600") {
            text.push_str("F300. ");
        }
        text.push_str(if random.once_in(4) { "; go\n" } else { "\n" });
    }
    text + "M30\n"
}

/// What came of a machine's programs.
#[derive(Debug, Default)]
struct Tally {
    /// Programs that fit 80 %, those that need marks for it, those that fit 60 % as they
    /// are, and those that were changed again.
    certified: u32,
    marked: u32,
    at_once: u32,
    again: u32,
}

impl Tally {
    /// Limits a program at 80 % and at 60 %, in one step and in two.
    fn try_program(&mut self, machine: &Machine, name: &str, program: &str) {
        let run = |machine: &Machine, mark, program: &str| {
            let done = marking(machine, LimitOptions::USUAL, mark, program).ok()?;
            done.1.certified.then_some(done)
        };
        let [most, least] = [0.8, 0.6].map(|share| with_share(machine, share));
        let Some((first, summary)) = run(&most, "RAPID", program) else {
            return;
        };
        self.certified += 1;
        // But for the comments it is what is written without the option.
        let (plain, _) = run(&most, "", program).expect("it fits without marks too");
        let without = first.replace(" (RAPID)", "").replace(" ; RAPID", "");
        assert_eq!(without, plain, "{name}\n{program}");
        self.marked += u32::from(first != plain);
        let (same, unchanged) = run(&most, "RAPID", &first).expect("it fits as it is");
        assert_eq!(same, first, "{name}\n{program}");
        assert_eq!(unchanged.edited_lines, 0);
        assert!(unchanged.after.duration_s <= summary.after.duration_s * (1.0 + 1e-9));
        let Some((at_once, _)) = run(&least, "RAPID", program) else {
            return;
        };
        self.at_once += 1;
        let Some((second, again)) = run(&least, "RAPID", &first) else {
            let (_, refused) = marking(&least, LimitOptions::USUAL, "RAPID", &first).unwrap();
            panic!(
                "{name}\n{program}\n{first}\n{at_once}\n{:#?}",
                refused.reasons
            );
        };
        self.again += u32::from(again.edited_lines > 0 && second != first);
        let marks = |text: &str| text.matches("RAPID").count();
        assert!(marks(&second) >= marks(&first), "{name}\n{first}\n{second}");
        assert!(again.after.fits());
    }
}

/// Over all controller profiles, in exact stop and as the control blends.
#[test]
fn programs_for_every_controller() {
    for profile in builtin::controllers() {
        let mut tally = Tally::default();
        for path in ["mode = \"exact-stop\"", ""] {
            let machine = own(profile.name, &format!("{path}\nrapid = \"linear\""));
            for seed in 0..PROGRAMS {
                let mut random = Random::new(seed);
                let (axes, headers) = header(profile.name);
                let program = program(&mut random, axes, headers[seed as usize % 2]);
                tally.try_program(&machine, profile.name, &program);
            }
        }
        // Other controls have words for slower rapids, or let G0 obey F.
        let others = ["isg", "marlin", "reprap", "klipper"];
        let marks = !others.contains(&profile.name);
        assert_eq!(
            tally.marked > 0 && tally.again > 0,
            marks,
            "{}: {tally:?}",
            profile.name
        );
    }
}

#[test]
fn programs_for_every_built_in_machine() {
    for file in builtin::machines() {
        let machine = Machine::from_toml(file.name, file.text)
            .expect("a machine")
            .0;
        let mut tally = Tally::default();
        for seed in 0..PROGRAMS {
            let mut random = Random::new(100 + seed);
            let (axes, headers) = header(file.name);
            let program = program(&mut random, axes, headers[seed as usize % 2]);
            tally.try_program(&machine, file.name, &program);
        }
        let marks = !["linear-gantry", "five-axis", "printer"].contains(&file.name);
        assert_eq!(
            tally.marked > 0 && tally.again > 0,
            marks,
            "{}: {tally:?}",
            file.name
        );
    }
}
