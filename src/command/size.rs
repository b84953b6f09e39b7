//! `gwatt size`.

use std::io::{self, BufWriter};
use std::path::Path;

use anyhow::{Context, Result, bail};
use gwatt::machine::Machine;
use gwatt::pipeline::LimitOptions;
use gwatt::pipeline::size::{Job, Outcome, Size, Wish, size};
use gwatt::report::{Verdict, chain, size_chart, size_csv, size_json, size_text, size_verdict};

use super::clash::refuse_clashes;
use super::input::{Input, Program, is_dash};
use super::listing::Listing;
use super::output::{Spool, Target, print};
use super::progress::Progress;
use super::settings::Settings;
use super::setup::{Setup, machine_file, machine_name};
use super::terminal::Terminal;
use crate::cli::{SizeArgs, allowed};

/// Says how large the converter must be.
pub fn run(args: &SizeArgs, terminal: Terminal) -> Result<Verdict> {
    let mut programs = Listing::of(&args.programs, terminal)?.programs();
    let mut args = args.clone();
    let settings = Settings::of(&programs, terminal)?;
    settings.fill(&mut args.machine, &mut args.reading)?;
    settings.allow(&mut args.allow);
    let args = &args;
    let machine = machine_file(args.machine.machine.as_deref());
    let inputs: Vec<&Path> = programs
        .iter()
        .filter_map(Program::path)
        .chain(machine)
        .collect();
    let files = [&args.csv, &args.json, &args.svg];
    let outputs: Vec<&Path> = files.into_iter().flatten().map(AsRef::as_ref).collect();
    refuse_clashes(&inputs, &outputs)?;
    let name = machine_name(&args.machine, terminal);
    let mut setup = Setup::of(name, &args.reading, terminal)?;
    setup.options.certificate = args.certificate.map(Into::into);
    for program in &mut programs {
        program.keep()?;
    }
    let wish = wish(args, &setup)?;
    let bytes = programs.iter().map(Program::bytes).sum();
    let progress = Progress::of_bytes(terminal.progress(false), "size", bytes, 1);
    for program in &mut programs {
        program.count_by(progress.meter());
    }
    let jobs: Vec<Job<'_, Input>> = programs
        .iter()
        .map(|program| Job {
            name: program.name.clone(),
            options: setup.options_for(program),
            open: Box::new(|| program.open()),
        })
        .collect();
    let found = match size(&jobs, &setup.machine, &wish) {
        Ok(found) => found,
        Err(failure) => bail!("{}", chain(&failure)),
    };
    drop(progress);
    for (program, outcome) in &found.rating.programs {
        if let Outcome::Refused(failure) = outcome {
            terminal.failure(program, failure);
        }
    }
    deliver(args, &found, &setup.machine, wish.converter)?;
    let text = size_text(&found, &setup.machine, name, wish.converter);
    if outputs.iter().any(|path| is_dash(path)) {
        terminal.text(&text);
    } else {
        print(|out| out.write_all(text.as_bytes()))?;
    }
    Ok(size_verdict(&found))
}

fn wish(args: &SizeArgs, setup: &Setup) -> Result<Wish> {
    Ok(Wish {
        how: LimitOptions {
            strategy: args.strategy.into(),
            law: args.law.into(),
            allowed: allowed(&args.allow),
            ..LimitOptions::USUAL
        },
        converter: converter(args.converter.as_deref(), &setup.machine)?,
        steps: args.steps,
        until: args.until.0,
        losses: args.losses.iter().map(|loss| loss.0).collect(),
        regen_ratio: args.regen_ratio,
        threads: setup.options.threads,
    })
}

/// Index of the converter that is sized.
fn converter(name: Option<&str>, machine: &Machine) -> Result<usize> {
    let converters = &machine.converters;
    let names = || {
        let names: Vec<&str> = converters.iter().map(|it| it.name.as_str()).collect();
        names.join(", ")
    };
    match name {
        None if converters.len() > 1 => bail!(
            "the machine has several converters: say with --converter which one is to be \
             sized ({})",
            names()
        ),
        None => Ok(0),
        Some(name) => converters
            .iter()
            .position(|converter| converter.name == name)
            .with_context(|| match names().as_str() {
                "" => format!("--converter {name}: the machine's converter has no name"),
                names => format!("--converter {name}: the machine has no such one ({names})"),
            }),
    }
}

/// Writes the files: all are made before the first takes its place.
fn deliver(args: &SizeArgs, found: &Size, machine: &Machine, converter: usize) -> Result<()> {
    let converter = machine.converters.get(converter);
    let converter = converter.map_or("", |it| it.name.as_str());
    let mut spools: Vec<Spool> = Vec::new();
    let mut write = |path: Option<&Path>,
                     write: &dyn Fn(&mut BufWriter<Spool>) -> io::Result<()>| {
        let Some(path) = path else {
            return Ok(());
        };
        let mut spool = BufWriter::new(Target::new(path)?.spool()?);
        write(&mut spool).with_context(|| format!("cannot write {}", path.display()))?;
        spools.push(spool.into_inner().map_err(io::IntoInnerError::into_error)?);
        anyhow::Ok(())
    };
    write(args.csv.as_deref(), &|out| size_csv(found, out))?;
    write(args.json.as_deref(), &|out| {
        size_json(found, &machine.name, converter, out)
    })?;
    write(args.svg.as_deref(), &|out| size_chart(found, out))?;
    spools.into_iter().try_for_each(Spool::deliver)
}
