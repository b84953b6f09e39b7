//! The trajectory planner of `LinuxCNC` 2.9 as rules.
//!
//! Input: elements, one by one. Output: nodes for the window, with blends
//! between them. The last element waits for its successor: a blend takes a
//! piece of both, and one that finds no successor in the queue (before a stop
//! that a word causes) keeps half of its acceleration in G64.
//!
//! A joint is passed without a blend where the step of velocity, over one servo
//! cycle, takes no more than `kink_ratio` of an axis' acceleration; both
//! elements give that share up. Facts from `tp.c`, `tc.c` and measurements.

use super::super::arc::{self, LINUXCNC_TANGENTIAL_SHARE as TANGENTIAL_SHARE};
use super::blend::{Axes, Circle, Fit, Side, angle_between, fit};
use super::element::{Element, Joint};
use super::join::Joiner;
use super::planner::{Blend, Load, Piece};
use super::vector::{Vector, add, cross, dot, scale, sub, unit};
use super::window::{Node, Window};
use crate::machine::AXES;

/// Cycles that an element lasts at least.
const CYCLES_MIN: f64 = 1.02;
/// A reversal within two degrees is a stop.
const REVERSAL2: f64 = 0.034_906_585_039_886_59 * 0.034_906_585_039_886_59;

#[derive(Debug, Clone)]
pub(super) struct LinuxCnc<T> {
    axes: Axes,
    cycle_s: f64,
    kink_ratio: f64,
    gap_cycles: f64,
    pending: Option<Box<Pending<T>>>,
    /// Room for the next one.
    spare: Option<Box<Pending<T>>>,
    joiner: Joiner<T>,
}

/// The last element: a blend may still take a piece of it.
#[derive(Debug, Clone)]
struct Pending<T> {
    element: Element<T>,
    /// Of several elements that became one line: the first.
    first: T,
    /// It is a line in place of the element's path.
    is_line: bool,
    /// What the blend before it took, mm of path.
    from_mm: f64,
    /// And what is left, mm.
    length_mm: f64,
    /// Of an arc: what is left of its angle.
    sweep_rad: f64,
    max_speed: f64,
    /// Share of the acceleration given up to the kinks before and behind.
    kink_before: f64,
    kink_behind: f64,
    /// A parabolic blend before or behind it: its path is known within the
    /// tolerance only.
    parabolic: bool,
    /// The element before it, where it begins while that brakes.
    braking: Option<Braking>,
    /// Largest speed at its start, squared.
    entry2: f64,
}

enum Way {
    Stop,
    Pass(f64),
    Parabolic,
    Blend(Fit),
}

impl<T: Copy> Pending<T> {
    fn new(element: &Element<T>, first: T) -> Self {
        Self {
            element: *element,
            first,
            is_line: false,
            from_mm: 0.0,
            length_mm: 0.0,
            sweep_rad: 0.0,
            max_speed: 0.0,
            kink_before: 0.0,
            kink_behind: 0.0,
            parabolic: false,
            braking: None,
            entry2: 0.0,
        }
    }

    /// Nothing has changed it yet.
    fn begin(&mut self, is_line: bool, cycle_s: f64) {
        let element = &self.element;
        let max_speed = element.speed_mm_s.min(element.curve_speed_mm_s);
        self.is_line = is_line;
        self.from_mm = 0.0;
        self.length_mm = element.length_mm;
        self.sweep_rad = element.curve.map_or(0.0, |curve| curve.sweep_rad.abs());
        self.max_speed = max_speed.min(element.length_mm / cycle_s);
        (self.kink_before, self.kink_behind) = (0.0, 0.0);
        self.parabolic = false;
        self.braking = None;
        self.entry2 = 0.0;
    }

    fn target_speed(&self) -> f64 {
        self.element.feed_mm_s.min(self.max_speed)
    }

    /// The acceleration before any share is taken off.
    fn accel(&self) -> f64 {
        match &self.element.curve {
            Some(curve) => curve.accel_mm_s2.min(self.element.path_accel_mm_s2),
            None => self.element.accel_mm_s2,
        }
    }

    /// The share of its acceleration that a parabolic blend leaves.
    fn unbent_share(&self) -> f64 {
        0.5 * (1.0 - self.kink_before.max(self.kink_behind))
    }

    /// Gives up `mm` of path at the start or at the end.
    fn trim(&mut self, by: f64, at_start: bool) {
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

    fn side(&self, at_end: bool) -> Option<Side> {
        let element = &self.element;
        let change = if at_end { &element.end } else { &element.start };
        let along = [change[0], change[1], change[2]];
        let tolerance_mm = match element.joint {
            Joint::Blend { tolerance_mm, .. } => tolerance_mm,
            _ => 0.0,
        };
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
        Some(Side {
            tangent: unit(along)?,
            circle,
            nominal_mm: element.length_mm,
            length_mm: self.length_mm,
            max_speed: self.max_speed,
            asked_speed: element.feed_mm_s,
            tolerance_mm,
        })
    }

    /// What is left of it.
    fn piece(&self) -> Piece {
        let change = &self.element.start;
        if self.is_line {
            Piece::Joined {
                direction: [change[0], change[1], change[2]],
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
    fn turning(&self, max_speed: f64, accel: f64) -> (f64, f64) {
        let Some(curve) = &self.element.curve else {
            return (max_speed, accel);
        };
        let radius_mm = curve.radius_mm + curve.rise_mm * curve.rise_mm / curve.radius_mm;
        arc::linuxcnc(max_speed, accel, radius_mm)
    }

    /// Unit direction in which the planner expects an end to pull. An arc pulls in
    /// its plane; at its start it turns towards the centre, by what half of the
    /// speed asked for needs.
    fn pull(&self, at_end: bool) -> Option<Vector> {
        let side = self.side(at_end)?;
        let Some(circle) = &side.circle else {
            return Some(side.tangent);
        };
        let across = dot(side.tangent, circle.normal);
        let flat = unit(sub(side.tangent, scale(circle.normal, across)))?;
        if at_end {
            return Some(flat);
        }
        let half = 0.5 * self.element.feed_mm_s.min(self.element.speed_mm_s);
        let inward = scale(unit(circle.center)?, half * half / circle.radius);
        unit(add(scale(flat, self.unbent_share() * self.accel()), inward))
    }

    /// The speed that the tolerance permits in a parabolic blend, and the sine of
    /// half the angle inside its corner.
    fn tolerated(&self, next: &Self, accel: f64) -> (f64, f64) {
        let (Some(first), Some(second)) = (self.pull(true), next.pull(false)) else {
            return (f64::INFINITY, 0.0);
        };
        let (sin, cos) = libm::sincos(0.5 * angle_between(first, second));
        let most = match self.element.joint {
            Joint::Blend { tolerance_mm, .. } if tolerance_mm > 0.0 && cos > 1e-3 => {
                2.0 * (accel * tolerance_mm / cos).sqrt()
            }
            _ => f64::INFINITY,
        };
        (most, sin)
    }

    /// The speed along the mean direction that the planner expects of a parabolic
    /// blend when it chooses one.
    fn overlap(&self, next: &Self) -> f64 {
        let ramps = [self, next].map(|of| {
            let (speed, accel) = of.turning(of.max_speed, of.accel());
            Ramp::new(&of.element, of.length_mm, speed, of.unbent_share() * accel)
        });
        let (most, sin) = self.tolerated(next, ramps[0].accel);
        let [first, second] = Ramp::overlap([&ramps[0], &ramps[1]]);
        0.5 * sin * (first.min(most) + second.min(most))
    }

    /// How long it runs while the element before it brakes, s.
    fn overlap_s(&self) -> f64 {
        let Some(braking) = &self.braking else {
            return 0.0;
        };
        let accel = self.unbent_share() * self.accel();
        let (speed, accel) = self.turning(self.max_speed, accel);
        braking.lasts_s(&Ramp::new(&self.element, self.length_mm, speed, accel))
    }

    /// Whether axes other than X, Y and Z move.
    fn rotates(&self) -> bool {
        let changes = &self.element.start;
        (3..AXES).any(|axis| changes.get(axis).is_some_and(|change| *change != 0.0))
    }
}

impl<T: Copy> LinuxCnc<T> {
    pub fn new(axes: Axes, cycle_s: f64, kink_ratio: f64, gap_cycles: f64) -> Self {
        Self {
            axes,
            cycle_s,
            kink_ratio,
            gap_cycles,
            pending: None,
            spare: None,
            joiner: Joiner::new(),
        }
    }

    /// Adds an element.
    pub fn push(&mut self, element: &Element<T>, window: &mut Window<Load<T>>) {
        if self.joiner.passes(element) {
            return self.enqueue(element, element.tag, false, window);
        }
        for joined in self.joiner.push(element, &self.axes).into_iter().flatten() {
            self.enqueue(&joined.element, joined.first, joined.is_line, window);
        }
    }

    fn enqueue(
        &mut self,
        element: &Element<T>,
        first: T,
        is_line: bool,
        window: &mut Window<Load<T>>,
    ) {
        let mut next = match self.spare.take() {
            Some(mut next) => {
                next.element = *element;
                next.first = first;
                next
            }
            None => Box::new(Pending::new(element, first)),
        };
        next.begin(is_line, self.cycle_s);
        let Some(mut before) = self.pending.take() else {
            self.pending = Some(next);
            return;
        };
        match self.way(&mut before, &mut next) {
            Way::Stop => {
                self.hand_over(&before, window, false);
                window.stop();
            }
            Way::Pass(speed) => {
                next.entry2 = speed * speed;
                self.hand_over(&before, window, false);
            }
            Way::Parabolic => {
                before.parabolic = true;
                next.parabolic = true;
                next.braking = Some(Braking::of(&before, &next));
                self.hand_over(&before, window, false);
            }
            Way::Blend(fit) => self.round(&mut before, &mut next, &fit, window),
        }
        self.pending = Some(next);
        self.spare = Some(before);
    }

    /// Nothing comes behind the last element.
    pub fn stop(&mut self, window: &mut Window<Load<T>>) {
        if let Some(joined) = self.joiner.flush(&self.axes) {
            self.enqueue(&joined.element, joined.first, joined.is_line, window);
        }
        if let Some(last) = self.pending.take() {
            self.hand_over(&last, window, true);
            self.spare = Some(last);
        }
    }

    /// How the joint of two elements is passed.
    fn way(&self, before: &mut Pending<T>, next: &mut Pending<T>) -> Way {
        let joint = before.element.joint;
        if joint == Joint::Stop || before.element.rapid != next.element.rapid {
            return Way::Stop;
        }
        let blends = matches!(joint, Joint::Blend { .. });
        let (Some(first), Some(second)) = (before.side(true), next.side(false)) else {
            return if blends { Way::Parabolic } else { Way::Stop };
        };
        if before.rotates() || next.rotates() {
            return if blends { Way::Parabolic } else { Way::Stop };
        }
        let sum = add(first.tangent, second.tangent);
        if dot(sum, sum) < REVERSAL2 {
            return Way::Stop;
        }
        let accel = self.axes.accel(&next.element.axis_accel_mm_s2);
        let v = before.target_speed().min(next.target_speed());
        let step = scale(
            sub(second.tangent, first.tangent),
            v / self.cycle_s + next.accel(),
        );
        let mut share = share_of(step, accel);
        if first.circle.is_some() || second.circle.is_some() {
            share /= TANGENTIAL_SHARE;
        }
        let taken = share.min(self.kink_ratio);
        let kept = (before.kink_behind, next.kink_before);
        before.kink_behind = before.kink_behind.max(taken);
        next.kink_before = next.kink_before.max(taken);
        if share < self.kink_ratio {
            return Way::Pass(v);
        }
        if !blends {
            return Way::Stop;
        }
        let kink_speed = v * self.kink_ratio / share;
        let fit = fit([&first, &second], &self.axes, accel);
        let blend_speed = fit.as_ref().map_or(0.0, |fit| fit.speed);
        let overlap = 0.5 * before.overlap(next);
        if overlap >= kink_speed && overlap >= blend_speed {
            (before.kink_behind, next.kink_before) = kept;
            return Way::Parabolic;
        }
        match fit {
            Some(fit) if blend_speed > kink_speed => {
                (before.kink_behind, next.kink_before) = (0.0, 0.0);
                Way::Blend(fit)
            }
            _ => Way::Pass(kink_speed),
        }
    }

    /// Lays a blend between two elements.
    fn round(
        &mut self,
        before: &mut Pending<T>,
        next: &mut Pending<T>,
        fit: &Fit,
        window: &mut Window<Load<T>>,
    ) {
        before.trim(fit.trims[0], false);
        next.trim(fit.trims[1], true);
        let tag = before.element.tag;
        let short = before.length_mm / fit.speed < self.gap_cycles * self.cycle_s;
        let consumed = short && before.element.curve.is_none() && !before.parabolic;
        let (lead_mm, entry2) = if consumed {
            (before.length_mm.max(0.0), Some(before.entry2))
        } else {
            self.hand_over(before, window, false);
            (0.0, None)
        };
        let length_mm = lead_mm + fit.radius * fit.sweep;
        let mut top = fit.speed.min(fit.asked_speed);
        if length_mm > 0.0 {
            top = top.min(length_mm / (self.cycle_s * CYCLES_MIN));
        }
        let piece = Piece::Blend(Blend {
            lead_mm,
            radius_mm: fit.radius,
            sweep_rad: fit.sweep,
            tangent: fit.tangent,
            normal: fit.normal,
        });
        let load = Load {
            tag,
            first: if consumed { before.first } else { tag },
            next: Some(next.first),
            piece,
            certain: true,
            overlap_s: 0.0,
        };
        let top2 = top * top;
        let before2 = window.last_top2();
        let entry2 = match entry2 {
            Some(entry2) => entry2.min(top2),
            None => before2.min(top2),
        };
        let accel = fit.accel * TANGENTIAL_SHARE;
        let mut node = Node::new(length_mm, top2, accel, entry2, load);
        node.block = false;
        let jerks = [&*before, &*next].map(|of| of.element.jerk_mm_s3);
        node.jerk = jerks[0].min(jerks[1]);
        window.push(node);
        next.entry2 = top2;
    }

    /// Puts an element into the window as it is now.
    fn hand_over(&self, of: &Pending<T>, window: &mut Window<Load<T>>, last: bool) {
        let unblended = last && matches!(of.element.joint, Joint::Blend { .. });
        let share = if of.parabolic || unblended { 0.5 } else { 1.0 };
        let mut accel = of.accel() * (1.0 - of.kink_before.max(of.kink_behind)) * share;
        let mut max_speed = of.max_speed.min(of.length_mm / self.cycle_s);
        // What a queue's last element may be entered with.
        let mut half = accel;
        if of.element.curve.is_some() {
            half *= TANGENTIAL_SHARE;
            if last {
                accel = half;
            } else {
                (max_speed, accel) = of.turning(max_speed, accel);
            }
        }
        if !last {
            max_speed = max_speed.min(of.length_mm / (self.cycle_s * CYCLES_MIN));
        }
        if of.element.jerk_mm_s3 < f64::INFINITY {
            max_speed = max_speed.min(of.element.curve_speed_mm_s);
        }
        let top = of.element.feed_mm_s.min(max_speed);
        let top2 = top * top;
        let mut entry2 = of.entry2.min(top2);
        if last {
            entry2 = entry2.min(accel * of.length_mm);
        }
        let entry2 = if entry2 > 0.0 {
            entry2.min(window.last_top2())
        } else {
            0.0
        };
        let load = Load {
            tag: of.element.tag,
            first: of.first,
            next: None,
            piece: of.piece(),
            certain: !of.parabolic,
            overlap_s: of.overlap_s(),
        };
        let mut node = Node::new(of.length_mm, top2, accel, entry2, load);
        let parabolic = matches!(of.element.joint, Joint::Blend { .. });
        node.jerk = of.element.jerk_mm_s3;
        node.tail2 = half * of.length_mm * if parabolic && !last { 0.5 } else { 1.0 };
        window.push(node);
    }
}

/// The largest share of an axis' acceleration.
fn share_of(accel: Vector, limits: Vector) -> f64 {
    accel
        .into_iter()
        .zip(limits)
        .filter(|(_, limit)| *limit > 0.0)
        .fold(0.0, |share, (a, limit)| share.max(a.abs() / limit))
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
    fn new(of: &Element<impl Copy>, length_mm: f64, max_speed: f64, accel: f64) -> Self {
        let peak = (accel * length_mm).sqrt();
        Self {
            accel,
            length_mm,
            speed: peak.min(max_speed).min(of.feed_mm_s),
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
struct Braking {
    ramp: Ramp,
    /// The speed that the tolerance permits.
    most: f64,
}

impl Braking {
    fn of<T: Copy>(before: &Pending<T>, next: &Pending<T>) -> Self {
        let accel = before.unbent_share() * before.accel();
        let (speed, accel) = before.turning(before.max_speed, accel);
        Self {
            ramp: Ramp::new(&before.element, before.length_mm, speed, accel),
            most: before.tolerated(next, accel).0,
        }
    }

    /// How long it still brakes when the next one begins, s.
    fn lasts_s(&self, next: &Ramp) -> f64 {
        let [brakes_from, _] = Ramp::overlap([&self.ramp, next]);
        brakes_from.min(self.most) / self.ramp.accel
    }
}
