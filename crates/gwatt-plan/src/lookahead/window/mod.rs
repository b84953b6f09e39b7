//! The window of a look-ahead: backward and forward passes over squared speed.
//!
//! Input: path elements in order, each with its length, its limits and the
//! largest speed at its start. Output: the speeds at which each begins and ends.
//!
//! ```text
//!  v² │      ╱╲                 backward: e[i] = min(J[i], e[i+1] + 2·a·L)
//!     │  ╱──╱  ╲──╲     ╱       forward:  f[i+1] = min(e[i+1], f[i] + 2·a·L)
//!     │ ╱          ╲   ╱
//!     │╱            ╲_╱         The path is not known beyond the window: it may
//!     └─────────────────→ s     end there, so the backward pass begins at rest.
//! ```
//!
//! What comes later can only raise e. Where e[i] = J[i] it cannot rise any more,
//! and with it everything before is final: the result is that of the whole
//! program at once, to the last bit. The pass is run when the elements that are
//! not final have doubled, so that each costs a few steps however long the
//! stopping distance is; at once where it fits into the last element.
//!
//! A controller that sees `n` blocks ahead keeps able to stop within them:
//! `e[i] ≤ Σ 2·a·L` over the next n, which sums in O(1); and the square of the speed at
//! which it may leave the last of them, where it knows that more of an arc comes after. One
//! that sees from `m` to `n`, as time goes, has speeds between those of both: where they are not
//! the same, the element is ranged.

mod glide;
#[cfg(test)]
mod tests;

use super::node::{Node, OPEN_MAX, Span, lower};
use std::collections::VecDeque;

use super::runs::Runs;

/// What rounding may make of a sum of squared speeds.
const ROUNDING: f64 = 1.0 + 1e-12;

/// Elements after which a first backward pass is worth its start.
const OPEN_MIN: usize = 8;

/// Elements whose speeds are not given out yet.
#[derive(Debug, Clone)]
pub(super) struct Window<P> {
    nodes: VecDeque<Node<P>>,
    /// How many of the first are final.
    ready: usize,
    /// Open elements at which the next backward pass runs.
    settle_at: usize,
    /// Speed at which the first one really starts, squared.
    now2: f64,
    /// The controller's own look-ahead.
    blocks: Option<usize>,
    /// What it surely sees, where it may see less than that: how many blocks is then a matter of
    /// timing.
    sure_blocks: Option<usize>,
    /// The lowest speed at which the first one starts, whatever it sees, squared.
    low2: f64,
    /// Hills are smoothed: `Node::smooth_accel` counts.
    smooth: bool,
    /// The speeds at joints are final as they come.
    given: bool,
    /// Open elements at which a first backward pass runs, and at most.
    open_min: usize,
    open_max: usize,
    /// Takes the place of all this where jerk is limited.
    runs: Option<Box<Runs<P>>>,
}

impl<P: Copy> Window<P> {
    pub fn new(blocks: Option<u32>, smooth: bool) -> Self {
        Self {
            nodes: VecDeque::with_capacity(128),
            ready: 0,
            settle_at: OPEN_MIN,
            now2: 0.0,
            blocks: blocks.map(|blocks| blocks.max(1) as usize),
            sure_blocks: None,
            low2: 0.0,
            smooth,
            given: false,
            open_min: OPEN_MIN,
            open_max: OPEN_MAX,
            runs: None,
        }
    }

    /// The same where the controller may see up to `most` blocks: elements whose speeds depend on how
    /// many it sees are ranged.
    pub fn seeing_up_to(mut self, most: Option<u32>) -> Self {
        if let (Some(fewest), Some(most)) = (self.blocks, most) {
            self.sure_blocks = Some(fewest);
            self.blocks = Some(fewest.max(most as usize));
        }
        self
    }

    /// The same where the speed at the start of each element is final as it comes: from
    /// there on the motion can come to all that follow.
    pub fn given(mut self) -> Self {
        self.given = true;
        (self.blocks, self.sure_blocks) = (None, None);
        self
    }

    /// The same where elements limit their jerk; how that goes together with
    /// smoothed hills is not known. `renewed`: elements after one over which the controller
    /// surely plans its speeds again as these come, if not over all.
    pub fn with_jerk(mut self, renewed: Option<usize>) -> Self {
        let mut runs = Runs::new(self.blocks, !self.smooth && self.sure_blocks.is_none());
        if let Some(elements) = renewed {
            runs = runs.renewing(elements);
        }
        self.runs = Some(Box::new(runs));
        self
    }

    /// Adds an element.
    #[inline]
    pub fn push(&mut self, mut node: Node<P>) {
        if let Some(runs) = &mut self.runs {
            return runs.push(node);
        }
        if self.given {
            node.e2 = node.entry2;
            self.ready = self.nodes.len();
            return self.nodes.push_back(node);
        }
        if let Some(last) = self.nodes.back() {
            // What cannot be reached from before is no limit that matters.
            let ramp2 = last.ramp2();
            let reach = higher(higher(last.entry2, last.step2), last.begins2) + ramp2;
            node.entry2 = lower(node.entry2, reach);
            if ramp2 < last.top2 {
                node.begins2 = lower(node.begins2, reach);
            }
            node.sum = last.sum + ramp2;
            node.run = last.run;
            if self.smooth {
                let reach = higher(last.smooth_entry2, last.step2) + last.smooth2();
                node.smooth_entry2 = lower(node.entry2, reach);
            }
            if node.entry2 == 0.0 {
                node.sum = 0.0;
                node.run = last.run.wrapping_add(1);
            }
        } else {
            // Not in motion, but where it has glided here.
            node.entry2 = lower(node.entry2, self.now2);
            node.smooth_entry2 = node.entry2;
        }
        if node.smooth_accel > node.accel {
            node.smooth_accel = node.accel;
        }
        let entry2 = node.entry2;
        let stops = node.ramp2() >= higher(entry2, node.begins2);
        self.nodes.push_back(node);
        if stops && !self.smooth {
            self.release_before_last();
        } else if self.nodes.len() - self.ready >= self.settle_at {
            self.settle();
        }
    }

    /// Makes all elements before the last one final: within that one the motion
    /// can come to rest from the largest speed at its start. The common case of
    /// short lines at a feed, and the window stays as small as it can be.
    #[inline]
    fn release_before_last(&mut self) {
        let last = self.nodes.len().saturating_sub(1);
        let mut e2 = 0.0;
        for node in self.nodes.range_mut(self.ready.min(last)..).rev() {
            e2 = if node.entry2 <= e2 + node.ramp2() {
                node.entry2
            } else {
                e2 + node.ramp2()
            };
            node.e2 = e2;
        }
        self.ready = last;
        self.settle_at = self.open_min;
    }

    /// The path stops after the last element: all are final.
    pub fn stop(&mut self) {
        if let Some(runs) = &mut self.runs {
            return runs.stop();
        }
        if self.ready == self.nodes.len() {
            return;
        }
        if !self.given {
            self.backward();
        }
        self.ready = self.nodes.len();
        self.settle_at = self.open_min;
    }

    /// Looks for elements that are final.
    pub fn settle(&mut self) {
        if let Some(runs) = &mut self.runs {
            return runs.settle();
        }
        if self.given {
            return;
        }
        let anchor = self.backward();
        self.ready = self.ready.max(anchor);
        if let Some(blocks) = self.blocks
            && !self.smooth
        {
            // The sum after it bounds all that is further after.
            let last = self.nodes.len().saturating_sub(blocks + 3);
            while self.ready < last && self.is_bounded(self.ready + 1) {
                self.ready += 1;
            }
        }
        let open = self.nodes.len() - self.ready;
        if open >= self.open_max {
            let until = self.ready + open / 2;
            for node in self.nodes.range_mut(self.ready..until) {
                node.forced = true;
            }
            self.ready = until;
        }
        let open = self.nodes.len() - self.ready;
        self.settle_at = (2 * open).saturating_add(self.open_min).min(self.open_max);
    }

    /// Runs the backward pass from rest at the end; elements before the index
    /// that it gives are final.
    fn backward(&mut self) -> usize {
        if self.smooth {
            return self.backward_smooth();
        }
        let mut e2 = 0.0;
        let mut anchor = None;
        for (i, node) in self.nodes.iter_mut().enumerate().skip(self.ready).rev() {
            let reach = e2 + node.ramp2();
            if reach >= node.entry2 {
                e2 = node.entry2;
                anchor = anchor.or(Some(i));
            } else {
                e2 = reach;
            }
            node.e2 = e2;
        }
        anchor.unwrap_or(0)
    }

    /// As [`Self::backward`], with the smoothed pass next to it: a hill of speed
    /// is cut at the height that the lower acceleration reaches (Klipper's
    /// minimum cruise ratio).
    ///
    /// Going back, the elements in which the smoothed speed falls all through
    /// wait for the peak that stands before them. Final is what stands before a
    /// peak after which both passes have met their limits.
    fn backward_smooth(&mut self) -> usize {
        let (mut e2, mut s2, mut peak2) = (0.0, 0.0, f64::INFINITY);
        let (mut anchored, mut smooth_anchored) = (false, false);
        let mut waiting: Option<usize> = None;
        let mut boundary = None;
        for i in (self.ready..self.nodes.len()).rev() {
            let Some(node) = self.nodes.get_mut(i) else {
                break;
            };
            let was_final = anchored && smooth_anchored;
            let next_s2 = s2;
            let reach = e2 + node.ramp2();
            e2 = lower(reach, node.entry2);
            anchored |= reach >= node.entry2;
            let smooth_reach = s2 + node.smooth2();
            s2 = lower(smooth_reach, node.smooth_entry2);
            smooth_anchored |= smooth_reach >= node.smooth_entry2;
            node.e2 = e2;
            if s2 < smooth_reach {
                if s2 + node.smooth2() > next_s2 || waiting.is_some() {
                    peak2 = 0.5 * (s2 + smooth_reach);
                    if was_final {
                        boundary = boundary.or(Some(i));
                    }
                    if let Some(end) = waiting.take() {
                        // They do not speed up.
                        let mut top2 = peak2;
                        for node in self.nodes.range_mut(i + 1..end) {
                            top2 = lower(top2, node.e2);
                            node.hill2 = top2;
                        }
                    }
                }
                if let Some(node) = self.nodes.get_mut(i) {
                    node.hill2 = peak2;
                }
            } else if waiting.is_none() {
                waiting = Some(i + 1);
            }
        }
        boundary.unwrap_or(0)
    }

    /// Whether an element may be final; a quick answer.
    #[inline]
    pub fn is_ready(&self) -> bool {
        self.ready > 0 || self.runs.is_some()
    }

    /// The next element in order, once it is final.
    #[inline]
    pub fn pop(&mut self) -> Option<Span<P>> {
        if let Some(runs) = &mut self.runs {
            return runs.pop();
        }
        if self.ready == 0 {
            return None;
        }
        let (end2, seen2) = match self.nodes.get(1) {
            Some(next) => {
                let cap2 = lower(next.e2, self.rest2(1, self.blocks));
                (lower(cap2, next.hill2), next.seen2)
            }
            None => (0.0, 0.0),
        };
        let node = self.nodes.front()?;
        let start2 = if self.now2 == 0.0 {
            node.step2
        } else {
            self.now2
        };
        let (ramp2, mut top2) = (node.ramp2(), lower(node.hill2, node.top2));
        let start2 = higher(start2, lower(node.begins2, end2 + ramp2));
        let end2 = lower(end2, start2 + ramp2);
        let most2 = if node.overruns {
            lower(top2, seen2)
        } else {
            top2
        };
        let end2 = lower(end2, higher(most2, start2 - ramp2));
        top2 = higher(top2, end2);
        if !node.overruns {
            top2 = higher(top2, start2);
        }
        // The same with the blocks that it surely sees.
        let low2 = if self.now2 == 0.0 { start2 } else { self.low2 };
        let low_end2 = match self.sure_blocks {
            Some(_) => lower(low2 + ramp2, self.rest2(1, self.sure_blocks) * ROUNDING),
            None => end2,
        };
        let span = Span {
            start2,
            end2,
            top2,
            length: node.length,
            accel: node.accel,
            certain: !node.forced,
            ranged: low2 < start2 || low_end2 < end2,
            section: None,
            payload: node.payload,
        };
        self.nodes.pop_front();
        self.ready -= 1;
        self.now2 = end2;
        self.low2 = lower(low_end2, end2);
        Some(span)
    }

    /// Whether what is further after an element than the controller sees bears nothing on it:
    /// to the end of all that is known it could stop from a higher speed.
    #[inline]
    fn is_bounded(&self, i: usize) -> bool {
        let (Some(node), Some(last)) = (self.nodes.get(i), self.nodes.back()) else {
            return false;
        };
        last.run != node.run || last.sum - node.sum + last.ramp2() >= self.rest2(i, self.blocks)
    }

    /// Speed, squared, from which the controller can stop within the blocks
    /// that it sees from element `i` on; infinite where it sees enough.
    #[inline]
    fn rest2(&self, i: usize, blocks: Option<usize>) -> f64 {
        let Some(blocks) = blocks else {
            return f64::INFINITY;
        };
        let Some(first) = self.nodes.get(i) else {
            return f64::INFINITY;
        };
        match self.nodes.get(i + blocks) {
            Some(node) if node.run == first.run => node.sum - first.sum + node.ramp2() + node.exit2,
            _ => f64::INFINITY,
        }
    }
}

/// The higher of two numbers.
#[inline]
fn higher(a: f64, b: f64) -> f64 {
    if b > a { b } else { a }
}
