//! A run of the spindle at lower overrides of its own: between lower speeds, and over sooner.
//!
//! Input: a run from one steady speed to another in the same direction, or from or to rest,
//! at the largest override. Output: what the motor draws and feeds back at most in a span of
//! time at any override up to that.
//!
//! At the share o a run leads from `o·S₁` to `o·S₂`, with the same limits of torque and jerk:
//!
//! * at no time since the command is it faster than at the largest override;
//! * at no speed does it speed up harder than a run from rest to S₂, or brake harder than
//!   one from S₁ to rest.
//!
//! So it draws no more after t than the run from rest up to the speed that the largest
//! override gives after t; and feeds back no more than the run to rest from that speed on.
//! It may also do neither, or hold its speed.

use super::spindle_trace::{SpindleSpan, SpindleTrace};

/// Halvings in the search for an instant.
const HALVINGS: u32 = 60;

/// A run at any override of the spindle.
#[derive(Debug, Clone, Copy)]
pub(super) struct LoweredRun<'a> {
    /// At the largest override.
    pub trace: &'a SpindleTrace,
    /// From rest to the same speed, or from the same speed to rest, where the run itself
    /// neither begins nor ends there.
    pub whole: Option<&'a SpindleTrace>,
}

impl LoweredRun<'_> {
    /// Largest and smallest power between two instants, s after the command; energies are
    /// left aside.
    pub fn over(&self, from_s: f64, to_s: f64) -> SpindleSpan {
        let [start_rpm, end_rpm] = self.trace.speeds_rpm().map(f64::abs);
        let rises = end_rpm >= start_rpm;
        let whole = self.whole.unwrap_or(self.trace);
        // The first, or else the last instant at which the whole run has a speed.
        let instant = |t: f64| match self.whole {
            Some(whole) => instant_s(whole, self.trace.at(t).speed.abs(), rises),
            None => t,
        };
        let [largest_w, least_w] = if rises {
            let largest_w = whole.over(0.0, instant(to_s)).largest_w;
            [largest_w, self.trace.over(from_s, to_s).least_w]
        } else {
            let held_w = self.trace.held_w(self.trace.at(from_s).speed);
            [held_w, whole.over(instant(from_s), f64::INFINITY).least_w]
        };
        let mut span = SpindleSpan::steady(0.0, 0.0);
        span.largest_w = largest_w.max(0.0);
        span.least_w = least_w.min(0.0);
        span
    }
}

/// When a run from or to rest has a speed, 1/min without its sign: no earlier while it
/// rises, no later while it falls.
fn instant_s(whole: &SpindleTrace, speed_rpm: f64, rises: bool) -> f64 {
    let mut between_s = [0.0, whole.duration_s()];
    for _ in 0..HALVINGS {
        let middle_s = f64::midpoint(between_s[0], between_s[1]);
        let reached = whole.at(middle_s).speed.abs() >= speed_rpm;
        between_s[usize::from(reached == rises)] = middle_s;
    }
    between_s[usize::from(rises)]
}
