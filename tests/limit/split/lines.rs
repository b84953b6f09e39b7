//! Lines between two stops, which the ISG kernel runs on into each other.

use gwatt::machine::PathMode;
use gwatt::pipeline::Certificate;

use super::super::{EXACT_STOP, Rig};
use super::ISG;
use crate::runs::rows_of;

/// Blocks of one line between two stops are planned together; whatever else joins them
/// or stands between them brings the robust bound back.
#[test]
fn lines_between_two_stops_are_planned() {
    let machine = ISG.machine();
    let certificates = |program: &str| -> Vec<Certificate> {
        let rows = rows_of(&machine, program);
        let moves = rows.iter().filter(|row| row.kind.name() != "dwell");
        moves.map(|row| row.certificate).collect()
    };
    let (planned, robust) = (Certificate::Planned, Certificate::Robust);
    for program in [
        "G0 X100\nX300\nM30\n",
        "G0 X100\nG231 = 50\nX300\nG4 P1\nX0\nM30\n",
        "G4 P1\nG1 F9000 X30 Y40\nX60 Y80\nX90 Y120 G60\nG0 X0\nM30\n",
    ] {
        let found = certificates(program);
        assert!(found.iter().all(|it| *it == planned), "{program} {found:?}");
    }
    for program in [
        "G0 X100\nX300\nY10\nM30\n",
        "G0 X100\nM8\nX300\nM30\n",
        "G0 X100\n(maybe)\nX300\nM30\n",
        "G0 X100\nX50\nM30\n",
        "G0 X100\nG1 X300 F30000\nM30\n",
        "G1 F9000 X100\nX300 F8000\nM30\n",
    ] {
        let found = certificates(program);
        assert!(found.contains(&robust), "{program} {found:?}");
    }
    // 5 m/s² over 100 mm lead to 1 m/s: 0.5 m/s after 0.1 s, and the second block brakes.
    let rows = rows_of(&machine, "G0 X100\nG231 = 40\nX300\nM30\n");
    let first_s = 0.1 + (100.0 - 25.0) / 500.0;
    let second_s = (200.0 - 62.5) / 500.0 + 0.25;
    assert!((rows[0].duration_s - first_s).abs() < 1e-9);
    assert!((rows[1].duration_s - second_s).abs() < 1e-9);
    assert!((rows[0].peak_w - 1250.0).abs() < 1e-6);
    // Cruising takes nothing, braking gives 0.5 m/s · 500 kg · 2 m/s².
    assert!(rows[1].peak_w.abs() < 1e-6 && (rows[1].regen_w - 500.0).abs() < 1e-6);
}

/// G60 stops once, G360 until G359.
#[test]
fn exact_stops_of_the_isg_kernel_are_read() {
    let machine = ISG.machine();
    let rows = rows_of(
        &machine,
        "G360\nG0 X100\nX200\nG359\nX300 G60\nX400\nY9\nM30\n",
    );
    let robust: Vec<bool> = rows
        .iter()
        .map(|row| row.certificate == Certificate::Robust)
        .collect();
    assert_eq!(robust, [false, false, false, true, true]);
    // The machine's own start-up code stays in force.
    let rig = Rig {
        rest: EXACT_STOP,
        ..ISG
    };
    assert_eq!(rig.machine().path.mode, Some(PathMode::ExactStop));
    let rows = rows_of(&rig.machine(), "G359\nG0 X100\nX200\nY9\nM30\n");
    assert!(
        rows.iter()
            .all(|row| row.certificate == Certificate::Planned)
    );
}
