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

/// What is asked for next to the program changes nothing of it, where the spindle and the loads
/// leave the axes little: the last moves before the end are judged as closely as with a report.
#[test]
fn a_report_changes_nothing_of_the_program() {
    let rest = "[spindle]\ninertia_kg_m2 = 0.02\nfriction_nm = 0.3\nmax_rpm = 8000\n\
                base_rpm = 1500\naccel_time_s = 2.5\nwait = true\npeak_power_w = 300\n\
                [[load]]\non = \"M8\"\noff = \"M9\"\npower_w = 500";
    let axis = "coulomb_n = 500\nmass_kg = 700\nefficiency = 0.85";
    let shop = Shop(tempfile::tempdir().unwrap());
    shop.put(
        "mill.toml",
        &format!(
            "schema = 1\nname = \"mill\"\ncontroller = \"isg\"\n[converter]\n\
             peak_power_w = 1250\nbase_load_w = 250\n{rest}\n[limits]\nmargin = 0.05\n\
             [axes.X]\nrapid_mm_min = 36000\naccel_mm_s2 = 3000\n{axis}\n\
             [axes.Y]\nrapid_mm_min = 30000\naccel_mm_s2 = 5000\n{axis}\n\
             [axes.Z]\nrapid_mm_min = 24000\naccel_mm_s2 = 3000\n{axis}\n"
        ),
    );
    shop.put(
        "a.nc",
        "S1000 M3\nG1 X39.9 Z-1.5 F12000\nM8\nG0 X424.1 Y270.8 Z73.0\nG1 X244.2 Y126.4 F500\n\
         G0 X-43.7 Y138.0 Z22.8\n",
    );
    let [plain, reported] = ["", " --json a.json"].map(|option| {
        let (code, _, errors) = shop.run(&format!("limit a.nc --allow feed{option} -o out.nc"));
        assert_eq!(code, 0, "{errors}");
        shop.get("out.nc")
    });
    assert_eq!(plain, reported);
}
