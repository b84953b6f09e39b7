//! What stops a program that runs away.

/// Where repetition stops.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limits {
    /// Calls inside one another.
    pub depth: usize,
    /// Moves of lines that have been executed before.
    pub repeated_moves: u64,
    /// Lines in a row that move no axis.
    pub idle_lines: u64,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            depth: 100,
            repeated_moves: 10_000_000,
            idle_lines: 1_000_000,
        }
    }
}
