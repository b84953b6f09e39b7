//! Plans against LinuxCNC's own planner, run without a display.
//!
//! Ignored, since it needs LinuxCNC and minutes:
//! `cargo test --test main recorded -- --ignored --nocapture`. Where LinuxCNC or
//! the scripts that run it are missing, it says so and passes.

use super::{machine, plan_elements, total_s};
use gwatt::plan::State;
use gwatt::plan::lookahead::{Element, Piece, Planned};
use std::collections::HashMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

const SPEED_MM_S: f64 = 200.0;
const ACCEL_MM_S2: f64 = 1000.0;
const MASS_KG: [f64; 3] = [100.0, 80.0, 120.0];
const COULOMB_N: f64 = 50.0;
/// LinuxCNC may start too slowly on a loaded host.
const TRIES: usize = 3;
/// Chords of a ring; far more, and the blocks are held up by the task that feeds
/// the planner one block a millisecond.
const PIECES: [usize; 3] = [60, 150, 200];

/// A point in time: velocity and acceleration of X, Y and Z.
type Point = ([f64; 3], [f64; 3]);

fn power_w(point: &Point) -> f64 {
    let (v, a) = point;
    let axis = |i: usize| v[i] * 1e-3 * (MASS_KG[i] * a[i] * 1e-3 + COULOMB_N * v[i].signum());
    (0..3).map(|i| axis(i).max(0.0)).sum()
}

/// Where a piece of the plan is at `state` of its profile.
fn point(piece: &Planned<u64>, element: &Element<u64>, state: State) -> Point {
    let (v, a) = (state.velocity_mm_s, state.accel_mm_s2);
    let (mut along, mut across) = ([0.0; 3], [0.0; 3]);
    match piece.piece {
        Piece::Joined { direction } => along.copy_from_slice(&direction[..3]),
        Piece::Blend(blend) => {
            let angle = (state.position_mm - blend.lead_mm).max(0.0) / blend.radius_mm;
            let (sin, cos) = libm::sincos(angle);
            let turns = f64::from(state.position_mm >= blend.lead_mm);
            for i in 0..3 {
                let (t, n) = (blend.tangent[i], blend.normal[i]);
                along[i] = cos * t + sin * n;
                across[i] = turns * (cos * n - sin * t) / blend.radius_mm;
            }
        }
        Piece::Along { from_mm, .. } => {
            along.copy_from_slice(&element.start[..3]);
            if let Some(curve) = &element.curve {
                let rate = curve.sweep_rad / element.length_mm;
                let (sin, cos) = libm::sincos(rate * (from_mm + state.position_mm));
                let [first, second] = curve.plane;
                let (x, y) = (along[first], along[second]);
                (along[first], along[second]) = (x * cos - y * sin, x * sin + y * cos);
                (across[first], across[second]) = (-along[second] * rate, along[first] * rate);
            }
        }
    }
    let accel = |i: usize| a * along[i] + v * v * across[i];
    ([0, 1, 2].map(|i| v * along[i]), [0, 1, 2].map(accel))
}

/// What a run comes to: peak power, top path speed per line, largest
/// acceleration of an axis.
#[derive(Default)]
struct Figures {
    total_s: f64,
    peak_w: f64,
    accel_mm_s2: f64,
    tops: HashMap<u64, f64>,
}

impl Figures {
    fn take(&mut self, line: u64, point: &Point) {
        self.peak_w = self.peak_w.max(power_w(point));
        let speed = point.0.iter().map(|v| v * v).sum::<f64>().sqrt();
        let top = self.tops.entry(line).or_default();
        *top = top.max(speed);
        for a in point.1 {
            self.accel_mm_s2 = self.accel_mm_s2.max(a.abs());
        }
    }

    fn planned(program: &str) -> Self {
        let machine = machine("linuxcnc", SPEED_MM_S, ACCEL_MM_S2);
        let (planned, elements) = plan_elements(&machine, program.as_bytes());
        let mut figures = Self {
            total_s: total_s(&planned),
            ..Self::default()
        };
        for piece in &planned.0 {
            for phase in &piece.profile().phases {
                for step in 0..=32 {
                    let mut state = phase.state_at(phase.duration_s * f64::from(step) / 32.0);
                    state.accel_mm_s2 = phase.accel_mm_s2;
                    figures.take(piece.tag, &point(piece, &elements[&piece.tag], state));
                }
            }
        }
        figures
    }

    /// Of a recording, one row a millisecond.
    fn recorded(csv: &str) -> Self {
        let rows: Vec<Vec<f64>> = csv
            .lines()
            .skip(1)
            .map(|row| {
                row.split(',')
                    .filter_map(|cell| cell.parse().ok())
                    .collect()
            })
            .collect();
        let speed = |row: &[f64]| row[7..10].iter().map(|v| v * v).sum::<f64>().sqrt();
        let moves = |row: &&Vec<f64>| speed(row) > 1e-9;
        let dwells = rows.iter().position(|row| speed(row) > 1e-9).unwrap_or(0);
        let last = rows.len() - rows.iter().rev().position(|row| moves(&row)).unwrap_or(0);
        let mut figures = Self {
            total_s: (last - dwells) as f64 * 0.001,
            ..Self::default()
        };
        for at in rows.windows(3) {
            let v = [at[1][7], at[1][8], at[1][9]];
            let a = [7, 8, 9].map(|i| (at[2][i] - at[0][i]) / 0.002);
            figures.take(at[1][1] as u64, &(v, a));
        }
        figures
    }
}

fn shared() -> PathBuf {
    let sibling = concat!(env!("CARGO_MANIFEST_DIR"), "/../shared");
    PathBuf::from(std::env::var("GWATT_SHARED").unwrap_or_else(|_| sibling.to_owned()))
}

/// Programs of our own: chords, a path in space, arcs and corners.
fn own() -> Vec<(String, String)> {
    let mut programs = Vec::new();
    for count in PIECES {
        for mode in ["G61", "G64", "G64 P0.01 Q0", "G64 P0.05"] {
            let mut text = format!("G21 G90 G17 G94 {mode}\nG0 X20 Y0\nG1 F4800\n");
            for i in 1..=count {
                let angle = std::f64::consts::TAU * i as f64 / count as f64;
                let (sin, cos) = libm::sincos(angle);
                let z = 2.0 * libm::sin(3.0 * angle);
                let _ = writeln!(text, "X{:.4} Y{:.4} Z{z:.4}", 20.0 * cos, 20.0 * sin);
            }
            programs.push((format!("ring of {count}, {mode}"), text + "M2\n"));
        }
    }
    for mode in ["G61", "G64", "G64 P0.05", "G64 P0.5"] {
        let text = format!(
            "G21 G90 G17 G94 {mode}\nG0 X10 Y0\nG1 X40 F4800\nG3 X50 Y12 R14\nG1 Y40\nG2 X30 Y50 R15\n\
             G1 X10 Y45\nG3 X0 Y30 R12\nG2 X5 Y10 R20\nG1 X10 Y0\nG0 Z5\nG0 X0\nM2\n"
        );
        programs.push((format!("contour, {mode}"), text.clone()));
        let text = text.replace("G1 Y40", "M8\nG1 Y40\nM3 S500\nS600");
        let text = text
            .replace("G3 X0", "M62 P0\nG3 X0")
            .replace("G1 X10 Y0", "M9\nG1 X10 Y0");
        programs.push((format!("words, {mode}"), text));
    }
    programs
}

fn record(shared: &Path, folder: &Path, name: &str, program: &str) -> Option<String> {
    let (source, csv) = (folder.join("program.ngc"), folder.join("out.csv"));
    std::fs::write(&source, program).unwrap();
    for _ in 0..TRIES {
        // The recording of another program is none of this one.
        let _ = std::fs::remove_file(&csv);
        // What LinuxCNC's task waits for at words it does not wait for any faster.
        let speedup = if name.starts_with("words") { 2 } else { 10 };
        let status = Command::new(shared.join("tools/linuxcnc/simrun.sh"))
            .args([&source, &csv])
            .arg(format!("SPEEDUP={speedup}"))
            .status()
            .ok()?;
        if status.success() {
            return std::fs::read_to_string(csv).ok();
        }
        println!("{name}: LinuxCNC failed");
    }
    None
}

#[test]
#[ignore = "runs LinuxCNC for minutes"]
fn plans_are_what_linuxcnc_does() {
    let shared = shared();
    let mut programs = own();
    let folder = shared.join("tools/linuxcnc/programs");
    for entry in std::fs::read_dir(&folder).into_iter().flatten().flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        // Those that set limits through HAL pins need a file of their own.
        if !name.starts_with("acc_") {
            programs.push((name, std::fs::read_to_string(entry.path()).unwrap()));
        }
    }
    programs.sort();
    let installed = Command::new("sh")
        .args(["-c", "command -v linuxcnc"])
        .output()
        .is_ok_and(|output| output.status.success());
    if !installed || !folder.is_dir() {
        crate::evidence::cannot_run("LinuxCNC is not installed");
        return;
    }
    crate::evidence::runs();
    let scratch = tempfile::tempdir().unwrap();
    let mut wrong = Vec::new();
    for (name, program) in &programs {
        let Some(csv) = record(&shared, scratch.path(), name, program) else {
            println!("{name}: no recording");
            wrong.push(name);
            continue;
        };
        let (plan, run) = (Figures::planned(program), Figures::recorded(&csv));
        let time = plan.total_s / run.total_s - 1.0;
        let power = run.peak_w / plan.peak_w - 1.0;
        let accel = run.accel_mm_s2 / plan.accel_mm_s2 - 1.0;
        let speeds = plan.tops.iter().filter_map(|(line, top)| {
            let recorded = run.tops.get(line)?;
            Some((recorded / top - 1.0).abs())
        });
        let speed = speeds.fold(0.0, f64::max);
        println!(
            "{name:28} {:8.3} s {:+6.2} %  power {:+6.2} %  speed {:5.2} %  accel {:+6.2} %",
            run.total_s,
            time * 100.0,
            power * 100.0,
            speed * 100.0,
            accel * 100.0
        );
        let blends = program.contains("G64");
        if time.abs() > if blends { 0.02 } else { 0.01 } || power > 0.02 {
            wrong.push(name);
        }
    }
    assert!(wrong.is_empty(), "{wrong:?}");
}
