//! What each parameter of a model does to its output, sample by sample, and the
//! normal equations of that: the work of a fit.
//!
//! Rows are made in stretches, column by column, so that the processor can work
//! on several at once.

use super::data::Data;
use super::leaky_integrator::Fading;
use super::normal::Normal;
use super::parallel::{Parallel, TAPS};
use super::parameters::{parameters, probes, with};
use super::state_space::Measured;
use super::stretch::{Bank, Column, Free, ROWS, Stride, Terms, combine, run_together, stretches};
use super::transfer::TransferFunction;

/// A model with the derivatives of its coefficients.
struct Derivatives {
    base: Parallel,
    /// By section: the parameters that move it, and how.
    moves: Vec<Vec<(usize, Stride)>>,
    /// By parameter: derivatives of the weights of each section.
    weights: Vec<Vec<[f64; 2]>>,
    /// By parameter: derivatives of the direct path.
    direct: Vec<[f64; TAPS]>,
}

impl Derivatives {
    fn new(data: &Data<'_>, transfer: &TransferFunction, delay_is_free: bool) -> Option<Self> {
        let base = Parallel::new(transfer, data.measured, data.period_s)?;
        let theta = parameters(transfer, delay_is_free);
        let mut out = Self {
            moves: vec![Vec::new(); base.sections.len()],
            base,
            weights: Vec::new(),
            direct: Vec::new(),
        };
        for (index, probe) in probes(transfer, delay_is_free, data.period_s)
            .iter()
            .enumerate()
        {
            let mut theta = theta.clone();
            *theta.get_mut(index)? += probe;
            let to = with(transfer, &theta);
            let moved = Parallel::near(&out.base, transfer, &to, data.measured, data.period_s)?;
            let slope = |a: f64, b: f64| (a - b) / probe;
            let pairs = moved.weights.iter().zip(&out.base.weights);
            let weights = pairs.map(|([p, q], [r, s])| [slope(*p, *r), slope(*q, *s)]);
            out.weights.push(weights.collect());
            let mut direct = [0.0; TAPS];
            // The edge of a held input passes a sampling instant or it does not.
            let has_edge = to.delay_s != transfer.delay_s && data.measured == Measured::Direct;
            if !has_edge {
                let pairs = moved.direct.iter().zip(&out.base.direct);
                for (slot, (a, b)) in direct.iter_mut().zip(pairs) {
                    *slot = slope(*a, *b);
                }
            }
            out.direct.push(direct);
            let pairs = moved.sections.iter().zip(&out.base.sections);
            for (moves, (moved, section)) in out.moves.iter_mut().zip(pairs) {
                if moved != section {
                    let (moved, section) = (
                        Stride::of(moved, data.every),
                        Stride::of(section, data.every),
                    );
                    moves.push((index, moved.slope_from(&section, *probe)));
                }
            }
        }
        Some(out)
    }

    /// The sections with their moves.
    fn bank(&self, data: &Data<'_>) -> Bank {
        let moves = self.moves.iter();
        let moves = moves.map(|moves| moves.iter().map(|(_, change)| change.clone()).collect());
        let moves: Vec<Vec<Stride>> = moves.collect();
        Bank::new(&self.base, data.every, &moves)
    }

    /// By parameter: what its column is the sum of.
    fn columns(&self, bank: &Bank) -> Vec<Terms> {
        let each = self.weights.iter().zip(&self.direct);
        each.enumerate()
            .map(|(parameter, (slopes, direct))| {
                let mut terms = bank.direct(direct);
                for (section, slopes) in slopes.iter().enumerate() {
                    terms.extend(bank.weighed(section, *slopes));
                }
                for (section, (moves, weights)) in
                    self.moves.iter().zip(&self.base.weights).enumerate()
                {
                    for (which, (of, _)) in moves.iter().enumerate() {
                        if *of == parameter {
                            terms.extend(bank.moved(section, which + 1, *weights));
                        }
                    }
                }
                terms
            })
            .collect()
    }
}

/// Normal equations of a step from a model: a column for each parameter, one for
/// each state of the first row that counts and of leaky integrators, one for each term
/// of friction, and one for an offset. The rows before `first` do not count. What is `known`
/// of the unknowns after the parameters is taken off: steps go on from there.
#[must_use]
pub fn gather(
    data: &Data<'_>,
    transfer: &TransferFunction,
    delay_is_free: bool,
    first: usize,
    known: &[f64],
) -> Option<Normal> {
    let derivatives = Derivatives::new(data, transfer, delay_is_free)?;
    let base = &derivatives.base;
    let mut bank = derivatives.bank(data);
    let terms = derivatives.columns(&bank);
    let output = bank.output(base);
    let count = terms.len();
    let states = base.order() + data.fading();
    let width = count + states + data.friction.len() + 1;
    let mut normal = Normal::new(width);
    let mut columns = vec![[0.0; ROWS]; width];
    *columns.last_mut()? = [1.0; ROWS];
    let mut is_over = vec![false; width];
    // How the instruments are driven; in an open loop as the output is.
    let driven = data.undisturbed.unwrap_or(data.input);
    let mut open = data.undisturbed.map(|_| Bank::new(base, data.every, &[]));
    let mut free = Free::new(base, data.every);
    let mut fading = Fading::new(data);
    let mut rubbed = Rubbed::new(data, base, data.every);
    let first = first.div_ceil(data.every);
    for (from, rows) in stretches(first, data.rows()) {
        bank.run(driven, from, rows);
        if let Some(open) = &mut open {
            open.run(data.input, from, rows);
        }
        rubbed.run(from, rows);
        if from < first {
            continue;
        }
        for (column, terms) in columns.iter_mut().zip(&terms) {
            combine(column, terms, bank.signals());
        }
        let mut simulated = [0.0; ROWS];
        match &open {
            Some(open) => combine(&mut simulated, &open.output(base), open.signals()),
            None => combine(&mut simulated, &output, bank.signals()),
        }
        let mut fill = |at: usize, column: Option<&Column>| match column {
            Some(column) => columns.get_mut(at).map_or((), |slot| *slot = *column),
            None => is_over.get_mut(at).map_or((), |over| *over = true),
        };
        free.next(rows, |index, column| fill(count + index, column));
        fading.next(rows, |index, column| {
            fill(count + base.order() + index, column);
        });
        for (slot, column) in columns
            .iter_mut()
            .skip(count + states)
            .zip(rubbed.columns())
        {
            *slot = column;
        }
        let mut gaps = [0.0; ROWS];
        let measured = data.output.get(from * data.every..)?;
        let measured = measured.iter().step_by(data.every).take(rows);
        for ((gap, y), simulated) in gaps.iter_mut().zip(measured).zip(&simulated) {
            *gap = y - simulated;
        }
        let taken = columns.iter().zip(&is_over).skip(count).zip(known);
        for ((column, _), known) in taken.filter(|((_, over), _)| !**over) {
            gaps.iter_mut()
                .zip(column)
                .for_each(|(gap, x)| *gap -= known * x);
        }
        let live: Vec<(usize, &[f64])> = columns
            .iter()
            .zip(&is_over)
            .enumerate()
            .filter(|(_, (_, over))| !**over)
            .filter_map(|(index, (column, _))| Some((index, column.get(..rows)?)))
            .collect();
        normal.add_columns(&live, gaps.get(..rows)?);
    }
    normal.total.is_finite().then_some(normal)
}

/// What terms of friction make of the output, for a factor of 1.
struct Rubbed<'a> {
    inputs: &'a [Vec<f64>],
    banks: Vec<Bank>,
    terms: Terms,
}

impl<'a> Rubbed<'a> {
    fn new(data: &Data<'a>, base: &Parallel, every: usize) -> Self {
        let bank = || Bank::new(base, every, &[]);
        Self {
            inputs: data.friction,
            banks: data.friction.iter().map(|_| bank()).collect(),
            terms: bank().output(base),
        }
    }

    /// Goes over the next rows.
    fn run(&mut self, from: usize, rows: usize) {
        run_together(&mut self.banks, self.inputs, from, rows);
    }

    /// A column for each term.
    fn columns(&self) -> impl Iterator<Item = Column> + '_ {
        self.banks.iter().map(|bank| {
            let mut column = [0.0; ROWS];
            combine(&mut column, &self.terms, bank.signals());
            column.map(|x| -x)
        })
    }
}

/// Differences between measured and simulated output, the swing of these first
/// states, friction and an offset taken off; 0 before the row `first`. All samples are rows.
#[must_use]
pub fn differences(
    data: &Data<'_>,
    transfer: &TransferFunction,
    first: usize,
    state: &[f64],
    offset: f64,
) -> Option<Vec<f64>> {
    let base = Parallel::new(transfer, data.measured, data.period_s)?;
    let mut bank = Bank::new(&base, 1, &[]);
    let terms = bank.output(&base);
    let mut free = Free::new(&base, 1);
    let mut fading = Fading::new(data);
    let mut rubbed = Rubbed::new(data, &base, 1);
    let mut out = vec![0.0; data.len()];
    for (from, rows) in stretches(first, data.len()) {
        bank.run(data.input, from, rows);
        rubbed.run(from, rows);
        if from < first {
            continue;
        }
        let mut simulated = [0.0; ROWS];
        combine(&mut simulated, &terms, bank.signals());
        let mut add = |index: usize, column: &Column| {
            if let Some(state) = state.get(index) {
                for (sum, x) in simulated.iter_mut().zip(column) {
                    *sum += state * x;
                }
            }
        };
        free.next(rows, |index, column| {
            if let Some(column) = column {
                add(index, column);
            }
        });
        fading.next(rows, |index, column| {
            if let Some(column) = column {
                add(base.order() + index, column);
            }
        });
        for (index, column) in rubbed.columns().enumerate() {
            add(base.order() + data.fading() + index, &column);
        }
        let measured = data.output.get(from..from + rows)?.iter();
        let slots = out.get_mut(from..from + rows)?;
        for ((slot, y), simulated) in slots.iter_mut().zip(measured).zip(&simulated) {
            *slot = y - simulated - offset;
        }
    }
    Some(out)
}
