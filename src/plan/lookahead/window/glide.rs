//! Elements over which the motion keeps its speed, without a way through the queue.

use std::collections::VecDeque;

use super::{Node, Window};

impl<P: Copy> Window<P> {
    /// Whether elements of this window may be followed from outside.
    pub fn may_glide(&self) -> bool {
        !self.smooth && self.runs.is_none()
    }

    /// How many elements a controller sees, if that is bounded.
    pub fn blocks(&self) -> Option<usize> {
        self.blocks
    }

    /// The elements that are open, if the motion has the largest speed of all of
    /// them and of the joints between. Otherwise, how many must be final before it
    /// can be so.
    #[inline]
    pub fn gliding(&self) -> Result<&VecDeque<Node<P>>, usize> {
        let speed2 = self.now2;
        if self.ready > 0 || speed2 == 0.0 {
            return Err(0);
        }
        for (index, node) in self.nodes.iter().enumerate() {
            let entered = index == 0 || node.entry2 == speed2;
            if !entered || node.top2 != speed2 || node.forced {
                return Err(index);
            }
        }
        Ok(&self.nodes)
    }

    /// Forgets the elements that are open, over which the motion has glided: it
    /// has come to the start of `node`, at the speed that this may be entered at.
    pub fn glide_to(&mut self, mut node: Node<P>) {
        node.e2 = node.entry2;
        self.now2 = node.entry2;
        self.settle_at = self.open_min;
        self.nodes.clear();
        self.nodes.push_back(node);
    }
}
