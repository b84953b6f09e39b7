//! Results as `JUnit` XML: one test case a program. Without times of day or
//! random identifiers, so that the same programs give the same file. The time of a case is
//! how long the program runs on the machine.

use std::io::{self, Write};
use std::time::Duration;

use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};

use super::checked::{Checked, Verdict};
use super::finding::{PEAK_POWER, REGEN_POWER, is_regenerative};
use super::style::Style;
use super::text::check_text;
use crate::diagnostic::Severity;
use crate::machine::Machine;
use crate::pipeline::{Failure, Summary};

/// Writes one suite, named after the machine.
///
/// # Errors
/// Those of `out`.
pub fn junit(checked: &[Checked], machine: &Machine, mut out: impl Write) -> io::Result<()> {
    let mut suite = TestSuite::new(machine.name.as_str());
    suite.add_test_cases(checked.iter().map(|checked| test_case(checked, machine)));
    let mut report = Report::new("gwatt");
    report.add_test_suite(suite);
    let text = report.to_string().map_err(io::Error::other)?;
    out.write_all(text.as_bytes())
}

fn test_case(checked: &Checked, machine: &Machine) -> TestCase {
    let text = check_text(checked, machine, Style::PLAIN);
    let title = text.lines().next().unwrap_or_default().to_owned();
    let status = match &checked.outcome {
        Ok(summary) if summary.only_subprograms() => {
            let mut status = TestCaseStatus::skipped();
            status.set_message(title);
            status
        }
        Ok(_) if checked.verdict() == Verdict::Fits => TestCaseStatus::success(),
        Ok(summary) => {
            let mut status = TestCaseStatus::non_success(NonSuccessKind::Failure);
            status.set_message(title).set_type(unfit_rule(summary));
            status.set_description(text);
            status
        }
        Err(failure) => {
            let mut status = TestCaseStatus::non_success(NonSuccessKind::Error);
            status.set_message(title).set_type(refused_rule(failure));
            status.set_description(refusal(&checked.program, failure, &text));
            status
        }
    };
    let mut case = TestCase::new(checked.program.as_str(), status);
    case.set_classname("gwatt");
    if let Ok(summary) = &checked.outcome
        && let Ok(time) = Duration::try_from_secs_f64(summary.duration_s)
    {
        case.set_time(time);
    }
    case
}

/// The rule of what does not fit first, as `gwatt explain` knows it.
fn unfit_rule(summary: &Summary) -> &'static str {
    let missed = || {
        let mut limits = summary.over_time.iter();
        limits.find(|limit| limit.rating.is_missed())
    };
    match (summary.unfit.first(), missed()) {
        (Some(unfit), _) if is_regenerative(unfit) => REGEN_POWER,
        (None, Some(limit)) => limit.rating.measure.name(),
        _ => PEAK_POWER,
    }
}

/// The rule of the first error.
fn refused_rule(failure: &Failure) -> &'static str {
    let Failure::Refused { diagnostics, .. } = failure else {
        return "refused";
    };
    let mut errors = diagnostics.iter();
    let first = errors.find(|it| it.severity == Severity::Error);
    first.map_or("refused", |it| it.rule)
}

/// Every diagnostic with the line under it.
fn refusal(program: &str, failure: &Failure, text: &str) -> String {
    let Failure::Refused { diagnostics, .. } = failure else {
        return text.to_owned();
    };
    let shown: Vec<String> = diagnostics
        .iter()
        .map(|diagnostic| diagnostic.render(program, false))
        .collect();
    shown.join("\n")
}
