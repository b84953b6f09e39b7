//! Machines with another converter.

use super::Wish;
use crate::machine::{Converter, Machine};

/// Significant digits of the values that are tried: as many as one copies from a report
/// into a machine file.
const DIGITS: i32 = 4;
/// Significant digits of the powers that go with them, as reports print them.
const SCALED_DIGITS: i32 = 10;
/// A value that is no limit, by the machine's own.
const NO_LIMIT: f64 = 1e6;
/// The smallest value that is tried, by the machine's own or by one that is enough.
const LEAST: f64 = 1e-3;
/// What is left for motion at least, as a share of the base load.
const ABOVE_BASE: f64 = 1e-3;
/// Rounding that does not count as a further step up.
const ROUNDING: f64 = 1e-12;

/// What is varied.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// The converter's peak power, W.
    Rating,
    /// The capacitance of its DC bus, F.
    Capacitance,
}

/// A machine whose converter has another peak power (W). Its continuous power and the
/// powers of its overloads grow and shrink with it, as within a series of converters;
/// what may be fed back is `regen_ratio` of it, or stays.
#[must_use]
pub fn rated(
    machine: &Machine,
    converter: usize,
    peak_power_w: f64,
    regen_ratio: Option<f64>,
) -> Machine {
    let mut machine = machine.clone();
    if let Some(converter) = machine.converters.get_mut(converter) {
        let share = peak_power_w / converter.peak_power_w;
        let scaled = |power_w: f64| at_digits(power_w * share, SCALED_DIGITS, f64::round);
        converter.peak_power_w = peak_power_w;
        if let Some(continuous) = &mut converter.ratings.continuous {
            continuous.power_w = scaled(continuous.power_w);
        }
        for overload in &mut converter.ratings.overload {
            overload.power_w = scaled(overload.power_w);
        }
        if let Some(ratio) = regen_ratio {
            converter.regen_power_w = Some(ratio * peak_power_w);
        }
    }
    machine
}

/// Whether the voltage of a converter's bus is limited.
pub(super) fn limits_voltage(machine: &Machine, converter: usize) -> bool {
    let bus = machine.converters.get(converter);
    let bus = bus.and_then(|it| Some((it, it.ratings.capacitor?)));
    bus.is_some_and(|(converter, bus)| {
        bus.min_v.is_some() || bus.max_v.is_some() && converter.regen_power_w.is_some()
    })
}

/// One quantity of one converter.
#[derive(Debug)]
pub(super) struct Scale<'m> {
    machine: &'m Machine,
    converter: usize,
    regen_ratio: Option<f64>,
    pub(super) quantity: Quantity,
}

impl<'m> Scale<'m> {
    pub(super) fn new(machine: &'m Machine, wish: &Wish, quantity: Quantity) -> Self {
        Self {
            machine,
            converter: wish.converter,
            regen_ratio: wish.regen_ratio,
            quantity,
        }
    }

    /// The machine with this value.
    pub(super) fn at(&self, value: f64) -> Machine {
        let rating_w = match self.quantity {
            Quantity::Rating => value,
            Quantity::Capacitance => self.converter().map_or(0.0, |it| it.peak_power_w),
        };
        let mut machine = rated(self.machine, self.converter, rating_w, self.regen_ratio);
        if self.quantity == Quantity::Capacitance
            && let Some(converter) = machine.converters.get_mut(self.converter)
            && let Some(bus) = &mut converter.ratings.capacitor
        {
            bus.capacitance_f = value;
        }
        machine
    }

    /// The converter of that machine.
    pub(super) fn converter_at(&self, value: f64) -> Option<Converter> {
        self.at(value).converters.into_iter().nth(self.converter)
    }

    fn converter(&self) -> Option<&Converter> {
        self.machine.converters.get(self.converter)
    }

    /// The machine's own value.
    pub(super) fn own(&self) -> f64 {
        let Some(converter) = self.converter() else {
            return 0.0;
        };
        match (self.quantity, converter.ratings.capacitor) {
            (Quantity::Rating, _) => converter.peak_power_w,
            (Quantity::Capacitance, bus) => bus.map_or(0.0, |bus| bus.capacitance_f),
        }
    }

    /// A value that is no limit.
    pub(super) fn unlimited(&self) -> f64 {
        NO_LIMIT * self.own()
    }

    /// The value that should be enough for a peak (W), as far as that can be known.
    pub(super) fn expected(&self, peak_w: f64) -> f64 {
        match self.quantity {
            Quantity::Rating => round_up(peak_w / self.kept()).max(self.least(0.0)),
            Quantity::Capacitance => self.own(),
        }
    }

    /// The smallest value that makes sense where `enough` is enough: less would leave
    /// nothing for motion, or is too far from it to be meant.
    pub(super) fn least(&self, enough: f64) -> f64 {
        let base_w = self.converter().map_or(0.0, |it| it.base_load_w);
        round_up(match self.quantity {
            Quantity::Rating => (LEAST * enough).max(base_w * (1.0 + ABOVE_BASE) / self.kept()),
            Quantity::Capacitance => LEAST * self.own(),
        })
    }

    fn kept(&self) -> f64 {
        1.0 - self.machine.limits.margin
    }
}

/// The next value with four digits, not below.
pub(super) fn round_up(value: f64) -> f64 {
    at_digits(value, DIGITS, |digits| (digits * (1.0 - ROUNDING)).ceil())
}

/// The next lower value with four digits.
pub(super) fn step_down(value: f64) -> f64 {
    at_digits(value, DIGITS, |digits| {
        (digits * (1.0 - ROUNDING)).ceil() - 1.0
    })
}

fn at_digits(value: f64, digits: i32, round: impl Fn(f64) -> f64) -> f64 {
    if !(value > 0.0 && value.is_finite()) {
        return 0.0;
    }
    let scale = digits - 1 - libm::floor(libm::log10(value)) as i32;
    // A power of ten and its quotient are exact, or nearest to it.
    if scale >= 0 {
        let power = 10f64.powi(scale);
        round(value * power) / power
    } else {
        let power = 10f64.powi(-scale);
        round(value / power) * power
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_have_four_digits() {
        assert_eq!(round_up(4235.96), 4236.0);
        assert_eq!(round_up(4236.0), 4236.0);
        assert_eq!(round_up(12_345.6), 12_350.0);
        assert_eq!(round_up(0.003_999_91), 0.004);
        assert_eq!(round_up(0.004), 0.004);
        assert_eq!(round_up(0.0), 0.0);
        assert_eq!(step_down(4236.0), 4235.0);
        assert_eq!(step_down(0.004), 0.003_999);
    }
}
