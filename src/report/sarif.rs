//! Results as SARIF 2.1.0, for code scanning.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::io::{self, Write};

use serde_sarif::sarif::{
    ArtifactChange, ArtifactContent, ArtifactLocation, Fix, Location, Message,
    MultiformatMessageString, PhysicalLocation, Region, Replacement, ReportingDescriptor,
    Result as Finding, ResultLevel, Run, SCHEMA_URL, Sarif, Tool, ToolComponent, Version,
};

use super::checked::{Changes, Checked, chain};
use super::finding::{PEAK_POWER, REGEN_POWER, is_regenerative};
use super::over_time::message;
use super::quantity::power;
use crate::diagnostic::{Diagnostic, Severity};
use crate::pipeline::{Failure, OverTime, Unfit};
use crate::rules;

const UNREADABLE: &str = "unreadable";

/// Writes one run with a result for each move that does not fit and for each
/// diagnostic. `rules_url` is where the pages of `docs/rules` can be read, if anywhere.
///
/// # Errors
/// Those of `out`.
pub fn sarif(checked: &[Checked], rules_url: Option<&str>, mut out: impl Write) -> io::Result<()> {
    let results: Vec<Finding> = checked.iter().flat_map(findings).collect();
    let driver = ToolComponent::builder()
        .name("gwatt")
        .version(env!("CARGO_PKG_VERSION").to_owned())
        .rules(described(&results, rules_url))
        .build();
    let run = Run::builder()
        .tool(Tool::builder().driver(driver).build())
        .column_kind(serde_json::Value::from("unicodeCodePoints"))
        .results(results)
        .build();
    let sarif = Sarif::builder()
        .version(Version::V2_1_0.to_string())
        .schema(SCHEMA_URL.to_owned())
        .runs(vec![run])
        .build();
    serde_json::to_writer_pretty(&mut out, &sarif)?;
    writeln!(out)
}

/// The rules that the results name, in alphabetical order, with the texts of `gwatt explain`.
fn described(results: &[Finding], rules_url: Option<&str>) -> Vec<ReportingDescriptor> {
    let names = results.iter().filter_map(|result| result.rule_id.clone());
    let names: BTreeSet<String> = names.collect();
    let text = |text: String| MultiformatMessageString::builder().text(text).build();
    let describe = |name: String| {
        let Some(rule) = rules::find(&name) else {
            return ReportingDescriptor::builder().id(name).build();
        };
        let help = MultiformatMessageString::builder()
            .text(rule.text)
            .markdown(rule.text)
            .build();
        let mut described = ReportingDescriptor::builder()
            .id(name)
            .short_description(text(rule.summary()))
            .full_description(text(rule.meaning()))
            .help(help)
            .build();
        described.help_uri = rules_url.map(|url| {
            let url = url.trim_end_matches('/');
            format!("{url}/{}#{}", rule.page, rule.name)
        });
        described
    };
    names.into_iter().map(describe).collect()
}

fn findings(checked: &Checked) -> Vec<Finding> {
    let program = checked.program.as_str();
    match &checked.outcome {
        Ok(summary) => {
            let notes = summary.notes.iter();
            let unfit = summary.unfit.iter();
            let over_time = summary.over_time.iter();
            let held = checked.held.as_ref();
            let mut fixes = checked.changes.as_ref().map(|it| vec![fix(program, it)]);
            let unfit = unfit.map(|unfit| {
                let mut found = unfit_finding(program, unfit);
                // All changes belong together: they stand at the first move.
                found.fixes = fixes.take();
                found.baseline_state = state(held.map(|held| held.has_move(unfit)));
                found
            });
            notes
                .map(|note| diagnostic_finding(program, note))
                .chain(unfit)
                .chain(
                    over_time
                        .filter(|found| found.rating.is_missed())
                        .map(|found| {
                            let mut result = over_time_finding(program, found);
                            result.baseline_state = state(held.map(|held| held.has_limit(found)));
                            result
                        }),
                )
                .collect()
        }
        Err(Failure::Refused { diagnostics, .. }) => diagnostics
            .iter()
            .map(|diagnostic| diagnostic_finding(program, diagnostic))
            .collect(),
        Err(failure) => vec![finding(
            UNREADABLE,
            ResultLevel::Error,
            chain(failure),
            location(program, None),
        )],
    }
}

fn unfit_finding(program: &str, unfit: &Unfit) -> Finding {
    let program = if unfit.file.is_empty() {
        program
    } else {
        &unfit.file
    };
    let (rule, mut message) = if is_regenerative(unfit) {
        let limit = power(unfit.regen_limit_w.unwrap_or_default());
        let message = format!("feeds back {} of {limit}", power(unfit.regen_w));
        (REGEN_POWER, message)
    } else {
        let (peak, limit) = (power(unfit.peak_w), power(unfit.limit_w));
        (PEAK_POWER, format!("draws {peak} of {limit}"))
    };
    message.insert_str(0, &format!("{} {} ", unfit.kind.name(), unfit.axes));
    if !unfit.help.is_empty() {
        message.push_str("; ");
        message.push_str(&unfit.help);
    }
    let region = Region::builder()
        .start_line(unfit.line.cast_signed())
        .build();
    let place = location(program, Some(region));
    finding(rule, ResultLevel::Error, message, place)
}

fn over_time_finding(program: &str, found: &OverTime) -> Finding {
    let program = if found.file.is_empty() {
        program
    } else {
        &found.file
    };
    let line = found.rating.line;
    let region = (line > 0).then(|| Region::builder().start_line(line.cast_signed()).build());
    let rule = found.rating.measure.name();
    let place = location(program, region);
    finding(rule, ResultLevel::Error, message(found), place)
}

fn diagnostic_finding(program: &str, diagnostic: &Diagnostic) -> Finding {
    let program = diagnostic.file.as_deref().unwrap_or(program);
    let level = match diagnostic.severity {
        Severity::Error => ResultLevel::Error,
        Severity::Warning => ResultLevel::Warning,
        Severity::Note => ResultLevel::Note,
    };
    let mut message = diagnostic.message.clone();
    if let Some(help) = &diagnostic.help {
        message.push_str("; ");
        message.push_str(help);
    }
    let region = (diagnostic.line > 0).then(|| {
        let column = i64::from(diagnostic.column.max(1));
        Region::builder()
            .start_line(diagnostic.line.cast_signed())
            .start_column(column)
            .end_column(column + i64::from(diagnostic.span.len().max(1)))
            .build()
    });
    let place = location(program, region);
    finding(diagnostic.rule, level, message, place)
}

/// What a baseline says of a result, where there is one.
fn state(known: Option<bool>) -> Option<serde_json::Value> {
    known.map(|known| serde_json::Value::from(if known { "unchanged" } else { "new" }))
}

/// The changes that make a program fit. They were certified together: one fix has them all.
fn fix(program: &str, changes: &Changes) -> Fix {
    let replacements = changes.edits.iter().map(|edit| {
        let first = edit.first.cast_signed();
        let (end_line, end_column) = if edit.count == 0 {
            (first, 1)
        } else {
            let last = first + edit.count.cast_signed() - 1;
            (last, edit.last_chars.cast_signed() + 1)
        };
        let region = Region::builder()
            .start_line(first)
            .start_column(1)
            .end_line(end_line)
            .end_column(end_column)
            .build();
        let text = ArtifactContent::builder().text(edit.text.clone()).build();
        Replacement::builder()
            .deleted_region(region)
            .inserted_content(text)
            .build()
    });
    let message = format!(
        "what `{}` writes: certified together, so take all changes of the program or none",
        changes.command
    );
    let change = ArtifactChange::builder()
        .artifact_location(ArtifactLocation::builder().uri(uri(program)).build())
        .replacements(replacements.collect::<Vec<_>>())
        .build();
    Fix::builder()
        .description(Message::builder().text(message).build())
        .artifact_changes(vec![change])
        .build()
}

fn finding(rule: &str, level: ResultLevel, message: String, place: Location) -> Finding {
    Finding::builder()
        .rule_id(rule.to_owned())
        .level(level)
        .message(Message::builder().text(message).build())
        .locations(vec![place])
        .build()
}

fn location(program: &str, region: Option<Region>) -> Location {
    let artifact = ArtifactLocation::builder().uri(uri(program)).build();
    let physical = PhysicalLocation {
        region,
        ..PhysicalLocation::builder()
            .artifact_location(artifact)
            .build()
    };
    Location::builder().physical_location(physical).build()
}

/// A path as a relative reference: what a URI may not hold is percent-encoded.
fn uri(path: &str) -> String {
    let mut uri = String::with_capacity(path.len());
    for byte in path.bytes() {
        match byte {
            b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'/' | b'.' | b'-' | b'_' | b'~' => {
                uri.push(byte as char);
            }
            b'\\' if cfg!(windows) => uri.push('/'),
            _ => {
                let _ = write!(uri, "%{byte:02X}");
            }
        }
    }
    uri
}
