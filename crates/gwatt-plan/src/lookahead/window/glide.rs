//! Elements over which the motion keeps its speed, without a way through the queue.

use std::collections::VecDeque;

use super::{Node, Window};

impl<P: Copy> Window<P> {
    /// Whether elements of this window may be followed from outside.
    pub fn may_glide(&self) -> bool {
        self.runs.is_none()
    }

    /// How many elements a controller surely sees, if that is bounded.
    pub fn blocks(&self) -> Option<usize> {
        self.sure_blocks.or(self.blocks)
    }

    /// The elements that are open, if the motion has the largest speed of all of
    /// them and of the joints between, and that speed, squared.
    pub fn gliding(&self) -> Option<(f64, &VecDeque<Node<P>>)> {
        let speed2 = self.now2;
        let unsure = self.sure_blocks.is_some() && self.low2 < speed2;
        if self.ready > 0 || speed2 == 0.0 || unsure {
            return None;
        }
        let glides = self.nodes.iter().enumerate().all(|(index, node)| {
            let entered = index == 0 || node.entry2 == speed2;
            let smooth = !self.smooth || node.smooth_entry2 == speed2;
            entered && smooth && node.top2 == speed2 && !node.forced
        });
        glides.then_some((speed2, &self.nodes))
    }

    /// Forgets the elements that are open: the motion has glided over them at this
    /// speed, squared.
    pub fn glide_to(&mut self, speed2: f64) {
        self.nodes.clear();
        (self.now2, self.low2) = (speed2, speed2);
        self.settle_at = self.open_min;
    }
}
