//! Effects with the sizes that suit the recordings best: periods and speeds are moved
//! together (Gauss and Newton), and their errors widen those of all else.

use super::super::equations::Equations;
use super::super::friction::{Friction, Solved, left_of, solve, solve_best};
use super::shape::Shape;

/// Steps by which sizes are moved.
const STEPS: usize = 3;

/// Equations with effects, and their solution.
pub struct Settled {
    pub all: Vec<Equations>,
    pub solved: Solved,
    pub shapes: Vec<Shape>,
    /// Standard errors of the sizes, as shares of them.
    pub size_stds: Vec<f64>,
}

/// The column of an unknown of a shape for the equations of one recording of several: where
/// factors are of a recording, those of the others are empty.
fn column(
    shape: Shape,
    equations: &Equations,
    recording: usize,
    unknown: usize,
) -> Option<Vec<f64>> {
    if !shape.is_apart() {
        return shape.column(&equations.raw, unknown);
    }
    let width = shape.width();
    if unknown / width == recording {
        shape.column(&equations.raw, unknown % width)
    } else {
        Some(Vec::new())
    }
}

/// Unknowns of a shape in so many recordings.
pub fn unknowns(shape: Shape, recordings: usize) -> usize {
    if shape.is_apart() {
        recordings * shape.width()
    } else {
        shape.width()
    }
}

/// The columns of a shape in the band, for each recording.
pub fn in_band(all: &[Equations], shape: Shape) -> Option<Vec<Vec<Vec<f64>>>> {
    let of = all.len();
    let each = all.iter().enumerate().map(|(index, equations)| {
        let in_band = (0..unknowns(shape, of)).map(|unknown| {
            let column = column(shape, equations, index, unknown)?;
            Some(if column.is_empty() {
                vec![0.0; equations.inside.force.len()]
            } else {
                equations.in_band(&column)
            })
        });
        in_band.collect()
    });
    each.collect()
}

/// The equations with these effects as further columns.
pub fn with(base: &[Equations], shapes: &[Shape]) -> Option<Vec<Equations>> {
    let mut all = base.to_vec();
    let of = base.len();
    for (index, equations) in all.iter_mut().enumerate() {
        for shape in shapes {
            for unknown in 0..unknowns(*shape, of) {
                let column = column(*shape, equations, index, unknown)?;
                equations.add(&column);
            }
        }
    }
    Some(all)
}

/// How the force of an effect with these factors changes with its size, for one recording.
fn slope(
    equations: &Equations,
    shape: Shape,
    factors: &[f64],
    recording: usize,
    range: f64,
) -> Option<Vec<f64>> {
    let [_, little] = shape.steps(range);
    let (longer, shorter) = (shape.resized(1.0 + little), shape.resized(1.0 - little));
    let mut slope = vec![0.0; equations.raw.force.len()];
    for (unknown, factor) in factors.iter().enumerate() {
        let larger = column(longer, equations, recording, unknown)?;
        let smaller = column(shorter, equations, recording, unknown)?;
        for ((slot, a), b) in slope.iter_mut().zip(&larger).zip(&smaller) {
            *slot += factor * (a - b) / (2.0 * little);
        }
    }
    Some(slope)
}

/// The solution with all that may change: sizes as further unknowns.
fn joint(all: &[Equations], solved: &Solved, shapes: &[Shape], range: f64) -> Option<Solved> {
    let of = all.len();
    let factors = solved.theta.get(solved.terms.width()..)?;
    let mut wider = all.to_vec();
    for (index, equations) in wider.iter_mut().enumerate() {
        equations.above = None;
        let mut at = 0;
        for shape in shapes {
            let count = unknowns(*shape, of);
            let own = factors.get(at..at + count)?;
            let slope = slope(equations, *shape, own, index, range)?;
            equations.add(&slope);
            at += count;
        }
    }
    solve(&wider, solved.terms)
}

fn rest(all: &[Equations], solved: &Solved) -> f64 {
    let left = all
        .iter()
        .map(|it| left_of(it, solved.terms, &solved.theta));
    left.map(|[left, _]| left).sum()
}

/// Settles the sizes of effects. `None` where the recordings do not determine them.
pub fn settled(
    base: &[Equations],
    asked: Option<Friction>,
    mut shapes: Vec<Shape>,
    range: f64,
) -> Option<Settled> {
    let mut best: Option<(f64, Settled)> = None;
    for step in 0..=STEPS {
        let mut all = with(base, &shapes)?;
        let Some(mut solved) = solve_best(&mut all, asked) else {
            break;
        };
        let left = rest(&all, &solved);
        if best.as_ref().is_some_and(|(least, _)| left >= *least) {
            break;
        }
        let Some(joint) = joint(&all, &solved, &shapes, range) else {
            break;
        };
        let known = solved.theta.len();
        let size_stds = (known..joint.theta.len()).map(|at| joint.covariance[(at, at)].sqrt());
        let size_stds: Vec<f64> = size_stds.collect();
        solved.covariance = joint.covariance.view((0, 0), (known, known)).into_owned();
        let moves = joint.theta.iter().skip(known);
        let moved = shapes.iter().zip(moves).map(|(shape, by)| {
            let [most, _] = shape.steps(range);
            shape.resized(1.0 + by.clamp(-most, most))
        });
        let moved = moved.collect();
        best = Some((
            left,
            Settled {
                all,
                solved,
                shapes,
                size_stds,
            },
        ));
        if step == STEPS {
            break;
        }
        shapes = moved;
    }
    best.map(|(_, settled)| settled)
}
