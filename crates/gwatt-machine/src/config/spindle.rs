//! The spindle's table.

use std::ops::Range;

use super::converter_name::converter_of;
use super::drive_curve::{points, torque_points};
use super::findings::Findings;
use super::machine_file::SpindleTable;
use super::value::{At, Num};
use crate::controller::{Controller, SpindleWait};
use crate::model::{Converter, Spindle, TorquePoint};
use crate::units::RAD_S_PER_RPM;

/// Makes the spindle of its table; `None` if something is missing.
pub(crate) fn spindle(
    findings: &mut Findings<'_>,
    table: &At<SpindleTable>,
    converters: &[Converter],
    controller: &Controller,
) -> Option<Spindle> {
    let SpindleTable {
        max_rpm,
        base_rpm,
        accel_time_s,
        jerk_time_s,
        ..
    } = &table.value;
    one_of_the_two(findings, table);
    let max = max_rpm.as_ref()?;
    if let Some(base) = base_rpm.as_ref().filter(|base| base.value > max.value) {
        let message = "`base_rpm` is above `max_rpm`";
        findings.error("machine-spindle", &base.span, message, None);
    }
    if let (Some(jerk), Some(time)) = (jerk_time_s, accel_time_s)
        && jerk.value > time.value
    {
        let message = "`jerk_time_s` is longer than `accel_time_s`";
        findings.error("machine-spindle", &jerk.span, message, None);
    }
    let converter = match &table.value.converter {
        Some(name) => converter_of(findings, name, converters)?,
        None if converters.len() > 1 => {
            let message = "with several converters, the spindle needs `converter`";
            findings.error("machine-missing", &table.span, message, None);
            return None;
        }
        None => 0,
    };
    let table = &table.value;
    let friction_nm = value(table.friction_nm.as_ref(), 0.0);
    let torque_curve = match &table.torque_curve {
        Some(curve) => torque_curve(findings, curve, friction_nm)?,
        None => Vec::new(),
    };
    let spindle = Spindle {
        inertia_kg_m2: table.inertia_kg_m2.as_ref()?.value,
        friction_nm,
        max_rpm: max.value,
        base_rpm: value(base_rpm.as_ref(), 0.0),
        accel_time_s: accel_time_s.as_ref().map(|time| time.value),
        torque_curve,
        jerk_time_s: value(jerk_time_s.as_ref(), 0.0),
        efficiency: value(table.efficiency.as_ref(), 1.0),
        base_load_w: value(table.base_load_w.as_ref(), 0.0),
        peak_power_w: table.peak_power_w.as_ref().map(|power| power.value),
        regen_power_w: table.regen_power_w.as_ref().map(|power| power.value),
        wait: match (table.wait, controller.planner.spindle_wait) {
            (None | Some(true), SpindleWait::Blocks) => SpindleWait::Blocks,
            (Some(true), _) => SpindleWait::Feeds,
            (Some(false), _) => SpindleWait::Nothing,
            (None, wait) => wait,
        },
        converter,
        cutting_power_w: value(table.cutting_power_w.as_ref(), 0.0),
    };
    if let Some(peak) = &table.peak_power_w {
        enough_power(findings, &spindle, peak.value, &peak.span);
    }
    Some(spindle)
}

/// The acceleration comes from a time or from a torque curve.
fn one_of_the_two(findings: &mut Findings<'_>, table: &At<SpindleTable>) {
    let SpindleTable {
        base_rpm,
        accel_time_s,
        torque_curve,
        ..
    } = &table.value;
    let Some(curve) = torque_curve else {
        if accel_time_s.is_none() && !findings.refused_in("spindle") {
            let message = "the spindle needs an acceleration";
            let help = Some("give `accel_time_s` or `torque_curve`".to_owned());
            findings.error("machine-missing", &table.span, message, help);
        }
        return;
    };
    let given = [
        ("accel_time_s", accel_time_s.as_ref().map(|time| &time.span)),
        ("base_rpm", base_rpm.as_ref().map(|base| &base.span)),
    ];
    for (key, span) in given {
        if let Some(span) = span {
            let message = format!("`{key}` and `torque_curve` give the same quantity");
            let help = Some("keep one of the two".to_owned());
            findings.error("machine-twice", span, message, help);
        }
    }
    if curve.is_empty() && !findings.refused_in("spindle") {
        let message = "`torque_curve` has no points";
        findings.error("machine-spindle", &table.span, message, None);
    }
}

fn torque_curve(
    findings: &mut Findings<'_>,
    curve: &[At<super::machine_file::TorquePointTable>],
    friction_nm: f64,
) -> Option<Vec<TorquePoint>> {
    let list = points(findings, "torque_curve", torque_points(curve))?;
    for (point, table) in list.iter().zip(curve) {
        if point.1 <= friction_nm {
            let message = "the torque does not overcome `friction_nm`";
            findings.error("machine-spindle", &table.span, message, None);
        }
    }
    let point = |(rpm, torque_nm)| TorquePoint { rpm, torque_nm };
    Some(list.into_iter().map(point).collect())
}

/// Less power than friction takes at `max_rpm` never gets there.
fn enough_power(findings: &mut Findings<'_>, spindle: &Spindle, peak_w: f64, span: &Range<usize>) {
    let friction_w = spindle.friction_nm * spindle.max_rpm * RAD_S_PER_RPM;
    let needed = spindle.base_load_w + friction_w / spindle.efficiency;
    if peak_w <= needed {
        let message = format!(
            "`peak_power_w` leaves nothing to accelerate with at `max_rpm`: friction and base load take {needed:.0} W"
        );
        findings.error("machine-spindle", span, message, None);
    }
}

fn value<B>(number: Option<&Num<B>>, default: f64) -> f64 {
    number.map_or(default, |number| number.value)
}
