//! `gwatt machine`.

use anyhow::{Context, Result, bail};
use gwatt::machine::{builtin, schema};
use gwatt::pipeline::assumptions;
use gwatt::power::spindle_run;
use gwatt::report::{Verdict, axis_table, duration, level_table, mass_table, power};

use super::output::print;
use super::setup::load_machine;
use super::terminal::Terminal;
use crate::cli::MachineCommand;

/// Lists, shows, checks, makes and imports machine descriptions.
pub fn run(command: &MachineCommand, terminal: Terminal) -> Result<Verdict> {
    match command {
        MachineCommand::List => list()?,
        MachineCommand::Show { name } => show(name)?,
        MachineCommand::Motors => super::machine_motors::run()?,
        MachineCommand::Check { file } => check(file, terminal)?,
        MachineCommand::Import(args) => super::machine_import::run(args, terminal)?,
        MachineCommand::New(args) => super::machine_new::run(args, terminal)?,
        MachineCommand::Schema => print(|out| {
            serde_json::to_writer_pretty(&mut *out, &schema())?;
            writeln!(out)
        })?,
    }
    Ok(Verdict::Fits)
}

fn list() -> Result<()> {
    let machines = builtin::machines();
    let controllers = builtin::controllers();
    let width = machines.iter().chain(controllers).map(|it| it.name.len());
    let width = width.max().unwrap_or_default();
    print(|out| {
        for machine in machines {
            let is_default = machine.name == builtin::DEFAULT_MACHINE;
            let mark = if is_default { '*' } else { ' ' };
            writeln!(
                out,
                "{mark} {:width$}  {}",
                machine.name, machine.description
            )?;
        }
        writeln!(out, "\n* used when no machine is given")?;
        writeln!(
            out,
            "\nController profiles (`controller` in a machine file, --dialect):"
        )?;
        for profile in controllers {
            writeln!(out, "  {:width$}  {}", profile.name, profile.description)?;
        }
        Ok(())
    })
}

fn show(name: &str) -> Result<()> {
    let (machines, controllers) = (builtin::machines(), builtin::controllers());
    let Some(found) = machines
        .iter()
        .chain(controllers)
        .find(|it| it.name == name)
    else {
        let names = |of: &[builtin::Builtin]| {
            let names: Vec<_> = of.iter().map(|it| it.name).collect();
            names.join(", ")
        };
        bail!(
            "there is no built-in machine {name}; there are {}, and the controller profiles {}",
            names(machines),
            names(controllers)
        );
    };
    print(|out| out.write_all(found.text.as_bytes()))
}

fn check(file: &str, terminal: Terminal) -> Result<()> {
    let machine = load_machine(file, terminal)?;
    let run = machine
        .spindle
        .as_ref()
        .map(|spindle| spindle_run(spindle, 0.0, spindle.max_rpm));
    let run = run
        .transpose()
        .with_context(|| format!("{file}: [spindle]"))?;
    print(|out| {
        writeln!(out, "{file}: {}", machine.name)?;
        write!(out, "{}{}", axis_table(&machine), mass_table(&machine))?;
        write!(out, "{}", level_table(&machine))?;
        for converter in &machine.converters {
            let share = 1.0 - machine.limits.margin;
            let limit = power(share * converter.peak_power_w);
            let name = match converter.name.as_str() {
                "" => String::new(),
                name => format!(" {name}"),
            };
            write!(out, "  converter{name}: limit {limit} with its margin")?;
            if let Some(regen) = converter.regen_power_w {
                write!(out, ", {} fed back", power(share * regen))?;
            }
            writeln!(out)?;
        }
        if let (Some(spindle), Some(run)) = (&machine.spindle, &run) {
            let (max, time, peak) = (spindle.max_rpm, duration(run.duration_s), power(run.peak_w));
            writeln!(out, "  spindle: {max} 1/min in {time}, peak {peak}")?;
        }
        for assumption in assumptions(&machine) {
            writeln!(out, "  {assumption}")?;
        }
        Ok(())
    })
}
