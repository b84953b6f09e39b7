//! A plain word on what was identified.

use std::f64::consts::TAU;
use std::fmt;

use super::certainty;
use super::effects::{Effect, Saturation};
use super::figure::Figure;
use super::flexible::{Flexible, Root};
use super::power_fit::PowerModel;
use super::rigid::Rigid;
use super::slow_motion::SLOW_HZ;

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
    /// The model explains the recording with a negative mass: force and motion are
    /// counted in opposite directions.
    Reversed,
    /// A damping or a viscous friction comes out clearly negative.
    NegativeDamping,
    /// A force that is periodic in position is a fair part of the whole.
    Cogging,
    /// Force is missing after each reversal.
    Backlash,
    /// Friction falls with the speed, by a fair part of the force.
    Stribeck,
    /// The force that moves the axis ends at a value, and the recorded one is another.
    Saturated,
    /// The mass is another one in a part of the recordings.
    Changed {
        /// By which share of the mass.
        by: f64,
    },
    /// Force and motion belong to different times.
    OutOfStep {
        /// By how much later than recorded the force acts, s.
        late_s: f64,
    },
    /// What is left is more than noise, and too much of the whole.
    MoreThanNoise,
    /// The method gives no standard errors.
    NoErrors,
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
            Self::Reversed => "reversed",
            Self::NegativeDamping => "negative damping",
            Self::Cogging => "cogging",
            Self::Backlash => "backlash",
            Self::Stribeck => "Stribeck friction",
            Self::Saturated => "saturated",
            Self::Changed { .. } => "changed meanwhile",
            Self::OutOfStep { .. } => "out of step",
            Self::MoreThanNoise => "more than noise is left",
            Self::NoErrors => "no standard errors",
            Self::DoesNotFit => "the model does not fit",
        }
    }
}

impl fmt::Display for Judgement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::ExciteLonger { times } if *times > TIMES_MAX => f.write_str(
                "excite longer: no practical length is enough; excite with more amplitude, or with more power where the axis resonates",
            ),
            Self::ExciteLonger { times } => write!(
                f,
                "excite longer: about {times:.0} times as long, or with more amplitude"
            ),
            Self::NotRigid => f.write_str(
                "not rigid: it resonates within the band; take --model flexible, or a --bandwidth-hz well below",
            ),
            Self::Reversed => f.write_str(
                "reversed: force and motion are counted in opposite directions; give --reverse if all else is right",
            ),
            Self::NegativeDamping => f.write_str(
                "negative damping: no axis has it; the model stands for something else, such as friction, backlash or another mode",
            ),
            Self::Cogging => f.write_str(
                "cogging: a force that is periodic in position; mass and friction are estimated next to it, but a machine file has no place for it: a margin must cover its amplitude times the speed",
            ),
            Self::Backlash => f.write_str(
                "backlash: force is missing after each reversal, as in a play; take up the play (preload, nut, belt), and record again",
            ),
            Self::Stribeck => f.write_str(
                "Stribeck friction: it falls as the axis begins to move; mass and friction are estimated next to it, but a machine file has Coulomb friction alone: where the axis creeps, it is that of breakaway",
            ),
            Self::Saturated => f.write_str(
                "saturated: the force ends at a value, and the motion does not go with what was recorded; record with a smaller amplitude, or the force that the drive gives",
            ),
            Self::Changed { by } => write!(
                f,
                "changed meanwhile: the mass differs by {:.0} % from one part of the recordings to the others; record one load of one axis at a time",
                100.0 * by.abs()
            ),
            Self::OutOfStep { late_s } => write!(
                f,
                "out of step: the force belongs to motion {:.1} ms {}, more than a drive that samples makes of it; record the actual force and motion at the same time, without filters",
                1e3 * late_s.abs(),
                if *late_s > 0.0 { "later" } else { "earlier" }
            ),
            Self::MoreThanNoise => f.write_str(
                "more than noise is left: the model misses something, such as friction, cogging, backlash or another mode",
            ),
            Self::NoErrors => f.write_str(
                "no standard errors: this method gives none; compare it with --method iv",
            ),
            other @ (Self::Good | Self::TooNoisyForDamping | Self::DoesNotFit) => {
                f.write_str(other.word())
            }
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
/// Relative standard errors of a power model from which on it is no good, and how much it
/// must explain of the power's square.
const POWER_MASS: f64 = 0.05;
const EFFICIENCY: f64 = 0.05;
const POWER_EXPLAINED: f64 = 0.5;
/// Peaks by which a factor for peaks is found, at least.
const PEAKS: usize = 5;
/// What a model leaves unexplained, at most.
const REL_ERROR: f64 = 0.5;
/// The same of a flexible axis, of which single samples are compared.
const REL_ERROR_FLEXIBLE: f64 = 0.9;
/// What may be left besides noise, as a share of the whole.
const MISSED: f64 = 0.1;
/// The same where most of what is left follows from the input: a mode that is missing takes
/// the inertia along.
const MOSTLY: f64 = 0.5;
const MOSTLY_MISSED: f64 = 0.04;
/// So many times as much as noise would leave is more than noise: noise of a sensor is
/// as strong above the band as within, or stronger.
const NOISY: f64 = 2.0;
/// Frequencies that differ by less, as a share, are next to each other.
const NEXT_TO: f64 = 0.2;
/// What may be left where what is left comes and goes.
const UNSTEADY: f64 = 0.3;

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

/// Whether a figure is below zero for sure; one without an error, by more than nothing.
fn is_negative(figure: Figure) -> bool {
    let is_sure = figure.std.is_nan() || figure.value.abs() > certainty::SIGN * figure.std;
    figure.value < 0.0 && is_sure
}

/// Judges a rigid axis. Friction counts against the larger of its parts.
#[must_use]
pub fn rigid(axis: &Rigid) -> Judgement {
    if is_negative(axis.mass) && axis.rel_error <= REL_ERROR {
        return Judgement::Reversed;
    }
    if axis.mass.value > 0.0
        && let Some(word) = named(axis)
    {
        return word;
    }
    if axis.mass.value > 0.0 && axis.resonates {
        return Judgement::NotRigid;
    }
    if axis.mass.value <= 0.0 || axis.rel_error > REL_ERROR {
        return Judgement::DoesNotFit;
    }
    if axis.viscous.is_some_and(is_negative) {
        return Judgement::NegativeDamping;
    }
    if axis.rel_error > MISSED.max(NOISY * axis.noise_share) {
        return Judgement::MoreThanNoise;
    }
    if let Some(change) = axis.change {
        return Judgement::Changed { by: change.value };
    }
    if let Some(late) = axis.out_of_step_s {
        return Judgement::OutOfStep { late_s: late.value };
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

/// What makes up a fair part of the force besides mass and friction, where that is known by
/// its sign.
fn named(axis: &Rigid) -> Option<Judgement> {
    if let Some(Saturation::Recording { .. } | Saturation::Beyond { .. }) = axis.saturation {
        return Some(Judgement::Saturated);
    }
    // What explains less than it leaves is not what the axis has for the most part.
    let is_much = |share: f64| share > MISSED && (share > axis.rel_error || !axis.resonates);
    let effects = axis.effects.iter().filter(|effect| is_much(effect.share()));
    let most = effects.max_by(|a, b| a.share().total_cmp(&b.share()))?;
    Some(match most {
        Effect::Cogging { .. } => Judgement::Cogging,
        Effect::Backlash { .. } => Judgement::Backlash,
        Effect::Stribeck { .. } => Judgement::Stribeck,
    })
}

/// Judges a flexible axis.
#[must_use]
pub fn flexible(axis: &Flexible) -> Judgement {
    if axis.transfer.gain < 0.0 && axis.rel_error <= REL_ERROR {
        let is_sure = axis.sign_is_sure && axis.inertia.is_none_or(is_negative);
        return if is_sure {
            Judgement::Reversed
        } else {
            Judgement::DoesNotFit
        };
    }
    if axis.transfer.gain <= 0.0 || axis.rel_error > REL_ERROR_FLEXIBLE {
        return Judgement::DoesNotFit;
    }
    let zeros = || axis.zeros.iter().chain(&axis.unclear_zeros);
    let roots = || zeros().chain(&axis.poles);
    if roots().any(|root| is_negative(root.damping)) {
        return Judgement::NegativeDamping;
    }
    if leaves_more_than_noise(axis) {
        return Judgement::MoreThanNoise;
    }
    if let Some(change) = axis.change {
        return Judgement::Changed { by: change.value };
    }
    if !axis.has_errors {
        return Judgement::NoErrors;
    }
    // A mode that nothing excites is as uncertain as that, however long a recording is.
    let excited = || roots().filter(|root| root.omega_rad_s.value < axis.shown_rad_s);
    let worst = |part: fn(&Root) -> Figure, limit: f64| {
        excited()
            .map(|root| excess(part(root), limit))
            .fold(0.0, f64::max)
    };
    let inertia = if axis.sign_is_sure {
        axis.inertia.map_or(0.0, |j| excess(j, MASS))
    } else {
        f64::INFINITY
    };
    let frequency = worst(|root| root.omega_rad_s, FREQUENCY).max(inertia);
    let damping = worst(|root| root.damping, DAMPING);
    let verdict = if damping > TIMES_MAX && frequency <= 1.0 {
        Judgement::TooNoisyForDamping
    } else {
        longer(damping.max(frequency))
    };
    // Where errors are those of what the model misses, a longer recording has them too. Nor
    // does it show how an axis sticks that is seen by its positions alone, of which its modes
    // have a part.
    let swings = !(axis.zeros.is_empty() && axis.poles.is_empty());
    let sticks = swings && axis.coulomb.is_some() && axis.measured.integrators() > 1;
    let misses = verdict != Judgement::Good && axis.missed_energy > 1.0;
    if misses || verdict == Judgement::Good && sticks {
        return Judgement::MoreThanNoise;
    }
    if verdict == Judgement::Good && swings_in_slow_motion(axis) {
        return Judgement::DoesNotFit;
    }
    verdict
}

/// Whether an axis swings as slowly as it was taken as rigid to find its friction: the two
/// contradict each other. A pole next to a zero swings little.
fn swings_in_slow_motion(axis: &Flexible) -> bool {
    let slow_rad_s = TAU * SLOW_HZ;
    let zeros = || axis.zeros.iter().chain(&axis.unclear_zeros);
    let apart = |a: &Root, b: &Root| libm::log(a.omega_rad_s.value / b.omega_rad_s.value).abs();
    let swings = |pole: &Root| {
        let is_slow = pole.rings() && pole.omega_rad_s.value < slow_rad_s;
        is_slow && zeros().all(|zero| apart(zero, pole) > NEXT_TO)
    };
    let rubs = axis.viscous.is_some() || axis.coulomb.is_some();
    rubs && axis.poles.iter().any(swings)
}

/// Whether a model misses more than it may: what the input would explain of what is
/// left, what is not white, or what comes and goes with the motion as friction and
/// backlash do.
fn leaves_more_than_noise(axis: &Flexible) -> bool {
    let missed = axis.rel_error * axis.missed_share.sqrt();
    let is_coloured = !axis.whiteness.is_white() && axis.rel_error > MISSED;
    let is_unsteady = !axis.steadiness.is_white() && axis.rel_error > UNSTEADY;
    let is_mostly_missed = axis.missed_share > MOSTLY && missed > MOSTLY_MISSED;
    missed > MISSED || is_mostly_missed || is_coloured || is_unsteady
}

/// Judges a power model.
#[must_use]
pub fn power(model: &PowerModel) -> Judgement {
    // A model that explains less than half of how the power changes is none.
    let explains = model.r2_centered >= POWER_EXPLAINED && model.r2 >= POWER_EXPLAINED;
    if !explains || model.mass.value <= 0.0 {
        return Judgement::DoesNotFit;
    }
    if is_negative(model.viscous) || is_negative(model.coulomb) {
        return Judgement::NegativeDamping;
    }
    let efficiency = if model.efficiency.std > 0.0 {
        excess(model.efficiency, EFFICIENCY)
    } else {
        0.0
    };
    if model.peaks.peaks < PEAKS {
        return longer(PEAKS as f64 / model.peaks.peaks.max(1) as f64);
    }
    longer(excess(model.mass, POWER_MASS).max(efficiency))
}
