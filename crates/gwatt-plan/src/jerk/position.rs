//! To a position with a speed and an acceleration: up to seven phases.
//!
//! Input: two states and the limits. Output: the fastest profile.
//!
//! A start outside the limits is brought in first. The rest is put into units
//! in which the jerk and the larger limit of acceleration are 1, and solved by
//! `family` twice: with the signs as they are, and all changed.

use super::State;
use super::bring_in::bring_in;
use super::family::{Task, Way, fastest};
use super::limits::{JerkError, JerkLimits};
use super::profile::JerkProfile;

/// How far a target may be outside by rounding, relative to the limits.
const ROUNDING: f64 = 1e-12;
/// How much a way may miss the distance by, relative to its terms.
const MISSED: f64 = 1e-10;

/// The fastest profile from one state to another.
///
/// # Errors
///
/// Where a limit or the start is not finite, where the target is outside the
/// limits or only states outside lead to it, and where the path must run
/// backwards but `min_speed_mm_s` is 0 (or forwards with a largest speed of 0).
/// Otherwise there is always a profile.
pub fn position_target(
    start: State,
    target: State,
    limits: &JerkLimits,
) -> Result<JerkProfile, JerkError> {
    let (v_max, v_min) = (limits.max_speed_mm_s, limits.min_speed_mm_s);
    let speeds_fit = v_max >= 0.0 && v_min <= 0.0 && (v_max - v_min).is_finite();
    if !(limits.drive() && speeds_fit && v_min < v_max) {
        return Err(JerkError::Limits);
    }
    if !(start.position_mm + start.velocity_mm_s + start.accel_mm_s2).is_finite() {
        return Err(JerkError::Start);
    }
    if !(target.position_mm.is_finite() && reachable(target, limits)) {
        return Err(JerkError::Target);
    }
    let mut profile = JerkProfile::new(start);
    bring_in(&mut profile, limits);
    let from = profile.end;
    let up = fastest(&task(from, target, limits, 1.0));
    let down = fastest(&task(from, target, limits, -1.0));
    let (way, sign) = match (up, down) {
        (Some((miss, way)), Some((other_miss, other))) => {
            // One that misses the target only counts where none hits it.
            if (other_miss, other.total) < (miss, way.total) {
                ((other_miss, other), -1.0)
            } else {
                ((miss, way), 1.0)
            }
        }
        (Some(way), None) => (way, 1.0),
        (None, Some(way)) => (way, -1.0),
        (None, None) => return Err(JerkError::Target),
    };
    if way.0.is_nan() || way.0 > MISSED {
        return Err(JerkError::Target);
    }
    follow(&mut profile, way.1, sign, target, limits);
    let State {
        position_mm,
        velocity_mm_s,
        accel_mm_s2,
    } = target;
    profile.arrive(position_mm, velocity_mm_s, accel_mm_s2);
    Ok(profile)
}

/// Whether states within the limits lead to a target.
fn reachable(target: State, limits: &JerkLimits) -> bool {
    let (v, a) = (target.velocity_mm_s, target.accel_mm_s2);
    // The speed at which a was last 0, at the latest.
    let before = v + a * a.abs() / (-2.0 * limits.jerk_mm_s3);
    let slack = ROUNDING * (limits.max_speed_mm_s - limits.min_speed_mm_s);
    let within = |v: f64| v <= limits.max_speed_mm_s + slack && v >= limits.min_speed_mm_s - slack;
    a <= limits.max_accel_mm_s2 && a >= limits.min_accel_mm_s2 && within(v) && within(before)
}

/// The larger limit of acceleration, the unit of the task.
fn accel_unit(limits: &JerkLimits) -> f64 {
    limits.max_accel_mm_s2.max(-limits.min_accel_mm_s2)
}

/// The task in units of the jerk and the larger acceleration, with all signs
/// times `sign`.
fn task(from: State, target: State, limits: &JerkLimits, sign: f64) -> Task {
    let a = accel_unit(limits);
    let time = a / limits.jerk_mm_s3;
    let v = a * time;
    let scaled = |state: State| [sign * state.velocity_mm_s / v, sign * state.accel_mm_s2 / a];
    let (rise, fall, speed) = if sign > 0.0 {
        (
            limits.max_accel_mm_s2,
            -limits.min_accel_mm_s2,
            limits.max_speed_mm_s,
        )
    } else {
        (
            -limits.min_accel_mm_s2,
            limits.max_accel_mm_s2,
            -limits.min_speed_mm_s,
        )
    };
    Task {
        start: scaled(from),
        end: scaled(target),
        distance: sign * (target.position_mm - from.position_mm) / (v * time),
        rise: rise / a,
        fall: fall / a,
        speed: speed / v,
    }
}

/// Appends the phases of a way.
fn follow(profile: &mut JerkProfile, way: Way, sign: f64, target: State, limits: &JerkLimits) {
    let unit = accel_unit(limits);
    let j = sign * limits.jerk_mm_s3;
    let time = unit / limits.jerk_mm_s3;
    let clamped = |a: f64| (sign * unit * a).clamp(limits.min_accel_mm_s2, limits.max_accel_mm_s2);
    profile.ramp(clamped(way.peak), j);
    profile.hold(way.peak_hold * time);
    let mut cruise = None;
    if way.cruise > 0.0 {
        profile.ramp(0.0, -j);
        profile.level(if sign > 0.0 {
            limits.max_speed_mm_s
        } else {
            limits.min_speed_mm_s
        });
        cruise = Some(profile.phases.len());
        profile.hold(way.cruise * time);
    }
    profile.ramp(clamped(way.trough), -j);
    profile.hold(way.trough_hold * time);
    profile.ramp(target.accel_mm_s2, j);
    // Of a long cruise, rounding of the speeds is many mm: it takes that up.
    if let Some(cruise) = cruise {
        profile.lengthen(cruise, target.position_mm - profile.end.position_mm);
    }
}
