//! Times of recordings that are written with too few digits.

use std::fmt::Write as _;

use gwatt_identify::Recording;

use crate::miswritten::{rigid_columns, rigid_outcome};
use crate::simulated::Random;

/// They repeat, or leave samples out.
#[test]
fn times_of_too_few_digits_do_not_mislead() {
    let mut random = Random(9);
    let (columns, truth) = rigid_columns(&mut random);
    let read = |period_s: f64, digit_s: f64| {
        let mut table = String::from("time_s,force_n,position_m\n");
        for (k, (force, x)) in columns.force.iter().zip(&columns.position).enumerate() {
            let time_s = digit_s * libm::round(k as f64 * period_s / digit_s);
            let _ = writeln!(table, "{time_s:.6},{force:.3},{x:.6}");
        }
        Recording::read(table.as_bytes(), None)
    };
    for (period_s, digit_s) in [(1e-3, 2e-3), (1e-3, 0.01), (2.5e-4, 1e-3)] {
        let trouble = read(period_s, digit_s).unwrap_err().message;
        assert!(trouble.contains("the time "), "{trouble}");
    }
    for period_s in [1.25e-3, 1.5e-3] {
        let trouble = read(period_s, 1e-3).unwrap_err().message;
        assert!(trouble.starts_with("sampling is uneven"), "{trouble}");
    }
    // One sample of two hundred seems to be missing.
    let recording = read(1.005e-3, 1e-3).unwrap();
    let times = 1.005_f64;
    let [mass, viscous] = truth;
    let outcome = rigid_outcome(recording, [mass * times * times, viscous * times]);
    assert!(!outcome.misleads(), "{}", outcome.word);
}
