//! What is known of an axis before it is recorded for good.

use crate::choice::Choice;
use crate::error::{IdentifyError, Outcome};
use crate::flexible::{Flexible, identify};
use crate::judgement::{self, Judgement};
use crate::measured_noise::Noise;
use crate::recording::Recording;
use crate::state_space::{Measured, simulate};
use crate::transfer::{Factor, TransferFunction};

/// An axis as a first recording or a machine file shows it.
#[derive(Debug, Clone)]
pub struct Known {
    /// From force or torque, less friction, to acceleration.
    pub transfer: TransferFunction,
    /// The zeros and poles that are to be determined, with the relative standard error
    /// of each frequency as it is known now.
    pub roots: Vec<(Factor, f64)>,
    /// Viscous friction; 0 for none.
    pub viscous: f64,
    /// Coulomb friction; 0 for none.
    pub coulomb: f64,
    /// What is measured.
    pub(crate) measured: Measured,
    /// How the noise is coloured.
    pub(crate) noise: Noise,
    /// Standard deviation of the noise once it is white; where that is not known, none.
    pub(crate) noise_std: Option<f64>,
    /// Sampling period, s.
    pub period_s: f64,
    /// Torque and inertia, where a slide has force and mass.
    pub rotary: bool,
}

/// Noise that is counted where none was recorded, as a share of the acceleration that
/// the signal makes.
pub(crate) const NOISE_SHARE: f64 = 0.05;

impl Known {
    /// Of a first recording of force or torque and motion.
    ///
    /// # Errors
    ///
    /// A recording that cannot be used, or that no axis makes.
    pub fn of_recording(recording: &Recording, choice: &Choice) -> Outcome<Self> {
        let found = identify(recording, choice)?;
        let judged = judgement::flexible(&found);
        let is_wrong = matches!(
            judged,
            Judgement::DoesNotFit | Judgement::Reversed | Judgement::NegativeDamping
        );
        if is_wrong || found.inertia.is_none() {
            let verdict = if is_wrong {
                judged.to_string()
            } else {
                "it is one of a command".to_owned()
            };
            return Err(IdentifyError::new(
                format!("a signal cannot be designed by this recording: {verdict}"),
                "record force or torque and the motion of the axis, excited by `gwatt excite --amplitude …` alone",
            ));
        }
        Ok(Self::of(&found, recording))
    }

    fn of(found: &Flexible, recording: &Recording) -> Self {
        let roots = found.zeros.iter().chain(&found.poles).map(|root| {
            let factor = Factor::Pair {
                omega_rad_s: root.omega_rad_s.value,
                damping: root.damping.value,
            };
            let share = root.omega_rad_s.std / root.omega_rad_s.value;
            (factor, if share.is_finite() { share } else { 0.0 })
        });
        let value = |figure: Option<crate::figure::Figure>| {
            figure.map_or(0.0, |figure| figure.value.max(0.0))
        };
        Self {
            transfer: found.transfer.clone(),
            roots: roots.collect(),
            viscous: value(found.viscous),
            coulomb: value(found.coulomb),
            measured: found.measured,
            noise: found.noise.clone(),
            noise_std: Some(found.noise_std),
            period_s: recording.period_s,
            rotary: recording.is_rotary(),
        }
    }

    /// Of figures that are known from elsewhere; the acceleration is measured, with noise
    /// of a twentieth of it.
    #[must_use]
    pub fn of_figures(transfer: TransferFunction, friction: [f64; 2], period_s: f64) -> Self {
        let [viscous, coulomb] = friction;
        let factors = transfer.zeros.iter().chain(&transfer.poles);
        let oscillating = factors.filter(|factor| factor.oscillates());
        Self {
            roots: oscillating.map(|factor| (*factor, 0.0)).collect(),
            transfer,
            viscous,
            coulomb,
            measured: Measured::Direct,
            noise: Noise::default(),
            noise_std: None,
            period_s,
            rotary: false,
        }
    }

    /// Whether its noise was recorded.
    #[must_use]
    pub fn has_noise(&self) -> bool {
        self.noise_std.is_some()
    }

    /// The part of a force that accelerates: what the viscous friction of a rigid axis
    /// takes is taken off. With it the speed, as it is from sample to sample.
    pub(crate) fn driven(&self, force: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let per_step = self.period_s * self.transfer.gain;
        // Implicit: stable for any friction.
        let share = 1.0 / (1.0 + 0.5 * per_step * self.viscous);
        let mut speed = 0.0;
        let mean = force.iter().map(|force| {
            let mean = (speed + 0.5 * per_step * force) * share;
            speed = 2.0 * mean - speed;
            mean
        });
        let mean: Vec<f64> = mean.collect();
        let left = force.iter().zip(&mean);
        let left = left.map(|(force, speed)| force - self.viscous * speed);
        (left.collect(), mean)
    }

    /// How the axis goes under a force, from rest and without friction, so that it is
    /// no more in truth: the distance between its ends and the largest speed (m and m/s,
    /// or rad), and the acceleration.
    pub(crate) fn motion(&self, force: &[f64]) -> Option<(f64, f64, Vec<f64>)> {
        let accel = simulate(&self.transfer, Measured::Direct, self.period_s, force)?;
        let (half, fastest, _) = crate::excitation::reach(&accel, self.period_s, 1.0);
        Some((2.0 * half, fastest, accel))
    }
}
