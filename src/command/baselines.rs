//! Known findings: the file of `check --baseline`, and that of `--write-baseline`.

use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use gwatt::report::{Baseline, Checked, Held, Verdict};

use super::clash::refuse_clashes;
use super::input::Program;
use super::output::{Spool, Target};
use super::setup::machine_file;
use super::terminal::Terminal;
use crate::cli::CheckArgs;

/// Names that are shown of programs that a baseline has besides those that were checked.
const SHOWN: usize = 3;

/// The baselines of a run.
#[derive(Debug, Default)]
pub struct Baselines {
    /// What findings are compared with, with the name of its file.
    known: Option<(PathBuf, Baseline)>,
    /// What is to be written, and where.
    written: Option<(PathBuf, Spool, Baseline)>,
    /// Comments count too.
    comments: bool,
    /// Programs so far.
    checked: Vec<String>,
    /// Moves over the limit that no baseline can list.
    not_listed: u64,
}

impl Baselines {
    /// Reads the one that findings are compared with.
    pub fn new(args: &CheckArgs, programs: &[Program]) -> Result<Self> {
        let read = |path: &PathBuf| {
            let shown = path.display();
            let text = fs::read_to_string(path).with_context(|| format!("cannot read {shown}"))?;
            let known = Baseline::read(&text).with_context(|| {
                format!("cannot use {shown} as a baseline (--write-baseline writes one)")
            })?;
            Ok::<_, anyhow::Error>((path.clone(), known))
        };
        if let Some(path) = &args.write_baseline {
            let inputs = programs.iter().filter_map(Program::path);
            let inputs = inputs.chain(machine_file(args.machine.machine.as_deref()));
            let inputs: Vec<&Path> = inputs.collect();
            refuse_clashes(&inputs, &[path.as_path()])?;
        }
        let write = |path: &PathBuf| {
            let spool = Target::new(path)?.spool()?;
            Ok::<_, anyhow::Error>((path.clone(), spool, Baseline::default()))
        };
        Ok(Self {
            known: args.baseline.as_ref().map(read).transpose()?,
            written: args.write_baseline.as_ref().map(write).transpose()?,
            comments: args.known_comments,
            ..Self::default()
        })
    }

    /// Takes what was found of a program, and holds it against what is known.
    pub fn take(&mut self, checked: &mut Checked) {
        if let Ok(summary) = &checked.outcome {
            let nothing = Baseline::default();
            let known = self.known.as_ref().map(|(_, known)| known);
            let compare = if self.comments {
                Held::with_comments
            } else {
                Held::new
            };
            let held = compare(known.unwrap_or(&nothing), &checked.program, summary);
            self.not_listed += held.not_listed();
            if let Some((_, _, written)) = &mut self.written {
                written.add(&checked.program, summary);
            }
            checked.held = (known.is_some() || self.comments).then_some(held);
        }
        self.checked.push(checked.program.clone());
    }

    /// Writes the new one; gives the verdict on the run.
    pub fn finish(self, worst: Verdict, terminal: Terminal) -> Result<Verdict> {
        if let Some((path, known)) = &self.known {
            let others = known.others(&self.checked);
            let shown = others.iter().take(SHOWN).copied().collect::<Vec<_>>();
            let more = if others.len() > SHOWN { " …" } else { "" };
            if !others.is_empty() {
                terminal.note(format_args!(
                    "{} has findings of {} that were not checked: {}{more}",
                    path.display(),
                    programs(others.len()),
                    shown.join(", ")
                ));
            }
        }
        let Some((path, mut spool, written)) = self.written else {
            return Ok(worst);
        };
        let shown = path.display();
        if worst == Verdict::Refused {
            terminal.error(format_args!(
                "{shown} is not written: a program is not read, and no baseline covers that"
            ));
            return Ok(worst);
        }
        if self.not_listed > 0 {
            terminal.note(format_args!(
                "{} moves over the limit are too many to be listed: they stay new",
                self.not_listed
            ));
        }
        let mut text = Vec::new();
        written
            .write(&mut text)
            .and_then(|()| spool.write_all(&text))
            .with_context(|| format!("cannot write {shown}"))?;
        spool.deliver()?;
        let count = written.count();
        let findings = if count == 1 { "finding" } else { "findings" };
        terminal.note(format_args!(
            "{shown}: {count} {findings} in {}",
            programs(written.programs())
        ));
        Ok(Verdict::Fits)
    }
}

fn programs(count: usize) -> String {
    let noun = if count == 1 { "program" } else { "programs" };
    format!("{count} {noun}")
}
