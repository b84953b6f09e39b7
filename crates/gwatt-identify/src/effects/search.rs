//! One effect after another, as long as each predicts the recordings clearly better.

use std::f64::consts::TAU;
use std::sync::Arc;

use super::super::equations::Equations;
use super::super::figure::Figure;
use super::super::friction::{
    Friction, Solved, Terms, counted_rows, left_of, predicted, refit, rest_of,
};
use super::cogging::{Left, lines, periodic_in_time};
use super::effect::Effect;
use super::play::Play;
use super::settled::{Settled, in_band, settled, unknowns, with};
use super::shape::Shape;
use crate::certainty;

/// Nothing is looked for where a model leaves less of the force than this.
const LEFT: f64 = 0.02;
/// An effect makes up this share of the force at least.
const SHARE: f64 = 0.02;
/// By which share what is left of predictions falls at least.
const BETTER: f64 = 0.1;
/// Effects at most.
const EFFECTS: usize = 6;
/// Stretches of each part that is predicted by the others.
const STRETCHES: usize = 8;
/// Sizes that are tried: plays by the range, speeds by the largest one.
const PLAYS: [f64; 2] = [1e-4, 0.3];
const SPEEDS: [f64; 2] = [0.004, 0.4];
const SIZES: usize = 12;
/// Halvings of the distance between sizes.
const HALVINGS: u32 = 4;
/// A position explains so many times as much as a time, where a force is periodic in it.
const RATHER_THAN_TIME: f64 = 1.5;
/// A load within a play has such a share of the mass, at least and at most.
const LOAD: [f64; 2] = [0.05, 1.1];

/// Coulomb friction is such a share of what breakaway has more, at least.
const SLIDING: f64 = 0.2;

/// What a model leaves with a shape next to it: a sum of squares.
fn tried(all: &[Equations], terms: Terms, shape: Shape) -> f64 {
    let rest = in_band(all, shape).and_then(|further| rest_of(all, terms, &further));
    rest.unwrap_or(f64::INFINITY)
}

/// The size of a shape between two ends that leaves least, in equal ratios and then by
/// halves of their distance.
fn sized(
    all: &[Equations],
    terms: Terms,
    [from, to]: [f64; 2],
    shape: impl Fn(f64) -> Shape,
) -> Option<Shape> {
    let rest = |size: f64| tried(all, terms, shape(size));
    let mut ratio = libm::pow(to / from, 1.0 / (SIZES - 1) as f64);
    let sizes = (0..SIZES).map(|k| from * libm::pow(ratio, k as f64));
    let all_sizes = sizes.map(|size| (rest(size), size));
    let (mut least, mut best) = all_sizes.min_by(|a, b| a.0.total_cmp(&b.0))?;
    for _ in 0..HALVINGS {
        ratio = ratio.sqrt();
        for size in [best / ratio, best * ratio] {
            let rest = rest(size);
            if rest < least {
                (least, best) = (rest, size);
            }
        }
    }
    least.is_finite().then(|| shape(best))
}

fn largest(all: &[Equations], of: impl Fn(&Equations) -> f64) -> f64 {
    all.iter().map(of).fold(0.0, f64::max)
}

fn range(equations: &Equations) -> f64 {
    let position = equations.raw.position.iter().flat_map(|x| x.iter());
    let (low, high) = position.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
        (low.min(*x), high.max(*x))
    });
    (high - low).max(0.0)
}

fn fastest(equations: &Equations) -> f64 {
    let speed = equations.raw.velocity.iter().flat_map(|x| x.iter());
    speed.fold(0.0, |most: f64, v| most.max(v.abs()))
}

/// The speed that a motion passes in a quarter of the band's shortest period: what friction
/// does below is as short as a blow.
fn passed_in_band(equations: &Equations) -> f64 {
    let squares: f64 = equations.raw.acceleration.iter().map(|a| a * a).sum();
    let rms = (squares / equations.raw.acceleration.len().max(1) as f64).sqrt();
    0.25 * rms / equations.bandwidth_hz
}

/// What a solution leaves, where the motion was.
fn left(all: &[Equations], solved: &Solved) -> Vec<Left> {
    let each = all.iter().zip(&solved.residuals);
    each.map(|(equations, residual)| {
        let counted = |column: &Option<Arc<Vec<f64>>>| -> Vec<f64> {
            let thin = equations.thinned(column.as_deref().map_or(&[][..], |x| x));
            let both = thin.into_iter().zip(&equations.counts);
            both.filter(|(_, counts)| **counts)
                .map(|(x, _)| x)
                .collect()
        };
        Left {
            residual: residual.clone(),
            position: counted(&equations.raw.position),
            speed: counted(&equations.raw.velocity),
        }
    })
    .collect()
}

/// How much of what is left is explained by a sine of the time.
fn explained_in_time(all: &[Equations], solved: &Solved) -> f64 {
    let each = all.iter().zip(&solved.residuals);
    each.map(|(equations, residual)| {
        let mut left = residual.iter();
        let evenly = equations.counts.iter().map(|counts| {
            let next = counts.then(|| left.next()).flatten();
            next.copied().unwrap_or_default()
        });
        let squares: f64 = residual.iter().map(|x| x * x).sum();
        let evenly: Vec<f64> = evenly.collect();
        let share = periodic_in_time(&evenly) * evenly.len() as f64;
        squares * share / residual.len().max(1) as f64
    })
    .sum()
}

/// The period in position that explains most, unless one in time explains as much.
fn cogging(all: &[Equations], solved: &Solved) -> Option<Shape> {
    let rest: f64 = solved.residuals.iter().flatten().map(|x| x * x).sum();
    let shapes = lines(&left(all, solved)).into_iter().map(|per_unit| {
        let shape = Shape::Cogging { per_unit };
        (tried(all, solved.terms, shape), shape)
    });
    let (least, shape) = shapes.min_by(|a, b| a.0.total_cmp(&b.0))?;
    let is_periodic = rest - least > RATHER_THAN_TIME * explained_in_time(all, solved);
    is_periodic.then_some(shape)
}

/// The play that explains most: what brakes a load of the whole mass brakes it within the
/// play, or acts on the motor alone, and the load goes on as fast as it was.
fn backlash(all: &[Equations], solved: &Solved, range: f64) -> Option<Shape> {
    let mass = *solved.theta.first()?;
    let friction = solved.terms.friction_in(&solved.theta)?;
    if mass <= 0.0 {
        return None;
    }
    let braked = friction.map(|friction| (friction / mass).max(0.0));
    let plays = PLAYS.map(|share| share * range);
    let each = [braked, [0.0; 2]].into_iter().filter_map(|by| {
        let [viscous, coulomb] = by;
        let shape = sized(all, solved.terms, plays, |width| {
            Shape::Backlash(Play {
                width,
                coulomb,
                viscous,
            })
        })?;
        Some((tried(all, solved.terms, shape), shape))
    });
    let best = each.min_by(|a, b| a.0.total_cmp(&b.0));
    best.map(|(_, shape)| shape)
}

/// The solution with the effects that the recordings show; they are part of the equations
/// afterwards.
pub fn find(base: &[Equations], asked: Option<Friction>, solved: &Solved) -> Option<Settled> {
    let has_speed = |equations: &Equations| equations.inside.speeds.is_some();
    if !base.iter().all(has_speed) {
        return None;
    }
    let range = largest(base, range);
    // What is above the band is of no use for a search.
    let mut light = base.to_vec();
    for equations in &mut light {
        equations.above = None;
    }
    let mut found: Option<Settled> = None;
    for _ in 0..EFFECTS {
        let (all, solved) = match &found {
            Some(found) => (&found.all[..], &found.solved),
            None => (&light[..], solved),
        };
        if left_share(all, solved) <= LEFT {
            break;
        }
        let shapes = found.as_ref().map_or(&[][..], |found| &found.shapes);
        let Some(next) = next(&light, asked, (all, solved), shapes, range) else {
            break;
        };
        found = Some(next);
    }
    let mut found = found?;
    found.all = with(base, &found.shapes)?;
    // Directions that are left out stay so.
    for (equations, light) in found.all.iter_mut().zip(&light) {
        equations.counts.clone_from(&light.counts);
    }
    Some(found)
}

/// The share of the force that a solution leaves.
pub fn left_share(all: &[Equations], solved: &Solved) -> f64 {
    let sums = all
        .iter()
        .map(|it| left_of(it, solved.terms, &solved.theta));
    let [rest, total] = sums.fold([0.0; 2], |[a, b], [c, d]| [a + c, b + d]);
    (rest / total).sqrt()
}

/// The effect that predicts best, next to those that there are.
fn next(
    base: &[Equations],
    asked: Option<Friction>,
    (all, solved): (&[Equations], &Solved),
    shapes: &[Shape],
    range: f64,
) -> Option<Settled> {
    let terms = solved.terms;
    let fastest = largest(all, fastest);
    let [slowest, most] = SPEEDS.map(|share| share * fastest);
    let speeds = [slowest.max(largest(all, passed_in_band)).min(most), most];
    let has = |kind: fn(&Shape) -> bool| shapes.iter().any(kind);
    let play = || backlash(all, solved, range);
    let falling = || sized(all, terms, speeds, |speed| Shape::Stribeck { speed });
    let candidates = [
        cogging(all, solved),
        (!has(|shape| matches!(shape, Shape::Backlash(_))))
            .then(play)
            .flatten(),
        (!has(|shape| matches!(shape, Shape::Stribeck { .. })))
            .then(falling)
            .flatten(),
    ];
    let now = predicted(all, terms, STRETCHES)?;
    let tried = candidates.into_iter().flatten().filter_map(|shape| {
        let shapes = [shapes, &[shape]].concat();
        let next = settled(base, asked, shapes, range)?;
        let error = predicted(&next.all, next.solved.terms, STRETCHES)?;
        (error < (1.0 - BETTER) * now && is_plain(&next)).then_some((error, next))
    });
    let best = tried.min_by(|a, b| a.0.total_cmp(&b.0));
    best.map(|(_, next)| next)
}

/// Whether all effects have the signs that they must have, for sure.
fn is_plain(settled: &Settled) -> bool {
    let is_sure = |figure: &Figure| figure.value > certainty::EFFECT * figure.std;
    let solved = &settled.solved;
    let mass = solved.theta.first().copied().unwrap_or_default();
    let coulomb = solved.terms.friction_in(&solved.theta);
    let [least, most] = LOAD.map(|share| share * mass);
    described(settled).iter().all(|effect| {
        let is_one = match effect {
            Effect::Cogging { amplitude, .. } => is_sure(amplitude),
            Effect::Backlash { mass: load, .. } => {
                is_sure(load) && (least..most).contains(&load.value)
            }
            // Where the speed hardly changes one stands for the other.
            Effect::Stribeck { rise, .. } => {
                let slides = |[_, coulomb]: [f64; 2]| coulomb > SLIDING * rise.value;
                is_sure(rise) && coulomb.is_none_or(slides)
            }
        };
        is_one && (SHARE..1.0).contains(&effect.share())
    })
}

/// Effects with their figures.
pub fn described(settled: &Settled) -> Vec<Effect> {
    let recordings = settled.all.len();
    let mut at = settled.solved.terms.width();
    let sizes = settled.shapes.iter().zip(&settled.size_stds);
    sizes
        .map(|(shape, std)| {
            let effect = effect(settled, *shape, *std, at);
            at += unknowns(*shape, recordings);
            effect
        })
        .collect()
}

fn effect(settled: &Settled, shape: Shape, size_std: f64, at: usize) -> Effect {
    let Settled { all, solved, .. } = settled;
    let single = |index: usize| Figure {
        value: solved.theta.get(at + index).copied().unwrap_or_default(),
        std: solved.covariance[(at + index, at + index)].max(0.0).sqrt(),
    };
    let with_std = |value: f64| Figure {
        value,
        std: value * size_std,
    };
    let count = unknowns(shape, all.len());
    let share = share(all, solved, at, count);
    match shape {
        Shape::Cogging { per_unit } => {
            let n = (count / 2).max(1) as f64;
            let (mut squares, mut variance) = (0.0, 0.0);
            for factor in (0..count).map(single) {
                squares += factor.value * factor.value / n;
                // Sine and cosine are about as sure as each other.
                variance += 0.5 * factor.std * factor.std / (n * n);
            }
            Effect::Cogging {
                period: with_std(1.0 / per_unit),
                amplitude: Figure {
                    value: squares.sqrt(),
                    std: variance.sqrt(),
                },
                share,
            }
        }
        Shape::Backlash(play) => Effect::Backlash {
            width: Figure {
                value: play.width,
                std: libm::hypot(play.width * size_std, blurred(all, play)),
            },
            mass: single(0),
            share,
        },
        Shape::Stribeck { speed } => Effect::Stribeck {
            rise: single(0),
            speed: with_std(speed),
            share,
        },
    }
}

/// How far a width is in doubt besides, m (rad): by the distance of the sizes that are tried,
/// and by how far the motor goes on while it pushes the load to its speed. How long that takes
/// does not show in the band.
fn blurred(all: &[Equations], play: Play) -> f64 {
    let [from, to] = PLAYS;
    let halved = f64::from(1_u32 << HALVINGS);
    let ratio = libm::log(to / from) / ((SIZES - 1) as f64 * halved);
    let while_pushed = largest(all, |equations| {
        let speed = play.catching_speed(&equations.raw).unwrap_or_default();
        speed / (TAU * equations.bandwidth_hz)
    });
    libm::hypot(play.width * ratio / 12.0_f64.sqrt(), while_pushed)
}

/// Norm of the force of some columns by norm of the force.
pub fn share(all: &[Equations], solved: &Solved, at: usize, count: usize) -> f64 {
    let (mut own, mut total) = (0.0, 0.0);
    for equations in all {
        counted_rows(equations, solved.terms, |row, force| {
            let pairs = row.iter().zip(&solved.theta).skip(at).take(count);
            let part: f64 = pairs.map(|(x, t)| x * t).sum();
            own += part * part;
            total += force * force;
        });
    }
    (own / total).sqrt()
}

/// Adds known effects to the equations of another recording; the phases of what is periodic
/// in position are taken from it, as its positions may count from elsewhere. Gives all
/// factors, and `None` where speed or position is missing.
pub fn add_known(
    equations: &mut Equations,
    terms: Terms,
    theta: &[f64],
    (shapes, recordings): (&[Shape], usize),
) -> Option<Vec<f64>> {
    let mut known = theta.get(..terms.width())?.to_vec();
    let mut at = terms.width();
    for shape in shapes {
        if !shape.is_apart() {
            known.extend(theta.get(at..at + shape.width())?);
            add(equations, *shape)?;
        }
        at += unknowns(*shape, recordings);
    }
    for shape in shapes.iter().filter(|shape| shape.is_apart()) {
        add(equations, *shape)?;
    }
    known.extend(refit(equations, terms, &known)?);
    Some(known)
}

/// Adds the columns of a shape.
fn add(equations: &mut Equations, shape: Shape) -> Option<()> {
    for unknown in 0..shape.width() {
        let column = shape.column(&equations.raw, unknown)?;
        equations.add(&column);
    }
    Some(())
}
