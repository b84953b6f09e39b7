//! The values between which one program is sized.

use std::io::{Read, Seek};

use super::scale::{Quantity, round_up, step_down};
use super::trial::{Bench, Trial};
use super::{Failure, Outcome, ProgramSize};

/// How near the smallest value is found from which on nothing is slowed, as a share.
const ENOUGH: f64 = 1e-3;
/// How near the smallest value is found at which a program is certified.
const LOWEST: f64 = 0.01;
/// Steps on the way down: the limiter takes long where little is left.
const STEP_DOWN: f64 = 0.7;
/// Two times are the same.
const SAME_TIME: f64 = 1e-9;
/// Doublings until a value that is no limit must be reached.
const DOUBLINGS: u32 = 20;

/// Whether something holds at a value.
type Holds<'f> = dyn FnMut(f64) -> Result<bool, Failure> + 'f;

/// Sizes one program, as long as it loses no more time than `until` (a share).
pub(super) fn find<R: Read + Seek + Send>(
    bench: &mut Bench<'_, R>,
    until: f64,
) -> Result<Outcome, Failure> {
    let no_limit = bench.scale.unlimited();
    let mut summary = bench.limit_at(no_limit)?;
    let before = std::mem::take(&mut summary.before);
    let unlimited = bench.know(no_limit, summary);
    if before.peak_w <= 0.0 && before.regen_w <= 0.0 || before.duration_s <= 0.0 {
        return Ok(Outcome::Idle);
    }
    if !unlimited.certified {
        return Ok(Outcome::Never {
            peak_w: before.peak_w,
            regen_w: before.regen_w,
            reasons: unlimited.reasons,
        });
    }
    let expected = bench.scale.expected(unlimited.peak_w);
    let enough = enough(bench, &unlimited, expected, no_limit)?;
    let least = bench.scale.least(enough);
    let longest_s = unlimited.duration_s * (1.0 + until);
    let mut certified = |value| {
        let trial = bench.at(value)?;
        Ok(trial.certified && trial.duration_s <= longest_s)
    };
    let (lowest, below) = descend(enough, least, LOWEST, &mut certified)?;
    let below = match below {
        Some(value) => Some((value, bench.at(value)?.reasons.clone())),
        None => None,
    };
    Ok(Outcome::Sized(Box::new(ProgramSize {
        duration_s: before.duration_s,
        peak_w: before.peak_w,
        regen_w: before.regen_w,
        unlimited,
        enough,
        lowest,
        below,
    })))
}

/// The smallest value from which on nothing is slowed.
fn enough<R: Read + Seek + Send>(
    bench: &mut Bench<'_, R>,
    unlimited: &Trial,
    expected: f64,
    no_limit: f64,
) -> Result<f64, Failure> {
    let scale = bench.scale;
    let mut slows_nothing = |value: f64| {
        let trial = bench.at(value)?;
        let longer_s = trial.duration_s - unlimited.duration_s;
        Ok(trial.certified
            && trial.edited_lines == unlimited.edited_lines
            && longer_s <= SAME_TIME * unlimited.duration_s)
    };
    let least = scale.least(expected);
    if slows_nothing(expected)? {
        // A peak is the whole answer, unless something else than peaks counts.
        let next = step_down(expected);
        if scale.quantity == Quantity::Rating && (next <= least || !slows_nothing(next)?) {
            return Ok(expected);
        }
        return Ok(descend(expected, least, ENOUGH, &mut slows_nothing)?.0);
    }
    let mut slows = expected;
    for _ in 0..DOUBLINGS {
        let value = round_up(2.0 * slows);
        if value >= no_limit {
            break;
        }
        if slows_nothing(value)? {
            return Ok(narrow(slows, value, ENOUGH, &mut slows_nothing)?.0);
        }
        slows = value;
    }
    Ok(no_limit)
}

/// From a value at which something holds downwards step by step, not below `least`: the
/// smallest at which it holds, and a value by at most a share of it lower at which it
/// does not, if there is any.
fn descend(
    from: f64,
    least: f64,
    share: f64,
    holds: &mut Holds<'_>,
) -> Result<(f64, Option<f64>), Failure> {
    let mut good = from;
    loop {
        let next = round_up(STEP_DOWN * good).max(least);
        if next >= good {
            return Ok((good, None));
        }
        if !holds(next)? {
            let (good, bad) = narrow(next, good, share, holds)?;
            return Ok((good, Some(bad)));
        }
        good = next;
    }
}

/// Halves the way between a value at which something does not hold and a larger one at
/// which it does, until they differ by a share: both ends, the good one first.
pub(super) fn narrow(
    bad: f64,
    good: f64,
    share: f64,
    holds: &mut Holds<'_>,
) -> Result<(f64, f64), Failure> {
    let (mut bad, mut good) = (bad, good);
    while good > bad * (1.0 + share) {
        let middle = round_up((bad * good).sqrt());
        if middle <= bad || middle >= good {
            break;
        }
        if holds(middle)? {
            good = middle;
        } else {
            bad = middle;
        }
    }
    Ok((good, bad))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The end that holds and the end that does not are a hundredth apart, and the
    /// smallest value that makes sense is not passed.
    #[test]
    fn the_smallest_value_is_found_from_above() {
        for threshold in [37.0, 123.4, 999.9] {
            let mut tried = Vec::new();
            let mut holds = |value: f64| {
                tried.push(value);
                Ok(value >= threshold)
            };
            let (good, bad) = descend(1000.0, 1.0, 0.01, &mut holds).unwrap();
            let bad = bad.unwrap();
            assert!(bad < threshold && threshold <= good, "{bad} {good}");
            assert!(good <= 1.0101 * bad, "{bad} {good}");
            assert!(tried.len() < 18, "{tried:?}");
        }
        let found = descend(1000.0, 300.0, 0.01, &mut |_| Ok(true)).unwrap();
        assert_eq!(found, (300.0, None));
    }
}
