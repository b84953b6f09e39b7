//! Why a recording cannot be used, and what to do about it.

/// A refusal: what is wrong, and what helps.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{message}\n  help: {help}")]
pub struct IdentifyError {
    /// What is wrong.
    pub message: String,
    /// What to do.
    pub help: String,
}

impl IdentifyError {
    /// Both sentences.
    pub fn new(message: impl Into<String>, help: impl Into<String>) -> Self {
        Self {
            message: message.into(),
            help: help.into(),
        }
    }
}

/// A result or a refusal.
pub type Outcome<T> = Result<T, IdentifyError>;
