//! The noise that a recording was taken with.

/// A model of noise.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Noise {
    /// Leak of the integrators that go with it; 0 without them.
    pub leak: f64,
    /// Taps of the filter that makes white what is left after them, without the
    /// leading 1.
    pub taps: Vec<f64>,
}
