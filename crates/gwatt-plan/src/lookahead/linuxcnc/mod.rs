//! The trajectory planner of `LinuxCNC` 2.9 as rules.
//!
//! Input: elements, one by one. Output: nodes for the window, with blends
//! between them. The last element waits for its successor: a blend takes a
//! piece of both, and one that finds no successor in the queue (before a stop
//! that a word causes) keeps half of its acceleration in G64.
//!
//! A joint is passed without a blend where the step of velocity, over one servo
//! cycle, takes no more than `kink_ratio` of an axis' acceleration; both
//! elements give that share up. Elsewhere the fastest of three is taken: so slow that
//! the step takes no more, a blend, or half of the speed of a parabolic blend, in
//! which the next element begins while the last one brakes, each with half of its
//! acceleration. Facts from `tp.c`, `tc.c` and measurements.

mod optimiser;

use super::super::arc_plane::LINUXCNC_TANGENTIAL_SHARE as TANGENTIAL_SHARE;
use super::blend::{Axes, Fit, fit};
use super::element::{Element, Joint};
use super::join::{Joined, Joiner, chords};
use super::node::Node;
use super::pending::{Braking, Pending};
use super::pieces::{Blend, Load, Piece};
use super::ramp::Slack;
use super::vector::{Vector, add, dot, scale, sub};
use super::window::Window;
use optimiser::Optimiser;

/// Elements after one over which the optimiser surely raises its speeds.
pub(super) const RENEWED: usize = optimiser::HITS;
/// Cycles that an element lasts at least.
const CYCLES_MIN: f64 = 1.02;
/// Servo cycles in which an element that begins at rest may have ended before the next one comes
/// into the queue: recorded at two, not at four; six with a margin.
const BRIEF_CYCLES: f64 = 6.0;
/// Cycles after which a change of pace acts: HAL hands it on within one, and the planner takes
/// it in the next.
pub const LATE_CYCLES: f64 = 2.0;
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
    /// Sets the speeds at joints. With limits of jerk the window does, as far as that is known.
    optimiser: Option<Optimiser<T>>,
    /// Largest speed of the last node, squared, whatever F asks for.
    last_max2: f64,
    /// The largest feed override by the one in force.
    feed_ratio: f64,
}

enum Way {
    Stop,
    Pass(f64),
    Parabolic,
    Blend(Fit),
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
            optimiser: None,
            last_max2: f64::INFINITY,
            feed_ratio: 1.0,
        }
    }

    /// Speeds at joints are those of its optimiser, which goes back over so many elements.
    pub fn optimised(mut self, depth: Option<u32>) -> Self {
        self.optimiser = Some(Optimiser::new(depth));
        self
    }

    /// The feed override may be raised by this factor.
    pub fn expect(&mut self, feed_ratio: f64) {
        self.feed_ratio = feed_ratio;
    }

    /// Adds an element.
    pub fn push(&mut self, element: &Element<T>, window: &mut Window<Load<T>>) {
        if self.joiner.passes(element) {
            return self.enqueue(element, element.tag, false, window);
        }
        if let Some(chords) = chords(element, &self.axes) {
            for chord in &chords {
                let complete = self.joiner.push_chord(chord, &self.axes);
                self.enqueue_all(complete, window);
            }
        } else {
            let complete = self.joiner.push(element, &self.axes);
            self.enqueue_all(complete, window);
        }
    }

    fn enqueue_all(&mut self, joined: [Option<Joined<T>>; 2], window: &mut Window<Load<T>>) {
        for joined in joined.into_iter().flatten() {
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
        let mut next = self.begin(element, first, is_line);
        let Some(mut before) = self.pending.take() else {
            self.pending = Some(next);
            return;
        };
        let brief = before.is_brief(BRIEF_CYCLES * self.cycle_s);
        let way = self.way(&mut before, &mut next);
        next.comes_late = brief && !matches!(way, Way::Stop);
        if before.element.pace != next.element.pace {
            self.change_pace(&mut before, &mut next, &way);
        }
        match way {
            Way::Stop => {
                before.rests = true;
                self.hand_over(&before, window, false);
                if let Some(optimiser) = &mut self.optimiser {
                    optimiser.end(true, &mut |node| window.push(node));
                }
                window.stop();
            }
            Way::Pass(speed) => {
                next.entry2 = speed * speed;
                self.hand_over(&before, window, false);
            }
            Way::Parabolic => {
                before.blended_after = true;
                // It is marked only where it may have been a blend of lines and arcs.
                next.blended_before = !(before.rotates() || next.rotates());
                next.braking = Some(Braking::of(&before));
                self.hand_over(&before, window, false);
            }
            Way::Blend(fit) => self.round(&mut before, &mut next, &fit, window),
        }
        self.pending = Some(next);
        self.spare = Some(before);
    }

    /// The pace changes at a joint that is not a stop: up to there the next element is seen
    /// at the pace before. A lower one comes into force after some cycles, in which the
    /// motion may still speed up; at lower overrides, where the joint may be passed as fast,
    /// it brakes then.
    fn change_pace(&self, before: &mut Pending<T>, next: &mut Pending<T>, way: &Way) {
        let joint_mm_s = match way {
            // Rapids may be rounded there at a lower override.
            Way::Parabolic if before.element.rapid && next.element.rapid => before.run_speed(),
            Way::Stop | Way::Parabolic => return,
            Way::Pass(speed) => *speed,
            Way::Blend(fit) => fit.speed,
        };
        let overlaps = matches!(way, Way::Parabolic);
        // The slower one may be too slow for that at a lower override, where the other one still
        // is fast: both keep all of their acceleration then.
        (before.keeps_all, next.keeps_all) = (before.keeps_all || overlaps, overlaps);
        if !overlaps {
            next.pace_before = before.element.pace;
        }
        if before.element.pace <= next.element.pace {
            // At a lower override there may be no room for the blend in which it speeds up here.
            if matches!(way, Way::Blend(_)) {
                next.late_mm_s = next.run_speed();
            }
            return;
        }
        let accel = next.accel();
        next.late_mm_s = joint_mm_s + LATE_CYCLES * self.cycle_s * accel;
        // With half of the acceleration, which blends may leave.
        let brakes_mm = next.late_mm_s * next.late_mm_s / accel;
        // Where it keeps up with the joint here, there is a lower override at which the element
        // before it still reaches that speed and this one no longer does.
        next.lags = !overlaps && next.length_mm < brakes_mm;
    }

    /// An element that nothing has changed yet.
    fn begin(&mut self, element: &Element<T>, first: T, is_line: bool) -> Box<Pending<T>> {
        let mut next = match self.spare.take() {
            Some(mut next) => {
                next.element = *element;
                next.first = first;
                next
            }
            None => Box::new(Pending::new(element, first)),
        };
        next.begin(is_line, self.cycle_s, self.feed_ratio);
        next
    }

    /// What comes next is not put to the last element.
    pub fn part(&mut self, window: &mut Window<Load<T>>) {
        if let Some(joined) = self.joiner.flush(&self.axes) {
            self.enqueue(&joined.element, joined.first, joined.is_line, window);
        }
    }

    /// The motion stops after the last element; nothing comes after it unless it is
    /// `followed`.
    pub fn stop(&mut self, window: &mut Window<Load<T>>, followed: bool) {
        self.part(window);
        if let Some(last) = self.pending.take() {
            self.hand_over(&last, window, !followed);
            self.spare = Some(last);
        }
        if let Some(optimiser) = &mut self.optimiser {
            optimiser.end(followed, &mut |node| window.push(node));
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
        let sum = add(first.leg.tangent, second.leg.tangent);
        if dot(sum, sum) < REVERSAL2 {
            return Way::Stop;
        }
        let accel = self.axes.accel(&next.element.axis_accel_mm_s2);
        let v = before.target_speed().min(next.target_speed());
        let step = scale(
            sub(second.leg.tangent, first.leg.tangent),
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
        let fit = fit([&first, &second], &self.axes, accel, self.cycle_s);
        // A blend lasts a cycle at least.
        let blend_speed = fit.as_ref().map_or(0.0, |fit| {
            let length_mm = self.lead_mm(before, fit).unwrap_or(0.0) + fit.radius * fit.sweep;
            fit.speed.min(length_mm / self.cycle_s)
        });
        let faster = kink_speed.max(blend_speed);
        // What it comes to at most needs no closer look at most corners.
        let may_overlap = 0.25 * (before.asked_speed() + next.asked_speed()) >= faster;
        let overlaps = |whole| may_overlap && 0.5 * before.overlap(next, whole) >= faster;
        // Where it could have laid a blend and takes none, it decides once more, and has
        // given the first element its whole acceleration back by then.
        let twice = fit.is_some() && blend_speed <= kink_speed;
        if overlaps(false) || twice && overlaps(true) {
            (before.kink_behind, next.kink_before) = kept;
            return Way::Parabolic;
        }
        match fit {
            Some(fit) if !twice => {
                (before.kink_behind, next.kink_before) = (0.0, 0.0);
                Way::Blend(fit)
            }
            _ => Way::Pass(kink_speed),
        }
    }

    /// What is left of the element before a blend, if that is too short to stand alone
    /// and leads into it.
    fn lead_mm(&self, before: &Pending<T>, fit: &Fit) -> Option<f64> {
        let left_mm = before.length_mm - fit.trims[0];
        let short = left_mm / fit.speed < self.gap_cycles * self.cycle_s;
        let alone = before.element.curve.is_some() || before.blended_before;
        (short && !alone).then_some(left_mm.max(0.0))
    }

    /// Lays a blend between two elements.
    fn round(
        &mut self,
        before: &mut Pending<T>,
        next: &mut Pending<T>,
        fit: &Fit,
        window: &mut Window<Load<T>>,
    ) {
        let lead_mm = self.lead_mm(before, fit);
        if lead_mm.is_some()
            && let Some(optimiser) = &mut self.optimiser
        {
            let entry2 = before.entry2.min(before.max_speed * before.max_speed);
            let taken = [entry2, before.unseen2()];
            optimiser.pass_taken(taken, &mut |node| window.push(node));
        }
        before.trim(fit.trims[0], false);
        next.trim(fit.trims[1], true);
        let tag = before.element.tag;
        let last_max2 = if lead_mm.is_some() {
            before.entry2
        } else {
            self.hand_over(before, window, false);
            self.last_max2
        };
        let (consumed, lead_mm) = (lead_mm.is_some(), lead_mm.unwrap_or(0.0));
        let length_mm = lead_mm + fit.radius * fit.sweep;
        let mut max = fit.speed;
        if length_mm > 0.0 {
            max = max.min(length_mm / (self.cycle_s * CYCLES_MIN));
        }
        let top = max.min(before.run_speed().max(next.seen_speed()));
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
            certain: !next.comes_late,
            rests: false,
            overlap_s: 0.0,
            overlaps: false,
            late_mm_s: 0.0,
            slack: Slack::default(),
        };
        let jerk = before.element.jerk_mm_s3.min(next.element.jerk_mm_s3);
        let top2 = top * top;
        let max2 = if jerk < f64::INFINITY {
            top2
        } else {
            max * max
        };
        let entry2 = max2.min(last_max2);
        let accel = fit.accel * TANGENTIAL_SHARE;
        let mut node = Node::new(length_mm, top2, accel, entry2, load);
        node.block = false;
        node.jerk = jerk;
        self.push_node(node, max2, 0.0, window);
        next.entry2 = max2;
    }

    /// Hands a node on. The planner looks back with the speeds that the machine
    /// permits: around a blend it sees a lower F only when it is there, and may
    /// still be too fast. `unseen2`: see [`Optimiser::push`].
    #[inline]
    fn push_node(
        &mut self,
        mut node: Node<Load<T>>,
        max2: f64,
        unseen2: f64,
        window: &mut Window<Load<T>>,
    ) {
        node.overruns = node.jerk == f64::INFINITY;
        self.last_max2 = max2;
        match &mut self.optimiser {
            Some(optimiser) => optimiser.push(node, unseen2, &mut |node| window.push(node)),
            None => window.push(node),
        }
    }

    /// Puts an element into the window as it is now.
    fn hand_over(&mut self, of: &Pending<T>, window: &mut Window<Load<T>>, last: bool) {
        let mut accel = of.accel() * of.kept_share(last);
        let mut max_speed = of.max_speed.min(of.length_mm / self.cycle_s);
        if of.element.curve.is_some() {
            if last {
                accel *= TANGENTIAL_SHARE;
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
        let max2 = if of.element.jerk_mm_s3 < f64::INFINITY {
            top2
        } else {
            max_speed * max_speed
        };
        let mut entry2 = of.entry2.min(max2);
        if last {
            // With nothing after it F counts, whatever the pace.
            let asked = (of.element.feed_mm_s / of.element.pace).min(max_speed);
            entry2 = entry2.min(accel * of.length_mm).min(asked * asked);
        }
        let entry2 = if entry2 > 0.0 {
            entry2.min(self.last_max2)
        } else {
            0.0
        };
        let load = Load {
            tag: of.element.tag,
            first: of.first,
            next: None,
            piece: of.piece(),
            // With limits of jerk it is not modelled.
            certain: !(of.lags || of.comes_late)
                && (!of.overlaps() || of.element.jerk_mm_s3 == f64::INFINITY),
            rests: of.rests,
            overlap_s: of.overlap_s(last),
            overlaps: of.overlaps(),
            late_mm_s: of.late_mm_s,
            slack: of.slack(),
        };
        let mut node = Node::new(of.length_mm, top2, accel, entry2, load);
        let seen = of.seen_speed().min(max_speed);
        node.seen2 = seen * seen;
        node.jerk = of.element.jerk_mm_s3;
        self.push_node(node, max2, of.unseen2(), window);
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
