//! Warnings for parts and forces of an axis that do not go with what it moves.

use std::ops::Range;

use super::axis_table::AxisTable;
use super::findings::Findings;
use super::parts;
use super::quantity::Given;
use super::value::Num;
use crate::axis::AxisKind;

pub(super) const RULE: &str = "machine-unit";

/// Gravity, m/s².
const G_M_S2: f64 = 9.81;
/// No motor of a sliding axis has a rotor as heavy as this, kg·m².
const ROTOR_KG_M2: f64 = 0.1;
/// A lighter one may weigh much more than what it moves by a fine screw.
const LIGHT_ROTOR_KG_M2: f64 = 1e-3;
/// No rotor weighs as many times what it moves.
const ROTOR_SHARE: f64 = 1000.0;
/// Screws are longer than this, mm.
const SCREW_MM: f64 = 10.0;
/// And thicker than this, mm; by the root of what they move in kg, in mm.
const SCREW_DIAMETER_MM: f64 = 2.0;
const SCREW_DIAMETER_MM_KG: f64 = 0.4;
/// Guides take more than this share of the weight that slides on them. A mass at the load may
/// be that of the rotor for the most part.
const FRICTION: f64 = 1e-3;
const FRICTION_OF_ALL: f64 = 1e-4;
/// No axis carries more than its weight; doubled, since counterweights pull too.
const WEIGHTS: f64 = 2.0;

/// Where a number stands, and its key.
type At<'k> = (&'k str, Range<usize>);

fn at<'k, B>(key: &'k str, number: Option<&Num<B>>) -> Option<At<'k>> {
    number.map(|number| (key, number.span.clone()))
}

/// A value that does not go with a mass.
fn doubt(findings: &mut Findings<'_>, at: &At<'_>, value: &str, mass_kg: f64, help: &str) {
    let (key, span) = at;
    let message = format!("`{key}`: {value} for {} kg", round(mass_kg));
    findings.warning(RULE, span, message, Some(help.to_owned()));
}

/// Checks what a linear axis moves by, and against which forces.
pub(super) fn forces(findings: &mut Findings<'_>, table: &AxisTable) {
    let moved = table.moved_mass_kg.as_ref();
    let Some(mass_kg) = moved.or(table.mass_kg.as_ref()).map(|mass| mass.value) else {
        return;
    };
    screw(findings, table, mass_kg);
    let share = moved.map_or(FRICTION_OF_ALL, |_| FRICTION);
    if let Some(force) = &table.coulomb_n
        && force.value > 0.0
        && force.value < share * G_M_S2 * mass_kg
    {
        let at = ("coulomb_n", force.span.clone());
        let value = format!("{} N is unusually small", round(force.value));
        let help = "kN, or a coefficient of friction, given? Guides take 0.2 to 2 % of the weight";
        doubt(findings, &at, &value, mass_kg, help);
    }
    if let Some(force) = &table.gravity_n
        && force.value.abs() > WEIGHTS * G_M_S2 * mass_kg
    {
        let at = ("gravity_n", force.span.clone());
        let value = format!("{} N is unusually large", round(force.value));
        let weight = round(G_M_S2 * mass_kg);
        let help = format!("mN, or grams, given? All of it weighs {weight} N");
        doubt(findings, &at, &value, mass_kg, &help);
    }
}

fn screw(findings: &mut Findings<'_>, table: &AxisTable, mass_kg: f64) {
    let Some(screw) = table.screw.as_ref().map(|screw| &screw.value) else {
        return;
    };
    let (Some(diameter), Some(length)) = (&screw.diameter_mm, &screw.length_mm) else {
        return;
    };
    let least = SCREW_DIAMETER_MM.max(SCREW_DIAMETER_MM_KG * mass_kg.sqrt());
    if diameter.value < least {
        let at = ("screw.diameter_mm", diameter.span.clone());
        let value = format!("{} mm is unusually small", round(diameter.value));
        doubt(findings, &at, &value, mass_kg, "centimetres given?");
    }
    if length.value < SCREW_MM || length.value < 2.0 * diameter.value {
        let message = format!(
            "`screw.length_mm`: {} mm is unusually small",
            round(length.value)
        );
        let help = Some("metres or centimetres given?".to_owned());
        findings.warning(RULE, &length.span, message, help);
    }
}

const ROTOR_HELP: &str = "kg·cm² given? 1 kg·cm² is 0.0001 kg·m²";

/// Checks the rotor; true where it explains whatever all of the axis weighs.
pub(super) fn rotor(findings: &mut Findings<'_>, kind: AxisKind, table: &AxisTable) -> bool {
    let Some(rotor) = &table.rotor_kg_m2 else {
        return false;
    };
    let moved = match kind {
        AxisKind::Linear => table.moved_mass_kg.as_ref(),
        AxisKind::Rotary => table.moved_inertia_kg_m2.as_ref(),
    };
    let parts = parts::list(kind, table);
    let weighs = parts.iter().find(|part| part.name == "rotor");
    let share = match (weighs, moved) {
        (Some(part), Some(moved)) => part.mass_kg / moved.value,
        _ => 0.0,
    };
    let heavy = kind == AxisKind::Linear && rotor.value > ROTOR_KG_M2;
    let odd = heavy || rotor.value > LIGHT_ROTOR_KG_M2 && share > ROTOR_SHARE;
    if odd {
        let value = round(rotor.value);
        let message = format!("`rotor_kg_m2`: {value} kg·m² is unusually large");
        findings.warning(RULE, &rotor.span, message, Some(ROTOR_HELP.to_owned()));
    }
    odd
}

/// The part that makes the sum as large as it is, where what is given as such does not.
pub(super) fn largest<'k>(kind: AxisKind, table: &AxisTable, given: &Given) -> Option<At<'k>> {
    let parts = parts::list(kind, table);
    let turning: f64 = parts.iter().map(|part| part.mass_kg).sum();
    let own = given.value - turning;
    let most = parts.iter().max_by(|a, b| a.mass_kg.total_cmp(&b.mass_kg));
    let most = most.filter(|part| part.mass_kg > own)?;
    let whole = |key, span: Option<Range<usize>>| span.map(|span| (key, span));
    match most.name {
        "rotor" => at("rotor_kg_m2", table.rotor_kg_m2.as_ref()),
        "screw" => whole("screw", table.screw.as_ref().map(|it| it.span.clone())),
        "pulley" => whole("pulley", table.pulley.as_ref().map(|it| it.span.clone())),
        _ => whole("pinion", table.pinion.as_ref().map(|it| it.span.clone())),
    }
}

/// Four digits: a converted value has many.
pub(super) fn round(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use crate::Machine;

    /// The warnings of an axis, each with what its caret shows.
    fn warnings(axis: &str) -> Vec<String> {
        let text = format!(
            "schema = 1\nname = \"t\"\ncontroller = \"iso\"\n[converter]\npeak_power_w = 40000\n{axis}"
        );
        let (_, found) = Machine::from_toml("t.toml", &text).unwrap();
        let shown = |it: &gwatt_syntax::diagnostic::Diagnostic| {
            let (from, to) = (it.span.start as usize, it.span.end as usize);
            let caret = String::from_utf8_lossy(it.text.get(from..to).unwrap_or_default());
            format!(
                "{caret}: {} / {}",
                it.message,
                it.help.as_deref().unwrap_or("")
            )
        };
        let found = found.iter().filter(|it| it.rule == "machine-unit");
        found.map(shown).collect()
    }

    fn of(fields: &str) -> Vec<String> {
        warnings(&format!(
            "[axes.X]\nrapid_mm_min = 30000\naccel_mm_s2 = 3000\nmoved_mass_kg = 300\n{fields}\n"
        ))
    }

    const SOUND: &str =
        "rotor_kg_m2 = 0.0012\nscrew = { diameter_mm = 32, length_mm = 1000, lead_mm = 10 }";

    #[test]
    fn parts_in_another_unit() {
        assert_eq!(of(SOUND), [""; 0]);
        assert_eq!(
            of("rotor_kg_m2 = 0.0012\nscrew = { diameter_mm = 3.2, length_mm = 1, lead_mm = 10 }"),
            [
                "3.2: `screw.diameter_mm`: 3.2 mm is unusually small for 300 kg / centimetres given?",
                "1: `screw.length_mm`: 1 mm is unusually small / metres or centimetres given?",
            ]
        );
        assert_eq!(
            of(&SOUND.replace("0.0012", "1.2")),
            [
                "1.2: `rotor_kg_m2`: 1.2 kg·m² is unusually large / kg·cm² given? 1 kg·cm² is 0.0001 kg·m²"
            ]
        );
        // 0.012 kg·m² at a screw of 0.2 mm: (2π/0.0002)² · 0.012 kg.
        let fine = SOUND
            .replace("0.0012", "0.012")
            .replace("lead_mm = 10", "lead_mm = 0.2");
        assert_eq!(
            of(&fine),
            [
                "0.012: `rotor_kg_m2`: 0.012 kg·m² is unusually large / kg·cm² given? 1 kg·cm² is 0.0001 kg·m²"
            ]
        );
        // A screw of 320 mm: the caret is where the sum comes from.
        let thick = SOUND.replace("diameter_mm = 32,", "diameter_mm = 320,");
        assert_eq!(of(&thick).len(), 1, "{:?}", of(&thick));
        assert!(
            of(&thick)[0].contains("`screw`: a mass of "),
            "{:?}",
            of(&thick)
        );
    }

    /// 300 kg weigh 2943 N.
    #[test]
    fn forces_in_another_unit() {
        let with = |more: &str| of(&format!("{SOUND}\n{more}"));
        assert_eq!(with("coulomb_n = 60\ngravity_n = 2943"), [""; 0]);
        assert_eq!(with("coulomb_n = 0\ngravity_n = -2943"), [""; 0]);
        assert_eq!(
            with("coulomb_n = 0.3"),
            [
                "0.3: `coulomb_n`: 0.3 N is unusually small for 300 kg / kN, or a coefficient of friction, given? Guides take 0.2 to 2 % of the weight"
            ]
        );
        assert!(
            with("gravity_n = 300000").contains(&"300000: `gravity_n`: 300000 N is unusually large for 300 kg / mN, or grams, given? All of it weighs 2943 N".to_owned())
        );
    }

    #[test]
    fn a_margin_of_what_may_be_used() {
        let margin = |value: &str| {
            warnings(&format!(
                "[axes.X]\nrapid_mm_min = 30000\naccel_mm_s2 = 3000\nmass_kg = 300\n[limits]\nmargin = {value}\n"
            ))
        };
        assert_eq!(margin("0.3"), [""; 0]);
        assert_eq!(
            margin("0.9"),
            [
                "0.9: `margin`: 0.9 leaves 10 % of the peak power to be used / the share that is kept free is meant: 10 % is 0.1"
            ]
        );
    }
}
