//! Ramps of speed under a limit of jerk and a curve of acceleration over speed.
//!
//! Input: the kinks of the curve, straight between them, a top speed and a jerk.
//! Output: the phases of the fastest ramp from rest to that speed, without
//! acceleration at both ends.
//!
//! With `q = a²` over the speed v a jerk of J is a slope of `dq/dv = 2·J`. So
//! the ramp may have any q that nowhere exceeds the curve and nowhere changes
//! faster than that, and is 0 at both ends. The largest of them,
//!
//! ```text
//!  q │      ╱╲              q(v) = min over u of c(u)² + 2·J·|v − u|,
//!    │     ╱  ╲___ c²       c the curve, 0 at both ends,
//!    │    ╱       ╲
//!    │   ╱         ╲        is at each speed the hardest acceleration, and so
//!    └──────────────→ v     the fastest ramp.
//! ```
//!
//! The minimum is taken where u is v, a kink, an end, or a place where the curve
//! itself is as steep as the jerk permits, `|a·da/dv| = J`.

use super::phase::{Phase, PhaseKind};
use super::profile::{Phases, Profile};
use super::slope;
use smallvec::SmallVec;

/// Steps at most in the search for a top speed.
const STEPS: u32 = 100;

/// A point of a curve: speed in mm/s, acceleration in mm/s².
pub(super) type Kink = (f64, f64);
/// The points of a curve, at growing speeds.
pub(super) type Kinks = SmallVec<[Kink; 16]>;

/// A place on the speed axis between which the curve is one straight line, and as
/// steep as the jerk permits either nowhere or everywhere.
#[derive(Debug, Clone, Copy)]
struct Node {
    v: f64,
    /// Acceleration of the curve.
    accel: f64,
    /// Squared acceleration of the ramp.
    q: f64,
}

/// How the acceleration runs from one speed to the next.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Law {
    /// A constant jerk, mm/s³.
    Jerk(f64),
    /// The curve: change of acceleration by change of speed, 1/s.
    Slope(f64),
}

/// A piece of a ramp.
#[derive(Debug, Clone, Copy)]
struct Piece {
    law: Law,
    from: Kink,
    to: Kink,
}

/// The fastest ramp from rest to `top` mm/s, which the curve reaches, with a jerk
/// of at most `jerk` mm/s³; positions begin at 0. `kinks` begin at rest, all
/// accelerations positive.
pub(super) fn speed_up(kinks: &[Kink], top: f64, jerk: f64) -> Phases {
    let mut position = 0.0;
    let phases = pieces(kinks, top, jerk).into_iter().map(|piece| {
        let phase = piece.phase(position);
        position += phase.length_mm();
        phase
    });
    phases.collect()
}

/// The same in reverse: from `top` mm/s to rest.
pub(super) fn slow_down(kinks: &[Kink], top: f64, jerk: f64) -> Phases {
    let mut position = 0.0;
    let phases = pieces(kinks, top, jerk).into_iter().rev().map(|piece| {
        let up = piece.phase(0.0);
        let phase = Phase {
            kind: match up.kind {
                PhaseKind::ConstantSlope { slope_per_s } => PhaseKind::ConstantSlope {
                    slope_per_s: -slope_per_s,
                },
                kind => kind,
            },
            position_mm: position,
            velocity_mm_s: up.end_velocity_mm_s,
            end_velocity_mm_s: up.velocity_mm_s,
            accel_mm_s2: -piece.to.1,
            ..up
        };
        position += phase.length_mm();
        phase
    });
    phases.collect()
}

fn pieces(kinks: &[Kink], top: f64, jerk: f64) -> SmallVec<[Piece; 16]> {
    let nodes = nodes(kinks, top, jerk);
    let mut pieces = SmallVec::new();
    for (left, right) in nodes.iter().zip(nodes.iter().skip(1)) {
        between(*left, *right, jerk, &mut pieces);
    }
    pieces
}

/// The kinks below `top`, what lies between them where the curve becomes too
/// steep, and both ends; each with the squared acceleration of the ramp.
fn nodes(kinks: &[Kink], top: f64, jerk: f64) -> SmallVec<[Node; 16]> {
    let node = |v: f64, accel: f64| Node {
        v,
        accel,
        q: accel * accel,
    };
    let mut nodes = SmallVec::<[Node; 16]>::new();
    for (&(from, start), &(to, end)) in kinks.iter().zip(kinks.iter().skip(1)) {
        if from >= top {
            break;
        }
        nodes.push(node(from, start));
        let slope = (end - start) / (to - from);
        let steep = jerk / slope.abs();
        let at = from + (steep - start) / slope;
        if slope != 0.0 && at > from && at < to.min(top) {
            nodes.push(node(at, steep));
        }
        if to >= top {
            nodes.push(node(top, start + slope * (top - from)));
        }
    }
    if let Some(first) = nodes.first_mut() {
        first.q = 0.0;
    }
    if let Some(last) = nodes.last_mut() {
        last.q = 0.0;
    }
    let mut before: Option<Node> = None;
    for node in &mut nodes {
        if let Some(before) = before {
            node.q = node.q.min(before.q + 2.0 * jerk * (node.v - before.v));
        }
        before = Some(*node);
    }
    let mut after: Option<Node> = None;
    for node in nodes.iter_mut().rev() {
        if let Some(after) = after {
            node.q = node.q.min(after.q + 2.0 * jerk * (after.v - node.v));
        }
        after = Some(*node);
    }
    nodes
}

/// Appends what lies between two nodes: away from the left one with the jerk, along
/// the curve, and with the jerk to the right one.
fn between(left: Node, right: Node, jerk: f64, pieces: &mut SmallVec<[Piece; 16]>) {
    let width = right.v - left.v;
    if width <= 0.0 {
        return;
    }
    let slope = (right.accel - left.accel) / width;
    let is_steep = slope.abs() * 0.5 * (left.accel + right.accel) > jerk;
    let [up, down] = if is_steep {
        [width; 2]
    } else {
        [to_curve(left, slope, jerk), to_curve(right, -slope, jerk)]
    };
    let on_curve = |v: f64| left.accel + slope * (v - left.v);
    if up + down < width {
        let (first, last) = (left.v + up, right.v - down);
        let (start, end) = (on_curve(first), on_curve(last));
        push(
            pieces,
            Law::Jerk(jerk),
            (left.v, left.q.sqrt()),
            (first, start),
        );
        push(pieces, Law::Slope(slope), (first, start), (last, end));
        push(
            pieces,
            Law::Jerk(-jerk),
            (last, end),
            (right.v, right.q.sqrt()),
        );
        return;
    }
    // They meet below the curve.
    let up = (0.5 * width + (right.q - left.q) / (4.0 * jerk)).clamp(0.0, width);
    let meet = (left.v + up, (left.q + 2.0 * jerk * up).sqrt());
    push(pieces, Law::Jerk(jerk), (left.v, left.q.sqrt()), meet);
    push(pieces, Law::Jerk(-jerk), meet, (right.v, right.q.sqrt()));
}

/// How far from a node a ramp with the jerk meets the curve, which has `slope` in
/// that direction: `(c + s·x)² = q + 2·J·x`.
fn to_curve(node: Node, slope: f64, jerk: f64) -> f64 {
    let missing = node.accel * node.accel - node.q;
    if missing <= 0.0 {
        return 0.0;
    }
    let half = jerk - node.accel * slope;
    let root = half * half - slope * slope * missing;
    if half > 0.0 && root >= 0.0 {
        missing / (half + root.sqrt())
    } else {
        f64::INFINITY
    }
}

/// Appends a piece; one of the same jerk as the last goes on with it.
fn push(pieces: &mut SmallVec<[Piece; 16]>, law: Law, from: Kink, to: Kink) {
    if to.0 <= from.0 {
        return;
    }
    match pieces.last_mut() {
        Some(last) if last.law == law && matches!(law, Law::Jerk(_) | Law::Slope(0.0)) => {
            last.to = to;
        }
        _ => pieces.push(Piece { law, from, to }),
    }
}

impl Piece {
    /// As a phase that begins at `position_mm`.
    fn phase(&self, position_mm: f64) -> Phase {
        let ((v0, a0), (v1, a1)) = (self.from, self.to);
        let change = v1 - v0;
        let (kind, duration_s) = match self.law {
            Law::Jerk(jerk_mm_s3) => {
                // Of both ends' accelerations: exact where one is 0.
                (
                    PhaseKind::ConstantJerk { jerk_mm_s3 },
                    2.0 * change / (a0 + a1),
                )
            }
            Law::Slope(0.0) => (PhaseKind::ConstantAcceleration, change / a0),
            Law::Slope(slope_per_s) => (
                PhaseKind::ConstantSlope { slope_per_s },
                slope::time(a0, slope_per_s, change),
            ),
        };
        Phase {
            kind,
            duration_s,
            position_mm,
            velocity_mm_s: v0,
            end_velocity_mm_s: v1,
            accel_mm_s2: a0,
        }
    }
}

/// The fastest profile from rest to rest over `length` mm at up to `speed` mm/s
/// with a jerk of at most `jerk` mm/s³, under the curves `up` and `down`, which
/// both begin at rest and reach that speed.
pub(super) fn fastest(length: f64, speed: f64, jerk: f64, [up, down]: [&[Kink]; 2]) -> Profile {
    let ramps_mm =
        |v: f64| length_mm(&speed_up(up, v, jerk)) + length_mm(&slow_down(down, v, jerk));
    let mut top = speed;
    if ramps_mm(top) > length {
        // A higher speed takes longer ramps.
        let (mut low, mut high) = (0.0, speed);
        for _ in 0..STEPS {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            if ramps_mm(middle) > length {
                high = middle;
            } else {
                low = middle;
            }
        }
        top = low;
    }
    let mut profile = Profile {
        phases: speed_up(up, top, jerk),
    };
    let (up_mm, down) = (length_mm(&profile.phases), slow_down(down, top, jerk));
    let cruise_mm = length - up_mm - length_mm(&down);
    // Less than rounding makes of it is no cruise.
    if cruise_mm > 1e-12 * length {
        profile.phases.push(Phase {
            kind: PhaseKind::ConstantAcceleration,
            duration_s: cruise_mm / top,
            position_mm: up_mm,
            velocity_mm_s: top,
            end_velocity_mm_s: top,
            accel_mm_s2: 0.0,
        });
    }
    let from_mm = up_mm + cruise_mm.max(0.0);
    profile.phases.extend(down.into_iter().map(|phase| Phase {
        position_mm: from_mm + phase.position_mm,
        ..phase
    }));
    profile
}

fn length_mm(phases: &[Phase]) -> f64 {
    phases.iter().map(Phase::length_mm).sum()
}
