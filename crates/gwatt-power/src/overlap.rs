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

use super::arc_circle::Circle;
use super::demand::Want;
use super::model::{ConverterPower, PowerModel};
use super::spindle_trace::{SpindleSpan, SpindleTrace};
use super::trace::{Flow, Slice};
use super::{arc, independent, straight};
use gwatt_machine::AxisSet;
use gwatt_motion::Move;
use gwatt_plan::{Plan, Profile, Trajectory};

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
        let axes = Axes::new(model, converter, mv, plan, side);
        let sum = Sum {
            axes,
            trace,
            from_s,
        };
        sum.largest()
    })
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Side {
    Drawn,
    FedBack,
}

/// What the axes of a converter ask for during a planned move, on one side.
pub(super) struct Axes<'a> {
    model: &'a PowerModel,
    converter: &'a ConverterPower,
    mv: &'a Move,
    plan: &'a Plan,
    side: Side,
    /// Power over time, negative where they give more than is drawn.
    slices: Option<Vec<Slice>>,
}

struct Sum<'a> {
    axes: Axes<'a>,
    trace: &'a SpindleTrace,
    from_s: f64,
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
    fn largest(&self) -> f64 {
        let duration_s = self.axes.plan.duration_s;
        let own = self.trace.instants().map(|t| t - self.from_s);
        let mut ends: Vec<f64> = own.filter(|t| *t > 0.0 && *t < duration_s).collect();
        ends.push(duration_s);
        let mut stack: Vec<Node> = Vec::with_capacity(DEPTH + ends.len());
        let mut from = 0.0;
        let mut best = f64::NEG_INFINITY;
        for to in ends {
            let node = self.node(from, to);
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
            let mut halves = halves.map(|(from, to)| self.node(from, to));
            halves.sort_by(|a, b| a.most.total_cmp(&b.most));
            for half in halves {
                best = best.max(half.least);
                stack.push(half);
            }
        }
        upper.max(best)
    }

    fn node(&self, from: f64, to: f64) -> Node {
        let side = self.axes.side;
        let axes = self.axes.power_w(from, to);
        let span = self.trace.over(self.from_s + from, self.from_s + to);
        let [low, high] = side.of(&span, self.axes.converter);
        let floor = if side == Side::FedBack { 0.0 } else { f64::MIN };
        Node {
            from,
            to,
            least: (axes + low).max(floor),
            most: (axes + high).max(floor),
        }
    }
}

impl Side {
    /// The least and the largest power of the spindle on this side of its converter, W.
    pub fn of(self, span: &SpindleSpan, converter: &ConverterPower) -> [f64; 2] {
        let SpindleSpan {
            largest_w, least_w, ..
        } = *span;
        let powers = match self {
            Self::Drawn => [least_w, largest_w],
            Self::FedBack => [-largest_w, -least_w],
        };
        if converter.credit_regen {
            powers
        } else {
            powers.map(|power_w| power_w.max(0.0))
        }
    }

    pub fn flow(self) -> Flow {
        match self {
            Self::Drawn => Flow::Drawn,
            Self::FedBack => Flow::FedBack,
        }
    }
}

impl<'a> Axes<'a> {
    pub fn new(
        model: &'a PowerModel,
        converter: &'a ConverterPower,
        mv: &'a Move,
        plan: &'a Plan,
        side: Side,
    ) -> Self {
        // Without credit no axis takes anything off, and arcs have no exact slices.
        let signed = converter.credit_regen && mv.arc.is_none();
        let slices = signed.then(|| model.slices(converter, mv, plan, side.flow()));
        Self {
            model,
            converter,
            mv,
            plan,
            side,
            slices,
        }
    }

    /// Their largest power in a span of time, with the converter's own load, W.
    pub fn power_w(&self, from: f64, to: f64) -> f64 {
        let side = self.side;
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
                    Some(arc) => {
                        let circle = Circle::new(self.model, converter, mv, arc, idle_w);
                        arc::totals(&circle, &part, want)
                    }
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
