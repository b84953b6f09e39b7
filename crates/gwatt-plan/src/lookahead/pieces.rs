//! What look-ahead takes and gives.

use super::node::Span;
use super::ramp::{Slack, Speeds2};
use crate::{Profile, Section};
use gwatt_machine::AxisValues;

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
    /// True where it may run slower, and be sped up and braked at any lower speed: how many blocks the
    /// controller sees is a matter of timing.
    pub ranged: bool,
    /// True where it ends at rest even if it is not certain, since the rules stop
    /// there. `LinuxCNC`'s say so; with others it is false.
    pub rests: bool,
    /// How long it runs already while the piece before it comes to rest, s.
    pub overlap_s: f64,
    /// True where it or the piece after it may do so: next to a parabolic blend.
    pub overlaps: bool,
    /// The speed up to which it may still speed up and from which it may brake, mm/s, since
    /// a lower pace comes late, at this setting or a lower one, or a higher one after a blend
    /// that a lower override has no room for; 0 where none does.
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
            ranged: span.ranged,
            rests: span.payload.rests,
            overlap_s: span.payload.overlap_s,
            overlaps: span.payload.overlaps,
            late_mm_s: span.payload.late_mm_s,
            slack: span.payload.slack,
        }
    }
}
