//! Diagnostics and moves that do not fit, for other programs.

use serde::Serialize;

use super::figure::Figure;
use super::record::Letters;
use crate::diagnostic::{Diagnostic, Severity, excerpt};
use crate::pipeline::Unfit;

/// Characters of a program line that reports repeat.
pub(super) const LINE_CHARS: usize = 80;

/// Rules of moves that do not fit.
pub(super) const PEAK_POWER: &str = "peak-power";
/// See [`PEAK_POWER`].
pub(super) const REGEN_POWER: &str = "regen-power";

/// A diagnostic as JSON.
#[derive(Debug, Serialize)]
pub(super) struct Finding<'a> {
    severity: &'static str,
    rule: &'static str,
    /// Where it is not the program itself.
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<&'a str>,
    line: u64,
    column: u32,
    message: &'a str,
    help: Option<&'a str>,
}

impl<'a> From<&'a Diagnostic> for Finding<'a> {
    fn from(diagnostic: &'a Diagnostic) -> Self {
        Self {
            severity: severity_name(diagnostic.severity),
            rule: diagnostic.rule,
            file: diagnostic.file.as_deref(),
            line: diagnostic.line,
            column: diagnostic.column,
            message: &diagnostic.message,
            help: diagnostic.help.as_deref(),
        }
    }
}

/// The name of a severity.
pub(super) fn severity_name(severity: Severity) -> &'static str {
    match severity {
        Severity::Note => "note",
        Severity::Warning => "warning",
        Severity::Error => "error",
    }
}

/// A move that does not fit as JSON.
#[derive(Debug, Serialize)]
pub(super) struct UnfitMove<'a> {
    line: u64,
    file: &'a str,
    runs: u64,
    n_word: Option<Figure>,
    #[serde(rename = "move")]
    kind: &'static str,
    axes: Letters,
    peak_w: Figure,
    limit_w: Figure,
    regen_w: Figure,
    regen_limit_w: Option<Figure>,
    overload: Figure,
    help: &'a str,
    text: String,
}

impl<'a> From<&'a Unfit> for UnfitMove<'a> {
    fn from(unfit: &'a Unfit) -> Self {
        Self {
            line: unfit.line,
            file: &unfit.file,
            runs: unfit.runs,
            n_word: unfit.n_word.map(Figure),
            kind: unfit.kind.name(),
            axes: Letters(unfit.axes),
            peak_w: Figure(unfit.peak_w),
            limit_w: Figure(unfit.limit_w),
            regen_w: Figure(unfit.regen_w),
            regen_limit_w: unfit.regen_limit_w.map(Figure),
            overload: Figure(unfit.overload),
            help: &unfit.help,
            text: excerpt(&unfit.text, LINE_CHARS),
        }
    }
}

/// True when power fed back, not power drawn, is what does not fit most.
pub(super) fn is_regenerative(unfit: &Unfit) -> bool {
    unfit
        .regen_limit_w
        .is_some_and(|limit_w| unfit.regen_w * unfit.limit_w > unfit.peak_w * limit_w)
}
