//! Moves that are followed without the planner: they come out as by way of it.

use std::fmt::Write as _;

use gwatt::interpret::{Diagnostics, Effects, Facts, Interpreter, Move, Reading, Step};
use gwatt::machine::{CornerRule, Machine, builtin_controller};
use gwatt::power::{Assessment, Assessor, Certificate, Want};
use gwatt::syntax::{Block, scan_line};
use proptest::prelude::*;

use super::machine;
use crate::machines::machine_from;

/// What is known of each move, in order. Peaks up to the floor are of no interest.
pub(super) fn judged(
    machine: &Machine,
    program: &str,
    floor_w: f64,
    accel: bool,
) -> Vec<(u64, Assessment)> {
    let want = Want {
        energy: false,
        floor_w,
        regen_floor_w: floor_w,
        accel,
    };
    judged_for(machine, program, want)
}

/// The same for what is wanted of it.
pub(super) fn judged_for(machine: &Machine, program: &str, want: Want) -> Vec<(u64, Assessment)> {
    let reading = Reading::default();
    let mut interpreter = Interpreter::new(machine, &reading);
    let mut assessor = Assessor::new(machine, None, want);
    let mut found = Vec::new();
    let mut keep = |mv: &Move, judged: &Assessment, _: &[u8]| found.push((mv.line, *judged));
    let (mut block, mut steps) = (Block::default(), Vec::new());
    let (mut facts, mut said) = (Facts::default(), Diagnostics::default());
    for (number, line) in (1..).zip(program.split_inclusive('\n')) {
        let line = line.as_bytes();
        scan_line(line, true, &mut block);
        steps.clear();
        interpreter.execute(
            number,
            line,
            &mut block,
            Effects::new(&mut steps, &mut facts, &mut said),
        );
        for step in &steps {
            match step {
                Step::Move(mv) => assessor.push(mv, line, &mut keep),
                Step::Action(action) => assessor.act(action, &mut keep),
            }
        }
    }
    assessor.finish(&mut keep);
    found
}

/// The share of moves that the planner was not asked about, if all else is alike.
fn glided(machine: &Machine, program: &str, floor_w: f64) -> f64 {
    let quick = judged(machine, program, floor_w, false);
    let slow = judged(machine, program, floor_w, true);
    assert_eq!(quick.len(), slow.len());
    let mut gliding = 0;
    let after = quick.iter().skip(1).map(|(_, next)| Some(next.certificate));
    let after = after.chain([None]);
    for (((line, quick), (other, slow)), next) in quick.iter().zip(&slow).zip(after) {
        assert_eq!(line, other);
        gliding += usize::from(quick.accel_mm_s2 == 0.0 && slow.accel_mm_s2 > 0.0);
        // The sums by which a controller's blocks are looked ahead begin elsewhere:
        // their last digits differ, and a ramp of that height has a peak.
        let times = |judged: &Assessment| {
            let top = judged.top_speed_mm_s;
            [judged.duration_s, judged.fastest_s, judged.speed_mm_s, top]
        };
        // A peak that nobody wants may be anything up to the floor.
        let peaks = |judged: &Assessment| {
            let demand = &judged.demand;
            [demand.peak_w, demand.regen_w].map(|peak_w| peak_w.max(floor_w))
        };
        let found = [quick, slow].map(|judged| (times(judged), peaks(judged)));
        let [(times, peaks), (slow_times, slow_peaks)] = found;
        // The planner may hold a line for longer than braking before a doubt takes.
        let held = slow.certificate == Certificate::Robust && next == Some(Certificate::Robust);
        let kind = |judged: &Assessment| {
            let certificate = (!held).then_some(judged.certificate);
            (certificate, judged.blended, judged.joined)
        };
        let alike = |(a, b): (f64, f64)| (a - b).abs() <= 1e-9 * b.abs();
        assert!(
            times.into_iter().zip(slow_times).all(alike)
                && (times != slow_times || peaks.into_iter().zip(slow_peaks).all(alike))
                && kind(quick) == kind(slow),
            "line {line}: {found:?}, {:?} in\n{program}",
            [quick, slow].map(kind)
        );
    }
    gliding as f64 / quick.len() as f64
}

/// grbl, the same with a low limit along the path, a control with a permitted
/// step of speed that sees few blocks, and `LinuxCNC`.
fn machines() -> Vec<Machine> {
    let grbl = machine("grbl", 100.0, 1000.0);
    let mut other = grbl.clone();
    let mut step_mm_s = [f64::INFINITY; gwatt::machine::AXES];
    step_mm_s[..3].copy_from_slice(&[4.0, 6.0, 2.0]);
    let rules = builtin_controller("grbl").unwrap().planner.look_ahead;
    let mut rules = rules.unwrap();
    let mut slow = grbl.clone();
    rules.path_accel_mm_s2 = 250.0;
    slow.controller.planner.look_ahead = Some(rules);
    rules.path_accel_mm_s2 = f64::INFINITY;
    rules.blocks = Some(5);
    rules.corner = CornerRule::SpeedStep {
        step_mm_s,
        same_kind_only: false,
    };
    other.controller.planner.look_ahead = Some(rules);
    vec![grbl, slow, other, machine("linuxcnc", 100.0, 1000.0)]
}

/// Printers; their extruder bears 40 mm/s.
fn printers() -> [Machine; 3] {
    ["marlin", "klipper", "reprap"].map(|controller| {
        let mut text = format!(
            "schema = 1\nname = \"test\"\ncontroller = \"{controller}\"\n\
             [converter]\npeak_power_w = 1e9\n"
        );
        let axes = [
            ("X", 200, 3000),
            ("Y", 200, 2500),
            ("Z", 60, 800),
            ("E", 40, 2000),
        ];
        for (axis, speed, accel) in axes {
            let _ = write!(
                text,
                "[axes.{axis}]\nkind = \"linear\"\nrapid_mm_min = {}\naccel_mm_s2 = {accel}\n\
                 mass_kg = 4\ncoulomb_n = 5\n",
                speed * 60
            );
        }
        machine_from(&text)
    })
}

/// A finishing pass: an arch of lines of 0.5 mm at 40 mm/s.
fn pass() -> String {
    let mut text = "G21 G90 G94\nG0 X0 Y0 Z0\nF2400\n".to_owned();
    for i in 1..200 {
        let x = 0.5 * f64::from(i);
        let _ = writeln!(text, "G1 X{x} Z{:.4}", 5.0 * libm::sin(x * 0.03));
    }
    text
}

#[test]
fn a_finishing_pass_glides() {
    for machine in machines() {
        let share = glided(&machine, &pass(), 1e9);
        // LinuxCNC plans again over few lines alone: its planner is asked about each.
        let planned = machine.controller.name == "linuxcnc";
        let expected = if planned { 0.0..=0.0 } else { 0.8..=1.0 };
        assert!(expected.contains(&share), "{share}");
    }
}

#[test]
fn a_wall_of_a_print_glides() {
    let mut text = "G21 G90 M83\nG28\nG0 X100 Y0 Z0.2\nG1 F2400\n".to_owned();
    for i in 1..400 {
        let (sin, cos) = libm::sincos(f64::from(i) * 0.01);
        let _ = writeln!(text, "G1 X{:.4} Y{:.4} E0.033", 100.0 * cos, 100.0 * sin);
    }
    for machine in printers() {
        let share = glided(&machine, &text, 1e9);
        // Moves that wait may get other corners on RepRapFirmware.
        let waits = machine.controller.name == "reprap";
        let expected = if waits { 0.0..=0.0 } else { 0.7..=1.0 };
        let name = &machine.controller.name;
        assert!(expected.contains(&share), "{share} {name}");
    }
}

#[test]
fn peaks_of_interest_are_looked_at() {
    // 100 kg at 40 mm/s and at rest ask for nothing; at 1000 mm/s² for some watts.
    let machine = machines().swap_remove(0);
    assert_eq!(glided(&machine, &pass(), -1.0), 0.0);
}

/// Lines of a program.
fn any_lines() -> impl Strategy<Value = Vec<String>> {
    let step = || (-1.0..1.0_f64, -1.0..1.0_f64);
    // Onward, with little or much of a turn, short or long, and no two alike.
    let onward = (0.05..0.8_f64, step(), -3..0_i32, 1..30_u32);
    let onward = onward.prop_map(|(x, (y, z), bend, times)| {
        let bend = libm::pow(10.0, f64::from(bend));
        let line = |i| {
            let x = x * (1.0 + 0.2 * libm::sin(f64::from(i) + y));
            format!("G1 X{x:.6} Y{:.4} Z{:.4}", bend * y, bend * z)
        };
        (0..times).map(line).collect()
    });
    let other = prop_oneof![
        4 => (1.0..30.0_f64).prop_map(|x| format!("G1 X{x:.6}")),
        2 => step().prop_map(|(x, y)| format!("G1 X{x:.6} Y{y:.6}")),
        2 => (300..5000_u32).prop_map(|feed| format!("F{feed}")),
        1 => (0.1..2.0_f64).prop_map(|r| format!("G2 X{r:.6} Y{r:.6} I{r:.6}")),
        1 => step().prop_map(|(x, z)| format!("G0 X{x:.6} Z{z:.6}")),
        1 => Just("G4 P0.1".to_owned()),
        1 => Just("M8".to_owned()),
        1 => Just("M62 P0".to_owned()),
        1 => Just("G61.1".to_owned()),
        1 => Just("G64".to_owned()),
        1 => (1..60_u32).prop_map(|p| format!("G64 P{}", 0.001 * f64::from(p))),
        1 => Just("G64 P0.02 Q0.01".to_owned()),
        1 => Just("G61".to_owned()),
        1 => Just("G1 X0".to_owned()),
    ];
    prop_oneof![
        3 => onward,
        2 => other.prop_map(|line| vec![line]),
    ]
}

/// The same as a print: most lines extrude, more or less.
fn any_print() -> impl Strategy<Value = Vec<String>> {
    let known = |line: &str| !["M", "G6", "G4"].iter().any(|word| line.starts_with(word));
    (any_lines(), 0.0..0.2_f64, 0..4_u32).prop_map(move |(lines, e, kind)| {
        let lines = lines.into_iter().filter(|line| known(line)).zip(0..);
        let extrude = |(line, i): (String, u32)| {
            let e = e * (1.0 + 0.3 * libm::sin(f64::from(i)));
            match kind {
                _ if !line.starts_with("G1") => line,
                0 => line,
                1 => format!("{line} E{:.6}", -e),
                _ => format!("{line} E{e:.6}"),
            }
        };
        lines.map(extrude).collect()
    })
}

proptest! {
    #[test]
    fn prints_come_out_alike(
        lines in prop::collection::vec(any_print(), 1..25),
        feed in prop_oneof![600..900_u32, 1500..9000_u32],
        floor_w in prop_oneof![Just(1e9), 0.0..8.0_f64],
    ) {
        let text = format!("G21 G90 M83\nG28\nG91\nG1 F{feed}\n{}\n", lines.concat().join("\n"));
        for machine in printers() {
            glided(&machine, &text, floor_w);
        }
    }

    #[test]
    fn programs_come_out_alike(
        lines in prop::collection::vec(any_lines(), 1..25),
        feed in prop_oneof![600..900_u32, 1500..6000_u32],
        floor_w in prop_oneof![Just(1e9), 0.0..8.0_f64],
    ) {
        let text = format!("G21 G91 G94 G64\nF{feed}\n{}\n", lines.concat().join("\n"));
        for machine in machines() {
            glided(&machine, &text, floor_w);
        }
    }
}
