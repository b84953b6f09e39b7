//! Results as workflow commands: annotations next to the lines of a change on
//! GitHub.

use std::io::{self, Write};

use super::checked::{Checked, Verdict, chain};
use super::finding::{PEAK_POWER, REGEN_POWER, is_regenerative};
use super::held::Held;
use super::over_time::message;
use super::quantity::{percent, power};
use crate::diagnostic::{Diagnostic, Severity};
use crate::pipeline::{Failure, Summary, Unfit};

/// Annotations that GitHub shows of one step.
const ANNOTATIONS_MAX: usize = 10;

/// Writes the worst findings as errors, then a notice with the counts.
///
/// # Errors
/// Those of `out`.
pub fn github(checked: &[Checked], mut out: impl Write) -> io::Result<()> {
    let mut commands: Vec<(f64, String)> = checked.iter().flat_map(annotations).collect();
    // Stable: equals stay in the order of programs and lines.
    commands.sort_by(|a, b| b.0.total_cmp(&a.0));
    for (_, command) in commands.iter().take(ANNOTATIONS_MAX) {
        writeln!(out, "{command}")?;
    }
    let count = |verdict| {
        checked
            .iter()
            .filter(|checked| checked.verdict() == verdict)
            .count()
    };
    writeln!(
        out,
        "::notice title=gwatt::{} fit, {} do not fit, {} refused",
        count(Verdict::Fits),
        count(Verdict::DoesNotFit),
        count(Verdict::Refused)
    )
}

/// The annotations of one program with their weights; refusals come first.
fn annotations(checked: &Checked) -> Vec<(f64, String)> {
    let program = &checked.program;
    // What a baseline has is no news.
    let held = checked.held.as_ref();
    match &checked.outcome {
        Ok(summary) => summary
            .worst
            .iter()
            .filter(|unfit| held.is_none_or(|held| !held.has_move(unfit)))
            .map(|unfit| (unfit.overload, unfit_command(program, unfit)))
            .chain(missed(program, summary, held))
            .collect(),
        Err(Failure::Refused { diagnostics, .. }) => diagnostics
            .iter()
            .filter(|diagnostic| diagnostic.severity == Severity::Error)
            .map(|diagnostic| (f64::INFINITY, refusal_command(program, diagnostic)))
            .collect(),
        Err(failure) => vec![(f64::INFINITY, command(program, 0, "gwatt", &chain(failure)))],
    }
}

/// Limits over time that are not kept.
fn missed<'a>(
    program: &'a str,
    summary: &'a Summary,
    held: Option<&'a Held>,
) -> impl Iterator<Item = (f64, String)> + 'a {
    let missed = summary.over_time.iter().filter(|it| it.rating.is_missed());
    let missed = missed.filter(move |it| held.is_none_or(|held| !held.has_limit(it)));
    missed.map(move |found| {
        let program = if found.file.is_empty() {
            program
        } else {
            &found.file
        };
        let rating = &found.rating;
        let title = rating.measure.name();
        (
            rating.load_ratio(),
            command(program, rating.line, title, &message(found)),
        )
    })
}

fn unfit_command(program: &str, unfit: &Unfit) -> String {
    let program = if unfit.file.is_empty() {
        program
    } else {
        &unfit.file
    };
    let (title, what, power_w, limit_w) = if is_regenerative(unfit) {
        let limit_w = unfit.regen_limit_w.unwrap_or_default();
        (REGEN_POWER, "feeds back", unfit.regen_w, limit_w)
    } else {
        (PEAK_POWER, "draws", unfit.peak_w, unfit.limit_w)
    };
    let mut message = format!(
        "{} {} {what} {} of {} ({})",
        unfit.kind.name(),
        unfit.axes,
        power(power_w),
        power(limit_w),
        percent(unfit.overload)
    );
    if !unfit.help.is_empty() {
        message.push_str("; ");
        message.push_str(&unfit.help);
    }
    command(program, unfit.line, title, &message)
}

fn refusal_command(program: &str, diagnostic: &Diagnostic) -> String {
    let program = diagnostic.file.as_deref().unwrap_or(program);
    let mut message = diagnostic.message.clone();
    if let Some(help) = &diagnostic.help {
        message.push_str("; ");
        message.push_str(help);
    }
    command(program, diagnostic.line, diagnostic.rule, &message)
}

fn command(program: &str, line: u64, title: &str, message: &str) -> String {
    let line = if line > 0 {
        format!(",line={line}")
    } else {
        String::new()
    };
    format!(
        "::error file={}{line},title={}::{}",
        escape_property(program),
        escape_property(title),
        escape(message)
    )
}

/// A message may hold neither line ends nor `%`.
fn escape(text: &str) -> String {
    text.replace('%', "%25")
        .replace('\r', "%0D")
        .replace('\n', "%0A")
}

/// A property, moreover, neither `:` nor `,`.
fn escape_property(text: &str) -> String {
    escape(text).replace(':', "%3A").replace(',', "%2C")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_escaped() {
        let checked = Checked {
            program: "a,b:c\n.ngc".into(),
            outcome: Err(Failure::Unsuitable("100 % wrong".into())),
            changes: None,
            held: None,
        };
        let mut out = Vec::new();
        assert!(github(&[checked], &mut out).is_ok());
        insta::assert_snapshot!(String::from_utf8_lossy(&out), @"
        ::error file=a%2Cb%3Ac%0A.ngc,title=gwatt::100 %25 wrong
        ::notice title=gwatt::0 fit, 0 do not fit, 1 refused
        ");
    }
}
