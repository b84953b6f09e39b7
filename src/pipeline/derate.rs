//! Programs whose moves fit one by one, but which exceed a limit over time: all
//! moves are held to lower peaks, until the limits over time are kept too.
//!
//! The share of the peak power that is aimed at is found by halving; each try is
//! certified by the whole analysis, so nothing rests on how the figures depend on
//! the share.

use super::{Failure, LimitSummary, Summary};
use crate::machine::Machine;
use crate::power::Measure;

/// Shares of the peak powers that are tried, until one is enough.
const SHARES: [f64; 8] = [0.75, 0.55, 0.4, 0.3, 0.2, 0.13, 0.08, 0.05];
/// Halvings between the first share that is enough and the one before.
const HALVINGS: u32 = 4;
/// The rule of what is said where there is no further round.
pub(super) const LAST_ROUND: &str = "last-round";
/// Beyond the peak power there is only what the capacitor gives: so much is
/// tried at most.
const BEYOND: f64 = 4.0;

/// Which limits are lowered.
#[derive(Debug, Clone, Copy)]
struct Sides {
    drawn: bool,
    fed_back: bool,
}

/// Lowers peaks until the limits over time are kept; `first` is what came of the
/// machine's own limits, and what is given back if nothing helps.
pub(super) fn lower_further(
    machine: &Machine,
    first: LimitSummary,
    attempt: &mut dyn FnMut(&Machine) -> Result<LimitSummary, Failure>,
) -> Result<LimitSummary, Failure> {
    let missed = |fed_back: bool| {
        let missed = first.after.over_time.iter().filter(|it| !it.rating.fits());
        missed
            .map(|it| it.rating.measure)
            .any(|measure| is_fed_back(measure) == fed_back)
    };
    let sides = Sides {
        drawn: missed(false),
        fed_back: missed(true),
    };
    let credited = machine.converters.iter().any(|converter| {
        sides.drawn && converter.ratings.credits_low()
            || sides.fed_back && converter.ratings.credits_high()
    });
    // Where capacitors take peaks, the peaks have had no limit at all so far.
    let tried = if credited { BEYOND } else { 1.0 };
    let shares = credited.then_some(1.0).into_iter().chain(SHARES);
    // Shares of what nothing reaches would be too coarse.
    let alone = machine.converters.len() == 1 && !credited;
    let mut search = Search {
        machine,
        before: first.before,
        drawn_w: if alone {
            first.after.peak_w
        } else {
            f64::INFINITY
        },
        regen_w: first.after.regen_w,
        sides,
        attempt,
    };
    let mut above = tried;
    for share in shares {
        if search.fits(share)? {
            return search.largest(share, above);
        }
        above = share;
    }
    // Once more, for the report and the reasons.
    (search.attempt)(machine)
}

/// Shares of the peak powers that are aimed at where the limits themselves were missed.
const AIMS: [f64; 2] = [0.97, 0.9];

/// Whether every block could be lowered, and some exceed the limit all the same, since their
/// neighbours run otherwise then.
pub(super) fn missed_narrowly(first: &LimitSummary) -> bool {
    let mut reasons = first.reasons.iter();
    let narrow = |rule| rule == "does-not-fit" || rule == LAST_ROUND;
    !first.certified && !first.reasons.is_empty() && reasons.all(|reason| narrow(reason.rule))
}

/// Aims a little lower, which leads to other feeds; what comes of it is certified for the
/// machine itself. `first` is what was missed narrowly.
pub(super) fn aim_lower(
    machine: &Machine,
    first: LimitSummary,
    attempt: &mut dyn FnMut(&Machine) -> Result<LimitSummary, Failure>,
) -> Result<LimitSummary, Failure> {
    for aim in AIMS {
        let mut target = machine.clone();
        for converter in &mut target.converters {
            converter.peak_power_w *= aim;
            converter.regen_power_w = converter.regen_power_w.map(|power_w| aim * power_w);
        }
        let summary = attempt(&target)?;
        if summary.certified {
            return Ok(LimitSummary {
                before: first.before,
                ..summary
            });
        }
    }
    // Once more, for the report and the reasons.
    attempt(machine)
}

/// Whether a limit is one of the power that is fed back.
fn is_fed_back(measure: Measure) -> bool {
    matches!(measure, Measure::Brake { .. } | Measure::HighestVoltage)
}

struct Search<'a> {
    machine: &'a Machine,
    /// The program as it came, under the machine's own limits.
    before: Summary,
    /// What is drawn at most, where that is known of the converter, W.
    drawn_w: f64,
    /// What is fed back at most, where the machine sets no limit to it, W.
    regen_w: f64,
    sides: Sides,
    attempt: &'a mut dyn FnMut(&Machine) -> Result<LimitSummary, Failure>,
}

impl Search<'_> {
    /// Whether a share is enough.
    fn fits(&mut self, share: f64) -> Result<bool, Failure> {
        let target = self.target(share);
        Ok((self.attempt)(&target)?.certified)
    }

    /// The largest share between one that is enough and one that is not, and
    /// what comes of it.
    fn largest(mut self, enough: f64, above: f64) -> Result<LimitSummary, Failure> {
        let (mut low, mut high) = (enough, above);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if self.fits(middle)? {
                low = middle;
            } else {
                high = middle;
            }
        }
        // What was written last may be another one.
        let target = self.target(low);
        let summary = (self.attempt)(&target)?;
        Ok(LimitSummary {
            before: self.before,
            ..summary
        })
    }

    /// The machine with a share of its limits, and capacitors that take nothing.
    fn target(&self, share: f64) -> Machine {
        let mut target = self.machine.clone();
        let kept = 1.0 - target.limits.margin;
        for converter in &mut target.converters {
            if self.sides.drawn {
                let largest_w = converter.peak_power_w.min(self.drawn_w / kept);
                converter.peak_power_w = share * largest_w;
            }
            if self.sides.fed_back {
                let own_w = self.regen_w / kept;
                let largest_w = converter.regen_power_w.unwrap_or(own_w);
                converter.regen_power_w = Some(share * largest_w);
            }
            converter.ratings.credit_capacitance = false;
        }
        target
    }
}
