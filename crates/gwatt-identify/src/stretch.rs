//! Sections of a model run over stretches of rows, signal by signal, so that a
//! processor can work on several rows at once.
//!
//! Of a recording that shows nothing fast, one of so many samples may count as a
//! row: a section then steps from row to row, driven by all samples between.

use super::parallel::{Parallel, Section, TAPS};

/// Rows of a stretch.
pub const ROWS: usize = 128;
/// Rows that are summed up in registers.
const BLOCK: usize = 8;
/// A free swing that has died down to this is over.
pub const OVER: f64 = 1e-13;
/// A section moves with its own pole, of at most two parameters, and the delay.
const MOVES: usize = 3;

/// A stretch of a signal.
pub type Column = [f64; ROWS];
/// Signals, by their place, with how they count in a sum.
pub type Terms = Vec<(usize, f64)>;
type States = [f64; 2];

/// Sums signals up.
pub fn combine(out: &mut Column, terms: &[(usize, f64)], signals: &[Column]) {
    let (blocks, _) = out.as_chunks_mut::<BLOCK>();
    for (index, block) in blocks.iter_mut().enumerate() {
        let mut sums = [0.0; BLOCK];
        for (signal, factor) in terms {
            let signal = signals.get(*signal).map(|x| x.as_chunks::<BLOCK>().0);
            if let Some(x) = signal.and_then(|blocks| blocks.get(index)) {
                for (sum, x) in sums.iter_mut().zip(x) {
                    *sum += factor * x;
                }
            }
        }
        *block = sums;
    }
}

/// Leaves out what counts nothing.
pub fn counting(terms: impl Iterator<Item = (usize, f64)>) -> Terms {
    terms.filter(|(_, factor)| *factor != 0.0).collect()
}

/// A section that steps from row to row.
#[derive(Debug, Clone)]
pub struct Stride {
    phi: [f64; 4],
    /// What each sample of the input adds to the states, the last one first.
    gamma: Vec<[f64; 2]>,
}

impl Stride {
    /// So many samples in one step: `Φ` as often, and what each sample adds turned by
    /// the steps that follow it.
    #[must_use]
    pub fn of(section: &Section, every: usize) -> Self {
        let [a, b, c, d] = section.phi;
        let mut phi = [1.0, 0.0, 0.0, 1.0];
        let mut gamma = vec![[0.0; 2]; TAPS + every - 1];
        for back in 0..every {
            let [e, f, g, h] = phi;
            for (slot, [p, q]) in gamma.iter_mut().skip(back).zip(section.gamma) {
                let [x, y] = *slot;
                *slot = [x + e * p + f * q, y + g * p + h * q];
            }
            phi = [e * a + f * c, e * b + f * d, g * a + h * c, g * b + h * d];
        }
        Self { phi, gamma }
    }

    /// How fast the coefficients change from another section to this one, which
    /// is `probe` away.
    #[must_use]
    pub fn slope_from(mut self, other: &Self, probe: f64) -> Self {
        for (slot, before) in self.phi.iter_mut().zip(&other.phi) {
            *slot = (*slot - before) / probe;
        }
        let pairs = self.gamma.iter_mut().zip(&other.gamma);
        for (slot, before) in pairs.flat_map(|(slots, before)| slots.iter_mut().zip(before)) {
            *slot = (*slot - before) / probe;
        }
        self
    }

    /// What drives each of the states.
    fn drives(&self) -> [Terms; 2] {
        let of = |pick: fn(&[f64; 2]) -> f64| counting(self.gamma.iter().map(pick).enumerate());
        [of(|[first, _]| *first), of(|[_, second]| *second)]
    }
}

/// A section and how parameters move it.
struct Chain {
    phi: [f64; 4],
    changes: Vec<[f64; 4]>,
    /// Of the section and of each move: what drives the states, and the states.
    drives: Vec<[Terms; 2]>,
    states: [States; 1 + MOVES],
}

impl Chain {
    fn new(section: &Stride, moves: &[Stride]) -> Self {
        let all = std::iter::once(section).chain(moves);
        Self {
            phi: section.phi,
            changes: moves.iter().map(|change| change.phi).collect(),
            drives: all.map(Stride::drives).collect(),
            states: [[0.0; 2]; 1 + MOVES],
        }
    }

    fn run(&mut self, input: &[Column], rows: usize, out: &mut [Column]) {
        let (out, _) = out.as_chunks_mut::<2>();
        // Columns hold what the input adds, until the states take its place.
        for (columns, drives) in out.iter_mut().zip(&self.drives) {
            for (column, drive) in columns.iter_mut().zip(drives) {
                combine(column, drive, input);
            }
        }
        match self.changes.len() {
            0 => self.step::<0>(rows, out),
            1 => self.step::<1>(rows, out),
            2 => self.step::<2>(rows, out),
            _ => self.step::<MOVES>(rows, out),
        }
    }

    /// Steps the section and `N` moves of it.
    fn step<const N: usize>(&mut self, rows: usize, out: &mut [[Column; 2]]) {
        let mut changes = [[0.0; 4]; N];
        for (slot, change) in changes.iter_mut().zip(&self.changes) {
            *slot = *change;
        }
        let Some((base, moved)) = out.split_first_mut() else {
            return;
        };
        let Some(moved) = moved.first_chunk_mut::<N>() else {
            return;
        };
        let [a, b, c, d] = self.phi;
        let [states, rest @ ..] = &mut self.states;
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
}

/// All sections of a model over stretches: signals that any output of it is a sum of.
pub struct Bank {
    chains: Vec<Chain>,
    /// The input by how many samples it is late, then by chains: the two states of
    /// the section, and those of each move.
    signals: Vec<Column>,
    every: usize,
    lag: usize,
}

impl Bank {
    /// Of a model, with moves of each section; a row is one of `every` samples.
    #[must_use]
    pub fn new(model: &Parallel, every: usize, moves: &[Vec<Stride>]) -> Self {
        let chains: Vec<Chain> = model
            .sections
            .iter()
            .zip(
                moves
                    .iter()
                    .map(Vec::as_slice)
                    .chain(std::iter::repeat(&[][..])),
            )
            .map(|(section, moves)| Chain::new(&Stride::of(section, every), moves))
            .collect();
        let states: usize = chains.iter().map(|chain| 2 * chain.drives.len()).sum();
        Self {
            signals: vec![[0.0; ROWS]; TAPS + every - 1 + states],
            chains,
            every,
            lag: model.lag,
        }
    }

    /// The signals of the last stretch.
    #[must_use]
    pub fn signals(&self) -> &[Column] {
        &self.signals
    }

    /// What the input adds at once.
    #[must_use]
    pub fn direct(&self, direct: &[f64; TAPS]) -> Terms {
        let first = self.every - 1;
        counting((first..).zip(direct.iter().copied()))
    }

    /// The states of a section, weighed.
    #[must_use]
    pub fn weighed(&self, section: usize, weights: [f64; 2]) -> Terms {
        self.moved(section, 0, weights)
    }

    /// The states of a section's move, weighed; move 0 is the section itself.
    #[must_use]
    pub fn moved(&self, section: usize, which: usize, weights: [f64; 2]) -> Terms {
        let before = self.chains.iter().take(section);
        let before: usize = before.map(|chain| 2 * chain.drives.len()).sum();
        let first = TAPS + self.every - 1 + before + 2 * which;
        counting((first..).zip(weights))
    }

    /// A model's output.
    #[must_use]
    pub fn output(&self, model: &Parallel) -> Terms {
        let weights = model.weights.iter().enumerate();
        let states = weights.flat_map(|(section, weights)| self.weighed(section, *weights));
        self.direct(&model.direct)
            .into_iter()
            .chain(states)
            .collect()
    }

    /// Takes in the samples that drive the rows from this one on.
    fn take_in(&mut self, input: &[f64], from: usize) {
        let next = (from + 1) * self.every;
        let late = self.signals.iter_mut().take(TAPS + self.every - 1);
        for (tap, column) in late.enumerate() {
            delayed(column, input, next, self.lag + tap + 1, self.every);
        }
    }

    /// Runs over the rows from this one on.
    pub fn run(&mut self, input: &[f64], from: usize, rows: usize) {
        self.take_in(input, from);
        let taps = TAPS + self.every - 1;
        let Some((late, mut out)) = self.signals.split_at_mut_checked(taps) else {
            return;
        };
        for chain in &mut self.chains {
            let Some((own, rest)) = out.split_at_mut_checked(2 * chain.drives.len()) else {
                return;
            };
            chain.run(late, rows, own);
            out = rest;
        }
    }
}

/// Runs banks of one model without moves over the rows from this one on, each by an input of
/// its own. They step together: what one waits for, the others fill.
pub fn run_together(banks: &mut [Bank], inputs: &[Vec<f64>], from: usize, rows: usize) {
    for (bank, input) in banks.iter_mut().zip(inputs) {
        bank.take_in(input, from);
    }
    match banks.len() {
        0 => {}
        2 => step_together::<2>(banks, rows),
        3 => step_together::<3>(banks, rows),
        _ => banks
            .chunks_mut(1)
            .for_each(|one| step_together::<1>(one, rows)),
    }
}

/// Steps all sections of so many banks that have taken in what drives them.
fn step_together<const N: usize>(banks: &mut [Bank], rows: usize) {
    let sections = banks.first().map_or(0, |bank| bank.chains.len());
    for section in 0..sections {
        let mut columns = [[[0.0; ROWS]; 2]; N];
        let mut states = [[0.0; 2]; N];
        let mut phi = [0.0; 4];
        for ((bank, columns), state) in banks.iter().zip(&mut columns).zip(&mut states) {
            if let Some(chain) = bank.chains.get(section)
                && let (Some(drives), [own, ..]) = (chain.drives.first(), chain.states)
            {
                (phi, *state) = (chain.phi, own);
                for (column, drive) in columns.iter_mut().zip(drives) {
                    combine(column, drive, &bank.signals);
                }
            }
        }
        let [a, b, c, d] = phi;
        for k in 0..rows.min(ROWS) {
            for ([first, second], state) in columns.iter_mut().zip(&mut states) {
                let [x, y] = *state;
                *state = [a * x + b * y + first[k], c * x + d * y + second[k]];
                (first[k], second[k]) = (x, y);
            }
        }
        for ((bank, columns), state) in banks.iter_mut().zip(columns).zip(states) {
            let at = TAPS + bank.every - 1 + 2 * section;
            let slots = bank.signals.iter_mut().skip(at);
            slots.zip(columns).for_each(|(slot, column)| *slot = column);
            if let Some(chain) = bank.chains.get_mut(section)
                && let [own, ..] = &mut chain.states
            {
                *own = state;
            }
        }
    }
}

/// The samples that come `late` before `next`, and each `every` after; those before
/// the first one are 0.
fn delayed(column: &mut Column, input: &[f64], next: usize, late: usize, every: usize) {
    let missing = late.saturating_sub(next).div_ceil(every);
    let first = (next + missing * every).saturating_sub(late);
    let (none, rest) = column.split_at_mut(missing.min(ROWS));
    none.fill(0.0);
    let present = input.get(first..).unwrap_or_default();
    if let Some(present) = present.get(..rest.len()).filter(|_| every == 1) {
        rest.copy_from_slice(present);
        return;
    }
    let mut present = present.iter().step_by(every);
    for slot in rest {
        *slot = present.next().copied().unwrap_or_default();
    }
}

/// How each state of the sections swings freely from the first row on.
pub struct Free {
    sections: Vec<([f64; 4], States, usize)>,
}

impl Free {
    /// Of a model whose rows are one of `every` samples.
    #[must_use]
    pub fn new(model: &Parallel, every: usize) -> Self {
        let start = |section: &Section| {
            let stride = Stride::of(section, every);
            (stride.phi, [1.0, 0.0], section.degree)
        };
        Self {
            sections: model.sections.iter().map(start).collect(),
        }
    }

    /// The next rows, a column for each state; `None` for one that is over.
    pub fn next(&mut self, rows: usize, mut take: impl FnMut(usize, Option<&Column>)) {
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

/// Stretches of rows: those up to `first` in one, the others after.
pub fn stretches(first: usize, end: usize) -> impl Iterator<Item = (usize, usize)> {
    let mut at = 0;
    std::iter::from_fn(move || {
        let limit = if at < first { first.min(end) } else { end };
        let rows = limit.checked_sub(at).filter(|rows| *rows > 0)?.min(ROWS);
        at += rows;
        Some((at - rows, rows))
    })
}
