//! Results for people: a line a program, and below it what does not fit.

use std::fmt::Write as _;

use super::aligned::aligned;
use super::checked::{Checked, chain};
use super::figure::round_to_digits;
use super::finding::is_regenerative;
use super::over_time::over_time_text;
use super::quantity::{duration, percent, power, three_digits};
use super::style::Style;
use crate::diagnostic::Severity;
use crate::machine::{ALL_AXES, Axis, AxisKind, Machine};
use crate::pipeline::{Certificate, Failure, LimitSummary, SetSummary, Summary, Unfit};
use crate::units::SECONDS_PER_MINUTE;

/// Pauses that are named one by one.
const PAUSES_SHOWN: usize = 20;

/// What `check` says of one program: one line where it fits.
#[must_use]
pub fn check_text(checked: &Checked, machine: &Machine, style: Style) -> String {
    let mut text = verdict_text(checked, machine, style);
    if let Some(held) = &checked.held {
        text.push_str(&held.text());
    }
    text
}

fn verdict_text(checked: &Checked, machine: &Machine, style: Style) -> String {
    let program = &checked.program;
    let no = style.bad("does not fit");
    match &checked.outcome {
        Ok(summary) if summary.only_subprograms() => {
            format!("{program}: only subprograms: nothing of it was looked at\n")
        }
        Ok(summary) if summary.fits() => {
            let fits = style.good("fits");
            let text = format!("{program}: {fits}: {}\n", figures(summary, machine));
            text + &over_time_text(summary)
        }
        Ok(summary) if summary.unfit_count == 0 => {
            let text = format!("{program}: {no}: {}\n", figures(summary, machine));
            text + &over_time_text(summary)
        }
        Ok(summary) => {
            let count = moves(summary.unfit_count);
            let mut text = format!(
                "{program}: {no}: {count} of {} over the limit; {}\n",
                summary.moves,
                figures(summary, machine)
            );
            text.push_str(&worst(summary, style));
            text.push_str(&over_time_text(summary));
            text
        }
        Err(failure) => {
            let refused = style.bad("refused");
            format!("{program}: {refused}: {}\n", refusal(failure))
        }
    }
}

/// Peak, where, time and, if it is not the planned one, the certificate.
fn figures(summary: &Summary, machine: &Machine) -> String {
    let mut text = format!("peak {}", power(summary.peak_w));
    // With several converters the peak may be any one's.
    if let [converter] = machine.converters.as_slice() {
        let limit_w = converter.peak_power_w * (1.0 - machine.limits.margin);
        let _ = write!(text, " of {}", power(limit_w));
    }
    if summary.peak_line > 0 {
        let _ = write!(text, " (line {})", summary.peak_line);
    }
    let _ = write!(text, ", {}", duration(summary.duration_s));
    if summary.certificate == Some(Certificate::Robust) {
        text.push_str(", robust");
    }
    text
}

fn moves(count: u64) -> String {
    let noun = if count == 1 { "move" } else { "moves" };
    format!("{count} {noun}")
}

/// Why a program came to no result.
fn refusal(failure: &Failure) -> String {
    match failure {
        Failure::Refused { diagnostics, more } => {
            let listed = diagnostics
                .iter()
                .filter(|diagnostic| diagnostic.severity == Severity::Error)
                .count() as u64;
            let count = listed + more;
            let noun = if count == 1 { "error" } else { "errors" };
            format!("{count} {noun}")
        }
        other => chain(other),
    }
}

/// The worst moves, one a line, with the line of the program and what helps.
fn worst(summary: &Summary, style: Style) -> String {
    // A cycle has many moves that are alike.
    let mut alike: Vec<(Shown<'_>, u64)> = Vec::new();
    for unfit in &summary.worst {
        let row = Shown::of(unfit);
        match alike.iter_mut().find(|(known, _)| *known == row) {
            Some((_, count)) => *count += 1,
            None => alike.push((row, 1)),
        }
    }
    let width = |cell: usize| {
        let cells = alike.iter().map(|(row, _)| row.cells[cell].chars().count());
        cells.max().unwrap_or(0)
    };
    let taken: usize = INDENT.len() + (0..4).map(|cell| width(cell) + 2).sum::<usize>();
    // What helps stands in the row where there is room for it.
    let in_rows = alike
        .iter()
        .all(|(row, _)| style.has_room(taken + row.after.chars().count() + row.help_chars()));
    let mut helps = Vec::new();
    let rows = alike.iter().map(|(row, count)| {
        let mut after = row.after.clone();
        if !row.help.is_empty() && in_rows {
            let _ = write!(after, "{HELPS}{}", row.help);
        }
        helps.push(row.help);
        if *count > 1 {
            let _ = write!(after, "  ({})", moves(*count));
        }
        let line = style.cut(row.text, taken + after.chars().count());
        let [line_number, what, limit, overload] = row.cells.clone();
        [line_number, what, limit, overload, line + &after]
    });
    let rows: Vec<_> = rows.collect();
    let mut text = aligned(&rows, INDENT);
    if !in_rows {
        let lines = text.lines().zip(&helps);
        let lines = lines.map(|(line, help)| match *help {
            "" => format!("{line}\n"),
            help => {
                let indent = INDENT.len() + HELPS.chars().count();
                let help = style.wrapped(help, indent);
                format!("{line}\n{INDENT}{HELPS}{help}\n")
            }
        });
        text = lines.collect();
    }
    let shown: u64 = summary.worst.iter().map(|unfit| unfit.runs).sum();
    if summary.unfit_count > shown {
        let more = summary.unfit_count - shown;
        let _ = writeln!(text, "  and {more} more: see `gwatt report`");
    }
    text
}

/// What lists are set in by, and what stands before what helps.
const INDENT: &str = "  ";
const HELPS: &str = "  → ";

/// A move of the list of the worst.
#[derive(PartialEq)]
struct Shown<'a> {
    cells: [String; 4],
    /// The line of the program.
    text: &'a [u8],
    /// What stands after it.
    after: String,
    /// What helps; empty where nothing is known.
    help: &'a str,
}

impl<'a> Shown<'a> {
    fn of(unfit: &'a Unfit) -> Self {
        let limit = if is_regenerative(unfit) {
            let limit_w = unfit.regen_limit_w.unwrap_or_default();
            format!("{} of {} fed back", power(unfit.regen_w), power(limit_w))
        } else {
            format!("{} of {}", power(unfit.peak_w), power(unfit.limit_w))
        };
        let mut after = String::new();
        if unfit.runs > 1 {
            let _ = write!(after, "  ({} runs)", unfit.runs);
        }
        if !unfit.file.is_empty() {
            let _ = write!(after, "  in {}", unfit.file);
        }
        Self {
            cells: [
                format!("line {}", unfit.line),
                format!("{} {}", unfit.kind.name(), unfit.axes),
                limit,
                percent(unfit.overload),
            ],
            text: unfit.text.trim_ascii(),
            after,
            help: &unfit.help,
        }
    }

    /// Columns that what helps takes in the row.
    fn help_chars(&self) -> usize {
        match self.help {
            "" => 0,
            help => HELPS.chars().count() + help.chars().count(),
        }
    }
}

/// What `limit` did to a program; its reasons, if it could not, are shown
/// apart with the lines under them.
#[must_use]
pub fn limit_text(
    program: &str,
    summary: &LimitSummary,
    machine: &Machine,
    style: Style,
) -> String {
    let (before, after) = (&summary.before, &summary.after);
    if before.only_subprograms() && summary.certified {
        return format!("{program}: only subprograms: nothing of it was looked at\n");
    }
    if !summary.certified {
        let count = summary.reasons.len();
        let noun = if count == 1 { "reason" } else { "reasons" };
        return format!(
            "{program}: {} ({count} {noun}), nothing is written; it draws {}\n{}{}{}{}",
            style.bad("cannot be made to fit"),
            figures(before, machine),
            worst(after, style),
            over_time_text(after),
            ideal_text(summary),
            price_text(summary)
        );
    }
    let mut text = if summary.edited_lines == 0 {
        let fits = style.good("fits as it is");
        format!("{program}: {fits}: {}\n", figures(before, machine))
    } else {
        format!(
            "{program}: {}: {}; before: peak {}, {}; {} changed\n",
            style.good("fits now"),
            figures(after, machine),
            power(before.peak_w),
            duration(before.duration_s),
            lines(summary.edited_lines)
        )
    };
    text.push_str(&over_time_text(after));
    text.push_str(&pauses_text(summary));
    text.push_str(&ideal_text(summary));
    if let Some(certificate) = after.certificate {
        let _ = writeln!(text, "certificate: {}", certificate.name());
    }
    for condition in &after.conditions {
        let _ = writeln!(text, "  {condition}");
    }
    text
}

/// What would make the program fit, a line for each; nothing where that is not known.
fn price_text(summary: &LimitSummary) -> String {
    let mut text = String::new();
    for price in &summary.prices {
        let [before_s, after_s] = price.duration_s;
        let _ = writeln!(
            text,
            "with --allow {} it fits, in {} instead of {}",
            price.allowed.names(),
            duration(after_s),
            duration(before_s)
        );
    }
    text
}

/// What a word for acceleration would bring; nothing where that is not worth a line.
fn ideal_text(summary: &LimitSummary) -> String {
    let Some(ideal) = &summary.ideal else {
        return String::new();
    };
    let mut text = if summary.certified {
        let less = |seconds: f64| duration(summary.after.duration_s - seconds);
        let whole = summary.after.duration_s - ideal.duration_s;
        let word = "with a word for acceleration between moves: ";
        match ideal.in_pieces_s {
            Some(split_s) if whole < summary.after.duration_s * 1e-3 => {
                format!("{word}{} less, long blocks in pieces", less(split_s))
            }
            Some(split_s) => format!(
                "{word}{} less, with long blocks in pieces {} less",
                less(ideal.duration_s),
                less(split_s)
            ),
            None => format!("{word}{} less", less(ideal.duration_s)),
        }
    } else {
        let soonest_s = ideal.in_pieces_s.unwrap_or(ideal.duration_s);
        let [now, soonest] = [summary.before.duration_s, soonest_s].map(duration);
        let word = "with a word for acceleration between moves it would fit, ";
        if soonest == now {
            format!("{word}as fast as it is now")
        } else {
            format!("{word}in {soonest} instead of {now}")
        }
    };
    if !ideal.settings.is_empty() {
        let _ = write!(text, " ({})", ideal.settings.join("; "));
    }
    text.push('\n');
    text
}

/// Where the written program waits though the original does not; nothing where it does not.
fn pauses_text(summary: &LimitSummary) -> String {
    let pauses = &summary.pauses;
    if pauses.is_empty() {
        return String::new();
    }
    let sum_s: f64 = pauses.iter().map(|pause| pause.seconds).sum();
    let mut text = format!("waits for {} in all (G4), before", duration(sum_s));
    for (place, pause) in pauses.iter().take(PAUSES_SHOWN).enumerate() {
        let comma = if place > 0 { "," } else { "" };
        let _ = write!(
            text,
            "{comma} line {} for {}",
            pause.line,
            duration(pause.seconds)
        );
    }
    if pauses.len() > PAUSES_SHOWN {
        let _ = write!(text, " and {} more", pauses.len() - PAUSES_SHOWN);
    }
    text.push('\n');
    text
}

/// What came of a program that is written though not all of its moves fit.
#[must_use]
pub fn partial_text(
    program: &str,
    summary: &LimitSummary,
    machine: &Machine,
    style: Style,
) -> String {
    let (before, after) = (&summary.before, &summary.after);
    format!(
        "{program}: {}: {} still over the limit; {}; before: peak {}, {}; {} changed\n{}{}{}{}",
        style.bad("not certified"),
        moves(after.unfit_count),
        figures(after, machine),
        power(before.peak_w),
        duration(before.duration_s),
        lines(summary.edited_lines),
        worst(after, style),
        over_time_text(after),
        ideal_text(summary),
        price_text(summary)
    )
}

/// Which files a set of programs consists of, and what was changed in each.
#[must_use]
pub fn set_text(set: &SetSummary, delivered: bool) -> String {
    if !delivered {
        return "nothing is written: the programs are certified together, or none is\n".to_owned();
    }
    let heading = if set.certified() {
        "files of this certificate:\n"
    } else {
        "files that are written without a certificate:\n"
    };
    let mut text = heading.to_owned();
    for file in &set.files {
        let what = match file.edited_lines {
            0 => "as it was".to_owned(),
            count => format!("{} changed", lines(count)),
        };
        let _ = writeln!(text, "  {}: {what}", file.name);
    }
    if set.files.len() > set.programs.len() {
        text.push_str(
            "other programs that call these files are not looked at: give them together\n",
        );
    }
    text
}

fn lines(count: u64) -> String {
    let noun = if count == 1 { "line" } else { "lines" };
    format!("{count} {noun}")
}

/// The axes of a machine, one a line: top speed, acceleration, mass, the force
/// at full acceleration, and the peak power when the axis moves alone.
#[must_use]
pub fn axis_table(machine: &Machine) -> String {
    let rows: Vec<[String; 6]> = machine
        .axis_set
        .iter()
        .filter_map(|index| {
            let axis = machine.axes.get(index)?.as_ref()?;
            Some(axis_row(ALL_AXES.get(index)?.letter() as char, axis))
        })
        .collect();
    aligned(&rows, "  ")
}

/// A number of the machine file: six digits show it, and hide how it was made.
pub(super) fn rounded(value: f64) -> f64 {
    round_to_digits(value, 6)
}

fn axis_row(letter: char, axis: &Axis) -> [String; 6] {
    let (length, mass, force) = match axis.kind {
        AxisKind::Linear => ("mm", "kg", "N"),
        AxisKind::Rotary => ("deg", "kg m2", "Nm"),
    };
    let speed = axis.rapid_mm_s * axis.si_per_unit;
    let driving = axis.mass_kg * axis.accel_mm_s2 * axis.si_per_unit * axis.servo_factor_motor;
    let driving = driving * (1.0 + axis.mass_error);
    let friction = axis.coulomb_n + axis.viscous_n_s_m * speed;
    let load = friction * (1.0 + axis.friction_error) + axis.gravity_n.abs();
    let peak = driving + load;
    let peak_w = speed * peak / axis.efficiency + axis.copper_w_n2 * peak * peak;
    [
        letter.to_string(),
        format!(
            "{} {length}/min",
            rounded(axis.rapid_mm_s * SECONDS_PER_MINUTE)
        ),
        format!("{} {length}/s2", rounded(axis.accel_mm_s2)),
        format!("{} {mass}", three_digits(axis.mass_kg)),
        format!("{} {force}", three_digits(peak)),
        format!("{} alone", power(peak_w)),
    ]
}
