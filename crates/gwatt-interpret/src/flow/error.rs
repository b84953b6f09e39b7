//! What went wrong.

/// What went wrong, at the line that is being executed.
pub(crate) struct FlowError {
    pub(super) rule: &'static str,
    pub(super) message: String,
    pub(super) help: String,
}

impl FlowError {
    pub(super) fn new(
        rule: &'static str,
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> Self {
        Self {
            rule,
            message: message.into(),
            help: help.into(),
        }
    }
}
