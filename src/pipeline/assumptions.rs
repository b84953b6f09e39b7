//! What is assumed of a machine's description: within which errors the figures hold,
//! what counts as exact, and what counts as none.

use std::fmt::Write as _;

use crate::machine::{ALL_AXES, Axis, AxisId, AxisSet, Machine};

/// What the figures of a machine assume of its description, a sentence each.
#[must_use]
pub fn assumptions(machine: &Machine) -> Vec<String> {
    let servos = servos(machine);
    let others = [exact(machine), absent(machine)];
    let all = within(machine).into_iter().chain(servos);
    all.chain(others.into_iter().flatten()).collect()
}

/// The axes for which `holds`.
fn axes(machine: &Machine, holds: impl Fn(AxisId, &Axis) -> bool) -> AxisSet {
    let mut found = AxisSet::default();
    for (id, axis) in ALL_AXES.into_iter().zip(&machine.axes) {
        if axis.as_ref().is_some_and(|axis| holds(id, axis)) {
            found.insert(id as usize);
        }
    }
    found
}

/// Within which errors every machine fits.
fn within(machine: &Machine) -> Option<String> {
    let percent = |error: f64| (error * 1e4).round() / 1e2;
    let mut named: Vec<([f64; 2], AxisSet)> = Vec::new();
    for (id, axis) in ALL_AXES.into_iter().zip(&machine.axes) {
        let Some(axis) = axis else { continue };
        let errors = [axis.mass_error, axis.friction_error].map(percent);
        match named.iter_mut().find(|(other, _)| *other == errors) {
            Some((_, set)) => set.insert(id as usize),
            None => named.push((errors, AxisSet(1 << id as usize))),
        }
    }
    named.retain(|(errors, _)| *errors != [0.0; 2]);
    let mut text = String::new();
    for ([mass, friction], set) in &named {
        let comma = if text.is_empty() { "" } else { ", " };
        let _ = write!(text, "{comma}{set} mass ±{mass} %, friction ±{friction} %");
    }
    (!text.is_empty()).then(|| {
        format!("every machine within these errors: {text}; weights as the machine file has them")
    })
}

/// How far servos exceed their commands, a sentence for each factor.
fn servos(machine: &Machine) -> Vec<String> {
    let mut named: Vec<(f64, AxisSet)> = Vec::new();
    for (id, axis) in ALL_AXES.into_iter().zip(&machine.axes) {
        let Some(axis) = axis.filter(|axis| axis.servo.is_some()) else {
            continue;
        };
        let factor = axis.servo_factor_motor;
        match named.iter_mut().find(|(other, _)| *other == factor) {
            Some((_, set)) => set.insert(id as usize),
            None => named.push((factor, AxisSet(1 << id as usize))),
        }
    }
    let sentence = |(factor, set): (f64, AxisSet)| {
        format!(
            "servos as described ({set}): the power of acceleration exceeds that of \
             the command by a factor of at most {factor}"
        )
    };
    named.into_iter().map(sentence).collect()
}

/// What counts exactly as the machine file has it.
fn exact(machine: &Machine) -> Option<String> {
    let listed = list([
        ("mass", axes(machine, |_, axis| axis.mass_error == 0.0)),
        (
            "friction",
            axes(machine, |_, axis| axis.friction_error == 0.0 && rubs(axis)),
        ),
        (
            "how servos follow",
            axes(machine, |_, axis| {
                axis.servo.is_none()
                    && (axis.servo_factor_motor == 1.0 || axis.servo_factor_regen == 1.0)
            }),
        ),
    ])?;
    Some(format!(
        "taken as exact; only the margin covers errors in: {listed}"
    ))
}

/// What a real axis has and this one has not.
fn absent(machine: &Machine) -> Option<String> {
    let is_lathe = machine.controller.language.dialect.diameter;
    let listed = list([
        ("friction", axes(machine, |_, axis| !rubs(axis))),
        (
            "losses of the drive",
            axes(machine, |_, axis| {
                axis.efficiency == 1.0 && axis.copper_w_n2 == 0.0
            }),
        ),
        (
            "weight",
            axes(machine, |id, axis| {
                id == AxisId::Z && !is_lathe && axis.gravity_n == 0.0
            }),
        ),
    ])?;
    Some(format!(
        "counted as none, as the machine file gives none: {listed}"
    ))
}

/// Whether an axis has friction.
fn rubs(axis: &Axis) -> bool {
    axis.coulomb_n > 0.0 || axis.viscous_n_s_m > 0.0
}

/// Quantities with their axes; `None` where no axis is concerned.
fn list<const N: usize>(quantities: [(&str, AxisSet); N]) -> Option<String> {
    let shown: Vec<String> = quantities
        .into_iter()
        .filter(|(_, set)| !set.is_empty())
        .map(|(what, set)| format!("{what} ({set})"))
        .collect();
    (!shown.is_empty()).then(|| shown.join(", "))
}
