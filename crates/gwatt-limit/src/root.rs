//! The largest value of a knob that still fits.

/// The load may stay this far below the limit: a share of it.
const CLOSE_ENOUGH: f64 = 1e-7;
/// The search ends when the bracket is this narrow: a share of the value.
const NARROW: f64 = 1e-9;
/// Smallest value that is tried, as a share of the largest.
const SMALLEST: f64 = 1e-6;
/// Evaluations that a search may take.
const EVALUATIONS: u32 = 80;

/// The largest `x ≤ top` with `load(x) ≤ 1`, where `load(top) = load_top > 1`.
///
/// `load` is a load ratio that grows with x, at least near the solution. The
/// value returned has been evaluated and fits; `None` when not even a very
/// small one does. Regula falsi with the Illinois modification: exact at once
/// where the load is linear in x.
pub(super) fn largest(top: f64, load_top: f64, mut load: impl FnMut(f64) -> f64) -> Option<f64> {
    let mut low = top * SMALLEST;
    let load_low = load(low);
    // Not a number counts as too much.
    if load_low > 1.0 || load_low.is_nan() {
        return None;
    }
    let (mut high, mut below, mut above) = (top, load_low - 1.0, load_top - 1.0);
    let mut side = 0_i8;
    for round in 0..EVALUATIONS {
        if high - low <= NARROW * high {
            break;
        }
        let secant = low + (high - low) * (-below / (above - below));
        // Every fourth step halves, so that the bracket shrinks for any curve.
        let inside = secant.is_finite() && secant > low && secant < high && round % 4 != 3;
        let x = if inside {
            secant
        } else {
            f64::midpoint(low, high)
        };
        let excess = load(x) - 1.0;
        if excess <= 0.0 {
            low = x;
            if excess >= -CLOSE_ENOUGH {
                break;
            }
            below = excess;
            if side == -1 {
                above /= 2.0;
            }
            side = -1;
        } else {
            // Rounding may leave the secant's point just above the limit.
            if excess <= CLOSE_ENOUGH / 2.0 {
                let backed = x * (1.0 - CLOSE_ENOUGH);
                if backed > low && load(backed) <= 1.0 {
                    low = backed;
                    break;
                }
            }
            high = x;
            above = excess;
            if side == 1 {
                below /= 2.0;
            }
            side = 1;
        }
    }
    Some(low)
}

#[cfg(test)]
mod tests {
    use super::largest;

    #[test]
    fn linear_loads_are_solved_at_once() {
        let mut evaluations = 0;
        let x = largest(100.0, 2.0, |x| {
            evaluations += 1;
            x / 50.0
        });
        assert!((x.unwrap() - 50.0).abs() < 1e-4);
        assert!(evaluations <= 4, "{evaluations}");
    }

    #[test]
    fn curved_and_kinked_loads() {
        for (load, expected) in [
            ((|x: f64| x * x / 400.0) as fn(f64) -> f64, 20.0),
            (|x| x.powi(3) / 8000.0, 20.0),
            (|x| if x > 20.0 { 3.0 } else { 0.2 }, 20.0),
            (|x| (x / 20.0).sqrt(), 20.0),
        ] {
            let x = largest(100.0, load(100.0), load).unwrap();
            assert!(load(x) <= 1.0 && (x - expected).abs() < 1e-4, "{x}");
        }
    }

    #[test]
    fn a_load_that_never_fits_has_no_solution() {
        assert_eq!(largest(100.0, 2.0, |x| 1.5 + x / 200.0), None);
        assert_eq!(largest(100.0, f64::NAN, |_| f64::NAN), None);
    }
}
