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

use super::blend::{Axes, Circle, Fit, NORMAL_SHARE, Side, TANGENTIAL_SHARE, angle_between, fit};
use super::element::{Element, Joint};
use super::join::{Joined, Joiner};
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
    pending: Option<Pending<T>>,
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
    /// What it runs while the element before it brakes.
    lead: Option<Lead>,
    /// Largest speed at its start, squared.
    entry2: f64,
}

/// The start of an element in a parabolic blend: from rest, in the time in which
/// the element before it comes to rest.
#[derive(Debug, Clone, Copy)]
struct Lead {
    accel: f64,
    length_mm: f64,
}

enum Way {
    Stop,
    Pass(f64),
    Parabolic,
    Blend(Fit),
}

impl<T: Copy> Pending<T> {
    fn new(joined: &Joined<T>, cycle_s: f64) -> Self {
        let element = &joined.element;
        let max_speed = element.speed_mm_s.min(element.curve_speed_mm_s);
        Self {
            element: *element,
            first: joined.first,
            is_line: joined.is_line,
            from_mm: 0.0,
            length_mm: element.length_mm,
            sweep_rad: element.curve.map_or(0.0, |curve| curve.sweep_rad.abs()),
            max_speed: max_speed.min(element.length_mm / cycle_s),
            kink_before: 0.0,
            kink_behind: 0.0,
            parabolic: false,
            lead: None,
            entry2: 0.0,
        }
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

    /// Of what is left of it, a piece.
    fn piece(&self, from_mm: f64, to_mm: f64) -> Piece {
        let change = &self.element.start;
        if self.is_line {
            Piece::Joined {
                direction: [change[0], change[1], change[2]],
            }
        } else {
            Piece::Along {
                from_mm: self.from_mm + from_mm,
                to_mm: self.from_mm + to_mm,
            }
        }
    }

    /// The speed of an arc and the acceleration along it, of those that it has
    /// without its curvature.
    fn turning(&self, max_speed: f64, accel: f64) -> (f64, f64) {
        let Some(curve) = &self.element.curve else {
            return (max_speed, accel);
        };
        let radius = curve.radius_mm + curve.rise_mm * curve.rise_mm / curve.radius_mm;
        let turning2 = NORMAL_SHARE * accel * radius;
        if max_speed * max_speed > turning2 {
            return (turning2.sqrt(), accel * TANGENTIAL_SHARE);
        }
        let normal = max_speed * max_speed / (radius * accel);
        (max_speed, accel * (1.0 - normal * normal).sqrt())
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
            joiner: Joiner::new(),
        }
    }

    /// Adds an element.
    pub fn push(&mut self, element: &Element<T>, window: &mut Window<Load<T>>) {
        for joined in self.joiner.push(element, &self.axes).into_iter().flatten() {
            self.enqueue(&joined, window);
        }
    }

    fn enqueue(&mut self, joined: &Joined<T>, window: &mut Window<Load<T>>) {
        let mut next = Pending::new(joined, self.cycle_s);
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
                next.lead = Overlap::of(&before, &next, true).lead();
                self.hand_over(&before, window, false);
            }
            Way::Blend(fit) => self.round(before, &mut next, &fit, window),
        }
        self.pending = Some(next);
    }

    /// Nothing comes behind the last element.
    pub fn stop(&mut self, window: &mut Window<Load<T>>) {
        if let Some(joined) = self.joiner.flush(&self.axes) {
            self.enqueue(&joined, window);
        }
        if let Some(last) = self.pending.take() {
            self.hand_over(&last, window, true);
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
        let overlap = 0.5 * Overlap::of(before, next, false).along;
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
        mut before: Pending<T>,
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
            self.hand_over(&before, window, false);
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
            meanwhile: false,
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
        let jerks = [&before, &*next].map(|of| of.element.jerk_mm_s3);
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
        entry2 = if entry2 > 0.0 {
            entry2.min(window.last_top2())
        } else {
            0.0
        };
        let mut load = Load {
            tag: of.element.tag,
            first: of.first,
            next: None,
            piece: of.piece(0.0, of.length_mm),
            certain: !of.parabolic,
            meanwhile: false,
        };
        let mut length_mm = of.length_mm;
        if let Some(lead) = &of.lead {
            let speed2 = 2.0 * lead.accel * lead.length_mm;
            load.piece = of.piece(0.0, lead.length_mm);
            load.meanwhile = true;
            let mut node = Node::new(lead.length_mm, speed2, lead.accel, 0.0, load.clone());
            node.jerk = of.element.jerk_mm_s3;
            node.block = false;
            window.push(node);
            length_mm -= lead.length_mm;
            load.piece = of.piece(lead.length_mm, of.length_mm);
            load.meanwhile = false;
            entry2 = top2.min(speed2);
        }
        let mut node = Node::new(length_mm, top2, accel, entry2, load);
        let parabolic = matches!(of.element.joint, Joint::Blend { .. });
        node.jerk = of.element.jerk_mm_s3;
        node.tail2 = half * length_mm * if parabolic && !last { 0.5 } else { 1.0 };
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

/// What a parabolic blend comes to: the next element begins while the last one
/// still brakes, both with half of their acceleration.
struct Overlap {
    /// Speeds of the element before when the next one begins, and of the next
    /// one when the one before it has come to rest.
    speeds: [f64; 2],
    /// Acceleration of the one before.
    accel: f64,
    /// Speed along the mean direction.
    along: f64,
}

impl Overlap {
    /// As it is expected where it is chosen, or as it comes: there the turning
    /// of arcs has to do with half of the acceleration as well.
    fn of<T: Copy>(before: &Pending<T>, next: &Pending<T>, chosen: bool) -> Self {
        let [(v0, a0), (v1, a1)] = [before, next].map(|of| {
            let share = of.unbent_share();
            let (speed, accel) = if chosen {
                of.turning(of.max_speed, share * of.accel())
            } else {
                let (speed, accel) = of.turning(of.max_speed, of.accel());
                (speed, share * accel)
            };
            let peak = (accel * of.length_mm).sqrt();
            (peak.min(speed).min(of.element.feed_mm_s), accel)
        });
        let accels = [a0, a1];
        // As long as the longer ramp takes, if the elements are long enough.
        let longest_s = (v0 / accels[0]).max(v1 / accels[1]);
        let blend_s = longest_s.min((before.length_mm / v0).min(next.length_mm / v1));
        let mut speeds = [v0.min(blend_s * accels[0]), v1.min(blend_s * accels[1])];
        let mut along = 0.0;
        if let (Some(first), Some(second)) = (before.pull(true), next.pull(false)) {
            let theta = 0.5 * angle_between(first, second);
            let tolerance_mm = match before.element.joint {
                Joint::Blend { tolerance_mm, .. } => tolerance_mm,
                _ => 0.0,
            };
            if tolerance_mm > 0.0 && libm::cos(theta) > 1e-3 {
                let most = 2.0 * (accels[0] * tolerance_mm / libm::cos(theta)).sqrt();
                speeds = speeds.map(|speed| speed.min(most));
            }
            along = 0.5 * libm::sin(theta) * (speeds[0] + speeds[1]);
        }
        Self {
            speeds,
            accel: accels[0],
            along,
        }
    }

    /// What the next element runs meanwhile.
    fn lead(&self) -> Option<Lead> {
        let [before, next] = self.speeds;
        let lasts_s = before / self.accel;
        let lead = Lead {
            accel: next / lasts_s,
            length_mm: 0.5 * next * lasts_s,
        };
        (lead.accel > 0.0 && lead.length_mm > 0.0).then_some(lead)
    }
}
