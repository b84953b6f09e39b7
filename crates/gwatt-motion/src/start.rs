//! Where a program begins.

use gwatt_machine::AxisValues;

/// Where the axes stand at the beginning of a program.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Start {
    /// At these machine coordinates (mm or degrees); 0 by default.
    At(AxisValues),
    /// Nowhere known: each axis' first move is priced at its full speed and
    /// acceleration.
    Unknown,
}
