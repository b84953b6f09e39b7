//! Slices of straight paths and of independent axes.

use super::super::changing;
use super::super::demand::{Totals, Want};
use super::super::independent::instants;
use super::super::stretch::{Course, Follower, Stretch};
use super::slice::Slice;
use super::{Flow, Tracer};
use arrayvec::ArrayVec;
use gwatt_machine::{AXES, AxisSet};
use gwatt_motion::Move;
use gwatt_plan::{Phase, PhaseKind, Profile};

/// Parts of a phase of which the largest power counts for the whole part.
const PARTS: u32 = 64;

impl Tracer<'_> {
    /// All axes along a line.
    pub(super) fn straight(
        &self,
        mv: &Move,
        profile: &Profile,
        idle_w: f64,
        out: &mut impl FnMut(Slice),
    ) {
        let directions = self.directions(mv);
        if self.is_line(mv, &directions, profile) {
            return self.even(&directions, &profile.phases, idle_w, out);
        }
        for phase in &profile.phases {
            if self.raised {
                self.raised_phase(&directions, phase, idle_w, out);
            } else {
                self.straight_phase(&directions, phase, idle_w, out);
            }
        }
    }

    /// One phase along a line.
    pub(super) fn straight_phase(
        &self,
        directions: &[(usize, f64)],
        phase: &Phase,
        idle_w: f64,
        out: &mut impl FnMut(Slice),
    ) {
        for part in phase.parts() {
            let followers = |part: &Phase| -> ArrayVec<Follower<'_>, AXES> {
                let course = Course::new(part);
                directions
                    .iter()
                    .take(AXES)
                    .map(|&(axis, direction)| Follower {
                        axis: &self.model.axes[axis],
                        course,
                        direction,
                    })
                    .collect()
            };
            if is_over_time(&part) {
                self.exact(&followers(&part), part.duration_s, idle_w, out);
                continue;
            }
            let step_s = part.duration_s / f64::from(PARTS);
            for i in 0..PARTS {
                let share = part.between(f64::from(i) * step_s, f64::from(i + 1) * step_s);
                self.bounded(&followers(&share), share.duration_s, idle_w, out);
            }
        }
    }

    /// Axes whose speeds are polynomials of the same time.
    fn exact(
        &self,
        axes: &[Follower<'_>],
        duration_s: f64,
        idle_w: f64,
        out: &mut impl FnMut(Slice),
    ) {
        if axes.is_empty() || duration_s <= 0.0 {
            return self.at_rest(duration_s, idle_w, out);
        }
        let stretch = self.stretch(axes, idle_w);
        let base_w = self.base_w(idle_w);
        stretch.pieces(self.flow.side(), self.flow.sign(), |power, from, to| {
            if to > from {
                let mut power = *power;
                power.0[0] += base_w;
                out(Slice {
                    duration_s: duration_s * (to - from),
                    from,
                    to,
                    power,
                });
            }
        });
    }

    /// The largest power of axes with any course, for all of the time.
    fn bounded(
        &self,
        axes: &[Follower<'_>],
        duration_s: f64,
        idle_w: f64,
        out: &mut impl FnMut(Slice),
    ) {
        if axes.is_empty() || duration_s <= 0.0 {
            return self.at_rest(duration_s, idle_w, out);
        }
        let mut totals = Totals::new(idle_w);
        self.stretch(axes, idle_w)
            .evaluate(Want::PEAKS, &mut totals);
        self.push_totals(&totals, duration_s, out);
    }

    fn push_totals(&self, totals: &Totals, duration_s: f64, out: &mut impl FnMut(Slice)) {
        let power_w = match self.flow {
            Flow::Drawn => totals.peak_w,
            Flow::FedBack => totals.regen_w,
        };
        out(Slice::constant(duration_s, power_w));
    }

    fn stretch<'s>(&self, axes: &'s [Follower<'s>], idle_w: f64) -> Stretch<'s> {
        Stretch {
            credit_regen: self.converter.credit_regen,
            idle_w,
            axes,
        }
    }

    /// Axes that run for themselves.
    pub(super) fn independent(
        &self,
        mv: &Move,
        profiles: &[(usize, Profile)],
        out: &mut impl FnMut(Slice),
    ) {
        let active = AxisSet(mv.moving.0 & self.converter.axes.0);
        let idle_w = self.idle_w(mv, active);
        let (instants, duration_s) = instants(self.converter, profiles);
        let mut start = 0.0;
        for end in instants {
            if end <= start {
                continue;
            }
            let axes = changing::parts(self.model, self.converter, mv, profiles, (start, end));
            let over_time = axes.iter().all(|(part, _)| is_over_time(part));
            if over_time {
                let axes: ArrayVec<Follower<'_>, AXES> =
                    axes.into_iter().map(|(_, axis)| axis).collect();
                self.exact(&axes, end - start, idle_w, out);
            } else {
                let mut totals = Totals::new(idle_w);
                let credit_regen = self.converter.credit_regen;
                changing::interval(axes, credit_regen, Want::PEAKS, &mut totals);
                self.push_totals(&totals, end - start, out);
            }
            start = end;
        }
        // The axes of other converters run on.
        let resting_w = self.idle_w(mv, AxisSet::default());
        self.at_rest(duration_s - start, resting_w, out);
    }
}

/// Whether power is a polynomial of time.
fn is_over_time(part: &Phase) -> bool {
    matches!(
        part.kind,
        PhaseKind::ConstantAcceleration | PhaseKind::ConstantJerk { .. }
    )
}
