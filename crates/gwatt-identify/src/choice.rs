//! What may be chosen of how a flexible axis is identified.

use super::candidate_models::Given;

/// How the transfer function is estimated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// Instrumental variables.
    Iv,
    /// Plain least squares.
    Arx,
    /// Through the averaged frequency response.
    Frequency,
    /// Subspaces (MOESP).
    Subspace,
}

/// What may be chosen.
#[derive(Debug, Clone)]
pub struct Choice {
    /// The method.
    pub method: Method,
    /// What is given instead of searched for.
    pub given: Given,
    /// The position command is the input, though a force is recorded.
    pub from_command: bool,
}
