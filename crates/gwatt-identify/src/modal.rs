//! A sum of modes through the lines of a recording.
//!
//! For given poles and a given delay the output is linear in everything else:
//! in the weights of the sections (which the zeros follow from), the direct path,
//! and the states at the ends. So only the poles are searched for, everything else
//! being at its best for them (Golub & Pereyra 1973, "variable projection"): a
//! search for zeros next to them comes to rest in many more wrong places.

use std::cell::OnceCell;

use nalgebra::{Cholesky, Complex, Matrix4, Vector4};

use super::descent::{Damping, Descending, Step, descend};
use super::normal::{Normal, Solution};
use super::parameters::{is_admissible, parameters, probes, with};
use super::places::{numbered, thinned};
use super::polynomial::{product, roots};
use super::spectral_lines::{Lines, add_scaled, at, inverse, on_circle, turned};
use super::transfer::{Factor, TransferFunction, factors};

type C = Complex<f64>;

/// Zeros beyond this many rad per period are artefacts.
const FAR: f64 = 20.0;

/// Lines on which a place for a mode is looked for.
const SPARSE: usize = 400;
/// Modes damped less than this are looked for in the band only.
const QUIET: f64 = 0.1;

const DAMPING: Damping = Damping {
    now: 1e-3,
    least: 1e-9,
    most: 1e5,
};
/// An improvement below this share of one row's squares ends the search: what is found is
/// a start.
const ENOUGH: f64 = 1e-2;

/// A delay: whole periods, and a part of one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Late {
    /// Whole periods.
    pub lag: usize,
    /// Part of a period.
    pub part: f64,
}

/// Poles with all that is linear at its best.
#[derive(Debug, Clone)]
pub struct Modes {
    /// The poles.
    pub poles: Vec<Factor>,
    /// Sum of squares that is left.
    pub rest: f64,
    late: Late,
    taps: usize,
    linear: Vec<f64>,
    columns: Vec<Vec<f64>>,
    left: Vec<f64>,
}

/// Fits of modes to lines.
impl Lines {
    /// Everything linear at its best for these poles, `lag` periods late, with
    /// this many free taps of the input.
    #[must_use]
    pub fn at(&self, poles: &[Factor], late: Late, taps: usize) -> Option<Modes> {
        let mut columns = Vec::new();
        let (lag, hold) = (late.lag, self.hold(late.part));
        for pole in poles {
            let section = hold.section(*pole, self.period_s)?;
            let states = self.states(&section, lag);
            for state in states.iter().take(section.degree) {
                columns.push(self.column(state));
            }
            for start in 0..section.degree {
                let [seen, _] = self.swing(&section, start);
                columns.push(self.column(&seen));
            }
        }
        columns.extend(self.ends());
        if taps == 1 {
            columns.push(self.column(&self.driven(&hold.at_sample(), lag)));
        } else {
            let taps = lag..lag + taps;
            columns.extend(taps.map(|tap| self.column(self.input(tap))));
        }
        let mut normal = Normal::new(columns.len());
        normal.add_columns(&numbered(&columns), self.output());
        let solution = solve(&normal)?;
        let mut left = self.output().to_vec();
        for (column, factor) in columns.iter().zip(solution.x.iter()) {
            for (slot, x) in left.iter_mut().zip(column) {
                *slot -= factor * x;
            }
        }
        Some(Modes {
            poles: poles.to_vec(),
            rest: left.iter().map(|x| x * x).sum(),
            late,
            taps,
            linear: solution.x.iter().copied().collect(),
            columns,
            left,
        })
    }

    /// The same with one pole more, where it is.
    #[must_use]
    pub fn with(&self, modes: &Modes, pole: Factor) -> Option<Modes> {
        let mut poles = modes.poles.clone();
        poles.push(pole);
        self.at(&poles, modes.late, modes.taps)
    }

    /// What each parameter of the poles does to the output, everything linear
    /// staying as it is.
    fn slopes(&self, modes: &Modes) -> Option<Vec<Vec<f64>>> {
        let model = of_poles(&modes.poles);
        let theta = parameters(&model, false);
        let (lag, hold) = (modes.late.lag, self.hold(modes.late.part));
        let probes = probes(&model, false, self.period_s);
        let mut slopes = Vec::new();
        let mut index = 1;
        let mut at_linear = 0;
        for (which, pole) in modes.poles.iter().enumerate() {
            let degree = pole.degree();
            let section = hold.section(*pole, self.period_s)?;
            let states = self.states(&section, lag);
            let swings: Vec<[Vec<C>; 2]> = (0..degree)
                .map(|start| self.swing(&section, start))
                .collect();
            let linear = modes.linear.get(at_linear..at_linear + 2 * degree)?;
            let (weights, starts) = linear.split_at(degree);
            for _ in 0..degree {
                let probe = *probes.get(index)?;
                let mut moved = theta.clone();
                *moved.get_mut(index)? += probe;
                let moved = *with(&model, &moved).poles.get(which)?;
                let moved = hold.section(moved, self.period_s)?;
                let change = moved.slope_from(&section, probe);
                let moves = self.moved(&section, &change, &states, lag);
                let mut sum = vec![C::default(); self.theta().len()];
                for (weight, state) in weights.iter().zip(&moves) {
                    add_scaled(&mut sum, *weight, state);
                }
                for (start, swing) in starts.iter().zip(&swings) {
                    let moves = self.resolve(&section, |k, _| turned(change.phi, swing, k));
                    let [seen, _] = &moves;
                    add_scaled(&mut sum, *start, seen);
                }
                slopes.push(self.column(&sum));
                index += 1;
            }
            at_linear += 2 * degree;
        }
        Some(slopes)
    }

    /// Moves the poles until nothing is gained, for so many steps at most.
    #[must_use]
    pub fn move_poles(&self, modes: Modes, steps: usize) -> Modes {
        let task = PoleTask { lines: self, steps };
        let first = modes.clone();
        descend(&task, PolePlace::of(first), DAMPING).map_or(modes, |(at, _)| at.modes)
    }

    /// Bayes' information criterion.
    #[must_use]
    pub fn criterion_of(&self, modes: &Modes) -> f64 {
        let count = 2 * degree(&modes.poles) + modes.taps;
        let rows = self.rows() as f64;
        let rest = modes.rest.max(1e-14 * self.power).max(f64::MIN_POSITIVE);
        rows * libm::log(rest / rows) + count as f64 * libm::log(self.samples as f64)
    }

    /// The pole that explains most of what is left, of a grid over frequency and
    /// for each of these dampings: one for each.
    #[must_use]
    pub fn missing(&self, modes: &Modes, dampings: &[f64]) -> Vec<Factor> {
        const STEP: f64 = 1.06;
        let (Some(first), Some(last)) = (self.theta().first(), self.theta().last()) else {
            return Vec::new();
        };
        // The hold makes the input late by half a period, each order of a spline by
        // as much.
        let held = 0.5 * (1 + self.measured().integrators()) as f64;
        let late = self
            .theta()
            .iter()
            .map(|theta| on_circle(-(held + modes.late.part) * theta));
        let input = self.driven(&[1.0, 0.0, 0.0, 0.0], modes.late.lag);
        let input: Vec<C> = input.iter().zip(late).map(|(u, late)| u * late).collect();
        let sparse = thinned(self.theta().len(), SPARSE);
        let best = |damping: f64| {
            let mut omega = 2.0 * first;
            let mut best: Option<(f64, f64)> = None;
            // What rings beyond the band is noise as well as not.
            let last = if damping < QUIET { self.edge() } else { *last };
            while omega < 0.95 * last {
                let gain = self.gain(&modes.left, &input, &sparse, omega, damping);
                if gain.is_finite() && best.is_none_or(|(most, _)| gain > most) {
                    best = Some((gain, omega));
                }
                omega *= STEP;
            }
            best.map(|(_, omega)| Factor::Pair {
                omega_rad_s: omega / self.period_s,
                damping,
            })
        };
        dampings
            .iter()
            .filter_map(|damping| best(*damping))
            .collect()
    }

    /// By how much a mode at ω (rad per period) makes the squares that are left
    /// smaller, about.
    fn gain(&self, left: &[f64], input: &[C], sparse: &[usize], omega: f64, damping: f64) -> f64 {
        let (re, im) = left.split_at(self.theta().len());
        let mut products = [[0.0; 4]; 4];
        let mut right = [0.0; 4];
        for k in sparse.iter().copied() {
            let theta = self.theta().get(k).copied().unwrap_or_default();
            let weight = self.weight().get(k).copied().unwrap_or_default();
            let x = theta / omega;
            let q = inverse(C::new(1.0 - x * x, 2.0 * damping * x)) * weight;
            let driven = q * at(input, k);
            let turn = |c: C| C::new(-c.im * x, c.re * x);
            let columns = [driven, turn(driven), q, turn(q)];
            let gap = C::new(
                re.get(k).copied().unwrap_or_default(),
                im.get(k).copied().unwrap_or_default(),
            );
            for (i, (row, slot)) in products.iter_mut().zip(&mut right).enumerate() {
                let a = columns.get(i).copied().unwrap_or_default();
                *slot += (a.conj() * gap).re;
                for (slot, b) in row.iter_mut().zip(&columns).take(i + 1) {
                    *slot += a.re * b.re + a.im * b.im;
                }
            }
        }
        explained(products, right)
    }

    /// As a transfer function: all zeros that the band shows.
    #[must_use]
    pub fn transfer(&self, modes: &Modes) -> Option<TransferFunction> {
        let t = self.period_s;
        let per_period = |pole: &Factor| match *pole {
            Factor::Pair {
                omega_rad_s,
                damping,
            } => Factor::Pair {
                omega_rad_s: omega_rad_s * t,
                damping,
            },
            Factor::Real { time_constant_s } => Factor::Real {
                time_constant_s: time_constant_s / t,
            },
        };
        let poles: Vec<Factor> = modes.poles.iter().map(per_period).collect();
        let without = |index: usize| -> Vec<f64> {
            let others = poles.iter().enumerate().filter(|(i, _)| *i != index);
            others.fold(vec![1.0], |p, (_, pole)| product(&p, &pole.coefficients()))
        };
        let direct = match modes.taps {
            1 => modes.linear.last().copied()?,
            _ => return None,
        };
        let mut numerator = without(usize::MAX);
        for c in &mut numerator {
            *c *= direct;
        }
        let mut at_linear = 0;
        for (index, pole) in poles.iter().enumerate() {
            let a = *modes.linear.get(at_linear)?;
            let own = match pole {
                Factor::Pair { omega_rad_s, .. } => {
                    vec![a, modes.linear.get(at_linear + 1)? / omega_rad_s]
                }
                Factor::Real { .. } => vec![a],
            };
            for (slot, c) in numerator.iter_mut().zip(product(&without(index), &own)) {
                *slot += c;
            }
            at_linear += 2 * pole.degree();
        }
        let gain = *numerator.first()?;
        let zeros: Vec<C> = roots(&numerator)?
            .iter()
            .filter(|root| root.norm() < FAR)
            .map(|root| root / t)
            .collect();
        Some(TransferFunction {
            gain,
            zeros: factors(&zeros, false),
            poles: modes.poles.clone(),
            delay_s: (modes.late.lag as f64 + modes.late.part) * t,
        })
        .filter(|model| model.gain.is_finite() && model.gain != 0.0)
    }
}

/// Poles on their way down.
struct PoleTask<'a> {
    lines: &'a Lines,
    steps: usize,
}

/// Modes, and how the output changes with their poles once a step has needed it.
struct PolePlace {
    modes: Modes,
    slopes: OnceCell<Option<Vec<Vec<f64>>>>,
}

impl PolePlace {
    fn of(modes: Modes) -> Self {
        Self {
            modes,
            slopes: OnceCell::new(),
        }
    }
}

impl Descending for PoleTask<'_> {
    type Place = PolePlace;

    fn squares(&self, at: &PolePlace) -> f64 {
        at.modes.rest
    }

    fn goes_on(&self, round: usize, _: &PolePlace) -> bool {
        round < self.steps
    }

    fn step(&self, _: usize, at: &PolePlace, damping: f64) -> Step<PolePlace> {
        let (lines, modes) = (self.lines, &at.modes);
        let slopes = at.slopes.get_or_init(|| lines.slopes(modes)).as_ref();
        let Some(slopes) = slopes.filter(|slopes| !slopes.is_empty()) else {
            return Step::GivenUp;
        };
        let count = slopes.len();
        let mut normal = Normal::new(count + modes.columns.len());
        let all = slopes.iter().chain(&modes.columns).map(Vec::as_slice);
        let all: Vec<(usize, &[f64])> = all.enumerate().collect();
        normal.add_columns(&all, &modes.left);
        let model = of_poles(&modes.poles);
        let next = normal.solve_from(0, damping).and_then(|step| {
            let mut theta = parameters(&model, false);
            for (value, step) in theta.iter_mut().skip(1).zip(step.x.iter().take(count)) {
                *value += step;
            }
            let next = with(&model, &theta);
            is_admissible(&next, lines.period_s).then_some(next)
        });
        next.and_then(|next| lines.at(&next.poles, modes.late, modes.taps))
            .map_or(Step::Nowhere, |next| Step::To(PolePlace::of(next)))
    }

    fn is_enough(&self, _: usize, before: &PolePlace, after: &PolePlace) -> bool {
        let (before, after) = (before.modes.rest, after.modes.rest);
        before - after < ENOUGH * after / self.lines.rows() as f64
            || after < 1e-14 * self.lines.power
    }
}

fn solve(normal: &Normal) -> Option<Solution> {
    [1e-13, 1e-11, 1e-9, 1e-7]
        .into_iter()
        .find_map(|damping| normal.solve_from(0, damping))
}

fn of_poles(poles: &[Factor]) -> TransferFunction {
    TransferFunction {
        poles: poles.to_vec(),
        ..TransferFunction::constant(1.0)
    }
}

fn degree(poles: &[Factor]) -> usize {
    poles.iter().map(|pole| pole.degree()).sum()
}

/// `rᵀ·P⁻¹·r`, the lower triangle of P being given.
fn explained(products: [[f64; 4]; 4], right: [f64; 4]) -> f64 {
    let p = Matrix4::from_fn(|i, j| {
        let row = products.get(i.max(j));
        row.and_then(|row| row.get(i.min(j)))
            .copied()
            .unwrap_or_default()
    });
    let r = Vector4::from(right);
    // Columns that are correlated say nothing more than one of them.
    let steep = p + Matrix4::from_diagonal(&(p.diagonal() * 1e-12));
    Cholesky::new(steep).map_or(f64::NAN, |cholesky| r.dot(&cholesky.solve(&r)))
}
