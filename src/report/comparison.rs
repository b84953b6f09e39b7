//! Two machines over the same programs.

use std::fmt::Write as _;
use std::io::{self, Write};

use serde::Serialize;

use super::aligned::{GAP, aligned, widths};
use super::checked::Verdict;
use super::figure::Figure;
use super::quantity::{duration, energy, power};
use super::style::Style;
use crate::pipeline::{Failure, OverTime, Summary};

/// Changes that are listed a program.
const LISTED_MAX: usize = 10;
/// Columns that a name of a program needs at least to stand next to its figures.
const NAME_LEAST: usize = 18;

/// A move that fits on one machine only.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Change {
    /// Line from 1.
    pub line: u64,
    /// The file that it stands in; empty for the program itself.
    pub file: String,
    /// True: it fits on the second machine only.
    pub begins: bool,
}

/// One program on two machines.
#[derive(Debug)]
pub struct Comparison {
    /// The program's name as it was given.
    pub program: String,
    /// Its figures on the first machine.
    pub from: Result<Summary, Failure>,
    /// Its figures on the second machine.
    pub to: Result<Summary, Failure>,
    /// Moves that fit on the second machine only.
    pub begin: u64,
    /// Moves that fit on the first machine only.
    pub cease: u64,
    /// The first changes.
    pub changes: Vec<Change>,
}

impl Comparison {
    /// Counts a change, and keeps it if it is among the first.
    pub fn count(&mut self, change: Change) {
        if change.begins {
            self.begin += 1;
        } else {
            self.cease += 1;
        }
        if self.changes.len() < LISTED_MAX {
            self.changes.push(change);
        }
    }

    /// How many limits over time begin and cease to fit.
    #[must_use]
    pub fn limit_changes(&self) -> [usize; 2] {
        match (&self.from, &self.to) {
            (Ok(from), Ok(to)) => {
                [(from, to), (to, from)].map(|(one, other)| exceeded_beyond(one, other).count())
            }
            _ => [0; 2],
        }
    }

    /// Does not fit when something fits on the first machine only.
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        match (&self.from, &self.to) {
            (Ok(from), Ok(to)) => {
                Verdict::of(self.cease == 0 && exceeded_beyond(to, from).next().is_none())
            }
            _ => Verdict::Refused,
        }
    }
}

/// Limits over time that a program exceeds on one machine, but not on the other
/// one, be it that it has none.
fn exceeded_beyond<'a>(one: &'a Summary, other: &'a Summary) -> impl Iterator<Item = &'a OverTime> {
    let exceeded = |summary: &'a Summary| {
        let limits = summary.over_time.iter();
        limits.filter(|limit| limit.rating.is_missed())
    };
    let same = |a: &OverTime, b: &OverTime| {
        a.converter == b.converter && a.rating.measure.name() == b.rating.measure.name()
    };
    exceeded(one).filter(move |limit| !exceeded(other).any(|it| same(limit, it)))
}

/// A table with a line a program, and below it what begins and ceases to fit.
#[must_use]
pub fn comparison_text(comparisons: &[Comparison], from: &str, to: &str, style: Style) -> String {
    let pair = |a: String, b: String| format!("{a} → {b}");
    let figures = comparisons.iter().map(|comparison| {
        let (Ok(before), Ok(after)) = (&comparison.from, &comparison.to) else {
            return ["refused", "", "", "", ""].map(String::from);
        };
        [
            pair(power(before.peak_w), power(after.peak_w)),
            pair(duration(before.duration_s), duration(after.duration_s)),
            pair(
                energy(before.energy_j.unwrap_or_default()),
                energy(after.energy_j.unwrap_or_default()),
            ),
            comparison.begin.to_string(),
            comparison.cease.to_string(),
        ]
    });
    let heads = ["peak", "time", "energy", "begin to fit", "cease to fit"].map(String::from);
    let figures: Vec<_> = std::iter::once(heads).chain(figures).collect();
    let taken: usize = widths(&figures).iter().map(|width| width + GAP).sum();
    let room = style.columns.unwrap_or(usize::MAX).saturating_sub(taken);
    // Where hardly anything is left for names, they stand on lines of their own.
    let own_lines = style.columns.is_some() && room < NAME_LEAST;
    let names = comparisons.iter().map(|it| it.program.as_str());
    let names: Vec<&str> = std::iter::once("program").chain(names).collect();
    let table = if own_lines {
        let mut text = String::new();
        let rows = aligned(&figures, "  ");
        let mut rows = rows.lines();
        let _ = writeln!(text, "{}", rows.next().unwrap_or_default());
        for (name, row) in names.iter().skip(1).zip(rows) {
            let columns = style.columns.unwrap_or(usize::MAX);
            let _ = writeln!(text, "{}\n{row}", style.cut_name(name, columns));
        }
        text
    } else {
        let rows = names.iter().zip(&figures).map(|(name, row)| {
            let [peak, time, energy, begin, cease] = row.clone();
            let name = style.cut_name(name, room.saturating_sub(GAP));
            [name, peak, time, energy, begin, cease]
        });
        aligned(&rows.collect::<Vec<_>>(), "")
    };
    let mut changes = String::new();
    for comparison in comparisons {
        let (Ok(before), Ok(after)) = (&comparison.from, &comparison.to) else {
            continue;
        };
        changes.push_str(&listed(comparison, style));
        for (one, other, begins) in [(after, before, false), (before, after, true)] {
            for limit in exceeded_beyond(one, other) {
                let fit = begins_or_ceases(begins, 1, style);
                let _ = writeln!(changes, "{}: {} {fit}", comparison.program, limit.title());
            }
        }
    }
    format!("from {from}\nto   {to}\n\n{table}{changes}")
}

fn begins_or_ceases(begins: bool, count: usize, style: Style) -> String {
    match (begins, count) {
        (true, 1) => style.good("begins to fit"),
        (true, _) => style.good("begin to fit"),
        (false, 1) => style.bad("ceases to fit"),
        (false, _) => style.bad("cease to fit"),
    }
}

/// The changes of a program: a row for each file and each way.
fn listed(comparison: &Comparison, style: Style) -> String {
    let mut rows: Vec<(&str, bool, Vec<String>)> = Vec::new();
    for change in &comparison.changes {
        let line = change.line.to_string();
        let own = rows
            .iter_mut()
            .find(|(file, begins, _)| *file == change.file && *begins == change.begins);
        match own {
            Some((_, _, lines)) => lines.push(line),
            None => rows.push((&change.file, change.begins, vec![line])),
        }
    }
    let program = &comparison.program;
    let mut text = String::new();
    for (file, begins, lines) in rows {
        let noun = if lines.len() == 1 { "line" } else { "lines" };
        let fit = begins_or_ceases(begins, lines.len(), style);
        let file = match file {
            "" => String::new(),
            file => format!(" of {file}"),
        };
        let _ = writeln!(text, "{program}: {noun} {}{file} {fit}", lines.join(", "));
    }
    let more = comparison.begin + comparison.cease - comparison.changes.len() as u64;
    if more > 0 {
        let _ = writeln!(text, "{program}: and {more} more");
    }
    text
}

#[derive(Serialize)]
struct Line<'a> {
    program: &'a str,
    from: &'a str,
    to: &'a str,
    peak_from_w: Figure,
    peak_to_w: Figure,
    regen_from_w: Figure,
    regen_to_w: Figure,
    duration_from_s: Figure,
    duration_to_s: Figure,
    energy_from_j: Option<Figure>,
    energy_to_j: Option<Figure>,
    unfit_from: u64,
    unfit_to: u64,
    begin_to_fit: u64,
    cease_to_fit: u64,
    limits_begin_to_fit: usize,
    limits_cease_to_fit: usize,
}

/// The table as CSV, without programs that are refused.
///
/// # Errors
/// Those of `out`.
pub fn comparison_csv(
    comparisons: &[Comparison],
    from: &str,
    to: &str,
    out: impl Write,
) -> io::Result<()> {
    let mut out = csv::WriterBuilder::new()
        .terminator(csv::Terminator::CRLF)
        .from_writer(out);
    for comparison in comparisons {
        let (Ok(before), Ok(after)) = (&comparison.from, &comparison.to) else {
            continue;
        };
        let [limits_begin, limits_cease] = comparison.limit_changes();
        out.serialize(Line {
            program: &comparison.program,
            from,
            to,
            peak_from_w: Figure(before.peak_w),
            peak_to_w: Figure(after.peak_w),
            regen_from_w: Figure(before.regen_w),
            regen_to_w: Figure(after.regen_w),
            duration_from_s: Figure(before.duration_s),
            duration_to_s: Figure(after.duration_s),
            energy_from_j: before.energy_j.map(Figure),
            energy_to_j: after.energy_j.map(Figure),
            unfit_from: before.unfit_count,
            unfit_to: after.unfit_count,
            begin_to_fit: comparison.begin,
            cease_to_fit: comparison.cease,
            limits_begin_to_fit: limits_begin,
            limits_cease_to_fit: limits_cease,
        })?;
    }
    out.flush()
}
