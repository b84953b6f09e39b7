//! The last element of `LinuxCNC`'s queue, and what overlaps in a parabolic blend.
//!
//! Input: elements as the rule hands them on. Output: what is left of them between
//! blends, with the speeds and accelerations that the planner gives them; how long
//! an element runs while the one before it still brakes.

use super::super::arc::{self};
use super::super::arc_plane::LINUXCNC_TANGENTIAL_SHARE as TANGENTIAL_SHARE;
use super::super::axis_limits::lower;
use super::blend::{Circle, Leg, Side, angle_between};
use super::element::{Element, Joint};
use super::pieces::Piece;
use super::ramp::Slack;
use super::vector::{Vector, add, cross, dot, scale, sub, unit};
use gwatt_machine::AXES;

/// The last element: a blend may still take a piece of it.
#[derive(Debug, Clone)]
pub(super) struct Pending<T> {
    pub element: Element<T>,
    /// Of several elements that became one line: the first.
    pub first: T,
    /// It is a line in place of the element's path.
    pub is_line: bool,
    /// What the blend before it took, mm of path.
    pub from_mm: f64,
    /// And what is left, mm.
    pub length_mm: f64,
    /// Of an arc: what is left of its angle.
    pub sweep_rad: f64,
    pub max_speed: f64,
    /// F at the largest feed override, mm/s: how joints are passed is decided for that,
    /// wherever the knob stands.
    pub expected_mm_s: f64,
    /// The pace of the element before it, which it is entered at.
    pub pace_before: f64,
    /// It may be entered faster than it runs, the change of pace comes late, and it is too
    /// short to come down to its own.
    pub lags: bool,
    /// The element before it may have ended before this one is queued: it then keeps all of its
    /// acceleration.
    pub comes_late: bool,
    /// At some lower override it may keep all of its acceleration at a joint in which it
    /// overlaps here.
    pub keeps_all: bool,
    /// See [`Planned::late_mm_s`](super::Planned::late_mm_s).
    pub late_mm_s: f64,
    /// Share of the acceleration given up to the kinks before and after.
    pub kink_before: f64,
    pub kink_behind: f64,
    /// A parabolic blend before it, and one after it, which take half of its
    /// acceleration. Next to an element that moves axes other than X, Y and Z the
    /// one before it takes none, though the elements overlap.
    pub blended_before: bool,
    pub blended_after: bool,
    /// After it there is a stop.
    pub rests: bool,
    /// The element before it, where it begins while that brakes.
    pub braking: Option<Braking>,
    /// Largest speed at its start, squared.
    pub entry2: f64,
}

impl<T: Copy> Pending<T> {
    pub fn new(element: &Element<T>, first: T) -> Self {
        Self {
            element: *element,
            first,
            is_line: false,
            from_mm: 0.0,
            length_mm: 0.0,
            sweep_rad: 0.0,
            max_speed: 0.0,
            expected_mm_s: element.feed_mm_s,
            pace_before: element.pace,
            lags: false,
            comes_late: false,
            keeps_all: false,
            late_mm_s: 0.0,
            kink_before: 0.0,
            kink_behind: 0.0,
            blended_before: false,
            blended_after: false,
            rests: false,
            braking: None,
            entry2: 0.0,
        }
    }

    /// Nothing has changed it yet.
    pub fn begin(&mut self, is_line: bool, cycle_s: f64, feed_ratio: f64) {
        let element = &self.element;
        let max_speed = element.speed_mm_s.min(element.curve_speed_mm_s);
        self.is_line = is_line;
        self.expected_mm_s = if element.rapid {
            f64::INFINITY
        } else {
            element.feed_mm_s / element.pace * feed_ratio
        };
        (self.pace_before, self.lags, self.late_mm_s) = (element.pace, false, 0.0);
        (self.comes_late, self.keeps_all) = (false, false);
        self.from_mm = 0.0;
        self.length_mm = element.length_mm;
        self.sweep_rad = element.curve.map_or(0.0, |curve| curve.sweep_rad.abs());
        self.max_speed = max_speed.min(element.length_mm / cycle_s);
        (self.kink_before, self.kink_behind) = (0.0, 0.0);
        (self.blended_before, self.blended_after) = (false, false);
        self.rests = false;
        self.braking = None;
        self.entry2 = 0.0;
    }

    /// The speed that it is decided for.
    pub fn target_speed(&self) -> f64 {
        self.expected_mm_s.min(self.max_speed)
    }

    /// The speed that it runs at.
    pub fn run_speed(&self) -> f64 {
        self.element.feed_mm_s.min(self.max_speed)
    }

    /// Whether it begins at rest and may take no longer than `least_s`.
    pub fn is_brief(&self, least_s: f64) -> bool {
        (self.entry2 == 0.0 || self.comes_late)
            && 4.0 * self.element.length_mm <= self.accel() * least_s * least_s
    }

    /// How far lower overrides may go beyond its plan.
    pub fn slack(&self) -> Slack {
        if !self.keeps_all {
            return Slack::default();
        }
        Slack {
            accel_mm_s2: self.accel(),
            chord2: f64::INFINITY,
            ..Slack::default()
        }
    }

    /// The same while the pace of the element before it is still in force.
    pub fn seen_speed(&self) -> f64 {
        if self.pace_before == self.element.pace {
            return self.run_speed();
        }
        let feed_mm_s = self.element.feed_mm_s / self.element.pace * self.pace_before;
        feed_mm_s.min(self.max_speed)
    }

    /// The acceleration before any share is taken off.
    pub fn accel(&self) -> f64 {
        match &self.element.curve {
            Some(curve) => curve.accel_mm_s2.min(self.element.path_accel_mm_s2),
            None => self.element.accel_mm_s2,
        }
    }

    /// The share of its acceleration that a parabolic blend leaves.
    pub fn unbent_share(&self) -> f64 {
        0.5 * self.straight_share()
    }

    /// The share that the kinks on both sides leave.
    fn straight_share(&self) -> f64 {
        1.0 - self.kink_before.max(self.kink_behind)
    }

    /// The share that it keeps. It is the `last` where nothing waits after it: then
    /// its mode takes what a blend would.
    pub fn kept_share(&self, last: bool) -> f64 {
        if self.blended_before || self.blended_after {
            self.unbent_share()
        } else if last {
            self.unseen_share()
        } else {
            self.straight_share()
        }
    }

    /// The share that it keeps while nothing waits after it.
    fn unseen_share(&self) -> f64 {
        match self.element.joint {
            Joint::Blend { .. } => self.unbent_share(),
            _ => self.straight_share(),
        }
    }

    /// The speed, squared, with which the planner enters it while nothing waits after it: half
    /// of it is enough to stop.
    pub fn unseen2(&self) -> f64 {
        let share = match self.element.joint {
            Joint::Blend { .. } => 0.5,
            _ if self.blended_before => 0.5,
            _ => 1.0,
        };
        let along = self.element.curve.map_or(1.0, |_| TANGENTIAL_SHARE);
        let accel = share * along * (1.0 - self.kink_before) * self.accel();
        let length_mm = self.element.length_mm - self.from_mm;
        lower(accel * length_mm, self.expected_mm_s * self.expected_mm_s)
    }

    /// Whether it overlaps with the element before or after it: its path is known
    /// within the tolerance only.
    pub fn overlaps(&self) -> bool {
        self.blended_after || self.braking.is_some()
    }

    /// Gives up `mm` of path at the start or at the end.
    pub fn trim(&mut self, by: f64, at_start: bool) {
        let mm = match &self.element.curve {
            Some(curve) => by * self.element.length_mm / curve.sweep_rad.abs(),
            None => by,
        };
        self.sweep_rad -= by;
        self.length_mm -= mm;
        if at_start {
            self.from_mm += mm;
        }
    }

    pub fn side(&self, at_end: bool) -> Option<Side> {
        let element = &self.element;
        let change = if at_end { &element.end } else { &element.start };
        let along = [change[0], change[1], change[2]];
        let circle = match &element.curve {
            None => None,
            Some(curve) => {
                let [first, second] = curve.plane;
                let mut flat = [0.0; 3];
                let mut normal = [0.0; 3];
                *flat.get_mut(first)? = *along.get(first)?;
                *flat.get_mut(second)? = *along.get(second)?;
                let third = 3_usize.checked_sub(first + second)?;
                let right_handed = (second + 3 - first) % 3 == 1;
                let up = curve.sweep_rad.signum();
                *normal.get_mut(third)? = if right_handed { up } else { -up };
                let inward = unit(cross(normal, flat))?;
                Some(Circle {
                    center: scale(inward, curve.radius_mm),
                    radius: curve.radius_mm,
                    angle: self.sweep_rad,
                    normal,
                })
            }
        };
        let leg = self.leg(unit(along)?);
        Some(Side { leg, circle })
    }

    /// A side of a joint that it is passed in this direction.
    fn leg(&self, tangent: Vector) -> Leg {
        let element = &self.element;
        Leg {
            tangent,
            nominal_mm: element.length_mm,
            length_mm: self.length_mm,
            max_speed: self.max_speed,
            asked_speed: self.expected_mm_s,
            tolerance_mm: match element.joint {
                Joint::Blend { tolerance_mm, .. } => tolerance_mm,
                _ => 0.0,
            },
        }
    }

    /// What is left of it.
    pub fn piece(&self) -> Piece {
        if self.is_line {
            Piece::Joined {
                direction: self.element.start,
            }
        } else {
            Piece::Along {
                from_mm: self.from_mm,
                to_mm: self.from_mm + self.length_mm,
            }
        }
    }

    /// The speed of an arc and the acceleration along it, of those that it has
    /// without its curvature.
    pub fn turning(&self, max_speed: f64, accel: f64) -> (f64, f64) {
        let Some(curve) = &self.element.curve else {
            return (max_speed, accel);
        };
        let radius_mm = curve.radius_mm + curve.rise_mm * curve.rise_mm / curve.radius_mm;
        arc::linuxcnc(max_speed, accel, radius_mm)
    }

    /// The speed that the interpreter asks for: F, as far as the axes and turning in
    /// the plane permit it. Of a helix the planner permits less.
    pub fn asked_speed(&self) -> f64 {
        let element = &self.element;
        let asked = lower(self.expected_mm_s, element.speed_mm_s);
        let Some(curve) = &element.curve else {
            return asked;
        };
        let limits = curve.plane.iter();
        let limits = limits.filter_map(|axis| element.axis_accel_mm_s2.get(*axis));
        let accel = limits.copied().fold(f64::INFINITY, lower);
        let share = curve.radius_mm * curve.sweep_rad.abs() / element.length_mm;
        lower(asked, arc::linuxcnc_turning(accel, curve.radius_mm) / share)
    }

    /// Unit direction in which the planner expects an end to pull, with a share of its
    /// acceleration. An arc pulls in its plane; at its start it turns towards the centre, by what half of the
    /// speed asked for needs.
    fn pull(&self, at_end: bool, share: f64) -> Option<Vector> {
        let Some(side) = self.side(at_end) else {
            // Where X, Y and Z stand the planner takes the first axis.
            return Some([1.0, 0.0, 0.0]);
        };
        let Some(circle) = &side.circle else {
            return Some(side.leg.tangent);
        };
        let across = dot(side.leg.tangent, circle.normal);
        let flat = unit(sub(side.leg.tangent, scale(circle.normal, across)))?;
        if at_end {
            return Some(flat);
        }
        let half = 0.5 * self.asked_speed();
        let inward = scale(unit(circle.center)?, half * half / circle.radius);
        unit(add(scale(flat, share * self.accel()), inward))
    }

    /// How it leaves a parabolic blend that comes after it.
    fn leaving(&self) -> Leaving {
        let tolerance_mm = match self.element.joint {
            Joint::Blend { tolerance_mm, .. } => tolerance_mm,
            _ => 0.0,
        };
        Leaving {
            pull: self.pull(true, 1.0),
            tolerance_mm,
        }
    }

    /// The speed along the mean direction that the planner expects of a parabolic
    /// blend when it chooses one; with the `whole` acceleration of this element, if no
    /// parabolic blend before it takes half of that.
    pub fn overlap(&self, next: &Self, whole: bool) -> f64 {
        let twice = |yes| if yes { 2.0 } else { 1.0 };
        let whole = twice(whole && !self.blended_before);
        // So far only its own mode may take half of the next one's.
        let next_whole = twice(!matches!(next.element.joint, Joint::Blend { .. }));
        let share = next_whole * next.unbent_share();
        let first = self.unseen(self.asked_speed(), whole * self.unbent_share());
        let second = next.unseen(next.asked_speed(), share);
        let (most, sin) = self.leaving().tolerated(first.accel, next, share);
        let [first, second] = Ramp::overlap([&first, &second]);
        0.5 * sin * (first.min(most) + second.min(most))
    }

    /// How long it runs while the element before it brakes, s. It is the `last` where
    /// nothing waits after it: then it has not been looked at closely.
    pub fn overlap_s(&self, last: bool) -> f64 {
        let Some(braking) = &self.braking else {
            return 0.0;
        };
        let ramp = if last {
            self.unseen(self.run_speed(), self.kept_share(true))
        } else {
            self.ramp()
        };
        let (ahead, share) = (braking.ramp, self.kept_share(last));
        let (most, _) = braking.leaving.tolerated(ahead.accel, self, share);
        let [brakes_from, _] = Ramp::overlap([&ahead, &ramp]);
        brakes_from.min(most) / ahead.accel
    }

    /// Its ramp.
    fn ramp(&self) -> Ramp {
        let accel = self.kept_share(false) * self.accel();
        let (speed, accel) = self.turning(self.max_speed, accel);
        Ramp::new(self.length_mm, speed.min(self.element.feed_mm_s), accel)
    }

    /// Its ramp before it is known how sharply it turns, and how much of it, up to one
    /// half, what follows takes.
    fn unseen(&self, max_speed: f64, share: f64) -> Ramp {
        let along = self.element.curve.map_or(1.0, |_| TANGENTIAL_SHARE);
        let accel = share * along * self.accel();
        let peak = (0.5 * accel * self.length_mm).sqrt();
        Ramp::new(self.length_mm, max_speed.min(peak), accel)
    }

    /// Whether axes other than X, Y and Z move.
    pub fn rotates(&self) -> bool {
        let changes = &self.element.start;
        (3..AXES).any(|axis| changes.get(axis).is_some_and(|change| *change != 0.0))
    }
}

/// One side of a parabolic blend, where the next element begins while the last
/// one still brakes, both with half of their acceleration.
#[derive(Debug, Clone, Copy)]
struct Ramp {
    accel: f64,
    length_mm: f64,
    /// The most that it gets to from rest.
    speed: f64,
}

impl Ramp {
    fn new(length_mm: f64, max_speed: f64, accel: f64) -> Self {
        let peak = (accel * length_mm).sqrt();
        Self {
            accel,
            length_mm,
            speed: peak.min(max_speed),
        }
    }

    /// The speeds from which the first brakes while the next one begins, and to
    /// which that gets meanwhile: as long as the longer ramp takes, if both are
    /// long enough.
    fn overlap(sides: [&Self; 2]) -> [f64; 2] {
        let longest_s = sides.map(|side| side.speed / side.accel);
        let most_s = sides.map(|side| side.length_mm / side.speed);
        let lasts_s = longest_s[0].max(longest_s[1]).min(most_s[0].min(most_s[1]));
        sides.map(|side| side.speed.min(lasts_s * side.accel))
    }
}

/// An element that brakes while the next one begins.
#[derive(Debug, Clone, Copy)]
pub(super) struct Braking {
    ramp: Ramp,
    leaving: Leaving,
}

impl Braking {
    pub fn of<T: Copy>(before: &Pending<T>) -> Self {
        Self {
            ramp: before.ramp(),
            leaving: before.leaving(),
        }
    }
}

/// How the first element of a parabolic blend comes to its corner.
#[derive(Debug, Clone, Copy)]
struct Leaving {
    /// The direction in which the planner expects it to pull.
    pull: Option<Vector>,
    /// How far the corner may be left, mm; 0: as far as it takes.
    tolerance_mm: f64,
}

impl Leaving {
    /// The speed that the tolerance permits, and the sine of half the angle inside the
    /// corner; `accel` of this element, of the next one a share of its own.
    fn tolerated<T: Copy>(&self, accel: f64, next: &Pending<T>, share: f64) -> (f64, f64) {
        let (Some(first), Some(second)) = (self.pull, next.pull(false, share)) else {
            return (f64::INFINITY, 0.0);
        };
        let (sin, cos) = libm::sincos(0.5 * angle_between(first, second));
        let most = if self.tolerance_mm > 0.0 && cos > 1e-3 {
            2.0 * (accel * self.tolerance_mm / cos).sqrt()
        } else {
            f64::INFINITY
        };
        (most, sin)
    }
}
