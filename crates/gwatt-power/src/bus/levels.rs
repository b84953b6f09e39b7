//! The spindle over time in steps, for limits over time of the converter.

use super::SpindleBus;
use crate::duty_cycle::{Level, Steps};
use crate::spindle_state::Window;
use crate::spindle_trace::{SpindleSpan, SpindleTrace};

/// Steps of a run are no higher than this share of its largest power.
const STEP: f64 = 0.002;
/// Nor need they be lower than this share of what the converter supplies: a program may
/// change the speed by a little in each block (a laser's S).
const LEAST_STEP: f64 = 0.000_2;
/// Depth of halving.
const DEPTH: u32 = 12;
/// How well the time of a move is known that is planned with others, where the knobs
/// stand: what a blend takes of it, s.
const SPREAD_S: f64 = 0.5;

impl SpindleBus<'_> {
    /// What it draws at most while a move lasts, step by step: base load and
    /// cutting are in it. Where the move is planned with others its time is not
    /// known as well as a run is steep: the largest power counts throughout, and where
    /// the knobs stand, so that no lower override is meant, for [`SPREAD_S`] more on both
    /// sides.
    pub(super) fn levels(
        &self,
        window: &Window<'_>,
        (duration_s, ahead): (f64, bool),
        cutting_w: f64,
    ) -> Steps {
        // What lasts after a run.
        let target = self.states[0].target();
        let held_w = self.motor.holding_w(target);
        let level = |duration_s: f64, largest_w: f64, least_w: f64| {
            let base_w = self.spindle.base_load_w;
            let more_w = base_w + cutting_w;
            let lasting_w = held_w + more_w;
            if self.credits() {
                Level {
                    duration_s,
                    drawn_w: largest_w + more_w,
                    fed_back_w: -least_w - self.credited_w(),
                    lasting_w,
                }
            } else {
                Level {
                    duration_s,
                    drawn_w: largest_w.max(0.0) + more_w,
                    fed_back_w: (-least_w).max(0.0),
                    lasting_w,
                }
            }
        };
        match window {
            Window::Steady(power_w) => Steps::Steady(level(duration_s, *power_w, *power_w)),
            Window::Between([largest_w, least_w]) => {
                let level = level(duration_s, *largest_w, *least_w);
                Steps::Steady(Level {
                    lasting_w: level.drawn_w,
                    ..level
                })
            }
            Window::Run(trace, from_s) => {
                let to_s = from_s + duration_s;
                let whole = trace.over(*from_s, to_s);
                let stands = !self.machine.limits.counts_lower();
                if ahead && !stands || !duration_s.is_finite() {
                    return Steps::Steady(level(duration_s, whole.largest_w, whole.least_w));
                }
                let most_w = whole.largest_w.abs().max(whole.least_w.abs());
                let limit_w = self.model.limit_w(self.spindle.converter);
                let mut step_w = STEP * most_w;
                if limit_w.is_finite() {
                    step_w = step_w.max(LEAST_STEP * limit_w);
                }
                let mut levels = Vec::new();
                let mut from_s = *from_s;
                let spread_s = if ahead { SPREAD_S } else { 0.0 };
                for end_s in trace.ends(from_s, to_s) {
                    steps(
                        trace,
                        [from_s, end_s],
                        (step_w, spread_s),
                        DEPTH,
                        &mut |span, part| {
                            levels.push(level(span, part.largest_w, part.least_w));
                        },
                    );
                    from_s = end_s;
                }
                Steps::Many(levels)
            }
        }
    }
}

/// Spans of time in which the power changes by no more than a step.
fn steps(
    trace: &SpindleTrace,
    [from_s, to_s]: [f64; 2],
    (step_w, spread_s): (f64, f64),
    depth: u32,
    out: &mut impl FnMut(f64, &SpindleSpan),
) {
    let part = trace.over((from_s - spread_s).max(0.0), to_s + spread_s);
    let short = to_s - from_s < 0.25 * spread_s;
    if depth == 0 || short || part.largest_w - part.least_w <= step_w {
        out(to_s - from_s, &part);
        return;
    }
    let middle_s = f64::midpoint(from_s, to_s);
    steps(
        trace,
        [from_s, middle_s],
        (step_w, spread_s),
        depth - 1,
        out,
    );
    steps(trace, [middle_s, to_s], (step_w, spread_s), depth - 1, out);
}
