//! Words between two lines of one direction under `LinuxCNC`: whether its planner runs
//! them as one line, as two, or with a stop between them.
//!
//! Recorded: X by 20 and by 40 mm at F8000 under G64 P0.05; 2000 mm/s², of which the
//! last element keeps half. One line takes 0.585 s, two 0.552 s, with a stop 0.722 s.

use std::io::Cursor;

use gwatt::machine::Machine;
use gwatt::pipeline::{Certificate, Options, analyze};

use crate::machines::{linear_axes, machine_from};
use crate::rows::Rows;

const ONE: [&str; 29] = [
    "",
    "M61 Q1",
    "M70",
    "M71",
    "M70\nM72",
    "M73",
    "G10 L2 P2 X5",
    "G10 L20 P2 X7",
    "G10 L0",
    "G17",
    "G20\nG21",
    "G28.1",
    "G30.1",
    "G40",
    "G54",
    "G80",
    "G90",
    "G91\nG90",
    "G91.1",
    "G97",
    "G98",
    "F8000",
    "T1",
    "(PRINT, a)",
    "(a)",
    "; LOG, a",
    "#1=5",
    "G1 X20 F8000",
    "(LOGCLOSE)",
];
const TWO: [&str; 21] = [
    "M48",
    "M49",
    "M50",
    "M50 P0",
    "M51",
    "M53",
    "M62 P0",
    "M63 P0",
    "M67 E0 Q1",
    "G61\nG64 P0.05",
    "G61.1\nG64 P0.05",
    "G64 P0.05",
    "G64 P0.05 Q0.05",
    "G93\nG94 F8000",
    "G94 F8000",
    "G95\nG94 F8000",
    "F4000\nF8000",
    "(LOG, a)",
    "G0 X20",
    "M62 P0 F8000",
    "M70\nF3000\nM72",
];
const STOP: [&str; 28] = [
    "M52 P0",
    "M64 P0",
    "M65 P0",
    "M66 P0 L0",
    "M68 E0 Q1",
    "G4 P0",
    "G10 L2 P1 X0",
    "G10 L2 P0 Y0",
    "G10 L20 P1 X20",
    "G43.1 Z0",
    "G49",
    "G52 X0",
    "G92 X20",
    "G92.1",
    "G92.2",
    "G97 S500",
    "S500",
    "S0",
    "M3 S500",
    "M4 S500",
    "M5",
    "M7",
    "M8",
    "M9",
    "(MSG, a)",
    "(DEBUG, a)",
    "M0",
    "M1",
];

fn machine() -> Machine {
    machine_from(&format!(
        "schema = 1\nname = \"test\"\ncontroller = \"linuxcnc\"\n[converter]\npeak_power_w = 1e6\n\
         [offsets]\nG54 = {{ X = 0 }}\nG55 = {{ X = 0 }}\n{}",
        linear_axes("XYZ", [9000.0, 2000.0, 250.0], "")
    ))
}

#[test]
fn words_join_part_or_stop_as_recorded() {
    let machine = machine();
    let lists = [(0.585, ONE.as_slice()), (0.552, &TWO), (0.722, &STOP)];
    for (recorded_s, word) in lists
        .iter()
        .flat_map(|(s, words)| words.iter().map(move |word| (s, word)))
    {
        let program =
            format!("G21 G90 G17 G94 G64 P0.05\nG0 X0 Y0\nG1 X20 F8000\n{word}\nG1 X60\nM2\n");
        let mut rows = Rows::default();
        analyze(
            Cursor::new(program.as_bytes()),
            &machine,
            &Options::default(),
            Some(&mut rows),
        )
        .unwrap_or_else(|error| panic!("{word}: {error}"));
        let planned_s: f64 = rows.0.iter().map(|row| row.duration_s).sum();
        let certain = rows
            .0
            .iter()
            .all(|row| row.certificate == Certificate::Planned);
        assert!(certain, "{word}");
        assert!(
            (planned_s - recorded_s).abs() < 6e-3,
            "{word}: {planned_s} s, not {recorded_s}"
        );
    }
}
