//! Steps of speed where a controller passes corners without stopping.
//!
//! At a joint that is passed at the speed v each axis is commanded a step of
//! `Δv = v·(u₂ − u₁)`, in no time. The drives follow it in a time of their own, the
//! response time τ of the machine file: what they make of the commanded speed is
//! its mean over τ,
//!
//! ```text
//! w(t) = (x(t) − x(t − τ))/τ,    w'(t) = (v(t) − v(t − τ))/τ
//! ```
//!
//! in which the steps within τ add up by their signs, and the acceleration along
//! the path counts with its share. A slower drive takes a longer mean. Where the
//! steps lie further apart than τ a mean that just reaches from one to another may
//! ask for more than that over τ: these are looked at too, up to 2·τ; one over a
//! longer time has no more acceleration than one of its parts.
//!
//! `LinuxCNC` takes what a step at a joint asks of an axis from its acceleration along the path,
//! and its commands pass a spline: τ is that of two servo cycles. Between such joints arcs and
//! blends turn as they do.
//!
//! Input: the planned motion as [`Span`]s in the order of time. Output: the largest
//! power of these means where there is a step within. It comes on top of what the
//! plan itself asks for, which has no steps.

mod energy;
mod peaks;
mod placed;
mod slowed;
mod spans;
mod surged;
mod windows;

pub(super) use energy::{StepEnergy, velocity};
pub(super) use placed::{Beyond, Span};
use placed::{Placed, Surged};
pub(super) use spans::{Heading, close_spans, spans};

use peaks::at_most_w;

use super::demand::{Want, larger};
use super::model::{ConverterPower, PowerModel};
use arrayvec::ArrayVec;
use gwatt_machine::{AXES, AxisSet, AxisValues};
use gwatt_motion::Move;
use std::collections::VecDeque;

/// Steps by less than this share of the speed are rounding.
const ROUNDING: f64 = 1e-9;

/// Share by which spans are kept for longer than they are looked at: see `NO_TIME`.
const REACH: f64 = 1e-6;

/// What the axes do at most in some time.
#[derive(Debug, Clone, Copy, Default)]
struct Most {
    speed_mm_s: AxisValues,
    accel_mm_s2: AxisValues,
    /// Sum of all steps.
    step_mm_s: AxisValues,
}

/// The last of the motion, as far as steps in it still count.
#[derive(Debug)]
pub(super) struct Steps {
    response_s: f64,
    /// Beyond overrides count too.
    lower: bool,
    /// See [`Self::turning`].
    turns: bool,
    axes: ArrayVec<usize, AXES>,
    spans: VecDeque<Placed>,
    end_s: f64,
    end_mm: AxisValues,
    end_mm_s: AxisValues,
    /// When the last step was.
    last_step_s: f64,
    /// Until when means reach back to where the motion was in doubt.
    doubtful_to_s: f64,
    /// Pieces that lower overrides may speed up or brake.
    surges: VecDeque<Surged>,
    /// Since `since_s`, and in at least 2·τ before.
    most: [Most; 2],
    since_s: f64,
}

impl Steps {
    /// Nothing moves yet. `response_s`: over how long the drives spread a step;
    /// `lower`: lower overrides count too.
    pub fn new(axes: AxisSet, response_s: f64, lower: bool) -> Self {
        Self {
            response_s,
            lower,
            turns: false,
            axes: axes.iter().collect(),
            spans: VecDeque::with_capacity(64),
            end_s: 0.0,
            end_mm: [0.0; AXES],
            end_mm_s: [0.0; AXES],
            last_step_s: f64::NEG_INFINITY,
            doubtful_to_s: f64::NEG_INFINITY,
            surges: VecDeque::new(),
            most: [Most::default(); 2],
            since_s: 0.0,
        }
    }

    /// The same where the path turns between joints as well, and is followed closely there: the
    /// turn is no step.
    pub fn turning(mut self) -> Self {
        self.turns = true;
        self
    }

    /// See [`Self::turning`].
    pub fn turns(&self) -> bool {
        self.turns
    }

    /// Over how long the drives spread a step, s.
    pub fn response_s(&self) -> f64 {
        self.response_s
    }

    /// The motion begins at rest, and what was before is not known.
    pub fn begin(&mut self) {
        if !self.spans.is_empty() {
            *self = self.at_rest();
        }
    }

    /// The same axes at rest.
    pub fn at_rest(&self) -> Self {
        let mut axes = AxisSet::default();
        self.axes.iter().for_each(|axis| axes.insert(*axis));
        Self {
            turns: self.turns,
            ..Self::new(axes, self.response_s, self.lower)
        }
    }

    /// Takes the next span; true where steps within twice the response time before
    /// its end may matter.
    #[inline]
    pub fn push(&mut self, span: &Span) -> bool {
        let lasts = span.duration_s > 0.0 && span.duration_s < f64::INFINITY;
        if !lasts {
            return false;
        }
        let start_s = self.end_s;
        // What is there but for rounding is kept.
        let reach_s = start_s - 2.0 * self.response_s * (1.0 + REACH);
        while let Some(first) = self.spans.front()
            && first.start_s + first.span.duration_s < reach_s
        {
            self.spans.pop_front();
        }
        while self.surges.front().is_some_and(|it| it.end_s < reach_s) {
            self.surges.pop_front();
        }
        if start_s - self.since_s > 2.0 * self.response_s {
            self.most = [Most::default(), self.most[0]];
            self.since_s = start_s;
        }
        let [from, to] = &span.axes_mm_s;
        let per_s = 1.0 / span.duration_s;
        // Where it comes to rest, rounding is that of what was before.
        let last_mm_s = (self.spans.back()).map_or(0.0, |last| last.span.top_mm_s);
        let rounding_mm_s = ROUNDING * larger(span.top_mm_s, last_mm_s);
        let most = &mut self.most[0];
        let place_mm = self.end_mm;
        let mut steps = false;
        let mut step_mm_s = [0.0; AXES];
        for &axis in &self.axes {
            let (from, to) = (from[axis], to[axis]);
            step_mm_s[axis] = from - self.end_mm_s[axis];
            let step = step_mm_s[axis].abs();
            steps |= step > rounding_mm_s;
            most.step_mm_s[axis] += step * span.beyond.joint;
            let top = larger(from.abs(), to.abs());
            most.speed_mm_s[axis] = larger(most.speed_mm_s[axis], top);
            let accel = ((to - from) * per_s).abs() * span.beyond.ramp;
            most.accel_mm_s2[axis] = larger(most.accel_mm_s2[axis], accel);
            self.end_mm[axis] += 0.5 * (from + to) * span.duration_s;
            self.end_mm_s[axis] = to;
        }
        steps &= span.joint;
        if steps {
            self.last_step_s = start_s;
        }
        self.spans.push_back(Placed {
            span: *span,
            start_s,
            place_mm,
            steps,
            step_mm_s,
        });
        self.end_s = start_s + span.duration_s;
        self.last_step_s > reach_s
    }

    /// Whether a quick bound shows that the peaks of all means that end in the last
    /// span are of no interest.
    #[inline]
    pub fn is_quiet(&self, model: &PowerModel, mv: &Move, want: Want) -> bool {
        if want.floor_w == f64::NEG_INFINITY {
            return false;
        }
        let [converter] = model.converters.as_slice() else {
            return false;
        };
        want.passes(self.bound_w(model, converter, mv))
    }

    /// How the motion has run up to now is in doubt.
    pub fn doubt(&mut self) {
        self.doubtful_to_s = self.end_s + 2.0 * self.response_s;
    }

    /// Whether a mean may reach back to where the motion was in doubt.
    pub fn is_doubtful(&self) -> bool {
        self.end_s <= self.doubtful_to_s
    }

    /// Whether there were steps since that may have come otherwise.
    pub fn has_doubtful_steps(&self) -> bool {
        self.is_doubtful() && self.last_step_s >= self.end_s - 4.0 * self.response_s
    }

    /// An upper bound of what is drawn and fed back, W.
    fn bound_w(&self, model: &PowerModel, converter: &ConverterPower, mv: &Move) -> [f64; 2] {
        let mut drawn_w = converter.idle_w(mv, &model.axes, AxisSet::default());
        let mut fed_back_w = 0.0;
        let [now, before] = &self.most;
        for &axis in &self.axes {
            let v = larger(now.speed_mm_s[axis], before.speed_mm_s[axis]);
            if v == 0.0 || !converter.axes.contains(axis) {
                continue;
            }
            let along = larger(now.accel_mm_s2[axis], before.accel_mm_s2[axis]);
            let steps = (now.step_mm_s[axis] + before.step_mm_s[axis]) / self.response_s;
            let [drawn, fed_back] = at_most_w(&model.axes[axis], v, along + steps);
            drawn_w += drawn;
            fed_back_w += fed_back;
        }
        [drawn_w, fed_back_w]
    }
}
