//! Named parameters that show the state of the control ("Predefined Named
//! Parameters" of `LinuxCNC`). They are read only.

use super::code::Motion;
use super::control::Control;
use super::modal::Feed;
use crate::rules::Macros;
use gwatt_motion::FeedMode;

/// The version that gwatt follows: 2.9.
const VERSION: [f64; 2] = [2.9, 0.0];

impl Control<'_> {
    /// The value of a predefined parameter, by its name in small letters
    /// without `#<` and `>`; `None` for other names, and for what is not known.
    pub(super) fn named_parameter(&self, name: &str) -> Option<f64> {
        if self.rules.macros != Macros::OWords {
            return None;
        }
        let name = name.strip_prefix('_')?;
        let modal = &self.modal;
        let flag = |on: bool| Some(f64::from(u8::from(on)));
        match name {
            "vmajor" => Some(VERSION[0]),
            "vminor" => Some(VERSION[1]),
            "motion_mode" => match modal.motion {
                Motion::None => Some(800.0),
                _ => Some(f64::from(modal.motion.digit()? - b'0') * 10.0),
            },
            "plane" => match modal.plane {
                [0, 1, 2] => Some(170.0),
                [2, 0, 1] => Some(180.0),
                [1, 2, 0] => Some(190.0),
                _ => None,
            },
            "metric" => flag(modal.mm_per_unit == 1.0),
            "imperial" => flag(modal.mm_per_unit != 1.0),
            "absolute" => flag(modal.absolute),
            "incremental" => flag(!modal.absolute),
            "inverse_time" => flag(modal.feed_mode == FeedMode::InverseTime),
            "units_per_minute" => flag(modal.feed_mode == FeedMode::PerMinute),
            "units_per_rev" => flag(modal.feed_mode == FeedMode::PerRevolution),
            "coord_system" => {
                let system = f64::from(self.position.offsets().system);
                // 540 for G54 to 590 for G59, then 591 to 593.
                Some(if system < 7.0 {
                    530.0 + 10.0 * system
                } else {
                    584.0 + system
                })
            }
            // On the machine, not in a preview.
            "task" => Some(1.0),
            // No word is remapped.
            "remap_level" => Some(0.0),
            "ccomp" => self
                .compensation
                .as_ref()
                .map_or(Some(400.0), |it| Some(it.code())),
            "tool_offset" => flag(self.has_tool_length()),
            "spindle_css_mode" => flag(self.spindle.surface_mm_min.is_some()),
            "spindle_rpm_mode" => flag(self.spindle.surface_mm_min.is_none()),
            "retract_r_plane" => flag(!self.special.to_initial),
            "retract_old_z" => flag(self.special.to_initial),
            "line" => Some(self.parameters.line as f64),
            "call_level" => Some(self.parameters.call_level() as f64),
            "ijk_absolute_mode" => flag(modal.arc_absolute),
            "lathe_diameter_mode" => flag(modal.diameter),
            "lathe_radius_mode" => flag(!modal.diameter),
            "spindle_on" => flag(self.switches.spindle != 5),
            "spindle_cw" => flag(self.switches.spindle == 3),
            "mist" => flag(self.switches.mist),
            "flood" => flag(self.switches.flood),
            "speed_override" => flag(self.switches.speed_override),
            "feed_override" => flag(self.switches.feed_override),
            "adaptive_feed" => flag(self.switches.adaptive_feed),
            "feed_hold" => flag(self.switches.feed_hold),
            "feed" => Some(modal.feed.map_or(0.0, |feed| self.feed_in_unit(&feed))),
            "rpm" => Some(modal.spindle_rpm),
            "current_tool" => self.tools.loaded_known().map(f64::from),
            "selected_tool" => self.tools.selected_known().map(f64::from),
            _ => self.named_place(name),
        }
    }

    /// F in units of the program as they are now.
    fn feed_in_unit(&self, feed: &Feed) -> f64 {
        feed.value * feed.mm_per_unit / self.modal.mm_per_unit
    }

    /// `_x` … `_w`, and `_abs_x` … `_abs_w` in machine coordinates.
    fn named_place(&self, name: &str) -> Option<f64> {
        let absolute = name.strip_prefix("abs_");
        let axis = match absolute.unwrap_or(name) {
            "x" => 0,
            "y" => 1,
            "z" => 2,
            "a" => 3,
            "b" => 4,
            "c" => 5,
            "u" => 6,
            "v" => 7,
            "w" => 8,
            _ => return None,
        };
        if absolute.is_none() {
            return self.place(axis);
        }
        self.place_in_machine(axis)
    }
}
