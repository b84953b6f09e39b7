//! Which moves are planned, and which get the robust bound.

use std::io::Cursor;

use gwatt::interpret::Move;
use gwatt::machine::Machine;
use gwatt::pipeline::{Certificate, Options, Row, analyze, moves};
use gwatt::power::{Assessment, Assessor, Want};

use crate::machines::machine_from;
use crate::rows::Rows;
use crate::runs::rows_of;

fn rows(program: &str) -> Vec<Row> {
    let (machine, _) = Machine::load("linuxcnc-mill").expect("an embedded machine");
    rows_of(&machine, program)
}

/// The joint of line and small arc is a parabolic blend, which is not modelled with
/// limits of jerk; between feed and rapid LinuxCNC always stops.
#[test]
fn behind_a_stop_nothing_is_left_of_what_is_not_certain() {
    let program = "G21 G90 G17 G94 G64\nG0 X0 Y0 Z5\nG1 X20 F1200\nX40 Z0\nG3 Y0.4 J0.2\n";
    let text = include_str!("../../machine-configs/linuxcnc-mill.toml");
    let text = text.replace("\naccel_mm_s2", "\njerk_mm_s3 = 50000\naccel_mm_s2");
    let machine = machine_from(&text);
    let before = |stop: &str| rows_of(&machine, &format!("{program}{stop}G0 Z30\nX0\nM2\n"));
    let (moving, dwelling) = (before(""), before("G4 P1\n"));
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

/// Lines after which a controller's queue may be empty, or not.
const IDLE: [&str; 4] = ["X20\n", "(a remark)\n", "F1200\n", "T1\n"];

#[test]
fn motion_does_not_wait_for_ever() {
    let certificates = |line: &str, count: usize| {
        let idle = line.repeat(count);
        let program = format!("G21 G90 G94 G64 F1200\nG1 X20\n{idle}X40\nX60\nM2\n");
        let rows = rows(&program);
        let rows = rows.iter().filter(|row| row.duration_s > 0.0);
        rows.map(|row| row.certificate).collect::<Vec<_>>()
    };
    let [robust, planned] = [Certificate::Robust, Certificate::Planned];
    for line in IDLE {
        assert_eq!(certificates(line, 4095), [planned, planned, planned]);
        assert_eq!(certificates(line, 4096), [robust, robust, robust]);
    }
}

/// With a stop there and without one.
#[test]
fn what_nobody_waits_for_is_not_read_too_low() {
    for (machine, certificate) in [
        ("linuxcnc-mill", None),
        ("router-48v", None),
        ("linuxcnc-mill", Some(Certificate::Robust)),
        ("three-axis", None),
    ] {
        let peaks = |between: &str| {
            let program = format!(
                "G21 G90 G94 G64 F3000\nG1 X0.1\nX1 Y0.2\n{between}Y1\nG0 X5 Y7\n{between}\
                 X9\n{between}G2 X12 Y10 I3 J0\n{between}G1 Z5\nM2\n"
            );
            let (machine, _) = Machine::load(machine).expect("an embedded machine");
            let options = Options {
                certificate,
                ..Options::default()
            };
            let mut rows = Rows::default();
            analyze(Cursor::new(program), &machine, &options, Some(&mut rows)).expect("a program");
            let moves = rows.0.iter().filter(|row| row.duration_s > 0.0);
            moves
                .map(|row| [row.peak_w, row.regen_w])
                .collect::<Vec<_>>()
        };
        let (waited, stopped) = (peaks(""), peaks("G4 P0\n"));
        for idle in ["(a remark)\n", "F3000\n", "T1\n"] {
            let doubted = peaks(&idle.repeat(5000));
            assert_eq!(doubted.len(), waited.len());
            for (index, own) in doubted.iter().enumerate() {
                // What two moves come to together may be the second one's.
                let next = doubted.get(index + 1).unwrap_or(own);
                for (at, (own, next)) in own.iter().zip(next).enumerate() {
                    assert!(*own >= stopped[index][at], "{machine}, move {index}");
                    assert!(own.max(*next) >= waited[index][at], "{machine}, {index}");
                }
            }
        }
    }
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
                let mut hand_on = |_: &Move, _: &Assessment, _: &[u8]| handed_on += 1;
                assessor.push(mv, b"", &mut hand_on);
                assessor.end_line(mv.moves_axes(), &mut hand_on);
                pushed += 1;
                assert!(pushed - handed_on <= most, "{line}: {pushed}, {handed_on}");
                Ok(())
            },
        )
        .expect("a program");
        assert!(pushed >= 5000);
    }
}
