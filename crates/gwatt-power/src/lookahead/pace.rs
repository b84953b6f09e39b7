//! What lower overrides may make of moves that are planned together.
//!
//! Input: the elements as they come, and their pieces at the largest overrides.
//! Output: up to which speed a move may have to be sped up or braked where it is
//! not at the largest overrides.
//!
//! With the path s, `x = v²`, the caps `C(s)` of elements and joints and
//! `A(s) = ∫a ds` a plan is
//!
//! ```text
//! x(s) = min over p of C(p) + 2·|A(s) − A(p)|
//! ```
//!
//! and the axes speed up where the least p lies before s. Of an element with F
//! `C = min(o²·F², r²)` at the override o, r what axes and curvature permit; joints do
//! not depend on o but through the elements next to them. So x grows with o, and
//!
//! * what starts at a joint, or at rest, does the same at the largest overrides, and
//!   goes on for longer;
//! * what starts at an element j does so only if its F is lower, `F_j < F_i`, and
//!   within `2·ΔA < x·(1 − F_j²/F_i²)`, x that of the largest overrides at the edge of i
//!   (`o²·F_j² + 2·ΔA` is neither above `o²·F_i²` nor above x, o being no less than the
//!   lowest override that counts); unless j is a rapid and i a feed, or the other way: these have
//!   knobs of their own;
//! * at the largest overrides i speeds up there as well, to a higher x, if its F is
//!   its cap: `o²·(F_i² − F_j²)` grows with o. It does not where r is the cap, or
//!   where it brakes from its start on, since something after it is slower.
//!
//! In these cases the move counts as if it sped up to its own largest speed, or to what
//! is reached from `F_j²` where that is lower. Braking is the same from after.

use arrayvec::ArrayVec;

/// Slower elements that are kept apart.
const SLOWER_MAX: usize = 32;
/// By what share two squared speeds may differ by rounding.
const ROUNDING: f64 = 1e-9;
/// By what share a sum may be off by rounding.
pub(super) const SUM_ROUNDING: f64 = 1e-13;

/// An element at the largest overrides; speeds are squared, mm²/s².
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Pace {
    /// Which knob it has: that of rapids or that of feeds.
    pub rapid: bool,
    /// The speed that is asked for, and at the lowest override that counts.
    pub asked2: f64,
    pub least2: f64,
    /// The same as far as axes and curvature permit it.
    pub cap2: f64,
    /// Σ 2·a·L of the elements before it, and its own, at least.
    pub before2: f64,
    /// See `before2`.
    pub own2: f64,
}

/// A piece of a plan; speeds are squared, mm²/s².
#[derive(Debug, Clone, Copy)]
pub(super) struct Course {
    pub start2: f64,
    pub end2: f64,
    /// The largest that is reached.
    pub top2: f64,
    /// 2·a·L.
    pub ramp2: f64,
    /// It is straight, and its acceleration does not change but for its sign: what it
    /// speeds up with it has at any lower speed as well.
    pub plain: bool,
    /// Changes of speed up to here are too short to matter as ramps, mm/s.
    pub brief_mm_s: f64,
}

impl Course {
    /// Whether it speeds up to its largest speed, and brakes from it.
    pub fn ramps(&self) -> [bool; 2] {
        [self.start2, self.end2].map(|end2| {
            self.plain
                && self.is_ramp_from(end2)
                && (self.brief_mm_s <= 0.0 || self.top2.sqrt() - end2.sqrt() > self.brief_mm_s)
        })
    }

    /// Whether it runs faster than at one of its ends.
    pub fn is_ramp_from(&self, end2: f64) -> bool {
        self.top2 > end2 * (1.0 + ROUNDING)
    }

    /// Whether it ends slower than it runs.
    pub fn brakes(&self) -> bool {
        self.is_ramp_from(self.end2)
    }
}

impl Pace {
    /// That of both at once: as fast as either.
    pub fn or_faster(&self, other: &Self) -> Self {
        Self {
            asked2: self.asked2.max(other.asked2),
            least2: self.least2.max(other.least2),
            cap2: self.cap2.max(other.cap2),
            ..*self
        }
    }

    /// Whether some override asks it for a lower speed than another one.
    pub fn may_be_slower(&self, than: &Self) -> bool {
        self.rapid != than.rapid || self.asked2 < than.asked2 * (1.0 - ROUNDING)
    }

    /// Whether the asked speed is its cap.
    pub fn is_asked(&self) -> bool {
        self.asked2 <= self.cap2 * (1.0 + ROUNDING)
    }

    /// Whether it runs at its cap where F is that.
    pub fn keeps(&self, speed2: f64) -> bool {
        self.is_asked() && speed2 >= self.cap2 * (1.0 - ROUNDING)
    }

    /// The speed, squared, that this one may be sped up to from another element at
    /// `distance2` (Σ 2·a·L between them), if that can be; `edge2` is the speed at the
    /// edge that it comes from, and `kept` says that it is the cap by F.
    pub fn reached_from(
        &self,
        slower: &Slow,
        distance2: f64,
        edge2: f64,
        kept: bool,
    ) -> Option<f64> {
        let distance2 = distance2.max(0.0);
        if slower.least2 + distance2 >= edge2 {
            return None;
        }
        if slower.rapid == self.rapid {
            if kept || slower.asked2 >= self.asked2 * (1.0 - ROUNDING) {
                return None;
            }
            // Of an endless F any other is a share of nothing.
            let share = 1.0 - slower.asked2 / self.asked2;
            if distance2 >= edge2 * share {
                return None;
            }
        }
        Some(slower.asked2 + distance2)
    }
}

/// An element that others may be sped up from.
#[derive(Debug, Clone, Copy)]
pub(super) struct Slow {
    /// Which knob it has.
    pub rapid: bool,
    /// The speed that is asked for, squared, and at the lowest override that counts.
    pub asked2: f64,
    pub least2: f64,
    /// Σ 2·a·L at the side that faces the others.
    pub at2: f64,
}

/// The elements after the motion since it was at rest last, as far as they matter:
/// of each knob those that are slower than all after them.
#[derive(Debug, Default)]
pub(super) struct Past {
    now2: f64,
    slower: [ArrayVec<Slow, SLOWER_MAX>; 2],
}

impl Past {
    /// Takes a piece of an element: the speed, squared, up to which it may have to be
    /// sped up where it need not at the largest overrides.
    #[inline]
    pub fn pass(&mut self, pace: &Pace, course: &Course) -> Option<f64> {
        let reach2 = (1.0 - SUM_ROUNDING) * self.now2 - course.start2;
        for slower in &mut self.slower {
            // What the motion cannot have braked for.
            let far = slower.iter().take_while(|slow| slow.at2 <= reach2);
            let far = far.count();
            if far > 0 {
                slower.drain(..far);
            }
        }
        let [rises, _] = course.ramps();
        let reached2 = if rises {
            None
        } else {
            self.reached2(pace, course.start2)
        };
        self.now2 += course.ramp2;
        self.leave(pace, course.end2);
        reached2.map(|reached2| course.top2.min(reached2 + course.ramp2))
    }

    /// The speed, squared, at the start of an element, from which it may have to be
    /// sped up.
    fn reached2(&self, pace: &Pace, start2: f64) -> Option<f64> {
        let kept = pace.keeps(start2);
        let all = self.slower.iter().flatten();
        let reached = all.filter_map(|slow| {
            pace.reached_from(
                slow,
                self.now2 - slow.at2 - SUM_ROUNDING * self.now2,
                start2,
                kept,
            )
        });
        reached.reduce(f64::max)
    }

    fn leave(&mut self, pace: &Pace, end2: f64) {
        if end2 <= 0.0 {
            return self.rest();
        }
        let Some(slower) = self.slower.get_mut(usize::from(pace.rapid)) else {
            return;
        };
        while slower.last().is_some_and(|slow| slow.asked2 >= pace.asked2) {
            slower.pop();
        }
        let full = slower.is_full();
        if let ([first, second, ..], true) = (slower.as_mut_slice(), full) {
            // As slow as the one, and as near as the other.
            first.at2 = second.at2;
            slower.remove(1);
        }
        slower.push(Slow {
            rapid: pace.rapid,
            asked2: pace.asked2,
            least2: pace.least2,
            at2: self.now2,
        });
    }

    /// Nothing moves.
    pub fn rest(&mut self) {
        self.now2 = 0.0;
        for slower in &mut self.slower {
            slower.clear();
        }
    }

    /// Whether the other knob has a say at a speed.
    pub fn is_mixed(&self, rapid: bool, speed2: f64) -> bool {
        let others = self.slower.get(usize::from(!rapid));
        let last = others.and_then(|slower| slower.last());
        last.is_some_and(|slow| self.now2 - slow.at2 < speed2 * (1.0 + ROUNDING))
    }
}
