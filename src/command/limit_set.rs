//! `gwatt limit --with-subprograms`.

use std::fs;
use std::io::{BufReader, Read, Write};
use std::path::{Path, PathBuf};

use anyhow::{Result, ensure};
use gwatt::pipeline::{
    Failure, LimitSummary, LineCount, SetFailure, SetFile, SetProgram, SetSummary, limit_set,
};
use gwatt::report::{Verdict, limit_text, partial_text, set_json, set_text, unified_diff};

use super::clash::refuse_clashes;
use super::dialect;
use super::diff_colours::DiffColours;
use super::input::{Program, is_dash};
use super::listing::Listing;
use super::output::{Spool, Target, print};
use super::progress::Progress;
use super::rows::Rows;
use super::set_page::{self, SetRows};
use super::setup::{Setup, machine_file};
use super::terminal::Terminal;
use super::together::Together;
use crate::cli::LimitArgs;

/// Writes programs that fit, with the files of subprograms that they call.
pub fn run(args: &LimitArgs, listing: &Listing, terminal: Terminal) -> Result<Verdict> {
    let mut programs = listing.programs();
    refuse_usage(args, &programs)?;
    let mut setup = Setup::new(&args.machine, &args.reading, terminal)?;
    dialect::settle(&mut setup, &mut programs, terminal)?;
    setup.options.certificate = args.how.certificate.map(Into::into);
    setup.options.rapid_mark.clone_from(&args.how.mark_rapids);
    let count = LineCount::default();
    setup.options.count = Some(count.clone());
    let mut set = Vec::with_capacity(programs.len());
    for program in &programs {
        match read(program, &setup) {
            Ok(read) => set.push(read),
            Err(failure) => {
                terminal.failure(&program.name, &failure);
                return Ok(Verdict::Refused);
            }
        }
    }
    if args.html.is_some() {
        setup.one_way("--html shows")?;
    }
    let report = args.report.as_deref().map(Target::new).transpose()?;
    let rows = Rows::new(report, args.json.as_deref())?;
    let mut rows = SetRows::new(rows, &set, args.html.is_some());
    let page = set_page::open(args.html.as_deref())?;
    let shape = terminal.progress(args.quiet);
    let _progress = Progress::of_lines(shape, &name_of(&programs), count, PASSES);
    let limited = limit_set(&set, &setup.machine, args.how.options(), rows.sink());
    let limited = match limited {
        Ok(limited) => limited,
        Err(SetFailure { program, failure }) => {
            match program.and_then(|place| programs.get(place)) {
                Some(program) => {
                    terminal.say(|it| dialect::failure(&setup, program, &failure, it));
                }
                None => terminal.failure("limit", &failure),
            }
            return Ok(Verdict::Refused);
        }
    };
    let placed = destinations(args, &limited.files);
    refuse_all_clashes(args, &limited.files, &placed)?;
    let partly = partly(args, &limited);
    let page = page
        .map(|page| set_page::draw(page, &set, &setup.machine, &limited, (&rows.pages, partly)));
    let page = page.transpose()?;
    for (program, summary) in programs.iter().zip(&limited.programs) {
        show(&program.name, summary, partly, &setup, terminal);
    }
    write(args, &limited, &placed, terminal, || {
        let names: Vec<&str> = programs.iter().map(|it| it.name.as_str()).collect();
        rows.rows
            .deliver(|blocks, out| set_json(&names, &setup.machine.name, &limited, blocks, out))?;
        page.map_or(Ok(()), Spool::deliver)
    })?;
    Ok(Verdict::of(limited.certified()))
}

/// How often the programs are run through as a rule: what files they call, what each line
/// meets, the changes, and both sides of the certificate.
const PASSES: u64 = 5;

/// What the bar of several programs says.
fn name_of(programs: &[Program]) -> String {
    match programs {
        [program] => program.name.clone(),
        programs => format!("{} programs", programs.len()),
    }
}

/// Whether what can be lowered is written, though not all of it fits.
fn partly(args: &LimitArgs, limited: &SetSummary) -> bool {
    let slower = limited.programs.iter().any(|summary| summary.slower);
    args.partial && !limited.certified() && limited.slower() && slower
}

/// Writes the files, once `reports` has written what is said of them.
fn write(
    args: &LimitArgs,
    limited: &SetSummary,
    placed: &[PathBuf],
    terminal: Terminal,
    reports: impl FnOnce() -> Result<()>,
) -> Result<()> {
    let written = limited.certified() || partly(args, limited);
    terminal.text(&set_text(limited, written));
    let mut together = Together::default();
    if written && !args.dry_run {
        for (file, path) in limited.files.iter().zip(placed) {
            // In place, what is not changed is not touched.
            if !(args.in_place && file.edited_lines == 0) {
                together.add(path, &file.text)?;
            }
        }
    }
    reports()?;
    if written {
        deliver(args, limited, together, terminal)?;
    }
    Ok(())
}

fn refuse_usage(args: &LimitArgs, programs: &[Program]) -> Result<()> {
    ensure!(
        programs.iter().all(|program| program.path().is_some()),
        "--with-subprograms: standard input lies in no folder: give the program's file"
    );
    let Some(folder) = &args.output else {
        ensure!(
            args.in_place || args.dry_run,
            "--with-subprograms writes several files: give a folder by -o, or --in-place"
        );
        return Ok(());
    };
    ensure!(
        !is_dash(folder) && (folder.is_dir() || !folder.exists()),
        "--with-subprograms writes several files: -o {} is no folder",
        folder.display()
    );
    Ok(())
}

fn read(program: &Program, setup: &Setup) -> Result<SetProgram, Failure> {
    let mut text = Vec::new();
    let mut file = program.open()?;
    file.read_to_end(&mut text).map_err(Failure::Input)?;
    Ok(SetProgram {
        name: program.name.clone(),
        path: program.path().unwrap_or(Path::new("-")).to_owned(),
        text: text.into(),
        options: setup.options_for(program),
    })
}

/// Where each file is to go: into the folder that is asked for, in the same folders below
/// it as the originals lie in below the folder that holds them all; or in its own place.
fn destinations(args: &LimitArgs, files: &[SetFile]) -> Vec<PathBuf> {
    let Some(into) = args.output.as_ref().filter(|_| !args.dry_run) else {
        return files.iter().map(|file| file.path.clone()).collect();
    };
    let folders = files.iter().filter_map(|file| file.path.parent());
    let common = folders.map(Path::to_owned).reduce(|common, folder| {
        let shared = common.components().zip(folder.components());
        shared
            .take_while(|(own, other)| own == other)
            .map(|(own, _)| own)
            .collect()
    });
    let common = common.unwrap_or_default();
    let below = |file: &SetFile| {
        let relative = file.path.strip_prefix(&common).ok();
        into.join(relative.unwrap_or(Path::new("")))
    };
    files.iter().map(below).collect()
}

fn refuse_all_clashes(args: &LimitArgs, files: &[SetFile], placed: &[PathBuf]) -> Result<()> {
    let machine = machine_file(args.machine.machine.as_deref());
    let files = files.iter().map(|file| file.path.as_path());
    let inputs: Vec<&Path> = files.chain(machine).collect();
    let placed = placed.iter().map(PathBuf::as_path);
    let outputs: Vec<&Path> = placed
        .filter(|_| args.output.is_some() && !args.dry_run)
        .chain(args.report.as_deref())
        .chain(args.json.as_deref())
        .chain(args.html.as_deref())
        .collect();
    refuse_clashes(&inputs, &outputs)?;
    if args.in_place {
        // Two names of one file: it cannot hold both.
        refuse_clashes(&[], &inputs)?;
    }
    Ok(())
}

fn show(program: &str, summary: &LimitSummary, partly: bool, setup: &Setup, terminal: Terminal) {
    terminal.diagnostics(program, &summary.before.notes);
    terminal.diagnostics(program, &summary.reasons);
    let style = terminal.style();
    terminal.text(&if partly && !summary.certified {
        partial_text(program, summary, &setup.machine, style)
    } else {
        limit_text(program, summary, &setup.machine, style)
    });
}

fn deliver(
    args: &LimitArgs,
    limited: &SetSummary,
    together: Together,
    terminal: Terminal,
) -> Result<()> {
    if args.dry_run {
        return print(|out: &mut dyn Write| {
            let mut out = DiffColours::new(out, terminal.out_style());
            for file in limited.files.iter().filter(|file| file.edited_lines > 0) {
                let old = fs::File::open(&file.path)?;
                let bytes = old.metadata()?.len();
                let new = file.text.as_slice();
                unified_diff(&file.name, bytes, BufReader::new(old), new, &mut out)?;
            }
            out.finish()
        });
    }
    let backups = together.deliver()?;
    for backup in backups {
        if args.in_place && !args.no_backup {
            terminal.note(format_args!("a file as it was is {}", backup.display()));
        } else {
            // What stood there before is replaced for good.
            let _ = fs::remove_file(&backup);
        }
    }
    Ok(())
}
