//! What the limits over time have to know of pieces that lower overrides change.

use super::bounds::{least_share, lower_of};
use super::{Buffered, DutyCycle, Span, Track};
use crate::demand::larger;
use crate::model::PowerModel;
use crate::parabolic_blend::Tandem;
use crate::robust::{Extremes, Part};
use crate::surge::{Surge, surge_powers};
use crate::trace::{Flow, Slice};
use gwatt_motion::Move;
use gwatt_plan::SpeedBound;
use gwatt_plan::lookahead::Planned;

impl DutyCycle {
    /// At lower overrides a piece may be sped up or braked where it is not at the
    /// largest.
    #[cold]
    pub fn surge(
        &self,
        model: &PowerModel,
        mv: &Move,
        planned: &Planned<u64>,
        surge: &Surge,
        kept: &mut Buffered,
    ) {
        let least_share = self.least_share(mv);
        let copper = model.has_copper(mv);
        for (index, track) in self.tracks.iter().enumerate() {
            if !track.bounds {
                continue;
            }
            // Sped up an axis feeds no more back than in a cruise, and braked it draws no
            // more, but for what is lost in copper.
            let less = match track.flow {
                Flow::Drawn => [false, !copper],
                Flow::FedBack => [!copper, false],
            };
            let Some(surge) = surge.without(less) else {
                continue;
            };
            let lasts_s = surge.lasts_s(planned.speeds2, least_share);
            if lasts_s <= 0.0 {
                continue;
            }
            let own = track.model(model, &self.models);
            let [drawn_w, fed_back_w] = surge_powers(own, track.converter, mv, planned, surge);
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

    /// Two moves that share some of their time: what both ask for then stands in place of
    /// the end of the one and the beginning of the other. At lower overrides they may
    /// share less of it, so that places of both are passed by themselves, or more.
    #[cold]
    pub fn together(
        &self,
        model: &PowerModel,
        mv: &Move,
        tandem: &Tandem,
        [before, own]: [&mut Buffered; 2],
    ) {
        let shared_s = tandem.overlap_s;
        let least_share = self.least_share(mv);
        for (index, track) in self.tracks.iter().enumerate() {
            let model = track.model(model, &self.models);
            let power_w = |extremes: &Extremes| {
                let [drawn_w, fed_back_w] =
                    model.robust_powers(track.converter, mv, &[extremes.part()]);
                match track.flow {
                    Flow::Drawn => drawn_w,
                    Flow::FedBack => fed_back_w,
                }
            };
            let ends = [
                before.take_end(index, shared_s),
                own.take_start(index, shared_s),
            ];
            let slice_s = shared_s / tandem.largest.len() as f64;
            let largest = tandem.largest.iter().map(power_w);
            if !track.bounds {
                own.put_first(
                    index,
                    largest.map(|most_w| Slice::constant(slice_s, most_w)),
                );
                continue;
            }
            let all = largest.chain(tandem.slower.iter().map(power_w));
            let most_w = all.fold(0.0, larger);
            own.put_first(index, std::iter::once(Slice::constant(shared_s, most_w)));
            // Places where one of both brakes or speeds up for longer than they share then,
            // which is so much of the time at the largest overrides at least.
            let [end, start] = ends;
            let shares_s = [least_share, least_share * least_share].map(|share| share * shared_s);
            before.push_passed(index, between(&end, [0.0, shared_s - shares_s[0]]));
            before.push_passed(index, between(&start, [shares_s[1], shared_s]));
            let more_s = tandem.longest_s - shared_s;
            if more_s > 0.0 {
                before.push_late(index, Slice::constant(more_s, most_w));
            }
            // What is passed then counts in the move before.
            let next = own.terms(index).copied().unwrap_or_default();
            if let Some(terms) = before.terms(index) {
                terms.rest_w = terms.rest_w.max(next.rest_w);
                terms.cruise_w = terms.cruise_w.max(next.cruise_w).max(most_w);
            }
        }
    }

    /// The share of its speed that a move keeps which is planned together with others: both
    /// knobs have a say unless the motion stops between rapids and feeds.
    pub(super) fn least_share(&self, mv: &Move) -> f64 {
        if self.apart {
            least_share(self.least_shares, mv)
        } else {
            lower_of(self.least_shares)
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

/// What of some slices lies between two instants, s after their beginning.
fn between(slices: &[Slice], [from_s, to_s]: [f64; 2]) -> impl Iterator<Item = Slice> {
    let mut start_s = 0.0;
    slices.iter().filter_map(move |slice| {
        let [_, after] = slice.cut(from_s - start_s);
        let begun_s = from_s.max(start_s);
        start_s += slice.duration_s;
        let [own, _] = after?.cut(to_s - begun_s);
        own
    })
}
