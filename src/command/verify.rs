//! `gwatt verify`.

use std::fs::File;
use std::io::{self, BufReader, BufWriter, Write};
use std::path::Path;
use std::slice;

use anyhow::{Context, Result};
use gwatt::identify::overlay::{Overlay, PowerTrace, overlay};
use gwatt::identify::{MappedColumn, Outcome, merge};
use gwatt::machine::{ALL_AXES, Machine};
use gwatt::report::{
    OverlayChart, Verdict, VerifiedNames, verified_csv, verified_json, verified_page, verified_text,
};
use gwatt::verify::predicted;

use super::clash::refuse_clashes;
use super::dialect;
use super::input::{Program, is_dash};
use super::into::{Merged, axis_of, written};
use super::output::{Spool, Target, print};
use super::settings::Settings;
use super::setup::{Setup, machine_file};
use super::terminal::Terminal;
use crate::cli::VerifyArgs;

/// Lays a recording over the prediction.
pub fn run(args: &VerifyArgs, terminal: Terminal) -> Result<Verdict> {
    let mut program = Program::new(&args.program);
    let mut args = args.clone();
    let settings = Settings::of(slice::from_ref(&program), terminal)?;
    settings.fill(&mut args.machine, &mut args.reading)?;
    let args = &args;
    let machine = machine_file(args.machine.machine.as_deref());
    // The machine file may be the one that is written.
    let machine = machine.filter(|path| args.into.as_deref() != Some(*path));
    let log = Some(args.log.as_path());
    let inputs: Vec<&Path> = program
        .path()
        .into_iter()
        .chain(log)
        .chain(machine)
        .collect();
    let results = [&args.csv, &args.json, &args.svg, &args.html, &args.into];
    let outputs: Vec<&Path> = results.into_iter().flatten().map(AsRef::as_ref).collect();
    refuse_clashes(&inputs, &outputs)?;
    let mut setup = Setup::new(&args.machine, &args.reading, terminal)?;
    setup.one_way("`verify` follows")?;
    dialect::settle(&mut setup, slice::from_mut(&mut program), terminal)?;
    let trace = read(args)?;
    for note in &trace.notes {
        terminal.note(note);
    }
    let options = setup.options_for(&program);
    let predicted = program
        .open()
        .and_then(|input| predicted(input, &setup.machine, &options, &trace));
    let predicted = match predicted {
        Ok(predicted) => predicted,
        Err(failure) => {
            terminal.say(|it| dialect::failure(&setup, &program, &failure, it));
            return Ok(Verdict::Refused);
        }
    };
    if let Some(line) = predicted.unknown_line {
        terminal.note(format_args!(
            "line {line} moves from an unknown start: the prediction is the most that it may draw \
             there, and has no power of its axes; give --tool-table, --parameters or the offsets"
        ));
    }
    let log = args.log.display().to_string();
    let found = overlay(&predicted.curve, &predicted.axes, &trace).with_context(|| log.clone())?;
    let names = VerifiedNames {
        program: program.name.clone(),
        log,
        machine: setup.machine.name.clone(),
        margin: setup.machine.limits.margin,
        servo_factors: servo_factors(&setup.machine),
    };
    deliver(args, &names, &found, &trace, terminal)
}

/// `servo_factor_motor` of each axis.
fn servo_factors(machine: &Machine) -> Vec<(char, f64)> {
    let axes = machine.axes.iter().zip(ALL_AXES);
    let axes = axes.filter_map(|(axis, id)| Some((id, axis.as_ref()?)));
    axes.map(|(id, axis)| (id.letter() as char, axis.servo_factor_motor))
        .collect()
}

fn read(args: &VerifyArgs) -> Result<PowerTrace> {
    let map = args.map.iter().map(|text| text.parse());
    let map = map.collect::<Outcome<Vec<MappedColumn>>>()?;
    let name = args.log.display();
    let read = if is_dash(&args.log) {
        PowerTrace::read(io::stdin().lock(), &map)
    } else {
        let file = File::open(&args.log).with_context(|| format!("{name}: cannot read the log"))?;
        PowerTrace::read(BufReader::new(file), &map)
    };
    read.with_context(|| name.to_string())
}

fn deliver(
    args: &VerifyArgs,
    names: &VerifiedNames,
    found: &Overlay,
    trace: &PowerTrace,
    terminal: Terminal,
) -> Result<Verdict> {
    let csv = spooled(args.csv.as_deref(), |out| verified_csv(found, out))?;
    let json = spooled(args.json.as_deref(), |out| verified_json(names, found, out))?;
    let svg = spooled(args.svg.as_deref(), |out| {
        OverlayChart::new(found, trace).write(out)
    })?;
    let html = spooled(args.html.as_deref(), |out| {
        verified_page(names, found, trace, out)
    })?;
    let good = found.agreement().is_of_the_program();
    let is_refused = args.into.is_some() && !good && !args.force;
    let merged = match &args.into {
        Some(path) if !is_refused => {
            let factors = found.axes.iter();
            let factors = factors.map(|it| Ok((axis_of(it.letter)?, it.motor)));
            let factors = factors.collect::<Result<Vec<_>>>()?;
            let made = |name: &str, text: &str| {
                merge::margin_into_machine(name, text, found.margin_beyond_axes(), &factors)
            };
            Some((path, Merged::made(path, made)?))
        }
        _ => None,
    };
    for spool in [csv, json, svg, html].into_iter().flatten() {
        spool.deliver()?;
    }
    if let Some((path, merged)) = merged {
        merged.deliver(path, terminal)?;
    }
    let text = verified_text(names, found);
    let printed = [&args.csv, &args.json, &args.svg, &args.html];
    if printed.into_iter().flatten().any(|path| is_dash(path)) {
        terminal.text(&text);
    } else {
        print(|out| out.write_all(text.as_bytes()))?;
    }
    let exceeds = args.into.is_none() && !names.covers(found);
    Ok(match written(args.into.as_deref(), is_refused, terminal) {
        Verdict::Fits => Verdict::of(good && !exceeds || args.force),
        verdict => verdict,
    })
}

/// A result on its way, if it is asked for.
fn spooled(
    path: Option<&Path>,
    write: impl FnOnce(&mut BufWriter<Spool>) -> io::Result<()>,
) -> Result<Option<Spool>> {
    let Some(path) = path else {
        return Ok(None);
    };
    let mut out = BufWriter::new(Target::new(path)?.spool()?);
    write(&mut out)
        .and_then(|()| out.flush())
        .with_context(|| format!("cannot write {}", path.display()))?;
    let spool = out.into_inner().map_err(io::IntoInnerError::into_error)?;
    Ok(Some(spool))
}
