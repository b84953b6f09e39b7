//! All programs together, step by step.

use std::io::{Read, Seek};

use super::scale::{Scale, round_up};
use super::search::narrow;
use super::trial::{Bench, Trial, at_all};
use super::{Curve, Failure, ProgramSize, Rung, Wish};

/// How near the value for a wished loss is found, as a share.
const NEAR: f64 = 0.005;
/// Rounding of a loss.
const ROUNDING: f64 = 1e-9;

/// The curve of the programs that can be sized; `None` where there are none.
pub(super) fn curve<R: Read + Seek + Send>(
    sized: Vec<(ProgramSize, Bench<'_, R>)>,
    scale: &Scale<'_>,
    wish: &Wish,
) -> Result<Option<Curve>, Failure> {
    let (sizes, benches): (Vec<_>, Vec<_>) = sized.into_iter().unzip();
    if sizes.is_empty() {
        return Ok(None);
    }
    let largest = |of: fn(&ProgramSize) -> f64| sizes.iter().map(of).fold(0.0, f64::max);
    let (enough, lowest) = (largest(|size| size.enough), largest(|size| size.lowest));
    let duration_s = sizes.iter().map(|size| size.unlimited.duration_s).sum();
    let mut all = Together {
        benches,
        scale,
        threads: wish.threads,
        duration_s,
    };
    let mut values = steps(lowest, enough, wish.steps);
    values.push(scale.own());
    let mut ladder = all.at(&values)?;
    let own = ladder.pop().unwrap_or_default();
    let mut losses = Vec::new();
    for &loss in &wish.losses {
        losses.push((loss, all.for_loss(loss, &ladder)?));
    }
    Ok(Some(Curve {
        duration_s,
        enough,
        lowest,
        ladder,
        own,
        losses,
    }))
}

/// Values by equal factors from one to another, both included.
fn steps(lowest: f64, enough: f64, count: usize) -> Vec<f64> {
    let last = count.saturating_sub(1).max(1);
    let mut values: Vec<f64> = (0..=last)
        .map(|index| match index {
            0 => lowest,
            _ if index == last => enough,
            _ => round_up(lowest * libm::pow(enough / lowest, index as f64 / last as f64)),
        })
        .collect();
    values.dedup();
    values
}

/// The programs that are sized.
struct Together<'a, R> {
    benches: Vec<Bench<'a, R>>,
    scale: &'a Scale<'a>,
    threads: usize,
    duration_s: f64,
}

impl<R: Read + Seek + Send> Together<'_, R> {
    fn at(&mut self, values: &[f64]) -> Result<Vec<Rung>, Failure> {
        let trials = at_all(&mut self.benches, values, self.threads)?;
        let rungs = values.iter().zip(trials);
        Ok(rungs
            .map(|(&value, trials)| self.rung(value, trials))
            .collect())
    }

    fn rung(&self, value: f64, trials: Vec<Trial>) -> Rung {
        let total = Trial::together(trials.iter());
        let converter = self.scale.converter_at(value);
        let ratings = converter.as_ref().map(|it| &it.ratings);
        Rung {
            value,
            peak_power_w: converter.as_ref().map_or(0.0, |it| it.peak_power_w),
            continuous_power_w: ratings.and_then(|it| Some(it.continuous?.power_w)),
            regen_power_w: converter.as_ref().and_then(|it| it.regen_power_w),
            capacitance_f: ratings.and_then(|it| Some(it.capacitor?.capacitance_f)),
            loss: (total.duration_s / self.duration_s - 1.0).max(0.0),
            trials,
            total,
        }
    }

    /// The smallest value, to half a percent, at which all are certified and lose no
    /// more than this. The ladder ends where nothing is lost.
    fn for_loss(&mut self, loss: f64, ladder: &[Rung]) -> Result<Rung, Failure> {
        let within = |rung: &Rung| rung.total.certified && rung.loss <= loss + ROUNDING;
        let from_above = ladder.iter().rev();
        let kept = from_above.take_while(|rung| within(rung)).count();
        let at = |index: usize| ladder.get(index).map_or(0.0, |rung| rung.value);
        let first = ladder.len() - kept.max(1);
        let mut value = at(first);
        if first > 0 {
            let bad = at(first - 1);
            let mut holds = |value: f64| {
                let rungs = self.at(&[value])?;
                Ok(rungs.first().is_some_and(within))
            };
            value = narrow(bad, value, NEAR, &mut holds)?.0;
        }
        let mut rungs = self.at(&[value])?;
        Ok(rungs.pop().unwrap_or_default())
    }
}
