//! G5, G5.1, G5.2 and G5.3: cubic and quadratic splines and NURBS (`LinuxCNC`
//! "G5 Cubic Spline", "G5.1 Quadratic Spline", "G5.2 G5.3 NURBS Block").
//!
//! A curve becomes short lines, 15 for each control point, as `LinuxCNC`'s own
//! module for previews has them; its motion takes tangent arcs (`biarc` of `emccanon.cc`),
//! fewer and longer, between which it does not stop under G61 either. So the lines count
//! as chords of another path, which is bounded and not planned.

mod words;

use gwatt_motion::{Step, Stray};
use std::f64::consts::SQRT_2;

/// Lines for each control point.
const LINES_FOR_A_POINT: usize = 15;
/// By what factor arcs may turn more than their chords.
const ARCS_TURN: f64 = 1.5;
/// By how much the planner may exceed the limits of axes on arcs: tangential and centripetal
/// acceleration each keep to them, their sum does not.
const ARCS_EXCEED: f64 = SQRT_2 - 1.0;
/// Control points and order of a NURBS that are followed.
const POINTS_MAX: usize = 5000;
const ORDER_MAX: usize = 16;

const FIXED: &str = "it is part of a spline";

/// A control point: place in the plane, mm, machine coordinates, and weight.
#[derive(Debug, Clone, Copy)]
pub(super) struct ControlPoint {
    place: [f64; 2],
    weight: f64,
}

/// What splines keep from block to block.
#[derive(Debug, Default)]
pub(super) struct Spline {
    /// Vector from the start to the first control point that a G5 without I
    /// and J takes, mm.
    first: Option<[f64; 2]>,
    /// Control points of a NURBS, and its order.
    points: Vec<ControlPoint>,
    order: usize,
}

impl Spline {
    /// Forgets a series of splines that another motion has ended.
    pub(super) fn end(&mut self) {
        self.first = None;
        self.points.clear();
    }
}

/// Marks lines as the chords of a curve, each with how far it turns to the ones next to it.
fn as_chords(steps: &mut [Step]) {
    let along = |step: &Step| match step {
        Step::Move(mv) if mv.length_mm > 0.0 => {
            let axis = |i: usize| (mv.end[i] - mv.start[i]) / mv.length_mm;
            Some([axis(0), axis(1)])
        }
        _ => None,
    };
    let directions: Vec<_> = steps.iter().map(along).collect();
    for (index, step) in steps.iter_mut().enumerate() {
        let Step::Move(mv) = step else { continue };
        let own = directions.get(index).copied().flatten();
        let neighbours = [index.checked_sub(1), index.checked_add(1)];
        let turns = neighbours.into_iter().flatten().filter_map(|other| {
            let [[x, y], [u, v]] = [own?, directions.get(other).copied().flatten()?];
            Some(libm::hypot(x - u, y - v))
        });
        mv.stray = Stray {
            direction: ARCS_TURN * turns.fold(0.0, f64::max),
            accel: ARCS_EXCEED,
            in_chords: true,
        };
    }
}

fn unweighted(place: [f64; 2]) -> ControlPoint {
    ControlPoint { place, weight: 1.0 }
}

/// The point of a NURBS at the parameter `u`: de Boor's algorithm over
/// the knots 0 … 0, 1, 2 … with the first and last repeated `order` times.
fn point_at(points: &[ControlPoint], order: usize, u: f64) -> [f64; 2] {
    let count = points.len();
    let spans = count + 1 - order.min(count);
    let span = (u as usize).min(spans - 1);
    let knot =
        |index: usize| -> f64 { (index as f64 - (order as f64 - 1.0)).clamp(0.0, spans as f64) };
    // x·w, y·w and w of the points that count in this span.
    let mut work = [[0.0; 3]; ORDER_MAX];
    for (slot, point) in work.iter_mut().zip(points.iter().skip(span).take(order)) {
        let ControlPoint { place, weight } = *point;
        *slot = [place[0] * weight, place[1] * weight, weight];
    }
    for level in 1..order {
        for index in (level..order).rev() {
            let from = knot(span + index);
            let to = knot(span + index + order - level);
            let share = if to > from {
                (u - from) / (to - from)
            } else {
                0.0
            };
            let (Some(&left), Some(right)) =
                (work.get(index - 1).copied().as_ref(), work.get_mut(index))
            else {
                continue;
            };
            for (right, left) in right.iter_mut().zip(left) {
                *right = left * (1.0 - share) + *right * share;
            }
        }
    }
    let [x, y, weight] = work.get(order - 1).copied().unwrap_or([0.0, 0.0, 1.0]);
    [x / weight, y / weight]
}
