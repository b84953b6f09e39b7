//! What the drives of the axes permit: the acceleration that a curve of force
//! over speed leaves.
//!
//! Input: a machine with force curves, a move and its limits. Output: phases
//! that follow the curves, or the lowest acceleration up to a speed.
//!
//! ```text
//! up:   a(v) = (F(v) − Fc − b·v − Fg)/m      Fg in the direction of the motion
//! down: a(v) = (F(v) + Fc + b·v + Fg)/m
//! ```
//!
//! never more than the axis' own limit. On a straight path of direction `u` the
//! lowest of `a_n(|u_n|·v)/|u_n|` counts: straight lines over the speed, with
//! kinks. On an arc each axis has any speed up to the path's, so that the lowest up
//! to that counts, in the part that the arc rule leaves for speeding up.

use super::curve::{AccelCurve, fastest};
use super::driven_ramp::{self, Kink, Kinks};
use super::path_limits::PathLimits;
use super::profile::Profile;
use arrayvec::ArrayVec;
use gwatt_machine::{ALL_AXES, ArcRule, Axis, AxisKind, ForcePoint, Machine};
use gwatt_motion::{Arc, Move};
use smallvec::SmallVec;
use std::f64::consts::FRAC_1_SQRT_2;

/// Steps at most in the search for a speed.
const STEPS: u32 = 100;
/// No axis is faster, mm/s.
const FASTEST: f64 = 1e12;

/// Whether weight helps or hinders.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Heading {
    /// In + (1) or − (−1) direction.
    Known(f64),
    /// In both.
    Both,
}

/// An axis that moves on a path.
#[derive(Debug, Clone, Copy)]
struct Part {
    axis: usize,
    /// The largest speed of the axis at a path speed of 1.
    share: f64,
    /// Acceleration along the path at an acceleration of the axis of 1.
    path_per_axis: f64,
    heading: Heading,
}

/// The axes of a path.
type Parts = ArrayVec<Part, { 2 * gwatt_machine::AXES }>;

/// The points of an axis' curve; `None` without one.
fn points(machine: &Machine, axis: usize) -> Option<&[ForcePoint]> {
    let id = ALL_AXES.get(axis)?;
    let mut curves = machine.force_curves.iter();
    let (_, points) = curves.find(|(own, _)| own == id)?;
    Some(points)
}

/// Force at a speed; beyond the curve that of its end.
fn force(points: &[ForcePoint], speed: f64) -> f64 {
    let mut before: Option<&ForcePoint> = None;
    for point in points {
        if speed <= point.speed_mm_s {
            let Some(before) = before else {
                return point.force_n;
            };
            let share = (speed - before.speed_mm_s) / (point.speed_mm_s - before.speed_mm_s);
            return before.force_n + share * (point.force_n - before.force_n);
        }
        before = Some(point);
    }
    before.map_or(f64::INFINITY, |last| last.force_n)
}

/// The acceleration that is left at a speed of the axis, mm/s²: up and down.
fn left(axis: &Axis, points: &[ForcePoint], speed: f64, heading: Heading) -> [f64; 2] {
    let weights = match heading {
        Heading::Known(side) => [side * axis.gravity_n; 2],
        Heading::Both => [axis.gravity_n.abs(), -axis.gravity_n.abs()],
    };
    let force = force(points, speed);
    let friction = axis.coulomb_n + axis.viscous_n_s_m * speed * axis.si_per_unit;
    let by_force = 1.0 / (axis.mass_kg * axis.si_per_unit);
    [
        (force - friction - weights[0]) * by_force,
        (force + friction + weights[1]) * by_force,
    ]
}

/// The lowest acceleration, up or down, that the drive of an axis leaves at any
/// speed up to `speed`, mm/s²; infinite without a curve.
pub(super) fn lowest(machine: &Machine, axis: usize, speed: f64, heading: Heading) -> f64 {
    let (Some(points), Some(Some(own))) = (points(machine, axis), machine.axes.get(axis)) else {
        return f64::INFINITY;
    };
    let kinks = points.iter().map(|point| point.speed_mm_s);
    kinks
        .filter(|kink| *kink < speed)
        .chain([speed])
        .flat_map(|speed| left(own, points, speed, heading))
        .fold(f64::INFINITY, f64::min)
}

/// The lowest acceleration along a path at speeds up to `speed`, mm/s²; infinite for
/// an arc whose axes have all of their own up to there. How much of that the arc rule
/// gives to speeding up is not the drives' matter.
pub(super) fn lowest_on_path(machine: &Machine, mv: &Move, speed: f64) -> f64 {
    let parts = parts(machine, mv);
    let is_free = |part: &Part| {
        let own = mv.accel_mm_s2.get(part.axis).copied().unwrap_or(0.0);
        lowest(machine, part.axis, speed * part.share, part.heading) >= own
    };
    if mv.arc.is_some() && parts.iter().all(is_free) {
        return f64::INFINITY;
    }
    lowest_of(machine, &parts, speed)
}

fn lowest_of(machine: &Machine, parts: &[Part], speed: f64) -> f64 {
    parts.iter().fold(f64::INFINITY, |accel, part| {
        let own = lowest(machine, part.axis, speed * part.share, part.heading);
        accel.min(own * part.path_per_axis)
    })
}

/// The axes that a path moves.
fn parts(machine: &Machine, mv: &Move) -> Parts {
    match &mv.arc {
        Some(arc) => arc_parts(machine, mv, arc),
        None => crate::axis_limits::moving(machine, mv)
            .filter_map(|(axis, _)| in_proportion(mv, axis))
            .collect(),
    }
}

/// An axis that moves in proportion to the path, if it does.
fn in_proportion(mv: &Move, axis: usize) -> Option<Part> {
    let distance = mv.end.get(axis)? - mv.start.get(axis)?;
    let share = distance.abs() / mv.length_mm;
    (share > 0.0).then_some(Part {
        axis,
        share,
        path_per_axis: 1.0 / share,
        heading: Heading::Known(distance.signum()),
    })
}

/// Of an arc: what is left of each axis' acceleration for speeding up, whatever
/// directions it meets.
fn arc_parts(machine: &Machine, mv: &Move, of: &Arc) -> Parts {
    let plane = crate::arc_plane::plane_axes(machine, mv, of);
    let linux_cnc = machine.controller.planner.arc_rule == ArcRule::LinuxCnc;
    let along = if linux_cnc {
        crate::arc_plane::LINUXCNC_TANGENTIAL_SHARE
    } else {
        FRAC_1_SQRT_2
    };
    let mut parts = Parts::new();
    for (axis, own) in crate::axis_limits::moving(machine, mv) {
        let in_plane = plane.iter().find(|(plane, _)| *plane == axis);
        let across = in_plane.is_none();
        let part = in_proportion(mv, axis).filter(|_| across);
        // The rule shares the smallest acceleration of all linear axes.
        let shares = !across || (own.kind == AxisKind::Linear && !linux_cnc);
        let share =
            in_plane.map_or_else(|| part.map_or(0.0, |part| part.share), |(_, share)| *share);
        let turning = shares.then_some(Part {
            axis,
            share,
            path_per_axis: along,
            heading: Heading::Both,
        });
        parts.extend(part.into_iter().chain(turning));
    }
    parts
}

/// The largest speed, at most `speed`, at which a curve of radius `radius_mm` takes
/// no more than `normal_share` of what the drives leave of the acceleration of the
/// axes; each of them has at most so much of the speed.
pub(super) fn turning_speed(
    machine: &Machine,
    axes: [(usize, f64); 2],
    [radius_mm, plane_share, normal_share]: [f64; 3],
    speed: f64,
) -> f64 {
    let permits = |v: f64| {
        let in_plane = v * plane_share;
        let left = axes.map(|(axis, share)| lowest(machine, axis, v * share, Heading::Both));
        let left = left.into_iter().fold(f64::INFINITY, f64::min);
        in_plane * in_plane <= normal_share * left * radius_mm
    };
    if permits(speed) {
        return speed;
    }
    let (mut low, mut high) = (0.0, speed.min(FASTEST));
    for _ in 0..STEPS {
        let middle = 0.5 * (low + high);
        if permits(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// How a path runs under its limits and those of the drives.
pub(super) fn path(machine: &Machine, mv: &Move, limits: &PathLimits) -> Profile {
    if mv.arc.is_some() && lowest_on_path(machine, mv, limits.speed_mm_s) >= limits.accel_mm_s2 {
        return limits.profile(mv.length_mm);
    }
    follow(machine, &parts(machine, mv), mv.length_mm, limits)
}

/// The same for one axis that runs for itself over `length`.
pub(super) fn axis(
    machine: &Machine,
    axis: usize,
    length: f64,
    heading: f64,
    limits: &PathLimits,
) -> Profile {
    let alone = Part {
        axis,
        share: 1.0,
        path_per_axis: 1.0,
        heading: Heading::Known(heading),
    };
    follow(machine, &[alone], length, limits)
}

/// The ramps of a path between rest and its largest speed, however long they are,
/// without a limit of jerk: no motion under the limits draws or feeds back more.
pub(super) fn ramps(machine: &Machine, mv: &Move, limits: &PathLimits) -> Profile {
    let parts = parts(machine, mv);
    let curves = curves(machine, &parts, limits);
    if let Some((up, down)) = curves.as_ref().and_then(accel_curves) {
        let top = limits.speed_mm_s;
        let length = up.length_to(top) + down.length_to(top);
        if let Ok(profile) = fastest(length, top, &up, &down) {
            return profile;
        }
    }
    let v = limits.speed_mm_s;
    Profile::trapezoid(v * v / limits.accel_mm_s2, v, limits.accel_mm_s2)
}

fn follow(machine: &Machine, parts: &[Part], length: f64, limits: &PathLimits) -> Profile {
    if let Some(curves) = curves(machine, parts, limits) {
        let [up, down] = &curves;
        if limits.jerk_mm_s3 < f64::INFINITY {
            let bound = |kinks: &Kinks| kinks.iter().any(|kink| kink.1 < limits.accel_mm_s2);
            if !(bound(up) || bound(down)) {
                return limits.profile(length);
            }
            return driven_ramp::fastest(length, limits.speed_mm_s, limits.jerk_mm_s3, [up, down]);
        }
        if let Some((up, down)) = accel_curves(&curves)
            && let Ok(profile) = fastest(length, limits.speed_mm_s, &up, &down)
        {
            return profile;
        }
    }
    let mut low = *limits;
    low.accel_mm_s2 = low
        .accel_mm_s2
        .min(lowest_of(machine, parts, limits.speed_mm_s));
    low.profile(length)
}

fn accel_curves([up, down]: &[Kinks; 2]) -> Option<(AccelCurve, AccelCurve)> {
    Some((AccelCurve::points(up).ok()?, AccelCurve::points(down).ok()?))
}

/// The curves of a path up and down; `None` where a drive leaves nothing.
fn curves(machine: &Machine, parts: &[Part], limits: &PathLimits) -> Option<[Kinks; 2]> {
    let [up, down] = [0, 1].map(|side| curve(machine, parts, side, limits));
    Some([up?, down?])
}

/// The curve of a path up (0) or down (1); `None` where a drive leaves nothing.
fn curve(machine: &Machine, parts: &[Part], side: usize, limits: &PathLimits) -> Option<Kinks> {
    let top = limits.speed_mm_s;
    let mut speeds = SmallVec::<[f64; 16]>::new();
    speeds.push(0.0);
    for part in parts {
        for point in points(machine, part.axis).unwrap_or_default() {
            let speed = point.speed_mm_s / part.share;
            if speed > 0.0 && speed < top {
                speeds.push(speed);
            }
        }
    }
    speeds.push(top);
    speeds.sort_unstable_by(f64::total_cmp);
    let mut kinks = Kinks::new();
    for (&from, &to) in speeds.iter().zip(speeds.iter().skip(1)) {
        if to <= from {
            continue;
        }
        // Straight lines between two speeds: what each axis leaves, and the
        // limit.
        let mut lines = ArrayVec::<[f64; 2], { 2 * gwatt_machine::AXES + 1 }>::new();
        lines.push([limits.accel_mm_s2; 2]);
        for part in parts {
            let (Some(points), Some(Some(own))) =
                (points(machine, part.axis), machine.axes.get(part.axis))
            else {
                continue;
            };
            let at = |v: f64| {
                let both = left(own, points, v * part.share, part.heading);
                // Of an axis that turns, either may be asked for.
                let accel = match part.heading {
                    Heading::Known(_) => both.get(side).copied(),
                    Heading::Both => both.into_iter().reduce(f64::min),
                };
                accel.unwrap_or(0.0) * part.path_per_axis
            };
            lines.try_push([at(from), at(to)]).ok()?;
        }
        lowest_lines(&lines, [from, to], &mut kinks);
    }
    if parts.iter().any(|part| part.heading == Heading::Both) {
        // The axis has any speed up to that.
        kinks = never_rising(&kinks);
    }
    let positive = kinks.iter().all(|(_, accel)| *accel > 0.0);
    positive.then_some(kinks)
}

/// The lowest value of a curve up to each speed.
fn never_rising(kinks: &[Kink]) -> Kinks {
    let mut falling = Kinks::new();
    let mut before: Option<(Kink, f64)> = None;
    for &(v, accel) in kinks {
        let Some((last, low)) = before else {
            falling.push((v, accel));
            before = Some(((v, accel), accel));
            continue;
        };
        if accel < low && last.1 > low {
            // It comes down to the lowest so far on the way.
            let share = (last.1 - low) / (last.1 - accel);
            add(&mut falling, (last.0 + share * (v - last.0), low));
        }
        let low = low.min(accel);
        add(&mut falling, (v, low));
        before = Some(((v, accel), low));
    }
    falling
}

/// Appends the kinks of the lowest of straight lines, given by their values at
/// both ends of a range of speeds.
fn lowest_lines(lines: &[[f64; 2]], [from, to]: [f64; 2], kinks: &mut Kinks) {
    let at = |line: &[f64; 2], x: f64| line[0] + x * (line[1] - line[0]);
    let falls = |line: &[f64; 2]| line[1] - line[0];
    let mut x = 0.0;
    // Of those that meet at the start, the one that falls most.
    let first = |a: &&[f64; 2], b: &&[f64; 2]| {
        let order = a[0].total_cmp(&b[0]);
        order.then(falls(a).total_cmp(&falls(b)))
    };
    let Some(mut own) = lines.iter().min_by(first) else {
        return;
    };
    add(kinks, (from, own[0]));
    for _ in 0..lines.len() {
        // The first line that falls below it.
        let mut next: Option<(f64, &[f64; 2])> = None;
        for line in lines.iter().filter(|line| falls(line) < falls(own)) {
            let meets = (line[0] - own[0]) / (falls(own) - falls(line));
            let sooner = next.is_none_or(|(best, _)| meets < best);
            if meets > x && meets < 1.0 && sooner {
                next = Some((meets, line));
            }
        }
        let Some((meets, line)) = next else { break };
        add(kinks, (from + meets * (to - from), at(own, meets)));
        (x, own) = (meets, line);
    }
    add(kinks, (to, own[1]));
}

/// Appends a kink, unless the speed is the same or nothing bends.
fn add(kinks: &mut Kinks, kink: Kink) {
    if let Some(&last) = kinks.last() {
        if kink.0 <= last.0 {
            return;
        }
        let before = kinks.len().checked_sub(2).and_then(|i| kinks.get(i));
        if before.is_some_and(|before| before.1 == last.1 && last.1 == kink.1) {
            kinks.pop();
        }
    }
    kinks.push(kink);
}
