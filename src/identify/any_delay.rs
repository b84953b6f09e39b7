//! Delays between the steps that a search tries.

use super::ladder::Fit;
use super::output_error::{Effort, Estimate, Fitting};
use super::transfer::TransferFunction;

/// By how much a delay between samples has to be better than one of whole
/// periods.
const CLEAR_DELAY: f64 = 10.0;

/// The delay set free, if that is clearly worth a parameter: beside a fast zero
/// and a fast pole it makes all of them uncertain. Where it stays as it was, also
/// how uncertain it would be, s.
pub fn any_delay(fit: &Fit<'_>, t: f64, best: Estimate) -> (Estimate, bool, f64) {
    let mut alone_s = 0.0;
    for part in [0.3, -0.3] {
        let mut start = best.transfer.clone();
        start.delay_s += part * t;
        if start.delay_s < 0.0 {
            continue;
        }
        if let Some(found) = fit(&start, true, Effort::FULL) {
            if found.criterion() < best.criterion() - CLEAR_DELAY {
                return (found, true, 0.0);
            }
            let apart = found.transfer.delay_s - best.transfer.delay_s;
            let std = found.std(found.count - 1).unwrap_or(0.0);
            if apart.abs() < t && found.likelihood() < best.likelihood() + 2.0 {
                alone_s = f64::max(alone_s, std.min(t));
            }
        }
    }
    (best, false, alone_s)
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

/// A model with the whole periods of delay that suit it best, or any delay where that
/// is clearly better.
#[must_use]
pub fn timed(fitting: &Fitting<'_>, t: f64, found: Estimate) -> Timed {
    const SAME: f64 = 1e-6;
    let fit = |start: &TransferFunction, delay_is_free: bool, effort: Effort| {
        fitting.refine(start, delay_is_free, effort)
    };
    let periods = found.transfer.delay_s / t;
    let below = libm::floor(periods + SAME);
    if periods - below < 2.0 * SAME {
        let (found, is_free, alone_s) = any_delay(&fit, t, found);
        return Timed {
            found,
            is_free,
            alone_s,
        };
    }
    let whole = [below, below + 1.0].into_iter().filter_map(|periods| {
        let mut start = found.transfer.clone();
        start.delay_s = periods * t;
        fit(&start, false, Effort::FULL)
    });
    let whole = whole.min_by(|a, b| a.criterion().total_cmp(&b.criterion()));
    let free = fit(&found.transfer, true, Effort::FULL);
    let is_clear = |free: &Estimate| {
        whole
            .as_ref()
            .is_none_or(|whole| free.criterion() < whole.criterion() - CLEAR_DELAY)
    };
    match (free.filter(is_clear), whole) {
        (Some(found), _) => Timed {
            found,
            is_free: true,
            alone_s: 0.0,
        },
        (None, whole) => {
            let (found, is_free, alone_s) = any_delay(&fit, t, whole.unwrap_or(found));
            Timed {
                found,
                is_free,
                alone_s,
            }
        }
    }
}
