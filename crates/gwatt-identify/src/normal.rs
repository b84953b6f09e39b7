//! Normal equations of least squares, gathered row by row.

use nalgebra::{Cholesky, DMatrix, DVector};

/// Sums of products of the columns with one another and with the right side.
#[derive(Debug, Clone)]
pub struct Normal {
    size: usize,
    /// Lower triangle by rows: column i with columns 0 to i.
    products: Vec<f64>,
    right: Vec<f64>,
    /// Sum of squares of the right side.
    pub total: f64,
    /// Number of rows.
    pub rows: usize,
}

/// A solution with its inverse matrix.
#[derive(Debug, Clone)]
pub struct Solution {
    /// The unknowns.
    pub x: DVector<f64>,
    /// Inverse of the normal matrix: times the variance of the residuals, the
    /// covariance of the unknowns.
    pub inverse: DMatrix<f64>,
    /// Sum of squares of what is left.
    pub rest: f64,
}

/// Values that are multiplied and added at a time.
const LANES: usize = 4;
type Lanes = [f64; LANES];

fn add(sums: Lanes, x: &Lanes, y: &Lanes) -> Lanes {
    let ([i, j, k, l], [a, b, c, d], [e, f, g, h]) = (sums, x, y);
    [i + a * e, j + b * f, k + c * g, l + d * h]
}

/// Sums of what lanes hold. Not in line: a compiler that sees it joins lanes of
/// different sums, and shuffles them for each row.
#[inline(never)]
fn totals(sums: &[Lanes; 4]) -> [f64; 4] {
    sums.map(|[a, b, c, d]| (a + b) + (c + d))
}

/// The sums of products of each of two columns with each of two others, all of one
/// length. Each value is loaded once for two products, and so many sums run next to
/// one another that none waits for itself.
fn products(x: [&[f64]; 2], y: [&[f64]; 2]) -> [[f64; 2]; 2] {
    let [(a, a_rest), (b, b_rest)] = x.map(<[f64]>::as_chunks);
    let [(c, c_rest), (d, d_rest)] = y.map(<[f64]>::as_chunks);
    let [mut e, mut f, mut g, mut h] = [[0.0; LANES]; 4];
    for (((a, b), c), d) in a.iter().zip(b).zip(c).zip(d) {
        (e, f) = (add(e, a, c), add(f, a, d));
        (g, h) = (add(g, b, c), add(h, b, d));
    }
    let rest = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>();
    let [e, f, g, h] = totals(&[e, f, g, h]);
    [
        [e + rest(a_rest, c_rest), f + rest(a_rest, d_rest)],
        [g + rest(b_rest, c_rest), h + rest(b_rest, d_rest)],
    ]
}

/// The columns of a pair; of a single one twice the same.
fn pair<'a>(columns: &[(usize, &'a [f64])]) -> [&'a [f64]; 2] {
    let ends = [columns.first(), columns.last()];
    ends.map(|column| column.map_or(&[][..], |(_, x)| *x))
}

impl Normal {
    /// For this many unknowns.
    #[must_use]
    pub fn new(size: usize) -> Self {
        Self {
            size,
            products: vec![0.0; size * (size + 1) / 2],
            right: vec![0.0; size],
            total: 0.0,
            rows: 0,
        }
    }

    /// Adds a row.
    pub fn add(&mut self, row: &[f64], right: f64) {
        let mut at = self.products.iter_mut();
        for (i, x) in row.iter().enumerate() {
            for (y, slot) in row.iter().take(i + 1).zip(&mut at) {
                *slot += x * y;
            }
        }
        for (slot, x) in self.right.iter_mut().zip(row) {
            *slot += x * right;
        }
        self.total += right * right;
        self.rows += 1;
    }

    /// Adds rows by columns: those that are not zero, ascending by their place,
    /// and the right side, all of one length.
    pub fn add_columns(&mut self, columns: &[(usize, &[f64])], right: &[f64]) {
        // By pairs; of a single column at the end the second half is not taken.
        let twos = || columns.chunks(2);
        for (index, rows) in twos().enumerate() {
            let x = pair(rows);
            for others in twos().take(index + 1) {
                let sums = products(x, pair(others));
                for ((i, _), sums) in rows.iter().zip(sums) {
                    let slots = self.products.get_mut(i * (i + 1) / 2..).unwrap_or_default();
                    for ((j, _), sum) in others.iter().zip(sums).filter(|((j, _), _)| j <= i) {
                        if let Some(slot) = slots.get_mut(*j) {
                            *slot += sum;
                        }
                    }
                }
            }
            let [first, second] = products(x, [right; 2]);
            for ((i, _), [sum, _]) in rows.iter().zip([first, second]) {
                if let Some(slot) = self.right.get_mut(*i) {
                    *slot += sum;
                }
            }
        }
        let [[total, _], _] = products([right; 2], [right; 2]);
        self.total += total;
        self.rows += right.len();
    }

    /// Solves for all unknowns.
    #[must_use]
    pub fn solve(&self) -> Option<Solution> {
        self.solve_from(0, 0.0)
    }

    /// Solves for the unknowns from `first` on, those before being zero, with
    /// `damping` added to each diagonal element, relative to it. `None` when the
    /// columns depend on one another.
    #[must_use]
    pub fn solve_from(&self, first: usize, damping: f64) -> Option<Solution> {
        let n = self.size.checked_sub(first)?;
        let mut matrix = DMatrix::zeros(n, n);
        let mut at = self.products.iter();
        for i in 0..self.size {
            for (j, product) in (0..=i).zip(&mut at) {
                if i >= first && j >= first {
                    matrix[(i - first, j - first)] = *product;
                    matrix[(j - first, i - first)] = *product;
                }
            }
        }
        // Units differ by powers of ten: make the diagonal 1.
        let scale: Vec<f64> = matrix.diagonal().iter().map(|d| 1.0 / d.sqrt()).collect();
        if scale.iter().any(|s| !s.is_finite()) {
            return None;
        }
        for i in 0..n {
            for j in 0..n {
                matrix[(i, j)] *= scale.get(i)? * scale.get(j)?;
            }
            matrix[(i, i)] += damping;
        }
        let right = DVector::from_iterator(
            n,
            self.right
                .iter()
                .skip(first)
                .zip(&scale)
                .map(|(r, s)| r * s),
        );
        let cholesky = Cholesky::new(matrix)?;
        let mut x = cholesky.solve(&right);
        let explained = x.dot(&right);
        let mut inverse = cholesky.inverse();
        // Digits that are left of the inverse: none beyond this.
        if inverse.diagonal().iter().any(|d| d.is_nan() || *d >= 1e13) {
            return None;
        }
        for i in 0..n {
            x[i] *= scale.get(i)?;
            for j in 0..n {
                inverse[(i, j)] *= scale.get(i)? * scale.get(j)?;
            }
        }
        Some(Solution {
            x,
            inverse,
            rest: (self.total - explained).max(0.0),
        })
    }
}
