//! Paths that turn, run more slowly.
//!
//! On a line each state of a lower override is one of the largest, but for what `pace`
//! and `cruise` look at. Where a path turns, each place is passed with another force at
//! each speed: what turning takes grows with v², so that a heavy axis that it brakes may
//! draw most, and a light one feed back most, at some speed between. Over the speeds v of
//! a place the power is `A·v + B·v³`; the ladder is so narrow that a peak between two of
//! its rungs lies less than 0.6 % above them.

use super::demand::Demand;

/// How many lower speeds are looked at, and by what share they differ; far below the
/// largest, where limits of jerk alone matter, every third of them.
const RUNGS: i32 = 24;
pub(super) const RUNG_RATIO: f64 = 0.92;
const FAR_RUNGS: i32 = 27;
const FAR: i32 = 3;
/// Speeds nearer to the largest are not looked at.
const NEAREST: f64 = 0.96;
/// The least that a share of a speed may be here.
pub(super) const LEAST: f64 = 1e-3;
/// A share of the largest speed that is hardly less.
pub(super) const JUST_BELOW: f64 = 1.0 - 1e-6;
/// What may lie between two of them.
pub(super) const BETWEEN: f64 = 1.01;

/// Speeds below `top_mm_s` at which a path that turns is looked at. They are the same for
/// every path, so that what a lower top leaves out is nothing but what lies above it.
pub(super) fn speeds_mm_s(top_mm_s: f64) -> impl Iterator<Item = f64> {
    let known = top_mm_s > 0.0 && top_mm_s < f64::INFINITY;
    let exponent = libm::log(NEAREST * top_mm_s) / libm::log(RUNG_RATIO);
    let first = if known {
        libm::ceil(exponent) as i32
    } else {
        0
    };
    let near = first..first.saturating_add(RUNGS);
    let far = (near.end..near.end.saturating_add(FAR_RUNGS)).filter(|rung| rung % FAR == 0);
    let rungs = near.chain(far).filter(move |_| known);
    rungs.map(|rung| libm::pow(RUNG_RATIO, f64::from(rung)))
}

impl Demand {
    /// Includes the largest demand at all [`speeds_mm_s`], with what may lie between.
    pub(super) fn include_slower(&mut self, mut slower: Self) {
        let near = |slower: f64, own: f64| {
            if slower * BETWEEN <= own {
                own
            } else {
                slower * BETWEEN
            }
        };
        slower.peak_w = near(slower.peak_w, self.peak_w);
        slower.regen_w = near(slower.regen_w, self.regen_w);
        slower.load_ratio = near(slower.load_ratio, self.load_ratio);
        self.include(&slower);
    }
}
