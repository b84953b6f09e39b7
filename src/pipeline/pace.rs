//! Programs whose moves are planned together: speeds found by measure, where those that were
//! solved move by move lose time or do not fit.
//!
//! Three ways are tried: each line is held to what its own plan leaves it, round by round;
//! all lines that are lowered are held to one share of their speeds; and both are let go
//! where there is room. The soonest that is certified is written.

use std::collections::BTreeSet;

use super::derate::LAST_ROUND;
use super::summary::AT_LENGTH_MAX;
use super::{Failure, Law, LimitOptions, LimitSummary, Strategy};
use crate::limit::{Paces, Place};
use crate::machine::{Knob, Machine};

/// What a program must have lost before other speeds are looked for, and what these must
/// bring in, as a share of its time.
const LOSS: f64 = 1e-3;
const GAIN: f64 = 2e-4;
/// Moves that are written in all tries together.
const EFFORT: u64 = 200_000;
/// Reasons of a refusal for which other speeds may help.
const OPEN: [&str; 4] = ["does-not-fit", LAST_ROUND, "no-solution", "not-enough"];
/// How often a program is written at most.
const TRIES: u64 = 120;
/// How often lines are let go.
const RAISES: u32 = 2;
/// Halvings of the ratio between the shares that are enough and those that are not, and the
/// lowest share.
const HALVINGS: u32 = 10;
const LOWEST: f64 = 1.0 / 64.0;
/// How often further lines are taken in.
const JOINS: u32 = 4;

/// Runs a program with the speeds that lines are held to, or else with moves solved one by
/// one: gives what came of it, and what the plan said of its lines.
type Run<'a> = &'a mut dyn FnMut(Option<Paces>) -> Result<(LimitSummary, Paces), Failure>;

/// The soonest program of those that fit; `first` is what came of solving its moves one by
/// one.
pub(super) fn sooner(
    how: LimitOptions,
    first: LimitSummary,
    run: Run<'_>,
) -> Result<LimitSummary, Failure> {
    if !is_worth(how, &first) {
        return Ok(first);
    }
    let mut search = Search {
        left: (EFFORT / first.before.moves.max(1)).min(TRIES),
        best: first,
        by: None,
        last_is_best: true,
        run,
    };
    let lowered = search.try_paces(Paces::default())?;
    search.raise()?;
    let by_lines_s = search.best.after.duration_s;
    search.common(&mut |search, share| {
        let end = search.try_paces(Paces::all_feeds(share))?;
        Ok(end.exceeding().next().is_none())
    })?;
    let mut lines = lowered.places().collect();
    search.common(&mut |search, share| search.fits(&mut lines, share))?;
    if search.best.after.duration_s < by_lines_s {
        search.raise()?;
    }
    search.finish()
}

/// Whether there may be something to gain.
fn is_worth(how: LimitOptions, first: &LimitSummary) -> bool {
    let solved = matches!(
        how.strategy,
        Strategy::Speed | Strategy::Optimal | Strategy::Split
    );
    solved && how.law == Law::Exact && first.before.moves <= AT_LENGTH_MAX && loses(first)
}

/// Whether a program whose moves are planned together loses time, or does not fit for reasons that
/// other speeds may do away with.
fn loses(first: &LimitSummary) -> bool {
    let (before, after) = (&first.before, &first.after);
    let lost_s = after.duration_s - before.duration_s;
    after.ahead
        && if first.certified {
            lost_s > LOSS * before.duration_s
        } else {
            let mut reasons = first.reasons.iter();
            reasons.all(|reason| OPEN.contains(&reason.rule))
        }
}

/// A program that is too long for speeds by measure, with words for acceleration alone where that is
/// sooner: lower speeds of many short lines slow their neighbours down too. `first` is what came of
/// both, and `run` limits it in another way.
pub(super) fn by_acceleration(
    machine: &Machine,
    how: LimitOptions,
    first: LimitSummary,
    run: &mut dyn FnMut(LimitOptions) -> Result<LimitSummary, Failure>,
) -> Result<(LimitOptions, LimitSummary), Failure> {
    let is_long = first.before.moves > AT_LENGTH_MAX;
    let both = how.strategy == Strategy::Optimal && how.law == Law::Exact;
    let has_word = machine.controller.knobs.iter().any(Knob::lowers_accel);
    if !(is_long && both && has_word && loses(&first)) {
        return Ok((how, first));
    }
    let alone = LimitOptions {
        strategy: Strategy::Accel,
        ..how
    };
    let found = run(alone)?;
    let sooner = !first.certified || found.after.duration_s < first.after.duration_s;
    if found.certified && sooner {
        return Ok((alone, found));
    }
    // What was written last is delivered.
    Ok((how, run(how)?))
}

struct Search<'a> {
    best: LimitSummary,
    /// The speeds that it was written with, where it was by measure, as they were at the end.
    by: Option<(Paces, Paces)>,
    /// What was written last is the best.
    last_is_best: bool,
    /// Tries that are left.
    left: u64,
    run: Run<'a>,
}

impl Search<'_> {
    /// Tries speeds, and keeps them where the program is certified and sooner done.
    fn try_paces(&mut self, paces: Paces) -> Result<Paces, Failure> {
        let start = paces.clone();
        let (found, end) = (self.run)(Some(paces))?;
        self.left = self.left.saturating_sub(u64::from(end.rounds()) + 1);
        let least_s = self.best.after.duration_s * (1.0 - GAIN);
        let better = found.certified && (!self.best.certified || found.after.duration_s < least_s);
        self.last_is_best = better;
        if better {
            self.best = found;
            self.by = Some((start, end.clone()));
        }
        Ok(end)
    }

    /// Lets lines go where the best leaves them room.
    fn raise(&mut self) -> Result<(), Failure> {
        for _ in 0..RAISES {
            let Some((_, end)) = self.by.as_ref().filter(|_| self.left > 0) else {
                break;
            };
            let raised = end.raised();
            let before_s = self.best.after.duration_s;
            self.try_paces(raised)?;
            if self.best.after.duration_s >= before_s {
                break;
            }
        }
        Ok(())
    }

    /// The largest share of their speeds that moves may have in common.
    fn common(
        &mut self,
        fits: &mut dyn FnMut(&mut Self, f64) -> Result<bool, Failure>,
    ) -> Result<(), Failure> {
        if self.left == 0 || !fits(self, LOWEST)? {
            return Ok(());
        }
        let (mut low, mut high) = (LOWEST, 1.0);
        for _ in 0..HALVINGS {
            if self.left == 0 {
                break;
            }
            let share = libm::sqrt(low * high);
            if fits(self, share)? {
                low = share;
            } else {
                high = share;
            }
        }
        Ok(())
    }

    /// Whether one share of the speeds of these lines is enough; lines that exceed then
    /// join them.
    fn fits(&mut self, lines: &mut BTreeSet<Place>, share: f64) -> Result<bool, Failure> {
        for _ in 0..JOINS {
            if self.left == 0 {
                break;
            }
            let end = self.try_paces(Paces::common(lines.iter().copied(), share))?;
            let known = lines.len();
            lines.extend(end.exceeding());
            if end.exceeding().next().is_none() {
                return Ok(true);
            }
            if lines.len() == known {
                break;
            }
        }
        Ok(false)
    }

    /// What was best, written once more where it was not last.
    fn finish(self) -> Result<LimitSummary, Failure> {
        if self.last_is_best {
            return Ok(self.best);
        }
        let start = self.by.map(|(start, _)| start);
        (self.run)(start).map(|(found, _)| found)
    }
}
