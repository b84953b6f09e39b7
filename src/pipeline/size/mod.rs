//! How large a converter must be: what programs take at different ratings, and at
//! different capacitances of its DC bus.
//!
//! Every figure is what the limiter made of the program for a machine with that rating:
//! nothing is interpolated, and no formula stands for a run. So `limit` does with such
//! a machine what is said here.

mod outcome;
mod rating_steps;
mod scale;
mod search;
mod trial;
mod wish;

use std::io::{Read, Seek};

pub use outcome::{Curve, Outcome, ProgramSize, Rung, Size, Sizing};
pub use scale::{Quantity, rated};
pub use trial::{Job, Trial};
pub use wish::Wish;

use super::Failure;
use crate::machine::Machine;
use rating_steps::curve;
use scale::Scale;
use search::find;
use trial::{Bench, each};

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
