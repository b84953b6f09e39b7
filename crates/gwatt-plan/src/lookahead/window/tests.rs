//! The window against the whole program at once, and against plain arithmetic.

use super::{Node, Span, Window};
use crate::random::Random;

/// Elements from 1 µm to 30 mm; `stops`: the share of joints at rest.
fn nodes(seed: u64, count: usize, stops: f64) -> Vec<Node<usize>> {
    let mut random = Random(seed);
    let mut before_top2 = 0.0;
    (0..count)
        .map(|i| {
            let length = libm::pow(10.0, -3.0 + 4.5 * random.next());
            let top = 1.0 + 150.0 * random.next();
            let accel = 100.0 + 2000.0 * random.next();
            let corner = if random.next() < stops {
                0.0
            } else {
                200.0 * random.next()
            };
            let top2 = top * top;
            let entry2 = f64::min(corner * corner, f64::min(top2, before_top2));
            before_top2 = top2;
            let mut node = Node::new(length, top2, accel, entry2, i);
            node.smooth_accel = 0.4 * accel;
            node
        })
        .collect()
}

/// Runs elements through a window; `open_min` says how often the pass runs.
fn run(
    nodes: &[Node<usize>],
    blocks: Option<u32>,
    smooth: bool,
    open_min: usize,
    open_max: usize,
) -> (Vec<Span<usize>>, usize) {
    run_in(Window::new(blocks, smooth), nodes, open_min, open_max)
}

fn run_in(
    mut window: Window<usize>,
    nodes: &[Node<usize>],
    open_min: usize,
    open_max: usize,
) -> (Vec<Span<usize>>, usize) {
    (window.open_min, window.settle_at, window.open_max) = (open_min, open_min, open_max);
    let mut spans = Vec::new();
    let mut held = 0;
    for node in nodes {
        if node.entry2 == 0.0 {
            window.stop();
        }
        window.push(node.clone());
        held = held.max(window.nodes.len());
        spans.extend(std::iter::from_fn(|| window.pop()));
    }
    window.stop();
    spans.extend(std::iter::from_fn(|| window.pop()));
    (spans, held)
}

fn figures(spans: &[Span<usize>]) -> Vec<[u64; 3]> {
    let bits = |span: &Span<usize>| [span.start2, span.end2, span.top2].map(f64::to_bits);
    spans.iter().map(bits).collect()
}

#[test]
fn a_stream_gives_what_the_whole_program_gives() {
    for seed in 1..40 {
        for stops in [0.0, 0.002, 0.1] {
            let nodes = nodes(seed, 3000, stops);
            for blocks in [None, Some(1), Some(7), Some(50)] {
                let (whole, _) = run(&nodes, blocks, false, usize::MAX, usize::MAX);
                for open_min in [1, 5, 24, 300] {
                    let (stream, held) = run(&nodes, blocks, false, open_min, usize::MAX);
                    assert_eq!(
                        figures(&stream),
                        figures(&whole),
                        "{seed} {blocks:?} {open_min}"
                    );
                    assert!(held < 1500, "{held}");
                }
            }
        }
    }
}

#[test]
fn a_smoothed_stream_gives_what_the_whole_program_gives() {
    for seed in 1..40 {
        for stops in [0.0, 0.002, 0.1] {
            let nodes = nodes(seed, 3000, stops);
            let (whole, _) = run(&nodes, None, true, usize::MAX, usize::MAX);
            for open_min in [1, 5, 24, 300] {
                let (stream, held) = run(&nodes, None, true, open_min, usize::MAX);
                assert_eq!(figures(&stream), figures(&whole), "{seed} {open_min}");
                assert!(held < 2000, "{held}");
            }
        }
    }
}

#[test]
fn speeds_join_and_keep_all_limits() {
    for (smooth, blocks) in [(false, None), (false, Some(5)), (true, None)] {
        let nodes = nodes(77, 20_000, 0.01);
        let (spans, _) = run(&nodes, blocks, smooth, 24, usize::MAX);
        assert_eq!(spans.len(), nodes.len());
        let mut before2 = 0.0;
        for (span, node) in spans.iter().zip(&nodes) {
            assert_eq!(span.start2, before2);
            assert!(span.start2 <= node.entry2);
            assert!(span.top2 <= node.top2);
            let change = (span.end2 - span.start2).abs();
            assert!(change <= 2.0 * node.accel * node.length * (1.0 + 1e-9) + 1e-9);
            assert!(span.certain);
            before2 = span.end2;
        }
        assert_eq!(before2, 0.0);
    }
}

#[test]
fn a_controller_can_always_stop_within_the_blocks_it_sees() {
    let mut nodes = nodes(5, 5000, 0.0);
    for node in &mut nodes {
        // Short ones, so that it matters.
        node.length *= 0.01;
    }
    for blocks in [1_usize, 4, 20] {
        let (spans, _) = run(&nodes, Some(blocks as u32), false, 24, usize::MAX);
        let mut bound = false;
        for i in 1..nodes.len() - blocks - 1 {
            let most: f64 = nodes[i..=i + blocks]
                .iter()
                .map(|node| 2.0 * node.accel * node.length)
                .sum();
            assert!(spans[i].start2 <= most * (1.0 + 1e-9) + 1e-6, "{i}");
            bound |= spans[i].start2 >= most * (1.0 - 1e-9) && most > 0.0;
        }
        assert!(bound, "{blocks} never mattered");
    }
}

/// A controller that sees more or fewer blocks, as time goes, has the same speeds save in ranged
/// elements, and none above those with the most.
#[test]
fn what_depends_on_how_many_blocks_are_seen_is_ranged() {
    let mut nodes = nodes(9, 5000, 0.01);
    for node in &mut nodes {
        node.length *= 0.02;
    }
    for (fewest, most) in [(1, 4), (3, 9), (12, 20)] {
        let window = || Window::new(Some(fewest), false).seeing_up_to(Some(most));
        let (ranged, _) = run_in(window(), &nodes, 24, usize::MAX);
        let (whole, _) = run_in(window(), &nodes, usize::MAX, usize::MAX);
        assert_eq!(figures(&ranged), figures(&whole));
        let same = ranged.iter().filter(|span| !span.ranged).count();
        assert!(same > 500 && same < 4900, "{fewest} {most}: {same}");
        for blocks in fewest..=most {
            let (plan, _) = run(&nodes, Some(blocks), false, 24, usize::MAX);
            for (i, (span, other)) in ranged.iter().zip(&plan).enumerate() {
                for (high, there) in [(span.start2, other.start2), (span.end2, other.end2)] {
                    assert!(there <= high * (1.0 + 1e-9), "{i}");
                    let same = (there - high).abs() <= 1e-9 * high;
                    assert!(same || span.ranged, "{i}: {there} {high}");
                }
            }
        }
    }
}

#[test]
fn beyond_the_count_limit_speeds_are_lower_and_not_certain() {
    // 5000 elements of 1 µm at 100 mm/s: the stopping distance is all of them.
    let nodes: Vec<Node<usize>> = (0..5000)
        .map(|i| Node::new(0.001, 1e4, 1000.0, 1e4, i))
        .collect();
    let (whole, _) = run(&nodes, None, false, usize::MAX, usize::MAX);
    let (stream, held) = run(&nodes, None, false, 24, 64);
    assert!(held <= 65, "{held}");
    assert!(stream.iter().any(|span| !span.certain));
    assert!(whole.iter().all(|span| span.certain));
    for (low, high) in stream.iter().zip(&whole) {
        assert!(low.start2 <= high.start2 && low.end2 <= high.end2);
    }
}

#[test]
fn hand_worked() {
    // From rest, 2·a·L = 100 and 300, a corner of 8 mm/s between.
    let nodes = [
        Node::new(0.05, 2500.0, 1000.0, 0.0, 0),
        Node::new(0.15, 2500.0, 1000.0, 64.0, 1),
    ];
    let (spans, _) = run(&nodes, None, false, 24, 100);
    let speeds: Vec<_> = spans.iter().map(|span| (span.start2, span.end2)).collect();
    assert_eq!(speeds, [(0.0, 64.0), (64.0, 0.0)]);
}

#[test]
fn a_hill_is_cut_at_the_smoothed_height() {
    // One element alone, cruise ratio 0.6: the top that 0.4 of the acceleration
    // reaches in half the way, v² = 0.4·a·L.
    let mut node = Node::new(10.0, 1e6, 1000.0, 0.0, 0);
    node.smooth_accel = 400.0;
    let (spans, _) = run(&[node], None, true, 24, 100);
    assert_eq!(spans[0].top2, 4000.0);
}
