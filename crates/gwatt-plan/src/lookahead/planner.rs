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
use super::ramp::{Slack, Speeds2};
use super::window::{Node, Span, Window};
use crate::{Profile, Section};
use gwatt_machine::{AxisValues, CornerRule, LookAhead, Machine};

/// A piece of path that a controller lays round a corner: a circle in space,
/// begun by a straight rest of the element before where that was too short to
/// stand alone. XYZ only.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Blend {
    /// Straight path before the circle, mm.
    pub lead_mm: f64,
    /// Of the circle, mm.
    pub radius_mm: f64,
    /// By which the direction turns, positive.
    pub sweep_rad: f64,
    /// Unit direction at the start.
    pub tangent: [f64; 3],
    /// Unit direction from the start to the centre.
    pub normal: [f64; 3],
}

impl Blend {
    /// Where it begins and ends on its path, mm.
    #[must_use]
    pub fn ends_mm(&self) -> [f64; 2] {
        [0.0, self.lead_mm + self.radius_mm * self.sweep_rad]
    }
}

/// What a piece of the plan stands for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Piece {
    /// The element, from one place on its path to another, mm.
    Along {
        /// Where it begins.
        from_mm: f64,
        /// Where it ends.
        to_mm: f64,
    },
    /// A line that stands for all elements from the first to the tagged one.
    Joined {
        /// Change of each axis by its length: of X, Y and Z a unit.
        direction: AxisValues,
    },
    /// A blend; half of it belongs to the element before and half to the next.
    Blend(Blend),
}

/// A planned piece of path.
#[derive(Debug, Clone, PartialEq)]
pub struct Planned<T> {
    /// The element's; of several that became one line, the last one's.
    pub tag: T,
    /// The same, but of several the first one's.
    pub first: T,
    /// Of a blend: the next element's.
    pub next: Option<T>,
    /// What it is.
    pub piece: Piece,
    /// Its length, mm.
    pub length_mm: f64,
    /// Its speeds, squared.
    pub speeds2: Speeds2,
    /// Its acceleration, mm/s²; on an S-curve a bound of it.
    pub accel_mm_s2: f64,
    /// Its part of an S-curve, where jerk is limited: how it runs.
    pub section: Option<Section>,
    /// False where the controller may do otherwise than planned: the robust
    /// bound applies. So it is where its rule is not modelled, and where more
    /// elements were open than the window holds.
    pub certain: bool,
    /// True where it ends at rest even if it is not certain, since the rules stop
    /// there. `LinuxCNC`'s say so; with others it is false.
    pub rests: bool,
    /// How long it runs already while the piece before it comes to rest, s.
    pub overlap_s: f64,
    /// True where it or the piece after it may do so: next to a parabolic blend.
    pub overlaps: bool,
    /// The speed up to which it may still speed up and from which it may brake, mm/s, since
    /// a lower pace comes late, at this setting or a lower one; 0 where none does.
    pub late_mm_s: f64,
    /// How far lower overrides may go beyond that.
    pub slack: Slack,
}

impl<T> Planned<T> {
    /// The largest speed, mm/s.
    #[must_use]
    #[inline]
    pub fn top_speed_mm_s(&self) -> f64 {
        let Speeds2 { start, end, top } = self.speeds2;
        if self.section.is_some() || self.speeds2.are_one() {
            return top.sqrt();
        }
        let reached = 0.5 * (start + end) + self.accel_mm_s2 * self.length_mm;
        top.min(reached).max(start).max(end).sqrt()
    }

    /// The largest acceleration of [`Self::profile`], mm/s².
    #[must_use]
    #[inline]
    pub fn largest_accel_mm_s2(&self) -> f64 {
        if self.section.is_some() {
            return self.accel_mm_s2;
        }
        if self.speeds2.are_one() {
            return 0.0;
        }
        let needed = 0.5 * (self.speeds2.start - self.speeds2.end).abs() / self.length_mm;
        self.accel_mm_s2.max(needed)
    }

    /// How much time it adds, s: its own less what the piece before it has brought.
    #[must_use]
    #[inline]
    pub fn duration_s(&self) -> f64 {
        let own_s = match &self.section {
            Some(section) => section.duration_s(),
            None => self.speeds2.duration_s(self.length_mm, self.accel_mm_s2),
        };
        (own_s - self.overlap_s).max(0.0)
    }

    /// The same at a share of its speeds; `None` where it is part of a longer S-curve.
    #[must_use]
    pub fn slowed(&self, share: f64) -> Option<Self>
    where
        T: Clone,
    {
        let Speeds2 { start, end, top } = self.speeds2;
        let whole = start == 0.0 && end == 0.0;
        if self.section.is_some() && !whole {
            return None;
        }
        let share2 = share * share;
        let section = self.section.map(|section| section.slowed(share));
        Some(Self {
            speeds2: Speeds2 {
                start: share2 * start,
                end: share2 * end,
                top: share2 * top,
            },
            section,
            ..self.clone()
        })
    }

    /// How it runs.
    #[must_use]
    #[inline]
    pub fn profile(&self) -> Profile {
        if let Some(section) = &self.section {
            return section.profile();
        }
        Profile::between(self.length_mm, self.speeds2, self.accel_mm_s2)
    }
}

impl<T> Planned<T> {
    /// Speed, squared, that is reached at its end at least from another one at
    /// its start, with half of the limits, mm²/s².
    #[must_use]
    pub fn reached2(&self, start2: f64) -> f64 {
        match &self.section {
            Some(section) => {
                let speed = section.reached(start2.sqrt(), self.length_mm);
                speed * speed
            }
            None => start2 + self.accel_mm_s2 * self.length_mm,
        }
    }
}

/// What travels through the window with a node.
#[derive(Debug, Clone, Copy)]
pub(super) struct Load<T> {
    pub tag: T,
    pub first: T,
    pub next: Option<T>,
    pub piece: Piece,
    pub certain: bool,
    pub rests: bool,
    pub overlap_s: f64,
    pub overlaps: bool,
    pub late_mm_s: f64,
    pub slack: Slack,
}

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
/// the changed element and those after it, plans them anew. From the first
/// piece on that begins as before at a joint that the change did not reach, all
/// is as it was; under limits of jerk that is a joint that limits the speed.
#[derive(Debug, Clone)]
pub struct PathPlanner<T> {
    pub(super) look_ahead: LookAhead,
    pub(super) rule: Rule<T>,
    pub(super) window: Window<Load<T>>,
}

impl<T: Copy> PathPlanner<T> {
    /// A planner at rest.
    #[must_use]
    pub fn new(machine: &Machine, look_ahead: LookAhead) -> Self {
        let mut axes = machine.axes.iter().flatten();
        let has_jerk = axes.any(|axis| axis.jerk_mm_s3 > 0.0);
        let mut window = Window::new(look_ahead.blocks, smooths(&look_ahead));
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
            self.push_corner(element, [0.0, element.length_mm], None);
            return None;
        };
        let (mut ramp2, mut last) = (0.0, None);
        while let Some(at) = chords.advance() {
            ramp2 += 2.0 * chords.chord.accel_mm_s2 * chords.chord.length_mm;
            let finer = chords.finer();
            self.push_corner(&chords.chord, at, finer);
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
            let share = 1.0 - element.square.map_or(ratio, |square| square.cruise_ratio);
            node.smooth_accel = element.common_accel_mm_s2() * share;
        }
        node.step2 = after.rest2;
        node.jerk = element.jerk_mm_s3;
        (after, node)
    }

    /// `finer`: of a chord that lower overrides may make shorter.
    fn push_corner(&mut self, element: &Element<T>, at: [f64; 2], finer: Option<Finer>) {
        let (after, mut node) = self.node(element, at);
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
        if node.entry2 == 0.0 {
            self.window.stop();
        }
        node.payload.slack.joint2 = node.entry2;
        if let Some(finer) = finer {
            node.payload.slack.accel_mm_s2 = finer.accel_mm_s2;
            node.payload.slack.chord2 = finer.speed2;
            // Shorter ones turn by less, and are passed faster: that is not followed.
            let asked2 = after.top_mm_s * after.top_mm_s;
            node.payload.certain = at[0] <= 0.0 || node.entry2 >= finer.speed2.min(asked2);
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

impl<T> Planned<T> {
    #[inline]
    pub(super) fn of(span: Span<Load<T>>) -> Self {
        Self {
            tag: span.payload.tag,
            first: span.payload.first,
            next: span.payload.next,
            piece: span.payload.piece,
            length_mm: span.length,
            speeds2: Speeds2 {
                start: span.start2,
                end: span.end2,
                top: span.top2,
            },
            accel_mm_s2: span.accel,
            section: span.section,
            certain: span.certain && span.payload.certain,
            rests: span.payload.rests,
            overlap_s: span.payload.overlap_s,
            overlaps: span.payload.overlaps,
            late_mm_s: span.payload.late_mm_s,
            slack: span.payload.slack,
        }
    }
}

/// Whether hills may be smoothed: by the profile, or since a program may ask for it.
fn smooths(rules: &LookAhead) -> bool {
    rules.min_cruise_ratio > 0.0 || matches!(rules.corner, CornerRule::SquareCorner { .. })
}
