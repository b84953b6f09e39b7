//! What the limits over time have to know of moves where they are bounds over lower
//! overrides: see [`terms`](super::terms).

use super::{Kept, Span, Track, Watch};
use crate::interpret::{Move, MoveKind};
use crate::plan::lookahead::Planned;
use crate::plan::{Plan, Profile, SpeedBound, Trajectory};
use crate::power::model::PowerModel;
use crate::power::robust::Part;
use crate::power::surge::{Surge, surge_powers};
use crate::power::trace::{Flow, Slice, Tracer};

impl Watch {
    /// At lower overrides a piece may be sped up or braked where it is not at the
    /// largest.
    #[cold]
    pub fn surge(
        &self,
        model: &PowerModel,
        mv: &Move,
        planned: &Planned<u64>,
        surge: &Surge,
        kept: &mut Kept,
    ) {
        let lasts_s = surge.lasts_s(planned.speeds2, lower_of(self.least_shares));
        if lasts_s <= 0.0 {
            return;
        }
        for (index, track) in self.tracks.iter().enumerate() {
            if !track.bounds {
                continue;
            }
            let own = track.model(model, &self.models);
            let [drawn_w, fed_back_w] = surge_powers(own, track.converter, mv, planned, *surge);
            let power_w = match track.flow {
                Flow::Drawn => drawn_w,
                Flow::FedBack => fed_back_w,
            };
            if let Some(terms) = kept.terms(index) {
                terms.surge_w = terms.surge_w.max(power_w);
                terms.surge_s += lasts_s;
            }
            if let Some(step) = kept.step(index).copied()
                && step.more_w > 0.0
            {
                // It may fall into the step of speed before the piece.
                let both = Slice::constant(lasts_s.min(step.lasts_s), power_w + step.more_w);
                kept.push_late(index, both);
            }
        }
    }

    /// For how long the same may last at lower overrides too. Where these go down to 0 the
    /// terms of the bound say that.
    pub(super) fn within(&self, span: Span) -> Span {
        let least_share = lower_of(self.least_shares);
        let bounds = self.tracks.iter().any(|track| track.bounds);
        if !bounds || least_share <= 0.0 {
            return span;
        }
        Span {
            longest_s: span.longest_s / least_share,
            ..span
        }
    }
}

impl Track {
    /// What a move whose timing is not known may draw or feed back next to rest, W: axes may
    /// be sped up as hard at any speed, and losses in copper stay.
    pub(super) fn still_w(&self, model: &PowerModel, mv: &Move, parts: &[Part<'_>]) -> f64 {
        let Some(tracer) = self.tracer(model).filter(|_| self.bounds) else {
            return 0.0;
        };
        let rest = SpeedBound::default();
        let still = parts.iter().map(|part| Part {
            bound: &rest,
            ..*part
        });
        let still: Vec<Part<'_>> = still.collect();
        let [drawn_w, fed_back_w] = model.robust_powers(self.converter, mv, &still);
        let still_w = match self.flow {
            Flow::Drawn => drawn_w,
            Flow::FedBack => fed_back_w,
        };
        tracer.rest_w(mv).max(still_w)
    }
}

/// The smaller of two shares: where moves are planned together both knobs have a say.
pub(super) fn lower_of([feed, rapid]: [f64; 2]) -> f64 {
    feed.min(rapid)
}

/// The share of its speed that a move by itself keeps.
pub(super) fn least_share(least: [f64; 2], mv: &Move) -> f64 {
    match mv.kind {
        MoveKind::Feed | MoveKind::Arc => least[0],
        MoveKind::Rapid => least[1],
        _ => lower_of(least),
    }
}

/// Axes that run for themselves, where overrides are no lower than a share.
pub(super) fn shift(
    tracer: &Tracer<'_>,
    (mv, profiles): (&Move, &[(usize, Profile)]),
    least_share: f64,
    index: usize,
    kept: &mut Kept,
) {
    let mut late = Vec::new();
    let out = &mut |slice| kept.push(index, slice);
    tracer.shifted(mv, profiles, least_share, out, &mut |slice| {
        late.push(slice);
    });
    for slice in late {
        kept.push_late(index, slice);
    }
    if let Some(terms) = kept.terms(index) {
        // The slices last as long as they may.
        terms.least_share = 1.0;
    }
}

/// What a bound over all lower overrides has to know of a move by itself.
pub(super) fn bound(
    tracer: &Tracer<'_>,
    (mv, plan): (&Move, &Plan),
    least_share: f64,
    index: usize,
    kept: &mut Kept,
) {
    if matches!(plan.trajectory, Trajectory::Rest) {
        // It lasts as long as it does.
        return;
    }
    let Some(terms) = kept.terms(index) else {
        return;
    };
    terms.rest_w = tracer.rest_w(mv);
    terms.least_share = least_share;
    if mv.arc.is_none() && matches!(plan.trajectory, Trajectory::Path(_)) {
        terms.cruise_w = tracer.cruise_w(mv, plan.top_speed_mm_s);
        terms.line_s = Some(mv.length_mm / plan.top_speed_mm_s);
    }
}
