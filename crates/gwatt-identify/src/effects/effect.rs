//! What was found, with its figures.

use super::super::figure::Figure;

/// A force that a rigid axis with friction has not.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Effect {
    /// Periodic in position: of magnets and slots, or of a screw.
    Cogging {
        /// Period, m (rad where the axis turns).
        period: Figure,
        /// Amplitude, N (N·m); the root of the mean square over several recordings.
        amplitude: Figure,
        /// Norm of this force by norm of the whole force.
        share: f64,
    },
    /// Missing after each reversal, until the motion has gone through the play.
    Backlash {
        /// Width of the play, m (rad).
        width: Figure,
        /// Mass of the load that is not moved within it, kg (kg·m²).
        mass: Figure,
        /// Norm of this force by norm of the whole force.
        share: f64,
    },
    /// Friction that falls as the axis begins to move: `rise·exp(−(v/speed)²)` on top of
    /// Coulomb friction (Stribeck 1902; Armstrong-Hélouvry et al. 1994).
    Stribeck {
        /// By how much breakaway is above Coulomb friction, N (N·m).
        rise: Figure,
        /// Speed at which a factor of e is left of that, m/s (rad/s).
        speed: Figure,
        /// Norm of this force by norm of the whole force.
        share: f64,
    },
}

impl Effect {
    /// Norm of its force by norm of the whole force.
    #[must_use]
    pub fn share(&self) -> f64 {
        match self {
            Self::Cogging { share, .. }
            | Self::Backlash { share, .. }
            | Self::Stribeck { share, .. } => *share,
        }
    }
}

/// A force that does not pass a value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Saturation {
    /// The recorded force stands there, and the motion agrees: the drive gives no more.
    Drive {
        /// The value, N (N·m).
        limit: f64,
        /// Share of the samples that stand there.
        share: f64,
    },
    /// The recorded force stands there, and the motion shows more: the recording is cut off.
    Recording {
        /// The value, N (N·m).
        limit: f64,
        /// Share of the samples that stand there.
        share: f64,
    },
    /// The recorded force goes on, and the motion does not: the drive gives less than what
    /// was recorded.
    Beyond {
        /// The value, N (N·m).
        limit: f64,
        /// Share of the samples that are above.
        share: f64,
    },
}
