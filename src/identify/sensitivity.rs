//! What each parameter of a model does to its output, sample by sample, and the
//! normal equations of that: the work of a fit.
//!
//! Rows are made in stretches, column by column, so that the processor can work
//! on several at once.

use super::data::Data;
use super::normal::Normal;
use super::parallel::{Parallel, Section, TAPS};
use super::parameters::{parameters, probes, with};
use super::state_space::Measured;
use super::transfer::TransferFunction;

/// Rows of a stretch.
const ROWS: usize = 128;
/// A free swing that has died down to this is over.
const OVER: f64 = 1e-13;
/// A section moves with its own pole, of at most two parameters, and the delay.
const MOVES: usize = 3;

type Column = [f64; ROWS];
type States = [f64; 2];

/// A section and how parameters move it.
struct Chain {
    section: Section,
    /// The parameter and by how much it changes the section.
    moves: Vec<(usize, Section)>,
    /// States of the section and of each move.
    states: [States; 1 + MOVES],
}

/// A model with the derivatives of its coefficients.
struct Derivatives {
    base: Parallel,
    chains: Vec<Chain>,
    /// By parameter: derivatives of the weights of each section.
    weights: Vec<Vec<[f64; 2]>>,
    /// By parameter: derivatives of the direct path.
    direct: Vec<[f64; TAPS]>,
}

fn chains(base: &Parallel) -> Vec<Chain> {
    let chain = |section: &Section| Chain {
        section: *section,
        moves: Vec::new(),
        states: [[0.0; 2]; 1 + MOVES],
    };
    base.sections.iter().map(chain).collect()
}

impl Derivatives {
    fn new(data: &Data<'_>, transfer: &TransferFunction, delay_is_free: bool) -> Option<Self> {
        let base = Parallel::new(transfer, data.measured, data.period_s)?;
        let theta = parameters(transfer, delay_is_free);
        let mut out = Self {
            chains: chains(&base),
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
            for (chain, moved) in out.chains.iter_mut().zip(&moved.sections) {
                if *moved != chain.section {
                    let change = moved.slope_from(&chain.section, *probe);
                    chain.moves.push((index, change));
                }
            }
        }
        Some(out)
    }
}

/// A stretch of the input, with the samples before it that still act.
struct Stretch([f64; ROWS + TAPS - 1]);

impl Stretch {
    fn new(input: &[f64], from: usize, lag: usize) -> Self {
        let mut out = [0.0; ROWS + TAPS - 1];
        let before = lag + TAPS - 1;
        let skip = before.saturating_sub(from);
        let first = (from + skip).saturating_sub(before);
        let present = input.get(first..).unwrap_or_default();
        for (slot, u) in out.iter_mut().skip(skip).zip(present) {
            *slot = *u;
        }
        Self(out)
    }

    /// The input `tap` samples earlier.
    fn at(&self, tap: usize) -> &[f64] {
        self.0.get(TAPS - 1 - tap..).unwrap_or_default()
    }
}

fn add_scaled(column: &mut Column, factor: f64, x: &[f64]) {
    if factor != 0.0 {
        for (slot, x) in column.iter_mut().zip(x) {
            *slot += factor * x;
        }
    }
}

/// What the input adds to states.
fn forced(gamma: &[[f64; 2]; TAPS], input: &Stretch) -> [Column; 2] {
    let mut out = [[0.0; ROWS]; 2];
    for (tap, gamma) in gamma.iter().enumerate() {
        for (column, factor) in out.iter_mut().zip(gamma) {
            add_scaled(column, *factor, input.at(tap));
        }
    }
    out
}

/// Runs a section and `N` moves of it over `rows` samples.
fn run<const N: usize>(chain: &mut Chain, input: &Stretch, rows: usize, out: &mut [[Column; 2]]) {
    let mut changes = [[0.0; 4]; N];
    for (slot, (_, change)) in changes.iter_mut().zip(&chain.moves) {
        *slot = change.phi;
    }
    // Columns hold what the input adds, until the states take its place.
    let gammas = std::iter::once(&chain.section.gamma)
        .chain(chain.moves.iter().map(|(_, change)| &change.gamma));
    for (columns, gamma) in out.iter_mut().zip(gammas) {
        *columns = forced(gamma, input);
    }
    let Some((base, moved)) = out.split_first_mut() else {
        return;
    };
    let Some(moved) = moved.first_chunk_mut::<N>() else {
        return;
    };
    let [a, b, c, d] = chain.section.phi;
    let [states, rest @ ..] = &mut chain.states;
    let Some(rest) = rest.first_chunk_mut::<N>() else {
        return;
    };
    let [x, y] = states;
    let [first, second] = base;
    for (k, (first, second)) in first.iter_mut().zip(second).enumerate().take(rows) {
        for ((columns, state), change) in moved.iter_mut().zip(rest.iter_mut()).zip(&changes) {
            let [p, q] = state;
            let [e, f, g, h] = change;
            let [one, two] = columns;
            let (Some(one), Some(two)) = (one.get_mut(k), two.get_mut(k)) else {
                return;
            };
            let next = (
                (a * *p + b * *q) + (e * *x + f * *y) + *one,
                (c * *p + d * *q) + (g * *x + h * *y) + *two,
            );
            (*one, *two) = (*p, *q);
            (*p, *q) = next;
        }
        let next = (a * *x + b * *y + *first, c * *x + d * *y + *second);
        (*first, *second) = (*x, *y);
        (*x, *y) = next;
    }
}

fn run_chain(chain: &mut Chain, input: &Stretch, rows: usize, out: &mut [[Column; 2]]) {
    match chain.moves.len() {
        0 => run::<0>(chain, input, rows, out),
        1 => run::<1>(chain, input, rows, out),
        2 => run::<2>(chain, input, rows, out),
        _ => run::<MOVES>(chain, input, rows, out),
    }
}

fn outputs() -> [[Column; 2]; 1 + MOVES] {
    [[[0.0; ROWS]; 2]; 1 + MOVES]
}

/// A model's output over stretches.
struct Output<'a> {
    base: &'a Parallel,
    chains: Vec<Chain>,
}

impl<'a> Output<'a> {
    fn new(base: &'a Parallel) -> Self {
        Self {
            base,
            chains: chains(base),
        }
    }

    fn next(&mut self, input: &[f64], from: usize, rows: usize) -> Column {
        let stretch = Stretch::new(input, from, self.base.lag);
        let mut sum = [0.0; ROWS];
        for (tap, factor) in self.base.direct.iter().enumerate() {
            add_scaled(&mut sum, *factor, stretch.at(tap));
        }
        let mut out = outputs();
        for (chain, weights) in self.chains.iter_mut().zip(&self.base.weights) {
            run_chain(chain, &stretch, rows, &mut out);
            let [states, ..] = &out;
            for (column, weight) in states.iter().zip(weights) {
                add_scaled(&mut sum, *weight, column);
            }
        }
        sum
    }
}

/// How each state of the sections swings freely from the first row on.
struct Free {
    sections: Vec<([f64; 4], States, usize)>,
}

impl Free {
    fn new(base: &Parallel) -> Self {
        let start = |section: &Section| (section.phi, [1.0, 0.0], section.degree);
        Self {
            sections: base.sections.iter().map(start).collect(),
        }
    }

    /// The next rows, a column for each state; `None` for one that is over.
    fn next(&mut self, rows: usize, mut take: impl FnMut(usize, Option<&Column>)) {
        let mut at = 0;
        for (phi, row, degree) in &mut self.sections {
            let [x, y] = *row;
            if x.abs().max(y.abs()) < OVER {
                (at..at + *degree).for_each(|index| take(index, None));
            } else {
                let mut columns = [[0.0; ROWS]; 2];
                let [first, second] = &mut columns;
                let [a, b, c, d] = *phi;
                for (first, second) in first.iter_mut().zip(second).take(rows) {
                    let [x, y] = *row;
                    (*first, *second) = (x, y);
                    *row = [x * a + y * c, x * b + y * d];
                }
                for (index, column) in (at..at + *degree).zip(&columns) {
                    take(index, Some(column));
                }
            }
            at += *degree;
        }
    }
}

/// Stretches of rows: those up to `first` in one, the others behind.
fn stretches(first: usize, end: usize) -> impl Iterator<Item = (usize, usize)> {
    let mut at = 0;
    std::iter::from_fn(move || {
        let limit = if at < first { first.min(end) } else { end };
        let rows = limit.checked_sub(at).filter(|rows| *rows > 0)?.min(ROWS);
        at += rows;
        Some((at - rows, rows))
    })
}

/// Normal equations of a step from a model: a column for each parameter, one for
/// each state of the first row that counts, and one for an offset. The rows
/// before `first` do not count.
#[must_use]
pub fn gather(
    data: &Data<'_>,
    transfer: &TransferFunction,
    delay_is_free: bool,
    first: usize,
) -> Option<Normal> {
    let Derivatives {
        base,
        mut chains,
        weights,
        direct,
    } = Derivatives::new(data, transfer, delay_is_free)?;
    let count = weights.len();
    let width = count + base.order() + 1;
    let mut normal = Normal::new(width);
    let mut columns = vec![[0.0; ROWS]; width];
    *columns.last_mut()? = [1.0; ROWS];
    let mut is_over = vec![false; width];
    // How the instruments are driven; in an open loop as the output is.
    let driven = data.undisturbed.unwrap_or(data.input);
    let mut output = Output::new(&base);
    let mut free = Free::new(&base);
    let mut out = outputs();
    for (from, rows) in stretches(first, data.len()) {
        let stretch = Stretch::new(driven, from, base.lag);
        let mut simulated = [0.0; ROWS];
        for (tap, factor) in base.direct.iter().enumerate() {
            add_scaled(&mut simulated, *factor, stretch.at(tap));
        }
        for (column, direct) in columns.iter_mut().zip(&direct) {
            *column = [0.0; ROWS];
            for (tap, factor) in direct.iter().enumerate() {
                add_scaled(column, *factor, stretch.at(tap));
            }
        }
        for (index, chain) in chains.iter_mut().enumerate() {
            run_chain(chain, &stretch, rows, &mut out);
            let [states, moved @ ..] = &out;
            let weight = base.weights.get(index)?;
            for (state, weight) in states.iter().zip(weight) {
                add_scaled(&mut simulated, *weight, state);
            }
            for (column, slopes) in columns.iter_mut().zip(&weights) {
                for (state, slope) in states.iter().zip(slopes.get(index)?) {
                    add_scaled(column, *slope, state);
                }
            }
            for ((parameter, _), states) in chain.moves.iter().zip(moved) {
                let column = columns.get_mut(*parameter)?;
                for (state, weight) in states.iter().zip(weight) {
                    add_scaled(column, *weight, state);
                }
            }
        }
        if data.undisturbed.is_some() {
            simulated = output.next(data.input, from, rows);
        }
        if from < first {
            continue;
        }
        free.next(rows, |index, column| {
            let at = count + index;
            match (column, columns.get_mut(at), is_over.get_mut(at)) {
                (Some(column), Some(slot), _) => *slot = *column,
                (None, _, Some(over)) => *over = true,
                _ => {}
            }
        });
        let mut gaps = [0.0; ROWS];
        let measured = data.output.get(from..from + rows)?;
        for ((gap, y), simulated) in gaps.iter_mut().zip(measured).zip(&simulated) {
            *gap = y - simulated;
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

/// Differences between measured and simulated output, the swing of these first
/// states and an offset taken off; 0 before the row `first`.
#[must_use]
pub fn differences(
    data: &Data<'_>,
    transfer: &TransferFunction,
    first: usize,
    state: &[f64],
    offset: f64,
) -> Option<Vec<f64>> {
    let base = Parallel::new(transfer, data.measured, data.period_s)?;
    let mut output = Output::new(&base);
    let mut free = Free::new(&base);
    let mut out = vec![0.0; data.len()];
    for (from, rows) in stretches(first, data.len()) {
        let mut simulated = output.next(data.input, from, rows);
        if from < first {
            continue;
        }
        free.next(rows, |index, column| {
            if let (Some(column), Some(state)) = (column, state.get(index)) {
                add_scaled(&mut simulated, *state, column);
            }
        });
        let measured = data.output.get(from..from + rows)?.iter();
        let slots = out.get_mut(from..from + rows)?;
        for ((slot, y), simulated) in slots.iter_mut().zip(measured).zip(&simulated) {
            *slot = y - simulated - offset;
        }
    }
    Some(out)
}
