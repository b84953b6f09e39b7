//! Demand of independent rapids: each axis runs its own ramp.
//!
//! Input: the profile of each axis, all starting together. Output: the
//! [`Totals`] of one converter. The instants at which any axis switches are
//! merged; between two of them every acceleration is constant, or else
//! `changing` takes over.

use super::changing;
use super::demand::{Totals, Want};
use super::interval::{Interval, Ramp};
use super::model::{ConverterPower, PowerModel};
use arrayvec::ArrayVec;
use gwatt_machine::{AXES, AxisSet};
use gwatt_motion::Move;
use gwatt_plan::{Phase, PhaseKind, Profile};

/// Switching instants of all axes: seven phases each, of four parts at most.
const INSTANTS: usize = 7 * 4 * AXES;

/// By what share of its duration a move may end early by rounding.
const ROUNDING: f64 = 1e-12;

/// The converter's share of an independent rapid.
pub(super) fn totals(
    model: &PowerModel,
    converter: &ConverterPower,
    mv: &Move,
    profiles: &[(usize, Profile)],
    idle_w: f64,
    want: Want,
) -> Totals {
    let (instants, duration_s) = instants(converter, profiles);
    let mut totals = Totals::at_rest(idle_w, duration_s, want);
    let mut phases = profiles.iter().flat_map(|(_, profile)| &profile.phases);
    let steady = phases.all(is_steady);
    let mut start = 0.0;
    for end in instants {
        if end > start && !steady {
            let axes = changing::parts(model, converter, mv, profiles, (start, end));
            changing::interval(axes, converter.credit_regen, want, &mut totals);
            start = end;
        } else if end > start {
            let ramps = ramps(model, converter, mv, profiles, start, end);
            Interval {
                credit_regen: converter.credit_regen,
                curved: converter.curved.0 & mv.moving.0 != 0,
                idle_w,
                ramps: &ramps,
                duration_s: end - start,
            }
            .evaluate(want, &mut totals);
            start = end;
        }
    }
    // Axes that hold their weight while those of other converters run on.
    let rest_s = duration_s - start;
    if rest_s > ROUNDING * duration_s {
        let arrived_w = holding_w(model, AxisSet(converter.holding.0 & mv.moving.0));
        totals.raise_peak(idle_w + arrived_w);
        if want.energy {
            totals.energy_j += rest_s * arrived_w;
        }
    }
    totals
}

/// The instants at which an axis of the converter switches, in order, and how
/// long the move lasts, s.
pub(super) fn instants(
    converter: &ConverterPower,
    profiles: &[(usize, Profile)],
) -> (ArrayVec<f64, INSTANTS>, f64) {
    let mut instants = ArrayVec::new();
    let mut duration_s = 0.0_f64;
    for (axis, profile) in profiles {
        duration_s = duration_s.max(profile.duration_s());
        if converter.axes.contains(*axis) {
            let mut start = 0.0;
            for phase in &profile.phases {
                let mut end = start;
                if !is_steady(phase) {
                    for part in phase.parts() {
                        end += part.duration_s;
                        instants.try_push(end).ok();
                    }
                }
                start += phase.duration_s;
                // More axes than exist cannot come from `plan`.
                instants.try_push(start).ok();
            }
        }
    }
    instants.sort_unstable_by(f64::total_cmp);
    (instants, duration_s)
}

/// Whether a phase has one acceleration.
fn is_steady(phase: &Phase) -> bool {
    phase.kind == PhaseKind::ConstantAcceleration
}

/// The ramp of each axis of the converter between two switching instants.
fn ramps<'a>(
    model: &'a PowerModel,
    converter: &ConverterPower,
    mv: &Move,
    profiles: &[(usize, Profile)],
    start: f64,
    end: f64,
) -> ArrayVec<Ramp<'a>, AXES> {
    profiles
        .iter()
        .filter(|(axis, _)| converter.axes.contains(*axis))
        .take(AXES)
        .map(|(axis, profile)| {
            let power = &model.axes[*axis];
            let unit = power.si_per_unit.copysign(mv.end[*axis] - mv.start[*axis]);
            let (v0, v1, a) = motion(profile, start, end);
            Ramp {
                axis: power,
                start: unit * v0,
                end: unit * v1,
                accel: unit * a,
            }
        })
        .collect()
}

/// Speeds at both instants, and the acceleration between them; all 0 once the
/// axis has arrived. No switching instant lies between the two.
fn motion(profile: &Profile, start: f64, end: f64) -> (f64, f64, f64) {
    let middle = 0.5 * (start + end);
    let mut from = 0.0;
    for phase in &profile.phases {
        let to = from + phase.duration_s;
        if middle < to {
            return (
                speed(phase, (start - from).max(0.0)),
                speed(phase, end - from),
                phase.accel_mm_s2,
            );
        }
        from = to;
    }
    (0.0, 0.0, 0.0)
}

/// Speed `t` seconds into a phase; exactly its end speed at the end.
fn speed(phase: &Phase, t: f64) -> f64 {
    if t >= phase.duration_s {
        phase.end_velocity_mm_s
    } else {
        phase.state_at(t).velocity_mm_s
    }
}

/// What the axes draw while they hold their weight, W.
fn holding_w(model: &PowerModel, axes: AxisSet) -> f64 {
    axes.iter().map(|axis| model.axes[axis].holding_w()).sum()
}
