//! Work offsets in the machine file.

use schemars::JsonSchema;
use serde::Deserialize;

use super::findings::Findings;
use super::value::{Number, PerAxis};
use crate::axis::{AXES, AxisSet, AxisValues};

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

/// Work offsets by the number of the system.
pub(crate) fn offsets(
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
