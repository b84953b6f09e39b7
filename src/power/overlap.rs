//! Axes and spindle together: the peaks of a move during a run of the spindle.
//!
//! Input: a planned move, and a run with the time since its command when the
//! move begins. Output: peak and regenerative peak of one converter, never too
//! low and within [`TOLERANCE`].
//!
//! Over any span of time the sum is at most the largest power of the axes plus
//! the largest of the spindle, and somewhere at least the largest of the axes
//! plus the smallest of the spindle: branch and bound over the time, where both
//! figures of both are exact.

use super::demand::Want;
use super::model::{ConverterPower, PowerModel};
use super::spindle_trace::{SpindleSpan, SpindleTrace};
use super::trace::{Flow, Slice};
use super::{arc, independent, straight};
use crate::interpret::Move;
use crate::machine::AxisSet;
use crate::plan::{Plan, Profile, Trajectory};

/// How far the result may lie above the largest power, relative.
const TOLERANCE: f64 = 1e-7;
/// Spans that are looked at; then the tolerance is what is left.
const BUDGET: u32 = 4000;
/// Depth of halving.
const DEPTH: usize = 48;

/// Largest power drawn and fed back of axes and spindle, W; the spindle without
/// its base load, the converter with its own.
pub(super) fn peaks(
    model: &PowerModel,
    converter: &ConverterPower,
    mv: &Move,
    plan: &Plan,
    (trace, from_s): (&SpindleTrace, f64),
) -> [f64; 2] {
    [Side::Drawn, Side::FedBack].map(|side| {
        let flow = match side {
            Side::Drawn => Flow::Drawn,
            Side::FedBack => Flow::FedBack,
        };
        // Without credit no axis takes anything off, and arcs have no exact slices.
        let signed = converter.credit_regen && mv.arc.is_none();
        let slices = signed.then(|| model.slices(converter, mv, plan, flow));
        let sum = Sum {
            model,
            converter,
            mv,
            plan,
            trace,
            from_s,
            slices,
        };
        sum.largest(side)
    })
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Side {
    Drawn,
    FedBack,
}

struct Sum<'a> {
    model: &'a PowerModel,
    converter: &'a ConverterPower,
    mv: &'a Move,
    plan: &'a Plan,
    trace: &'a SpindleTrace,
    from_s: f64,
    /// Power of the axes over time, negative where they give more than is drawn.
    slices: Option<Vec<Slice>>,
}

/// A span of time and what the sum reaches in it, at least and at most.
#[derive(Debug, Clone, Copy)]
struct Node {
    from: f64,
    to: f64,
    least: f64,
    most: f64,
}

impl Sum<'_> {
    fn largest(&self, side: Side) -> f64 {
        let duration_s = self.plan.duration_s;
        let own = self.trace.instants().map(|t| t - self.from_s);
        let mut ends: Vec<f64> = own.filter(|t| *t > 0.0 && *t < duration_s).collect();
        ends.push(duration_s);
        let mut stack: Vec<Node> = Vec::with_capacity(DEPTH + ends.len());
        let mut from = 0.0;
        let mut best = f64::NEG_INFINITY;
        for to in ends {
            let node = self.node(side, from, to);
            best = best.max(node.least);
            stack.push(node);
            from = to;
        }
        let mut upper = best;
        let mut budget = BUDGET;
        while let Some(node) = stack.pop() {
            let target = best + TOLERANCE * best.abs();
            let middle = f64::midpoint(node.from, node.to);
            let divisible = node.from < middle && middle < node.to && budget > 0;
            if node.most <= target || !divisible {
                upper = super::demand::larger(upper, node.most);
                continue;
            }
            budget -= 1;
            let halves = [(node.from, middle), (middle, node.to)];
            let mut halves = halves.map(|(from, to)| self.node(side, from, to));
            halves.sort_by(|a, b| a.most.total_cmp(&b.most));
            for half in halves {
                best = best.max(half.least);
                stack.push(half);
            }
        }
        upper.max(best)
    }

    fn node(&self, side: Side, from: f64, to: f64) -> Node {
        let axes = self.axes(side, from, to);
        let SpindleSpan {
            largest_w, least_w, ..
        } = self.trace.over(self.from_s + from, self.from_s + to);
        let [mut low, mut high] = match side {
            Side::Drawn => [least_w, largest_w],
            Side::FedBack => [-largest_w, -least_w],
        };
        if !self.converter.credit_regen {
            (low, high) = (low.max(0.0), high.max(0.0));
        }
        let floor = if side == Side::FedBack { 0.0 } else { f64::MIN };
        Node {
            from,
            to,
            least: (axes + low).max(floor),
            most: (axes + high).max(floor),
        }
    }

    /// The largest power of the axes and the converter's own load in a span.
    fn axes(&self, side: Side, from: f64, to: f64) -> f64 {
        if let Some(slices) = &self.slices {
            return largest_between(slices, from, to);
        }
        let (converter, mv) = (self.converter, self.mv);
        let moving = AxisSet(mv.moving.0 & converter.axes.0);
        let idle_w = match &self.plan.trajectory {
            Trajectory::Path(_) | Trajectory::Axes(_) => {
                converter.idle_w(mv, &self.model.axes, moving)
            }
            Trajectory::Rest | Trajectory::Unknown(_) => {
                converter.idle_w(mv, &self.model.axes, AxisSet::default())
            }
        };
        let want = Want::PEAKS;
        let totals = match &self.plan.trajectory {
            Trajectory::Path(profile) => {
                let part = profile.part(from, to);
                match &mv.arc {
                    Some(arc) => arc::totals(self.model, converter, mv, arc, &part, idle_w, want),
                    None => straight::totals(self.model, converter, mv, &part, idle_w, want),
                }
            }
            Trajectory::Axes(profiles) => {
                let parts: Vec<(usize, Profile)> = profiles
                    .iter()
                    .map(|(axis, profile)| (*axis, profile.part(from, to)))
                    .collect();
                independent::totals(self.model, converter, mv, &parts, idle_w, want)
            }
            Trajectory::Rest | Trajectory::Unknown(_) => {
                return match side {
                    Side::Drawn => idle_w,
                    Side::FedBack if converter.credit_regen => -idle_w,
                    Side::FedBack => 0.0,
                };
            }
        };
        match side {
            Side::Drawn => totals.peak_w,
            Side::FedBack => totals.regen_w,
        }
    }
}

/// The largest power between two instants.
fn largest_between(slices: &[Slice], from: f64, to: f64) -> f64 {
    let mut largest = f64::NEG_INFINITY;
    let mut start = 0.0;
    for (index, slice) in slices.iter().enumerate() {
        let end = start + slice.duration_s;
        // Rounding: the last slice lasts to the end.
        let last = index + 1 == slices.len();
        if start <= to && (end >= from || last) {
            let [from, to] = [from, to].map(|t| (t - start).clamp(0.0, slice.duration_s));
            let part = slice.part(slice.at(from), slice.at(to));
            largest = super::demand::larger(largest, part.peak_w());
        }
        start = end;
    }
    largest
}
