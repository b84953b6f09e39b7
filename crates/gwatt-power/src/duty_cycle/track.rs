//! One converter and one direction of its power, over time.

use super::super::model::PowerModel;
use super::super::trace::{Flow, Slice, Tracer};
use super::limits::Limits;
use super::rating::Place;
use super::span::Span;
use super::terms::{Models, Terms};

/// One converter and one direction of its power.
#[derive(Debug)]
pub(super) struct Track {
    pub(super) converter: usize,
    pub(super) flow: Flow,
    pub(super) limits: Limits,
    /// Time so far in s.
    pub(super) time_s: f64,
    /// What is found is no less than at any lower override: see [`terms`](super::terms).
    pub(super) bounds: bool,
    /// These are no lower than some share of the largest.
    pub(super) ends: bool,
    /// No power is larger at any time, W.
    pub(super) most_w: f64,
}

impl Track {
    /// The model that it is computed with.
    pub(super) fn model<'a>(&self, model: &'a PowerModel, models: &'a Models) -> &'a PowerModel {
        if self.bounds && self.flow == Flow::FedBack {
            models.fed_back(model)
        } else {
            model
        }
    }

    pub(super) fn tracer<'a>(&self, model: &'a PowerModel) -> Option<Tracer<'a>> {
        let tracer = model.tracer(self.converter, self.flow)?;
        Some(if self.bounds { tracer.raised() } else { tracer })
    }

    /// All power passes here, slice by slice.
    pub(super) fn take(&mut self, slice: &Slice, place: Place) {
        if self.most_w == f64::INFINITY || slice.keeps_below(self.most_w) {
            self.limits.take(slice, self.time_s, place);
            self.time_s += slice.duration_s;
            return;
        }
        for (part, above) in slice.sides(self.most_w) {
            let part = if above {
                Slice::constant(part.duration_s, self.most_w)
            } else {
                part
            };
            self.limits.take(&part, self.time_s, place);
            self.time_s += part.duration_s;
        }
    }

    /// What may come after a move, no more than there is at any time.
    pub(super) fn capped(&self, slice: &Slice) -> Slice {
        if slice.peak_w() > self.most_w {
            Slice::constant(slice.duration_s, self.most_w)
        } else {
            *slice
        }
    }

    /// A power that lasts for a time that is not known.
    pub(super) fn span(&mut self, powers: [f64; 3], span: Span, place: Place) {
        let power_w = match self.flow {
            Flow::Drawn => powers[0],
            Flow::FedBack => powers[1],
        };
        let power_w = power_w.min(self.most_w);
        let terms = Terms {
            rest_w: powers[2].min(self.most_w),
            cruise_w: power_w,
            // The span is as long as it may be.
            least_share: if self.ends { 1.0 } else { 0.0 },
            ..Terms::default()
        };
        if self.bounds {
            self.limits.begin(&terms, self.time_s, place);
        }
        self.limits.span(power_w, span, self.time_s, place);
        if self.bounds {
            self.limits.end(&terms, self.time_s, place);
        }
        if span.longest_s.is_finite() {
            self.time_s += span.longest_s;
        }
    }
}
