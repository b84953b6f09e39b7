//! The shortest time under a limit of power that the physics permits, and random machines.

use std::fmt::Write as _;

use crate::random::Random;

/// What an axis of the reference has, SI.
#[derive(Clone, Copy)]
struct Axis {
    letter: &'static str,
    rapid_m_s: f64,
    accel_m_s2: f64,
    mass_kg: f64,
    coulomb_n: f64,
    efficiency: f64,
}

/// A machine for the reference.
pub(super) struct Axes {
    axes: Vec<Axis>,
    /// The acceleration of X and Y holds along the path, and half of each hill of speed is
    /// cruised (Klipper).
    along_path: bool,
}

/// A line for the reference, SI: axes with their shares of the way.
pub(super) struct Line {
    axes: Vec<(f64, Axis)>,
    length_m: f64,
    top_m_s: f64,
    accel_m_s2: f64,
}

impl Axes {
    /// Random ones; X and Y alike where the acceleration holds along the path.
    pub(super) fn any(random: &mut Random, along_path: bool) -> Self {
        let mut axes: Vec<Axis> = Vec::new();
        for letter in ["X", "Y", "Z"] {
            let mut limits = (random.within(0.3, 1.0), random.within(2.0, 10.0));
            if let Some(x) = axes.first().filter(|_| along_path && letter == "Y") {
                limits = (x.rapid_m_s, x.accel_m_s2);
            }
            let mass_kg = random.within(20.0, 900.0);
            axes.push(Axis {
                letter,
                rapid_m_s: limits.0,
                accel_m_s2: limits.1,
                mass_kg,
                coulomb_n: mass_kg * limits.1 * random.within(0.0, 0.2),
                efficiency: [1.0, 0.85, 0.7][random.within(0.0, 2.999) as usize],
            });
        }
        Self { axes, along_path }
    }

    /// Their part of a machine file.
    pub(super) fn text(&self) -> String {
        let mut text = String::new();
        for axis in &self.axes {
            let _ = write!(
                text,
                "[axes.{}]\nrapid_mm_min = {:?}\naccel_mm_s2 = {:?}\nmass_kg = {:?}\n\
                 coulomb_n = {:?}\nefficiency = {:?}\n",
                axis.letter,
                axis.rapid_m_s * 6e4,
                axis.accel_m_s2 * 1e3,
                axis.mass_kg,
                axis.coulomb_n,
                axis.efficiency
            );
        }
        text
    }

    /// The line over these distances, mm.
    pub(super) fn line(&self, way_mm: [f64; 3]) -> Line {
        let length = way_mm.iter().map(|it| it * it).sum::<f64>().sqrt();
        let moving = self.axes.iter().zip(way_mm);
        let moving = moving.filter(|(_, way_mm)| *way_mm != 0.0);
        let axes: Vec<(f64, Axis)> = moving
            .map(|(axis, way_mm)| (way_mm.abs() / length, *axis))
            .collect();
        let (mut top, mut accel) = (f64::INFINITY, f64::INFINITY);
        for (share, axis) in &axes {
            top = top.min(axis.rapid_m_s / share);
            let alone = self.along_path && axis.letter != "Z";
            accel = accel.min(axis.accel_m_s2 / if alone { 1.0 } else { *share });
        }
        let length_m = length / 1e3;
        if self.along_path {
            // It is to become no faster than it was.
            top = top.min((0.5 * accel * length_m).sqrt());
        }
        Line {
            axes,
            length_m,
            top_m_s: top,
            accel_m_s2: accel,
        }
    }
}

impl Line {
    fn power_w(&self, speed: f64, accel: f64) -> f64 {
        let powers = self.axes.iter().map(|(share, axis)| {
            let force = axis.mass_kg * share * accel + axis.coulomb_n;
            (share * speed * force / axis.efficiency).max(0.0)
        });
        powers.sum()
    }

    /// What it draws without a limit.
    pub(super) fn peak_w(&self) -> f64 {
        let reached = self.top_m_s.min((self.accel_m_s2 * self.length_m).sqrt());
        self.power_w(reached, self.accel_m_s2)
    }

    /// The shortest time from rest to rest under a limit of power: forwards over the levels
    /// of v² with the largest acceleration that each permits, brakes with all force, and the
    /// best of all top speeds.
    pub(super) fn soonest_s(&self, limit_w: f64) -> f64 {
        const LEVELS: usize = 3000;
        let speed =
            |level: usize| (level as f64 / LEVELS as f64 * self.top_m_s * self.top_m_s).sqrt();
        let (mut up_s, mut up_m, mut best_s) = (0.0, 0.0, f64::INFINITY);
        for level in 1..=LEVELS {
            let (low, high) = (speed(level - 1), speed(level));
            let middle = f64::midpoint(low, high);
            let (mut fits, mut exceeds) = (0.0, self.accel_m_s2);
            if self.power_w(middle, exceeds) <= limit_w {
                fits = exceeds;
            }
            for _ in 0..50 {
                let accel = f64::midpoint(fits, exceeds);
                if self.power_w(middle, accel) <= limit_w {
                    fits = accel;
                } else {
                    exceeds = accel;
                }
            }
            if fits < 1e-6 {
                break;
            }
            up_s += (high - low) / fits;
            up_m += (high * high - low * low) / (2.0 * fits);
            let down_m = high * high / (2.0 * self.accel_m_s2);
            let cruise_m = self.length_m - up_m - down_m;
            if cruise_m < 0.0 {
                break;
            }
            best_s = f64::min(best_s, up_s + high / self.accel_m_s2 + cruise_m / high);
        }
        best_s
    }
}

impl Random {
    /// A distance in mm, to a thousandth.
    pub(super) fn way_mm(&mut self, [low, high]: [f64; 2]) -> f64 {
        (self.within(low, high) * 1e3).round() / 1e3
    }
}
