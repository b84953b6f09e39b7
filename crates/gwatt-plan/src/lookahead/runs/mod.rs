//! The window of a look-ahead with limits of jerk: runs of elements, each an
//! S-curve.
//!
//! Input and output are those of `window`. Speed and acceleration along the path
//! do not jump; at a joint that limits the speed the acceleration is 0:
//!
//! ```text
//!  v │     ______________        ╱‾‾‾   A run is a row of elements that all
//!    │    ╱  ·  ·  ·  ·  ╲______╱       may run at one speed, joints included.
//!    │___╱                              It is planned as one path: its ramps
//!    └─────────────────────────→ s      know nothing of the joints inside (·).
//! ```
//!
//! Its acceleration and jerk are the lowest of its elements'. A long run is cut
//! where both parts are longer than any ramp to its speed: there it runs at that
//! speed anyway, so that nothing changes. The cut depends on what comes
//! before alone.
//!
//! The passes are those of `window` over runs, with the speed that an S-curve
//! reaches ([`Steepness::farthest`]) in place of √(v² + 2·a·L). It grows with the
//! speed at the other end, so that what comes later can only raise the speeds:
//! the result is that of the whole program at once here as well.
//!
//! A controller that sees `n` blocks ahead begins each at a speed from which it
//! can stop within n.

#[cfg(test)]
mod tests;

use std::collections::VecDeque;

use super::super::profile::Profile;
use super::super::s_curve::{SCurve, Steepness};
use super::super::section::Section;
use super::node::{Node, OPEN_MAX, Span, lower};

/// How far a higher speed may lower another one by rounding, as a share.
const ROUNDING: f64 = 1e-12;
/// What rounding may make of a speed from which elements are enough to stop, as a share.
const RENEWED_ROUNDING: f64 = 1e-9;
/// Elements of one run, at most.
const RUN_MAX: usize = 1 << 12;
/// Runs after which a first backward pass is worth its start.
const OPEN_MIN: usize = 8;

/// An element that is not given out yet.
#[derive(Debug, Clone)]
struct Element<P> {
    length: f64,
    steepness: Steepness,
    payload: P,
}

/// A run of elements.
#[derive(Debug, Clone)]
struct Run {
    /// How many elements it has.
    count: usize,
    length: f64,
    /// Largest speed.
    top: f64,
    /// Largest speed at its start.
    entry: f64,
    /// The lowest of its elements.
    steepness: Steepness,
    /// Planned speed at its start.
    planned: f64,
    /// Released by the count, not by its neighbours.
    forced: bool,
}

/// The run that may still grow.
#[derive(Debug, Clone)]
struct Growing {
    run: Run,
    /// Elements from its start that are at least a ramp long, or all; and their
    /// length.
    ramp_count: usize,
    ramp_length: f64,
}

/// The run that is being given out.
#[derive(Debug, Clone)]
struct Current {
    curve: SCurve,
    /// The largest speed that it might have.
    cap: f64,
    profile: Profile,
    /// Elements that are left.
    left: usize,
    /// Where the next one begins, and at what time and speed.
    from_mm: f64,
    from_s: f64,
    speed: f64,
    /// Phase of that place, and when it began.
    phase: usize,
    phase_s: f64,
    certain: bool,
}

/// Elements whose speeds are not given out yet.
#[derive(Debug, Clone)]
pub(super) struct Runs<P> {
    /// Those that wait until the controller's own look-ahead is known.
    unseen: VecDeque<Node<P>>,
    elements: VecDeque<Element<P>>,
    /// Those that grow no more.
    closed: VecDeque<Run>,
    growing: Option<Growing>,
    current: Option<Current>,
    /// How many of the first runs are final.
    ready: usize,
    /// Open runs at which the next backward pass runs.
    settle_at: usize,
    /// Elements of the runs that are not final.
    open: usize,
    /// Speed at which the first run really starts.
    now: f64,
    /// The controller's own look-ahead.
    blocks: Option<usize>,
    /// Elements after one over which the controller surely plans its speeds again as these
    /// come; `None`: over all.
    renewed: Option<usize>,
    /// Whether the controller's rules are known to go together with limits of
    /// jerk.
    certain: bool,
    open_min: usize,
    open_max: usize,
}

impl<P> Runs<P> {
    pub fn new(blocks: Option<usize>, certain: bool) -> Self {
        Self {
            unseen: VecDeque::new(),
            elements: VecDeque::with_capacity(128),
            closed: VecDeque::with_capacity(64),
            growing: None,
            current: None,
            ready: 0,
            settle_at: OPEN_MIN,
            open: 0,
            now: 0.0,
            blocks,
            renewed: None,
            certain,
            open_min: OPEN_MIN,
            open_max: OPEN_MAX,
        }
    }

    /// The same where the controller plans an element again only while so many come after it:
    /// where these are shorter than it takes to stop, it may keep a lower speed at its end.
    pub fn renewing(mut self, elements: usize) -> Self {
        self.renewed = Some(elements);
        self
    }

    /// Adds an element.
    #[inline]
    pub fn push(&mut self, node: Node<P>) {
        let Some(blocks) = self.blocks else {
            return self.take(node);
        };
        self.unseen.push_back(node);
        while self.unseen.len() > blocks {
            // A blend enters the queue together with the line after it.
            let mut seen = 0;
            let (mut length, mut exit2) = (0.0, 0.0);
            let mut steepness = Steepness::NONE;
            for node in &self.unseen {
                if seen == blocks && node.block {
                    seen += 1;
                    break;
                }
                seen += usize::from(node.block);
                length += node.length;
                steepness = steepness.lowest(node.steepness());
                exit2 = node.exit2;
            }
            if seen <= blocks {
                return;
            }
            let Some(mut node) = self.unseen.pop_front() else {
                return;
            };
            let stops = steepness.farthest(f64::sqrt(exit2), length);
            node.entry2 = lower(node.entry2, stops * stops);
            self.take(node);
        }
    }

    /// Adds an element to the runs.
    #[inline]
    fn take(&mut self, node: Node<P>) {
        let top = node.top2.sqrt();
        let entry = node.entry2.sqrt();
        let element = Element {
            length: node.length,
            steepness: node.steepness(),
            payload: node.payload,
        };
        let steepness = element.steepness;
        if let Some(growing) = &mut self.growing {
            let run = &mut growing.run;
            if run.top == top && entry >= top && run.count < RUN_MAX {
                run.count += 1;
                run.length += element.length;
                run.steepness = run.steepness.lowest(steepness);
                self.elements.push_back(element);
                self.cut();
                return;
            }
            let entry = lower(lower(entry, top), run.top);
            self.close();
            self.begin(&element, top, entry);
        } else {
            // Nothing stands before it, or a stop.
            self.begin(&element, top, 0.0);
        }
        self.elements.push_back(element);
    }

    /// A run of one element.
    #[inline]
    fn begin(&mut self, element: &Element<P>, top: f64, entry: f64) {
        self.growing = Some(Growing {
            run: Run {
                count: 1,
                length: element.length,
                top,
                entry,
                steepness: element.steepness,
                planned: 0.0,
                forced: false,
            },
            ramp_count: 1,
            ramp_length: element.length,
        });
    }

    /// Cuts a run that has become long enough for it.
    #[inline]
    fn cut(&mut self) {
        let Some(growing) = &mut self.growing else {
            return;
        };
        let run = &growing.run;
        let ramp = run.steepness.longest(run.top);
        let first = self.elements.len() - run.count;
        while growing.ramp_length < ramp && growing.ramp_count < run.count {
            let next = self.elements.get(first + growing.ramp_count);
            growing.ramp_length += next.map_or(0.0, |element| element.length);
            growing.ramp_count += 1;
        }
        let rest = run.length - growing.ramp_length;
        if growing.ramp_length < ramp || rest < ramp || growing.ramp_count == run.count {
            return;
        }
        let (count, length, top) = (growing.ramp_count, growing.ramp_length, run.top);
        let lowest = |from: usize, count: usize| {
            let range = self.elements.range(first + from..first + from + count);
            range.fold(Steepness::NONE, |lowest, element| {
                lowest.lowest(element.steepness)
            })
        };
        let after = Run {
            count: run.count - count,
            length: rest,
            top,
            entry: top,
            steepness: lowest(count, run.count - count),
            planned: 0.0,
            forced: false,
        };
        let before = Run {
            count,
            length,
            steepness: lowest(0, count),
            ..run.clone()
        };
        let element = self.elements.get(first + count);
        self.growing = Some(Growing {
            ramp_count: 1,
            ramp_length: element.map_or(0.0, |element| element.length),
            run: after,
        });
        self.add(before);
    }

    /// The growing run grows no more.
    #[inline]
    fn close(&mut self) {
        if let Some(growing) = self.growing.take() {
            self.add(growing.run);
        }
    }

    #[inline]
    fn add(&mut self, run: Run) {
        self.open += run.count;
        self.closed.push_back(run);
        if self.closed.len() - self.ready >= self.settle_at || self.open >= self.open_max {
            self.settle();
        }
    }

    /// The path stops after the last element: all are final.
    pub fn stop(&mut self) {
        while let Some(node) = self.unseen.pop_front() {
            self.take(node);
        }
        self.close();
        self.backward();
        self.ready = self.closed.len();
        self.open = 0;
        self.settle_at = self.open_min;
    }

    /// Looks for runs that are final.
    pub fn settle(&mut self) {
        let anchor = self.backward();
        self.release(anchor, false);
        if self.open >= self.open_max {
            let (mut until, mut left) = (self.ready, self.open / 2);
            while let Some(run) = self.closed.get(until)
                && left > 0
            {
                left = left.saturating_sub(run.count);
                until += 1;
            }
            self.release(until, true);
        }
        let open = self.closed.len() - self.ready;
        self.settle_at = (2 * open).saturating_add(self.open_min);
    }

    /// Makes the runs before an index final.
    fn release(&mut self, until: usize, forced: bool) {
        for run in self.closed.range_mut(self.ready.min(until)..until) {
            run.forced |= forced;
            self.open -= run.count.min(self.open);
        }
        self.ready = self.ready.max(until);
    }

    /// Runs the backward pass from rest at the end; runs before the index that it
    /// gives are final.
    fn backward(&mut self) -> usize {
        let mut speed = 0.0;
        let mut anchor = None;
        for (i, run) in self.closed.iter_mut().enumerate().skip(self.ready).rev() {
            let reach = run.steepness.farthest(speed, run.length);
            if reach >= run.entry {
                speed = run.entry;
                // Rounding must not lower it again.
                if reach >= run.entry * (1.0 + ROUNDING) {
                    anchor = anchor.or(Some(i));
                }
            } else {
                speed = reach;
            }
            run.planned = speed;
        }
        anchor.unwrap_or(0)
    }

    /// The next element in order, once it is final.
    #[inline]
    pub fn pop(&mut self) -> Option<Span<P>> {
        if self.current.is_none() {
            self.current = self.next_run();
        }
        let current = self.current.as_mut()?;
        let element = self.elements.pop_front()?;
        let mut span = current.give(element);
        // Where less is asked for, the joint may not hold the motion back: then it is passed
        // at the speed that it permits, faster than here.
        let permitted = if current.left == 0 {
            self.now = current.curve.end;
            self.current = None;
            self.closed.front().map_or(0.0, |next| next.entry)
        } else {
            current.cap
        };
        span.certain &= self.is_renewed(permitted);
        Some(span)
    }

    /// Whether the element before those that are left surely gets this speed at its end.
    fn is_renewed(&self, end: f64) -> bool {
        let Some(elements) = self.renewed else {
            return true;
        };
        let (mut length, mut steepness) = (0.0, Steepness::NONE);
        for element in self.elements.iter().take(elements) {
            length += element.length;
            steepness = steepness.lowest(element.steepness);
        }
        end == 0.0
            || length > 0.0 && steepness.farthest(0.0, length) >= end * (1.0 - RENEWED_ROUNDING)
    }

    /// The next run, once it is final.
    fn next_run(&mut self) -> Option<Current> {
        if self.ready == 0 {
            return None;
        }
        let end = self.closed.get(1).map_or(0.0, |next| next.planned);
        let run = self.closed.pop_front()?;
        self.ready -= 1;
        let start = self.now;
        let end = lower(end, run.steepness.farthest(start, run.length));
        let curve = SCurve {
            start,
            end,
            top: run.steepness.top([start, end], run.top, run.length),
            steepness: run.steepness,
            length: run.length,
        };
        Some(Current {
            curve,
            cap: run.top,
            profile: if run.count > 1 {
                curve.profile()
            } else {
                Profile::default()
            },
            left: run.count,
            from_mm: 0.0,
            from_s: 0.0,
            speed: start,
            phase: 0,
            phase_s: 0.0,
            certain: self.certain && !run.forced,
        })
    }
}

impl Current {
    /// The next element with its speeds.
    #[inline]
    fn give<P>(&mut self, element: Element<P>) -> Span<P> {
        self.left -= 1;
        let (from_mm, from_s, start) = (self.from_mm, self.from_s, self.speed);
        if self.left == 0 {
            self.from_s = self.curve.duration_s();
            self.speed = self.curve.end;
        } else {
            self.from_mm += element.length;
            self.advance();
        }
        let times_s = [from_s, self.from_s];
        let section = Section::new(self.curve, [from_mm, self.cap], times_s, element.steepness);
        let (top, accel) = section.extremes(start, self.speed);
        Span {
            start2: start * start,
            end2: self.speed * self.speed,
            top2: top * top,
            length: element.length,
            accel,
            certain: self.certain,
            ranged: false,
            section: Some(section),
            payload: element.payload,
        }
    }

    /// Goes on in time to the present place.
    fn advance(&mut self) {
        let last = self.profile.phases.len().saturating_sub(1);
        while let Some(phase) = self.profile.phases.get(self.phase) {
            let next = self.profile.phases.get(self.phase + 1);
            let ends = next.map_or(self.curve.length, |next| next.position_mm);
            if ends <= self.from_mm && self.phase < last {
                self.phase += 1;
                self.phase_s += phase.duration_s;
                continue;
            }
            let t = phase.time_at(self.from_mm);
            self.from_s = (self.phase_s + t).max(self.from_s);
            self.speed = phase.state_at(t).velocity_mm_s.max(0.0);
            return;
        }
    }
}
