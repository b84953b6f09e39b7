//! What a run is asked to do.

pub use crate::interpret::Start;

use super::row::Certificate;

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

/// How power is brought down.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Strategy {
    /// The machine's presets for combinations of axes.
    Preset,
    /// Speed alone.
    Speed,
    /// Acceleration alone.
    Accel,
    /// The shortest time with the words that the controller has.
    Optimal,
}

/// How far the ratio V = limit/peak lowers speed or acceleration.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Law {
    /// Solved for the real block.
    Exact,
    /// V² on the nominal values of the commanded axes.
    Patent,
}

/// What `limit` is asked to do.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LimitOptions {
    /// How power is brought down.
    pub strategy: Strategy,
    /// How far.
    pub law: Law,
    /// Whether cutting feeds may be lowered.
    pub allow_feed: bool,
}
