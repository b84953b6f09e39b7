//! The rows of `limit` are those of `report`, with what became of each move.

use super::RIG;
use crate::rows::Rows;
use crate::shop::Shop;
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

/// Where a cycle is written out, lines that stand keep the figures of the original: a stop
/// that comes between them and the cycle is not their own.
#[test]
fn rows_next_to_a_cycle_that_is_written_out_are_those_of_the_original() {
    let shop = Shop::mill(
        "linuxcnc",
        "peak_power_w = 450",
        "[path]\nrapid = \"linear\"",
        "",
    );
    shop.put(
        "a.nc",
        "G21 G90\nG0 X10 Y10 Z50\nG99 G81 X200 Y200 Z-5 R2 F300\nX300 Y10\nG80\nM2\n",
    );
    let (code, _, errors) = shop.run("limit a.nc --allow expand --report after.csv -o out.nc");
    assert_eq!(code, 0, "{errors}");
    shop.run("report a.nc --csv before.csv");
    let columns = |name: &str| -> Vec<Vec<String>> {
        let text = shop.get(name);
        let rows = text.lines().skip(1);
        rows.map(|row| row.split(',').map(str::to_owned).collect())
            .collect()
    };
    let of_line = |name: &str, line: &str| -> Vec<Vec<String>> {
        let rows = columns(name).into_iter();
        rows.filter(|row| row[0] == line).collect()
    };
    let [before, after] = ["before.csv", "after.csv"].map(|name| of_line(name, "2"));
    assert_eq!(before.len(), 1);
    // Line, kind, axes and the figures up to the energy.
    assert_eq!(before[0][..4], after[0][..4]);
    assert_eq!(before[0][5..11], after[0][5..11]);
    let cycle = of_line("after.csv", "3");
    assert!(cycle.len() > 2, "{cycle:?}");
    assert!(cycle.iter().all(|row| !row[11].is_empty()), "{cycle:?}");
}
