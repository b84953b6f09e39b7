//! The force that the filters of `tune` ask for, next to what a machine file says that an
//! axis has.

use anyhow::{Result, bail};
use gwatt::identify::tune::Tuned;
use gwatt::machine::{Axis, AxisKind, ForcePoint, Machine};

use super::into::axis_of;

/// The force of each axis under its filter, as text; where the command goes to the
/// acceleration of the machine file with its jerk.
///
/// # Errors
///
/// An axis that has less force than its filter asks for.
pub fn check(tuned: &Tuned, machine: &Machine) -> Result<Vec<String>> {
    let mut lines = Vec::new();
    for (index, response) in tuned.axes.iter().enumerate() {
        let id = axis_of(response.letter)?;
        let Some(axis) = machine.axes.get(id as usize).and_then(Option::as_ref) else {
            continue;
        };
        let rise_s = if axis.jerk_mm_s3 > 0.0 {
            axis.accel_mm_s2 / axis.jerk_mm_s3
        } else {
            0.0
        };
        let effort = tuned.correction.effort(index, rise_s);
        // A motor's inertia says nothing of a slide's mass.
        let is_alike = response.rotary == (axis.kind == AxisKind::Rotary);
        let inertia = response.inertia.filter(|_| is_alike);
        let force = needed(axis, inertia, effort.accel);
        let unit = match axis.kind {
            AxisKind::Linear => "N",
            AxisKind::Rotary => "N·m",
        };
        let curves = &machine.force_curves;
        let curve = curves.iter().find(|(of, _)| *of == id);
        let Some(most) = curve.and_then(|(_, points)| largest(points)) else {
            lines.push(format!(
                "the filter of {} takes up to {force:.1} {unit} at the acceleration of the machine file, which does not say what the axis has (force_curve)",
                response.letter
            ));
            continue;
        };
        if force > most {
            bail!(
                "the filter of axis {} takes up to {force:.1} {unit}, and the axis has {most:.1} {unit}\n  help: lower --low-pass-hz, or the acceleration or jerk of the axis in the machine file",
                response.letter
            );
        }
        lines.push(format!(
            "the filter of {} takes up to {force:.1} {unit} of the {most:.1} {unit} that the axis has",
            response.letter
        ));
    }
    Ok(lines)
}

/// Force at the acceleration of the machine file, so many times, and against friction and
/// weight.
fn needed(axis: &Axis, identified: Option<f64>, times: f64) -> f64 {
    let mass = identified.unwrap_or(0.0).max(axis.mass_kg);
    let accel = axis.accel_mm_s2 * axis.si_per_unit;
    let speed = axis.rapid_mm_s * axis.si_per_unit;
    times * mass * accel + axis.coulomb_n + axis.viscous_n_s_m * speed + axis.gravity_n.abs()
}

fn largest(points: &[ForcePoint]) -> Option<f64> {
    points.iter().map(|point| point.force_n).reduce(f64::max)
}
