//! Why a text has no value, and where that is.

use gwatt_syntax::source::Span;

pub(crate) type Outcome<T> = Result<T, Fault>;

/// Why a text has no value.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Fault {
    pub(crate) rule: &'static str,
    pub(crate) message: String,
    pub(crate) help: &'static str,
    pub(crate) span: Span,
}

impl Fault {
    pub(crate) fn new(
        rule: &'static str,
        message: impl Into<String>,
        help: &'static str,
        span: Span,
    ) -> Self {
        Self {
            rule,
            message: message.into(),
            help,
            span,
        }
    }
}
