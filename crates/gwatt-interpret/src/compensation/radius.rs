//! Which radius G41 and G42 take: by a tool's number (LinuxCNC), by the number
//! of an offset (Fanuc: D, on lathes the last two digits of T), by the tool and
//! its edge (SINUMERIK: T and D).

mod words;

use super::corner::Circle;

/// What is in force for the compensation that comes next.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Choice {
    /// D: the number of an offset, of SINUMERIK that of an edge.
    pub(crate) number: Option<u32>,
    /// The radius, mm, where the program itself has set it.
    pub(crate) radius_mm: Option<f64>,
    /// G451: outside corners end where the shifted lines meet.
    pub(crate) intersects: bool,
    pub(crate) feed: ContourFeed,
    /// The plane is mirrored.
    pub(crate) flipped: bool,
    /// Why nothing can be shifted.
    pub(crate) refused: Option<&'static str>,
}

/// What F is the speed of where the path is an arc (SINUMERIK, "Feedrate
/// optimization for curved path sections (CFTCP, CFC, CFIN)").
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum ContourFeed {
    /// The tool's centre.
    #[default]
    Center,
    /// The edge, at the contour.
    Contour,
    /// The edge where the tool is inside of the arc, else the centre.
    Inside,
}

impl ContourFeed {
    /// The centre's speed over F on a shifted arc of the programmed radius.
    pub(super) fn factor(self, shifted: &Circle, radius_mm: f64) -> f64 {
        let ratio = shifted.radius / radius_mm;
        match self {
            _ if !ratio.is_finite() => 1.0,
            Self::Center => 1.0,
            Self::Contour => ratio,
            Self::Inside => ratio.min(1.0),
        }
    }
}
