//! Random axes, as TOML.

use std::f64::consts::{PI, TAU};
use std::fmt::Write as _;

use crate::random::Random;

/// How the axes' motion is limited.
#[derive(Clone, Copy, PartialEq)]
pub enum Motion {
    Plain,
    Jerk,
    Curve,
    Both,
}

/// An axis at the load; its unit of motion is mm or degrees, everything else SI.
struct Load {
    turns: bool,
    /// m per mm, or rad per degree.
    unit: f64,
    speed: f64,
    accel: f64,
    /// Mass, Coulomb and viscous friction, weight, copper loss.
    values: [f64; 5],
    /// Lead in mm and ratio of the gear, where it is given by its motor.
    motor: Option<[f64; 2]>,
}

/// A value that is zero once in so many times.
fn sometimes(random: &mut Random, times: usize, scale: f64, [from, to]: [f64; 2]) -> f64 {
    if random.once_in(times) {
        0.0
    } else {
        scale * random.within(from, to)
    }
}

impl Load {
    fn any(random: &mut Random, turns: bool) -> Self {
        let unit = if turns { PI / 180.0 } else { 1e-3 };
        let speed = random.scale(40.0, 900.0);
        let accel = random.scale(300.0, 9000.0);
        let masses = if turns { [0.05, 20.0] } else { [1.0, 800.0] };
        let mass = random.scale(masses[0], masses[1]);
        let force = mass * accel * unit;
        let coulomb = sometimes(random, 3, force, [0.0, 0.6]);
        let viscous = sometimes(random, 2, force / (speed * unit), [0.0, 0.4]);
        let gravity = sometimes(random, 2, force, [-0.8, 0.8]);
        let copper = sometimes(random, 2, speed * unit / force, [0.0, 0.3]);
        let at_motor = !turns && random.once_in(4);
        let lead_mm = random.scale(5.0, 40.0).round();
        let gear = if random.once_in(2) { 1.0 } else { 2.0 };
        Self {
            turns,
            unit,
            speed,
            accel,
            values: [mass, coulomb, viscous, gravity, copper],
            motor: at_motor.then_some([lead_mm, gear]),
        }
    }

    /// Radians of the motor per metre.
    fn motor_per_load(&self) -> f64 {
        self.motor
            .map_or(1.0, |[lead_mm, gear]| TAU * gear / (1e-3 * lead_mm))
    }

    fn write(&self, toml: &mut String) {
        let names = match (self.turns, self.motor) {
            (false, None) => "mass_kg coulomb_n viscous_n_s_m gravity_n copper_w_n2",
            _ => "inertia_kg_m2 friction_nm viscous_nm_s_rad gravity_nm copper_w_nm2",
        };
        let k = self.motor_per_load();
        let factors = [1.0 / (k * k), 1.0 / k, 1.0 / (k * k), 1.0 / k, k * k];
        for ((name, value), factor) in names.split(' ').zip(self.values).zip(factors) {
            let _ = writeln!(toml, "{name} = {:?}", value * factor);
        }
        let per_min = self.speed * 60.0;
        let _ = match self.motor {
            Some([lead_mm, gear]) => writeln!(
                toml,
                "lead_mm = {lead_mm:?}\ngear_ratio = {gear:?}\nmax_speed_rpm = {:?}",
                per_min / lead_mm * gear
            ),
            None if self.turns => writeln!(toml, "rapid_deg_min = {per_min:?}"),
            None => writeln!(toml, "rapid_mm_min = {per_min:?}"),
        };
    }

    /// A curve of force or torque that falls with speed.
    fn write_curve(&self, random: &mut Random, toml: &mut String) {
        let [mass, coulomb, viscous, gravity, _] = self.values;
        let drag = coulomb + viscous * self.speed * self.unit + gravity.abs();
        let points = 2 + random.below(4);
        let mut share = random.within(0.6, 1.4);
        let k = self.motor_per_load();
        let mut list = Vec::new();
        for i in 0..points {
            let v = self.speed * 1.001 * i as f64 / (points - 1) as f64;
            let force = drag + mass * self.accel * self.unit * share;
            list.push(if self.motor.is_some() || self.turns {
                // One revolution of the motor: the lead by the gear, or 360 degrees.
                let per_turn = self.motor.map_or(360.0, |[lead_mm, gear]| lead_mm / gear);
                let rpm = v / per_turn * 60.0;
                format!("{{ rpm = {rpm:?}, torque_nm = {:?} }}", force / k)
            } else {
                format!("{{ speed_mm_min = {:?}, force_n = {force:?} }}", v * 60.0)
            });
            share *= random.within(0.4, 1.0);
        }
        let at_motor = self.motor.is_some() || self.turns;
        let key = if at_motor {
            "torque_curve"
        } else {
            "force_curve"
        };
        let _ = writeln!(toml, "{key} = [{}]", list.join(", "));
    }
}

/// Writes a random axis; `curved` where it is the one with a curve.
pub fn write(random: &mut Random, toml: &mut String, letter: char, motion: Motion, curved: bool) {
    let turns = "ABC".contains(letter);
    let unit = if turns { "deg" } else { "mm" };
    let load = Load::any(random, turns);
    let accel = load.accel;
    let _ = writeln!(toml, "[axes.{letter}]\naccel_{unit}_s2 = {accel:?}");
    load.write(toml);
    if random.once_in(2) {
        let _ = writeln!(toml, "efficiency = {:?}", random.within(0.6, 1.0));
    }
    let factors = random.once_in(3);
    if factors {
        let (motor, regen) = (random.within(1.0, 1.4), random.within(1.0, 1.4));
        let warm = random.within(0.4, 1.0);
        let _ = writeln!(
            toml,
            "servo_factor_motor = {motor:?}\nservo_factor_regen = {regen:?}\n\
             friction_min_ratio = {warm:?}"
        );
    }
    if motion == Motion::Jerk || motion == Motion::Both {
        let jerk = accel * random.scale(5.0, 400.0);
        let _ = writeln!(toml, "jerk_{unit}_s3 = {jerk:?}");
    }
    if curved && (motion == Motion::Curve || motion == Motion::Both) {
        load.write_curve(random, toml);
    }
}
