//! Klipper's planner, written again from its rules in one pass over a whole program,
//! next to plans of random moves of X, Y, Z and an extruder.
//!
//! `Δv² = 2·a·L` of a move, `a` its own acceleration; of the pass that smooths hills at
//! most `2·(1 − r)·a_max·L`, r the minimum cruise ratio.

use std::fmt::Write as _;

use gwatt::pipeline::{Certificate, Row};
use proptest::prelude::*;

use crate::machines::{linear_axes, machine_from};
use crate::runs::rows_of;

const ACCEL: f64 = 3000.0;
const CORNER: f64 = 5.0;
const RATIO: f64 = 0.5;
const EXTRUDER_STEP: f64 = 1.0;
/// Largest speed and acceleration of Z and of the extruder.
const Z: [f64; 2] = [10.0, 100.0];
const E: [f64; 2] = [50.0, 1500.0];

/// A move by X, Y, Z and E, and its speed.
type Asked = ([f64; 4], f64);

fn rows(program: &str) -> Vec<Row> {
    let axis =
        |letters, [speed, accel]: [f64; 2]| linear_axes(letters, [speed * 60.0, accel, 1.0], "");
    let machine = machine_from(&format!(
        "schema = 1\nname = \"test\"\ncontroller = \"klipper\"\n[converter]\n\
         peak_power_w = 1e6\n{}{}{}",
        axis("XY", [300.0, ACCEL]),
        axis("Z", Z),
        axis("E", E)
    ));
    rows_of(&machine, program)
}

struct Ruled {
    length: f64,
    accel: f64,
    top2: f64,
    /// Directions; nothing where the extruder moves alone.
    along: Option<[f64; 4]>,
    delta2: f64,
    smooth2: f64,
    start2: f64,
    smooth_start2: f64,
}

impl Ruled {
    fn of(&([x, y, z, e], speed): &Asked) -> Self {
        let path = (x * x + y * y + z * z).sqrt();
        let moves = path > 1e-9;
        let length = if moves { path } else { e.abs() };
        let (mut top, mut accel) = if moves {
            (speed.min(300.0), ACCEL)
        } else {
            (speed, 1e8)
        };
        let mut limit = |[own_speed, own_accel]: [f64; 2], part: f64| {
            top = top.min(own_speed * length / part.abs());
            accel = accel.min(own_accel * length / part.abs());
        };
        if z != 0.0 {
            limit(Z, z);
        }
        if e != 0.0 {
            limit(E, e);
        }
        Self {
            length,
            accel,
            top2: top * top,
            along: moves.then(|| [x, y, z, e].map(|part| part / length)),
            delta2: 2.0 * length * accel,
            smooth2: 2.0 * length * accel.min(ACCEL * (1.0 - RATIO)),
            start2: 0.0,
            smooth_start2: 0.0,
        }
    }

    /// Sets the largest speed at the joint with the move before.
    fn join(&mut self, before: &Self) {
        let (Some(u), Some(w)) = (before.along, self.along) else {
            return;
        };
        let mut most2 = self
            .top2
            .min(before.top2)
            .min(before.start2 + before.delta2);
        let extruder = (w[3] - u[3]).abs();
        if extruder > 0.0 {
            most2 = most2.min((EXTRUDER_STEP / extruder) * (EXTRUDER_STEP / extruder));
        }
        let cos = -(u[0] * w[0] + u[1] * w[1] + u[2] * w[2]);
        let (s, c) = (
            (0.5 * (1.0 - cos)).max(0.0).sqrt(),
            (0.5 * (1.0 + cos)).max(0.0).sqrt(),
        );
        if s < 1.0 && c > 0.0 {
            let deviation = CORNER * CORNER * (std::f64::consts::SQRT_2 - 1.0) / ACCEL;
            let accel = self.accel.min(before.accel);
            most2 = most2.min(s / (1.0 - s) * deviation * accel);
            most2 = most2.min(0.25 * s / c * self.delta2.min(before.delta2));
        }
        self.start2 = most2;
        self.smooth_start2 = most2.min(before.smooth_start2 + before.smooth2);
    }
}

/// How long each move takes.
fn ruled_s(asked: &[Asked]) -> Vec<f64> {
    let mut moves: Vec<Ruled> = asked.iter().map(Ruled::of).collect();
    for index in 1..moves.len() {
        let (before, rest) = moves.split_at_mut(index);
        rest[0].join(&before[index - 1]);
    }
    let mut speeds2 = vec![(0.0, None, 0.0); moves.len()];
    let (mut next2, mut smooth2, mut peak2, mut pending) = (0.0, 0.0, 0.0, 0);
    for (index, own) in moves.iter().enumerate().rev() {
        let reach2 = next2 + own.delta2;
        let start2 = own.start2.min(reach2);
        let smooth_reach2 = smooth2 + own.smooth2;
        let smooth_start2 = own.smooth_start2.min(smooth_reach2);
        let mut cruise2 = None;
        pending += 1;
        if smooth_start2 < smooth_reach2 {
            if smooth_start2 + own.smooth2 > smooth2 || pending > 1 {
                peak2 = 0.5 * (smooth_start2 + smooth_reach2);
            }
            cruise2 = Some((0.5 * (start2 + reach2)).min(own.top2).min(peak2));
            pending = 0;
        }
        speeds2[index] = (start2, cruise2, next2);
        (next2, smooth2) = (start2, smooth_start2);
    }
    let mut last2: f64 = 0.0;
    let timed = moves
        .iter()
        .zip(speeds2)
        .map(|(own, (start2, cruise2, end2))| {
            let top2 = cruise2.unwrap_or_else(|| last2.min(start2));
            last2 = top2;
            let [start2, end2] = [start2, end2].map(|v2: f64| v2.min(top2));
            let [start, top, end] = [start2, top2, end2].map(f64::sqrt);
            let ramps_mm = 0.5 * (2.0 * top2 - start2 - end2) / own.accel;
            (2.0 * top - start - end) / own.accel + (own.length - ramps_mm) / top
        });
    timed.collect()
}

fn program(asked: &[Asked]) -> String {
    // The acceleration along all paths too: diagonals have no more.
    let mut text = format!("SET_VELOCITY_LIMIT ACCEL={ACCEL}\nG91\nM83\n");
    for ([x, y, z, e], speed) in asked {
        let _ = write!(text, "G1");
        for (letter, part) in [("X", x), ("Y", y), ("Z", z), ("E", e)] {
            if *part != 0.0 {
                let _ = write!(text, " {letter}{part:.6}");
            }
        }
        let _ = writeln!(text, " F{:?}", speed * 60.0);
    }
    text
}

fn compare(asked: &[Asked]) {
    let text = program(asked);
    let rows = rows(&text);
    assert!(
        rows.iter()
            .all(|row| row.certificate == Certificate::Planned),
        "{text}"
    );
    let expected = ruled_s(asked);
    let own: Vec<f64> = rows.iter().map(|row| row.duration_s).collect();
    assert_eq!(own.len(), expected.len(), "{text}");
    for (at, (own, expected)) in own.iter().zip(&expected).enumerate() {
        assert!(
            (own - expected).abs() < 1e-6 * expected,
            "move {at}: {own} s, not {expected}\n{text}"
        );
    }
}

/// A hop of Z between long moves begins or ends at `5·√(100/3000)` = 0.913 mm/s and
/// reaches `√(100·0.5 + 0.417)` = 7.1005 mm/s; the extruder reaches its 30 mm/s.
#[test]
fn what_z_or_the_extruder_slow_down_by_hand() {
    let asked = [
        ([50.0, 0.0, 0.0, 0.0], 100.0),
        ([0.0, 0.0, 0.0, -0.7], 30.0),
        ([0.0, 0.0, 0.5, 0.0], 10.0),
        ([50.0, 0.0, 0.0, 0.0], 100.0),
    ];
    let seconds: Vec<f64> = rows(&program(&asked))
        .iter()
        .map(|row| row.duration_s)
        .collect();
    let extruder_s = 0.7 / 30.0 + 30.0 / 1500.0;
    let end = CORNER * (100.0_f64 / 3000.0).sqrt();
    let top = (100.0 * 0.5 + 0.5 * end * end).sqrt();
    let hop_s = (2.0 * top - end) / 100.0;
    assert!((seconds[1] - extruder_s).abs() < 1e-12, "{seconds:?}");
    assert!((seconds[2] - hop_s).abs() < 1e-12, "{seconds:?}");
    compare(&asked);
}

proptest! {
    #[test]
    fn random_moves_take_as_long_as_by_the_rules(
        moves in prop::collection::vec((0_u8..8, prop::array::uniform4(-1.0..1.0), 5.0..250.0, 0.0..2.5), 2..25),
    ) {
        let asked: Vec<Asked> = moves.into_iter().map(|(kind, [x, y, z, e], speed, scale)| {
            let size = libm::pow(10.0, scale - 1.0);
            let round = |value: f64| (value * size * 1e4).round() / 1e4 + 1e-3;
            let [x, y] = [x, y].map(round);
            let by = match kind {
                0 => [0.0, 0.0, 0.1 * round(z), 0.0],
                1 => [0.0, 0.0, 0.0, 0.1 * round(e)],
                2 => [x, y, 0.1 * round(z), 0.0],
                3 => [x, y, 0.0, 0.02 * round(e)],
                4 => [x, 0.0, 0.0, 0.0],
                _ => [x, y, 0.0, 0.0],
            };
            let mut by = by.map(|part: f64| (part * 1e6).round() / 1e6);
            if by == [0.0; 4] {
                by[0] = 1.0;
            }
            (by, f64::round(speed * 10.0) / 10.0)
        }).collect();
        compare(&asked);
    }
}
