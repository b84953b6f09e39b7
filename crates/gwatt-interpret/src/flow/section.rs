//! Sections of SINUMERIK programs that are repeated.

/// A section that is repeated.
#[derive(Debug)]
pub(super) struct Section {
    pub(super) text: usize,
    /// Calls that were open when it began.
    pub(super) depth: usize,
    pub(super) first: usize,
    pub(super) last: usize,
    pub(super) left: u64,
    pub(super) back: usize,
}
