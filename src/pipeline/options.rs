//! What a run is asked to do.

pub use crate::interpret::Start;

use super::row::Certificate;
pub use crate::limit::{Law, LimitOptions, Strategy};

/// How a program is read and judged.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Position at the beginning.
    pub start: Start,
    /// True: blocks that begin with `/` are passed over.
    pub block_delete: bool,
    /// The certificate asked for; `None`: planned where the controller's
    /// planner is modelled, else robust.
    pub certificate: Option<Certificate>,
    /// Threads that one program may use, at least 1.
    pub threads: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            start: Start::At([0.0; crate::machine::AXES]),
            block_delete: false,
            certificate: None,
            threads: 1,
        }
    }
}
