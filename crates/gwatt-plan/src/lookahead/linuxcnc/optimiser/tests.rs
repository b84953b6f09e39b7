//! The optimiser against its passes, one by one, over a queue that keeps all.

use super::super::super::node::Node;
use super::super::super::pieces::{Load, Piece};
use super::super::super::ramp::Slack;
use super::Optimiser;
use crate::random::Random;

/// An element: 2·a·L, the limit of the joint before it, and the speed (all squared) with
/// which it is entered while it may still be cut.
#[derive(Debug, Clone, Copy)]
struct Part {
    ramp2: f64,
    limit2: f64,
    unseen2: f64,
    blend: bool,
    /// Of a line whose place a blend has taken: the speed with which it was entered.
    taken2: Option<f64>,
}

fn node(index: usize, part: &Part) -> Node<Load<usize>> {
    let load = Load {
        tag: index,
        first: index,
        next: None,
        piece: Piece::Along {
            from_mm: 0.0,
            to_mm: 1.0,
        },
        certain: true,
        rests: false,
        overlap_s: 0.0,
        overlaps: false,
        late_mm_s: 0.0,
        slack: Slack::default(),
    };
    let mut node = Node::new(0.5 * part.ramp2, 1e9, 1.0, part.limit2, load);
    node.block = !part.blend;
    node
}

/// The speeds at the joints, squared.
fn optimised(parts: &[Part], depth: Option<u32>, followed: bool) -> Vec<f64> {
    let mut optimiser = Optimiser::new(depth);
    let mut joints2 = Vec::new();
    let mut out = |node: Node<Load<usize>>| {
        assert_eq!(node.payload.tag, joints2.len());
        joints2.push(node.entry2);
    };
    for (index, part) in parts.iter().enumerate() {
        if let Some(unseen2) = part.taken2 {
            optimiser.pass_taken([part.limit2, unseen2], &mut out);
        }
        optimiser.push(node(index, part), part.unseen2, &mut out);
    }
    optimiser.end(followed, &mut out);
    joints2
}

/// The whole queue, with the passes as they are.
#[derive(Default)]
struct Queue {
    parts: Vec<Part>,
    joints2: Vec<f64>,
    at_limit: Vec<bool>,
}

impl Queue {
    fn add(&mut self, part: Part) {
        self.parts.push(part);
        self.joints2.push(0.0);
        self.at_limit.push(false);
    }

    fn take(&mut self) {
        self.parts.pop();
        self.joints2.pop();
        self.at_limit.pop();
    }

    /// A pass; whether the last element may still be cut, or is one after a stop that is left
    /// out here.
    fn pass(&mut self, cut: bool, depth: usize) {
        let (mut after2, mut hits, mut stops) = (0.0, 0, usize::from(!cut));
        for steps in 0..depth + usize::from(cut) {
            let Some(joint) = (self.parts.len() - 1).checked_sub(steps) else {
                return;
            };
            let part = self.parts[joint];
            if part.limit2 == 0.0 {
                stops += 1;
                if stops > 1 {
                    return;
                }
                after2 = 0.0;
                continue;
            }
            if cut && steps == 0 {
                self.joints2[joint] = part.unseen2.min(part.limit2);
            } else {
                let reach2 = after2 + part.ramp2;
                self.at_limit[joint] |= reach2 >= part.limit2;
                self.joints2[joint] = reach2.min(part.limit2);
            }
            after2 = self.joints2[joint];
            hits += usize::from(self.at_limit.get(joint + 1) == Some(&true));
            if hits > 4 {
                return;
            }
        }
    }
}

fn simulated(parts: &[Part], depth: usize, followed: bool) -> Vec<f64> {
    let mut queue = Queue::default();
    for part in parts {
        if part.limit2 == 0.0 && !queue.parts.is_empty() {
            queue.pass(false, depth);
        }
        if let Some(unseen2) = part.taken2 {
            queue.add(Part { unseen2, ..*part });
            queue.pass(true, depth);
            queue.take();
        }
        queue.add(*part);
        if !part.blend {
            queue.pass(true, depth);
        }
    }
    if followed {
        queue.pass(false, depth);
    }
    queue.joints2
}

fn random_parts(seed: u64, count: usize) -> Vec<Part> {
    let mut random = Random(seed);
    let (short, stops) = (random.next(), 0.05 * random.next());
    let mut blended = false;
    (0..count)
        .map(|index| {
            let long = random.next() > short;
            let ramp2 = if long { 3000.0 } else { 60.0 } * random.next();
            let stop = index == 0 || !blended && random.next() < stops;
            let blend = index > 0 && !stop && random.next() < 0.4 && index + 1 < count;
            // Not more than the blend in its place: speeds do not fall.
            let taken2 = (blend && blended).then(|| ramp2 * random.next());
            blended = blend;
            let low = random.next() < 0.2;
            let limit2 = if stop {
                0.0
            } else if low {
                500.0 * random.next()
            } else {
                500.0
            };
            Part {
                ramp2,
                limit2,
                unseen2: 0.5 * ramp2,
                blend,
                taken2,
            }
        })
        .collect()
}

#[test]
fn it_leaves_what_its_passes_leave() {
    let mut dips = 0;
    for seed in 1..400 {
        let parts = random_parts(seed, 300);
        for (depth, followed) in [
            (50, true),
            (50, false),
            (9, true),
            (20, false),
            (1000, true),
        ] {
            let expected = simulated(&parts, depth as usize, followed);
            let found = optimised(&parts, Some(depth), followed);
            assert_eq!(found.len(), expected.len());
            for (index, (found, expected)) in found.iter().zip(&expected).enumerate() {
                let off = (found - expected).abs();
                assert!(
                    off <= 1e-9 * expected.max(1.0),
                    "{seed} {depth} {index}: {found} {expected}"
                );
            }
            // Of those that a pass over all would raise further.
            let mut after2 = 0.0;
            for (part, expected) in parts.iter().zip(&expected).rev() {
                after2 = f64::min(part.limit2, after2 + part.ramp2);
                dips += usize::from(depth == 1000 && *expected < 0.99 * after2);
            }
        }
    }
    assert!(dips > 1000, "{dips}");
}

/// Ten lines of 2·a·L = 100 at up to 30 mm/s, then a long one. As it is added nine are open
/// joints: that of the long one, which may still be cut, has its limit, and so have the six
/// before it in this pass. The four before those could stop where the queue ended when the
/// last short one was added, and its half counted: 50 and 100 for each.
#[test]
fn hand_worked() {
    let line = |ramp2: f64, limit2: f64| Part {
        ramp2,
        limit2,
        unseen2: 0.5 * ramp2,
        blend: false,
        taken2: None,
    };
    let mut parts = vec![line(100.0, 0.0)];
    parts.extend([line(100.0, 900.0); 9]);
    parts.push(line(1e5, 900.0));
    let expected = [
        0.0, 850.0, 750.0, 650.0, 900.0, 900.0, 900.0, 900.0, 900.0, 900.0, 900.0,
    ];
    assert_eq!(optimised(&parts, Some(50), true), expected);
    assert_eq!(optimised(&parts, Some(50), false), expected);
    // Where the lines come to their limits one after the other nothing is left back.
    let lines = vec![line(100.0, 900.0); 40];
    let all = [&parts[..1], &lines].concat();
    assert_eq!(optimised(&all, Some(50), true)[1..32], [900.0; 31]);
}
