//! `gwatt limit`.

use std::fs;
use std::io::{self, BufReader, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::slice;

use anyhow::{Context, Result, bail, ensure};
use gwatt::pipeline::{self, Failure, LimitSummary};
use gwatt::report::{Found, Verdict, limit_json, limit_text, partial_text, unified_diff};

use super::clash::refuse_clashes;
use super::dialect;
use super::diff_colours::DiffColours;
use super::input::Program;
use super::limit_set;
use super::listing::Listing;
use super::many::{OfMany, each_by_itself};
use super::output::{Spool, Target, back_up, print};
use super::page;
use super::places::Places;
use super::rows::Rows;
use super::settings::Settings;
use super::setup::{Setup, machine_file};
use super::terminal::{Messages, Terminal};
use crate::cli::{HowArgs, LimitArgs, Strategy};

/// Bytes that go to the spool at once.
const SPOOL_BYTES: usize = 1 << 16;

/// How often a program is read as a rule: what each line meets, the changes, the certificate.
const PASSES: u64 = 3;

/// Writes programs that fit.
pub fn run(args: &LimitArgs, terminal: Terminal) -> Result<Verdict> {
    refuse_how(&args.how)?;
    let listing = Listing::of(&args.programs, terminal)?;
    let mut programs = listing.programs();
    let mut args = args.clone();
    let settings = Settings::of(&programs, terminal)?;
    settings.fill(&mut args.machine, &mut args.reading)?;
    settings.allow(&mut args.how.allow);
    let args = &args;
    if args.with_subprograms {
        return limit_set::run(args, &listing, terminal);
    }
    for program in programs.iter().filter(|_| args.in_place) {
        ensure!(
            program.path().is_some(),
            "standard input cannot be changed in place: use -o"
        );
        // A pipe cannot be kept as a copy and replaced, and waits for ever.
        let file = program
            .path()
            .is_some_and(|it| it.is_file() || !it.exists());
        ensure!(file, "only a file can be changed in place: use -o");
    }
    if listing.is_many {
        return limit_each(args, &listing, terminal);
    }
    let [program] = programs.as_mut_slice() else {
        bail!("there is no program");
    };
    let places = places(args);
    refuse_all_clashes(args, program, &places)?;
    let mut setup = setup(args, terminal)?;
    dialect::settle(&mut setup, slice::from_mut(program), terminal)?;
    // Before a diff that follows them, unless they may have to be left out.
    let mut messages = if args.quiet {
        terminal.messages()
    } else {
        terminal.direct()
    };
    let _progress = program.progress(terminal.progress(args.quiet), PASSES);
    let limited = limit_one(args, &setup, program, &places, &mut messages);
    let verdict = limited.as_ref().map(|it| it.verdict());
    if args.quiet && !matches!(verdict, Ok(Some(Verdict::Fits) | None)) {
        terminal.show(&messages);
    }
    Ok(limited?.verdict().unwrap_or(Verdict::Fits))
}

/// Limits several programs, each by itself, into a folder or in place.
fn limit_each(args: &LimitArgs, listing: &Listing, terminal: Terminal) -> Result<Verdict> {
    ensure!(
        args.output.is_some() || args.in_place || args.dry_run,
        "several programs: give a folder by -o, or --in-place (and --with-subprograms if they \
         share files of subprograms)"
    );
    let machine = machine_file(args.machine.machine.as_deref());
    let places = places(args).of_each(listing, machine)?;
    let setup = setup(args, terminal)?;
    let how = OfMany {
        quiet: args.quiet,
        // Diffs are printed as they come.
        at_once: if args.dry_run { 1 } else { usize::MAX },
    };
    each_by_itself(listing.programs(), places, setup, how, terminal, |it| {
        let limited = limit_one(args, it.setup, it.program, it.places, it.messages)?;
        Ok(limited.verdict())
    })
}

/// Refuses options that do not go together.
pub fn refuse_how(how: &HowArgs) -> Result<()> {
    ensure!(
        how.preset_else.is_none() || matches!(how.strategy, Strategy::Preset),
        "--preset-else goes with --strategy preset"
    );
    Ok(())
}

/// What programs are judged with.
pub fn setup(args: &LimitArgs, terminal: Terminal) -> Result<Setup> {
    let mut setup = Setup::new(&args.machine, &args.reading, terminal)?;
    setup.options.certificate = args.how.certificate.map(Into::into);
    setup.options.rapid_mark.clone_from(&args.how.mark_rapids);
    Ok(setup)
}

/// Where the results go; a diff needs no program.
fn places(args: &LimitArgs) -> Places {
    Places {
        program: args.output.clone().filter(|_| !args.dry_run),
        csv: args.report.clone(),
        json: args.json.clone(),
        html: args.html.clone(),
        svg: args.svg.clone(),
    }
}

/// What came of a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Limited {
    /// It is written; `looked_at` is false where it holds only subprograms.
    Written {
        /// Whether there was anything to judge.
        looked_at: bool,
    },
    /// It cannot be made to fit.
    DoesNotFit,
    /// It cannot be read.
    Refused,
}

impl Limited {
    /// `None` where there was nothing to judge.
    pub fn verdict(self) -> Option<Verdict> {
        match self {
            Self::Written { looked_at } => looked_at.then_some(Verdict::Fits),
            Self::DoesNotFit => Some(Verdict::DoesNotFit),
            Self::Refused => Some(Verdict::Refused),
        }
    }
}

/// Limits a program by itself.
pub fn limit_one(
    args: &LimitArgs,
    setup: &Setup,
    program: &Program,
    places: &Places,
    messages: &mut Messages,
) -> Result<Limited> {
    let report = places.csv.as_deref().map(Target::new).transpose()?;
    let pictures = places.pictures();
    pictures.check(setup)?;
    let mut rows = Rows::new(report, places.json.as_deref())?.with_page(pictures.is_any());
    let mut frames = pictures.open()?;
    let target = target(args, program, places)?;
    let mut spool = BufWriter::with_capacity(SPOOL_BYTES, target.spool()?);
    let summary = match limited(args, setup, program, &mut spool, &mut rows) {
        Ok(summary) => summary,
        Err(failure) => {
            dialect::failure(setup, program, &failure, messages);
            return Ok(Limited::Refused);
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
        match page::draw_limit(&mut frames, program, setup, found, &drawn, written) {
            Ok(()) => {}
            Err(page::Refused::Error(error)) => return Err(error),
            Err(page::Refused::Program(failure)) => {
                dialect::failure(setup, program, &failure, messages);
                return Ok(Limited::Refused);
            }
        }
    }
    show(&program.name, &summary, partly, setup, messages);
    rows.deliver(|blocks, out| {
        limit_json(&program.name, &setup.machine.name, &summary, blocks, out)
    })?;
    frames.deliver()?;
    if summary.certified || partly {
        deliver(args, program, &summary, spool, messages)?;
    }
    Ok(if summary.certified {
        Limited::Written {
            looked_at: !summary.before.only_subprograms(),
        }
    } else {
        Limited::DoesNotFit
    })
}

/// The program as it is written goes to the spool, what its moves draw to the rows.
fn limited(
    args: &LimitArgs,
    setup: &Setup,
    program: &Program,
    spool: &mut BufWriter<Spool>,
    rows: &mut Rows,
) -> Result<LimitSummary, Failure> {
    let how = args.how.options();
    let options = setup.options_for(program);
    let machine = &setup.machine;
    let mut summary = pipeline::limit(program.open()?, machine, &options, how, spool, rows.sink())?;
    pipeline::price(program.open()?, machine, &options, how, &mut summary)?;
    summary.ideal = pipeline::ideal(program.open()?, machine, &options, how, &summary)?;
    Ok(summary)
}

fn refuse_all_clashes(args: &LimitArgs, program: &Program, places: &Places) -> Result<()> {
    let machine = machine_file(args.machine.machine.as_deref());
    let inputs: Vec<&Path> = program.path().into_iter().chain(machine).collect();
    let printed = places.program.is_none() && !args.in_place;
    let printed = printed.then_some(Path::new("-"));
    let outputs: Vec<&Path> = places.paths().chain(printed).collect();
    refuse_clashes(&inputs, &outputs)
}

/// Where the program goes. A diff needs only a spool.
fn target(args: &LimitArgs, program: &Program, places: &Places) -> Result<Target> {
    match (&places.program, program.path()) {
        _ if args.dry_run => Ok(Target::Stdout),
        (_, Some(path)) if args.in_place => Target::new(path),
        (Some(path), _) => Target::new(path),
        (None, _) => Ok(Target::Stdout),
    }
}

fn show(
    program: &str,
    summary: &LimitSummary,
    partly: bool,
    setup: &Setup,
    messages: &mut Messages,
) {
    messages.diagnostics(program, &summary.before.notes);
    messages.diagnostics(program, &summary.reasons);
    let style = messages.style();
    messages.text(&if partly {
        partial_text(program, summary, &setup.machine, style)
    } else {
        limit_text(program, summary, &setup.machine, style)
    });
}

fn deliver(
    args: &LimitArgs,
    program: &Program,
    summary: &LimitSummary,
    mut spool: Spool,
    messages: &mut Messages,
) -> Result<()> {
    if args.dry_run {
        let old = BufReader::new(program.open()?);
        let new = BufReader::new(spool.read()?);
        return print(|out: &mut dyn Write| {
            let mut out = DiffColours::new(out, messages.out_style());
            unified_diff(&program.name, program.bytes(), old, new, &mut out)?;
            out.finish()
        });
    }
    let Some(path) = program.path().filter(|_| args.in_place) else {
        return spool.deliver();
    };
    if summary.edited_lines == 0 {
        return Ok(());
    }
    if args.no_backup {
        return spool.deliver();
    }
    let backup = replace(path, spool)?;
    messages.note(format_args!(
        "the program as it was is {}",
        backup.display()
    ));
    Ok(())
}

/// Puts the spool in place of the program, which keeps another name.
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
