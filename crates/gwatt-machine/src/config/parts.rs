//! Mass of an axis as the sum of its parts, and the travel of one revolution.
//!
//! A part that turns `k` radians a metre of travel weighs as much as `J·k²` (both have the
//! energy `½·J·(k·v)²`). A screw, a pulley or a pinion turns `k = 2π/h`, with the lead `h`,
//! for a pulley or pinion its pitch circle `π·d`; the rotor turns `gear_ratio` times as
//! much. A solid cylinder has `J = π/32·ρ·l·d⁴` (half its mass times the radius squared;
//! Dubbel, "Taschenbuch für den Maschinenbau", moments of inertia of bodies), with the
//! density of steel, 7850 kg/m³: threads, bores and aluminium make it less.

use std::f64::consts::{PI, TAU};

use super::axis_table::AxisTable;
use super::findings::Findings;
use super::part_tables::{WheelTable, cylinder};
use super::value::{At, Num};
use crate::axis::AxisKind;
use crate::model::MassPart;
use crate::units::M_PER_MM;

/// Travel per revolution of the screw, pulley or pinion in mm; `None` where nothing says it.
pub(crate) fn lead_mm(table: &AxisTable) -> Option<f64> {
    let screw = table
        .screw
        .as_ref()
        .and_then(|it| it.value.lead_mm.as_ref());
    let lead = table.lead_mm.as_ref().or(screw).map(|lead| lead.value);
    let wheel = || table.pulley.as_ref().or(table.pinion.as_ref());
    let around = || wheel()?.value.diameter_mm().map(|diameter| PI * diameter);
    lead.or_else(around)
}

/// What turns and slides besides the mass or inertia that the table gives as such, as mass
/// at the load (of a rotary axis: inertia).
pub(crate) fn list(kind: AxisKind, table: &AxisTable) -> Vec<MassPart> {
    let gear = table.gear_ratio.as_ref().map_or(1.0, |gear| gear.value);
    let rad_per_m = match kind {
        AxisKind::Rotary => Some(1.0),
        AxisKind::Linear => lead_mm(table).map(|lead| TAU / (lead * M_PER_MM)),
    };
    let mut parts = Vec::new();
    let mut push = |name, inertia_kg_m2: f64, count: f64, gear: f64| {
        let Some(k) = rad_per_m.map(|k| k * gear) else {
            return;
        };
        if inertia_kg_m2 > 0.0 {
            parts.push(MassPart {
                name,
                mass_kg: count * inertia_kg_m2 * k * k,
                inertia_kg_m2: Some(inertia_kg_m2),
                count,
            });
        }
    };
    if let Some(rotor) = &table.rotor_kg_m2 {
        push("rotor", rotor.value, 1.0, gear);
    }
    if kind == AxisKind::Rotary {
        return parts;
    }
    if let Some(screw) = &table.screw
        && let (Some(d), Some(l)) = (&screw.value.diameter_mm, &screw.value.length_mm)
    {
        push("screw", cylinder(d.value, l.value), 1.0, 1.0);
    }
    for (name, wheel, usual) in [
        ("pulley", &table.pulley, 2.0),
        ("pinion", &table.pinion, 1.0),
    ] {
        let Some(wheel) = wheel.as_ref().map(|it| &it.value) else {
            continue;
        };
        if let Some(inertia) = wheel.inertia_kg_m2() {
            let count = wheel.count.as_ref().map_or(usual, |count| count.value);
            push(name, inertia, count, 1.0);
        }
    }
    parts
}

/// All parts of an axis, the mass that the table gives as such first; empty where there is
/// nothing besides that.
pub(crate) fn all(kind: AxisKind, table: &AxisTable, total: f64) -> Vec<MassPart> {
    let mut parts = list(kind, table);
    if parts.is_empty() {
        return parts;
    }
    let turning: f64 = parts.iter().map(|part| part.mass_kg).sum();
    let own = match kind {
        AxisKind::Linear => (table.moved_mass_kg.is_some(), "moved mass", "mass"),
        AxisKind::Rotary => (table.moved_inertia_kg_m2.is_some(), "table", "inertia"),
    };
    let (moved, of_moved, of_all) = own;
    let given = MassPart {
        name: if moved { of_moved } else { of_all },
        mass_kg: total - turning,
        inertia_kg_m2: None,
        count: 1.0,
    };
    parts.insert(0, given);
    parts
}

/// Checks that the parts go together.
pub(crate) fn check(findings: &mut Findings<'_>, letter: char, kind: AxisKind, table: &AxisTable) {
    for (key, wheel) in [("pulley", &table.pulley), ("pinion", &table.pinion)] {
        if let Some(at) = wheel {
            check_wheel(findings, letter, key, at);
        }
    }
    let mut leads = Vec::new();
    if let Some(lead) = &table.lead_mm {
        leads.push(("lead_mm", lead.span.clone()));
    }
    if let Some(lead) = table
        .screw
        .as_ref()
        .and_then(|it| it.value.lead_mm.as_ref())
    {
        leads.push(("screw.lead_mm", lead.span.clone()));
    }
    for (key, wheel) in [("pulley", &table.pulley), ("pinion", &table.pinion)] {
        if let Some(at) = wheel {
            leads.push((key, at.span.clone()));
        }
    }
    if let [(first, _), (second, span), ..] = leads.as_slice() {
        let message =
            format!("`{first}` and `{second}` both say how far axis {letter} goes in a revolution");
        let help = Some("keep one of the two".to_owned());
        findings.error("machine-twice", span, message, help);
    }
    if let Some(screw) = &table.screw
        && leads.is_empty()
    {
        let message = format!("the screw of axis {letter} has no lead");
        let help = Some("give its `lead_mm`: travel per revolution".to_owned());
        findings.error("machine-missing", &screw.span, message, help);
    }
    needs_rotor(findings, letter, kind, table);
}

/// The letter of extruders.
const EXTRUDER: char = 'E';

/// What slides is not all: the rotor often is the larger part.
fn needs_rotor(findings: &mut Findings<'_>, letter: char, kind: AxisKind, table: &AxisTable) {
    fn span<B>(number: Option<&Num<B>>) -> Option<std::ops::Range<usize>> {
        number.map(|number| number.span.clone())
    }
    let (key, moved) = match kind {
        AxisKind::Linear => ("moved_mass_kg", span(table.moved_mass_kg.as_ref())),
        AxisKind::Rotary => (
            "moved_inertia_kg_m2",
            span(table.moved_inertia_kg_m2.as_ref()),
        ),
    };
    let Some(moved) = moved else { return };
    let refused = findings.is_refused(&format!("axes.{letter}.rotor_kg_m2"));
    if table.rotor_kg_m2.is_none() && !refused {
        let message = format!("`{key}` is without the drive: `rotor_kg_m2` is missing");
        let help = "the rotor's inertia, from the motor's data sheet, with coupling and brake; 0 \
                    for a linear motor. 1 kg·cm² is 1e-4 kg·m²";
        findings.error("machine-missing", &moved, message, Some(help.to_owned()));
    }
    let turns = table.screw.is_some() || table.pulley.is_some() || table.pinion.is_some();
    // The gears and wheels of an extruder are what moves there: no screw is to be given.
    let turns = turns || letter == EXTRUDER;
    if let Some(lead) = table
        .lead_mm
        .as_ref()
        .filter(|_| !turns && kind == AxisKind::Linear)
    {
        let message = "the inertia of what turns besides the rotor counts as none";
        let help = "give `screw`, such as screw = { diameter_mm = 32, length_mm = 900 }, or add it to \
                    `rotor_kg_m2`";
        findings.warning(
            "machine-missing",
            &lead.span,
            message,
            Some(help.to_owned()),
        );
    }
}

fn check_wheel(findings: &mut Findings<'_>, letter: char, key: &str, at: &At<WheelTable>) {
    let wheel = &at.value;
    if findings.refused_in(&format!("axes.{letter}.{key}")) {
        return;
    }
    let by_teeth = wheel.teeth.is_some() || wheel.pitch_mm.is_some();
    if wheel.diameter_mm.is_some() && by_teeth {
        let message = format!("`{key}` has its diameter twice");
        let help = Some("keep `diameter_mm`, or `teeth` and `pitch_mm`".to_owned());
        findings.error("machine-twice", &at.span, message, help);
    } else if wheel.diameter_mm().is_none() {
        let message = format!("`{key}` of axis {letter} needs the diameter of its pitch circle");
        let help = Some("give `diameter_mm`, or `teeth` and `pitch_mm`".to_owned());
        findings.error("machine-missing", &at.span, message, help);
    }
    if wheel.width_mm.is_some() && wheel.inertia_kg_m2.is_some() {
        let message = format!("`{key}` has its inertia twice");
        let help = Some("keep `width_mm` or `inertia_kg_m2`".to_owned());
        findings.error("machine-twice", &at.span, message, help);
    } else if wheel.width_mm.is_none() && wheel.inertia_kg_m2.is_none() {
        let message = format!("`{key}` of axis {letter} needs an inertia");
        let help = "give `width_mm` (it counts as solid steel), or `inertia_kg_m2` of each one";
        findings.error("machine-missing", &at.span, message, Some(help.to_owned()));
    }
}
