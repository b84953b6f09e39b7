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

/// The sum of products, in four parts that a processor can work on at once.
fn dot(x: &[f64], y: &[f64]) -> f64 {
    let ((xs, x_rest), (ys, y_rest)) = (x.as_chunks(), y.as_chunks());
    let mut sums = [0.0; 4];
    for ([a, b, c, d], [e, f, g, h]) in xs.iter().zip(ys) {
        let [i, j, k, l] = sums;
        sums = [i + a * e, j + b * f, k + c * g, l + d * h];
    }
    let rest: f64 = x_rest.iter().zip(y_rest).map(|(x, y)| x * y).sum();
    let [a, b, c, d] = sums;
    (a + b) + (c + d) + rest
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
        for (i, x) in columns {
            let row = self.products.get_mut(i * (i + 1) / 2..).unwrap_or_default();
            for (j, y) in columns.iter().take_while(|(j, _)| j <= i) {
                if let Some(slot) = row.get_mut(*j) {
                    *slot += dot(x, y);
                }
            }
            if let Some(slot) = self.right.get_mut(*i) {
                *slot += dot(x, right);
            }
        }
        self.total += dot(right, right);
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
