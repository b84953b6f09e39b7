//! Work offsets in the machine file.

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

/// Machine coordinates of each system's zero; where G28 and G30 lead, by axis.
type Places = ([Option<AxisValues>; 9], [[Option<f64>; AXES]; 2]);

/// What the table gives, if there is one.
pub(crate) fn all(
    findings: &mut Findings<'_>,
    table: Option<&OffsetsTable>,
    axes: AxisSet,
    controller: &Controller,
) -> Places {
    table.map_or(([None; 9], [[None; AXES]; 2]), |table| {
        (
            offsets(findings, table, axes),
            points(findings, table, axes, controller),
        )
    })
}

/// Work offsets by the number of the system.
fn offsets(
    findings: &mut Findings<'_>,
    table: &OffsetsTable,
    axes: AxisSet,
) -> [Option<AxisValues>; 9] {
    table.systems().map(|system| {
        let mut origin = [0.0; AXES];
        for (axis, number) in system?.iter() {
            if !axes.contains(axis as usize) {
                let message = format!("the machine has no axis {}", axis.letter() as char);
                findings.error("machine-offsets", &number.span, message, None);
            }
            origin[axis as usize] = number.value;
        }
        Some(origin)
    })
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
