//! What the spindle is to do, announced as far as it changes: for machines that
//! have one on their converter.

mod control;

/// What was announced last.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Announced {
    rpm: f64,
    surface_mm_s: f64,
    clamp_rpm: f64,
    /// Bits of the place, so that a place that is not known equals itself.
    center: Option<u64>,
    tool: f64,
}
