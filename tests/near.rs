//! Figures that differ by rounding, or by what a method leaves.

/// Asserts that a figure is the expected one, to within `slack`.
#[track_caller]
pub(crate) fn assert_near(found: f64, expected: f64, slack: f64) {
    assert!((found - expected).abs() <= slack, "{found}, not {expected}");
}
