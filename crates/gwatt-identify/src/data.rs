//! What is fitted: input and output, and how they were measured.

use super::state_space::Measured;

/// The longest delay that is looked for, and a little.
const LEAD_IN: usize = 16;

/// What is fitted.
#[derive(Debug, Clone, Copy)]
pub struct Data<'a> {
    /// Input, held between samples.
    pub input: &'a [f64],
    /// What acts against the input besides, each by a factor that is estimated: speeds
    /// of viscous friction, signs of Coulomb friction.
    pub friction: &'a [Vec<f64>],
    /// How much viscous friction has been taken off the input by the first of these, where
    /// there is no other friction and it is the measured speed.
    pub viscous: Option<f64>,
    /// How many of them, the last ones, say how an axis turns round next to Coulomb friction.
    pub turning: usize,
    /// Output; differences of it where a speed or position was measured.
    pub output: &'a [f64],
    /// What the excitation alone makes of the input, in a closed loop.
    pub undisturbed: Option<&'a [f64]>,
    /// Sampling period.
    pub period_s: f64,
    /// What was measured.
    pub measured: Measured,
    /// True for commands as input.
    pub from_command: bool,
    /// By how much the input is early, s: no delay is shorter.
    pub early_s: f64,
    /// True for positions as input and output: most of what they are is slow.
    pub positions: bool,
    /// One of so many samples counts as a row: 1 where all do.
    pub every: usize,
    /// What leaky integrators, through which both signals went, lose from sample to
    /// sample; 0 without them.
    pub leak: f64,
}

/// Signals of a recording after a filter: all go through the same one, which leaves a
/// model between them as it is.
pub struct Signals {
    pub input: Vec<f64>,
    pub friction: Vec<Vec<f64>>,
    pub output: Vec<f64>,
    pub undisturbed: Option<Vec<f64>>,
}

impl Signals {
    /// Those of `data` after `filter`.
    #[must_use]
    pub fn filtered(data: &Data<'_>, filter: impl Fn(&[f64]) -> Vec<f64>) -> Self {
        // Of the first samples only, where friction is known of all.
        let present = |x: &'_ [f64]| x.len().min(data.input.len());
        let friction = data.friction.iter();
        let friction = friction.map(|x| filter(x.get(..present(x)).unwrap_or_default()));
        Self {
            input: filter(data.input),
            friction: friction.collect(),
            output: filter(data.output),
            undisturbed: data.undisturbed.map(filter),
        }
    }

    /// Each of them once more through a filter.
    pub fn each(&mut self, mut filter: impl FnMut(&mut [f64])) {
        filter(&mut self.input);
        self.friction.iter_mut().for_each(|x| filter(x));
        filter(&mut self.output);
        if let Some(undisturbed) = &mut self.undisturbed {
            filter(undisturbed);
        }
    }

    /// What was recorded, with these signals.
    #[must_use]
    pub fn data<'a>(&'a self, data: &Data<'a>) -> Data<'a> {
        Data {
            input: &self.input,
            friction: &self.friction,
            output: &self.output,
            undisturbed: self.undisturbed.as_deref(),
            ..*data
        }
    }
}

impl Data<'_> {
    /// The first samples only.
    #[must_use]
    pub fn head(&self, count: usize) -> Self {
        let cut = |x: &'_ [f64]| -> usize { count.min(x.len()) };
        Self {
            input: self.input.get(..cut(self.input)).unwrap_or_default(),
            output: self.output.get(..cut(self.output)).unwrap_or_default(),
            undisturbed: self
                .undisturbed
                .map(|x| x.get(..cut(x)).unwrap_or_default()),
            ..*self
        }
    }

    /// Without what says how an axis turns round.
    #[must_use]
    pub fn without_turning(&self) -> Self {
        let known = self.friction.len().saturating_sub(self.turning);
        Self {
            friction: self.friction.get(..known).unwrap_or_default(),
            turning: 0,
            ..*self
        }
    }

    /// Samples at the beginning that do not count. Before the first one a force
    /// was nil; where a command stood is not known, and comes late.
    #[must_use]
    pub fn skip(&self) -> usize {
        match self.measured {
            _ if self.from_command => LEAD_IN,
            Measured::Direct => 0,
            Measured::Velocity => 1,
            Measured::Position => 2,
        }
    }

    /// How many integrators' first values fade within the signals.
    #[must_use]
    pub fn fading(&self) -> usize {
        if self.leak > 0.0 {
            self.measured.integrators()
        } else {
            0
        }
    }

    /// Number of rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.len().div_ceil(self.every)
    }

    /// Number of samples.
    #[must_use]
    pub fn len(&self) -> usize {
        self.input.len().min(self.output.len())
    }
}
