//! Which moves are planned, and which get the robust bound.

use std::io::Cursor;

use gwatt::machine::Machine;
use gwatt::pipeline::{Certificate, Options, Row, analyze, moves};
use gwatt::power::{Assessor, Want};

use crate::rows::Rows;

fn rows(program: &str) -> Vec<Row> {
    let (machine, _) = Machine::load("linuxcnc-mill").expect("an embedded machine");
    let mut rows = Rows::default();
    analyze(
        Cursor::new(program),
        &machine,
        &Options::default(),
        Some(&mut rows),
    )
    .expect("a program");
    rows.0
}

/// The joint of line and small arc is a parabolic blend, whose path is not known;
/// between feed and rapid LinuxCNC always stops.
#[test]
fn behind_a_stop_nothing_is_left_of_what_is_not_certain() {
    let program = "G21 G90 G17 G94 G64\nG0 X0 Y0 Z5\nG1 X20 F1200\nX40 Z0\nG3 Y0.4 J0.2\n";
    let behind = |stop: &str| rows(&format!("{program}{stop}G0 Z30\nX0\nM2\n"));
    let (moving, dwelling) = (behind(""), behind("G4 P1\n"));
    let certificates: Vec<_> = moving.iter().map(|row| row.certificate).collect();
    let [robust, planned] = [Certificate::Robust, Certificate::Planned];
    assert_eq!(
        certificates,
        [planned, robust, robust, robust, planned, planned]
    );
    let rapids = |rows: &[Row]| {
        let rapids = rows.iter().rev().take(2);
        rapids
            .map(|row| (row.peak_w, row.duration_s))
            .collect::<Vec<_>>()
    };
    assert_eq!(rapids(&moving), rapids(&dwelling));
}

/// A controller's queue is empty before thousands of blocks of no length end.
#[test]
fn motion_does_not_wait_for_ever() {
    let certificates = |idle: usize| {
        let idle = "X20\n".repeat(idle);
        let program = format!("G21 G90 G94 G64 F1200\nG1 X20\n{idle}X40\nX60\nM2\n");
        let rows = rows(&program);
        let rows = rows.iter().filter(|row| row.duration_s > 0.0);
        rows.map(|row| row.certificate).collect::<Vec<_>>()
    };
    let [robust, planned] = [Certificate::Robust, Certificate::Planned];
    assert_eq!(certificates(4000), [planned, planned, planned]);
    assert_eq!(certificates(5000), [robust, robust, robust]);
}

/// Neither blocks of no length, nor moves whose way is not modelled.
#[test]
fn moves_are_handed_on_as_the_program_goes() {
    let (machine, _) = Machine::load("linuxcnc-mill").expect("an embedded machine");
    for (line, most) in [
        ("X10\n", 4100),
        ("G38.2 X20 Z-1 Y4\nG0 X10\n", 4),
        ("G33 X10 K1\nG1 X20\n", 8),
    ] {
        let program = format!(
            "G21 G90 G94 F1200 M3 S500\nG1 X10\n{}M2\n",
            line.repeat(5000)
        );
        let mut assessor = Assessor::new(&machine, None, Want::PEAKS);
        let (mut pushed, mut handed_on) = (0_usize, 0_usize);
        moves(
            Cursor::new(program),
            &machine,
            &Options::default(),
            &mut |mv, _| {
                assessor.push(mv, b"", &mut |_, _, _| handed_on += 1);
                pushed += 1;
                assert!(pushed - handed_on <= most, "{line}: {pushed}, {handed_on}");
                Ok(())
            },
        )
        .expect("a program");
        assert!(pushed >= 5000);
    }
}
