//! The standard errors that a signal leads to, before it is recorded: the inverse of the
//! products of the sensitivities, as the estimate itself has it (Cramér–Rao).

use super::known::{Known, NOISE_SHARE};
use crate::data::{Data, Signals};
use crate::leaky_integrator::Leaky;
use crate::output_error::whitened;
use crate::sensitivity::gather;
use crate::transfer::Factor;

/// Relative standard errors that are to be expected.
#[derive(Debug, Clone, PartialEq)]
pub struct Foreseen {
    /// Of mass or inertia.
    pub inertia: f64,
    /// The part of it that the signal makes; the rest is which speed of a held sample
    /// friction goes with, which no signal changes.
    pub(super) gain: f64,
    /// Of each zero and pole that is to be determined: frequency and damping.
    pub roots: Vec<[f64; 2]>,
}

/// What a signal is to reach, relative: mass; frequency of a zero by its damping, and
/// damping of a zero: at a zero a correction is wrong by 8.7 dB times the one and by 57°
/// times the other, so that 0.1 dB and 0.6° are then more than three standard errors: enough
/// for several axes at once; frequency and damping of a pole, as a verdict needs them.
const INERTIA: f64 = 0.005;
const ZERO: f64 = 0.0032;
const POLE: [f64; 2] = [0.005, 0.05];

/// The standard errors of a root that are to be reached: of ln ω and of ζ.
pub(super) fn wanted(known: &Known, index: usize) -> [f64; 2] {
    let (Some((factor, _)), zeros) = (known.roots.get(index), &known.transfer.zeros) else {
        return POLE;
    };
    match *factor {
        Factor::Pair { damping, .. } if zeros.contains(factor) => {
            [ZERO * damping.abs(), ZERO * damping.abs()]
        }
        Factor::Pair { damping, .. } => {
            let [frequency, share] = POLE;
            [frequency, share * damping.abs()]
        }
        Factor::Real { .. } => POLE,
    }
}

/// The relative standard error of the gain that is to be reached.
pub(super) const fn wanted_gain() -> f64 {
    INERTIA
}

/// Where the parameters of the roots stand: of ln ω, after which ζ comes.
pub(super) fn places(known: &Known) -> Vec<Option<usize>> {
    let transfer = &known.transfer;
    let place = |root: &Factor| {
        let mut at = 1;
        for factor in transfer.zeros.iter().chain(&transfer.poles) {
            if factor == root {
                return Some(at);
            }
            at += factor.degree();
        }
        None
    };
    known.roots.iter().map(|(root, _)| place(root)).collect()
}

impl Foreseen {
    /// How far the errors are from what is to be reached, at worst: 1 where all are
    /// there, less where they are smaller.
    #[must_use]
    pub fn by_wanted(&self, known: &Known) -> f64 {
        let mut worst = self.gain / wanted_gain();
        for (index, ([frequency, damping], (factor, _))) in
            self.roots.iter().zip(&known.roots).enumerate()
        {
            let zeta = match *factor {
                Factor::Pair { damping, .. } => damping.abs(),
                Factor::Real { .. } => 1.0,
            };
            let [of_frequency, of_damping] = wanted(known, index);
            for ratio in [frequency / of_frequency, damping * zeta / of_damping] {
                // What is not known stays so.
                if ratio > worst || ratio.is_nan() {
                    worst = ratio;
                }
            }
        }
        worst
    }

    /// Of a force. `None` where it does not determine the axis.
    pub(super) fn of(known: &Known, force: &[f64], accel: &[f64]) -> Option<Self> {
        let (input, speed) = known.driven(force);
        let output = vec![0.0; input.len()];
        let friction = if known.viscous > 0.0 {
            vec![speed]
        } else {
            Vec::new()
        };
        let data = Data {
            input: &input,
            friction: &friction,
            output: &output,
            viscous: None,
            turning: 0,
            undisturbed: None,
            period_s: known.period_s,
            measured: known.measured,
            from_command: false,
            early_s: 0.0,
            positions: false,
            every: 1,
            leak: 0.0,
        };
        let leaky = (known.noise.leak > 0.0).then(|| Leaky::of(&data, known.noise.leak));
        let held = leaky.as_ref().map_or(data, |leaky| leaky.data(&data));
        let taps = &known.noise.taps;
        let signals = Signals::filtered(&held, |x| whitened(x, taps));
        let white = signals.data(&held);
        let is_late = known.transfer.delay_s > 0.0;
        let normal = gather(
            &white,
            &known.transfer,
            is_late,
            taps.len() + data.skip(),
            &[],
        )?;
        let solution = normal.solve().or_else(|| normal.solve_from(0, 1e-12))?;
        let noise = known.noise_std.unwrap_or_else(|| NOISE_SHARE * rms(accel));
        let std = |index: usize| {
            if index < solution.inverse.nrows() {
                solution.inverse[(index, index)].max(0.0).sqrt() * noise
            } else {
                f64::NAN
            }
        };
        let gain = std(0) / known.transfer.gain;
        let held_friction = known.viscous * known.period_s * known.transfer.gain;
        let roots = known
            .roots
            .iter()
            .zip(places(known))
            .map(|((factor, _), at)| {
                let zeta = match *factor {
                    Factor::Pair { damping, .. } => damping.abs(),
                    Factor::Real { .. } => 1.0,
                };
                at.map_or([f64::NAN; 2], |at| [std(at), std(at + 1) / zeta])
            });
        Some(Self {
            inertia: libm::hypot(gain, held_friction),
            gain,
            roots: roots.collect(),
        })
    }
}

fn rms(x: &[f64]) -> f64 {
    (x.iter().map(|x| x * x).sum::<f64>() / x.len().max(1) as f64).sqrt()
}
