//! Filters that cannot be realised.

use gwatt::identify::Factor;
use gwatt::identify::tune::{AxisResponse, Discretization, Tuned, Wish, design};

use super::{axis, from_command, pair, refusal, wish};

#[test]
fn filters_that_cannot_be_had_are_refused() {
    let zeros = |hz: f64, damping: f64| [('X', vec![pair(hz, damping)]), ('Y', vec![])];
    let base = wish(Discretization::Matched);
    let refused = |zeros: &[(char, Vec<Factor>)], wish: Wish| refusal(design(zeros, &wish)).0;
    let of = |wish: Wish| refused(&zeros(40.0, 0.03), wish);
    assert_eq!(
        of(Wish {
            period_s: 0.0,
            ..base
        }),
        "the period of the filters is not positive"
    );
    assert_eq!(
        of(Wish {
            period_s: 0.02,
            ..base
        }),
        "axis X: the zero at 40.0 Hz is too fast for filters at 50 Hz"
    );
    assert_eq!(
        of(Wish {
            order: Some(1),
            ..base
        }),
        "a low-pass of order 1 under a numerator of order 2: the filter would not be causal"
    );
    assert_eq!(
        of(Wish {
            order: Some(99),
            ..base
        }),
        "a low-pass of order 99: at most 24 can be had"
    );
    assert_eq!(
        of(Wish {
            bandwidth_hz: Some(450.0),
            ..base
        }),
        "a low-pass of 450 Hz cannot be had at 1000 Hz"
    );
    // So slow that its poles are 1 to the last digit.
    assert_eq!(
        of(Wish {
            bandwidth_hz: Some(1e-15),
            ..base
        }),
        "the filter of axis X would not be stable"
    );
    assert_eq!(
        of(Wish {
            no_low_pass: true,
            ..wish(Discretization::Hold)
        }),
        "without a low-pass the filters are not causal as zoh makes them"
    );
    assert_eq!(
        refused(&zeros(40.0, 1.5), base),
        "axis X: a zero that does not oscillate cannot be evened out"
    );
    let refused = |axes: Vec<AxisResponse>, band| refusal(Tuned::new(axes, base, band)).0;
    let x = || axis('X', &[]);
    assert_eq!(refused(Vec::new(), 50.0), "there is no axis");
    assert_eq!(refused(vec![x(), x()], 50.0), "axis X is given twice");
    assert_eq!(
        refused(vec![x(), axis('Y', &[])], 501.0),
        "axes cannot be compared up to 501 Hz"
    );
    assert_eq!(
        refused(vec![x(), from_command('Y', &[], 0.0)], 50.0),
        "axis Y is known from its command, axis X from its force"
    );
}
