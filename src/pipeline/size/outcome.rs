//! What sizing comes to.

use super::super::Failure;
use super::scale::Quantity;
use super::trial::Trial;
use crate::diagnostic::Diagnostic;

/// What sizing came to.
#[derive(Debug)]
pub struct Size {
    /// Over the converter's rating.
    pub rating: Sizing,
    /// Over the capacitance of its DC bus at the machine's own rating, where the
    /// machine file limits the voltage.
    pub capacitance: Option<Sizing>,
}

/// Programs over one quantity.
#[derive(Debug)]
pub struct Sizing {
    /// What is varied.
    pub quantity: Quantity,
    /// What became of each program, in the order given.
    pub programs: Vec<(String, Outcome)>,
    /// All that can be sized together; `None` where none can.
    pub curve: Option<Curve>,
}

/// What became of a program.
#[derive(Debug)]
pub enum Outcome {
    /// It is not read.
    Refused(Failure),
    /// It draws nothing at all.
    Idle,
    /// It fits at no value.
    Never {
        /// What it draws at most as it came, W.
        peak_w: f64,
        /// What it feeds back at most as it came, W.
        regen_w: f64,
        /// Why.
        reasons: Vec<Diagnostic>,
    },
    /// It fits from some value on.
    Sized(Box<ProgramSize>),
}

/// A program that fits from some value on.
#[derive(Debug, Clone, PartialEq)]
pub struct ProgramSize {
    /// Its cycle time in s as it came.
    pub duration_s: f64,
    /// What it draws at most as it came, W.
    pub peak_w: f64,
    /// What it feeds back at most as it came, W.
    pub regen_w: f64,
    /// What remains of it where the value is no limit.
    pub unlimited: Trial,
    /// The smallest value from which on nothing is slowed (W or F).
    pub enough: f64,
    /// The smallest value at which it is certified, to a hundredth, with no larger loss
    /// of time than is of interest.
    pub lowest: f64,
    /// The next lower value that was tried and why it is not certified there: without a
    /// reason it takes too long. `None` where `lowest` is the smallest that makes sense.
    pub below: Option<(f64, Vec<Diagnostic>)>,
}

/// Programs together, over one quantity.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// Sum of the cycle times in s where the value is no limit.
    pub duration_s: f64,
    /// The smallest value from which on nothing is slowed (W or F).
    pub enough: f64,
    /// The smallest value at which all are certified, to a hundredth.
    pub lowest: f64,
    /// From the lowest value up.
    pub ladder: Vec<Rung>,
    /// The machine's own value.
    pub own: Rung,
    /// Wished losses, as shares, with the smallest value for each, to half a percent.
    pub losses: Vec<(f64, Rung)>,
}

/// What all programs come to at one value.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Rung {
    /// The value (W or F).
    pub value: f64,
    /// The converter's peak power, W.
    pub peak_power_w: f64,
    /// Its continuous power, where the machine gives one, W.
    pub continuous_power_w: Option<f64>,
    /// Power that may be fed back, where there is a limit, W.
    pub regen_power_w: Option<f64>,
    /// Its capacitance, where the machine gives one, F.
    pub capacitance_f: Option<f64>,
    /// Each program that can be sized, in the order given.
    pub trials: Vec<Trial>,
    /// All together: sums of times and lines, the largest powers.
    pub total: Trial,
    /// Loss of time as a share of that without this limit.
    pub loss: f64,
}
