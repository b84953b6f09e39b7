//! Figures with their errors, as text and as JSON.

use serde_json::{Map, Value, json};

use crate::identify::Figure;

/// Null for what is not known or not finite.
pub(super) fn number(value: Option<f64>) -> Value {
    value
        .filter(|v| v.is_finite())
        .map_or(Value::Null, |v| json!(v))
}

/// Puts a figure and its error into a map; null for what is not known.
pub(super) fn insert(map: &mut Map<String, Value>, key: &str, figure: Option<Figure>) {
    map.insert(key.to_owned(), number(figure.map(|f| f.value)));
    map.insert(format!("{key}_std"), number(figure.map(|f| f.std)));
}

/// A figure with four digits, and its error with two.
pub(super) fn shown(figure: Figure) -> String {
    // What is printed of a number, at least.
    let least = 1e-12;
    let digits = |value: f64, digits: i32| -> String {
        if value == 0.0 || !value.is_finite() {
            return format!("{value}");
        }
        let place = digits - 1 - libm::floor(libm::log10(value.abs())) as i32;
        let places = usize::try_from(place.clamp(0, 12)).unwrap_or(0);
        format!("{value:.places$}")
    };
    if figure.std.is_finite() && figure.std >= least {
        format!("{} ± {}", digits(figure.value, 5), digits(figure.std, 2))
    } else {
        digits(figure.value, 5)
    }
}
