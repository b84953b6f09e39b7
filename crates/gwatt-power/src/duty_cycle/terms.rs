//! What a bound over all lower overrides has to know of a move besides its slices.
//!
//! The slices are those at the largest overrides, raised (see `trace/raised`), so that
//! what fills stores and means over windows is no less than at any lower override, and
//! takes no longer. Beyond that
//!
//! * what is drawn next to rest lasts for ever where the override is next to nothing:
//!   means count at least that, and where it lies above a limit nothing is kept. Where
//!   overrides are no lower than a share σ of the largest, speeds are not either, and
//!   nothing lasts longer than by 1/σ: `P²·dt` grows by the square of the power next to
//!   rest, since `(P² − λ²)·dt` does not, and what lies above a limit next to rest does so
//!   all along;
//! * what lies above a power lasts longer at a lower speed: a cruise of `P` by
//!   `(P − P₀)/(λ − P₀)` at most, P₀ next to rest, since below that speed it does not
//!   lie above λ;
//!   A line from rest to rest of length L lies above λ for no longer than `L/v`, v the
//!   speed at which a cruise comes to λ: in all it takes `L/v + v/a`, and as long as it
//!   takes to brake, and some of speeding up, lie below;
//! * where a lower override makes axes speed up or brake that do not at the largest, so
//!   much power counts for so long in addition, and nothing is given off meanwhile: with
//!   σ it is from that share of a speed on, and the time that is lost for giving off is
//!   no longer than the ramp, since no place is passed faster;
//! * axes that run for themselves meet otherwise: their work counts, at no more than
//!   the largest powers of all together; with σ what each draws after t at the largest
//!   it draws between t and t/σ, see `trace/shifted`.

use crate::axis::AxisPower;
use crate::model::PowerModel;
use crate::trace::Apart;

/// See the module.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Terms {
    /// What is drawn or fed back next to rest, W.
    pub rest_w: f64,
    /// In a cruise at most, W.
    pub cruise_w: f64,
    /// Of a line from rest to rest its length by its largest speed, s.
    pub line_s: Option<f64>,
    /// In ramps that are none at the largest overrides, W, and for how long, s.
    pub surge_w: f64,
    pub surge_s: f64,
    /// Axes that run for themselves.
    pub apart: Option<Apart>,
    /// No place is passed at less than this share of its speed at the largest overrides.
    pub least_share: f64,
}

impl Terms {
    /// With what the spindle draws as well.
    pub fn raised(mut self, by_w: f64) -> Self {
        self.rest_w += by_w;
        self.cruise_w += by_w;
        self.surge_w += by_w;
        self
    }

    /// With no more than there is at any time, W.
    pub fn capped(mut self, most_w: f64) -> Self {
        self.rest_w = self.rest_w.min(most_w);
        self.cruise_w = self.cruise_w.min(most_w);
        self.surge_w = self.surge_w.min(most_w);
        self
    }

    /// By how much anything may last longer; endless where overrides go down to 0.
    pub fn longest_ratio(&self) -> f64 {
        if self.least_share > 0.0 {
            1.0 / self.least_share
        } else {
            f64::INFINITY
        }
    }
}

/// The models that bounds need.
#[derive(Debug)]
pub(super) struct Models(Option<Box<PowerModel>>);

impl Models {
    pub fn new(model: &PowerModel, needed: bool) -> Self {
        let curved = model.axes.iter().any(AxisPower::is_curved);
        let credits = model.converters.iter().any(|it| it.credit_regen);
        let needed = needed && (curved || credits);
        Self(needed.then(|| Box::new(model.unbraked())))
    }

    /// That of what is fed back.
    pub fn fed_back<'a>(&'a self, model: &'a PowerModel) -> &'a PowerModel {
        self.0.as_deref().unwrap_or(model)
    }
}
