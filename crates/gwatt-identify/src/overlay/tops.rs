//! By which factor each peak exceeds its prediction, from all samples around its top.
//!
//! A sample rarely meets the top of a ramp: next to the largest power that is predicted near it, it
//! reads the peak too low. So the samples around a top are fitted by the prediction, moved a
//! little in time and multiplied. With x the prediction at the samples of a window, moved by ε, and
//! y what is measured, the factor is Σxy/Σx², and ε that with the least sum of squares left; the
//! error is that of least squares for both together.

use super::align::Place;
use super::curve::Curve;
use super::meter::{SLACK, shown};
use super::trace::PowerTrace;
use crate::peak_factor::HALF;

/// Samples on each side of a top, and how long they take at least, s, as far as so many do.
const SIDE: usize = 8;
const SIDE_S: f64 = 0.03;
const SIDE_MAX: usize = 60;
/// Share of the least power of a peak that a sample of its top has at least.
const MISSED: f64 = 0.75;
/// Samples that a peak must have above a quarter of its top.
const SAMPLES: usize = 3;
/// Tops that are looked at, the largest first.
const TOPS_MAX: usize = 20_000;
/// Errors that are stated, in standard deviations.
pub(super) const STATED: f64 = 2.0;
/// The largest error of a factor with which it counts.
const ERROR_MAX: f64 = 0.1;
/// Steps of ε, in samples: the first one, and the last one of those that follow.
const COARSE: f64 = 0.25;
const FINE: f64 = 1.0 / 64.0;
/// The least slack, and the largest error of an ε that makes it, in samples.
const SLACK_MIN: f64 = 0.25;
const SHIFT_ERROR_MAX: f64 = 0.5;

/// What is predicted, and the part of it that a factor multiplies: all of it, or that of the
/// acceleration.
pub(super) struct Model<'a> {
    pub(super) curve: &'a Curve,
    pub(super) part: Option<&'a Curve>,
    pub(super) place: Place,
    pub(super) width_s: f64,
}

impl Model<'_> {
    /// What is multiplied, and what is added to it, at times that ascend.
    pub(super) fn at(&self, times_s: &[f64], shift_s: f64) -> (Vec<f64>, Vec<f64>) {
        let moved = Place {
            start_s: self.place.start_s + shift_s,
            end_s: self.place.end_s + shift_s,
            ..self.place
        };
        let of = |curve| shown(curve, times_s, moved, self.width_s);
        let whole = of(self.curve);
        if let Some(part) = self.part.map(of) {
            let fixed = whole.iter().zip(&part).map(|(w, part)| w - part).collect();
            (part, fixed)
        } else {
            let fixed = vec![0.0; whole.len()];
            (whole, fixed)
        }
    }
}

/// The factor of one top.
#[derive(Debug, Clone, Copy)]
pub(super) struct Top {
    /// The sample that is nearest to it.
    pub(super) sample: usize,
    pub(super) factor: f64,
    /// That of the factor, as it is stated.
    pub(super) error: f64,
    /// By how much later than predicted it comes, s.
    shift_s: f64,
    shift_error_s: f64,
}

/// The factors of all tops that have enough samples.
pub(super) struct Tops {
    /// In order of their samples.
    pub(super) found: Vec<Top>,
    /// What the samples scatter by around them, W.
    pub(super) scatter_w: f64,
    /// Whether all tops were looked at.
    pub(super) is_whole: bool,
}

impl Tops {
    /// By how much measured and predicted power may differ in time, in samples: as much as tops
    /// do.
    pub(super) fn slack(&self, step_s: f64) -> f64 {
        let sure = |it: &&Top| it.shift_error_s <= SHIFT_ERROR_MAX * step_s;
        let shifts = self.found.iter().filter(sure).map(|it| it.shift_s / step_s);
        let (count, square) =
            shifts.fold((0.0, 0.0), |(n, square), it| (n + 1.0, square + it * it));
        if count > 0.0 {
            (SLACK_MIN + 2.0 * f64::sqrt(square / count)).min(SLACK)
        } else {
            SLACK
        }
    }
}

/// One window, fitted; its errors are those of a scatter of 1 W.
struct Fit {
    top: Top,
    rest: f64,
    freedom: f64,
}

/// Finds them where the prediction is above half of `peak_w`.
pub(super) fn tops(
    model: &Model<'_>,
    log: &PowerTrace,
    measured_w: &[f64],
    (predicted_w, peak_w): (&[f64], f64),
) -> Tops {
    let inside = |t: f64| t >= model.place.start_s && t <= model.place.end_s;
    let value = |k: usize| predicted_w.get(k).copied().unwrap_or(f64::NEG_INFINITY);
    let samples = log.time_s.iter().enumerate();
    let high =
        samples.filter(|(k, t)| inside(**t) && value(*k) >= MISSED * HALF * peak_w && peak_w > 0.0);
    let mut high: Vec<usize> = high.map(|(k, _)| k).collect();
    high.sort_by(|a, b| value(*b).total_cmp(&value(*a)));
    let step_s = log.step_s();
    let side = ((SIDE_S / step_s) as usize).clamp(SIDE, SIDE_MAX);
    let mut is_taken = vec![false; log.time_s.len()];
    let (mut fits, mut looked_at) = (Vec::new(), 0);
    let mut is_whole = true;
    for top in high {
        if is_taken.get(top).is_none_or(|taken| *taken) {
            continue;
        }
        if looked_at == TOPS_MAX {
            is_whole = false;
            break;
        }
        looked_at += 1;
        let free = |k: &usize| is_taken.get(*k).is_some_and(|taken| !taken);
        let before = (top.saturating_sub(side)..top).rev().take_while(free);
        let from = before.last().unwrap_or(top);
        let after = (top..=top + side).take_while(free);
        let to = after.last().map_or(top, |last| last + 1);
        for taken in is_taken.iter_mut().take(to).skip(from) {
            *taken = true;
        }
        // The flank of a higher one is no top.
        let before = from.checked_sub(1).map_or(f64::NEG_INFINITY, value);
        if before.max(value(to)) > value(top) {
            continue;
        }
        fits.extend(fitted(model, log, (measured_w, step_s), (from, top, to)));
    }
    let (rest, freedom) = fits
        .iter()
        .fold((0.0, 0.0), |(a, b), it: &Fit| (a + it.rest, b + it.freedom));
    let scatter_w = f64::sqrt(rest / f64::max(freedom, 1.0));
    let stated = fits.into_iter().map(|it| Top {
        error: STATED * scatter_w * it.top.error,
        shift_error_s: STATED * scatter_w * it.top.shift_error_s,
        ..it.top
    });
    let mut found: Vec<Top> = stated.filter(|it| it.error <= ERROR_MAX).collect();
    found.sort_by_key(|it| it.sample);
    Tops {
        found,
        scatter_w,
        is_whole,
    }
}

/// Fits the samples of a window; `None` where there are too few of its peak.
fn fitted(
    model: &Model<'_>,
    log: &PowerTrace,
    (measured_w, step_s): (&[f64], f64),
    (from, top, to): (usize, usize, usize),
) -> Option<Fit> {
    let known = (from..to).filter(|k| measured_w.get(*k).is_some_and(|w| !w.is_nan()));
    let rows = known.filter_map(|k| Some((*log.time_s.get(k)?, *measured_w.get(k)?)));
    let (times_s, measured_w): (Vec<f64>, Vec<f64>) = rows.unzip();
    let at = |shift: f64| {
        let (x, fixed) = model.at(&times_s, shift * step_s);
        let pairs = || x.iter().zip(measured_w.iter().zip(&fixed));
        let square: f64 = x.iter().map(|x| x * x).sum();
        let both: f64 = pairs().map(|(x, (y, fixed))| x * (y - fixed)).sum();
        let factor = both / square;
        let rest = pairs().map(|(x, (y, fixed))| y - fixed - factor * x);
        let rest: f64 = rest.map(|it| it * it).sum();
        (rest, factor, shift)
    };
    let better = |best: (f64, f64, f64), it: (f64, f64, f64)| if it.0 < best.0 { it } else { best };
    let most = (SLACK / COARSE) as i32;
    let mut best = (1..=most).fold(at(0.0), |best, k| {
        let shift = f64::from(k) * COARSE;
        better(better(best, at(shift)), at(-shift))
    });
    let mut step = COARSE / 2.0;
    while step >= FINE {
        let middle = best.2;
        best = better(better(best, at(middle - step)), at(middle + step));
        step /= 2.0;
    }
    let (rest, factor, shift) = best;
    let (x, _) = model.at(&times_s, shift * step_s);
    let x_max = x.iter().copied().fold(0.0, f64::max);
    if !factor.is_finite() || x.iter().filter(|x| **x >= x_max / 4.0).count() < SAMPLES {
        return None;
    }
    // How all of it changes with ε, by samples.
    let moved = |shift: f64| {
        let (x, fixed) = model.at(&times_s, shift * step_s);
        let pairs = x.into_iter().zip(fixed);
        pairs.map(|(x, fixed)| factor * x + fixed).collect()
    };
    let (early, late): (Vec<f64>, Vec<f64>) = (moved(shift - FINE), moved(shift + FINE));
    let change = early.iter().zip(&late).map(|(a, b)| (b - a) / (2.0 * FINE));
    let (mut xx, mut xd, mut dd) = (0.0, 0.0, 0.0);
    for (x, d) in x.iter().zip(change) {
        xx += x * x;
        xd += x * d;
        dd += d * d;
    }
    let left = xx * dd - xd * xd;
    let (error, shift_error) = if left > 1e-9 * xx * xx {
        (f64::sqrt(dd / left), f64::sqrt(xx / left))
    } else {
        (f64::sqrt(1.0 / xx), f64::INFINITY)
    };
    Some(Fit {
        top: Top {
            sample: top,
            factor,
            error,
            shift_s: shift * step_s,
            shift_error_s: shift_error * step_s,
        },
        rest,
        freedom: x.len() as f64 - 2.0,
    })
}
