//! What is known of a move once it is judged.

use super::demand::Demand;
use super::spindle_share::SpindleShare;

/// Which bound a figure rests on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Certificate {
    /// The planner that the controller profile models.
    Planned,
    /// Any look-ahead, blending and filtering that keeps each axis inside its
    /// own limits.
    Robust,
}

impl Certificate {
    /// The name in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Planned => "planned",
            Self::Robust => "robust",
        }
    }
}

/// Load ratios of a move that is planned with others, by their cause.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Loads {
    /// Of the plan itself.
    pub own: f64,
    /// Of the steps of speed at joints.
    pub steps: f64,
}

impl Loads {
    /// Nothing known.
    pub(super) const NONE: Self = Self {
        own: 0.0,
        steps: 0.0,
    };
}

/// What is known of a move once it is judged.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Assessment {
    /// Duration from rest to rest in s; 0 where the start is not known.
    pub duration_s: f64,
    /// Path speed that feed and axes permit at 100 % override, mm/s.
    pub speed_mm_s: f64,
    /// Path acceleration, mm/s²; of moves that are planned together perhaps 0
    /// where it is not wanted.
    pub accel_mm_s2: f64,
    /// Path speed reached at the largest override, mm/s.
    pub top_speed_mm_s: f64,
    /// Path speeds with which it begins and ends there, squared, mm²/s²; infinite where
    /// they are not known.
    pub ends2: [f64; 2],
    /// Duration at the largest overrides in s.
    pub fastest_s: f64,
    /// Peaks at the largest overrides, and the energy at 100 %.
    pub demand: Demand,
    /// The part of the load ratio that the plan asks for by itself, and that of the
    /// steps of speed at its joints, where any matter; 0 where not known.
    pub loads: Loads,
    /// Which certificate the peaks belong to.
    pub certificate: Certificate,
    /// The move may run into or out of a neighbour without a stop: its peaks
    /// depend on both.
    pub blended: bool,
    /// The controller may run into it from its predecessor without a stop; a
    /// move of no length is passed on the way to the next.
    pub joined: bool,
    /// It is planned together with its neighbours.
    pub ahead: bool,
    /// What the spindle takes meanwhile.
    pub spindle: SpindleShare,
}

impl Assessment {
    /// Takes in the next part of the same move: its time, and the larger peaks.
    pub fn add(&mut self, next: &Self) {
        self.duration_s += next.duration_s;
        self.fastest_s += next.fastest_s;
        self.top_speed_mm_s = self.top_speed_mm_s.max(next.top_speed_mm_s);
        let energy_j = self.demand.energy_j + next.demand.energy_j;
        self.demand.include(&next.demand);
        self.demand.energy_j = energy_j;
        self.certificate = self.certificate.max(next.certificate);
        self.ends2 = [self.ends2[0], next.ends2[1]];
    }

    /// Nothing known yet of a move that is planned with others.
    pub(super) const AHEAD: Self = Self {
        duration_s: 0.0,
        speed_mm_s: 0.0,
        accel_mm_s2: 0.0,
        top_speed_mm_s: 0.0,
        ends2: [f64::INFINITY; 2],
        fastest_s: 0.0,
        demand: Demand::NONE,
        loads: Loads::NONE,
        certificate: Certificate::Planned,
        blended: true,
        joined: false,
        ahead: true,
        spindle: SpindleShare::NONE,
    };
}
