//! How large a converter must be: what programs take at different ratings, and at
//! different capacitances of its DC bus.
//!
//! Every figure is what the limiter made of the program for a machine with that rating:
//! nothing is interpolated, and no formula stands for a run. So `limit` does with such
//! a machine what is said here.

mod rating_steps;
mod scale;
mod search;
mod trial;

use std::io::{Read, Seek};

pub use scale::{Quantity, rated};
pub use trial::{Job, Trial};

use super::{Failure, LimitOptions};
use crate::diagnostic::Diagnostic;
use crate::machine::Machine;
use rating_steps::curve;
use scale::Scale;
use search::find;
use trial::{Bench, each};

/// What is wanted of a sizing.
#[derive(Debug, Clone, PartialEq)]
pub struct Wish {
    /// What the limiter is asked to do.
    pub how: LimitOptions,
    /// Index of the converter that is sized.
    pub converter: usize,
    /// Steps between the lowest value at which the programs can be made to fit and the
    /// value from which on nothing is slowed, both included; at least 2.
    pub steps: usize,
    /// Largest loss of time of a program, as a share, that is of interest: below, nothing
    /// is tried.
    pub until: f64,
    /// Losses of time, as shares, for which the smallest value is wanted.
    pub losses: Vec<f64>,
    /// Power that may be fed back by rating; `None`: as the machine says.
    pub regen_ratio: Option<f64>,
    /// Threads to use, at least 1.
    pub threads: usize,
}

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

/// Says what programs take at different ratings of a converter.
///
/// # Errors
/// Those of reading a program a further time, and of an unsuitable strategy; a program
/// that is refused at once is no error: see [`Outcome`].
pub fn size<R: Read + Seek + Send>(
    jobs: &[Job<'_, R>],
    machine: &Machine,
    wish: &Wish,
) -> Result<Size, Failure> {
    let scale = |quantity| Scale::new(machine, wish, quantity);
    let all: Vec<&Job<'_, R>> = jobs.iter().collect();
    let rating = sizing(&all, &scale(Quantity::Rating), wish)?;
    let sized = |index: usize| {
        let outcome = rating.programs.get(index).map(|(_, outcome)| outcome);
        matches!(outcome, Some(Outcome::Sized(_)))
    };
    let rest: Vec<&Job<'_, R>> = jobs
        .iter()
        .enumerate()
        .filter(|(index, _)| sized(*index))
        .map(|(_, job)| job)
        .collect();
    let capacitance = if scale::limits_voltage(machine, wish.converter) && !rest.is_empty() {
        Some(sizing(&rest, &scale(Quantity::Capacitance), wish)?)
    } else {
        None
    };
    Ok(Size {
        rating,
        capacitance,
    })
}

fn sizing<R: Read + Seek + Send>(
    jobs: &[&Job<'_, R>],
    scale: &Scale<'_>,
    wish: &Wish,
) -> Result<Sizing, Failure> {
    let at_once = wish.threads.min(jobs.len()).max(1);
    let threads = (wish.threads / at_once).max(1);
    let found = each(at_once, jobs, |job| {
        let mut bench = Bench::new(job, scale, wish.how, threads);
        let found = find(&mut bench, wish.until);
        (found, bench)
    })?;
    let mut programs = Vec::new();
    let mut benches = Vec::new();
    for (outcome, bench) in found {
        let name = bench.name().to_owned();
        let outcome = match outcome {
            // A strategy that does not suit the machine suits no program.
            Err(failure @ Failure::Unsuitable(_)) => return Err(failure),
            Err(failure) => Outcome::Refused(failure),
            Ok(outcome) => {
                if let Outcome::Sized(size) = &outcome {
                    benches.push(((**size).clone(), bench));
                }
                outcome
            }
        };
        programs.push((name, outcome));
    }
    Ok(Sizing {
        quantity: scale.quantity,
        programs,
        curve: curve(benches, scale, wish)?,
    })
}
