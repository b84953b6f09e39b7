//! Warnings for values that are possible, but look like another unit.

use std::ops::Range;

use super::findings::Findings;
use super::machine_file::{AxisTable, ConverterTable, MachineFile, OverrideTable};
use super::plausible_parts::{self, RULE, round};
use super::quantity::Given;
use super::value::{Num, Part};
use crate::axis::{AXES, Axis, AxisId, AxisKind};
use crate::model::{Converter, ForcePoint};

/// What a value is usually, and what it looks like when it is outside.
struct Usual {
    key: &'static str,
    unit: &'static str,
    low: f64,
    if_below: &'static str,
    high: f64,
    if_above: &'static str,
}

const NONE: f64 = f64::INFINITY;

/// Below this no axis is as slow, mm/min.
const LOWEST_MM_MIN: f64 = 100.0;

/// Usual values of fields as they are written.
const FIELDS: [Usual; 12] = [
    Usual {
        key: "rapid_mm_min",
        unit: "mm/min",
        low: LOWEST_MM_MIN,
        if_below: "mm/s or m/min given?",
        high: 1e6,
        if_above: "µm/s given?",
    },
    Usual {
        key: "rapid_deg_min",
        unit: "degrees/min",
        low: 100.0,
        if_below: "revolutions/min or degrees/s given?",
        high: 2e6,
        if_above: "degrees/min are meant",
    },
    Usual {
        key: "max_speed_rpm",
        unit: "1/min",
        low: 1.0,
        if_below: "revolutions/s given?",
        high: 1e5,
        if_above: "degrees/min given?",
    },
    Usual {
        key: "accel_time_s",
        unit: "s",
        low: 1e-3,
        if_below: "seconds are meant",
        high: 20.0,
        if_above: "milliseconds given?",
    },
    Usual {
        key: "lead_mm",
        unit: "mm",
        low: 0.1,
        if_below: "metres given?",
        high: 1000.0,
        if_above: "µm given?",
    },
    Usual {
        key: "gear_ratio",
        unit: "",
        low: 0.01,
        if_below: "motor revolutions per screw or table revolution are meant",
        high: 1000.0,
        if_above: "motor revolutions per screw or table revolution are meant",
    },
    Usual {
        key: "position_gain_1_s",
        unit: "1/s",
        low: 5.0,
        if_below: "in (m/min)/mm? 1 (m/min)/mm is 16.67 1/s",
        high: 500.0,
        if_above: "in 1/min?",
    },
    Usual {
        key: "velocity_bandwidth_hz",
        unit: "Hz",
        low: 3.0,
        if_below: "kHz given?",
        high: 3000.0,
        if_above: "Hz are meant",
    },
    Usual {
        key: "servo_factor_motor",
        unit: "",
        low: 0.0,
        if_below: "",
        high: 5.0,
        if_above: "a factor is meant, not percent",
    },
    Usual {
        key: "servo_factor_regen",
        unit: "",
        low: 0.0,
        if_below: "",
        high: 5.0,
        if_above: "a factor is meant, not percent",
    },
    Usual {
        key: "efficiency",
        unit: "",
        low: 0.05,
        if_below: "a share is meant: 85 % is 0.85",
        high: NONE,
        if_above: "",
    },
    Usual {
        key: "peak_power_w",
        unit: "W",
        low: 20.0,
        if_below: "kW given?",
        high: 1e7,
        if_above: "mW given?",
    },
];

const LINEAR_ACCEL: Usual = Usual {
    key: "acceleration",
    unit: "mm/s²",
    low: 20.0,
    if_below: "m/s² given?",
    high: 200_000.0,
    if_above: "mm/min² or µm/s² given?",
};

const LINEAR_MASS: Usual = Usual {
    key: "mass",
    unit: "kg",
    low: 0.01,
    if_below: "tonnes given, or an inertia in kg·cm²?",
    high: 1e5,
    if_above: "grams given, or an inertia in kg·cm²?",
};

const ROTARY_ACCEL: Usual = Usual {
    key: "acceleration",
    unit: "degrees/s²",
    low: 20.0,
    if_below: "rad/s² or revolutions/s² given?",
    high: 1e6,
    if_above: "degrees/min² given?",
};

const ROTARY_INERTIA: Usual = Usual {
    key: "inertia",
    unit: "kg·m²",
    low: 1e-7,
    if_below: "kg·m² are meant",
    high: 1e5,
    if_above: "kg·cm² or kg·mm² given?",
};

/// Checks a linear axis.
pub(crate) fn linear(findings: &mut Findings<'_>, table: &AxisTable, accel: &Given, mass: &Given) {
    fields(findings, table);
    check(findings, &LINEAR_ACCEL, accel.key, accel.value, &accel.span);
    plausible_parts::forces(findings, table);
    sum(findings, &LINEAR_MASS, AxisKind::Linear, table, mass);
}

/// Checks what an axis weighs in all; the caret stands where the most of it comes from.
fn sum(
    findings: &mut Findings<'_>,
    usual: &Usual,
    kind: AxisKind,
    table: &AxisTable,
    given: &Given,
) {
    if plausible_parts::rotor(findings, kind, table) {
        return;
    }
    let part = plausible_parts::largest(kind, table, given).filter(|_| given.value > usual.high);
    let (key, span) = part.unwrap_or((given.key, given.span.clone()));
    check(findings, usual, key, given.value, &span);
}

/// Checks a rotary axis.
pub(crate) fn rotary(
    findings: &mut Findings<'_>,
    table: &AxisTable,
    accel: &Given,
    inertia: &Given,
) {
    fields(findings, table);
    check(findings, &ROTARY_ACCEL, accel.key, accel.value, &accel.span);
    sum(findings, &ROTARY_INERTIA, AxisKind::Rotary, table, inertia);
}

/// Checks a converter.
pub(crate) fn converter(findings: &mut Findings<'_>, table: &ConverterTable) {
    field(findings, "peak_power_w", table.peak_power_w.as_ref());
    let credited = [table.credit_regen, table.credit_capacitance].contains(&Some(true));
    let none = table.regen_power_w.as_ref().filter(|it| it.value == 0.0);
    if let Some(none) = none.filter(|_| !credited) {
        let message = "with `regen_power_w` of 0 no axis may brake: braking feeds power back";
        let help = "leave it out where the capacitors of the bus take what small drives feed back \
                    (`capacitance_f` and `bus_max_v` count that); else give what the supply or \
                    its braking resistor takes";
        findings.warning("machine-braking", &none.span, message, Some(help.into()));
    }
}

/// Longer than this no axis takes to its full acceleration, s.
const JERK_TIME_S: f64 = 2.0;

/// Checks what is absurd once axes and converters are known: a jerk that hardly lets the axis
/// accelerate, friction beyond what the converter delivers, an acceleration that asks for
/// more than the drive's curve gives.
pub(crate) fn drives(
    findings: &mut Findings<'_>,
    file: &MachineFile,
    axes: &[Option<Axis>; AXES],
    converters: &[Converter],
    curves: &[(AxisId, Vec<ForcePoint>)],
) {
    for (id, table) in file.axes.iter().flat_map(|axes| axes.value.iter()) {
        let Some(axis) = &axes[id as usize] else {
            continue;
        };
        let letter = id.letter() as char;
        let [length, force] = match axis.kind {
            AxisKind::Linear => ["mm", "N"],
            AxisKind::Rotary => ["degrees", "N·m"],
        };
        let table = &table.value;
        jerk(findings, table, axis, length);
        let speed = axis.rapid_mm_s * axis.si_per_unit;
        let rubs = axis.coulomb_n + axis.viscous_n_s_m * speed;
        let friction_w = rubs * speed / axis.efficiency;
        let fed_by = converters.iter().find(|it| it.axes.contains(id as usize));
        if let Some(converter) =
            fed_by.filter(|it| it.peak_power_w > 0.0 && friction_w > it.peak_power_w)
        {
            let message = format!(
                "friction alone takes {} W of axis {letter} at its rapid speed, more than the \
                 converter's {} W",
                round(friction_w),
                round(converter.peak_power_w)
            );
            let of_motor = table.friction_nm.is_some() || table.viscous_nm_s_rad.is_some();
            let force = if of_motor { "N·m" } else { force };
            let help = format!("friction in {force} is meant, speed in {length}/min, power in W");
            let span = friction_span(table).unwrap_or(0..0);
            findings.warning(RULE, &span, message, Some(help));
        }
        let curve = curves.iter().find(|(of, _)| *of == id);
        let at_rest = curve.and_then(|(_, points)| points.first());
        let needed = axis.mass_kg * axis.accel_mm_s2 * axis.si_per_unit
            + axis.coulomb_n
            + axis.gravity_n.abs();
        if let Some(point) = at_rest.filter(|point| needed > point.force_n) {
            let message = format!(
                "the acceleration of axis {letter} needs {} {force}, and its drive gives {} {force} \
                 at rest: it accelerates as that permits",
                round(needed),
                round(point.force_n)
            );
            let list = [
                table.accel_mm_s2.as_ref().map(|it| it.span.clone()),
                table.accel_deg_s2.as_ref().map(|it| it.span.clone()),
                table.accel_time_s.as_ref().map(|it| it.span.clone()),
            ];
            let span = list.into_iter().flatten().next().unwrap_or(0..0);
            let help = "check mass, acceleration and the curve".to_owned();
            findings.warning(RULE, &span, message, Some(help));
        }
    }
}

/// A printer's X and Y are hardly ever as slow as this, mm/min.
const PRINTER_MM_MIN: f64 = 600.0;

/// Speeds of a printer in mm/s look like ones in mm/min, and are 60 times too low.
pub(crate) fn printer(findings: &mut Findings<'_>, file: &MachineFile) {
    let axes = file.axes.iter().flat_map(|axes| axes.value.iter());
    for (_, table) in axes.filter(|(id, _)| matches!(id, AxisId::X | AxisId::Y)) {
        let given = table.value.rapid_mm_min.as_ref();
        let small = LOWEST_MM_MIN..PRINTER_MM_MIN;
        let Some(speed) = given.filter(|speed| small.contains(&speed.value)) else {
            continue;
        };
        let value = round(speed.value);
        let message = format!("`rapid_mm_min`: {value} mm/min is unusually small for a printer");
        let help = "mm/s given? 1 mm/s is 60 mm/min; powers would be too low".to_owned();
        findings.warning(RULE, &speed.span, message, Some(help));
    }
}

/// A jerk that is given in m/s³ makes an axis that never accelerates.
fn jerk(findings: &mut Findings<'_>, table: &AxisTable, axis: &Axis, length: &str) {
    let given = [
        table.jerk_mm_s3.as_ref().map(|it| it.span.clone()),
        table.jerk_deg_s3.as_ref().map(|it| it.span.clone()),
    ];
    let Some(span) = given.into_iter().flatten().next() else {
        return;
    };
    let seconds = axis.accel_mm_s2 / axis.jerk_mm_s3;
    if axis.jerk_mm_s3 > 0.0 && seconds > JERK_TIME_S {
        let message = format!(
            "a jerk of {} {length}/s³ takes {} s to the full acceleration",
            axis.jerk_mm_s3,
            round(seconds)
        );
        let help = "m/s³ given? 1 m/s³ is 1000 mm/s³; powers would be too low".to_owned();
        findings.warning(RULE, &span, message, Some(help));
    }
}

/// Where the friction of an axis stands.
fn friction_span(table: &AxisTable) -> Option<Range<usize>> {
    let list = [
        table.coulomb_n.as_ref().map(|it| it.span.clone()),
        table.friction_nm.as_ref().map(|it| it.span.clone()),
        table.viscous_n_s_m.as_ref().map(|it| it.span.clone()),
        table.viscous_nm_s_rad.as_ref().map(|it| it.span.clone()),
    ];
    list.into_iter().flatten().next()
}

/// More than half of the supply's power is hardly ever kept free.
const MARGIN: f64 = 0.5;

/// A margin that looks like the share that may be used.
pub(crate) fn margin(findings: &mut Findings<'_>, margin: &Part) {
    // One of 1 and more is refused.
    if margin.value <= MARGIN || margin.value >= 1.0 {
        return;
    }
    let (value, used) = (margin.value, round((1.0 - margin.value) * 100.0));
    let message = format!("`margin`: {value} leaves {used} % of the peak power to be used");
    let help = "the share that is kept free is meant: 10 % is 0.1".to_owned();
    findings.warning(RULE, &margin.span, message, Some(help));
}

/// Checks the overrides: a factor instead of percent is far below 100.
pub(crate) fn overrides(findings: &mut Findings<'_>, table: &OverrideTable) {
    fn low<B>(findings: &mut Findings<'_>, key: &str, number: Option<&Num<B>>) {
        if let Some(number) = number.filter(|number| (1.0..10.0).contains(&number.value)) {
            let value = number.value;
            let message = format!("override `{key}` of {value} % is unusually low");
            let help = Some(format!("as a factor? {value} is {} %", value * 100.0));
            findings.warning(RULE, &number.span, message, help);
        }
    }
    low(findings, "feed", table.feed.as_ref());
    low(findings, "rapid", table.rapid.as_ref());
    low(findings, "spindle", table.spindle.as_ref());
}

fn fields(findings: &mut Findings<'_>, table: &AxisTable) {
    field(findings, "rapid_mm_min", table.rapid_mm_min.as_ref());
    field(findings, "rapid_deg_min", table.rapid_deg_min.as_ref());
    field(findings, "max_speed_rpm", table.max_speed_rpm.as_ref());
    field(findings, "accel_time_s", table.accel_time_s.as_ref());
    field(findings, "lead_mm", table.lead_mm.as_ref());
    field(findings, "gear_ratio", table.gear_ratio.as_ref());
    field(findings, "efficiency", table.efficiency.as_ref());
    field(
        findings,
        "position_gain_1_s",
        table.position_gain_1_s.as_ref(),
    );
    field(
        findings,
        "velocity_bandwidth_hz",
        table.velocity_bandwidth_hz.as_ref(),
    );
    field(
        findings,
        "servo_factor_motor",
        table.servo_factor_motor.as_ref(),
    );
    field(
        findings,
        "servo_factor_regen",
        table.servo_factor_regen.as_ref(),
    );
}

fn field<B>(findings: &mut Findings<'_>, key: &'static str, number: Option<&Num<B>>) {
    let usual = FIELDS.iter().find(|usual| usual.key == key);
    if let (Some(usual), Some(number)) = (usual, number) {
        check(findings, usual, key, number.value, &number.span);
    }
}

fn check(findings: &mut Findings<'_>, usual: &Usual, key: &str, value: f64, span: &Range<usize>) {
    if value <= 0.0 {
        // Out of range: reported already.
        return;
    }
    let (size, doubt) = if value < usual.low {
        ("small", usual.if_below)
    } else if value > usual.high {
        ("large", usual.if_above)
    } else {
        return;
    };
    // A converted value is named with its quantity.
    let quantity = match key {
        "accel_time_s" if usual.unit != "s" => "an acceleration of ",
        "inertia_kg_m2" | "rotor_kg_m2" | "screw" | "pulley" | "pinion" if usual.unit == "kg" => {
            "a mass of "
        }
        "rotor_kg_m2" => "an inertia of ",
        _ => "",
    };
    let number = round(value);
    let space = if usual.unit.is_empty() { "" } else { " " };
    let message = format!(
        "`{key}`: {quantity}{number}{space}{} is unusually {size}",
        usual.unit
    );
    findings.warning(RULE, span, message, Some(doubt.to_owned()));
}
