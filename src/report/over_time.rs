//! Limits over time: one line each for people, one object each for programs.

use serde::Serialize;

use super::aligned::aligned;
use super::figure::Figure;
use super::quantity::{duration, energy, percent, power, three_digits};
use crate::pipeline::{OverTime, Summary};
use crate::power::{Measure, Rating};

/// The limits over time of a program, one a line; nothing where there are none.
pub(super) fn over_time_text(summary: &Summary) -> String {
    let rows: Vec<[String; 4]> = summary.over_time.iter().map(row).collect();
    aligned(&rows, "  ")
}

fn row(found: &OverTime) -> [String; 4] {
    let rating = &found.rating;
    let ratio = match rating.measure {
        _ if !rating.value.is_finite() => String::new(),
        Measure::LowestVoltage | Measure::HighestVoltage => String::new(),
        _ => percent(rating.load_ratio()),
    };
    let mut place = if rating.line > 0 {
        let at = duration(rating.time_s);
        format!("line {} at {at}", rating.line)
    } else {
        String::new()
    };
    if rating.line > 0 && !found.file.is_empty() {
        place = format!("{place} in {}", found.file);
    }
    if rating.is_open() {
        place.push_str("  at the largest overrides; lower ones are looked at once all else fits");
    } else if rating.is_missed() {
        place = format!("{place}  does not fit → {}", found.help());
    }
    [found.title(), figures(rating), ratio, place]
}

/// Value and limit, such as `1.20 kW of 1.98 kW`.
pub(super) fn figures(rating: &Rating) -> String {
    let value = |value: f64| match rating.measure {
        Measure::Overload { .. } => duration(value),
        Measure::Continuous { .. } => power(value),
        Measure::LowestVoltage | Measure::HighestVoltage => format!("{} V", three_digits(value)),
        Measure::Brake { .. } => energy(value),
    };
    let limit = value(rating.limit);
    match rating.measure {
        _ if !rating.value.is_finite() => format!("more than {limit}"),
        Measure::LowestVoltage => format!("{}, at least {limit}", value(rating.value)),
        Measure::HighestVoltage => format!("{}, at most {limit}", value(rating.value)),
        _ => format!("{} of {limit}", value(rating.value)),
    }
}

/// From which power on an overload counts, W, and for how long that is permitted, such as
/// `overload above 1.98 kW: 4.00 s within 10 s`.
#[cfg(feature = "html")]
pub(super) fn overload(found: &OverTime) -> Option<(f64, String)> {
    let Measure::Overload {
        above_w, every_s, ..
    } = found.rating.measure
    else {
        return None;
    };
    let converter = if found.converter.is_empty() {
        String::new()
    } else {
        format!(" {}", found.converter)
    };
    let [above, limit] = [power(above_w), duration(found.rating.limit)];
    let text = format!("overload{converter} above {above}: {limit} within {every_s} s");
    Some((above_w, text))
}

/// What does not fit, in a sentence.
pub(super) fn message(found: &OverTime) -> String {
    format!(
        "{}: {}; {}",
        found.title(),
        figures(&found.rating),
        found.help()
    )
}

/// A limit over time as JSON.
#[derive(Debug, Serialize)]
pub(super) struct OverTimeRecord<'a> {
    check: &'static str,
    converter: &'a str,
    value: Option<Figure>,
    limit: Figure,
    unit: &'static str,
    fits: bool,
    line: u64,
    file: &'a str,
    time_s: Figure,
    lasting: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    above_w: Option<Figure>,
    #[serde(skip_serializing_if = "Option::is_none")]
    window_s: Option<Figure>,
    #[serde(skip_serializing_if = "Option::is_none")]
    feed_override: Option<Figure>,
    #[serde(skip_serializing_if = "Option::is_none")]
    rapid_override: Option<Figure>,
}

impl<'a> OverTimeRecord<'a> {
    /// All of a summary.
    pub(super) fn list(summary: &'a Summary) -> Vec<Self> {
        summary.over_time.iter().map(Self::from).collect()
    }
}

impl<'a> From<&'a OverTime> for OverTimeRecord<'a> {
    fn from(found: &'a OverTime) -> Self {
        let rating = &found.rating;
        let (above_w, window_s) = match rating.measure {
            Measure::Overload {
                above_w, every_s, ..
            } => (Some(above_w), Some(every_s)),
            Measure::Continuous { window_s } => (None, Some(window_s)),
            Measure::Brake { power_w } => (Some(power_w), None),
            Measure::LowestVoltage | Measure::HighestVoltage => (None, None),
        };
        Self {
            check: rating.measure.name(),
            converter: &found.converter,
            value: rating.value.is_finite().then_some(Figure(rating.value)),
            limit: Figure(rating.limit),
            unit: rating.measure.unit(),
            fits: rating.fits(),
            line: rating.line,
            file: &found.file,
            time_s: Figure(rating.time_s),
            lasting: rating.lasting,
            above_w: above_w.map(Figure),
            window_s: window_s.map(Figure),
            feed_override: rating.overrides.map(|at| Figure(at.feed)),
            rapid_override: rating.overrides.map(|at| Figure(at.rapid)),
        }
    }
}
