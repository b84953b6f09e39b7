//! The forces of effects sample by sample, up to their factors.

use std::f64::consts::TAU;

use super::super::equations::{Raw, sign};
use super::play::Play;

/// A force up to its factors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shape {
    /// Sine and cosine of the position.
    Cogging {
        /// Periods per m (rad).
        per_unit: f64,
    },
    /// Inertia of the load within the play, and its friction, if it has any.
    Backlash(Play),
    /// Friction that falls with the speed.
    Stribeck {
        /// Speed at which a factor of e is left, m/s (rad/s).
        speed: f64,
    },
}

impl Shape {
    /// Its unknowns for one recording.
    pub fn width(self) -> usize {
        match self {
            Self::Cogging { .. } => 2,
            Self::Backlash(play) => {
                if play.is_braked() {
                    2
                } else {
                    1
                }
            }
            Self::Stribeck { .. } => 1,
        }
    }

    /// The same with another size: so many times the period, play or speed.
    pub fn resized(self, times: f64) -> Self {
        match self {
            Self::Cogging { per_unit } => Self::Cogging {
                per_unit: per_unit / times,
            },
            Self::Backlash(play) => Self::Backlash(Play {
                width: play.width * times,
                ..play
            }),
            Self::Stribeck { speed } => Self::Stribeck {
                speed: speed * times,
            },
        }
    }

    /// By how much sizes may be changed at a time without becoming others, and how much is
    /// little; as shares, in a motion of this range, m (rad).
    pub fn steps(self, range: f64) -> [f64; 2] {
        match self {
            Self::Cogging { per_unit } => [0.5, 0.01].map(|lines| lines / (range * per_unit)),
            // What a play does changes by leaps: it is not moved.
            Self::Backlash(_) => [0.0, 0.05],
            Self::Stribeck { .. } => [0.3, 0.01],
        }
    }

    /// Whether its factors are other ones in each recording: positions count from anywhere.
    pub fn is_apart(self) -> bool {
        matches!(self, Self::Cogging { .. })
    }

    /// The column of one of its unknowns: of a long recording all of them are many megabytes.
    /// `None` where speed or position is not known.
    pub fn column(self, raw: &Raw, unknown: usize) -> Option<Vec<f64>> {
        let (position, velocity) = (raw.position.as_ref()?, raw.velocity.as_ref()?);
        match self {
            Self::Cogging { per_unit } => {
                let wave = if unknown == 0 { libm::sin } else { libm::cos };
                let values = position.iter().map(|x| wave(TAU * per_unit * x));
                Some(values.collect())
            }
            Self::Backlash(play) if unknown == 0 => play.accelerations(raw),
            Self::Backlash(play) => play.rubbing(raw),
            Self::Stribeck { speed } => {
                let fall = |v: &f64| sign(*v) * libm::exp(-(v / speed) * (v / speed));
                Some(velocity.iter().map(fall).collect())
            }
        }
    }
}
