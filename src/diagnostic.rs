//! What gwatt has to say about a program: as data, with the line under it.

use crate::source::Span;

/// How much a diagnostic weighs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    /// Worth knowing; changes nothing.
    Note,
    /// Probably a mistake; the run goes on.
    Warning,
    /// The program, or the machine file, is refused: exit 2.
    Error,
}

/// One finding, tied to a place in a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Diagnostic {
    /// How much it weighs.
    pub severity: Severity,
    /// Short stable name in kebab case, such as `arc-radius`.
    pub rule: &'static str,
    /// What is wrong, in one line without a full stop.
    pub message: String,
    /// What to do about it.
    pub help: Option<String>,
    /// Line number from 1; 0 when the finding concerns the whole file.
    pub line: u64,
    /// Where in that line.
    pub span: Span,
    /// The line itself, without its line end, as bytes; long lines are cut.
    pub text: Vec<u8>,
}
