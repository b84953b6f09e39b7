//! Quantities for people: three digits and the unit that suits.

use crate::units::SECONDS_PER_MINUTE;

const SECONDS_PER_HOUR: f64 = 3600.0;

/// Power such as `2.31 kW` or `850 W`.
#[must_use]
pub fn power(power_w: f64) -> String {
    scaled(power_w, "W")
}

/// Energy such as `12.3 kJ`.
pub(super) fn energy(energy_j: f64) -> String {
    scaled(energy_j, "J")
}

/// A quantity with the prefix that leaves one to three digits before the point.
fn scaled(value: f64, unit: &str) -> String {
    const PREFIXES: [(f64, &str); 3] = [(1e6, "M"), (1e3, "k"), (1.0, "")];
    // Half of the third digit below: 999.6 W is 1.00 kW.
    let prefix = PREFIXES
        .into_iter()
        .find(|(size, _)| value.abs() >= size * 0.9995);
    let (size, prefix) = prefix.unwrap_or((1.0, ""));
    format!("{} {prefix}{unit}", three_digits(value / size))
}

/// Three significant digits, without an exponent.
pub(super) fn three_digits(value: f64) -> String {
    let decimals = match value.abs() {
        0.0 => 0,
        v if v >= 99.95 => 0,
        v if v >= 9.995 => 1,
        _ => 2,
    };
    format!("{value:.decimals$}")
}

/// A duration such as `4.52 s`, `12 min 3 s` or `1 h 2 min 3 s`.
#[must_use]
pub fn duration(seconds: f64) -> String {
    if !seconds.is_finite() {
        return "unknown time".into();
    }
    if seconds < 59.95 {
        return format!("{} s", three_digits(seconds));
    }
    let whole = seconds.round();
    let hours = (whole / SECONDS_PER_HOUR).floor();
    let rest = whole - hours * SECONDS_PER_HOUR;
    let minutes = (rest / SECONDS_PER_MINUTE).floor();
    let seconds = rest - minutes * SECONDS_PER_MINUTE;
    if hours > 0.0 {
        format!("{hours} h {minutes} min {seconds} s")
    } else {
        format!("{minutes} min {seconds} s")
    }
}

/// A share in percent; near 100 % with the digits that distinguish it from 100.
pub(super) fn percent(ratio: f64) -> String {
    let value = ratio * 100.0;
    let off = (value - 100.0).abs();
    let decimals = match off {
        o if o >= 1.0 || o == 0.0 => 0,
        o if o >= 0.01 => 2,
        _ => 5,
    };
    format!("{value:.decimals$} %")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantities_have_three_digits() {
        assert_eq!(power(2310.4), "2.31 kW");
        assert_eq!(power(999.6), "1.00 kW");
        assert_eq!(power(850.0), "850 W");
        assert_eq!(power(0.0), "0 W");
        assert_eq!(power(-12.34), "-12.3 W");
        assert_eq!(energy(1.5e6), "1.50 MJ");
        assert_eq!(duration(4.5249), "4.52 s");
        assert_eq!(duration(723.2), "12 min 3 s");
        assert_eq!(duration(59.97), "1 min 0 s");
        assert_eq!(duration(3723.0), "1 h 2 min 3 s");
        assert_eq!(percent(1.65), "165 %");
        assert_eq!(percent(1.0004), "100.04 %");
    }
}
