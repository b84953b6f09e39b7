//! Coordinates that the program turns, scales, mirrors or gives as polar ones,
//! as Fanuc and Haas read it ("Coordinate System Rotation (G68, G69)",
//! "Scaling (G50, G51)", "Programmable Mirror Image (G50.1, G51.1)", "Polar
//! Coordinate Command (G15, G16)", "Local Coordinate System (G52)").
//!
//! Mirroring comes first, then scaling, then the turn; what depends on a
//! parameter of the control is refused.

mod words;

use super::frame::{Affine, SPACE};
use gwatt_machine::AxisValues;

/// Coordinates that differ by less are the same (mm, degrees).
const SAME_MM: f64 = 1e-9;

const NO_OFFSETS: &str = "without a parameter file all work offsets are taken as 0";

/// What the program has turned, scaled or mirrored.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Programmed {
    rotation: Option<Affine>,
    /// #CS of the ISG kernel, in which the others stand.
    system: Option<Affine>,
    scaling: Option<Affine>,
    mirror: [Option<f64>; SPACE],
    /// The coordinates that the control takes as the present ones.
    believed: AxisValues,
}

/// G16: the last radius and angle, and where they start from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Polar {
    center: [f64; 2],
    radius: f64,
    angle_deg: f64,
}

impl Programmed {
    fn mirrored(&self) -> bool {
        self.mirror.iter().any(Option::is_some)
    }

    fn affine(&self) -> Affine {
        let center = self.mirror.map(Option::unwrap_or_default);
        let factor = self.mirror.map(|at| if at.is_some() { -1.0 } else { 1.0 });
        let mut map = Affine::scaling(center, factor);
        for next in [&self.scaling, &self.rotation, &self.system]
            .into_iter()
            .flatten()
        {
            map = map.then(next);
        }
        map
    }
}
