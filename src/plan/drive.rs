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
//! kinks. A profile has room for three of them on each side; where there are
//! more, three below them.

use super::curve::{AccelCurve, fastest};
use super::limits::{self, PathLimits};
use super::profile::Profile;
use crate::interpret::Move;
use crate::machine::{ALL_AXES, Axis, ForcePoint, Machine};
use arrayvec::ArrayVec;

/// Kinks of a path's curve, at most; beyond them the lowest acceleration counts.
const KINKS: usize = 24;
/// Pieces of each side of a profile.
const PIECES: usize = 3;

/// Whether weight helps or hinders.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Heading {
    /// In + (1) or − (−1) direction.
    Known(f64),
    /// In both.
    Both,
}

/// A point of a path's curve: speed in mm/s, acceleration in mm/s².
type Kink = (f64, f64);

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

/// The lowest acceleration along a straight path at speeds up to `speed`, mm/s².
pub(super) fn lowest_on_path(machine: &Machine, mv: &Move, speed: f64) -> f64 {
    let mut accel = f64::INFINITY;
    for (axis, share, heading) in shares(machine, mv) {
        let own = lowest(machine, axis, speed * share, heading);
        accel = accel.min(own / share);
    }
    accel
}

/// The axes that move on a straight path: what each has of it, and where to.
fn shares<'a>(
    machine: &'a Machine,
    mv: &'a Move,
) -> impl Iterator<Item = (usize, f64, Heading)> + use<'a> {
    limits::moving(machine, mv).filter_map(|(axis, _)| {
        let distance = mv.end[axis] - mv.start[axis];
        let share = distance.abs() / mv.length_mm;
        (share > 0.0).then_some((axis, share, Heading::Known(distance.signum())))
    })
}

/// How a straight path runs under its limits and those of the drives.
pub(super) fn path(machine: &Machine, mv: &Move, limits: &PathLimits) -> Profile {
    follow(machine, shares(machine, mv), mv.length_mm, limits)
}

/// The same for one axis that runs for itself over `length`.
pub(super) fn axis(
    machine: &Machine,
    axis: usize,
    length: f64,
    heading: f64,
    limits: &PathLimits,
) -> Profile {
    let alone = [(axis, 1.0, Heading::Known(heading))];
    follow(machine, alone.into_iter(), length, limits)
}

fn follow(
    machine: &Machine,
    shares: impl Iterator<Item = (usize, f64, Heading)>,
    length: f64,
    limits: &PathLimits,
) -> Profile {
    let shares: ArrayVec<_, { crate::machine::AXES }> = shares.take(crate::machine::AXES).collect();
    if limits.jerk_mm_s3 == f64::INFINITY {
        let [up, down] =
            [0, 1].map(|side| curve(machine, &shares, side, limits).and_then(|kinks| few(&kinks)));
        if let (Some(up), Some(down)) = (up, down)
            && let Ok(profile) = fastest(length, limits.speed_mm_s, &up, &down)
        {
            return profile;
        }
    }
    let mut low = *limits;
    for (axis, share, heading) in shares {
        let own = lowest(machine, axis, limits.speed_mm_s * share, heading);
        low.accel_mm_s2 = low.accel_mm_s2.min(own / share);
    }
    low.profile(length)
}

/// The curve of a path up (0) or down (1); `None` where it has too many kinks.
fn curve(
    machine: &Machine,
    shares: &[(usize, f64, Heading)],
    side: usize,
    limits: &PathLimits,
) -> Option<ArrayVec<Kink, KINKS>> {
    let top = limits.speed_mm_s;
    let mut speeds = ArrayVec::<f64, KINKS>::new();
    speeds.try_push(0.0).ok()?;
    for &(axis, share, _) in shares {
        for point in points(machine, axis).unwrap_or_default() {
            let speed = point.speed_mm_s / share;
            if speed > 0.0 && speed < top {
                speeds.try_push(speed).ok()?;
            }
        }
    }
    speeds.try_push(top).ok()?;
    speeds.sort_unstable_by(f64::total_cmp);
    let mut kinks = ArrayVec::<Kink, KINKS>::new();
    for (&from, &to) in speeds.iter().zip(speeds.iter().skip(1)) {
        if to <= from {
            continue;
        }
        // Straight lines between two speeds: what each axis leaves, and the
        // limit.
        let mut lines = ArrayVec::<[f64; 2], { crate::machine::AXES + 1 }>::new();
        lines.push([limits.accel_mm_s2; 2]);
        for &(axis, share, heading) in shares {
            let (Some(points), Some(Some(own))) = (points(machine, axis), machine.axes.get(axis))
            else {
                continue;
            };
            let at = |v: f64| {
                let both = left(own, points, v * share, heading);
                both.get(side).map_or(0.0, |accel| accel / share)
            };
            lines.try_push([at(from), at(to)]).ok()?;
        }
        lowest_lines(&lines, [from, to], &mut kinks)?;
    }
    let positive = kinks.iter().all(|(_, accel)| *accel > 0.0);
    positive.then_some(kinks)
}

/// Appends the kinks of the lowest of straight lines, given by their values at
/// both ends of a range of speeds.
fn lowest_lines(
    lines: &[[f64; 2]],
    [from, to]: [f64; 2],
    kinks: &mut ArrayVec<Kink, KINKS>,
) -> Option<()> {
    let at = |line: &[f64; 2], x: f64| line[0] + x * (line[1] - line[0]);
    let falls = |line: &[f64; 2]| line[1] - line[0];
    let mut x = 0.0;
    // Of those that meet at the start, the one that falls most.
    let first = |a: &&[f64; 2], b: &&[f64; 2]| {
        let order = a[0].total_cmp(&b[0]);
        order.then(falls(a).total_cmp(&falls(b)))
    };
    let mut own = lines.iter().min_by(first)?;
    add(kinks, (from, own[0]))?;
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
        add(kinks, (from + meets * (to - from), at(own, meets)))?;
        (x, own) = (meets, line);
    }
    add(kinks, (to, own[1]))
}

/// Appends a kink, unless the speed is the same or nothing bends.
fn add(kinks: &mut ArrayVec<Kink, KINKS>, kink: Kink) -> Option<()> {
    if let Some(&last) = kinks.last() {
        if kink.0 <= last.0 {
            return Some(());
        }
        let before = kinks.len().checked_sub(2).and_then(|i| kinks.get(i));
        if before.is_some_and(|before| before.1 == last.1 && last.1 == kink.1) {
            kinks.pop();
        }
    }
    kinks.try_push(kink).ok()
}

/// A curve with few pieces that is nowhere above the kinks, and as high as it
/// can be: of all with their corners at the speeds of kinks the fastest.
fn few(kinks: &[Kink]) -> Option<AccelCurve> {
    let last = kinks.len().checked_sub(1)?;
    if last <= PIECES {
        return AccelCurve::points(kinks).ok();
    }
    let mut best: Option<(f64, [Kink; PIECES + 1])> = None;
    for i in 1..last {
        for j in i + 1..last {
            let Some(corners) = below(kinks, [0, i, j, last]) else {
                continue;
            };
            // About the time to the top.
            let time = |pair: &[Kink]| match pair {
                [a, b] => (b.0 - a.0) * (1.0 / a.1 + 1.0 / b.1),
                _ => 0.0,
            };
            let time: f64 = corners.windows(2).map(time).sum();
            if best.is_none_or(|(fastest, _)| time < fastest) {
                best = Some((time, corners));
            }
        }
    }
    AccelCurve::points(&best?.1).ok()
}

/// Corners at these kinks, lowered until no kink lies below the lines between
/// them; `None` where nothing is left.
fn below(kinks: &[Kink], at: [usize; PIECES + 1]) -> Option<[Kink; PIECES + 1]> {
    let mut corners = [(0.0, 0.0); PIECES + 1];
    for (corner, index) in corners.iter_mut().zip(at) {
        *corner = *kinks.get(index)?;
    }
    let mut lower = [0.0_f64; PIECES + 1];
    for piece in 0..PIECES {
        let [a, b] = [corners.get(piece)?, corners.get(piece + 1)?];
        for kink in kinks.get(*at.get(piece)?..*at.get(piece + 1)?)? {
            let share = (kink.0 - a.0) / (b.0 - a.0);
            let above = a.1 + share * (b.1 - a.1) - kink.1;
            for own in lower.iter_mut().skip(piece).take(2) {
                *own = own.max(above);
            }
        }
    }
    for (corner, lower) in corners.iter_mut().zip(lower) {
        // A little more, for rounding.
        corner.1 -= lower * (1.0 + 1e-12);
    }
    let positive = corners.iter().all(|corner| corner.1 > 0.0);
    positive.then_some(corners)
}
