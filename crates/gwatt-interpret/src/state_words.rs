//! M words of `LinuxCNC` that move nothing: spindle orientation, overrides,
//! inputs and outputs, and the saving of modal state ("M19", "M48" to "M53",
//! "M61" to "M68", "M70" to "M73").

mod words;

use super::modal::Modal;
use super::spindle_speed::SpindleMode;

/// What M words have switched.
#[derive(Debug, Clone, Copy, PartialEq)]
#[allow(
    clippy::struct_excessive_bools,
    reason = "each is a separate switch of the control"
)]
pub(super) struct Switches {
    /// M3, M4 or M5.
    pub(super) spindle: u16,
    /// M4, or an S in a block that feeds, has shown that there is a laser.
    pub(super) laser_seen: bool,
    pub(super) mist: bool,
    pub(super) flood: bool,
    pub(super) feed_override: bool,
    pub(super) speed_override: bool,
    pub(super) adaptive_feed: bool,
    pub(super) feed_hold: bool,
}

impl Default for Switches {
    fn default() -> Self {
        Self {
            spindle: 5,
            laser_seen: false,
            mist: false,
            flood: false,
            feed_override: true,
            speed_override: true,
            adaptive_feed: false,
            feed_hold: true,
        }
    }
}

impl Switches {
    /// M3 to M9 and M19.
    pub(super) fn switch(&mut self, number: u16) {
        match number {
            30 | 40 | 50 => self.spindle = number / 10,
            60 | 190 => self.spindle = 5,
            70 => self.mist = true,
            80 => self.flood = true,
            90 => (self.mist, self.flood) = (false, false),
            _ => {}
        }
    }
}

/// State that M70 or M73 has saved.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Saved {
    modal: Modal,
    system: u16,
    tool_length: bool,
    spindle: SpindleMode,
    switches: Switches,
    /// M73: to be restored when the subprogram returns.
    on_return: bool,
}
