//! Converter tables, and which axes each feeds.

use super::findings::Findings;
use super::machine_file::ConverterTable;
use super::value::{At, OneOrMany};
use super::{plausible, ratings};
use crate::axis::{ALL_AXES, AxisSet};
use crate::model::Converter;

/// Makes the converters of their tables; the margin is needed to see
/// whether anything is left for motion.
pub(crate) fn converters(
    findings: &mut Findings<'_>,
    tables: &OneOrMany<ConverterTable>,
    machine_axes: AxisSet,
    margin: f64,
) -> Vec<Converter> {
    let several = tables.0.len() > 1;
    let mut fed = AxisSet::default();
    let mut list: Vec<Converter> = Vec::new();
    for table in &tables.0 {
        power(findings, &table.value, margin);
        plausible::converter(findings, &table.value);
        let name = name(findings, table, several, &list);
        let axes = axes(findings, table, several, machine_axes, &mut fed);
        list.push(Converter {
            name,
            axes,
            peak_power_w: table
                .value
                .peak_power_w
                .as_ref()
                .map_or(0.0, |peak| peak.value),
            regen_power_w: table.value.regen_power_w.as_ref().map(|regen| regen.value),
            base_load_w: table
                .value
                .base_load_w
                .as_ref()
                .map_or(0.0, |load| load.value),
            credit_regen: table.value.credit_regen.unwrap_or(false),
            ratings: ratings::of(findings, table),
        });
    }
    let forgotten: Vec<String> = machine_axes
        .iter()
        .filter(|&axis| !fed.contains(axis))
        .map(|axis| (ALL_AXES[axis].letter() as char).to_string())
        .collect();
    if let Some(last) = tables.0.last().filter(|_| !forgotten.is_empty())
        && !findings.refused_in("converter")
        && !tables
            .0
            .iter()
            .any(|table| several && table.value.axes.is_none())
    {
        let message = format!("no converter feeds {}", forgotten.join(", "));
        let help = Some("every axis needs a converter".to_owned());
        let span = last
            .value
            .axes
            .as_ref()
            .map_or(&last.span, |axes| &axes.span);
        findings.error("machine-converter", span, message, help);
    }
    list
}

fn name(
    findings: &mut Findings<'_>,
    table: &At<ConverterTable>,
    several: bool,
    before: &[Converter],
) -> String {
    let Some(name) = &table.value.name else {
        if several {
            let message = "each of several converters needs a `name`";
            findings.error("machine-missing", &table.span, message, None);
        }
        return String::new();
    };
    if before.iter().any(|other| other.name == name.value) {
        let message = format!("two converters are named \"{}\"", name.value);
        findings.error("machine-converter", &name.span, message, None);
    }
    name.value.clone()
}

fn axes(
    findings: &mut Findings<'_>,
    table: &At<ConverterTable>,
    several: bool,
    machine_axes: AxisSet,
    fed: &mut AxisSet,
) -> AxisSet {
    let Some(letters) = &table.value.axes else {
        if several {
            let message = "each of several converters needs `axes`";
            findings.error("machine-missing", &table.span, message, None);
            return AxisSet::default();
        }
        *fed = machine_axes;
        return machine_axes;
    };
    let mut axes = AxisSet::default();
    for letter in &letters.value {
        let axis = letter.value.axis();
        let name = axis.letter() as char;
        if !machine_axes.contains(axis as usize) {
            let message = format!("the machine has no axis {name}");
            findings.error("machine-converter", &letter.span, message, None);
        } else if fed.contains(axis as usize) {
            let message = format!("axis {name} is already fed");
            let help = Some("name each axis once, at one converter".to_owned());
            findings.error("machine-converter", &letter.span, message, help);
        }
        axes.insert(axis as usize);
        fed.insert(axis as usize);
    }
    axes
}

/// Powers that contradict each other.
fn power(findings: &mut Findings<'_>, table: &ConverterTable, margin: f64) {
    let Some(peak) = table.peak_power_w.as_ref().filter(|peak| peak.value > 0.0) else {
        return;
    };
    if let Some(base) = &table.base_load_w
        && base.value >= (1.0 - margin) * peak.value
    {
        let message = format!(
            "`base_load_w` leaves nothing of {} W for motion",
            peak.value
        );
        let help = Some(format!(
            "the limit is (1 − margin)·peak_power_w, margin {margin}"
        ));
        findings.error("machine-converter", &base.span, message, help);
    }
    if let Some(continuous) = &table.continuous_power_w
        && continuous.value > peak.value
    {
        let message = "`continuous_power_w` is above `peak_power_w`";
        findings.error("machine-converter", &continuous.span, message, None);
    }
    if let (Some(window), None) = (&table.window_s, &table.continuous_power_w) {
        let message = "`window_s` without `continuous_power_w`";
        findings.error("machine-converter", &window.span, message, None);
    }
    for overload in table.overload.iter().flatten() {
        let entry = &overload.value;
        if let (Some(seconds), Some(every)) = (&entry.seconds, &entry.every_s)
            && every.value < seconds.value
        {
            let message = "`every_s` is shorter than `seconds`";
            findings.error("machine-converter", &every.span, message, None);
        }
        if let Some(power) = entry
            .power_w
            .as_ref()
            .filter(|power| power.value > peak.value)
        {
            let message = "an overload above `peak_power_w` is never used";
            findings.warning("machine-converter", &power.span, message, None);
        }
    }
}
