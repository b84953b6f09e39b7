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
/// largest, where limits of jerk alone matter, by more.
const RUNGS: i32 = 24;
const RUNG_RATIO: f64 = 0.92;
const FAR_RUNGS: i32 = 8;
const FAR_RATIO: f64 = 0.75;
/// The least that a share of a speed may be here.
pub(super) const LEAST: f64 = 1e-3;
/// What may lie between two of them.
const BETWEEN: f64 = 1.01;

/// Shares of a speed at which a path that turns is looked at.
pub(super) fn shares() -> impl Iterator<Item = f64> {
    let power = |ratio: f64, rung: i32| libm::pow(ratio, f64::from(rung));
    let far = (1..=FAR_RUNGS).map(move |rung| power(FAR_RATIO, rung) * power(RUNG_RATIO, RUNGS));
    (1..=RUNGS)
        .map(move |rung| power(RUNG_RATIO, rung))
        .chain(far)
}

impl Demand {
    /// Includes the largest demand of all [`shares`], with what may lie between.
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
