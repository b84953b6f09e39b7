//! Work offsets in the machine file.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::Deserialize;

use super::findings::Findings;
use super::value::{At, Number, PerAxis};
use crate::axis::{AXES, AxisSet, AxisValues};
use crate::controller::Controller;

/// Work offsets: the machine coordinates of each system's zero, in mm or degrees; 0 for
/// axes that are not named.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct OffsetsTable {
    /// Of G54.
    #[serde(rename = "G54")]
    g54: Option<PerAxis<Number>>,
    /// Of G55.
    #[serde(rename = "G55")]
    g55: Option<PerAxis<Number>>,
    /// Of G56.
    #[serde(rename = "G56")]
    g56: Option<PerAxis<Number>>,
    /// Of G57.
    #[serde(rename = "G57")]
    g57: Option<PerAxis<Number>>,
    /// Of G58.
    #[serde(rename = "G58")]
    g58: Option<PerAxis<Number>>,
    /// Of G59.
    #[serde(rename = "G59")]
    g59: Option<PerAxis<Number>>,
    /// Of G59.1.
    #[serde(rename = "G59.1")]
    g59_1: Option<PerAxis<Number>>,
    /// Of G59.2.
    #[serde(rename = "G59.2")]
    g59_2: Option<PerAxis<Number>>,
    /// Of G59.3.
    #[serde(rename = "G59.3")]
    g59_3: Option<PerAxis<Number>>,
    /// Of further systems (G54.1 P1), by `P1` to `P300`.
    #[serde(rename = "G54.1")]
    g54_1: Option<At<BTreeMap<String, PerAxis<Number>>>>,
    /// The same on Haas (G154 P1).
    #[serde(rename = "G154")]
    g154: Option<At<BTreeMap<String, PerAxis<Number>>>>,
    /// Where G28 leads, on controls that keep this point among their parameters (grbl's `$#`,
    /// `LinuxCNC`'s #5161), in machine coordinates; not known for axes that are not named.
    #[serde(rename = "G28")]
    g28: Option<At<PerAxis<Number>>>,
    /// The same of G30.
    #[serde(rename = "G30")]
    g30: Option<At<PerAxis<Number>>>,
}

impl OffsetsTable {
    /// By the number of the system, from 1.
    fn systems(&self) -> [Option<&PerAxis<Number>>; 9] {
        [
            &self.g54,
            &self.g55,
            &self.g56,
            &self.g57,
            &self.g58,
            &self.g59,
            &self.g59_1,
            &self.g59_2,
            &self.g59_3,
        ]
        .map(Option::as_ref)
    }
}

/// What the table gives.
#[derive(Debug, Default)]
pub(crate) struct Places {
    /// Machine coordinates of the zeros of G54 to G59.3.
    pub(crate) offsets: [Option<AxisValues>; 9],
    /// The same of further systems, by their P.
    pub(crate) further_offsets: BTreeMap<u16, AxisValues>,
    /// Where G28 and G30 lead, by axis.
    pub(crate) points: [[Option<f64>; AXES]; 2],
}

/// What the table gives, if there is one.
pub(crate) fn all(
    findings: &mut Findings<'_>,
    table: Option<&OffsetsTable>,
    axes: AxisSet,
    controller: &Controller,
) -> Places {
    table.map_or_else(Places::default, |table| Places {
        offsets: table
            .systems()
            .map(|system| Some(origin(findings, system?, axes))),
        further_offsets: further(findings, table, axes),
        points: points(findings, table, axes, controller),
    })
}

/// The zero of a system.
fn origin(findings: &mut Findings<'_>, system: &PerAxis<Number>, axes: AxisSet) -> AxisValues {
    let mut origin = [0.0; AXES];
    for (axis, number) in system.iter() {
        if !axes.contains(axis as usize) {
            let message = format!("the machine has no axis {}", axis.letter() as char);
            findings.error("machine-offsets", &number.span, message, None);
        }
        origin[axis as usize] = number.value;
    }
    origin
}

/// Most further systems.
const FURTHER_MAX: u16 = 300;

/// Zeros of further systems, by their P.
fn further(
    findings: &mut Findings<'_>,
    table: &OffsetsTable,
    axes: AxisSet,
) -> BTreeMap<u16, AxisValues> {
    let mut all = BTreeMap::new();
    let tables = [&table.g54_1, &table.g154].into_iter().flatten();
    let systems = tables.flat_map(|table| {
        let systems = table.value.iter();
        systems.map(|(name, system)| (name, system, &table.span))
    });
    for (name, system, span) in systems {
        let digits = name.strip_prefix('P').unwrap_or_default();
        let number = digits.parse().ok();
        let number = number.filter(|number| (1..=FURTHER_MAX).contains(number));
        let origin = origin(findings, system, axes);
        if number.is_none_or(|number| all.insert(number, origin).is_some()) {
            let message =
                format!("`{name}` is no number of a further work offset, or is given twice");
            let help = format!("write P1 to P{FURTHER_MAX}: \"G54.1\" = {{ P1 = {{ X = -450 }} }}");
            findings.error("machine-offsets", span, message, Some(help));
        }
    }
    all
}

/// Where G28 and G30 lead, by axis, on controls that keep these points among their parameters.
fn points(
    findings: &mut Findings<'_>,
    table: &OffsetsTable,
    axes: AxisSet,
    controller: &Controller,
) -> [[Option<f64>; AXES]; 2] {
    [&table.g28, &table.g30].map(|point| {
        let mut places = [None; AXES];
        let Some(point) = point else { return places };
        if !controller.language.family.facts().reference_in_parameters {
            let message = "this control has its reference points in the tables of the axes";
            let help = "give reference_mm, and further_reference_mm for those after the first";
            findings.error(
                "machine-offsets",
                &point.span,
                message,
                Some(help.to_owned()),
            );
        }
        for (axis, number) in point.value.iter() {
            if !axes.contains(axis as usize) {
                let message = format!("the machine has no axis {}", axis.letter() as char);
                findings.error("machine-offsets", &number.span, message, None);
            }
            places[axis as usize] = Some(number.value);
        }
        places
    })
}
