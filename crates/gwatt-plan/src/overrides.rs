//! Overrides, and what holds moves back besides their own limits.

use gwatt_machine::{AxisValues, Machine, OverrideAt};

/// Override switches as factors; 1 is 100 %.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Overrides {
    /// Of feeds.
    pub feed: f64,
    /// Of rapids.
    pub rapid: f64,
    /// Of the spindle, for moves in step with it.
    pub spindle: f64,
}

impl Default for Overrides {
    fn default() -> Self {
        Self {
            feed: 1.0,
            rapid: 1.0,
            spindle: 1.0,
        }
    }
}

impl Overrides {
    /// Those at which a machine's peaks and its times are taken: the largest, and 100 %
    /// or what the machine permits of it; where the knobs stand, both there.
    #[must_use]
    pub fn of(machine: &Machine) -> [Self; 2] {
        let limits = &machine.limits;
        if let Some(at) = limits.override_at {
            let OverrideAt {
                feed,
                rapid,
                spindle,
            } = at;
            return [Self {
                feed,
                rapid,
                spindle,
            }; 2];
        }
        let largest = Self {
            feed: limits.feed_override_max,
            rapid: limits.rapid_override_max,
            spindle: limits.spindle_override_max,
        };
        let nominal = Self {
            feed: largest.feed.min(1.0),
            rapid: largest.rapid.min(1.0),
            spindle: largest.spindle.min(1.0),
        };
        [largest, nominal]
    }
}

/// Lower limits to try on a move without touching it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Caps {
    /// Path speed that is really run, after overrides, in mm/s; infinite: no
    /// cap. On independent rapids each axis gets its share of it.
    pub speed_mm_s: f64,
    /// All accelerations, those of the axes and that along the path, times this.
    pub accel_factor: f64,
    /// Acceleration limits that replace the move's.
    pub accel_mm_s2: Option<AxisValues>,
    /// Acceleration along the path in mm/s²; infinite: no cap.
    pub path_accel_mm_s2: f64,
    /// Rapid speeds times this.
    pub rapid_factor: f64,
}

impl Default for Caps {
    fn default() -> Self {
        Self {
            speed_mm_s: f64::INFINITY,
            accel_factor: 1.0,
            accel_mm_s2: None,
            path_accel_mm_s2: f64::INFINITY,
            rapid_factor: 1.0,
        }
    }
}
