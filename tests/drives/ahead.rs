//! Curves of force under look-ahead: no peak lower than from rest to rest.

use crate::rows::Rows;
use gwatt::machine::Machine;
use gwatt::pipeline::{Options, analyze};
use std::io::Cursor;

use crate::machines::{linear_axes, machine_from};

/// 500 kg and 300 N of friction; 4000 N to 20000 mm/min, falling to 500 N at 60000.
fn machine(controller: &str) -> Machine {
    let drive = "coulomb_n = 300\nforce_curve = [{ speed_mm_min = 0, force_n = 4000 }, \
                 { speed_mm_min = 20000, force_n = 4000 }, { speed_mm_min = 60000, force_n = 500 }]";
    machine_from(&format!(
        "schema = 1\nname = \"test\"\ncontroller = \"{controller}\"\n\
         [converter]\npeak_power_w = 1e5\n{}",
        linear_axes("XY", [60000.0, 6000.0, 500.0], drive)
    ))
}

fn peak_w(controller: &str, program: &str) -> f64 {
    let machine = machine(controller);
    let mut rows = Rows::default();
    let summary = analyze(
        Cursor::new(program.as_bytes()),
        &machine,
        &Options::default(),
        Some(&mut rows),
    );
    summary.expect("a summary").peak_w
}

/// v·F is largest at 547 mm/s with 2875 N or so: 1574 W, with or without look-ahead.
#[test]
fn a_rapid_draws_what_its_drive_gives() {
    let force = |v: f64| 4000.0 - 3500.0 * (v - 1.0 / 3.0) / (2.0 / 3.0);
    let v = (4000.0 + 1750.0) / (2.0 * 5250.0);
    for controller in ["iso", "grbl", "linuxcnc", "marlin", "klipper", "reprap"] {
        let found = peak_w(controller, "G21 G90\nG0 X300\n");
        assert!(
            (found / (v * force(v)) - 1.0).abs() < 1e-6,
            "{controller}: {found}"
        );
    }
}

/// Speeds at which no drive has less than the axis asks for: as without a curve.
#[test]
fn an_arc_that_no_curve_concerns_is_planned() {
    let program = "G21 G90 G17\nG2 X100 Y0 I50 J0 F15000\n";
    for controller in ["iso", "grbl", "linuxcnc"] {
        let mut plain = machine(controller);
        plain.force_curves.clear();
        let mut rows = Rows::default();
        let summary = analyze(
            Cursor::new(program.as_bytes()),
            &plain,
            &Options::default(),
            Some(&mut rows),
        );
        let (found, plain_w) = (
            peak_w(controller, program),
            summary.expect("a summary").peak_w,
        );
        assert!(
            (found / plain_w - 1.0).abs() < 1e-9,
            "{controller}: {found} {plain_w}"
        );
    }
}

/// An arc between two lines at a speed at which the drives have too little: no less
/// than its force at that speed.
#[test]
fn an_arc_that_a_curve_concerns_is_bounded() {
    let program = "G21 G90 G17 G64\nG1 X50 F50000\nG2 X450 Y0 I200 J0\nG1 X600\n";
    for controller in ["grbl", "linuxcnc"] {
        let found = peak_w(controller, program);
        assert!(found > 1000.0, "{controller}: {found}");
    }
}
