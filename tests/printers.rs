//! The language of 3D printers: each construct by a program worked by hand,
//! with the source of its meaning.

mod corners;
mod firmware;
mod heaters;
mod limits;
mod lines;
mod macros;
mod unknown;

use std::fmt::Write as _;
use std::io::Cursor;

use gwatt::interpret::Move;
use gwatt::machine::{ALL_AXES, AxisSet, Machine};
use gwatt::pipeline::{self, Failure, Options};
use insta::assert_snapshot;

use crate::machines::machine_from;

/// X Y Z E: 100 mm/s, 1000 mm/s², home at 0, homing at 10 mm/s; a nozzle heater of
/// 40 W, a bed of 200 W and a fan of 5 W.
fn machine(controller: &str) -> Machine {
    machine_with(controller, "")
}

/// That machine with more in its file.
fn machine_with(controller: &str, more: &str) -> Machine {
    let mut text = format!(
        "schema = 1\nname = \"test\"\ncontroller = \"{controller}\"\n[converter]\npeak_power_w = 1e5\n"
    );
    for axis in ["X", "Y", "Z", "E"] {
        let home = if axis == "E" {
            ""
        } else {
            "reference_mm = 0\nreference_mm_min = 600"
        };
        let _ = writeln!(
            text,
            "[axes.{axis}]\nrapid_mm_min = 6000\naccel_mm_s2 = 1000\nmass_kg = 10\n{home}"
        );
    }
    text.push_str(
        "[[load]]\non = [\"M104\", \"M109\"]\noff = \"M81\"\npower_w = 40\n\
         [[load]]\non = [\"M140\", \"M190\"]\noff = \"M81\"\npower_w = 200\n\
         [[load]]\non = \"M106\"\noff = [\"M107\", \"M81\"]\npower_w = 5\n",
    );
    text.push_str(more);
    load(&text)
}

fn load(text: &str) -> Machine {
    machine_from(text)
}

fn letters(set: AxisSet) -> String {
    set.iter()
        .map(|axis| ALL_AXES[axis].letter() as char)
        .collect()
}

fn shown(mv: &Move) -> String {
    let mut out = format!("{} {}", mv.line, mv.kind.name());
    for axis in mv.moving.iter() {
        let letter = ALL_AXES[axis].letter() as char;
        let (start, end) = (mv.start[axis], mv.end[axis]);
        let _ = write!(out, " {letter}{start:.3}>{end:.3}");
    }
    if !mv.unknown_start.is_empty() {
        let _ = write!(out, " from anywhere {}", letters(mv.unknown_start));
    }
    if mv.feed_mm_s.is_finite() {
        let _ = write!(out, " v{:.3}", mv.feed_mm_s);
    }
    if mv.path_accel_mm_s2.is_finite() {
        let _ = write!(out, " a{:.0}", mv.path_accel_mm_s2);
    }
    if mv.rapid_factor > 1.0 {
        let _ = write!(out, " raised {:.2}", mv.rapid_factor);
    }
    if mv.dwell_s > 0.0 {
        let _ = write!(out, " {} s", mv.dwell_s);
    }
    if mv.loads != 0 {
        let _ = write!(out, " loads {:03b}", mv.loads);
    }
    out
}

/// The moves of a program and its notes, or the messages of a refusal.
fn run(machine: &Machine, program: &str) -> String {
    let mut out = String::new();
    let result = pipeline::moves(
        Cursor::new(program.as_bytes()),
        machine,
        &Options::default(),
        &mut |mv, _| {
            out.push_str(&shown(mv));
            out.push('\n');
            Ok(())
        },
    );
    match result {
        Ok(notes) => {
            for note in notes {
                let _ = writeln!(out, "note {}", note.rule);
            }
            out
        }
        Err(Failure::Refused { diagnostics, .. }) => diagnostics
            .iter()
            .filter(|found| found.severity == gwatt::diagnostic::Severity::Error)
            .fold(String::new(), |mut out, found| {
                let _ = writeln!(out, "{}: {}", found.rule, found.message);
                out
            }),
        Err(_) => "another failure".to_owned(),
    }
}

fn marlin(program: &str) -> String {
    run(&machine("marlin"), program)
}

fn reprap(program: &str) -> String {
    run(&machine("reprap"), program)
}

fn klipper(program: &str) -> String {
    run(&machine("klipper"), program)
}

/// Marlin G90, M82, M83: G90 makes the extruder absolute too; RepRapFirmware:
/// only M82 and M83; Klipper (`gcode_move.py`): relative if either says so.
#[test]
fn the_extruder_has_a_mode_of_its_own() {
    let program = "M83\nG90\nG1 E5 F60\nG1 E5\nG91\nM82\nG1 E7\n";
    assert_snapshot!(marlin(program), @r"
    3 feed E0.000>5.000 v1.000
    4 feed v1.000
    7 feed E5.000>7.000 v1.000
    ");
    assert_snapshot!(reprap(program), @r"
    3 feed E0.000>5.000 v1.000
    4 feed E5.000>10.000 v1.000
    7 feed E10.000>7.000 v1.000
    ");
    assert_snapshot!(klipper(program), @r"
    3 feed E0.000>5.000 v1.000
    4 feed E5.000>10.000 v1.000
    7 feed E10.000>17.000 v1.000
    ");
}

/// Marlin G10, G11, M207, M208: E moves by itself and its number stays; a
/// second G10 does nothing. Default 3 mm at 45 mm/s.
#[test]
fn firmware_retracts() {
    assert_snapshot!(marlin(
        "G1 E10 F60\nG10\nG10\nG11\nM207 S2 F600 Z0.5\nM208 S0.25 F300\nG10 S1\nG11\nG1 E11\n"
    ), @r"
    1 feed E0.000>10.000 v1.000
    2 feed E10.000>7.000 v45.000
    4 feed E7.000>10.000 v45.000
    7 feed E10.000>8.000 v10.000
    7 feed Z0.000>0.500
    8 feed Z0.500>0.000
    8 feed E8.000>10.250 v5.000
    9 feed E10.250>11.250 v1.000
    note retract-default
    ");
    // Klipper, [firmware_retraction], in mm and mm/s.
    assert_snapshot!(klipper("SET_RETRACTION RETRACT_LENGTH=4 RETRACT_SPEED=30\nG10\nG11\n"), @r"
    2 feed E0.000>-4.000 v30.000
    3 feed E-4.000>0.000 v10.000
    ");
    // Duet, G10 with P: temperatures of a tool, no retract.
    assert_snapshot!(reprap("G10 P0 S200 R150\nG1 X1 F60\n"), @r"
    2 feed X0.000>1.000 v1.000
    note heaters
    ");
}

/// Marlin G28: from anywhere to the endstops, X and Y together; Klipper homes
/// one axis after the other; RepRapFirmware's homeall.g is the machine's own.
#[test]
fn homing_starts_anywhere() {
    assert_snapshot!(marlin("G92 X5\nG28 ; all\nG1 X10 F600\nG28 X Y\nG28 Z0\n"), @r"
    2 feed from anywhere XY v10.000
    2 feed from anywhere Z v10.000
    3 feed X0.000>10.000 v10.000
    4 feed from anywhere XY v10.000
    5 feed from anywhere Z v10.000
    ");
    assert_snapshot!(klipper("G28\n"), @r"
    1 feed from anywhere X v10.000 a1000
    1 feed from anywhere Y v10.000 a1000
    1 feed from anywhere Z v10.000 a1000
    ");
    assert_snapshot!(reprap("G28\n"), @"1 feed from anywhere XYZ v10.000");
    // Without a homing speed and place: full speed, and the next move too.
    let plain = load(
        "schema = 1\nname = \"t\"\ncontroller = \"marlin\"\n[converter]\npeak_power_w = 1e5\n\
         [axes.X]\nrapid_mm_min = 6000\naccel_mm_s2 = 1000\nmass_kg = 10\n",
    );
    assert_snapshot!(run(&plain, "G28\nG1 X10 F600\nG1 X20\n"), @r"
    1 feed from anywhere X
    2 feed from anywhere X v10.000
    3 feed X10.000>20.000 v10.000
    note home
    ");
}

/// Marlin G29, M600, T: only the firmware knows; every axis counts, and its
/// place is lost until an absolute move, or G92.
#[test]
fn unknown_moves_count_in_full() {
    assert_snapshot!(marlin("G29 P1 T\nG1 X10 F600\nG91\nG1 Y5\nM600\nG92 E0\nG90\nG1 E2\nT0\nT1\n"), @r"
    1 feed from anywhere XYZE
    2 feed from anywhere X v10.000
    4 feed Y0.000>5.000 v10.000
    5 feed from anywhere XYZE
    8 feed E0.000>2.000 v10.000
    10 feed from anywhere XYZE
    note unknown-moves
    note bed-levelling
    ");
    // An F of such a command may or may not stay in force.
    assert_snapshot!(marlin("G1 X1 F60\nG38.2 Z-5 F30\nG92 X1\nG1 X2\n"), @r"
    1 feed X0.000>1.000 v1.000
    2 feed from anywhere XYZE
    4 feed X1.000>2.000
    note unknown-moves
    note no-feed-yet
    ");
    // M206 shifts: only the next absolute move of that axis comes from anywhere.
    assert_snapshot!(marlin("M206 Z0.5\nG1 X1 F60\nG1 Z1\nG1 Z2\n"), @r"
    2 feed X0.000>1.000 v1.000
    3 feed from anywhere Z v1.000
    4 feed Z1.000>2.000 v1.000
    ");
    // RepRapFirmware: T0 runs files of the machine; G1 H1 ends at an endstop.
    assert_snapshot!(reprap("T0\nG1 H1 X-200 F600\nG1 H0 X1\n"), @r"
    1 feed from anywhere XYZE loads 111
    2 feed from anywhere XYZE loads 111
    3 feed from anywhere X v10.000 loads 111
    note macro-heaters
    note unknown-moves
    note macro-settings
    ");
}

/// Marlin M220: a percentage of all feeds, of G0 too; B and R keep it.
#[test]
fn the_feed_percentage_scales_feeds() {
    assert_snapshot!(marlin("G0 X10 F600\nM220 S50 B\nG0 X20\nG1 X30 F1200\nM220 S200\nG1 X40\nM220 R\nG1 X50\n"), @r"
    1 feed X0.000>10.000 v10.000
    3 feed X10.000>20.000 v5.000
    4 feed X20.000>30.000 v10.000
    6 feed X30.000>40.000 v40.000
    8 feed X40.000>50.000 v20.000
    ");
    assert_snapshot!(marlin("M220 S0\n"), @"printer-value: this value is out of range");
}

/// Marlin M221 and M200: filament moves more or less than E says. 1.75 mm:
/// 1/(π·0.875²) = 0.415752 mm for a mm³.
#[test]
fn flow_scales_the_extruder() {
    assert_snapshot!(marlin("M221 S50\nG1 X10 E10 F600\nG1 E12\nM221 S100\nG1 E13\nG92 E0\nM200 D1.75\nG1 E10\n"), @r"
    2 feed X0.000>10.000 E0.000>5.000 v10.000
    3 feed E5.000>6.000 v10.000
    5 feed E6.000>7.000 v10.000
    8 feed E7.000>11.158 v10.000
    ");
}

/// Klipper, `[gcode_move]`: modes, feed and offsets come back, the extruder's
/// place does not; MOVE=1 goes back too.
#[test]
fn klipper_states() {
    assert_snapshot!(klipper(
        "G1 X10 E5 F600\nSAVE_GCODE_STATE NAME=a\nG91\nM83\nG1 X5 E2 F1200\n\
         RESTORE_GCODE_STATE NAME=a MOVE=1 MOVE_SPEED=7\nG1 X11 E6\n"
    ), @r"
    1 feed X0.000>10.000 E0.000>5.000 v10.000 a1000
    5 feed X10.000>15.000 E5.000>7.000 v20.000 a1000
    6 feed X15.000>10.000 v7.000 a1000
    7 feed X10.000>11.000 E7.000>8.000 v10.000 a1000
    ");
    assert_snapshot!(klipper("RESTORE_GCODE_STATE NAME=b\n"), @"no-such-state: a state that was not saved");
    // RepRapFirmware, M120 and M121: modes and feed.
    assert_snapshot!(reprap("G1 X1 F60\nM120\nG91\nG1 X1 F120\nM121\nG1 X1\n"), @r"
    1 feed X0.000>1.000 v1.000
    4 feed X1.000>2.000 v2.000
    6 feed X2.000>1.000 v1.000
    ");
}

/// Marlin G60 and G61.
#[test]
fn kept_positions() {
    assert_snapshot!(marlin("G1 X10 Y5 E1 F600\nG60 S2\nG1 X20 Y9 E2\nG61 S2 X F1200\nG61 S2\n"), @r"
    1 feed X0.000>10.000 Y0.000>5.000 E0.000>1.000 v10.000
    3 feed X10.000>20.000 Y5.000>9.000 E1.000>2.000 v10.000
    4 feed X20.000>10.000 v20.000
    5 feed Y9.000>5.000 v10.000
    ");
    assert_snapshot!(marlin("G61 S1\n"), @"no-such-position: G61 to a position that G60 has not kept");
}

/// Marlin M92: what the program states is taken for true, but not two values.
#[test]
fn steps_per_unit() {
    assert_snapshot!(marlin("M92 X80 E415\nM92\nM92 X80\n"), @"note steps-per-unit");
    assert_snapshot!(marlin("M92 E415\nM92 E400\n"), @"steps-per-unit: a second scale for this axis: its real distances are not known");
}

/// Marlin M501: the machine file's limits again.
#[test]
fn stored_settings() {
    assert_snapshot!(marlin("M204 P100 T100\nM203 X5\nG1 X1 F600\nM501\nG1 X2\n"), @r"
    3 feed X0.000>1.000 v5.000 a100
    5 feed from anywhere X v10.000
    note stored-settings
    ");
}

/// Marlin `G2_G3.cpp`: an end next to the circle is reached by the circle of the
/// start and a straight line: centre (10, 0), radius 10, a quarter turn to
/// (10, 10), then up to (10, 12).
#[test]
fn arcs_with_an_end_beside_the_circle() {
    assert_snapshot!(marlin("G2 X10 Y12 I10 J0 E3 F600\n"), @r"
    1 arc X0.000>10.000 Y0.000>10.000 E0.000>3.000 v10.000
    1 feed Y10.000>12.000 v10.000
    note arc-end
    ");
    // From an unknown place: the feed in every direction.
    assert_snapshot!(marlin("G29\nG2 X10 Y10 I10 J0 F600\nG1 X11\n"), @r"
    1 feed from anywhere XYZE
    2 feed from anywhere XY v10.000
    3 feed X10.000>11.000 v10.000
    note unknown-moves
    note bed-levelling
    ");
}

/// The same wall in absolute numbers, in increments after G92, and with the
/// extruder set back: Marlin G90 to G92, M82, M83.
#[test]
fn twins_in_other_modes_move_alike() {
    let absolute = "G90\nM82\nG92 E0\nG1 F1800\nG0 X10 Y10 Z0.2\nG1 X50 E2\nG1 Y50 E4\nG3 X40 Y60 I-10 J0 E4.8\nG1 X10 E6.3\nG1 Y10 E8.8\nG1 E7.8\nG0 Z5\n";
    let relative = "G91\nM83\nG1 F1800\nG0 X10 Y10 Z0.2\nG1 X40 E2\nG1 Y40 E2\nG3 X-10 Y10 I-10 J0 E0.8\nG1 X-30 E1.5\nG1 Y-50 E2.5\nG1 E-1\nG0 Z4.8\n";
    let shifted = "G90\nM82\nG92 E100\nG1 F1800\nG0 X10 Y10 Z0.2\nG92 X0 Y0\nG1 X40 E102\nG1 Y40 E104\nG92 E0\nG3 X30 Y50 I-10 J0 E0.8\nG1 X0 E2.3\nG1 Y0 E4.8\nG1 E3.8\nG0 Z5\n";
    for controller in ["marlin", "reprap", "klipper"] {
        let machine = machine(controller);
        let lengths = |program: &str| {
            let mut out = Vec::new();
            let done = pipeline::moves(
                Cursor::new(program),
                &machine,
                &Options::default(),
                &mut |mv, _| {
                    let way = |axis: usize| ((mv.end[axis] - mv.start[axis]) * 1e6).round();
                    out.push((mv.kind.name(), [0, 1, 2, 9].map(way)));
                    Ok(())
                },
            );
            assert!(done.is_ok(), "{controller}: {program}");
            out
        };
        let expected = lengths(absolute);
        assert_eq!(expected.len(), 8, "{controller}");
        assert_eq!(lengths(relative), expected, "{controller}");
        assert_eq!(lengths(shifted), expected, "{controller}");
    }
}

/// No bytes make the reader panic, and every refusal has a reason.
#[test]
fn any_text_is_read() {
    let parts = [
        "G",
        "M",
        "T",
        "G28",
        "M117",
        "N1",
        "*",
        "*5",
        "\"",
        "{",
        "}",
        ";",
        "(",
        ")",
        " ",
        "X",
        "-",
        ".",
        "1e",
        "é",
        "SET_",
        "=",
        ":",
        "M104",
        "S",
        "9999999999999999999999999999999999999999999",
        "\t",
        "/",
        "%",
        "#",
        "[",
        "G10",
        "M92",
        "G61",
        "SAVE_GCODE_STATE NAME=",
    ];
    let machines = ["marlin", "reprap", "klipper"].map(machine);
    for first in parts {
        for second in parts {
            for third in ["", "X", "5", "\"", "*", "G1", " M106 S1"] {
                let line = format!("{first}{second}{third}\nG1 X1 F60\n");
                for machine in &machines {
                    let _ = run(machine, &line);
                }
            }
        }
    }
}

/// Complete print programs of the corpus are read; it is not part of the
/// project.
#[test]
fn real_programs_are_read() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/corpus/3dprint");
    if !folder.is_dir() {
        crate::evidence::cannot_run("the programs of others are not there");
        return;
    }
    crate::evidence::runs();
    let (machine, _) = Machine::load("printer").expect("built in");
    let mut folders = vec![folder];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).expect("readable").flatten() {
            let path = entry.path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            // A plasma cutter's program for Mach3.
            let name = path
                .file_name()
                .unwrap_or_default()
                .to_string_lossy()
                .into_owned();
            if name == "mach3.gcode" {
                continue;
            }
            let text = std::fs::read(&path).expect("readable");
            let result = pipeline::analyze(Cursor::new(text), &machine, &Options::default(), None);
            assert!(result.is_ok(), "{}", path.display());
        }
    }
}
