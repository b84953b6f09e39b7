//! Parts of an axis, as machine files give them.

use std::f64::consts::PI;

use schemars::JsonSchema;
use serde::Deserialize;

use super::value::{AtLeastOne, NotNegative, Positive};
use crate::units::M_PER_MM;

/// Steel, kg/m³.
const STEEL_KG_M3: f64 = 7850.0;

/// A screw, as a solid cylinder of steel.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(clippy::struct_field_names, reason = "units end the names of files")]
pub(crate) struct ScrewTable {
    /// Its diameter in mm.
    #[schemars(required)]
    pub(crate) diameter_mm: Option<Positive>,
    /// Its length in mm, ends included.
    #[schemars(required)]
    pub(crate) length_mm: Option<Positive>,
    /// Travel per revolution in mm; here or as `lead_mm` of the axis.
    pub(crate) lead_mm: Option<Positive>,
}

/// A toothed pulley or a pinion: its pitch circle drives the axis.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct WheelTable {
    /// Diameter of the pitch circle in mm; or `teeth` and `pitch_mm`.
    pub(crate) diameter_mm: Option<Positive>,
    /// Number of teeth.
    pub(crate) teeth: Option<AtLeastOne>,
    /// From tooth to tooth in mm: of the belt, or π times the module of a rack.
    pub(crate) pitch_mm: Option<Positive>,
    /// Its width in mm, as a solid cylinder of steel; or `inertia_kg_m2`.
    pub(crate) width_mm: Option<Positive>,
    /// Its inertia in kg·m², of each one.
    pub(crate) inertia_kg_m2: Option<NotNegative>,
    /// How many of them turn with the axis; default 2 pulleys (that of the motor and the
    /// idler), 1 pinion.
    pub(crate) count: Option<AtLeastOne>,
}

impl WheelTable {
    /// Diameter of the pitch circle in mm.
    pub(crate) fn diameter_mm(&self) -> Option<f64> {
        let by_teeth = || Some(self.teeth.as_ref()?.value * self.pitch_mm.as_ref()?.value / PI);
        let given = self.diameter_mm.as_ref().map(|it| it.value);
        given.or_else(by_teeth)
    }

    /// Inertia of one, kg·m².
    pub(crate) fn inertia_kg_m2(&self) -> Option<f64> {
        let cylinder = || Some(cylinder(self.diameter_mm()?, self.width_mm.as_ref()?.value));
        let given = self.inertia_kg_m2.as_ref().map(|it| it.value);
        given.or_else(cylinder)
    }
}

/// Inertia of a solid cylinder of steel, kg·m².
pub(crate) fn cylinder(diameter_mm: f64, length_mm: f64) -> f64 {
    let (d, l) = (diameter_mm * M_PER_MM, length_mm * M_PER_MM);
    PI / 32.0 * STEEL_KG_M3 * l * d * d * d * d
}
