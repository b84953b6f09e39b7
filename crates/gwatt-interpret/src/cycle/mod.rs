//! Canned cycles: a hole by one block. Each part is a move of its own.

mod hole;
mod iso;
mod peck;
mod rs274;
mod tap;
mod tap_feed;
mod words;

/// The values of a cycle that hold until it is ended.
#[derive(Debug, Clone, Default)]
pub(super) struct Held {
    /// Retract level and bottom: of `Rs274` as they were written, else program
    /// coordinates in mm.
    pub(super) r: Option<f64>,
    pub(super) bottom: Option<f64>,
    /// Dwell in s.
    pub(super) dwell_s: Option<f64>,
    /// Depth of a peck, or the shift of G76 and G87, as it was written.
    pub(super) q: Option<f64>,
    /// Depth of a peck of a tap, as it was written.
    pub(super) tap_q: Option<f64>,
    /// H of a tap (Mazak): 0, or the speed of the return in percent.
    pub(super) tap_h: Option<f64>,
    /// How many times as fast as its feed a tap comes out.
    pub(super) tap_j: Option<f64>,
    /// I, J, K of shifts as they were written.
    pub(super) ijk: [Option<f64>; 3],
    /// I, J, K of pecks as they were written.
    pub(super) pecks: [Option<f64>; 3],
    /// The level at which the series of cycles began.
    pub(super) initial: Initial,
}

/// Where a series of cycles began: machine coordinate, and offset and unit at
/// that time.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Initial {
    pub(super) at_mm: f64,
    pub(super) offset_mm: f64,
    pub(super) mm_per_unit: f64,
}
