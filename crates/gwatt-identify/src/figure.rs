//! A figure with its standard error.

/// A figure with its standard error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Figure {
    /// The estimate.
    pub value: f64,
    /// Its standard error.
    pub std: f64,
}
