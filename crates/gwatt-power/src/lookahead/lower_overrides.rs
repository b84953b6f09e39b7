//! What final pieces may ask for at lower overrides.

use super::Ahead;
use super::pace::Course;
use crate::demand::{Demand, Want};
use crate::model::PowerModel;
use crate::observer::Observer;
use crate::piece::{Shift, is_quiet, piece_demand, shifted_demand, slower_demand};
use crate::surge::{Surge, surge_demand};
use gwatt_plan::lookahead::{Piece, Planned, Speeds2};

/// A chord that ramps, as shorter ones in its place may do it: they may be steeper, and so
/// as much faster at both ends.
fn steeper(planned: &Planned<u64>) -> Option<Planned<u64>> {
    let ratio = planned.slack.accel_mm_s2 / planned.accel_mm_s2;
    let Speeds2 { start, end, top } = planned.speeds2;
    let steeper = ratio > 1.0 && planned.section.is_none() && !planned.speeds2.are_one();
    let top = top.min(planned.slack.chord2);
    steeper.then(|| Planned {
        accel_mm_s2: planned.slack.accel_mm_s2,
        speeds2: Speeds2 {
            start: top.min(ratio * start),
            end: top.min(ratio * end),
            top,
        },
        ..planned.clone()
    })
}

/// The same as if it sped up and braked with all that, wherever it does so: over time, and with
/// limits of jerk.
fn any_ramp(planned: &Planned<u64>, most_mm_s: f64) -> Option<Surge> {
    let slack = &planned.slack;
    let speed_mm_s = most_mm_s.min(slack.chord2.sqrt());
    let ramps = slack.accel_mm_s2 > planned.accel_mm_s2 && !planned.speeds2.are_one();
    ramps.then_some(Surge {
        rises_mm_s: Some(speed_mm_s),
        falls_mm_s: Some(speed_mm_s),
        accel_mm_s2: slack.accel_mm_s2,
        section: None,
    })
}

/// Slower, friction takes less of what is fed back.
fn slow_down(surge: &mut Option<Surge>, accel_mm_s2: f64, top_mm_s: f64) {
    let slowed = surge.get_or_insert(Surge {
        rises_mm_s: None,
        falls_mm_s: None,
        accel_mm_s2,
        section: None,
    });
    slowed.falls_mm_s = Some(slowed.falls_mm_s.unwrap_or(0.0).max(top_mm_s));
}

impl Ahead {
    /// What a final piece may ask for at lower overrides, if it may do so and that is
    /// of interest.
    #[inline]
    pub(super) fn surge(
        &mut self,
        model: &PowerModel,
        observer: &Observer,
        planned: &Planned<u64>,
    ) -> Option<Demand> {
        let surges = self.surges.as_mut()?;
        let open = self.open.get(planned.tag)?;
        let straight = match planned.piece {
            Piece::Along { .. } => open.mv.arc.is_none(),
            Piece::Joined { .. } => true,
            Piece::Blend(_) => false,
        };
        let top_mm_s = planned.top_speed_mm_s();
        let course = Course::of(planned, straight, self.steps.response_s());
        let gentler = open.mv.arc.is_some() || !straight || planned.section.is_some();
        let turned = (gentler && model.has_copper(&open.mv)).then(|| {
            // Sped up or turned more gently an axis loses less of what it feeds back.
            let lossless = surges.lossless(model);
            let want = Want {
                energy: false,
                ..open.want
            };
            piece_demand(lossless, &open.mv, planned, want)
        });
        let slows = straight && course.brakes() && model.has_viscous(&open.mv);
        let is_own = planned.next.is_none() && planned.first == planned.tag;
        let found = is_own.then_some(&open.assessment.demand);
        let slower = slower_demand(model, &open.mv, planned, open.want, found);
        // A blend may be passed as fast as the faster of both moves asks for.
        let next = planned.next.and_then(|next| self.open.get(next));
        let pace = next.map_or(open.pace, |next| open.pace.or_faster(&next.pace));
        let slows_after = next.is_some_and(|next| next.pace.may_be_slower(&open.pace));
        // From a lower speed a ramp lasts longer, unless all speeds fall together.
        let longer = !pace.is_asked() || !surges.are_one(pace.rapid, course.top2);
        surges.runs.forget(planned.first);
        let mut shifted = [false; 2];
        let mut shift = Shift::Whole;
        let surge = if let Some(section) = &planned.section {
            surges.free(section, planned)
        } else {
            let rises2 = surges.past.pass(&pace, &course);
            let is_chord = surges.runs_chords && open.mv.arc.is_some();
            let on2 = surges.advance(planned.tag, &pace, course.ramp2, is_chord);
            let falls2 = surges.runs.falls2(planned.tag, &pace, &course, on2);
            let late2 = surges.late2(&course, slows_after);
            let falls2 = falls2.map_or(late2, |falls2| {
                Some(late2.map_or(falls2, |it| it.max(falls2)))
            });
            let ramps = [course.start2, course.end2].map(|low2| course.is_ramp_from(low2));
            if is_chord {
                shift = Shift::Chord;
                shifted = [rises2.is_some() && ramps[0], falls2.is_some() && ramps[1]];
            } else if !straight {
                // What turns asks for more where a ramp from a lower speed goes on.
                let moves = [course.start2, course.end2].map(|low2| low2 > 0.0);
                shifted = [ramps[0] && moves[0], ramps[1] && moves[1]];
            }
            Surge::between([rises2, falls2], planned.accel_mm_s2)
        };
        if let Some(surge) = surge {
            self.follow_surge(model, planned, &surge);
        }
        self.watch_surge(model, observer, planned, surge.as_ref(), longer);
        let most_mm_s = surge.map_or(top_mm_s, |it| it.speed_mm_s().max(top_mm_s));
        let chords = any_ramp(planned, most_mm_s);
        if let Some(chords) = &chords {
            self.watch_surge(model, observer, planned, Some(chords), longer);
        }
        let chords = chords.filter(|_| planned.section.is_some());
        let chords = chords.and_then(|it| self.surged(model, planned, &it, straight));
        let steeper = steeper(planned);
        let shift = match &steeper {
            Some(steeper) => self.shifted(model, steeper, (shift, [true; 2]), is_own),
            None => self.shifted(model, planned, (shift, shifted), is_own),
        };
        let mut surge = surge.and_then(|surge| surge.without(shifted));
        if slows {
            slow_down(&mut surge, planned.accel_mm_s2, top_mm_s);
        }
        let surged = surge.and_then(|surge| self.surged(model, planned, &surge, straight));
        [turned, slower, shift, chords, surged]
            .into_iter()
            .flatten()
            .reduce(|mut all, one| {
                all.include(&one);
                all
            })
    }

    /// What a piece asks for that is sped up or braked from any lower speed, if that is of
    /// interest.
    fn shifted(
        &mut self,
        model: &PowerModel,
        planned: &Planned<u64>,
        how: (Shift, [bool; 2]),
        is_own: bool,
    ) -> Option<Demand> {
        let open = self.open.get(planned.tag)?;
        if how.1 == [false; 2] || is_quiet(model, &open.mv, planned, open.want) {
            return None;
        }
        let found = is_own.then_some(&open.assessment.demand);
        let mut demand = shifted_demand(model, &open.mv, planned, how, (open.want, found));
        if model.has_copper(&open.mv)
            && let Some(surges) = self.surges.as_mut()
        {
            let lossless = surges.lossless(model);
            demand.include(&shifted_demand(
                lossless,
                &open.mv,
                planned,
                how,
                (open.want, found),
            ));
        }
        Some(demand)
    }

    /// Holds what a piece may do at lower overrides against limits over time, where there are
    /// any; `longer`: from a lower speed its ramps may last longer.
    pub(super) fn watch_surge(
        &mut self,
        model: &PowerModel,
        observer: &Observer,
        planned: &Planned<u64>,
        surge: Option<&Surge>,
        longer: bool,
    ) {
        if observer.watch.is_none() {
            return;
        }
        let Some(open) = self.open.get_mut(planned.tag) else {
            return;
        };
        if let Some(surge) = surge {
            observer.surge(model, &open.mv, planned, surge, &mut open.kept);
        }
        let longer = longer && planned.section.is_none();
        let top_mm_s = planned.top_speed_mm_s();
        let ends2 = [planned.speeds2.start, planned.speeds2.end];
        let [rises_mm_s, falls_mm_s] = ends2
            .map(|end2| (longer && top_mm_s * top_mm_s > end2 && end2 > 0.0).then(|| end2.sqrt()));
        if rises_mm_s.is_some() || falls_mm_s.is_some() {
            let ramps = Surge {
                rises_mm_s,
                falls_mm_s,
                accel_mm_s2: planned.accel_mm_s2,
                section: None,
            };
            observer.surge(model, &open.mv, planned, &ramps, &mut open.kept);
        }
    }

    /// What a surge asks for, if that is of interest.
    fn surged(
        &mut self,
        model: &PowerModel,
        planned: &Planned<u64>,
        surge: &Surge,
        straight: bool,
    ) -> Option<Demand> {
        let open = self.open.get(planned.tag)?;
        let want = Want {
            energy: false,
            ..open.want
        };
        let extremes = [surge.speed_mm_s(), surge.accel_mm_s2];
        if straight && model.is_straight_below_floor(&open.mv, extremes, want) {
            return None;
        }
        let mut demand = surge_demand(model, &open.mv, planned, *surge, want);
        if surge.section.is_some() && model.has_copper(&open.mv) {
            let lossless = self.surges.as_mut()?.lossless(model);
            demand.include(&surge_demand(lossless, &open.mv, planned, *surge, want));
        }
        Some(demand)
    }
}
