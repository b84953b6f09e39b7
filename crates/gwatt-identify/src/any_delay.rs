//! Delays between the steps that a search tries.

use super::certainty;
use super::estimate::Estimate;
use super::output_error::{Effort, Fitting};

/// The delay set free, if that is clearly worth a parameter: next to a fast zero
/// and a fast pole it makes all of them uncertain.
#[must_use]
pub fn any_delay(fitting: &Fitting<'_>, t: f64, best: Estimate) -> Timed {
    let mut alone_s = 0.0;
    for part in [0.3, -0.3] {
        let mut start = best.transfer.clone();
        start.delay_s += part * t;
        if start.delay_s < 0.0 {
            continue;
        }
        if let Some(found) = fitting.refine(&start, true, Effort::FULL) {
            if found.criterion() < best.criterion() - certainty::PART_OF_PERIOD {
                return Timed::free(found);
            }
            let apart = found.transfer.delay_s - best.transfer.delay_s;
            let std = found.std(found.count - 1).unwrap_or(0.0);
            if apart.abs() < t && found.likelihood() < best.likelihood() + 2.0 {
                alone_s = f64::max(alone_s, std.min(t));
            }
        }
    }
    Timed {
        found: best,
        is_free: false,
        alone_s,
    }
}

/// A model with its delay.
pub struct Timed {
    /// The model.
    pub found: Estimate,
    /// Whether the delay was fitted.
    pub is_free: bool,
    /// How uncertain it would be where it was not, s.
    pub alone_s: f64,
}

impl Timed {
    /// With the delay that it has.
    #[must_use]
    pub fn as_it_is(found: Estimate) -> Self {
        Self {
            found,
            is_free: false,
            alone_s: 0.0,
        }
    }

    /// With a delay that was fitted.
    fn free(found: Estimate) -> Self {
        Self {
            found,
            is_free: true,
            alone_s: 0.0,
        }
    }
}

/// A model with the whole periods of delay that suit it best, or any delay where that
/// is clearly better.
#[must_use]
pub fn timed(fitting: &Fitting<'_>, t: f64, found: Estimate) -> Timed {
    const SAME: f64 = 1e-6;
    let periods = found.transfer.delay_s / t;
    let below = libm::floor(periods + SAME);
    if periods - below < 2.0 * SAME {
        return any_delay(fitting, t, found);
    }
    let whole = [below, below + 1.0].into_iter().filter_map(|periods| {
        let mut start = found.transfer.clone();
        start.delay_s = periods * t;
        fitting.refine(&start, false, Effort::FULL)
    });
    let whole = whole.min_by(|a, b| a.criterion().total_cmp(&b.criterion()));
    let free = fitting.refine(&found.transfer, true, Effort::FULL);
    let is_clear = |free: &Estimate| {
        whole
            .as_ref()
            .is_none_or(|whole| free.criterion() < whole.criterion() - certainty::PART_OF_PERIOD)
    };
    match (free.filter(is_clear), whole) {
        (Some(found), _) => Timed::free(found),
        (None, whole) => any_delay(fitting, t, whole.unwrap_or(found)),
    }
}
