//! Machines as their files describe them, and as they may be.

use std::fmt::Write as _;

use super::command::{Command, SIMULATED};
use super::drive::{Drive, Load, Loops};
use crate::random::Random;

/// An axis as it is described.
#[derive(Debug, Clone, Copy)]
pub struct Described {
    pub rapid_mm_min: f64,
    pub accel_mm_s2: f64,
    pub load: Load,
}

/// What a machine file says beyond masses and friction.
#[derive(Debug, Clone, Copy)]
pub struct Says {
    pub errors: bool,
    pub servo: bool,
    pub margin: f64,
}

/// A machine of X, Y and Z.
#[derive(Debug, Clone, Copy)]
pub struct Rig {
    pub controller: &'static str,
    pub peak_w: f64,
    pub base_w: f64,
    pub axes: [Described; SIMULATED],
    pub loops: [Loops; SIMULATED],
}

/// By what shares masses and friction are off.
pub const MASS_ERROR: f64 = 0.2;
pub const FRICTION_ERROR: f64 = 0.5;

impl Rig {
    /// Its file.
    pub fn toml(&self, says: Says) -> String {
        let mut text = format!(
            "schema = 1\nname = \"rig\"\ncontroller = \"{}\"\n[converter]\n\
             peak_power_w = {:?}\nbase_load_w = {:?}\n[limits]\nmargin = {:?}\n",
            self.controller, self.peak_w, self.base_w, says.margin
        );
        if says.errors {
            let _ = writeln!(
                text,
                "mass_error = {MASS_ERROR:?}\nfriction_error = {FRICTION_ERROR:?}"
            );
        }
        for (letter, (axis, loops)) in ["X", "Y", "Z"]
            .iter()
            .zip(self.axes.iter().zip(&self.loops))
        {
            let load = &axis.load;
            let _ = writeln!(
                text,
                "[axes.{letter}]\nrapid_mm_min = {:?}\naccel_mm_s2 = {:?}\nmass_kg = {:?}\n\
                 coulomb_n = {:?}\nviscous_n_s_m = {:?}\ngravity_n = {:?}\n\
                 efficiency = {:?}\ncopper_w_n2 = {:?}",
                axis.rapid_mm_min,
                axis.accel_mm_s2,
                load.mass,
                load.coulomb,
                load.viscous,
                load.gravity,
                load.efficiency,
                load.copper
            );
            if says.servo {
                let _ = writeln!(
                    text,
                    "position_gain_1_s = {:?}\nvelocity_bandwidth_hz = {:?}\n\
                     velocity_feedforward = {:?}\nacceleration_feedforward = {:?}",
                    loops.position_gain_1_s,
                    loops.velocity_bandwidth_hz,
                    loops.velocity_feedforward,
                    loops.acceleration_feedforward
                );
                if loops.velocity_integral_time_s > 0.0 {
                    let time_s = loops.velocity_integral_time_s;
                    let _ = writeln!(text, "velocity_integral_time_s = {time_s:?}");
                }
            }
        }
        text
    }

    /// The most that one machine within the errors draws, W.
    pub fn peak_w(&self, command: &Command, random: &mut Random) -> f64 {
        let mut share = |error: f64| match random.below(3) {
            0 => 1.0 - error,
            1 => 1.0 + error,
            _ => random.within(1.0 - error, 1.0 + error),
        };
        let mut drives = [0, 1, 2].map(|axis| {
            let own = &self.axes[axis].load;
            let (mass, friction) = (share(MASS_ERROR), share(FRICTION_ERROR));
            let load = Load {
                mass: own.mass * mass,
                coulomb: own.coulomb * friction,
                viscous: own.viscous * friction,
                ..*own
            };
            (Drive::new(self.loops[axis], own.mass, load), load)
        });
        let mut peak_w = 0.0_f64;
        for three in command.wanted.windows(3).step_by(2) {
            let mut drawn_w = self.base_w;
            for (axis, (drive, load)) in drives.iter_mut().enumerate() {
                let [v, force] = drive.now(three[0][axis]);
                drawn_w += load.power_w(v, force).max(0.0);
                let wanted = [0, 1, 2].map(|at: usize| three[at][axis]);
                drive.step(wanted, 2.0 * command.step_s);
            }
            peak_w = peak_w.max(drawn_w);
        }
        peak_w
    }
}

const fn loops(gain: f64, hz: f64, integral_s: f64, forward: [f64; 2]) -> Loops {
    Loops {
        position_gain_1_s: gain,
        velocity_bandwidth_hz: hz,
        velocity_integral_time_s: integral_s,
        velocity_feedforward: forward[0],
        acceleration_feedforward: forward[1],
    }
}

/// The ways in which drives are set: with their names, by axis.
pub const SETTINGS: [(&str, [Loops; SIMULATED]); 5] = [
    (
        "no feedforward",
        [loops(40.0, 40.0, 0.0, [0.0; 2]); SIMULATED],
    ),
    (
        "feedforward",
        [loops(40.0, 40.0, 0.0, [1.0, 0.0]); SIMULATED],
    ),
    (
        "PI, feedforward",
        [loops(30.0, 50.0, 0.02, [1.0, 0.0]); SIMULATED],
    ),
    (
        "both fed forward",
        [loops(30.0, 30.0, 0.02, [1.0; 2]); SIMULATED],
    ),
    (
        "axes that differ",
        [
            loops(40.0, 60.0, 0.0, [0.0; 2]),
            loops(30.0, 40.0, 0.0, [0.0; 2]),
            loops(30.0, 30.0, 0.0, [0.0; 2]),
        ],
    ),
];

/// Drives set at random, from loops that swing to slow ones; each axis has its own
/// bandwidth every other time.
pub fn any_loops(random: &mut Random) -> [Loops; SIMULATED] {
    let share = |random: &mut Random| match random.below(3) {
        0 => 0.0,
        1 => 1.0,
        _ => random.within(0.0, 1.0),
    };
    let gain = random.scale(15.0, 60.0);
    let forward = [share(random), share(random)];
    let integral = random.once_in(2).then(|| random.scale(6.0, 20.0));
    let alike = random.once_in(2);
    let ratio = random.scale(4.0, 12.0);
    [0, 1, 2].map(|_| {
        let own = if alike { 1.0 } else { random.scale(0.7, 1.4) };
        let rate = gain * ratio * own;
        let integral_s = integral.map_or(0.0, |times| times / rate);
        loops(gain, rate / std::f64::consts::TAU, integral_s, forward)
    })
}

fn axis(rapid_mm_min: f64, accel_mm_s2: f64, mass: f64, friction: [f64; 2]) -> Described {
    let load = Load {
        mass,
        coulomb: friction[0],
        viscous: friction[1],
        gravity: 0.0,
        efficiency: 0.85,
        copper: 0.0,
    };
    Described {
        rapid_mm_min,
        accel_mm_s2,
        load,
    }
}

/// What holds the weight of an axis, and loses power.
fn heavy(mut axis: Described, gravity: f64, copper: f64) -> Described {
    axis.load.gravity = gravity;
    axis.load.copper = copper;
    axis
}

/// The machines, without their drives' settings: a bench mill under LinuxCNC, a
/// machining centre whose blocks stop at their ends, and a router under grbl, which
/// passes corners with steps of speed.
pub fn rigs() -> [Rig; 3] {
    let loops = SETTINGS[0].1;
    let mill = Rig {
        controller: "linuxcnc",
        peak_w: 130.0,
        base_w: 10.0,
        axes: [
            axis(9000.0, 2000.0, 250.0, [150.0, 100.0]),
            axis(9000.0, 2000.0, 280.0, [170.0, 0.0]),
            heavy(axis(6000.0, 1500.0, 150.0, [120.0, 0.0]), 100.0, 0.0),
        ],
        loops,
    };
    let centre = Rig {
        controller: "iso",
        peak_w: 2000.0,
        base_w: 100.0,
        axes: [
            heavy(axis(36000.0, 5000.0, 700.0, [500.0, 300.0]), 0.0, 3e-6),
            heavy(axis(30000.0, 5000.0, 600.0, [400.0, 0.0]), 0.0, 3e-6),
            heavy(axis(24000.0, 4000.0, 400.0, [300.0, 200.0]), 600.0, 3e-6),
        ],
        loops,
    };
    let router = Rig {
        controller: "grbl",
        peak_w: 40.0,
        base_w: 5.0,
        axes: [
            axis(8000.0, 1000.0, 60.0, [40.0, 20.0]),
            axis(8000.0, 1000.0, 80.0, [50.0, 0.0]),
            heavy(axis(4000.0, 800.0, 30.0, [30.0, 0.0]), 50.0, 0.0),
        ],
        loops,
    };
    [mill, centre, router]
}

/// A program of rapids, lines, arcs and zigzags near the origin.
pub fn program(random: &mut Random, blocks: usize) -> String {
    let mut text = String::from("G21 G90 G17 G94\nG1 F3000\n");
    let (mut x, mut y) = (0.0, 0.0);
    for _ in 0..blocks {
        let length = random.scale(0.5, 50.0);
        let feed = random.scale(2500.0, 15000.0);
        let angle = random.within(0.0, std::f64::consts::TAU);
        let (dx, dy) = (length * libm::cos(angle), length * libm::sin(angle));
        match random.below(6) {
            0 => {
                let z = random.within(-30.0, 30.0);
                let _ = writeln!(text, "G0 X{:.3} Y{:.3} Z{z:.3}", x + dx, y + dy);
            }
            1 => {
                let _ = writeln!(
                    text,
                    "G2 X{:.3} Y{:.3} I{:.3} J{:.3} F{feed:.0}",
                    x + dx,
                    y + dy,
                    0.5 * dx,
                    0.5 * dy
                );
            }
            2 => {
                // A curve of chords, passed at speed, and from its end on.
                let turn = random.within(-0.3, 0.3);
                let (mut at_x, mut at_y) = (x, y);
                for chord in 1..=10 {
                    let heading = angle + turn * f64::from(chord);
                    at_x += 3.0 * libm::cos(heading);
                    at_y += 3.0 * libm::sin(heading);
                    let _ = writeln!(text, "G1 X{at_x:.3} Y{at_y:.3} F{feed:.0}");
                }
                let _ = writeln!(text, "G1 X{:.3} Y{:.3}", x + dx, y + dy);
            }
            3 => {
                // There and back in X and Y by turns.
                for turn in 1..=6 {
                    let (far, near) = if turn % 2 == 0 { (dx, dy) } else { (-dy, dx) };
                    let _ = writeln!(
                        text,
                        "G1 X{:.3} Y{:.3} F{feed:.0}",
                        x + 0.1 * far * f64::from(turn),
                        y + 0.1 * near * f64::from(turn)
                    );
                }
                let _ = writeln!(text, "G1 X{:.3} Y{:.3}", x + dx, y + dy);
            }
            _ => {
                let _ = writeln!(text, "G1 X{:.3} Y{:.3} F{feed:.0}", x + dx, y + dy);
            }
        }
        // What is written is where it stands.
        let written = |value: f64| format!("{value:.3}").parse().unwrap_or(value);
        (x, y) = (written(x + dx), written(y + dy));
    }
    text + "M2\n"
}
