//! Random programs on machines of three to six axes: recorded next to planned.
//!
//! Ignored, since it needs LinuxCNC and minutes. Where that is missing, it says so and
//! passes. `GWATT_PROGRAMS` is the number of programs for each machine.

use super::recorder::{AxisLimits, is_installed, record};
use crate::rows::Rows;
use gwatt::machine::Machine;
use gwatt::pipeline::{Options, analyze};
use std::fmt::Write as _;
use std::io::Cursor;

use crate::machines::machine_from;

const MACHINES: [&str; 6] = ["XYZ", "XYZA", "XYZAC", "XYZUV", "XYZBW", "XYZABC"];
const PROGRAMS: usize = 50;
/// Cycles that LinuxCNC's task may take to wait at a word.
const WAIT_S: f64 = 0.03;

/// Numbers between 0 and 1, the same in each run.
pub struct Random(pub u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn of<T: Copy>(&mut self, list: &[T]) -> T {
        list[(self.next() * list.len() as f64) as usize]
    }

    fn either(&mut self, share: f64) -> bool {
        self.next() < share
    }
}

/// An axis with all that its power follows from.
pub struct Any {
    pub limits: AxisLimits,
    mass: f64,
    friction: f64,
    weight: f64,
}

impl Any {
    pub fn new(letter: char, random: &mut Random) -> Self {
        let rotary = "ABC".contains(letter);
        let weighs = "ZW".contains(letter);
        Self {
            limits: (
                letter,
                [
                    random.of(&[50.0, 80.0, 150.0, 300.0]),
                    random.of(&[300.0, 1000.0, 2000.0, 3000.0]),
                ],
            ),
            mass: random.of(if rotary {
                &[0.5, 3.0, 8.0]
            } else {
                &[50.0, 250.0, 400.0]
            }),
            friction: random.of(if rotary { &[2.0, 30.0] } else { &[20.0, 200.0] }),
            weight: if weighs {
                random.of(&[0.0, 100.0, -200.0])
            } else {
                0.0
            },
        }
    }

    pub fn table(&self) -> String {
        let Self {
            limits: (letter, [speed, accel]),
            mass,
            friction,
            weight,
        } = self;
        let speed = speed * 60.0;
        if "ABC".contains(*letter) {
            return format!(
                "[axes.{letter}]\nkind = \"rotary\"\nrapid_deg_min = {speed:?}\n\
                 accel_deg_s2 = {accel:?}\ninertia_kg_m2 = {mass:?}\nfriction_nm = {friction:?}\n"
            );
        }
        format!(
            "[axes.{letter}]\nkind = \"linear\"\nrapid_mm_min = {speed:?}\naccel_mm_s2 = {accel:?}\n\
             mass_kg = {mass:?}\ncoulomb_n = {friction:?}\ngravity_n = {weight:?}\n"
        )
    }

    /// Power drawn at a speed and an acceleration, in its own unit and s.
    fn power_w(&self, speed: f64, accel: f64) -> f64 {
        let si = if "ABC".contains(self.limits.0) {
            1_f64.to_radians()
        } else {
            1e-3
        };
        let friction = if speed == 0.0 {
            0.0
        } else {
            self.friction.copysign(speed)
        };
        (speed * si * (self.mass * accel * si + friction + self.weight)).max(0.0)
    }
}

/// The last word before a move, most often none.
fn word(random: &mut Random) -> &'static str {
    let words = [
        "M62 P0\n",
        "M8\n",
        "(LOG, x)\n",
        "M67 E0 Q1\n",
        "T1\n",
        "M73\n",
        "G97\n",
        "G54\n",
        "(a)\n",
        "M50\n",
        "G4 P0\n",
        "S500\n",
        "M9\n",
        "G64 P0.05\n",
        "G10 L2 P2 X1\n",
        "G52 X0\n",
    ];
    if random.either(0.2) {
        random.of(&words)
    } else {
        ""
    }
}

pub fn program(axes: &[Any], random: &mut Random) -> String {
    let modes = [
        "G64",
        "G64 P0.05",
        "G64 P0.02",
        "G64 P0.3",
        "G64 P0.05 Q0",
        "G64 P0.1 Q0.2",
        "G64 P1",
        "G61",
        "G61.1",
    ];
    let scale = random.of(&[0.03, 0.1, 0.3, 0.6]);
    let turns = random.of(&[0.2, 0.5, 0.9]);
    let mut text = format!("G21 G90 G17 G94 {}\n", random.of(&modes));
    let mut feed = random.of(&[1500.0, 3000.0, 6000.0, 15000.0]);
    let _ = writeln!(text, "F{feed}");
    let mut at = [0.0_f64; 2];
    for _ in 0..4 + (random.next() * 6.0) as usize {
        text += word(random);
        if random.either(0.15) {
            feed = random.of(&[1500.0, 3000.0, 6000.0, 15000.0]);
        }
        let rapid = random.either(0.3);
        let further = random.either(turns);
        if !rapid && random.either(0.25) {
            let radius = scale * (2.0 + 28.0 * random.next());
            let from = std::f64::consts::TAU * random.next();
            let sweep = random.of(&[-1.0, 1.0]) * (0.3 + 4.5 * random.next());
            let (sin, cos) = libm::sincos(from);
            let (end_sin, end_cos) = libm::sincos(from + sweep);
            let to = [
                at[0] + radius * (end_cos - cos),
                at[1] + radius * (end_sin - sin),
            ];
            let code = if sweep > 0.0 { "G3" } else { "G2" };
            let _ = write!(
                text,
                "{code} X{:.5} Y{:.5} I{:.5} J{:.5}",
                to[0],
                to[1],
                -radius * cos,
                -radius * sin
            );
            at = to.map(|value| (value * 1e5).round() / 1e5);
        } else {
            text += if rapid { "G0" } else { "G1" };
            let plane = !further || random.either(0.6);
            for (index, axis) in axes.iter().enumerate().take(3) {
                if plane && random.either(0.6) {
                    let to = (160.0 * scale * (random.next() - 0.5) * 1e3).round() / 1e3;
                    let _ = write!(text, " {}{to}", axis.limits.0);
                    if let Some(place) = at.get_mut(index) {
                        *place = to;
                    }
                }
            }
        }
        if further {
            for axis in axes.iter().skip(3) {
                if random.either(0.6) {
                    let to = 180.0 * scale * (random.next() - 0.5);
                    let _ = write!(text, " {}{to:.3}", axis.limits.0);
                }
            }
        }
        if !rapid {
            let _ = write!(text, " F{feed}");
        }
        text.push('\n');
    }
    text + "M2\n"
}

/// Time in motion and largest power of a recording.
pub fn recorded(axes: &[Any], rows: &[Vec<f64>]) -> Option<(f64, f64)> {
    let moves = |row: &Vec<f64>| row.iter().any(|speed| speed.abs() > 1e-9);
    let (first, last) = (rows.iter().position(moves)?, rows.iter().rposition(moves)?);
    let power_w = |at: &[Vec<f64>]| {
        let axis = |(index, axis): (usize, &Any)| {
            let accel = (at[2][index] - at[0][index]) / 0.002;
            axis.power_w(at[1][index], accel)
        };
        axes.iter().enumerate().map(axis).sum::<f64>()
    };
    let peak_w = rows.windows(3).map(power_w).fold(0.0, f64::max);
    Some(((last - first + 1) as f64 * 1e-3, peak_w))
}

/// Whether a recording is as planned; nothing where there is none.
fn compare(
    letters: &str,
    machine: &Machine,
    axes: &[Any],
    program: &str,
    rows: &[Vec<f64>],
) -> Option<bool> {
    let (recorded_s, recorded_w) = recorded(axes, rows)?;
    let mut rows = Rows::default();
    let input = Cursor::new(program.as_bytes());
    analyze(input, machine, &Options::default(), Some(&mut rows)).expect("a program");
    let planned_s: f64 = rows.0.iter().map(|row| row.duration_s).sum();
    let planned_w = rows
        .0
        .iter()
        .fold(0.0, |most: f64, row| most.max(row.peak_w));
    println!(
        "{letters:8} {recorded_s:8.3} s {:+7.2} %  {recorded_w:8.1} W {:+7.2} %",
        (planned_s / recorded_s - 1.0) * 100.0,
        (planned_w / recorded_w - 1.0) * 100.0
    );
    let off_s = planned_s - recorded_s;
    let slack_s = 0.01 * recorded_s + 0.005;
    let timed = (-slack_s - WAIT_S..=slack_s).contains(&off_s);
    Some(timed && recorded_w <= planned_w * 1.005)
}

#[test]
#[ignore = "runs LinuxCNC for minutes"]
fn recorded_random_programs_draw_no_more_than_planned() {
    if !is_installed() {
        crate::evidence::cannot_run("LinuxCNC is not installed");
        return;
    }
    crate::evidence::runs();
    let count = std::env::var("GWATT_PROGRAMS");
    let count = count
        .ok()
        .and_then(|count| count.parse().ok())
        .unwrap_or(PROGRAMS);
    let mut random = Random(0x2545_F491_4F6C_DD1D);
    let (mut seen, mut wrong) = (0, Vec::new());
    for letters in MACHINES {
        let axes: Vec<Any> = letters
            .chars()
            .map(|letter| Any::new(letter, &mut random))
            .collect();
        let tables: String = axes.iter().map(Any::table).collect();
        let text = format!(
            "schema = 1\nname = \"{letters}\"\ncontroller = \"linuxcnc\"\n\
             [converter]\npeak_power_w = 1e9\n[limits]\nmargin = 0.0\n{tables}"
        );
        let machine = machine_from(&text);
        let programs: Vec<String> = (0..count).map(|_| program(&axes, &mut random)).collect();
        let limits: Vec<AxisLimits> = axes.iter().map(|axis| axis.limits).collect();
        let mut left = programs;
        // A loaded host holds LinuxCNC's task up, which adds time.
        for speedup in [3, 1, 1] {
            let recordings = record(&limits, &left, speedup);
            let pairs = left.into_iter().zip(recordings);
            let (again, passed): (Vec<_>, Vec<_>) = pairs
                .map(|(program, rows)| {
                    let fits = compare(letters, &machine, &axes, &program, &rows);
                    (program, fits)
                })
                .partition(|(_, fits)| *fits != Some(true));
            seen += passed.len();
            left = again.into_iter().map(|(program, _)| program).collect();
            if left.is_empty() {
                break;
            }
        }
        wrong.extend(left);
    }
    println!("{seen} programs");
    assert!(wrong.is_empty(), "{wrong:#?}");
}
