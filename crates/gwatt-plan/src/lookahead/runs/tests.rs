//! Runs against the whole program at once, and against their limits.

use super::super::super::s_curve::Steepness;
use super::{Node, Runs, Span};
use crate::Phase;
use crate::random::Random;

impl Random {
    fn chance(&mut self, share: f64) -> bool {
        self.next() < share
    }
}

/// Elements from 1 µm to 30 mm in stretches of one feed, with corners here and
/// there; `stops`: the share of joints at rest.
fn nodes(seed: u64, count: usize, stops: f64) -> Vec<Node<usize>> {
    let mut random = Random(seed);
    let (mut top, mut before_top) = (50.0, 0.0);
    (0..count)
        .map(|i| {
            let length = libm::pow(10.0, -3.0 + 4.5 * random.next());
            if random.chance(0.05) {
                top = 1.0 + 150.0 * random.next();
            }
            let mut entry = f64::min(top, before_top);
            if random.chance(0.1) {
                entry *= random.next();
            }
            if random.chance(stops) {
                entry = 0.0;
            }
            before_top = top;
            let accel = 100.0 + 2000.0 * random.next();
            let mut node = Node::new(length, top * top, accel, entry * entry, i);
            if !random.chance(0.01) {
                node.jerk = libm::pow(10.0, 3.0 + 3.0 * random.next());
            }
            node.block = i % 3 != 1;
            node
        })
        .collect()
}

/// Runs elements through; `open_min` says how often the pass runs.
fn run(
    nodes: &[Node<usize>],
    blocks: Option<usize>,
    open_min: usize,
    open_max: usize,
) -> (Vec<Span<usize>>, usize) {
    let mut runs = Runs::new(blocks, true);
    (runs.open_min, runs.settle_at, runs.open_max) = (open_min, open_min, open_max);
    let mut spans = Vec::new();
    let mut held = 0;
    for node in nodes {
        if node.entry2 == 0.0 {
            runs.stop();
        }
        runs.push(node.clone());
        held = held.max(runs.elements.len() + runs.unseen.len());
        spans.extend(std::iter::from_fn(|| runs.pop()));
    }
    runs.stop();
    spans.extend(std::iter::from_fn(|| runs.pop()));
    (spans, held)
}

fn figures(spans: &[Span<usize>]) -> Vec<[u64; 5]> {
    let bits = |span: &Span<usize>| {
        let section = span.section.expect("an S-curve");
        let figures = [
            span.start2,
            span.end2,
            span.top2,
            span.accel,
            section.duration_s(),
        ];
        figures.map(f64::to_bits)
    };
    spans.iter().map(bits).collect()
}

#[test]
fn a_stream_gives_what_the_whole_program_gives() {
    for seed in 1..40 {
        for stops in [0.0, 0.002, 0.1] {
            let nodes = nodes(seed, 3000, stops);
            for blocks in [None, Some(1), Some(7), Some(50)] {
                let (whole, _) = run(&nodes, blocks, usize::MAX, usize::MAX);
                assert_eq!(whole.len(), nodes.len());
                for open_min in [1, 5, 24, 300] {
                    let (stream, held) = run(&nodes, blocks, open_min, usize::MAX);
                    assert_eq!(
                        figures(&stream),
                        figures(&whole),
                        "{seed} {blocks:?} {open_min}"
                    );
                    assert!(held < 2500, "{held}");
                }
            }
        }
    }
}

/// Positions, speeds and accelerations join, and all limits are kept.
#[test]
fn motion_is_smooth_and_keeps_all_limits() {
    for (seed, blocks) in [(77, None), (78, Some(5)), (79, Some(50))] {
        let nodes = nodes(seed, 20_000, 0.01);
        let (spans, _) = run(&nodes, blocks, 8, usize::MAX);
        assert_eq!(spans.len(), nodes.len());
        let (mut v, mut a, mut limited) = (0.0, 0.0, true);
        for (span, node) in spans.iter().zip(&nodes) {
            let top = node.top2.sqrt();
            assert!(span.start2.sqrt() <= node.entry2.sqrt() * (1.0 + 1e-9));
            assert!(span.top2 <= node.top2 * (1.0 + 1e-12));
            let section = span.section.expect("an S-curve");
            let profile = section.profile();
            assert!((profile.length_mm() / node.length - 1.0).abs() < 1e-6);
            assert!((profile.duration_s() / section.duration_s() - 1.0).abs() < 1e-6);
            assert!(profile.top_speed_mm_s() <= span.top2.sqrt() * (1.0 + 1e-9));
            for phase in &profile.phases {
                let accels = [phase.accel_mm_s2, phase.end_accel_mm_s2()];
                assert!(
                    (phase.velocity_mm_s - v).abs() <= 1e-9 * top,
                    "{phase:?} {v}"
                );
                if limited && node.jerk < f64::INFINITY {
                    assert!((accels[0] - a).abs() <= 1e-6 * node.accel, "{phase:?} {a}");
                }
                for accel in accels {
                    assert!(accel.abs() <= node.accel * (1.0 + 1e-9));
                    assert!(accel.abs() <= span.accel * (1.0 + 1e-9));
                }
                let jerk = phase.jerk_at(1.0, 0.0).abs();
                assert!(jerk <= node.jerk * (1.0 + 1e-9));
                (v, a) = (phase.end_velocity_mm_s, accels[1]);
                limited = node.jerk < f64::INFINITY;
            }
            assert!((span.end2.sqrt() - v).abs() <= 1e-9 * top);
        }
        assert_eq!(v, 0.0);
    }
}

/// Where nothing limits the joints, many elements run as one.
#[test]
fn joints_that_limit_nothing_leave_no_trace() {
    let steepness = Steepness {
        accel_mm_s2: 2000.0,
        jerk_mm_s3: 40e3,
    };
    // Ramps of 15 mm to 200 mm/s; elements of 0.5 and of 60 mm.
    for (length, count) in [(0.5, 200), (0.5, 40), (60.0, 5), (0.01, 5000)] {
        let nodes: Vec<_> = (0..count)
            .map(|i| {
                let entry2 = if i == 0 { 0.0 } else { 4e4 };
                let mut node = Node::new(length, 4e4, 2000.0, entry2, i);
                node.jerk = 40e3;
                node
            })
            .collect();
        let (spans, _) = run(&nodes, None, 8, usize::MAX);
        let way = length * f64::from(count as u32);
        let top = f64::min(200.0, steepness.top_from_rest(way));
        let expected = 2.0 * steepness.time(top) + (way - 2.0 * steepness.length(0.0, top)) / top;
        let phases = spans.iter().map(|span| span.section.expect("an S-curve"));
        let found: f64 = phases.map(|section| section.duration_s()).sum();
        assert!((found / expected - 1.0).abs() < 1e-9, "{found} {expected}");
    }
}

#[test]
fn what_is_forced_is_not_certain() {
    let mut nodes = nodes(5, 4000, 0.0);
    // Uphill all along: nothing is final before the end.
    for (i, node) in nodes.iter_mut().enumerate() {
        let top = 1.0 + i as f64;
        (node.length, node.top2) = (1e-4, top * top);
        node.entry2 = if i == 0 {
            0.0
        } else {
            (top - 1.0) * (top - 1.0)
        };
    }
    let (whole, _) = run(&nodes, None, 8, usize::MAX);
    assert!(whole.iter().all(|span| span.certain));
    let (forced, held) = run(&nodes, None, 8, 200);
    assert!(held < 250, "{held}");
    assert!(forced.iter().any(|span| !span.certain));
}

#[test]
fn the_farthest_speed_grows_and_can_be_reached() {
    let mut random = Random(3);
    for _ in 0..200_000 {
        let steepness = Steepness {
            accel_mm_s2: libm::pow(10.0, 1.0 + 3.0 * random.next()),
            jerk_mm_s3: libm::pow(10.0, 2.0 + 5.0 * random.next()),
        };
        let length = libm::pow(10.0, -5.0 + 8.0 * random.next());
        let low = libm::pow(10.0, -3.0 + 6.0 * random.next());
        let far = steepness.farthest(low, length);
        assert!(
            far >= low || low > 1e3 * far,
            "{steepness:?} {low} {length}"
        );
        if far >= low {
            assert!(steepness.length(low, far) <= length);
        }
        // From any slower one, too, and as far as that is possible.
        let slower = steepness.farthest(random.next() * low, length);
        assert!(slower <= far * (1.0 + 1e-12));
        let longest = steepness.longest(low);
        assert!(steepness.farthest(random.next() * low, longest) >= low);
        let rest = steepness.farthest(0.0, length);
        assert!(steepness.length(0.0, rest) <= length);
        assert!(steepness.length(0.0, 1.1 * rest) >= length * 0.9);
    }
}

/// The parts of a phase by position are those by time.
#[test]
fn an_instant_is_found_by_its_position() {
    let phase = Phase {
        kind: crate::PhaseKind::ConstantJerk { jerk_mm_s3: -40e3 },
        duration_s: 0.05,
        position_mm: 7.0,
        velocity_mm_s: 200.0,
        end_velocity_mm_s: 150.0,
        accel_mm_s2: 0.0,
    };
    for i in 0..=50 {
        let t = 1e-3 * f64::from(i);
        let found = phase.time_at(phase.state_at(t).position_mm);
        assert!((found - t).abs() < 1e-15 + 1e-12 * t, "{found} {t}");
    }
}
