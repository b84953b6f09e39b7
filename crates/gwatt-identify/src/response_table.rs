//! Responses and correction filters into a machine file: values change, comments
//! and all the rest stay.

use std::f64::consts::TAU;

use toml_edit::{Array, InlineTable, Item, Table, TableLike, Value};

use super::error::{IdentifyError, Outcome};
use super::merge::{axis_item, finished, no_axis, set, six_digits, sound};
use super::transfer::Factor;
use super::tune::Biquad;
use gwatt_machine::AxisId;

/// What is written of an axis' response; what is `None` stays as it is.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ResponseFigures {
    /// Zeros from command (or force) to load.
    pub zeros: Option<Vec<Factor>>,
    /// Poles from command to load.
    pub poles: Option<Vec<Factor>>,
    /// Poles from force to the load's acceleration.
    pub force_poles: Option<Vec<Factor>>,
    /// Dead time from command to load, s.
    pub delay_s: Option<f64>,
    /// Gain of the position loop, 1/s.
    pub position_gain_1_s: Option<f64>,
    /// Period in s and sections of the filter; no sections: there is none.
    pub correction: Option<(f64, Vec<Biquad>)>,
}

/// The machine file with these responses.
///
/// # Errors
///
/// When the file has no such axis, is no machine file, or would be none.
pub fn into_machine(
    path: &str,
    text: &str,
    responses: &[(AxisId, ResponseFigures)],
) -> Outcome<String> {
    let mut document = sound(path, text)?;
    for (axis, figures) in responses {
        let item = axis_item(&mut document, *axis).ok_or_else(|| no_axis(path, *axis))?;
        write_axis(item, figures).ok_or_else(|| {
            IdentifyError::new(
                format!("{path}: the tables of axis {} cannot be changed", axis.letter() as char),
                "write the axis as [axes.X], with [axes.X.response] and [axes.X.correction] below it",
            )
        })?;
    }
    finished(path, &document)
}

fn write_axis(axis: &mut Item, figures: &ResponseFigures) -> Option<()> {
    let response = table_in(axis, "response")?;
    let lists = [
        ("zeros", &figures.zeros),
        ("poles", &figures.poles),
        ("force_poles", &figures.force_poles),
    ];
    for (key, factors) in lists {
        if factors.as_ref().is_some_and(Vec::is_empty) {
            response.remove(key);
        } else if let Some(factors) = factors {
            set_list(response, key, list(factors));
        }
    }
    if figures.poles.is_some() {
        // These are all: those of the loops are among them.
        response.remove("position_gain_1_s");
        response.remove("velocity_bandwidth_hz");
    }
    if let Some(delay_s) = figures.delay_s {
        set(response, "delay_ms", 1e3 * delay_s);
    }
    if let Some(gain) = figures.position_gain_1_s {
        set(response, "position_gain_1_s", gain);
    }
    if let Some((period_s, sections)) = &figures.correction {
        if sections.is_empty() {
            axis.as_table_like_mut()?.remove("correction");
            return Some(());
        }
        let correction = table_in(axis, "correction")?;
        set(correction, "period_ms", 1e3 * period_s);
        // All digits: rounded, the filters would no longer be alike.
        let rows = sections.iter().map(|section| {
            let numbers = section.coefficients().into_iter();
            Value::Array(numbers.collect::<Array>())
        });
        set_list(correction, "sections", rows.collect());
    }
    Some(())
}

/// The table under a key, made where it is missing.
fn table_in<'a>(axis: &'a mut Item, key: &str) -> Option<&'a mut dyn TableLike> {
    let inline = axis.is_inline_table();
    let table = axis.as_table_like_mut()?;
    if !table.contains_key(key) {
        let new = if inline {
            Item::Value(Value::InlineTable(InlineTable::new()))
        } else {
            Item::Table(Table::new())
        };
        table.insert(key, new);
    }
    table.get_mut(key)?.as_table_like_mut()
}

/// One line for each entry.
fn set_list(table: &mut dyn TableLike, key: &str, mut rows: Array) {
    for row in rows.iter_mut() {
        row.decor_mut().set_prefix("\n  ");
    }
    if !rows.is_empty() {
        rows.set_trailing("\n");
        rows.set_trailing_comma(true);
    }
    if let Some(old) = table.get_mut(key).and_then(Item::as_value_mut) {
        let decor = old.decor().clone();
        *old = Value::Array(rows);
        *old.decor_mut() = decor;
    } else {
        table.insert(key, toml_edit::value(rows));
    }
}

fn list(factors: &[Factor]) -> Array {
    let rows = factors.iter().map(|factor| {
        let mut row = InlineTable::new();
        match *factor {
            Factor::Pair {
                omega_rad_s,
                damping,
            } => {
                row.insert("frequency_hz", six_digits(omega_rad_s / TAU).into());
                row.insert("damping", six_digits(damping).into());
            }
            Factor::Real { time_constant_s } => {
                row.insert("time_constant_s", six_digits(time_constant_s).into());
            }
        }
        Value::InlineTable(row)
    });
    rows.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const MACHINE: &str = r#"schema = 1
name = "mill" # ours
controller = "iso"
[converter]
peak_power_w = 3000
[axes.X]
rapid_mm_min = 24000
accel_mm_s2 = 4000
mass_kg = 300

[axes.X.response]
position_gain_1_s = 40 # drive parameter
[axes.Y]
rapid_mm_min = 24000
accel_mm_s2 = 4000
mass_kg = 300
"#;

    #[test]
    fn responses_and_filters_are_put_in_and_replaced() {
        let zero = Factor::Pair {
            omega_rad_s: 40.0 * TAU,
            damping: 0.03,
        };
        let x = ResponseFigures {
            zeros: Some(vec![zero]),
            correction: Some((1e-3, vec![Biquad::ONE])),
            ..ResponseFigures::default()
        };
        let y = ResponseFigures {
            poles: Some(vec![Factor::Real {
                time_constant_s: 0.025,
            }]),
            delay_s: Some(2e-3),
            ..x.clone()
        };
        let both = [(AxisId::X, x.clone()), (AxisId::Y, y)];
        let merged = into_machine("m.toml", MACHINE, &both).unwrap();
        let section = "period_ms = 1.0\nsections = [\n  [1.0, 0.0, 0.0, 0.0, 0.0],\n]\n";
        let zeros = "zeros = [\n  { frequency_hz = 40.0, damping = 0.03 },\n]\n";
        let expected = MACHINE.replace(
            "drive parameter\n",
            &format!("drive parameter\n{zeros}\n[axes.X.correction]\n{section}"),
        ) + &format!(
            "\n[axes.Y.response]\n{zeros}poles = [\n  {{ time_constant_s = 0.025 }},\n]\ndelay_ms = 2.0\n\n[axes.Y.correction]\n{section}"
        );
        assert_eq!(merged, expected);
        // Again the same; without sections the filter goes.
        assert_eq!(into_machine("m.toml", &merged, &both).unwrap(), merged);
        let none = ResponseFigures {
            correction: Some((1e-3, Vec::new())),
            ..x
        };
        let without = into_machine("m.toml", &merged, &[(AxisId::X, none)]).unwrap();
        assert!(!without.contains("axes.X.correction"), "{without}");
        let z = [(AxisId::Z, ResponseFigures::default())];
        let message = into_machine("m.toml", MACHINE, &z).unwrap_err().message;
        assert_eq!(message, "m.toml: the machine has no axis Z");
    }
}
