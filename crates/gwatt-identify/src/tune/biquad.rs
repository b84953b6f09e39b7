//! Second-order sections: a digital filter as it is put into a controller.

use nalgebra::Complex;

/// `(b0 + b1·z⁻¹ + b2·z⁻²)/(1 + a1·z⁻¹ + a2·z⁻²)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Biquad {
    /// b0, b1, b2.
    pub b: [f64; 3],
    /// a1, a2.
    pub a: [f64; 2],
}

impl Biquad {
    /// Lets everything through.
    pub const ONE: Self = Self {
        b: [1.0, 0.0, 0.0],
        a: [0.0, 0.0],
    };

    /// b0, b1, b2, a1, a2.
    #[must_use]
    pub fn coefficients(&self) -> [f64; 5] {
        let ([b0, b1, b2], [a1, a2]) = (self.b, self.a);
        [b0, b1, b2, a1, a2]
    }

    /// Of b0, b1, b2, a1, a2.
    #[must_use]
    pub fn of([b0, b1, b2, a1, a2]: [f64; 5]) -> Self {
        Self {
            b: [b0, b1, b2],
            a: [a1, a2],
        }
    }

    /// The response at z.
    #[must_use]
    pub fn at(&self, z: Complex<f64>) -> Complex<f64> {
        let back = z.inv();
        let ([b0, b1, b2], [a1, a2]) = (self.b, self.a);
        ((back * b2 + b1) * back + b0) / ((back * a2 + a1) * back + 1.0)
    }

    /// True where both poles lie inside the unit circle (the triangle of Jury's
    /// criterion).
    #[must_use]
    pub fn is_stable(&self) -> bool {
        let [a1, a2] = self.a;
        a2.abs() < 1.0 && a1.abs() < 1.0 + a2
    }
}

/// The response of sections in series to a sine of `frequency_hz`.
#[must_use]
pub fn response(sections: &[Biquad], frequency_hz: f64, period_s: f64) -> Complex<f64> {
    let (sin, cos) = libm::sincos(std::f64::consts::TAU * frequency_hz * period_s);
    let z = Complex::new(cos, sin);
    sections.iter().map(|section| section.at(z)).product()
}

/// Sections at work, one sample after another.
#[derive(Debug, Clone)]
pub struct Cascade {
    sections: Vec<(Biquad, [f64; 2])>,
}

impl Cascade {
    /// At rest at the value `x`, which has been there for ever.
    #[must_use]
    pub fn at_rest(sections: &[Biquad], x: f64) -> Self {
        let mut level = x;
        let with_state = sections.iter().map(|section| {
            let ([b0, b1, b2], [a1, a2]) = (section.b, section.a);
            let out = level * ((b0 + b1 + b2) / (1.0 + a1 + a2));
            let s2 = b2 * level - a2 * out;
            let s1 = b1 * level - a1 * out + s2;
            level = out;
            (*section, [s1, s2])
        });
        Self {
            sections: with_state.collect(),
        }
    }

    /// The next value (direct form II, transposed).
    pub fn step(&mut self, x: f64) -> f64 {
        let mut value = x;
        for (section, [s1, s2]) in &mut self.sections {
            let ([b0, b1, b2], [a1, a2]) = (section.b, section.a);
            let out = b0 * value + *s1;
            *s1 = b1 * value - a1 * out + *s2;
            *s2 = b2 * value - a2 * out;
            value = out;
        }
        value
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cascade_stays_at_rest_and_answers_as_its_response_says() {
        let sections = [
            Biquad::of([0.2, 0.3, 0.1, -0.5, 0.1]),
            Biquad::of([0.5, 0.0, 0.0, -0.5, 0.0]),
        ];
        let mut cascade = Cascade::at_rest(&sections, 3.0);
        for _ in 0..5 {
            assert!((cascade.step(3.0) - 3.0).abs() < 1e-15);
        }
        let mut cascade = Cascade::at_rest(&sections, 0.0);
        let (f, t) = (40.0, 1e-3);
        let expected = response(&sections, f, t);
        for k in 0..2000 {
            let phase = std::f64::consts::TAU * f * t * f64::from(k);
            let out = cascade.step(libm::cos(phase));
            let (sin, cos) = libm::sincos(phase);
            if k > 1000 {
                assert!((out - (expected * Complex::new(cos, sin)).re).abs() < 1e-12);
            }
        }
        assert!(sections.iter().all(Biquad::is_stable));
        assert!(!Biquad::of([1.0, 0.0, 0.0, -2.1, 1.05]).is_stable());
    }
}
