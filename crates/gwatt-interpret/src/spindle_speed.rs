//! Constant surface speed and the clamp of the spindle ("G96, G97" of
//! `LinuxCNC`; Fanuc "Constant Surface Speed Control (G96, G97)", G50 S and
//! G92 S), and what a feed per revolution then comes to.

mod words;

use gwatt_machine::units::MM_PER_INCH;

/// Surface speeds are in metres or feet per minute.
const MM_PER_M: f64 = 1000.0;
const MM_PER_FOOT: f64 = 12.0 * MM_PER_INCH;

/// How the spindle's speed is given.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SpindleMode {
    /// G96: the speed of the surface, mm/min.
    pub(super) surface_mm_min: Option<f64>,
    /// Largest speed under G96, 1/min; infinite without a clamp.
    limit_rpm: f64,
    /// G96 of SINUMERIK: somewhere up to its limit, 1/min.
    pub(super) unknown_up_to_rpm: Option<f64>,
    /// The speed of the spindle that feeds per revolution follow, where the program names one
    /// (SINUMERIK: SETMS), 1/min.
    pub(super) followed_rpm: Option<f64>,
    /// What S may be after a tap with a speed of its own (SINUMERIK), 1/min: the larger of it and
    /// S counts.
    pub(super) left_rpm: f64,
    /// The speed of a tool's own spindle on a lathe (OSP: SB), 1/min: feeds per revolution may
    /// follow it.
    pub(super) tool_rpm: f64,
}

impl SpindleMode {
    /// Largest speed under G96, 1/min; infinite without a clamp.
    pub(super) fn limit_rpm(&self) -> f64 {
        self.limit_rpm
    }
}

impl Default for SpindleMode {
    fn default() -> Self {
        Self {
            surface_mm_min: None,
            limit_rpm: f64::INFINITY,
            unknown_up_to_rpm: None,
            followed_rpm: None,
            left_rpm: 0.0,
            tool_rpm: 0.0,
        }
    }
}
