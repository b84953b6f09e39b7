//! `gwatt limit`.

use std::fs;
use std::io::{self, BufReader, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::slice;

use anyhow::{Context, Result, bail, ensure};
use gwatt::pipeline::{self, LimitOptions, LimitSummary};
use gwatt::report::{Found, Verdict, limit_json, limit_text, partial_text, unified_diff};

use super::clash::refuse_clashes;
use super::dialect;
use super::input::Program;
use super::limit_set;
use super::output::{Spool, Target, back_up, print};
use super::page::{self, Pictures};
use super::rows::Rows;
use super::setup::{Setup, machine_file};
use super::terminal::Terminal;
use crate::cli::{LimitArgs, Strategy, allowed};

/// Bytes that go to the spool at once.
const SPOOL_BYTES: usize = 1 << 16;

/// Writes a program that fits.
pub fn run(args: &LimitArgs, terminal: Terminal) -> Result<Verdict> {
    ensure!(
        args.preset_else.is_none() || matches!(args.strategy, Strategy::Preset),
        "--preset-else goes with --strategy preset"
    );
    if args.with_subprograms {
        return limit_set::run(args, terminal);
    }
    let [path] = args.programs.as_slice() else {
        bail!("one program at a time: --with-subprograms limits several together");
    };
    let mut program = Program::new(path);
    ensure!(
        !args.in_place || program.path().is_some(),
        "standard input cannot be changed in place: use -o"
    );
    // A pipe cannot be kept as a copy and replaced, and waits for ever.
    ensure!(
        !args.in_place || path.is_file() || !path.exists(),
        "only a file can be changed in place: use -o"
    );
    refuse_all_clashes(args, &program)?;
    let mut setup = Setup::new(&args.machine, &args.reading, terminal)?;
    dialect::settle(&mut setup, slice::from_mut(&mut program), terminal)?;
    setup.options.certificate = args.certificate.map(Into::into);
    setup.options.rapid_mark.clone_from(&args.mark_rapids);
    let report = args.report.as_deref().map(Target::new).transpose()?;
    let pictures = pictures(args);
    pictures.check(&setup)?;
    let mut rows = Rows::new(report, args.json.as_deref())?.with_page(pictures.is_any());
    let mut frames = pictures.open()?;
    let mut spool = BufWriter::with_capacity(SPOOL_BYTES, target(args, path)?.spool()?);

    let done = (|| {
        program.keep()?;
        let sink = rows.sink();
        let how = options(args);
        let input = program.open()?;
        let options = setup.options_for(&program);
        pipeline::limit(input, &setup.machine, &options, how, &mut spool, sink)
    })();
    let done = done.and_then(|mut summary| {
        let options = setup.options_for(&program);
        let how = self::options(args);
        let input = program.open()?;
        pipeline::price(input, &setup.machine, &options, how, &mut summary)?;
        let input = program.open()?;
        summary.ideal = pipeline::ideal(input, &setup.machine, &options, how, &summary)?;
        Ok(summary)
    });
    let summary = match done {
        Ok(summary) => summary,
        Err(failure) => {
            dialect::failure(&setup, &program, &failure, terminal);
            return Ok(Verdict::Refused);
        }
    };
    let mut spool = spool.into_inner().map_err(io::IntoInnerError::into_error)?;
    let partly = args.partial && !summary.certified && summary.slower;
    if let Some(drawn) = rows.page.take() {
        let found = Found::Limit {
            summary: &summary,
            partly,
        };
        let written = spool.read()?;
        match page::draw_limit(&mut frames, &program, &setup, found, &drawn, written) {
            Ok(()) => {}
            Err(page::Refused::Error(error)) => return Err(error),
            Err(page::Refused::Program(failure)) => {
                dialect::failure(&setup, &program, &failure, terminal);
                return Ok(Verdict::Refused);
            }
        }
    }
    tell(&program.name, &summary, partly, &setup, terminal);
    rows.deliver(|blocks, out| {
        limit_json(&program.name, &setup.machine.name, &summary, blocks, out)
    })?;
    frames.deliver()?;
    if summary.certified || partly {
        deliver(args, &program, &summary, spool, terminal)?;
    }
    Ok(Verdict::of(summary.certified))
}

pub(super) fn options(args: &LimitArgs) -> LimitOptions {
    LimitOptions {
        strategy: args.strategy.into(),
        law: args.law.into(),
        allowed: allowed(&args.allow),
        always: args.always,
        preset_else: args.preset_else.map_or_else(Default::default, Into::into),
    }
}

fn refuse_all_clashes(args: &LimitArgs, program: &Program) -> Result<()> {
    let machine = machine_file(args.machine.machine.as_deref());
    let inputs: Vec<&Path> = program.path().into_iter().chain(machine).collect();
    let program_out = match &args.output {
        Some(path) => Some(path.as_path()),
        None if args.in_place => None,
        None => Some(Path::new("-")),
    };
    let outputs: Vec<&Path> = program_out
        .into_iter()
        .chain(args.report.as_deref())
        .chain(args.json.as_deref())
        .chain(pictures(args).paths())
        .collect();
    refuse_clashes(&inputs, &outputs)
}

fn pictures(args: &LimitArgs) -> Pictures<'_> {
    Pictures {
        html: args.html.as_deref(),
        svg: args.svg.as_deref(),
    }
}

/// Where the program goes. A diff needs only a spool.
fn target(args: &LimitArgs, program: &Path) -> Result<Target> {
    match &args.output {
        _ if args.dry_run => Ok(Target::Stdout),
        _ if args.in_place => Target::new(program),
        Some(path) => Target::new(path),
        None => Ok(Target::Stdout),
    }
}

fn tell(program: &str, summary: &LimitSummary, partly: bool, setup: &Setup, terminal: Terminal) {
    terminal.diagnostics(program, &summary.before.notes);
    terminal.diagnostics(program, &summary.reasons);
    terminal.text(&if partly {
        partial_text(program, summary, &setup.machine)
    } else {
        limit_text(program, summary, &setup.machine)
    });
}

fn deliver(
    args: &LimitArgs,
    program: &Program,
    summary: &LimitSummary,
    mut spool: Spool,
    terminal: Terminal,
) -> Result<()> {
    if args.dry_run {
        let old = BufReader::new(program.open()?);
        let new = BufReader::new(spool.read()?);
        return print(|out: &mut dyn Write| {
            unified_diff(&program.name, program.bytes(), old, new, out)
        });
    }
    let Some(path) = program.path().filter(|_| args.in_place) else {
        return spool.deliver();
    };
    if summary.edited_lines == 0 {
        return Ok(());
    }
    let backup = replace(path, spool)?;
    terminal.note(format_args!(
        "the program as it was is {}",
        backup.display()
    ));
    Ok(())
}

/// Puts the spool in the place of the program, which keeps another name.
fn replace(program: &Path, spool: Spool) -> Result<PathBuf> {
    let program =
        fs::canonicalize(program).with_context(|| format!("cannot write {}", program.display()))?;
    let backup = back_up(&program)?;
    if let Err(error) = spool.deliver() {
        // Nothing is replaced, so there is nothing to go back to.
        let _ = fs::remove_file(&backup);
        return Err(error);
    }
    Ok(backup)
}
