//! Identified figures into a machine file: values change, comments and all the
//! rest stay.

use std::f64::consts::TAU;

use toml_edit::{DocumentMut, Item, TableLike, Value};

use super::certainty;
use super::error::{IdentifyError, Outcome};
use super::figure::Figure;
use super::parts;
use gwatt_machine::units::M_PER_MM;
use gwatt_machine::{Axis, AxisId, AxisKind, Machine};

/// What is written of an axis; N·m and kg·m² for N and kg where `rotary`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisFigures {
    /// True for torque and angles.
    pub rotary: bool,
    /// Mass or inertia.
    pub mass: f64,
    /// Viscous friction.
    pub viscous: Option<f64>,
    /// Coulomb friction.
    pub coulomb: Option<f64>,
    /// Force besides friction: weight. Written where the file has one already, or
    /// where it stands clear of its error.
    pub gravity: Option<Figure>,
    /// Efficiency; 1 where there are no losses, which replaces another one in the file.
    pub efficiency: Option<f64>,
    /// Standard errors of mass, viscous and Coulomb friction, where they are known; 0
    /// for a friction that is not.
    pub std: Option<[f64; 3]>,
}

/// Newtons per newton metre of a screw: `2π·gear/lead`.
#[must_use]
pub fn force_per_torque(lead_mm: f64, gear_ratio: f64) -> f64 {
    TAU * gear_ratio / (lead_mm * M_PER_MM)
}

/// The machine file with these figures for an axis and, where given, at least
/// this margin. Figures keep the form that the file has: motor side where it has
/// `inertia_kg_m2`, load side where it has `mass_kg`.
///
/// # Errors
///
/// When the file has no such axis, is no machine file, or would be none.
pub fn into_machine(
    path: &str,
    text: &str,
    axis: AxisId,
    figures: &AxisFigures,
    margin: Option<f64>,
) -> Outcome<String> {
    let letter = axis.letter() as char;
    let mut document = sound(path, text)?;
    let table = axis_item(&mut document, axis)
        .and_then(Item::as_table_like_mut)
        .ok_or_else(|| no_axis(path, axis))?;
    write_axis(table, axis, figures).map_err(|what| {
        IdentifyError::new(
            format!("{path}, axis {letter}: {what}"),
            "state lead_mm (and gear_ratio) of the axis, or record load-side quantities",
        )
    })?;
    if let Ok((machine, _)) = Machine::from_toml(path, text)
        && let Some(Some(known)) = machine.axes.get(axis as usize)
    {
        raise_errors(table, known, figures);
    }
    if let Some(margin) = margin {
        raise_margin(&mut document, margin);
    }
    finished(path, &document)
}

/// Raises the margin of a machine file to `margin`, a share, and `servo_factor_motor` of axes to
/// `factors`, unless it has larger ones; all else stays byte for byte. `path` is what messages
/// call it.
///
/// # Errors
///
/// When the file is no sound machine file, before or after.
pub fn margin_into_machine(
    path: &str,
    text: &str,
    margin: f64,
    factors: &[(AxisId, f64)],
) -> Outcome<String> {
    let mut document = sound(path, text)?;
    let machine = Machine::from_toml(path, text).ok();
    for (axis, factor) in factors {
        let item = axis_item(&mut document, *axis).ok_or_else(|| no_axis(path, *axis))?;
        let table = item.as_table_like_mut();
        let table = table.ok_or_else(|| no_axis(path, *axis))?;
        let factor = rounded_up(*factor);
        // That which follows from loops counts as well.
        let present = machine.as_ref().and_then(|(machine, _)| {
            let own = machine.axes.get(*axis as usize)?.as_ref()?;
            Some(own.servo_factor_motor)
        });
        let present = present.unwrap_or(1.0);
        if factor <= present {
            continue;
        }
        if table.contains_key("position_gain_1_s") {
            let letter = axis.letter() as char;
            return Err(IdentifyError::new(
                format!(
                    "{path}: the loops of axis {letter} make a factor of {present:.3}, and its power shows {factor:.3}"
                ),
                format!(
                    "take position_gain_1_s and what belongs to it out of axis {letter}, for \
                     servo_factor_motor as measured; nothing was written"
                ),
            ));
        }
        set(table, "servo_factor_motor", factor);
    }
    raise_margin(&mut document, margin);
    finished(path, &document)
}

fn refused(path: &str, what: &str) -> IdentifyError {
    IdentifyError::new(format!("{path}: {what}"), "nothing was written")
}

pub(super) fn no_axis(path: &str, axis: AxisId) -> IdentifyError {
    refused(
        path,
        &format!("the machine has no axis {}", axis.letter() as char),
    )
}

/// A machine file that is to change.
pub(super) fn sound(path: &str, text: &str) -> Outcome<DocumentMut> {
    if let Err(findings) = Machine::from_toml(path, text) {
        let first = findings.first().map(|f| f.message.as_str());
        let what = format!("this is no sound machine file: {}", first.unwrap_or(""));
        return Err(refused(path, &what));
    }
    let parsed = text.parse();
    parsed.map_err(|error: toml_edit::TomlError| refused(path, error.message()))
}

/// The table of an axis.
pub(super) fn axis_item(document: &mut DocumentMut, axis: AxisId) -> Option<&mut Item> {
    let letter = (axis.letter() as char).to_string();
    let axes = document.get_mut("axes")?.as_table_like_mut()?;
    axes.get_mut(&letter)
}

/// The text of a changed machine file, if that is sound.
pub(super) fn finished(path: &str, document: &DocumentMut) -> Outcome<String> {
    let merged = document.to_string();
    if let Err(findings) = Machine::from_toml(path, &merged) {
        let first = findings.first().map(|f| f.message.as_str());
        let what = format!(
            "with the new figures the file would not be sound: {}",
            first.unwrap_or("")
        );
        return Err(refused(path, &what));
    }
    Ok(merged)
}

fn write_axis(
    table: &mut dyn TableLike,
    axis: AxisId,
    figures: &AxisFigures,
) -> Result<(), &'static str> {
    let number = |table: &dyn TableLike, key: &str| {
        let value = table.get(key)?;
        value
            .as_float()
            .or_else(|| value.as_integer().map(|n| n as f64))
    };
    let is_rotary = match table.get("kind").and_then(|kind| kind.as_str()) {
        Some(kind) => kind == "rotary",
        None => matches!(axis, AxisId::A | AxisId::B | AxisId::C),
    };
    parts::take_out(table, figures.rotary && !is_rotary);
    let gear = number(table, "gear_ratio").unwrap_or(1.0);
    let per_torque = number(table, "lead_mm").map(|lead| force_per_torque(lead, gear));
    if is_rotary {
        if !figures.rotary {
            return Err("it turns, and the recording has a force and a slide");
        }
        set(table, "inertia_kg_m2", figures.mass);
        optional(table, "viscous_nm_s_rad", figures.viscous);
        optional(table, "friction_nm", figures.coulomb);
        gravity(table, "gravity_nm", figures.gravity, 1.0);
    } else {
        // Load side first.
        let (square, line) = if figures.rotary {
            let k = per_torque.ok_or("it slides, and the recording has torque and angles")?;
            (k * k, k)
        } else {
            (1.0, 1.0)
        };
        let by = |key: &str, other: &'static str, power: i32| {
            if table.contains_key(key) {
                per_torque.map(|k| (other, 1.0 / k.powi(power)))
            } else {
                None
            }
        };
        let mass = by("inertia_kg_m2", "inertia_kg_m2", 2).unwrap_or(("mass_kg", 1.0));
        let viscous =
            by("viscous_nm_s_rad", "viscous_nm_s_rad", 2).unwrap_or(("viscous_n_s_m", 1.0));
        let coulomb = by("friction_nm", "friction_nm", 1).unwrap_or(("coulomb_n", 1.0));
        let weight = by("gravity_nm", "gravity_nm", 1).unwrap_or(("gravity_n", 1.0));
        gravity(table, weight.0, figures.gravity, line * weight.1);
        set(table, mass.0, figures.mass * square * mass.1);
        optional(
            table,
            viscous.0,
            figures.viscous.map(|b| b * square * viscous.1),
        );
        optional(
            table,
            coulomb.0,
            figures.coulomb.map(|f| f * line * coulomb.1),
        );
    }
    if let Some(efficiency) = figures.efficiency
        && (efficiency < 1.0 || table.contains_key("efficiency"))
    {
        set(table, "efficiency", efficiency);
    }
    Ok(())
}

/// How far mass and friction may be off, as shares, by two standard errors of
/// each figure.
///
/// Friction is off by `(σ_c + σ_b·v)/(Fc + b·v)`, which grows or falls with the speed:
/// it is largest at rest or at the largest speed, `speed` (m/s or rad/s).
fn relative_errors(figures: &AxisFigures, speed: f64) -> [Option<f64>; 2] {
    let Some([mass, viscous, coulomb]) = figures.std else {
        return [None; 2];
    };
    let given = |figure: Option<f64>| figure.unwrap_or(0.0).max(0.0);
    let [b, c] = [given(figures.viscous), given(figures.coulomb)];
    let friction = [0.0, speed]
        .map(|v| 2.0 * (coulomb + viscous * v) / (c + b * v))
        .into_iter()
        .fold(
            0.0,
            |most: f64, error| if error > most { error } else { most },
        );
    let known = figures.viscous.is_some() || figures.coulomb.is_some();
    [Some(2.0 * mass / figures.mass), known.then_some(friction)]
        // From 1 on a figure says nothing, and a machine file would be refused.
        .map(|error| error.filter(|error| *error > 0.0 && *error < 1.0))
}

/// Writes errors of an axis that are larger than those in force.
fn raise_errors(table: &mut dyn TableLike, axis: &Axis, figures: &AxisFigures) {
    let travel = axis.rapid_mm_s * axis.si_per_unit;
    let number = |key: &str| table.get(key).and_then(number_of);
    let gear = number("gear_ratio").unwrap_or(1.0);
    // Speed on the side of the figures: of the motor, where they are its.
    let per_travel = match axis.kind {
        AxisKind::Rotary => gear,
        AxisKind::Linear if figures.rotary => {
            number("lead_mm").map_or(1.0, |lead| force_per_torque(lead, gear))
        }
        AxisKind::Linear => 1.0,
    };
    let found = relative_errors(figures, travel * per_travel);
    let present = [axis.mass_error, axis.friction_error];
    for ((key, error), present) in ["mass_error", "friction_error"]
        .into_iter()
        .zip(found)
        .zip(present)
    {
        if let Some(error) = error.filter(|error| *error > present) {
            set(table, key, error);
        }
    }
}

fn number_of(item: &Item) -> Option<f64> {
    let whole = || item.as_integer().map(|n| n as f64);
    item.as_float().or_else(whole)
}

impl AxisFigures {
    /// Whether the weight stands clear of its error.
    #[must_use]
    pub fn has_weight(&self) -> bool {
        self.gravity
            .is_some_and(|weight| weight.value.abs() > certainty::WEIGHT * weight.std)
    }
}

fn gravity(table: &mut dyn TableLike, key: &str, weight: Option<Figure>, factor: f64) {
    if let Some(weight) = weight
        && (table.contains_key(key) || weight.value.abs() > certainty::WEIGHT * weight.std)
    {
        set(table, key, weight.value * factor);
    }
}

/// Friction is not negative; where it comes out so, it is none.
fn optional(table: &mut dyn TableLike, key: &str, value: Option<f64>) {
    if let Some(value) = value {
        set(table, key, value.max(0.0));
    }
}

/// Writes a value with six digits, where it stands or at the end. A comment next to another
/// value says which one it was about.
pub(super) fn set(table: &mut dyn TableLike, key: &str, value: f64) {
    let value = six_digits(value);
    if let Some(old) = table.get_mut(key).and_then(|item| item.as_value_mut()) {
        let mut decor = old.decor().clone();
        let before = old
            .as_float()
            .or_else(|| old.as_integer().map(|n| n as f64));
        if before != Some(value)
            && let Some((space, comment)) = decor
                .suffix()
                .and_then(|suffix| suffix.as_str()?.split_once('#'))
            && !comment.trim_start().starts_with(WAS)
        {
            let was = old.clone().decorated("", "");
            let marked = format!("{space}# {WAS}{was}: {}", comment.trim());
            decor.set_suffix(marked);
        }
        *old = Value::from(value);
        *old.decor_mut() = decor;
    } else {
        table.insert(key, toml_edit::value(value));
    }
}

/// How a comment begins that is about an earlier value.
const WAS: &str = "was ";

/// A margin or factor as it is shown and written: up to three digits after the point, and never
/// less than what was found.
#[must_use]
pub fn rounded_up(value: f64) -> f64 {
    libm::ceil(value * 1000.0) / 1000.0
}

/// Six significant digits.
#[must_use]
pub fn six_digits(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

/// Sets the margin, unless the file has a larger one.
fn raise_margin(document: &mut DocumentMut, margin: f64) {
    const DEFAULT: f64 = 0.1;
    let margin = rounded_up(margin);
    let present = document
        .get("limits")
        .and_then(|limits| limits.get("margin"))
        .and_then(toml_edit::Item::as_float)
        .unwrap_or(DEFAULT);
    if margin <= present {
        return;
    }
    let limits = document.entry("limits").or_insert_with(toml_edit::table);
    if let Some(limits) = limits.as_table_like_mut() {
        set(limits, "margin", margin);
    }
}

#[cfg(test)]
mod tests;
