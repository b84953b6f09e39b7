//! What a run is asked to do.

pub use crate::interpret::{Limits, Reading, Start};

use super::row::Certificate;
pub use crate::limit::{Allowed, Law, LimitOptions, Strategy};

/// How a program is read and judged.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// How the program is to be read.
    pub reading: Reading,
    /// The certificate asked for; `None`: planned where the controller's
    /// planner is modelled, else robust.
    pub certificate: Option<Certificate>,
    /// The program runs once: limits over time need not bear it again at once.
    pub once: bool,
    /// Threads that one program may use, at least 1.
    pub threads: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            reading: Reading::default(),
            certificate: None,
            once: false,
            threads: 1,
        }
    }
}
