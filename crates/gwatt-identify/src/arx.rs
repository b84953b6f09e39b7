//! Plain least squares on past inputs and outputs (ARX).
//!
//! The original's method: right without noise, wrong with it, because the noise
//! of past outputs is taken for signal. High orders serve another end: what the
//! excitation of a closed loop makes of the input.

use super::discrete::Discrete;
use super::normal::Normal;

/// Samples on which a model is fitted, at most.
const ROWS_MAX: usize = 200_000;

/// Coefficients of `A(z⁻¹)·y = B(z⁻¹)·u + c`.
#[derive(Debug, Clone)]
pub struct Arx {
    /// Of A without the leading 1.
    pub a: Vec<f64>,
    /// Of B from no delay on.
    pub b: Vec<f64>,
    /// Bayes' criterion.
    pub criterion: f64,
}

/// Fits a model of an order. `None` when the data do not determine it.
#[must_use]
pub fn fit(input: &[f64], output: &[f64], order: usize) -> Option<Arx> {
    let width = 2 * order + 2;
    let mut normal = Normal::new(width);
    let mut row = Vec::with_capacity(width);
    let n = input.len().min(output.len()).min(ROWS_MAX);
    for k in order..n {
        row.clear();
        let past = output.get(k - order..k)?;
        row.extend(past.iter().rev().map(|y| -y));
        let drive = input.get(k - order..=k)?;
        row.extend(drive.iter().rev());
        row.push(1.0);
        normal.add(&row, *output.get(k)?);
    }
    if normal.rows < 2 * width {
        return None;
    }
    let solution = normal.solve().or_else(|| normal.solve_from(0, 1e-12))?;
    let rows = normal.rows as f64;
    let floor = 1e-14 * normal.total;
    let x = solution.x.as_slice();
    Some(Arx {
        a: x.get(..order)?.to_vec(),
        b: x.get(order..=2 * order)?.to_vec(),
        criterion: rows * libm::log(solution.rest.max(floor).max(f64::MIN_POSITIVE) / rows)
            + width as f64 * libm::log(rows),
    })
}

impl Arx {
    /// As poles and zeros.
    #[must_use]
    pub fn discrete(&self) -> Option<Discrete> {
        // In z, ascending.
        let numerator: Vec<f64> = self.b.iter().rev().copied().collect();
        let mut denominator: Vec<f64> = self.a.iter().rev().copied().collect();
        denominator.push(1.0);
        Discrete::from_polynomials(&numerator, &denominator)
    }

    /// The output that an input alone makes.
    #[must_use]
    pub fn simulate(&self, input: &[f64]) -> Vec<f64> {
        let mut out: Vec<f64> = Vec::with_capacity(input.len());
        for k in 0..input.len() {
            let driven: f64 = self
                .b
                .iter()
                .enumerate()
                .filter_map(|(lag, b)| Some(b * input.get(k.checked_sub(lag)?)?))
                .sum();
            let past: f64 = self
                .a
                .iter()
                .zip(out.iter().rev())
                .map(|(a, y)| a * y)
                .sum();
            out.push(driven - past);
        }
        out
    }
}

/// What the excitation makes of the input of a closed loop: a model of high
/// order from one to the other, simulated. `None` when there is none that is
/// stable.
#[must_use]
pub fn undisturbed(excitation: &[f64], input: &[f64]) -> Option<Vec<f64>> {
    const ORDERS: [usize; 4] = [40, 30, 20, 10];
    let mean = input.iter().sum::<f64>() / input.len().max(1) as f64;
    let size = input.iter().map(|u| (u - mean).abs()).fold(0.0, f64::max);
    ORDERS.into_iter().find_map(|order| {
        let out = fit(excitation, input, order)?.simulate(excitation);
        let is_sane = out.iter().all(|u| u.is_finite() && u.abs() < 20.0 * size);
        is_sane.then_some(out)
    })
}
