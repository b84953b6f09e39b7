//! Figures as reports print them.

use serde::{Serialize, Serializer};

/// Significant digits of a figure: four more than are promised, and few
/// enough that the noise of the last bits is never printed.
const FIGURE_DIGITS: i32 = 10;
/// Significant digits of a position: 1 m to less than a nanometre.
const POSITION_DIGITS: i32 = 12;
/// Powers of ten that f64 holds exactly.
const EXACT_POWERS: i32 = 22;
/// Whole numbers up to here are printed without a point.
const WHOLE_MAX: f64 = 1e15;

/// A figure of a report. Not finite: not known, printed as blank or null.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Figure(pub(super) f64);

/// A coordinate in mm or degrees.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Position(pub(super) f64);

impl Serialize for Figure {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        print(self.0, FIGURE_DIGITS, serializer)
    }
}

impl Serialize for Position {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        print(self.0, POSITION_DIGITS, serializer)
    }
}

/// A number with all its digits; 0 has no sign.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Exact(pub(super) f64);

impl Serialize for Exact {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let value = self.0 + 0.0;
        if value.fract() == 0.0 && value.abs() < WHOLE_MAX {
            serializer.serialize_i64(value as i64)
        } else {
            serializer.serialize_f64(value)
        }
    }
}

fn print<S: Serializer>(value: f64, digits: i32, serializer: S) -> Result<S::Ok, S::Error> {
    if !value.is_finite() {
        return serializer.serialize_none();
    }
    let rounded = round_to_digits(value, digits);
    if rounded.fract() == 0.0 && rounded.abs() < WHOLE_MAX {
        serializer.serialize_i64(rounded as i64)
    } else {
        serializer.serialize_f64(rounded)
    }
}

/// `value` rounded to so many significant digits: the f64 nearest to that
/// decimal number, so that its shortest form has no more digits.
pub(super) fn round_to_digits(value: f64, digits: i32) -> f64 {
    if value == 0.0 || !value.is_finite() {
        return value;
    }
    // One too small at most: then one digit more is kept.
    let exponent = libm::floor(libm::log10(value.abs())) as i32;
    let scale = digits - 1 - exponent;
    if scale.abs() > EXACT_POWERS {
        return value;
    }
    if scale >= 0 {
        // Both are exact, so the quotient is the nearest f64.
        let power = 10f64.powi(scale);
        (value * power).round() / power
    } else {
        let power = 10f64.powi(-scale);
        (value / power).round() * power
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn json(value: f64) -> String {
        serde_json::to_string(&Figure(value)).unwrap_or_default()
    }

    #[test]
    fn figures_have_ten_digits_and_no_noise() {
        assert_eq!(json(0.1 + 0.2), "0.3");
        assert_eq!(json(1_234.567_890_123_4), "1234.56789");
        assert_eq!(json(2.0 / 3.0), "0.6666666667");
        assert_eq!(json(-36000.0), "-36000");
        assert_eq!(json(-0.0), "0");
        assert_eq!(json(123_456_789_012_345.0), "123456789000000");
        assert_eq!(json(1.234_567_890_12e-4), "0.000123456789");
        assert_eq!(json(f64::NAN), "null");
        assert_eq!(json(f64::INFINITY), "null");
    }
}
