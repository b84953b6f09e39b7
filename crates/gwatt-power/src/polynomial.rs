//! Polynomials up to the fourth degree on an interval.
//!
//! Input: coefficients. Output: values, integrals, and all roots inside an
//! interval: between two neighbouring roots of its derivative a polynomial is
//! monotone and has one root at most.

use arrayvec::ArrayVec;

/// Halvings at most; Newton's steps need far fewer.
const STEPS: u32 = 200;

/// Coefficients, that of `zⁱ` at i.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Polynomial(pub [f64; 5]);

impl Polynomial {
    pub const ZERO: Self = Self([0.0; 5]);

    /// The product of two of the second degree.
    pub fn product(a: [f64; 3], b: [f64; 3]) -> Self {
        let mut c = [0.0; 5];
        for (i, x) in a.into_iter().enumerate() {
            for (j, y) in b.into_iter().enumerate() {
                c[i + j] += x * y;
            }
        }
        Self(c)
    }

    /// Adds another one times a factor.
    pub fn add(&mut self, factor: f64, other: &Self) {
        for (own, others) in self.0.iter_mut().zip(other.0) {
            *own += factor * others;
        }
    }

    pub fn value(&self, z: f64) -> f64 {
        self.0.iter().rev().fold(0.0, |sum, c| sum * z + c)
    }

    pub fn derivative(&self) -> Self {
        let [_, b, c, d, e] = self.0;
        Self([b, 2.0 * c, 3.0 * d, 4.0 * e, 0.0])
    }

    /// The integral between two points.
    pub fn integral(&self, from: f64, to: f64) -> f64 {
        let [a, b, c, d, e] = self.0;
        let primitive =
            |z: f64| z * (a + z * (b / 2.0 + z * (c / 3.0 + z * (d / 4.0 + z * e / 5.0))));
        primitive(to) - primitive(from)
    }

    /// Whether the constant term outweighs all others in an interval.
    fn keeps_its_sign(&self, low: f64, high: f64) -> bool {
        let [constant, rest @ ..] = self.0;
        let size = low.abs().max(high.abs());
        let most = rest.iter().rev().fold(0.0, |sum, c| (sum + c.abs()) * size);
        // A little more, for rounding.
        constant.abs() > most * (1.0 + 1e-9)
    }

    /// The points inside an interval where it is 0 and changes its sign.
    pub fn roots(&self, low: f64, high: f64) -> ArrayVec<f64, 4> {
        if self.keeps_its_sign(low, high) {
            return ArrayVec::new();
        }
        let order = self.0.iter().rposition(|c| *c != 0.0).unwrap_or(0);
        let mut chain = [*self; 4];
        for i in 1..4 {
            chain[i] = chain[i - 1].derivative();
        }
        // From the linear derivative up to the polynomial itself.
        let mut found = ArrayVec::<f64, 4>::new();
        for (degree, polynomial) in (1..=4).zip(chain.iter().rev()).skip(4 - order) {
            let slope = polynomial.derivative();
            let mut roots = ArrayVec::new();
            let mut from = low;
            for to in found.into_iter().chain([high]) {
                if let Some(root) = between(polynomial, &slope, from, to)
                    && roots.len() < degree
                {
                    roots.push(root);
                }
                from = to;
            }
            found = roots;
        }
        found
    }
}

/// The root between two points, between which the polynomial is monotone.
fn between(polynomial: &Polynomial, slope: &Polynomial, from: f64, to: f64) -> Option<f64> {
    let (first, last) = (polynomial.value(from), polynomial.value(to));
    let changes = (first < 0.0 && last > 0.0) || (first > 0.0 && last < 0.0);
    if !changes {
        return None;
    }
    let (mut low, mut high) = (from, to);
    let mut z = 0.5 * (low + high);
    for _ in 0..STEPS {
        let value = polynomial.value(z);
        if (value > 0.0) == (first > 0.0) {
            low = z;
        } else {
            high = z;
        }
        let step = value / slope.value(z);
        if step.abs() <= f64::EPSILON * z.abs() {
            break;
        }
        let newton = z - step;
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        z = if newton > low && newton < high {
            newton
        } else {
            middle
        };
    }
    Some(z)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_roots_inside_are_found() {
        // (z − 1)(z − 2)(z − 3)(z − 4)
        let p = Polynomial([24.0, -50.0, 35.0, -10.0, 1.0]);
        let roots = p.roots(0.0, 3.5);
        assert_eq!(roots.len(), 3);
        for (root, expected) in roots.into_iter().zip([1.0, 2.0, 3.0]) {
            assert!((root - expected).abs() < 1e-12);
        }
        assert_eq!(p.roots(-3.0, 5.0).len(), 4);
        assert!(
            Polynomial([1.0, 0.0, 1.0, 0.0, 0.0])
                .roots(-9.0, 9.0)
                .is_empty()
        );
        let linear = Polynomial([-1.0, 2.0, 0.0, 0.0, 0.0]);
        assert_eq!(linear.roots(0.0, 1.0).as_slice(), [0.5]);
        assert!(Polynomial::ZERO.roots(0.0, 1.0).is_empty());
    }

    #[test]
    fn integrals_are_exact() {
        let p = Polynomial([1.0, 2.0, 3.0, 4.0, 5.0]);
        assert_eq!(p.integral(0.0, 2.0), 2.0 + 4.0 + 8.0 + 16.0 + 32.0);
        assert_eq!(
            Polynomial::product([1.0, 1.0, 0.0], [1.0, -1.0, 2.0]).0,
            [1.0, 0.0, 1.0, 2.0, 0.0]
        );
    }
}
