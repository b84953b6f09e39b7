//! A filter by zero-order hold, as second-order sections.

use nalgebra::Complex;

use super::biquad::Biquad;
use super::low_pass::LowPass;
use crate::discrete::Discrete;
use crate::transfer::{Factor, TransferFunction};

type C = Complex<f64>;

/// Sections of the filter with the same samples, its input held. `None` where
/// the numerator is of higher order than the low-pass, or is not finite.
pub(super) fn held(numerator: &[Factor], low_pass: LowPass, period_s: f64) -> Option<Vec<Biquad>> {
    let filter = TransferFunction {
        gain: 1.0,
        zeros: numerator.to_vec(),
        poles: low_pass.poles(),
        delay_s: 0.0,
    };
    let discrete = Discrete::held(&filter, period_s)?;
    let poles = quadratics(&discrete.poles);
    let mut zeros = quadratics(&discrete.zeros);
    // Fewer zeros than poles: the rest is delay.
    let degree = |list: &[(usize, [f64; 3])]| list.iter().map(|(n, _)| n).sum::<usize>();
    let mut late = degree(&poles).saturating_sub(degree(&zeros));
    let mut sections = Vec::new();
    for (room, [_, a1, a2]) in poles {
        let fits = |(n, _): &(usize, [f64; 3])| *n <= room;
        let taken = zeros.iter().position(fits).map(|at| zeros.remove(at));
        let (size, mut b) = taken.unwrap_or((0, [1.0, 0.0, 0.0]));
        for _ in size..room {
            if late > 0 {
                late -= 1;
                let [b0, b1, _] = b;
                b = [0.0, b0, b1];
            }
        }
        let gain = (1.0 + a1 + a2) / b.iter().sum::<f64>();
        sections.push(Biquad {
            b: b.map(|c| c * gain),
            a: [a1, a2],
        });
    }
    let finite = |s: &Biquad| s.coefficients().iter().all(|c| c.is_finite());
    (zeros.is_empty() && sections.iter().all(finite)).then_some(sections)
}

/// `Π(1 − root·z⁻¹)` in factors of at most two roots, the pairs first.
fn quadratics(roots: &[C]) -> Vec<(usize, [f64; 3])> {
    let is_real = |root: &C| root.im.abs() <= 1e-9 * root.norm();
    let mut list: Vec<(usize, [f64; 3])> = roots
        .iter()
        .filter(|root| !is_real(root) && root.im > 0.0)
        .map(|root| (2, [1.0, -2.0 * root.re, root.norm_sqr()]))
        .collect();
    let real: Vec<f64> = roots.iter().filter(|r| is_real(r)).map(|r| r.re).collect();
    for pair in real.chunks(2) {
        list.push(match pair {
            [a, b] => (2, [1.0, -(a + b), a * b]),
            [a] => (1, [1.0, -a, 0.0]),
            _ => continue,
        });
    }
    list
}
