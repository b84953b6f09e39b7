//! Gliding: the motion keeps its full speed from one straight element to the next.
//!
//! Most lines of a finishing pass are run so. Whoever plans them may follow them
//! without the planner, and give it those that are not final when that ends: it is
//! then where it would have been.

use super::corner::Passage;
use super::element::Element;
use super::planner::{PathPlanner, Rule};

/// Elements that are looked ahead at most without the planner.
const BLOCKS_MAX: usize = 64;

/// A motion at full speed.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Gliding<T> {
    /// The first element that is open.
    pub first: T,
    /// Pieces of path that are.
    pub open: usize,
    /// Squared, mm²/s².
    pub speed2: f64,
    /// In X, Y and Z, where the last one ends.
    pub direction: [f64; 3],
}

impl<T: Copy> PathPlanner<T> {
    /// How many elements may be followed that are not final; 0: none.
    pub(crate) fn glide_blocks(&self) -> usize {
        if !matches!(self.rule, Rule::Corner(_)) || !self.window.may_glide() {
            return 0;
        }
        self.window.blocks().unwrap_or(BLOCKS_MAX).min(BLOCKS_MAX)
    }

    /// Where the motion glides, over all elements that are open. Otherwise, how
    /// many must be final before it can do so.
    #[inline]
    pub(crate) fn gliding(&self) -> Result<Gliding<T>, usize> {
        let Rule::Corner(Some(before)) = &self.rule else {
            return Err(0);
        };
        let direction = before.straight().ok_or(0_usize)?;
        let open = self.window.gliding()?;
        let first = open.front().ok_or(0_usize)?;
        Ok(Gliding {
            first: first.payload.tag,
            open: open.len(),
            speed2: first.top2,
            direction,
        })
    }

    /// Whether the rules permit a joint of two elements with the directions `u`
    /// and `w` in X, Y and Z; a quick answer that may be no where it is yes.
    #[inline]
    pub(crate) fn permits(&self, u: &[f64; 3], w: &[f64; 3], passage: &Passage) -> bool {
        passage.is_permitted(&self.look_ahead.corner, u, w)
    }

    /// Forgets the elements that are open: the motion has glided to the start of
    /// this one, with that speed, squared.
    pub(crate) fn glide_to(&mut self, element: &Element<T>, speed2: f64) {
        let limited = self.limited(element);
        let element = limited.as_ref().unwrap_or(element);
        let (after, mut node) = self.node(element, [0.0, element.length_mm]);
        node.entry2 = speed2;
        self.window.glide_to(node);
        self.rule = Rule::Corner(Some(after.before()));
    }
}
