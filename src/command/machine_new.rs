//! `gwatt machine new`.

use std::io::{self, IsTerminal};

use anyhow::{Context, Result, anyhow, bail, ensure};
use gwatt::draft::{Draft, DraftAxis, DraftLoad, DraftSpindle, MachineKind};
use gwatt::machine::{Machine, builtin};
use gwatt::report::{axis_table, mass_table};

use super::input::is_dash;
use super::machine_questions::{OnTerminal, ask};
use super::output::{Target, print};
use super::terminal::{Shown, Terminal};
use crate::cli::NewArgs;

/// Makes a machine file of what is known of the machine.
pub fn run(args: &NewArgs, terminal: Terminal) -> Result<()> {
    let target = args.output.as_deref().map(Target::new).transpose()?;
    if let Some(name) = &args.controller {
        known_controller(name)?;
    }
    let asked = io::stdin().is_terminal() && io::stderr().is_terminal() && args.axes.is_empty();
    let args = if asked {
        &ask(args.clone(), &mut OnTerminal)?
    } else {
        args
    };
    let mut draft = draft(args)?;
    let (text, sums) = finished(&mut draft, terminal)?;
    for sentence in draft.left_out() {
        terminal.note(sentence);
    }
    match (target, &args.output) {
        (Some(target), Some(path)) if !is_dash(path) => {
            let shown = path.display();
            target.replace(text.as_bytes(), path, terminal)?;
            print(|out| write!(out, "{shown}: {}\n{sums}", draft.name))
        }
        _ => print(|out| out.write_all(text.as_bytes())),
    }
}

/// What the options say.
fn draft(args: &NewArgs) -> Result<Draft> {
    let kind: MachineKind = args
        .kind
        .context("what kind of machine? --kind mill, lathe, router or printer")?
        .into();
    let axes = args.axes.iter().map(|text| {
        let axis = DraftAxis::parse(text, kind)?;
        match &args.motor {
            Some(motor) => axis.with_motor(motor, kind),
            None => Ok(axis),
        }
    });
    let draft = Draft {
        kind,
        name: args.name.clone().unwrap_or_else(|| format!("My {kind}")),
        controller: args.controller.clone(),
        supply_w: args
            .supply
            .context("what does the supply of the drives deliver at most? --supply W")?,
        feeds_back_w: args.feeds_back,
        base_load_w: args.base_load,
        axes: axes.collect::<Result<_, _>>()?,
        spindle: args
            .spindle
            .as_deref()
            .map(DraftSpindle::parse)
            .transpose()?,
        loads: args
            .loads
            .iter()
            .map(|text| DraftLoad::parse(text, kind))
            .collect::<Result<_, _>>()?,
    };
    draft.check()?;
    ensure!(!draft.name.trim().is_empty(), "the machine's name is empty");
    Ok(draft)
}

fn known_controller(name: &str) -> Result<()> {
    let all = builtin::controllers();
    if all.iter().any(|profile| profile.name == name) {
        return Ok(());
    }
    let names: Vec<&str> = all.iter().map(|profile| profile.name).collect();
    bail!(
        "no controller profile is named `{name}`; there are {}",
        names.join(", ")
    )
}

/// The text, with what the axes come to: the file is read as any other.
fn finished(draft: &mut Draft, terminal: Terminal) -> Result<(String, String)> {
    let read = |text: &str| {
        Machine::from_toml("the new file", text).map_err(|errors| {
            terminal.diagnostics("the new file", &errors);
            anyhow!(Shown)
        })
    };
    let (machine, _) = read(&draft.machine_file(""))?;
    for sentence in draft.settle_motors(&machine) {
        terminal.note(sentence);
    }
    let (machine, warnings) = read(&draft.machine_file(""))?;
    let sums = format!("{}{}", axis_table(&machine), mass_table(&machine));
    let text = draft.machine_file(&sums);
    read(&text)?;
    terminal.diagnostics("the new file", &warnings);
    Ok((text, sums))
}
