//! `gwatt power-fit`.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use anyhow::{Context, Result};
use gwatt::identify::merge::AxisFigures;
use gwatt::identify::power_fit::{PowerLog, PowerModel, fit};
use gwatt::identify::{Judgement, judgement};
use gwatt::report::{Heading, Verdict, margin, power_model_json, power_model_text};

use super::clash::refuse_clashes;
use super::input::is_dash;
use super::into::{Merged, axis_of, written};
use super::output::{Target, print};
use super::terminal::Terminal;
use crate::cli::PowerFitArgs;

/// Fits the power model of an axis.
pub fn run(args: &PowerFitArgs, terminal: Terminal) -> Result<Verdict> {
    let axis = axis_of(args.axis)?;
    let letter = axis.letter() as char;
    let inputs: Vec<&Path> = args.logs.iter().map(AsRef::as_ref).collect();
    let outputs: Vec<&Path> = [&args.json, &args.into]
        .into_iter()
        .flatten()
        .map(AsRef::as_ref)
        .collect();
    refuse_clashes(&inputs, &outputs)?;
    let mut log = PowerLog::default();
    for path in &args.logs {
        let name = path.display();
        let file = File::open(path).with_context(|| format!("{name}: cannot read the log"))?;
        log.add(BufReader::new(file), letter)
            .with_context(|| name.to_string())?;
    }
    let names: Vec<String> = args.logs.iter().map(|p| p.display().to_string()).collect();
    let recording = match names.as_slice() {
        [one] => one.clone(),
        many => format!("{} logs", many.len()),
    };
    let model = fit(&log).with_context(|| recording.clone())?;
    let heading = Heading {
        recording,
        axis: letter,
        rotary: log.rotary,
        validation: None,
        lever_is_missing: false,
        notes: log.notes.clone(),
    };
    let json = match &args.json {
        Some(path) => {
            let mut spool = Target::new(path)?.spool()?;
            power_model_json(&heading, &model, &mut spool)
                .with_context(|| format!("cannot write {}", path.display()))?;
            Some(spool)
        }
        None => None,
    };
    let judged = judgement::power(&model);
    let is_refused = args.into.is_some() && judged != Judgement::Good && !args.force;
    let merged = match &args.into {
        Some(path) if !is_refused => {
            let merged = Merged::new(path, axis, &figures(&log, &model), Some(margin(&model)))?;
            Some((path, merged))
        }
        _ => None,
    };
    if let Some(spool) = json {
        spool.deliver()?;
    }
    if let Some((path, merged)) = merged {
        merged.deliver(path, terminal)?;
    }
    for note in &heading.notes {
        terminal.note(note);
    }
    let text = power_model_text(&heading, &model);
    if args.json.as_deref().is_some_and(is_dash) {
        terminal.text(&text);
    } else {
        print(|out| out.write_all(text.as_bytes()))?;
    }
    Ok(written(args.into.as_deref(), is_refused, terminal))
}

fn figures(log: &PowerLog, model: &PowerModel) -> AxisFigures {
    AxisFigures {
        rotary: log.rotary,
        mass: model.mass.value,
        viscous: Some(model.viscous.value),
        coulomb: Some(model.coulomb.value),
        gravity: None,
        std: Some([model.mass, model.viscous, model.coulomb].map(|figure| figure.std)),
        efficiency: Some(model.efficiency.value),
    }
}
