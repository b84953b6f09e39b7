//! What a summary says of limiting besides figures and lines.

use super::Allowed;

/// How long a program takes with an ideal word for acceleration.
#[derive(Debug, Clone, PartialEq)]
pub struct Ideal {
    /// With the best pair of speed and acceleration in each block, s.
    pub duration_s: f64,
    /// The same with long blocks in pieces, each with its acceleration, where that is sooner
    /// and the control's planner runs pieces on into each other, s.
    pub in_pieces_s: Option<f64>,
    /// What would give the control such a word, where its profile knows: options, and
    /// settings of the machine file.
    pub settings: Vec<String>,
}

/// A dwell that the original does not have.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pause {
    /// The line before which the program waits, from 1.
    pub line: u64,
    /// How long, s.
    pub seconds: f64,
}

/// What it takes to make a program fit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Price {
    /// What has to be allowed, with what is allowed already.
    pub allowed: Allowed,
    /// How long the program takes as it came, and as it would be written, s.
    pub duration_s: [f64; 2],
}
