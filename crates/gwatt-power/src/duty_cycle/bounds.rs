//! What the limits over time have to know of moves where they are bounds over lower
//! overrides: see [`terms`](super::terms).

use super::Buffered;
use crate::trace::Tracer;
use gwatt_motion::{Move, MoveKind};
use gwatt_plan::{Plan, Profile, Trajectory};

/// The smaller of two shares: where both knobs have a say.
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
    kept: &mut Buffered,
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
    kept: &mut Buffered,
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
