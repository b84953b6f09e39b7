//! The planner: elements in, profiles out, in order, with a bounded window.
//!
//! ```text
//! elements ─chords→ ─corner or blend→ nodes ─window→ speeds ─→ profiles
//! ```
//!
//! Where an axis of the machine limits its jerk, `runs` is the window.

use super::blend::Axes;
use super::chord::{Chords, Finer, is_followed};
use super::corner::{After, Before};
use super::element::Element;
use super::linuxcnc::{LinuxCnc, RENEWED};
use super::node::Node;
use super::pieces::{Load, Piece, Planned};
use super::ramp::Slack;
use super::window::Window;
use gwatt_machine::{CornerRule, LookAhead, Machine};

#[derive(Debug, Clone)]
#[allow(
    clippy::large_enum_variant,
    reason = "each planner has one; a box would be followed for each block"
)]
pub(super) enum Rule<T> {
    Corner(Option<Before>),
    LinuxCnc(Box<LinuxCnc<T>>),
}

/// A look-ahead planner.
///
/// Elements are given with [`Self::push`], stops that other words cause with
/// [`Self::stop`], and the finished pieces are taken with [`Self::pop`], in
/// order. An element is final once nothing after it can change it.
///
/// What changes with the limits of one element: a clone taken before it, given
/// the changed element and those after it, plans them again. From the first
/// piece on that begins as before at a joint that the change did not reach, all
/// is as it was; under limits of jerk that is a joint that limits the speed.
#[derive(Debug, Clone)]
pub struct PathPlanner<T> {
    pub(super) look_ahead: LookAhead,
    pub(super) rule: Rule<T>,
    pub(super) window: Window<Load<T>>,
    /// Lower overrides count as well.
    lowers: bool,
}

impl<T: Copy> PathPlanner<T> {
    /// A planner at rest.
    #[must_use]
    pub fn new(machine: &Machine, look_ahead: LookAhead) -> Self {
        let mut axes = machine.axes.iter().flatten();
        let has_jerk = axes.any(|axis| axis.jerk_mm_s3 > 0.0);
        let mut window = Window::new(look_ahead.blocks, smooths(&look_ahead))
            .seeing_up_to(look_ahead.blocks_at_most);
        let rule = if let CornerRule::LinuxCnc {
            cycle_s,
            kink_ratio,
            gap_cycles,
        } = look_ahead.corner
        {
            let axes = Axes::of(machine);
            let mut rule = LinuxCnc::new(axes, cycle_s, kink_ratio, gap_cycles);
            if has_jerk {
                window = window.with_jerk(Some(RENEWED));
            } else {
                window = window.given();
                rule = rule.optimised(look_ahead.blocks);
            }
            Rule::LinuxCnc(Box::new(rule))
        } else {
            if has_jerk {
                window = window.with_jerk(None);
            }
            Rule::Corner(None)
        };
        Self {
            look_ahead,
            rule,
            window,
            lowers: machine.limits.override_at.is_none(),
        }
    }

    /// The same where the feed override may be raised by a factor: `LinuxCNC` decides
    /// for its largest value how joints are passed.
    #[must_use]
    pub fn expecting(mut self, feed_ratio: f64) -> Self {
        if let Rule::LinuxCnc(rule) = &mut self.rule {
            rule.expect(feed_ratio.max(1.0));
        }
        self
    }

    /// The same where no lower override counts.
    #[must_use]
    pub fn at_one_override(mut self) -> Self {
        self.lowers = false;
        self
    }

    /// Whether an arc before a stop that words cause, or at the end, accelerates
    /// less than between others, in exact stop too.
    #[must_use]
    pub fn slows_last_arcs(&self) -> bool {
        matches!(self.rule, Rule::LinuxCnc(_))
    }

    /// Whether arcs are run as chords, each a piece for itself.
    #[must_use]
    pub fn runs_chords(&self) -> bool {
        self.look_ahead.chords.is_some()
    }

    /// Whether an element can be followed: false for an arc of more chords than
    /// that, of which no more is known than the limits of its axes.
    #[must_use]
    #[inline]
    pub fn follows(&self, element: &Element<T>) -> bool {
        element.curve.is_none()
            || (self.look_ahead.chords.as_ref()).is_none_or(|rule| is_followed(rule, element))
    }

    /// Adds an element. Of one that is run as chords it gives Σ 2·a·L over them,
    /// mm²/s²: how far the square of the speed can fall on it.
    #[inline]
    pub fn push(&mut self, element: &Element<T>) -> Option<f64> {
        let limited = self.limited(element);
        let element = limited.as_ref().unwrap_or(element);
        if let Rule::LinuxCnc(rule) = &mut self.rule {
            rule.push(element, &mut self.window);
            return None;
        }
        let rule = self.look_ahead.chords.as_ref();
        let Some(mut chords) = rule.and_then(|rule| Chords::of(rule, element)) else {
            self.push_corner(element, [0.0, element.length_mm], 0.0, None);
            return None;
        };
        let (mut ramp2, mut last) = (0.0, None);
        while let Some(at) = chords.advance() {
            ramp2 += 2.0 * chords.chord.accel_mm_s2 * chords.chord.length_mm;
            let finer = chords.finer();
            if let Some(finer) = finer.filter(|_| self.lowers) {
                chords.chord.speed_mm_s = finer.axes_mm_s;
            }
            self.push_corner(&chords.chord, at, chords.exit2(), finer);
            last = finer;
        }
        if let (Some(finer), Rule::Corner(Some(before))) = (last, &mut self.rule) {
            before.tangent = Some(finer.tangents[1]);
        }
        Some(ramp2)
    }

    /// The element under the rules' own limit and the drives', where they are lower.
    #[inline]
    pub(super) fn limited(&self, element: &Element<T>) -> Option<Element<T>> {
        let path = self.look_ahead.path_accel_mm_s2;
        if element.path_accel_mm_s2 <= path && !element.is_driven() {
            return None;
        }
        let mut limited = *element;
        limited.path_accel_mm_s2 = limited.path_accel_mm_s2.min(path);
        let most = limited.path_accel_mm_s2.min(limited.drive_accel_mm_s2);
        limited.accel_mm_s2 = limited.accel_mm_s2.min(most);
        Some(limited)
    }

    /// An element after its first joint, and as the window sees it, where it
    /// begins at rest.
    #[inline]
    pub(super) fn node<'e>(
        &self,
        element: &'e Element<T>,
        at: [f64; 2],
    ) -> (After<'e, T>, Node<Load<T>>) {
        let after = After::new(&self.look_ahead.corner, element);
        let load = Load {
            tag: element.tag,
            first: element.tag,
            next: None,
            piece: Piece::Along {
                from_mm: at[0],
                to_mm: at[1],
            },
            certain: true,
            rests: false,
            overlap_s: 0.0,
            overlaps: false,
            late_mm_s: 0.0,
            slack: Slack::default(),
        };
        let top2 = after.top_mm_s * after.top_mm_s;
        let mut node = Node::new(element.length_mm, top2, element.accel_mm_s2, 0.0, load);
        if smooths(&self.look_ahead) {
            let ratio = self.look_ahead.min_cruise_ratio;
            let share = 1.0 - element.set.cruise_ratio(ratio);
            node.smooth_accel = element.common_accel_mm_s2() * share;
        }
        node.step2 = after.rest2;
        node.jerk = element.jerk_mm_s3;
        (after, node)
    }

    /// `exit2`: see [`Node::exit2`]; `finer`: of a chord that lower overrides may make shorter.
    fn push_corner(
        &mut self,
        element: &Element<T>,
        at: [f64; 2],
        exit2: f64,
        finer: Option<Finer>,
    ) {
        let (after, mut node) = self.node(element, at);
        node.exit2 = exit2;
        let Rule::Corner(before) = &mut self.rule else {
            return;
        };
        let rule = &self.look_ahead.corner;
        let joint2 =
            |after: &After<'_, T>| before.as_ref().map_or(0.0, |it| it.joint2(rule, after));
        node.entry2 = joint2(&after);
        if let Some(finer) = finer.filter(|_| at[0] <= 0.0) {
            let start = finer.tangents[0];
            let tangent = Element { start, ..*element };
            node.entry2 = node.entry2.max(joint2(&After::new(rule, &tangent)));
        }
        let jerk = before.as_ref().and_then(|it| it.jerk_joint(rule, &after));
        if let Some(joint) = jerk {
            let lower2 = joint.lower_speed2().filter(|_| self.lowers);
            if let Some(lower2) = lower2.filter(|lower2| *lower2 > node.entry2) {
                // A lower override may let it be passed as fast as that: how is not followed.
                (node.entry2, node.payload.certain) = (lower2, false);
            }
            if node.entry2 > 0.0 {
                node.begins2 = joint.begins2().unwrap_or(0.0);
                let lower2 = joint.lower_begins2().filter(|_| self.lowers);
                node.payload.slack.begins2 = lower2.unwrap_or(0.0);
            }
        }
        if node.entry2 == 0.0 {
            self.window.stop();
            // Up to 2.1.2 Marlin begins at rest and accelerates, later at that speed.
            node.payload.certain &= node.step2 == 0.0 || node.step2 < node.top2;
        }
        node.payload.slack.joint2 = node.entry2;
        if let Some(finer) = finer {
            node.payload.slack.accel_mm_s2 = finer.accel_mm_s2;
            node.payload.slack.chord2 = finer.speed2;
            // Shorter ones turn by less, and are passed faster: that is not followed.
            let asked2 = after.top_mm_s * after.top_mm_s;
            node.payload.certain &= at[0] <= 0.0 || node.entry2 >= finer.speed2.min(asked2);
        }
        self.window.push(node);
        *before = Some(after.before());
    }

    /// The last element and the next one are not put together to one line.
    pub fn part(&mut self) {
        if let Rule::LinuxCnc(rule) = &mut self.rule {
            rule.part(&mut self.window);
        }
    }

    /// The motion stops after the last element: a dwell, a tool change, the
    /// end of the program.
    pub fn stop(&mut self) {
        self.stop_before(false);
    }

    /// The same where the controller sees another element after that, which begins
    /// at rest.
    pub fn stop_between(&mut self) {
        self.stop_before(true);
    }

    fn stop_before(&mut self, another: bool) {
        match &mut self.rule {
            Rule::Corner(before) => *before = None,
            Rule::LinuxCnc(rule) => rule.stop(&mut self.window, another),
        }
        self.window.stop();
    }

    /// Makes all pieces final that nothing after can change, at once: by
    /// itself the planner looks for them now and then.
    pub fn settle(&mut self) {
        self.window.settle();
    }

    /// The next piece, once it is final.
    #[inline]
    pub fn pop(&mut self) -> Option<Planned<T>> {
        if self.window.is_ready() {
            self.pop_ready()
        } else {
            None
        }
    }

    fn pop_ready(&mut self) -> Option<Planned<T>> {
        self.window.pop().map(Planned::of)
    }
}

/// Whether hills may be smoothed: by the profile, or since a program may ask for it.
fn smooths(rules: &LookAhead) -> bool {
    rules.min_cruise_ratio > 0.0 || matches!(rules.corner, CornerRule::SquareCorner { .. })
}
