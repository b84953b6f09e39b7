//! The rows of `limit` are those of `report`, with what became of each move.

use super::RIG;
use crate::rows::Rows;
use gwatt::pipeline::{Allowed, Law, LimitOptions, Strategy, analyze, limit};

#[test]
fn peaks_are_exact_in_every_row() {
    let program = b"G1 X400 F20000\nG2 X402 I1 F900\nG3 X380 Y3 R20 F1200\nG0 X0 Y0\nG4 P1\n";
    let rig = super::Rig {
        axis: "coulomb_n = 77",
        ..RIG
    };
    let machine = rig.machine();
    let options = super::options(rig.options);
    let (mut report, mut limited) = (Rows::default(), Rows::default());
    analyze(
        std::io::Cursor::new(program),
        &machine,
        &options,
        Some(&mut report),
    )
    .expect("a program");
    let how = LimitOptions {
        strategy: Strategy::Optimal,
        law: Law::Exact,
        allowed: Allowed {
            feed: true,
            ..Allowed::NOTHING
        },
        ..LimitOptions::USUAL
    };
    limit(
        std::io::Cursor::new(program),
        &machine,
        &options,
        how,
        std::io::sink(),
        Some(&mut limited),
    )
    .expect("a program");
    assert_eq!(report.0.len(), limited.0.len());
    for (a, b) in report.0.iter().zip(&limited.0) {
        assert_eq!(
            (
                a.line,
                a.peak_w,
                a.regen_w,
                a.energy_j,
                a.start_s,
                a.duration_s
            ),
            (
                b.line,
                b.peak_w,
                b.regen_w,
                b.energy_j,
                b.start_s,
                b.duration_s
            )
        );
        assert!(b.peak_after_w.is_some_and(|peak| peak <= 1_000.000_01));
    }
    assert_eq!(limited.0[3].value_before, None);
    assert!(!limited.0[3].action.is_empty());
}
