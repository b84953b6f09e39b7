//! Poles from subspaces of the data (PO-MOESP, Verhaegen 1994), zeros by least
//! squares for these poles.
//!
//! Rows of future outputs, freed of what future inputs explain and related to
//! the past by an LQ factorisation, span the observability of the system; its
//! shift gives the poles.

use nalgebra::{Complex, DMatrix};

use super::discrete::{Discrete, backward_coefficients};
use super::normal::Normal;
use super::polynomial::product;

/// Rows of past and of future.
const BLOCK: usize = 20;
/// Samples on which the factorisation is made, at most.
const COLUMNS_MAX: usize = 6000;

/// The observability of the data, for models of any order.
#[derive(Debug, Clone)]
pub struct Subspace {
    /// Left singular vectors, the strongest first.
    basis: DMatrix<f64>,
}

impl Subspace {
    /// Factorises the data. `None` when there are too few.
    #[must_use]
    pub fn new(input: &[f64], output: &[f64]) -> Option<Self> {
        let n = input.len().min(output.len()).min(COLUMNS_MAX);
        let columns = n.checked_sub(2 * BLOCK)?;
        if columns < 8 * BLOCK {
            return None;
        }
        let mean = |x: &[f64]| x.iter().take(n).sum::<f64>() / n as f64;
        let (u0, y0) = (mean(input), mean(output));
        let u = |k: usize| input.get(k).map_or(0.0, |x| x - u0);
        let y = |k: usize| output.get(k).map_or(0.0, |x| x - y0);
        // Transposed: rows are samples, columns future inputs, the past, and
        // future outputs; R of its QR is L transposed.
        let data = DMatrix::from_fn(columns, 4 * BLOCK, |k, j| match j / BLOCK {
            0 => u(k + BLOCK + j),
            1 => u(k + j - BLOCK),
            _ => y(k + j - 2 * BLOCK),
        });
        let r = data.qr().r();
        let l32 = r.view((BLOCK, 3 * BLOCK), (2 * BLOCK, BLOCK)).transpose();
        let svd = l32.try_svd(true, false, f64::EPSILON, 1000)?;
        Some(Self { basis: svd.u? })
    }

    /// The poles of a model of this order.
    #[must_use]
    pub fn poles(&self, order: usize) -> Option<Vec<Complex<f64>>> {
        if order == 0 || order + 1 > BLOCK {
            return None;
        }
        let up = self.basis.view((0, 0), (BLOCK - 1, order)).into_owned();
        let down = self.basis.view((1, 0), (BLOCK - 1, order)).into_owned();
        let a = up.svd(true, true).solve(&down, 1e-12).ok()?;
        let schur = nalgebra::Schur::try_new(a, f64::EPSILON, 10_000)?;
        let poles: Vec<_> = schur.complex_eigenvalues().iter().copied().collect();
        poles
            .iter()
            .all(|p| p.re.is_finite() && p.im.is_finite())
            .then_some(poles)
    }
}

/// The model with these poles that fits best: as many zeros as poles, and a free
/// swing from the first sample.
#[must_use]
pub fn with_poles(poles: Vec<Complex<f64>>, input: &[f64], output: &[f64]) -> Option<Discrete> {
    let tamed = Discrete {
        gain: 1.0,
        zeros: Vec::new(),
        poles,
    }
    .tamed();
    let a = backward_coefficients(&tamed.poles);
    let n = a.len() - 1;
    let mut normal = Normal::new(2 * n + 2);
    let mut filtered = vec![0.0; n + 1];
    let mut free = vec![0.0; n + 1];
    let mut row = vec![0.0; 2 * n + 2];
    for (k, (u, y)) in input.iter().zip(output).enumerate() {
        // u/A and 1/A, the newest first.
        for (state, drive) in [
            (&mut filtered, *u),
            (&mut free, if k == 0 { 1.0 } else { 0.0 }),
        ] {
            let past: f64 = a.iter().skip(1).zip(state.iter()).map(|(a, x)| a * x).sum();
            state.rotate_right(1);
            if let Some(first) = state.first_mut() {
                *first = drive - past;
            }
        }
        let columns = filtered
            .iter()
            .chain(free.iter().take(n))
            .chain(std::iter::once(&1.0));
        for (slot, x) in row.iter_mut().zip(columns) {
            *slot = *x;
        }
        normal.add(&row, *y);
    }
    let solution = normal.solve_from(0, 1e-13)?;
    // In z, ascending: the coefficients in z⁻¹ reversed.
    let numerator: Vec<f64> = solution.x.iter().take(n + 1).rev().copied().collect();
    let denominator: Vec<f64> = product(&a, &[1.0]).into_iter().rev().collect();
    Discrete::from_polynomials(&numerator, &denominator)
}
