//! What is wanted of a sizing.

use super::super::LimitOptions;

/// What is wanted of a sizing.
#[derive(Debug, Clone, PartialEq)]
pub struct Wish {
    /// What the limiter is asked to do.
    pub how: LimitOptions,
    /// Index of the converter that is sized.
    pub converter: usize,
    /// Steps between the lowest value at which the programs can be made to fit and the
    /// value from which on nothing is slowed, both included; at least 2.
    pub steps: usize,
    /// Largest loss of time of a program, as a share, that is of interest: below, nothing
    /// is tried.
    pub until: f64,
    /// Losses of time, as shares, for which the smallest value is wanted.
    pub losses: Vec<f64>,
    /// Power that may be fed back by rating; `None`: as the machine says.
    pub regen_ratio: Option<f64>,
    /// Threads to use, at least 1.
    pub threads: usize,
}
