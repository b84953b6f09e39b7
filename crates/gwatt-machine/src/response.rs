//! How the load of an axis follows its position command, and the filter that
//! the command passes before.

use super::axis::AxisId;

/// What is known of the axes' responses.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Responses {
    /// How loads follow commands.
    pub follow: Vec<(AxisId, Response)>,
    /// Filters of the commands.
    pub corrections: Vec<(AxisId, CommandFilter)>,
}

/// From position command to load: gain 1, times zeros, by poles, after a delay.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Response {
    /// Roots of the numerator.
    pub zeros: Vec<ResponseRoot>,
    /// Roots of the denominator, those of the loops included.
    pub poles: Vec<ResponseRoot>,
    /// Poles from force to the load's acceleration.
    pub force_poles: Vec<ResponseRoot>,
    /// Dead time, s.
    pub delay_s: f64,
}

/// A pair of roots, or a single one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ResponseRoot {
    /// A resonance or an anti-resonance.
    Pair {
        /// Hz.
        frequency_hz: f64,
        /// Damping ratio.
        damping: f64,
    },
    /// A real one.
    Single {
        /// s.
        time_constant_s: f64,
    },
}

/// A digital filter in second-order sections.
#[derive(Debug, Clone, PartialEq)]
pub struct CommandFilter {
    /// Sampling period, s.
    pub period_s: f64,
    /// b0, b1, b2, a1, a2 of each.
    pub sections: Vec<[f64; 5]>,
}

impl Responses {
    /// How the load of an axis follows.
    #[must_use]
    pub fn of(&self, axis: AxisId) -> Option<&Response> {
        let mut list = self.follow.iter();
        list.find(|(id, _)| *id == axis).map(|(_, found)| found)
    }

    /// The filter of an axis' command.
    #[must_use]
    pub fn correction(&self, axis: AxisId) -> Option<&CommandFilter> {
        let mut list = self.corrections.iter();
        list.find(|(id, _)| *id == axis).map(|(_, found)| found)
    }
}
