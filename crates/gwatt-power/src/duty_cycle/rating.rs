//! What was found about a limit over time.

use gwatt_machine::OverrideAt;
use gwatt_motion::Move;

/// By how much a limit may be exceeded by rounding alone.
const ROUNDING: f64 = 1e-9;

/// What is limited.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Measure {
    /// Seconds above a power within a time.
    Overload {
        /// From which power on it counts, in W.
        above_w: f64,
        /// The power up to which the entry of the curve speaks, in W.
        power_w: f64,
        /// The time in s.
        every_s: f64,
    },
    /// Root of the mean square in W over a window, or over all of a program that
    /// is shorter.
    Continuous {
        /// The window in s.
        window_s: f64,
    },
    /// Lowest voltage of the bus in V.
    LowestVoltage,
    /// Highest voltage of the bus in V.
    HighestVoltage,
    /// Energy in J that the braking resistor holds beyond what it gives off.
    Brake {
        /// Power that it gives off, in W.
        power_w: f64,
    },
}

impl Measure {
    /// The rule's name in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Overload { .. } => "overload",
            Self::Continuous { .. } => "continuous-power",
            Self::LowestVoltage => "bus-voltage-low",
            Self::HighestVoltage => "bus-voltage-high",
            Self::Brake { .. } => "brake-energy",
        }
    }

    /// The unit of value and limit.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Self::Overload { .. } => "s",
            Self::Continuous { .. } => "W",
            Self::LowestVoltage | Self::HighestVoltage => "V",
            Self::Brake { .. } => "J",
        }
    }
}

/// A limit of a converter over time, and how near the program comes to it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rating {
    /// What is limited.
    pub measure: Measure,
    /// Which converter.
    pub converter: usize,
    /// The worst value, in the unit of the measure; infinite where a power may
    /// last for ever. Never better than it is.
    pub value: f64,
    /// The limit, less the margin.
    pub limit: f64,
    /// When it is worst, in s from the beginning; of a window its end.
    pub time_s: f64,
    /// In which line; 0 for none.
    pub line: u64,
    /// The text of that line: 0 the program, others files of subprograms.
    pub text: u16,
    /// The motion there is not known in time: its largest power counts as if it
    /// lasted.
    pub lasting: bool,
    /// The overrides at which it is worst, where those are lower than the largest.
    pub overrides: Option<OverrideAt>,
    /// A bound of the value over all overrides up to the largest, if by that the limit is
    /// not kept though by the value it is, and nothing has settled it yet.
    pub bound: Option<f64>,
    /// The value is that bound: what was looked at settles nothing.
    pub any: bool,
    /// Looked at with knobs at lower overrides, since the bound settles nothing.
    pub looked_at: bool,
}

impl Rating {
    /// Whether the limit is kept at every override.
    #[must_use]
    pub fn fits(&self) -> bool {
        self.keeps() && self.bound.is_none()
    }

    /// The worse of two values of the same limit, and of what bounds say of it.
    #[must_use]
    pub fn or_worse(&self, other: &Self) -> Self {
        let worse = if other.load_ratio() > self.load_ratio() {
            other
        } else {
            self
        };
        let bounds = [self.bound, other.bound].into_iter().flatten();
        let bound = bounds.reduce(match self.measure {
            Measure::LowestVoltage => f64::min,
            _ => f64::max,
        });
        Self { bound, ..*worse }
    }

    /// Whether the limit is kept at the largest overrides, and lower ones were not looked at.
    #[must_use]
    pub fn is_open(&self) -> bool {
        self.keeps() && self.bound.is_some()
    }

    /// Whether it is missed by the value.
    #[must_use]
    pub fn is_missed(&self) -> bool {
        !self.keeps()
    }

    /// Whether it is kept by the value.
    pub(crate) fn keeps(&self) -> bool {
        let slack = ROUNDING * self.limit.abs().max(1e-3);
        match self.measure {
            Measure::LowestVoltage => self.value >= self.limit - slack,
            _ => self.value <= self.limit + slack,
        }
    }

    /// How far the limit is used up: above 1 it is not kept.
    #[must_use]
    pub fn load_ratio(&self) -> f64 {
        match self.measure {
            Measure::LowestVoltage => self.limit / self.value,
            _ if self.value <= 0.0 => 0.0,
            _ => self.value / self.limit,
        }
    }
}

/// Where in the program something happens.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Place {
    pub line: u64,
    pub text: u16,
}

impl Place {
    pub fn of(mv: &Move) -> Self {
        Self {
            line: mv.line,
            text: mv.text,
        }
    }
}

/// The worst value so far, and where.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Worst {
    pub value: f64,
    pub time_s: f64,
    pub place: Place,
    pub lasting: bool,
}

impl Worst {
    /// Takes in a value; what is no number counts as the largest.
    pub fn raise(&mut self, value: f64, time_s: f64, place: Place) {
        if value > self.value || value.is_nan() && self.value < f64::INFINITY {
            *self = Self {
                value: if value.is_nan() { f64::INFINITY } else { value },
                time_s,
                place,
                lasting: false,
            };
        }
    }

    /// Takes in the value of a power that may last.
    pub fn raise_lasting(&mut self, value: f64, time_s: f64, place: Place) {
        let before = self.value;
        self.raise(value, time_s, place);
        self.lasting |= self.value > before;
    }

    pub fn rating(&self, measure: Measure, converter: usize, limit: f64) -> Rating {
        Rating {
            measure,
            converter,
            value: self.value,
            limit,
            time_s: self.time_s,
            line: self.place.line,
            text: self.place.text,
            lasting: self.lasting,
            overrides: None,
            bound: None,
            any: false,
            looked_at: false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of two ways through a program one has the larger value, the other one the bound.
    #[test]
    fn a_bound_is_not_lost_to_a_larger_value() {
        let of = |measure, value, limit, bound| Rating {
            value,
            bound,
            ..Worst::default().rating(measure, 0, limit)
        };
        let heating = |value, bound| of(Measure::Continuous { window_s: 1.0 }, value, 10.0, bound);
        let [small, large] = [heating(5.0, Some(12.0)), heating(6.0, None)];
        for merged in [small.or_worse(&large), large.or_worse(&small)] {
            assert_eq!((merged.value, merged.bound), (6.0, Some(12.0)));
        }
        let low = |value, bound| of(Measure::LowestVoltage, value, 300.0, bound);
        let merged = low(400.0, Some(280.0)).or_worse(&low(350.0, Some(290.0)));
        assert_eq!((merged.value, merged.bound), (350.0, Some(280.0)));
    }
}
