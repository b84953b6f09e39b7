//! Gliding: the motion keeps its full speed from one straight element to the next.
//!
//! Most lines of a finishing pass are run so. The caller may follow them
//! without the planner, and give it those that are not final when that ends: it is
//! then where it would have been.

use super::corner::Before;
use super::element::Element;
use super::line::Line;
use super::passage;
use super::planner::{PathPlanner, Rule};

/// Elements that are looked ahead at most without the planner.
const BLOCKS_MAX: usize = 64;

/// A motion at full speed.
#[derive(Debug, Clone, Copy)]
pub struct Gliding<T> {
    /// The first element that is open.
    pub first: T,
    /// Elements that are.
    pub open: usize,
    /// Squared, mm²/s².
    pub speed2: f64,
}

impl<T: Copy> PathPlanner<T> {
    /// How many elements may be followed that are not final; 0: none.
    #[must_use]
    pub fn glide_blocks(&self) -> usize {
        if !self.window.may_glide() {
            return 0;
        }
        match self.rule {
            Rule::Corner(_) => self.window.blocks().unwrap_or(BLOCKS_MAX).min(BLOCKS_MAX),
            // Its corners are rounded, and it plans again over few elements alone.
            Rule::LinuxCnc(_) => 0,
        }
    }

    /// Where the motion glides, over all elements that are open.
    #[must_use]
    pub fn gliding(&self) -> Option<Gliding<T>> {
        let (speed2, open) = self.window.gliding()?;
        let straight = match &self.rule {
            Rule::Corner(before) => before.as_ref().is_some_and(Before::is_straight),
            Rule::LinuxCnc(_) => false,
        };
        if !straight {
            return None;
        }
        Some(Gliding {
            first: open.front()?.payload.tag,
            open: open.len(),
            speed2,
        })
    }

    /// Whether the joint of two lines is passed at the speed (mm/s) that both ask for
    /// and their axes permit; false where it is not, or not plainly.
    #[must_use]
    #[inline]
    pub fn passes(&self, before: &Line, next: &Line, speed_mm_s: f64) -> bool {
        passage::permits(&self.look_ahead.corner, before, next, speed_mm_s)
    }

    /// The share of the acceleration that hills of speed are smoothed with, up to 1.
    #[must_use]
    pub fn accel_share(&self) -> f64 {
        1.0 - self.look_ahead.min_cruise_ratio
    }

    /// Forgets the elements that are open: the motion has glided to the start of
    /// this one, with that speed, squared (mm²/s²).
    pub fn glide_to(&mut self, element: &Element<T>, speed2: f64) {
        let limited = self.limited(element);
        let element = limited.as_ref().unwrap_or(element);
        self.window.glide_to(speed2);
        let (after, mut node) = self.node(element, [0.0, element.length_mm]);
        node.entry2 = speed2;
        self.window.push(node);
        self.rule = Rule::Corner(Some(after.before()));
    }
}
