//! Polynomials with real coefficients in ascending order, and their roots.

use nalgebra::{Complex, DMatrix, Schur};

/// How often the roots are iterated before they count as not found.
const ITERATIONS: usize = 10_000;

/// The product of two polynomials.
#[must_use]
pub fn product(p: &[f64], q: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0; (p.len() + q.len()).saturating_sub(1)];
    for (i, a) in p.iter().enumerate() {
        for (slot, b) in out.iter_mut().skip(i).zip(q) {
            *slot += a * b;
        }
    }
    out
}

/// The value at a complex point.
#[must_use]
pub fn value(p: &[f64], x: Complex<f64>) -> Complex<f64> {
    p.iter()
        .rev()
        .fold(Complex::new(0.0, 0.0), |sum, c| sum * x + c)
}

/// All roots: eigenvalues of the companion matrix, each made better by two
/// steps of Newton's method. `None` if they do not converge or a coefficient
/// is not finite. Leading coefficients of zero count as absent.
#[must_use]
pub fn roots(p: &[f64]) -> Option<Vec<Complex<f64>>> {
    if p.iter().any(|c| !c.is_finite()) {
        return None;
    }
    let degree = p.iter().rposition(|c| *c != 0.0).unwrap_or(0);
    let at_origin = p.iter().take_while(|c| **c == 0.0).count().min(degree);
    let (p, n) = (p.get(at_origin..=degree)?, degree - at_origin);
    let mut found = vec![Complex::new(0.0, 0.0); at_origin];
    if n == 0 {
        return Some(found);
    }
    let (first, last) = (*p.first()?, *p.last()?);
    // Unit of the unknown: the geometric mean of the roots' sizes.
    let unit = libm::pow((first / last).abs(), 1.0 / n as f64);
    if !(unit.is_finite() && unit > 0.0) {
        return None;
    }
    let mut power = last;
    let mut companion = DMatrix::<f64>::zeros(n, n);
    for (row, coefficient) in p.iter().take(n).enumerate().rev() {
        power *= unit;
        companion[(row, n - 1)] = -coefficient / power;
        if row > 0 {
            companion[(row, row - 1)] = 1.0;
        }
    }
    // `power` grew by one unit a row from the top down: as written, row n-1
    // gets c_{n-1}/(c_n·unit), row n-2 gets c_{n-2}/(c_n·unit²).
    let schur = Schur::try_new(companion, f64::EPSILON, ITERATIONS)?;
    for root in schur.complex_eigenvalues().iter() {
        found.push(polish(p, root * unit));
    }
    found
        .iter()
        .all(|root| root.re.is_finite() && root.im.is_finite())
        .then_some(found)
}

/// Newton's method, as long as it makes the value smaller.
fn polish(p: &[f64], mut x: Complex<f64>) -> Complex<f64> {
    let slope: Vec<f64> = p
        .iter()
        .enumerate()
        .skip(1)
        .map(|(power, c)| c * power as f64)
        .collect();
    for _ in 0..2 {
        let (here, rise) = (value(p, x), value(&slope, x));
        let next = x - here / rise;
        if value(p, next).norm_sqr() < here.norm_sqr() {
            x = next;
        } else {
            break;
        }
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_of_a_product_are_those_of_its_factors() {
        // s·(s + 3)·(s² + 2·0.1·200·s + 200²)
        let p = product(&product(&[0.0, 1.0], &[3.0, 1.0]), &[4e4, 40.0, 1.0]);
        let mut found = roots(&p).unwrap();
        found.sort_by(|a, b| a.norm().total_cmp(&b.norm()));
        assert_eq!(found[0], Complex::new(0.0, 0.0));
        assert!((found[1] - Complex::new(-3.0, 0.0)).norm() < 1e-10);
        assert!((found[2].re + 20.0).abs() < 1e-9 && (found[2].norm() - 200.0).abs() < 1e-9);
        assert_eq!(roots(&[f64::NAN, 1.0]), None);
        assert_eq!(roots(&[5.0]), Some(vec![]));
        assert_eq!(roots(&[]), None);
    }
}
