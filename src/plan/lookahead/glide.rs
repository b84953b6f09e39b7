//! Gliding: the motion keeps its full speed from one straight element to the next.
//!
//! Most lines of a finishing pass are run so. Whoever plans them may follow them
//! without the planner, and give it those that are not final when that ends: it is
//! then where it would have been.

use super::corner::Before;
use super::element::Element;
use super::passage;
use super::planner::{PathPlanner, Planned, Rule};

/// Elements that are looked ahead at most without the planner.
const BLOCKS_MAX: usize = 64;

/// A motion at full speed.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Gliding<T> {
    /// The first element that is open, but for those that the planner keeps.
    pub first: T,
    /// Elements that are.
    pub open: usize,
    /// The planner keeps pieces of path before that, to be taken with
    /// [`PathPlanner::pop_gliding`] once they are final.
    pub keeps: bool,
    /// Squared, mm²/s².
    pub speed2: f64,
    /// Where the last element begins.
    pub start: LineStart,
    /// See [`Passed::accel_share`].
    pub accel_share: f64,
}

/// What the joint before a line has taken of it.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct LineStart {
    /// Of its path, mm.
    pub taken_mm: f64,
    /// Share of its acceleration.
    pub kink: f64,
}

/// A straight feed in X, Y and Z, and next to them of an extruder, whose start is
/// known.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Line {
    /// A unit.
    pub direction: [f64; 3],
    /// Of the extruder per unit of path.
    pub extrusion: f64,
    pub length_mm: f64,
    /// Limits of the axes, mm/s²; of interest to blends alone, as are those below.
    pub axis_accel_mm_s2: [f64; 3],
    /// Limit along the path whatever the direction, mm/s².
    pub path_accel_mm_s2: f64,
    /// Their inverses.
    pub inverse_accel: [f64; 3],
    pub inverse_path_accel: f64,
    /// How far the path may be left at its end; 0: as far as it takes.
    pub tolerance_mm: f64,
    /// Not above the acceleration along the path, here and through the joint
    /// before it, mm/s².
    pub least_accel_mm_s2: f64,
    /// The largest share of the acceleration of all paths that it surely has, up to 1.
    pub common_share: f64,
    pub start: LineStart,
}

/// A joint that the motion glides through.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Passed {
    /// What of the path is left to the line before it, mm.
    pub own_mm: f64,
    /// What belongs to both halfway, mm, and its curvature.
    pub shared_mm: f64,
    pub curvature_per_mm: f64,
    /// Share of the least acceleration of both that all this permits.
    pub accel_share: f64,
    /// Where the line after it begins.
    pub next: LineStart,
}

impl<T: Copy> PathPlanner<T> {
    /// How many elements may be followed that are not final; 0: none.
    pub(crate) fn glide_blocks(&self) -> usize {
        if !self.window.may_glide() {
            return 0;
        }
        let blocks = self.window.blocks().unwrap_or(usize::MAX);
        let blocks = match self.rule {
            Rule::Corner(_) => blocks,
            // It plans again over few elements alone: whether it keeps its speed the window
            // says of each.
            Rule::LinuxCnc(_) => 0,
        };
        blocks.min(BLOCKS_MAX)
    }

    /// Where the motion glides, over all elements that are open.
    pub(crate) fn gliding(&self) -> Option<Gliding<T>> {
        let (speed2, open) = self.window.gliding()?;
        match &self.rule {
            Rule::Corner(before) => {
                let straight = before.as_ref().is_some_and(Before::is_straight);
                if !straight {
                    return None;
                }
                Some(Gliding {
                    first: open.front()?.payload.tag,
                    open: open.len(),
                    keeps: false,
                    speed2,
                    start: LineStart::default(),
                    accel_share: self.accel_share(),
                })
            }
            Rule::LinuxCnc(rule) => {
                let (first, start) = rule.gliding(speed2)?;
                Some(Gliding {
                    first,
                    open: 1,
                    keeps: true,
                    speed2,
                    start,
                    accel_share: 1.0,
                })
            }
        }
    }

    /// How the joint of two lines is passed at the speed (mm/s) that both ask for
    /// and their axes permit; `None` where it is not, or not plainly.
    #[inline]
    pub(crate) fn passes(&self, before: &Line, next: &Line, speed_mm_s: f64) -> Option<Passed> {
        if let Rule::LinuxCnc(rule) = &self.rule {
            return rule.passes(before, next, speed_mm_s);
        }
        let permitted = passage::permits(&self.look_ahead.corner, before, next, speed_mm_s);
        permitted.then_some(Passed {
            own_mm: before.length_mm,
            accel_share: self.accel_share(),
            ..Passed::default()
        })
    }

    /// What hills are smoothed with.
    fn accel_share(&self) -> f64 {
        1.0 - self.look_ahead.min_cruise_ratio
    }

    /// The next piece that the planner keeps; it is run at that speed, squared.
    pub(crate) fn pop_gliding(&mut self, speed2: f64) -> Option<Planned<T>> {
        self.window.pop_gliding(speed2).map(Planned::of)
    }

    /// Forgets the elements that are open: the motion has glided to the start of
    /// this one, with that speed, squared.
    pub(crate) fn glide_to(&mut self, element: &Element<T>, start: LineStart, speed2: f64) {
        let limited = self.limited(element);
        let element = limited.as_ref().unwrap_or(element);
        self.window.glide_to(speed2);
        if let Rule::LinuxCnc(rule) = &mut self.rule {
            return rule.glide_to(element, start, speed2);
        }
        let (after, mut node) = self.node(element, [0.0, element.length_mm]);
        node.entry2 = speed2;
        self.window.push(node);
        self.rule = Rule::Corner(Some(after.before()));
    }
}
