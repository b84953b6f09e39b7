//! Torque and force over speed, as points.

use std::f64::consts::TAU;
use std::ops::Range;

use super::findings::Findings;
use super::machine_file::{AxisTable, ForcePointTable, TorquePointTable};
use super::value::At;
use crate::axis::{Axis, AxisId, AxisKind};
use crate::model::ForcePoint;
use crate::units::{M_PER_MM, RAD_PER_DEG, SECONDS_PER_MINUTE};

/// Points that a curve may have.
const POINTS_MAX: usize = 16;

/// A point as it is written: speed, torque or force, and where.
pub(crate) type Written<'a> = (f64, f64, &'a Range<usize>);

/// The points of a torque curve that are whole.
pub(crate) fn torque_points(curve: &[At<TorquePointTable>]) -> Vec<Written<'_>> {
    let point = |at: &'_ At<TorquePointTable>| {
        let (rpm, torque) = (at.value.rpm.as_ref()?, at.value.torque_nm.as_ref()?);
        Some((rpm.value, torque.value))
    };
    let whole = |at| point(at).map(|(speed, value)| (speed, value, &at.span));
    curve.iter().filter_map(whole).collect()
}

fn force_points(curve: &[At<ForcePointTable>]) -> Vec<Written<'_>> {
    let point = |at: &'_ At<ForcePointTable>| {
        let (speed, force) = (at.value.speed_mm_min.as_ref()?, at.value.force_n.as_ref()?);
        Some((speed.value, force.value))
    };
    let whole = |at| point(at).map(|(speed, value)| (speed, value, &at.span));
    curve.iter().filter_map(whole).collect()
}

/// Checks that speeds ascend from 0; `None` if they do not, or without a point.
pub(crate) fn points(
    findings: &mut Findings<'_>,
    key: &str,
    curve: Vec<Written<'_>>,
) -> Option<Vec<(f64, f64)>> {
    let mut last = None;
    let mut fits = !curve.is_empty();
    for (index, &(speed, _, span)) in curve.iter().enumerate() {
        let wrong = match last {
            None if speed != 0.0 => Some("the first point must be at speed 0".to_owned()),
            Some(last) if speed <= last => Some("speeds must ascend".to_owned()),
            _ if index >= POINTS_MAX => Some(format!("more than {POINTS_MAX} points")),
            _ => None,
        };
        last = Some(speed);
        if let Some(wrong) = wrong {
            let message = format!("`{key}`: {wrong}");
            findings.error("machine-curve", span, message, None);
            fits = false;
        }
    }
    fits.then(|| curve.into_iter().map(|(v, t, _)| (v, t)).collect())
}

/// The force curve of an axis at the load, if one is given; `axis` is what the
/// table made otherwise.
pub(crate) fn force(
    findings: &mut Findings<'_>,
    id: AxisId,
    table: &AxisTable,
    axis: Option<&Axis>,
) -> Option<Vec<ForcePoint>> {
    let kind = super::axis::kind(id, table);
    let letter = id.letter() as char;
    let gear = table.gear_ratio.as_ref().map_or(1.0, |gear| gear.value);
    let (list, speed_factor, force_factor) = match (&table.force_curve, &table.torque_curve) {
        (None, None) => return None,
        (Some(_), Some(torque)) => {
            let message =
                format!("`force_curve` and `torque_curve` give the same quantity of axis {letter}");
            let help = Some("keep one of the two".to_owned());
            let span = torque.first().map_or(0..0, |point| point.span.clone());
            findings.error("machine-twice", &span, message, help);
            return None;
        }
        (Some(force), None) => {
            if kind == AxisKind::Rotary {
                let message = format!("`force_curve` is for linear axes; axis {letter} turns");
                let help = Some("give `torque_curve`".to_owned());
                let span = force.first().map_or(0..0, |point| point.span.clone());
                findings.error("machine-kind", &span, message, help);
                return None;
            }
            let list = points(findings, "force_curve", force_points(force))?;
            (list, 1.0 / SECONDS_PER_MINUTE, 1.0)
        }
        (None, Some(torque)) => {
            let list = points(findings, "torque_curve", torque_points(torque))?;
            if kind == AxisKind::Rotary {
                // One revolution per minute of the motor, at the table.
                let degrees = TAU / RAD_PER_DEG / SECONDS_PER_MINUTE / gear;
                (list, degrees, gear)
            } else if let Some(lead) = super::parts::lead_mm(table) {
                let rad_per_m = TAU * gear / (lead * M_PER_MM);
                (list, lead / SECONDS_PER_MINUTE / gear, rad_per_m)
            } else {
                let message =
                    format!("`torque_curve` is at the motor, but axis {letter} has no `lead_mm`");
                let help = Some("give the screw's `lead_mm`, or a `force_curve`".to_owned());
                let span = torque.first().map_or(0..0, |point| point.span.clone());
                findings.error("machine-missing", &span, message, help);
                return None;
            }
        }
    };
    let point = |(speed, force)| ForcePoint {
        speed_mm_s: speed * speed_factor,
        force_n: force * force_factor,
    };
    let curve: Vec<ForcePoint> = list.into_iter().map(point).collect();
    let force = table.force_curve.iter().flatten().map(|at| &at.span);
    let torque = table.torque_curve.iter().flatten().map(|at| &at.span);
    if let Some(axis) = axis {
        drives(findings, axis, &curve, force.chain(torque));
    }
    Some(curve)
}

/// A drive must be able to speed up, in both directions, at every speed up to
/// the rapid speed; `spans` are those of the points.
fn drives<'a>(
    findings: &mut Findings<'_>,
    axis: &Axis,
    curve: &[ForcePoint],
    spans: impl Iterator<Item = &'a Range<usize>>,
) {
    let (unit, force) = match axis.kind {
        AxisKind::Linear => ("mm/min", "N"),
        AxisKind::Rotary => ("degrees/min", "N·m"),
    };
    let per_minute = |speed_mm_s: f64| speed_mm_s * SECONDS_PER_MINUTE;
    let rapid = axis.rapid_mm_s;
    let mut before: Option<&ForcePoint> = None;
    let mut last_span = None;
    for (point, span) in curve.iter().zip(spans) {
        last_span = Some(span);
        let (mut speed, mut own) = (point.speed_mm_s, point.force_n);
        if let Some(before) = before.filter(|_| speed > rapid) {
            let share = (rapid - before.speed_mm_s) / (speed - before.speed_mm_s);
            own = before.force_n + share * (own - before.force_n);
            speed = rapid;
        }
        let friction = axis.coulomb_n + axis.viscous_n_s_m * speed * axis.si_per_unit;
        let needed = friction + axis.gravity_n.abs();
        if own <= needed {
            let message = format!(
                "nothing is left to accelerate with at {:.0} {unit}: friction and weight take {needed:.1} {force} of {own:.1} {force}",
                per_minute(speed)
            );
            findings.error("machine-curve", span, message, None);
            return;
        }
        if point.speed_mm_s >= rapid {
            return;
        }
        before = Some(point);
    }
    // Motor data and rapid speed may differ by rounding.
    if let (Some(last), Some(span)) = (before, last_span)
        && last.speed_mm_s < rapid * (1.0 - 1e-6)
    {
        let message = format!(
            "the curve ends at {:.0} {unit}, below the rapid speed of {:.0} {unit}",
            per_minute(last.speed_mm_s),
            per_minute(rapid)
        );
        let help = Some("give a point at the rapid speed or beyond".to_owned());
        findings.error("machine-curve", span, message, help);
    }
}
