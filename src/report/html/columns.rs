//! Numbers and lists as the page's data has them: short, and the same on every platform.

use std::collections::BTreeMap;

use serde_json::{Number, Value, json};

use crate::report::figure::round_to_digits;

/// Digits of a figure of a report.
const FIGURE_DIGITS: i32 = 10;
/// Digits of what is only drawn.
const DRAWN_DIGITS: i32 = 6;
/// Digits of a share of a limit.
const SHARE_DIGITS: i32 = 4;
/// Whole numbers up to here are printed without a point.
const WHOLE_MAX: f64 = 1e15;

/// A figure as reports have it; null where it is not known.
pub(super) fn figure(value: f64) -> Value {
    digits(value, FIGURE_DIGITS)
}

/// The same with fewer digits.
pub(super) fn drawn(value: f64) -> Value {
    digits(value, DRAWN_DIGITS)
}

/// A time in s, to a microsecond.
pub(super) fn time(seconds: f64) -> Value {
    digits((seconds * 1e6).round() / 1e6, FIGURE_DIGITS + 2)
}

fn digits(value: f64, digits: i32) -> Value {
    if !value.is_finite() {
        return Value::Null;
    }
    let rounded = round_to_digits(value, digits);
    if rounded.fract() == 0.0 && rounded.abs() < WHOLE_MAX {
        return Value::from(rounded as i64);
    }
    Number::from_f64(rounded).map_or(Value::Null, Value::Number)
}

/// A list; where all values are the same, that value stands for it.
pub(super) fn column(values: impl Iterator<Item = Value>) -> Value {
    let list: Vec<Value> = values.collect();
    match list.split_first() {
        Some((first, rest)) if !first.is_array() && rest.iter().all(|it| it == first) => {
            first.clone()
        }
        _ => Value::Array(list),
    }
}

/// A list of words, of which few differ: each word once, and which it is.
pub(super) fn words<'a>(values: impl Iterator<Item = &'a str>) -> Value {
    let mut places: BTreeMap<&str, usize> = BTreeMap::new();
    let mut names: Vec<&str> = Vec::new();
    let of: Vec<usize> = values
        .map(|word| {
            *places.entry(word).or_insert_with(|| {
                names.push(word);
                names.len() - 1
            })
        })
        .collect();
    match names.as_slice() {
        [one] => Value::from(*one),
        _ => json!({"names": names, "of": of}),
    }
}

/// A share with few digits, but near 1 with those that distinguish it from 1.
pub(super) fn share(value: f64) -> Value {
    let near = (value - 1.0).abs() < 0.01;
    digits(value, if near { FIGURE_DIGITS } else { SHARE_DIGITS })
}

/// A figure that may not be known.
pub(super) fn known(value: Option<f64>, print: fn(f64) -> Value) -> Value {
    value.map_or(Value::Null, print)
}
