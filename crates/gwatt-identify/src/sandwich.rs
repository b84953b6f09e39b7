//! Covariance of estimates whose residuals are correlated over some samples.

use nalgebra::DMatrix;

/// Covariance by Newey & West 1987, "A simple, positive semi-definite, heteroskedasticity
/// and autocorrelation consistent covariance matrix": `inverse` is that of the normal
/// matrix, `scores` has the rows of each stretch, each times its residual, one after the
/// other.
///
/// Products of rows count by how many windows of so many neighbours have both: squares of the
/// sums over all windows are the same, and a fraction of the work.
pub(super) fn sandwich(scores: &[Vec<f64>], inverse: &DMatrix<f64>) -> DMatrix<f64> {
    let width = inverse.nrows();
    let n = scores.iter().map(Vec::len).sum::<usize>() / width.max(1);
    let length = lags(n) + 1;
    let mut middle = DMatrix::zeros(width, width);
    for stretch in scores {
        let rows = stretch.len() / width.max(1);
        let row = |at: usize| stretch.get(at * width..(at + 1) * width);
        let mut window = vec![0.0; width];
        for next in 0..rows + length - 1 {
            for (sum, x) in window.iter_mut().zip(row(next).unwrap_or_default()) {
                *sum += x;
            }
            let left = next.checked_sub(length).and_then(row);
            for (sum, x) in window.iter_mut().zip(left.unwrap_or_default()) {
                *sum -= x;
            }
            let columns = middle.as_mut_slice().chunks_exact_mut(width);
            for (column, b) in columns.zip(&window) {
                for (slot, a) in column.iter_mut().zip(&window) {
                    *slot += a * b;
                }
            }
        }
    }
    inverse * middle * inverse / length as f64
}

/// Over how many rows residuals of so many are correlated.
fn lags(rows: usize) -> usize {
    (4.0 * libm::pow(rows as f64 / 100.0, 2.0 / 9.0)).max(4.0) as usize
}

/// By how much variances of few rows are to be widened, so that two standard errors hold
/// as often as of many: what the covariance itself does not know, by the share of the rows
/// that are correlated (Kiefer & Vogelsang 2005, "A new asymptotic theory for
/// heteroskedasticity-autocorrelation robust tests", table 1: Bartlett's kernel, 97.5 %).
#[must_use]
pub(super) fn widening(rows: usize) -> f64 {
    let b = ((lags(rows) + 1) as f64 / rows.max(1) as f64).min(1.0);
    let critical = 1.96 + b * (2.9694 + b * (0.4160 - 0.5324 * b));
    (critical / 1.96) * (critical / 1.96)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 40 rows, of which 5 are correlated: 1.96 + 2.9694/8 + 0.416/64 − 0.5324/512 = 2.3366.
    #[test]
    fn few_rows_widen_errors() {
        let critical: f64 = 2.336_635;
        assert!((widening(40) - (critical / 1.96) * (critical / 1.96)).abs() < 1e-6);
        assert!(widening(100_000) < 1.001);
    }

    /// A mean of five values: its variance is the sum of squares of what is left, each
    /// product of neighbours twice by 4/5, of next neighbours by 3/5 and so on, by n².
    #[test]
    fn neighbours_count_by_their_distance() {
        let left = [1.0, 1.0, 0.0, -1.0, -1.0];
        let inverse = DMatrix::from_element(1, 1, 0.2);
        let found = sandwich(&[left.to_vec()], &inverse)[(0, 0)];
        // Products: 4; at distance 1: 1 + 0 + 0 + 1; 2: 0 − 1 + 0; 3: −1 − 1; 4: −1.
        let sum = 4.0 + 2.0 * (0.8 * 2.0 - 0.6 * 1.0 - 0.4 * 2.0 - 0.2 * 1.0);
        assert!((found - sum / 25.0).abs() < 1e-12, "{found}");
        // In two stretches nothing is correlated across the gap.
        let apart = sandwich(&[vec![1.0], vec![1.0]], &DMatrix::from_element(1, 1, 0.5));
        assert!((apart[(0, 0)] - 0.5).abs() < 1e-12, "{apart}");
    }
}
