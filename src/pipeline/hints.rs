//! What `check` says of moves that do not fit is what `limit` does.

use std::collections::BTreeMap;
use std::io::{self, Read, Seek};

use super::advice::{FEED_OPTION, FITS, SPINDLE_HELP};
use super::expand::WRITTEN_OUT;
use super::limiting::{first_reasons, limit};
use super::pause;
use super::source::Source;
use super::summary::AT_LENGTH_MAX;
use super::{
    Allowed, Failure, Law, LimitOptions, Options, Restart, RestartRows, Row, RowSink, Strategy,
    Summary,
};

use crate::diagnostic::Diagnostic;
use crate::machine::Machine;

/// What helps where a cycle has to be written out.
const EXPAND: &str = "`limit --allow expand` writes the canned cycle out and lowers its moves";

/// What is said of lines that get no words of their own.
const PLACED: &str = "fits with its moves on lines of their own, as `limit` writes them";
const NEXT_TO: &str = "fits by what `limit` writes next to it";

/// What is said before the advice for a move whose neighbours were not looked at.
const BY_ITSELF: &str = "by itself it ";

/// Lets the limiter decide about a program that does not fit: where it could not lower a
/// move, its own reason stands in place of the advice in `summary`.
///
/// # Errors
/// See [`Failure`].
pub fn take_hints<R: Read + Seek + Send>(
    mut input: R,
    machine: &Machine,
    options: &Options,
    summary: &mut Summary,
) -> Result<(), Failure> {
    hints_of(&mut input, machine, options, summary)
}

fn hints_of(
    mut input: &mut dyn Source,
    machine: &Machine,
    options: &Options,
    summary: &mut Summary,
) -> Result<(), Failure> {
    input.rewind().map_err(Failure::Input)?;
    let over_time = summary.over_time.iter_mut();
    pause::advise(&mut input, machine, options, over_time)?;
    if summary.unfit_count == 0 {
        return Ok(());
    }
    let unfit = summary.unfit.iter().chain(&summary.worst);
    let lines = unfit.filter(|unfit| unfit.file.is_empty());
    let mut written = Written {
        lines: lines.map(|unfit| (unfit.line, Line::default())).collect(),
    };
    // Of longer programs the advice is that for each move by itself, and says so.
    let looks = summary.moves <= AT_LENGTH_MAX;
    let mut reasons = |expand, rows: Option<&mut dyn RestartRows>| {
        input.rewind().map_err(Failure::Input)?;
        let how = advised(expand);
        let found = if looks {
            limit(&mut input, machine, options, how, io::sink(), rows)?.reasons
        } else {
            first_reasons(input, machine, options, how)?
        };
        Ok(first_by_line(found))
    };
    if !looks {
        for unfit in summary.unfit.iter_mut().chain(&mut summary.worst) {
            if unfit.help.starts_with(FITS) {
                unfit.help.insert_str(0, BY_ITSELF);
            }
        }
    }
    let as_it_stands = reasons(false, Some(&mut written))?;
    for unfit in summary.unfit.iter_mut().chain(&mut summary.worst) {
        let refused = as_it_stands.contains_key(&unfit.line);
        let line = written.lines.get(&unfit.line).filter(|_| !refused);
        let help = line.and_then(Line::help);
        // What was advised for a move by itself gives way to what is written, save where no
        // word helps.
        if let Some(help) = help
            && unfit.file.is_empty()
            && unfit.help != SPINDLE_HELP
        {
            help.clone_into(&mut unfit.help);
        }
    }
    let has_cycles = machine.controller.language.family.facts().writes_out_cycles;
    if as_it_stands.is_empty() || !has_cycles {
        use_reasons(summary, &as_it_stands, &as_it_stands);
        return Ok(());
    }
    use_reasons(summary, &as_it_stands, &reasons(true, None)?);
    Ok(())
}

/// The first reason of each line.
fn first_by_line(found: Vec<Diagnostic>) -> BTreeMap<u64, Diagnostic> {
    let mut reasons = BTreeMap::new();
    for reason in found {
        reasons.entry(reason.line).or_insert(reason);
    }
    reasons
}

/// Puts the limiter's own reasons in place of the advice for lines that it could not lower: as the
/// program stands, and with its cycles written out.
fn use_reasons(
    summary: &mut Summary,
    as_it_stands: &BTreeMap<u64, Diagnostic>,
    written_out: &BTreeMap<u64, Diagnostic>,
) {
    for unfit in summary.unfit.iter_mut().chain(&mut summary.worst) {
        if !unfit.file.is_empty() || !as_it_stands.contains_key(&unfit.line) {
            continue;
        }
        // Where it stays as it is although cycles may be written out, nothing asks for that.
        let written_out = written_out.get(&unfit.line);
        unfit.help = match written_out.map(|it| (&it.message, &it.help)) {
            None => EXPAND.to_owned(),
            Some((message, Some(help))) => format!("{message}: {help}"),
            Some((message, None)) => message.clone(),
        };
    }
}

/// How the limiter is asked for advice.
fn advised(expand: bool) -> LimitOptions {
    LimitOptions {
        strategy: Strategy::Optimal,
        law: Law::Exact,
        allowed: Allowed {
            feed: true,
            expand,
            ..Allowed::NOTHING
        },
        ..LimitOptions::USUAL
    }
}

/// The program that the advice of [`take_hints`] comes to, and whether canned cycles are
/// written out in it; `None` where none can be certified. It is held in memory.
///
/// # Errors
/// See [`Failure`].
pub fn as_advised<R: Read + Seek + Send>(
    mut input: R,
    machine: &Machine,
    options: &Options,
) -> Result<Option<(Vec<u8>, bool)>, Failure> {
    for expand in [false, true] {
        input.rewind().map_err(Failure::Input)?;
        let mut text = Vec::new();
        let how = advised(expand);
        if limit(&mut input, machine, options, how, &mut text, None)?.certified {
            return Ok(Some((text, expand)));
        }
    }
    Ok(None)
}

/// What becomes of each line.
struct Written {
    lines: BTreeMap<u64, Line>,
}

/// What becomes of a line.
#[derive(Default)]
struct Line {
    /// The words that it gets, with the lowest value of the first of them.
    words: Option<(Option<f64>, String)>,
    /// Whether all its moves fit then; `None`: it has none.
    fits: Option<bool>,
    /// It is a cycle in another form.
    placed: bool,
}

impl Line {
    fn help(&self) -> Option<&str> {
        match &self.words {
            Some((_, words)) => Some(words),
            None if self.fits != Some(true) => None,
            None if self.placed => Some(PLACED),
            None => Some(NEXT_TO),
        }
    }
}

/// What rounding may make of a limit.
const ROUNDED: f64 = 1.0 + 1e-6;

/// Whether a move fits as it is written.
fn fits_after(row: &Row) -> bool {
    let within = |found: Option<f64>, limit: f64| found.is_some_and(|it| it <= limit * ROUNDED);
    let regen = row.regen_limit_w;
    within(row.peak_after_w, row.limit_w)
        && regen.is_none_or(|limit| within(row.regen_after_w, limit))
}

impl RowSink for Written {
    fn row(&mut self, row: &Row) -> io::Result<()> {
        let line = self.lines.get_mut(&row.line);
        let Some(line) = line.filter(|_| row.file.is_empty()) else {
            return Ok(());
        };
        line.fits = Some(line.fits != Some(false) && fits_after(row));
        line.placed |= row.action == WRITTEN_OUT;
        let known = &mut line.words;
        let value = row.value_after;
        if value.is_none() && row.words.is_empty() {
            return Ok(());
        }
        // A level has no value.
        let lower = |lowest: Option<f64>| match (value, lowest) {
            (Some(value), Some(lowest)) => value < lowest,
            (value, _) => value.is_some(),
        };
        if known.as_ref().is_none_or(|(lowest, _)| lower(*lowest)) {
            *known = Some((value, words(row)));
        }
        Ok(())
    }

    fn wants_figures(&self) -> bool {
        false
    }
}

impl Restart for Written {
    fn restart(&mut self) -> io::Result<()> {
        self.lines
            .values_mut()
            .for_each(|line| *line = Line::default());
        Ok(())
    }
}

/// What the limiter writes for a move.
fn words(row: &Row) -> String {
    let option = if row.feed_allowed { FEED_OPTION } else { "" };
    format!("{FITS}{}{option}", row.words)
}
