//! Friction of a flexible axis: what acts against its force with the speed, and with the
//! sign of the speed.
//!
//! A model from force to acceleration has no place for it: without friction the gain at
//! 0 Hz is 1/J, with it 0, and whatever stands for that takes the inertia along. So the
//! speed, taken from the recording, and its sign are further inputs, each with a factor
//! that is estimated next to the model. Whether there is any shows where motion is slow
//! and the axis as good as rigid.

use super::certainty;
use super::figure::Figure;
use super::recording::Recording;
use super::slow_motion::{SlowMotion, in_band, slow_motion};
use super::speeds::{Followed, Speed, are_sums, between, mean_sign, speed_of};
use super::state_space::Measured;

/// A term of friction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Term {
    /// It grows with the speed.
    Viscous,
    /// It has the sign of the speed.
    Coulomb,
    /// It turns round sooner than the sign of the speed that was measured, or takes longer, by
    /// factors of differences of that sign: how, a recording does not show but by these.
    Turning,
    /// What a sensor of acceleration adds makes a ramp of its sum, the speed.
    Drift,
}

/// Friction as further inputs of a model.
#[derive(Debug, Clone, Default)]
pub(super) struct Rubbing {
    /// What there is.
    pub(super) terms: Vec<Term>,
    /// By term: speeds (m/s or rad/s) or their signs, as means from sample to sample.
    whole: Vec<Vec<f64>>,
    /// What a model gets of these, to find what was not taken off.
    pub(super) inputs: Vec<Vec<f64>>,
    /// By term: about how much it is; that is taken off the force beforehand.
    pub(super) about: Vec<f64>,
    /// What slow motion shows, of which that is.
    slow: Option<SlowMotion>,
}

/// Sums of each sample and those before and after it by these factors.
fn next_to_each(x: &[f64], by: [f64; 3]) -> Vec<f64> {
    let sums = x.windows(3).map(|near| {
        let terms = near.iter().zip(&by).map(|(x, by)| x * by);
        terms.sum::<f64>()
    });
    let ends = || std::iter::once(0.0).take(x.len());
    ends().chain(sums).chain(ends()).take(x.len()).collect()
}

/// How sure a figure is, in standard errors; below 0 where it is negative.
fn sureness(value: f64, std: f64) -> f64 {
    value / std.max(f64::MIN_POSITIVE)
}

impl Rubbing {
    /// What a recording shows of friction. `None` where it shows none, or has no force
    /// or motion.
    pub(super) fn of(recording: &Recording) -> Option<Self> {
        let (slow, speed) = slow_motion(recording)?;
        let sureness = |figure: Figure| sureness(figure.value, figure.std);
        let surest = slow.coulomb.map_or(f64::MIN, sureness);
        if sureness(slow.viscous).max(surest) < certainty::FRICTION {
            return None;
        }
        let is_sure = |figure: Figure| sureness(figure) > certainty::FRICTION_TERM;
        let mut out = Self::default();
        let is_dry = slow.coulomb.is_some_and(is_sure);
        if is_sure(slow.viscous) || is_dry {
            // Next to Coulomb friction it also takes what the sign of the speed is off by: without
            // it that goes into the inertia.
            out.add(Term::Viscous, &speed, slow.viscous.value);
        }
        if let Some(coulomb) = slow.coulomb.filter(|_| is_dry) {
            out.add(Term::Coulomb, &speed, coulomb.value);
        }
        if are_sums(recording) {
            out.add(Term::Drift, &speed, 0.0);
        }
        out.slow = Some(slow);
        Some(out)
    }

    fn place(&self, wanted: Term) -> Option<usize> {
        self.terms.iter().position(|term| *term == wanted)
    }

    /// How many terms, the last ones, say how it turns round.
    pub(super) fn turning(&self) -> usize {
        let terms = self.terms.iter();
        terms.filter(|term| **term == Term::Turning).count()
    }

    fn add(&mut self, term: Term, speed: &Speed, about: f64) {
        self.terms.push(term);
        self.whole.push(term.input(speed));
        self.about.push(about);
    }

    /// Takes what is known of friction off a force; what is left to be found becomes inputs.
    /// A position shows the speed but roughly as it turns round.
    pub(super) fn take_off(&mut self, force: &mut [f64], measured: Measured, period_s: f64) {
        for (input, about) in self.whole.iter().zip(&self.about) {
            for (slot, x) in force.iter_mut().zip(input) {
                *slot -= about * x;
            }
        }
        self.inputs = std::mem::take(&mut self.whole);
        // One way the noise of the speed is large next to its changes. It is that of the motion
        // too, and a model that has the one as an input makes the other of it.
        if self.is_one_way() {
            for input in &mut self.inputs {
                *input = in_band(input, period_s);
            }
        }
        let sign = self.place(Term::Coulomb);
        if let Some(at) = sign.filter(|_| measured == Measured::Position) {
            let sign = self.inputs.get(at).map_or(&[][..], Vec::as_slice);
            let turning = [[-0.5, 0.0, 0.5], [1.0, -2.0, 1.0]].map(|by| next_to_each(sign, by));
            self.terms.extend([Term::Turning; 2]);
            self.inputs.extend(turning);
        }
    }

    /// Motion one way shows no Coulomb friction.
    fn is_one_way(&self) -> bool {
        self.slow.as_ref().is_some_and(|it| it.coulomb.is_none())
    }

    /// What was taken off a force beforehand, where that is viscous friction alone, of a motion
    /// to and fro.
    pub(super) fn viscous_alone(&self) -> Option<f64> {
        match (self.terms.as_slice(), self.about.as_slice()) {
            ([Term::Viscous], [about]) if !self.is_one_way() => Some(*about),
            _ => None,
        }
    }

    /// Whether the speed is a sum of accelerations.
    pub(super) fn is_summed(&self) -> bool {
        self.terms.contains(&Term::Drift)
    }

    /// Viscous and Coulomb friction. Next to Coulomb friction, and in motion one way, they are
    /// what slow motion shows: at which mass friction acts changes fast motion, and a model
    /// knows that of the force alone. To and fro viscous friction alone is what was taken off
    /// beforehand, and what the model found besides: wherever it acts, poles and zeros have a
    /// place for it.
    pub(super) fn figures(&self, found: &[Figure]) -> [Option<Figure>; 2] {
        let Some(slow) = &self.slow else {
            return [None; 2];
        };
        if self.place(Term::Coulomb).is_some() || self.is_one_way() {
            let viscous = slow.viscous;
            let is_sure = sureness(viscous.value, viscous.std) > certainty::FRICTION_TERM;
            return [is_sure.then_some(viscous), slow.coulomb];
        }
        let viscous = self.place(Term::Viscous).and_then(|at| {
            let (about, found) = (self.about.get(at)?, found.get(at)?);
            // Coulomb friction that does not show may be there.
            let unseen = slow.coulomb.map_or(0.0, |coulomb| coulomb.std);
            Some(Figure {
                value: about + found.value,
                std: libm::hypot(found.std, slow.exchanged * unseen),
            })
        });
        [viscous, None]
    }

    /// Whether there is friction for sure.
    pub(super) fn is_clear(&self, found: &[Figure]) -> bool {
        let figures = self.figures(found);
        let mut figures = figures.iter().flatten();
        figures.any(|figure| figure.value > certainty::FRICTION_OF_MODEL * figure.std)
    }

    /// This much friction in another recording of an axis of this mass.
    pub(super) fn known(
        recording: &Recording,
        mass: f64,
        figures: [(Term, Option<f64>); 2],
    ) -> Option<Self> {
        let [viscous, coulomb] = figures.map(|(_, value)| value.unwrap_or_default());
        let by = Followed {
            mass,
            viscous,
            coulomb,
        };
        let speed = speed_of(recording, by)?;
        let mut out = Self::default();
        for (term, value) in figures {
            if let Some(value) = value {
                out.add(term, &speed, value);
            }
        }
        Some(out)
    }
}

impl Term {
    fn input(self, speed: &Speed) -> Vec<f64> {
        match self {
            Self::Viscous => speed.means().to_vec(),
            Self::Coulomb | Self::Turning => between(&speed.smooth, mean_sign),
            Self::Drift => {
                let samples = speed.plain.len();
                let n = samples.max(1) as f64;
                (0..samples).map(|k| k as f64 / n).collect()
            }
        }
    }
}
