//! What turning cycles keep from block to block, and a cycle about a contour that is still to
//! be read.

/// What turning cycles keep from block to block.
#[derive(Debug, Default)]
pub(crate) struct Turning {
    /// A contour is read for G71, G72 or G73, which do without the compensation
    /// of the tool nose radius.
    pub(crate) reads_rough: bool,
    /// End point and taper of the single cycle in force, machine coordinates.
    pub(super) held: Held,
    /// Depth of cut and escape of G71 and G72, mm.
    pub(super) depth: Option<f64>,
    pub(super) escape: Option<f64>,
    /// G73: total relief in X and Z, mm, and the number of divisions.
    pub(super) relief: Option<([f64; 2], u64)>,
    /// Return of G74 and G75, mm.
    pub(super) back: Option<f64>,
    pub(super) finish: Finish,
    pub(super) hole: Hole,
}

#[derive(Debug, Default, Clone, Copy)]
pub(super) struct Held {
    pub(super) x: Option<f64>,
    pub(super) z: Option<f64>,
    pub(super) taper: f64,
}

/// What a drilling cycle keeps.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Hole {
    /// Machine coordinate of the bottom, and of the place where it began.
    pub(super) bottom: Option<f64>,
    pub(super) begin: f64,
    /// Distance to the level R, with its sign.
    pub(super) level: f64,
    pub(super) peck: Option<f64>,
    pub(super) dwell_s: f64,
}

/// What the first block of G76 says.
#[derive(Debug, Clone, Copy)]
pub(super) struct Finish {
    pub(super) repeats: u32,
    /// Length of the chamfer, in leads.
    pub(super) chamfer: f64,
    pub(super) angle_deg: f64,
    /// Smallest depth of a pass and what is left for the last ones, mm.
    pub(super) least_mm: f64,
    pub(super) last_mm: f64,
    pub(super) given: bool,
}

impl Default for Finish {
    fn default() -> Self {
        Self {
            repeats: 1,
            chamfer: 0.0,
            angle_deg: 0.0,
            least_mm: 0.0,
            last_mm: 0.0,
            given: false,
        }
    }
}

/// A cycle about a contour that is still to be read.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Contour {
    /// Numbers of its first and last block.
    pub(crate) first: u64,
    pub(crate) last: u64,
    pub(crate) cycle: ContourCycle,
    /// What is left for finishing in X (of the radius) and Z, mm.
    pub(super) allowance: [f64; 2],
    /// Its first block names X and Z: stock removal of type II.
    pub(crate) two_axes: bool,
    /// First and last line, from 1, as soon as it has been read.
    pub(crate) lines: Option<[u64; 2]>,
}

/// The cycles.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum ContourCycle {
    /// G70.
    Finish,
    /// G71 (deep along X) and G72 (deep along Z).
    Rough {
        deep: usize,
        depth_mm: f64,
        escape_mm: f64,
    },
    /// G73: relief in X and Z, and how many times.
    Pattern { relief_mm: [f64; 2], times: u64 },
}
