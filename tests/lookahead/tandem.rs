//! Moves that `LinuxCNC` overlaps: the next one begins while the last one brakes.

use std::fmt::Write as _;
use std::io::{self, Cursor};

use gwatt::machine::Machine;
use gwatt::pipeline::{Certificate, Options, Row, SeriesSink, series};
use gwatt::power::Instant;
use proptest::prelude::*;

use crate::machines::{linear_axes, machine_from, rotary_axes};
use crate::runs::rows_of;

/// 200 mm/s, 1 m/s² and 100 kg; the table next to them weighs nothing.
fn machine() -> Machine {
    machine_from(&format!(
        "schema = 1\nname = \"test\"\ncontroller = \"linuxcnc\"\n\
         [converter]\npeak_power_w = 1e6\nregen_power_w = 1e6\n{}{}",
        rotary_axes("A", [36000.0, 36000.0, 1e-12]),
        linear_axes("XYZ", [12000.0, 1000.0, 100.0], "")
    ))
}

/// With half of 1 m/s² each reaches 31.6 mm/s over 2 mm; the ramp of one falls as
/// that of the next rises. Together X has at most 31.6 mm/s and 1 m/s²: 3.16 W drawn
/// and fed back. F lies far above.
#[test]
fn two_ramps_at_once_by_hand() {
    let rows = rows_of(&machine(), "G21 G90 G94 G64\nG1 X2 A0.1 F3000\nX4 A0\nM2\n");
    for row in &rows {
        assert_eq!(row.certificate, Certificate::Planned);
        assert!((row.peak_w - 10_f64.sqrt()).abs() < 1e-6, "{}", row.peak_w);
        assert!((row.regen_w - row.peak_w).abs() < 1e-6, "{}", row.regen_w);
    }
    assert_eq!(rows.len(), 2);
}

#[derive(Default)]
struct Shown(Vec<(u64, f64, f64)>);

impl SeriesSink for Shown {
    fn row(&mut self, _: f64, line: u64, instant: &Instant) -> io::Result<()> {
        self.0.push((line, instant.bus_w[0], instant.regen_w[0]));
        Ok(())
    }
}

/// A line, a line with the table, an arc or a helix.
fn block(kind: u8, [x, y, z]: [f64; 3], turn: f64) -> String {
    match kind {
        0 => format!("G1 X{x:.4} Y{y:.4} Z{z:.4}"),
        1 => format!("G1 X{x:.4} Y{y:.4} A{turn:.4}"),
        _ => {
            let (sin, cos) = libm::sincos(turn);
            let (i, j) = (-5.0 * x.abs().max(0.1), 0.0);
            let (to_x, to_y) = (i - i * cos, -i * sin);
            let rise = if kind == 2 { 0.0 } else { z };
            format!("G3 X{to_x:.6} Y{to_y:.6} Z{rise:.4} I{i:.6} J{j}")
        }
    }
}

proptest! {
    /// What is shown of the motion, both moves at once among it, is nowhere above the
    /// peaks of the moves it belongs to, and these are no idle bounds.
    #[test]
    fn peaks_hold_for_both_at_once(
        blocks in prop::collection::vec(
            (0_u8..4, prop::array::uniform3(-3.0..3.0), 0.3..5.0),
            2..12,
        ),
        feed in 300.0..9000.0,
        tolerance in prop::option::of(0.001..0.3),
    ) {
        let tolerance = tolerance.map_or(String::new(), |p: f64| format!(" P{p:.4}"));
        let mut program = format!("G21 G90 G94 G17 G64{tolerance}\nF{feed:.1}\nG91\n");
        for (kind, by, turn) in blocks {
            let _ = writeln!(program, "{}", block(kind, by, turn));
        }
        program.push_str("G90\nM2\n");
        let machine = machine();
        let rows = rows_of(&machine, &program);
        let mut shown = Shown::default();
        let input = Cursor::new(program.as_bytes());
        series(input, &machine, &Options::default(), 1e-3, &mut shown).expect("a program");
        let (mut largest, mut planned) = (0.0_f64, 0.0_f64);
        for (line, drawn_w, regen_w) in shown.0 {
            let at = rows.iter().position(|row| row.line == line).expect("its row");
            prop_assert_eq!(rows[at].certificate, Certificate::Planned);
            // Half of a blend belongs to the move after it.
            let near = &rows[at.saturating_sub(1)..(at + 2).min(rows.len())];
            let most = |of: fn(&Row) -> f64| near.iter().map(of).fold(0.0, f64::max);
            let slack = 1.0 + 1e-6;
            prop_assert!(drawn_w <= most(|row| row.peak_w) * slack + 1e-9, "{}\n{}", line, program);
            prop_assert!(regen_w <= most(|row| row.regen_w) * slack + 1e-9, "{}\n{}", line, program);
            largest = largest.max(drawn_w);
        }
        for row in &rows {
            planned = planned.max(row.peak_w);
        }
        prop_assert!(planned <= 8.0 * largest, "{} {}\n{}", planned, largest, program);
    }
}
