//! Demand of independent axes between two instants where an acceleration
//! changes.
//!
//! Input: the profile of each axis. Output: peaks and energy, added to the
//! [`Totals`].
//!
//! At constant jerk the speeds of all axes are polynomials of the same time and
//! the peak of their sum is exact. Where the power of one is constant, or its
//! acceleration follows a slope, each axis is evaluated for itself: its energy
//! is exact still, and the sum of the axes' peaks is an upper bound of theirs.

use super::demand::{Totals, Want};
use super::model::{ConverterPower, PowerModel};
use super::stretch::{Course, Follower, Stretch};
use arrayvec::ArrayVec;
use gwatt_machine::AXES;
use gwatt_motion::Move;
use gwatt_plan::{Phase, PhaseKind, Profile};

/// What each axis does in an interval in which none switches.
pub(super) type Parts<'a> = ArrayVec<(Phase, Follower<'a>), AXES>;

/// Evaluates an interval.
pub(super) fn interval(axes: Parts<'_>, credit_regen: bool, want: Want, totals: &mut Totals) {
    let over_time = axes.iter().all(|(part, _)| {
        matches!(
            part.kind,
            PhaseKind::ConstantAcceleration | PhaseKind::ConstantJerk { .. }
        )
    });
    if over_time {
        let axes: ArrayVec<Follower<'_>, AXES> = axes.into_iter().map(|(_, axis)| axis).collect();
        Stretch {
            credit_regen,
            idle_w: totals.idle_w,
            axes: &axes,
        }
        .evaluate(want, totals);
        return;
    }
    let (mut peak_w, mut regen_w) = (totals.idle_w, 0.0);
    for (_, axis) in axes {
        let mut alone = Totals::new(0.0);
        Stretch {
            credit_regen,
            idle_w: 0.0,
            axes: &[axis],
        }
        .evaluate(want, &mut alone);
        peak_w += alone.peak_w;
        regen_w += alone.regen_w;
        totals.energy_j += alone.energy_j;
    }
    let credit_w = if credit_regen { totals.idle_w } else { 0.0 };
    totals.raise_peak(peak_w);
    totals.raise_regen(regen_w - credit_w);
}

/// What each axis of the converter does from `start` to `end`, s.
pub(super) fn parts<'a>(
    model: &'a PowerModel,
    converter: &ConverterPower,
    mv: &Move,
    profiles: &[(usize, Profile)],
    (start, end): (f64, f64),
) -> Parts<'a> {
    profiles
        .iter()
        .filter(|(axis, _)| converter.axes.contains(*axis))
        .take(AXES)
        .map(|(axis, profile)| {
            let power = &model.axes[*axis];
            let part = part(profile, start, end);
            let follower = Follower {
                axis: power,
                course: Course::new(&part),
                direction: power.si_per_unit.copysign(mv.end[*axis] - mv.start[*axis]),
            };
            (part, follower)
        })
        .collect()
}

/// What a profile does in an interval; it rests once the axis has arrived.
fn part(profile: &Profile, start: f64, end: f64) -> Phase {
    let middle = 0.5 * (start + end);
    let mut from = 0.0;
    for phase in &profile.phases {
        let to = from + phase.duration_s;
        if middle < to {
            let last = (end - from).min(phase.duration_s);
            return phase.between((start - from).max(0.0), last);
        }
        from = to;
    }
    Phase {
        kind: PhaseKind::ConstantAcceleration,
        duration_s: end - start,
        position_mm: 0.0,
        velocity_mm_s: 0.0,
        end_velocity_mm_s: 0.0,
        accel_mm_s2: 0.0,
    }
}
