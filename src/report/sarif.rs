//! Results as SARIF 2.1.0, for code scanning.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io::{self, Write};

use serde_sarif::sarif::{
    ArtifactLocation, Location, Message, MultiformatMessageString, PhysicalLocation, Region,
    ReportingDescriptor, Result as Finding, ResultLevel, Run, SCHEMA_URL, Sarif, Tool,
    ToolComponent, Version,
};

use super::checked::{Checked, chain};
use super::finding::is_regenerative;
use super::over_time::message;
use super::quantity::power;
use crate::diagnostic::{Diagnostic, Severity};
use crate::pipeline::{Failure, OverTime, Unfit};

const PEAK_POWER: &str = "peak-power";
const REGEN_POWER: &str = "regen-power";
const UNREADABLE: &str = "unreadable";

/// Writes one run with a result for each move that does not fit and for each
/// diagnostic.
///
/// # Errors
/// Those of `out`.
pub fn sarif(checked: &[Checked], mut out: impl Write) -> io::Result<()> {
    let results: Vec<Finding> = checked.iter().flat_map(findings).collect();
    let driver = ToolComponent::builder()
        .name("gwatt")
        .version(env!("CARGO_PKG_VERSION").to_owned())
        .rules(rules(&results))
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

/// The rules that the results name, in alphabetical order.
fn rules(results: &[Finding]) -> Vec<ReportingDescriptor> {
    let mut texts = BTreeMap::new();
    for rule in results.iter().filter_map(|result| result.rule_id.clone()) {
        let text = match rule.as_str() {
            PEAK_POWER => "A move draws more power than the converter gives.",
            REGEN_POWER => "A move feeds back more power than the converter takes.",
            "overload" => "More power is drawn, for longer, than the converter bears.",
            "continuous-power" => "More power is drawn on average than the converter delivers.",
            "bus-voltage-low" => "The voltage of the DC bus falls too low.",
            "bus-voltage-high" => "The voltage of the DC bus rises too high.",
            "brake-energy" => "More energy is fed back than the braking resistor takes.",
            UNREADABLE => "A program cannot be read.",
            _ => "gwatt cannot judge what the program asks for, or doubts it.",
        };
        texts.insert(rule, text);
    }
    let describe = |(rule, text): (String, &str)| {
        let text = MultiformatMessageString::builder().text(text).build();
        ReportingDescriptor::builder()
            .id(rule)
            .short_description(text)
            .build()
    };
    texts.into_iter().map(describe).collect()
}

fn findings(checked: &Checked) -> Vec<Finding> {
    let program = checked.program.as_str();
    match &checked.outcome {
        Ok(summary) => {
            let notes = summary.notes.iter();
            let unfit = summary.unfit.iter();
            let over_time = summary.over_time.iter();
            notes
                .map(|note| diagnostic_finding(program, note))
                .chain(unfit.map(|unfit| unfit_finding(program, unfit)))
                .chain(
                    over_time
                        .filter(|found| found.rating.is_missed())
                        .map(|found| over_time_finding(program, found)),
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
