//! Why there is no machine file.

use thiserror::Error;

/// Why there is no machine file.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum DraftError {
    /// An axis is not described as it should be.
    #[error("axis `{axis}`: {wrong}")]
    Axis {
        /// As it was given, up to the first colon.
        axis: String,
        /// What is wrong, and what to do.
        wrong: String,
    },
    /// An axis is described twice.
    #[error("axis {0} is described twice: keep one of the two")]
    Twice(char),
    /// There is none.
    #[error("a machine needs an axis: --axis X:rapid_mm_min=…,accel_mm_s2=…,table_kg=…")]
    NoAxes,
    /// The spindle or a load is not described as it should be.
    #[error("{0}")]
    Part(String),
    /// A power that is none.
    #[error("{0} must be {1}, in W")]
    Power(&'static str, &'static str),
}
