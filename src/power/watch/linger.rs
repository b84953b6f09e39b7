//! Cruises at lower overrides: for how long a move may lie above a power.
//!
//! Input: a move and its speed at the largest overrides. Output: seconds. At a speed
//! v ≤ V the power of a cruise is at most the chord `P₀ + (P_V − P₀)·v/V`, since it is
//! convex in v; where that is above the power in question a path of length L takes
//! no longer than L/v. Ramps last less long at lower overrides.

use crate::interpret::Move;
use crate::plan::Plan;
use crate::power::demand::Want;
use crate::power::model::PowerModel;

/// What stands for a speed of next to nothing, as a share.
const SLOW: f64 = 1e-6;

/// For how long at most a move lies above `above_w` in a cruise of up to `speed_mm_s`, s.
pub(super) fn lingers_s(
    model: &PowerModel,
    converter: usize,
    mv: &Move,
    speed_mm_s: f64,
    above_w: f64,
) -> f64 {
    let powers = [SLOW, 1.0].map(|share| {
        let cruise = Plan::cruise(speed_mm_s * share, mv.length_mm);
        model.peak_w(converter, mv, &cruise, Want::PEAKS)
    });
    let [rest_w, top_w] = powers;
    if top_w <= above_w {
        return 0.0;
    }
    if rest_w >= above_w {
        return f64::INFINITY;
    }
    mv.length_mm / speed_mm_s * (top_w - rest_w) / (above_w - rest_w)
}
