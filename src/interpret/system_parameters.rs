//! Parameters that show the state of the control.

use super::execute::Control;

impl Control<'_> {
    /// What a parameter of RS274/NGC shows of the state; `None` for those that
    /// only keep what is assigned.
    #[allow(clippy::unused_self, reason = "joined with the state")]
    pub(super) fn system_parameter(&self, _number: u32) -> Option<f64> {
        None
    }

    /// Changes the state; false for those that only keep what is assigned.
    #[allow(clippy::unused_self, reason = "joined with the state")]
    pub(super) fn set_system_parameter(&mut self, _number: u32, _value: f64) -> bool {
        false
    }

    /// What a predefined named parameter of `LinuxCNC` shows.
    #[allow(clippy::unused_self, reason = "joined with the state")]
    pub(super) fn named_parameter(&self, _name: &str) -> Option<f64> {
        None
    }
}
