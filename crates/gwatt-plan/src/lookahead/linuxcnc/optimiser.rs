//! `LinuxCNC`'s optimiser of speeds, `tpRunOptimization`.
//!
//! Input: nodes as the rule hands them on. Output: the same, with the speed at the start of
//! each that the optimiser leaves it.
//!
//! Each line that is added begins a pass from the end of the queue to its start. The last
//! element may still be cut to half: the one before it ends so slow that half of it is
//! enough to stop. From there back each element begins at the speed from which it reaches its
//! end, or at the limit of its joint. A pass ends where it has met [`HITS`] joints that have had
//! their limit once, and so is lazy: what lies before keeps the speeds of the pass before, from
//! which it could stop where the queue ended then.
//!
//! ```text
//!  v² │ ‾‾‾‾╲              ╱‾‾‾‾‾‾   A long element after short ones brings many joints
//!     │      ╲___     ____╱          to their limits at once. Of those only the last ones
//!     │          ‾‾‾‾‾               are raised: it slows down and speeds up again.
//!     └───────────────────────→ s
//! ```
//!
//! While no joint of the queue has its limit, all speeds of a pass are sums of 2·a·L to its end.
//! So a pass is worth its way only where a joint comes to its limit; from the last such joint
//! back all is final, since no pass gets further than the one before.
//! Facts from `tp.c`; recorded with it.

#[cfg(test)]
mod tests;

use std::collections::VecDeque;

use super::super::node::{Node, OPEN_MAX, lower};
use super::super::pieces::Load;

/// Joints at their limits after which a pass ends.
pub(super) const HITS: usize = 5;
/// What rounding may make of sums, as a share.
const ROUNDING: f64 = 1e-12;

/// An element whose speed at its start is not final.
#[derive(Debug, Clone)]
struct Open<T> {
    node: Node<Load<T>>,
    /// Σ 2·a·L of all before it.
    sum2: f64,
}

/// See the module.
#[derive(Debug, Clone)]
pub(super) struct Optimiser<T> {
    open: VecDeque<Open<T>>,
    /// The number of the first one that is open.
    first: u64,
    /// Those that come to their limits before all after them, and at which level: the first
    /// is the lowest.
    limits: VecDeque<(u64, f64)>,
    /// Σ 2·a·L of all.
    sum2: f64,
    /// The level of the last pass: from the speed at a joint (squared) and the sum before
    /// it the same for all that are open.
    level2: f64,
    /// Elements over which a pass goes.
    depth: u64,
}

impl<T: Copy> Optimiser<T> {
    pub fn new(depth: Option<u32>) -> Self {
        Self {
            open: VecDeque::with_capacity(64),
            first: 0,
            limits: VecDeque::with_capacity(64),
            sum2: 0.0,
            level2: 0.0,
            depth: depth.map_or(u64::MAX, u64::from),
        }
    }

    /// Adds an element; `unseen2` is the speed, squared, from which it can stop while it may
    /// still be cut.
    #[inline]
    pub fn push(&mut self, node: Node<Load<T>>, unseen2: f64, out: &mut impl FnMut(Node<Load<T>>)) {
        if node.entry2 == 0.0 {
            self.end(true, out);
            self.sum2 = node.ramp2();
            return out(node);
        }
        self.complete();
        let (sum2, ramp2, block) = (self.sum2, node.ramp2(), node.block);
        let level2 = sum2 + lower(unseen2, node.entry2);
        self.open.push_back(Open { node, sum2 });
        self.sum2 += ramp2;
        // A blend is added together with the element after it.
        if block {
            let last = self.open.len() as u64 - 1;
            self.pass(last, level2, out);
        }
    }

    /// An element was added, of which the blend that comes now has taken all that is left: with
    /// the largest speed at its start, and that with which it was entered, squared.
    pub fn pass_taken(&mut self, [entry2, unseen2]: [f64; 2], out: &mut impl FnMut(Node<Load<T>>)) {
        if entry2 > 0.0 {
            self.complete();
            let level2 = self.sum2 + lower(unseen2, entry2);
            self.pass(self.open.len() as u64, level2, out);
        }
    }

    /// The last element is complete, and its joint may come to its limit.
    #[inline]
    fn complete(&mut self) {
        let Some(last) = self.open.back() else {
            return;
        };
        let number = self.first + self.open.len() as u64 - 1;
        let level2 = last.node.entry2 + last.sum2;
        // Two passes may have the same one before their ends.
        if self
            .limits
            .back()
            .is_some_and(|(other, _)| *other == number)
        {
            return;
        }
        while self
            .limits
            .back()
            .is_some_and(|(_, other)| *other >= level2)
        {
            self.limits.pop_back();
        }
        self.limits.push_back((number, level2));
    }

    /// A pass over a queue that ends with an element that may still be cut, which comes so many
    /// after the first one that is open.
    #[inline]
    fn pass(&mut self, last: u64, level2: f64, out: &mut impl FnMut(Node<Load<T>>)) {
        // What it does not reach.
        let beyond = last.saturating_sub(self.depth) as usize;
        self.release(beyond, beyond, out);
        if self.open.len() >= OPEN_MAX {
            if let Some(front) = self.open.front_mut() {
                front.node.payload.certain = false;
            }
            self.release(1, 1, out);
        }
        let mut reached = None;
        while let Some((number, limit2)) = self.limits.front().copied()
            && limit2 * (1.0 - ROUNDING) <= level2
        {
            reached = Some(number);
            self.limits.pop_front();
        }
        if let Some(reached) = reached {
            let count = (reached - self.first) as usize + 1;
            let kept = self.raise(count, f64::INFINITY);
            self.release(count, kept, out);
        }
        self.level2 = level2;
    }

    /// Goes back over the first elements that are open, from the speed (squared) after them;
    /// gives the first one that it comes to.
    fn raise(&mut self, count: usize, mut after2: f64) -> usize {
        let (mut hits, mut hit) = (0, false);
        for (index, open) in self.open.iter_mut().enumerate().take(count).rev() {
            let limit2 = open.node.entry2;
            hits += usize::from(hit);
            let reach2 = after2 + open.node.ramp2();
            hit = reach2 >= limit2;
            after2 = lower(reach2, limit2);
            open.node.entry2 = after2;
            if hits >= HITS {
                return index;
            }
        }
        0
    }

    /// Hands the first elements on; of those the first `kept` have the speeds of the pass before.
    fn release(&mut self, count: usize, kept: usize, out: &mut impl FnMut(Node<Load<T>>)) {
        for index in 0..count {
            let Some(open) = self.open.pop_front() else {
                break;
            };
            let mut node = open.node;
            if index < kept {
                node.entry2 = lower(node.entry2, self.level2 - open.sum2);
            }
            out(node);
            self.first += 1;
        }
        while self
            .limits
            .front()
            .is_some_and(|(number, _)| *number < self.first)
        {
            self.limits.pop_front();
        }
    }

    /// The path stops after the last element. Where another one comes after that, the last
    /// one is complete: a pass goes over it.
    pub fn end(&mut self, followed: bool, out: &mut impl FnMut(Node<Load<T>>)) {
        let count = self.open.len();
        if count == 0 {
            return;
        }
        let mut kept = count;
        if followed {
            let beyond = (count as u64).saturating_sub(self.depth) as usize;
            self.release(beyond, beyond, out);
            kept = self.raise(count - beyond, 0.0);
        }
        self.release(self.open.len(), kept, out);
        self.limits.clear();
        self.sum2 = 0.0;
    }
}
