//! A plain word on what was identified.

use std::fmt;

use super::flexible::{Flexible, Root};
use super::rigid::{Figure, Rigid};

/// A plain word.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Judgement {
    /// The figures can be used.
    Good,
    /// They are uncertain; so many times the length would do.
    ExciteLonger {
        /// Times the length of this recording.
        times: f64,
    },
    /// Frequencies are known, dampings are not.
    TooNoisyForDamping,
    /// The axis resonates: the rigid model holds for slow motion only.
    NotRigid,
    /// The model does not explain the recording.
    DoesNotFit,
}

impl Judgement {
    /// The word.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Good => "good",
            Self::ExciteLonger { .. } => "excite longer",
            Self::TooNoisyForDamping => "too noisy for damping",
            Self::NotRigid => "not rigid",
            Self::DoesNotFit => "the model does not fit",
        }
    }
}

impl fmt::Display for Judgement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::ExciteLonger { times } => write!(
                f,
                "excite longer: about {times:.0} times as long, or with more amplitude"
            ),
            Self::NotRigid => f.write_str(
                "not rigid: it resonates within the band; take --model flexible, or a --bandwidth-hz well below",
            ),
            other => f.write_str(other.word()),
        }
    }
}

/// Relative standard errors from which on a figure is no good.
const MASS: f64 = 0.02;
const FRICTION: f64 = 0.1;
const FREQUENCY: f64 = 0.01;
const DAMPING: f64 = 0.1;
/// More than this many times the length nobody records.
const TIMES_MAX: f64 = 30.0;
/// What a model leaves unexplained, at most.
const REL_ERROR: f64 = 0.5;

fn excess(figure: Figure, limit: f64) -> f64 {
    let share = figure.std / figure.value.abs().max(f64::MIN_POSITIVE) / limit;
    if share.is_nan() { 0.0 } else { share * share }
}

fn longer(times: f64) -> Judgement {
    if times <= 1.0 {
        Judgement::Good
    } else {
        Judgement::ExciteLonger {
            times: libm::ceil(times).min(1000.0),
        }
    }
}

/// Judges a rigid axis. Friction counts against the larger of its parts.
#[must_use]
pub fn rigid(axis: &Rigid) -> Judgement {
    if axis.mass.value > 0.0 && axis.resonates {
        return Judgement::NotRigid;
    }
    if axis.mass.value <= 0.0 || axis.rel_error > REL_ERROR {
        return Judgement::DoesNotFit;
    }
    let mut times = excess(axis.mass, MASS);
    if let Some(coulomb) = axis.coulomb {
        // Friction near zero is known well enough when it is known as small.
        let small = axis.viscous.map_or(0.0, |v| v.std.min(v.value.abs()));
        if coulomb.value.abs() > small {
            times = times.max(excess(coulomb, FRICTION).min(TIMES_MAX));
        }
    }
    longer(times)
}

/// Judges a flexible axis.
#[must_use]
pub fn flexible(axis: &Flexible) -> Judgement {
    if axis.rel_error > 0.9 || axis.inertia.is_some_and(|j| j.value <= 0.0) {
        return Judgement::DoesNotFit;
    }
    let zeros = || axis.zeros.iter().chain(&axis.unclear_zeros);
    let roots = || zeros().chain(&axis.poles);
    let worst = |part: fn(&Root) -> Figure, limit: f64| {
        roots()
            .map(|root| excess(part(root), limit))
            .fold(0.0, f64::max)
    };
    let inertia = axis.inertia.map_or(0.0, |j| excess(j, MASS));
    let frequency = worst(|root| root.omega_rad_s, FREQUENCY).max(inertia);
    let damping = worst(|root| root.damping, DAMPING);
    if damping > TIMES_MAX && frequency <= 1.0 {
        return Judgement::TooNoisyForDamping;
    }
    longer(damping.max(frequency))
}
