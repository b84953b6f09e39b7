//! Percentages of the axes' limits that a program has set.

use gwatt_machine::{AXES, AxisValues};

/// What a program has set.
#[derive(Debug)]
pub(super) struct Limits {
    /// ACC, in percent.
    pub(super) accel: AxisValues,
    /// VELOLIM and JERKLIM, in percent.
    pub(super) speed: AxisValues,
    pub(super) jerk: AxisValues,
    /// BRISK, DRIVE: no limit of jerk.
    pub(super) brisk: bool,
    /// OVRRAP, in percent.
    pub(super) rapid: f64,
    /// OVRRAP is lower than it counts.
    pub(super) rapids_may_be_slower: bool,
    /// Something lower does not act yet, since blocks before it are held back.
    pub(super) due: bool,
}

impl Limits {
    pub(super) fn new() -> Self {
        Self {
            accel: [100.0; AXES],
            speed: [100.0; AXES],
            jerk: [100.0; AXES],
            brisk: false,
            rapid: 100.0,
            rapids_may_be_slower: false,
            due: false,
        }
    }

    /// The share of its own limit of jerk that each axis has; infinite without a limit.
    pub(super) fn jerk_factor(&self) -> AxisValues {
        if self.brisk {
            return [f64::INFINITY; AXES];
        }
        self.jerk.map(|percent| percent / 100.0)
    }

    pub(super) fn are_due(&self) -> bool {
        self.due
    }
}
