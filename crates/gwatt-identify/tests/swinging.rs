//! A table that side masses swing on, moved by a drive in a closed loop, and how well its
//! figures can be known at best.

use std::f64::consts::TAU;

use gwatt_identify::{Quantity, Recording};
use nalgebra::{DMatrix, DVector};

use crate::simulated::{PERIOD_S, Random, recording};

/// Steps of the simulation from sample to sample.
pub(crate) const FINE: usize = 16;
/// Below this speed, m/s, friction grows with it.
const CREEP: f64 = 1e-3;

/// A pair of zeros and the pair of poles above it: frequencies, Hz, and dampings.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Swing {
    pub(crate) zero: [f64; 2],
    pub(crate) pole: [f64; 2],
}

/// What reads the motion, in steps of a size: m or m/s.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Sensor {
    /// The place of each sample.
    Position(f64),
    /// The speed at each sample.
    Speed(f64),
    /// How far it went since the sample before, by the steps of a position.
    MeanSpeed(f64),
}

impl Sensor {
    fn step(self) -> f64 {
        match self {
            Self::Position(step) | Self::Speed(step) | Self::MeanSpeed(step) => step,
        }
    }

    /// To whole steps.
    fn read(self, x: f64) -> f64 {
        self.step() * libm::round(x / self.step())
    }
}

/// All of a table.
#[derive(Debug, Clone)]
pub(crate) struct Table {
    pub(crate) mass: f64,
    pub(crate) swings: Vec<Swing>,
    pub(crate) viscous: f64,
    pub(crate) coulomb: f64,
    /// By how many steps the force acts late.
    pub(crate) late: usize,
    /// What the drive gives at most, N.
    pub(crate) limit: f64,
}

/// Position, speed, and two states of each swing.
type State = [f64; 8];

impl Table {
    /// Mass, then frequency and damping of each zero and each pole, then friction.
    pub(crate) fn figures(&self) -> Vec<f64> {
        let each = self.swings.iter().flat_map(|it| [it.zero, it.pole]);
        let swings = each.flatten();
        let mut out: Vec<f64> = std::iter::once(self.mass).chain(swings).collect();
        out.extend(
            [self.viscous, self.coulomb]
                .into_iter()
                .filter(|x| *x > 0.0),
        );
        out
    }

    /// The same table with other figures.
    fn with(&self, figures: &[f64]) -> Self {
        let mut rest = figures.iter().copied();
        let mut next = || rest.next().unwrap();
        let mut out = self.clone();
        out.mass = next();
        for swing in &mut out.swings {
            swing.zero = [next(), next()];
            swing.pole = [next(), next()];
        }
        for friction in [&mut out.viscous, &mut out.coulomb] {
            if *friction > 0.0 {
                *friction = next();
            }
        }
        out
    }

    /// How fast the states change under a force: a section for each swing, one after the other.
    fn slopes(&self, state: &State, force: f64) -> State {
        let mut out = [0.0; 8];
        let speed = state[1];
        let friction = self.viscous * speed + self.coulomb * libm::tanh(speed / CREEP);
        let mut through = (force - friction) / self.mass;
        for (swing, at) in self.swings.iter().zip([2, 4, 6]) {
            let [[hz, zero_damping], [pole_hz, damping]] = [swing.zero, swing.pole];
            let (x, y, w) = (state[at], state[at + 1], TAU * pole_hz);
            let direct = (pole_hz / hz) * (pole_hz / hz);
            out[at] = w * y;
            out[at + 1] = w * (through - x - 2.0 * damping * y);
            let swung = 2.0 * (zero_damping * pole_hz / hz - damping * direct);
            through = direct * through + (1.0 - direct) * x + swung * y;
        }
        out[0] = speed;
        out[1] = through;
        out
    }

    /// A step of Runge and Kutta.
    fn step(&self, state: &mut State, force: f64) {
        let h = PERIOD_S / FINE as f64;
        let moved = |by: &State, h: f64| {
            let mut out = *state;
            for (slot, by) in out.iter_mut().zip(by) {
                *slot += h * by;
            }
            out
        };
        let a = self.slopes(state, force);
        let b = self.slopes(&moved(&a, 0.5 * h), force);
        let c = self.slopes(&moved(&b, 0.5 * h), force);
        let d = self.slopes(&moved(&c, h), force);
        for (index, slot) in state.iter_mut().enumerate() {
            *slot += h / 6.0 * (a[index] + 2.0 * (b[index] + c[index]) + d[index]);
        }
    }

    /// Forces that `next` gives for each sample from where it is, with the places and speeds
    /// to which they move it.
    fn moved(&self, samples: usize, mut next: impl FnMut(usize, f64) -> f64) -> [Vec<f64>; 3] {
        let [mut forces, mut positions, mut speeds]: [Vec<f64>; 3] = Default::default();
        let mut state = [0.0; 8];
        for k in 0..samples {
            positions.push(state[0]);
            speeds.push(state[1]);
            forces.push(next(k, state[0]).clamp(-self.limit, self.limit));
            for step in 0..FINE {
                let acts = (k * FINE + step).checked_sub(self.late);
                let force = acts.map_or(0.0, |at| forces[at / FINE]);
                self.step(&mut state, force);
            }
        }
        [forces, positions, speeds]
    }

    /// A recording to and fro by a position loop of 2 Hz, with random forces of this size
    /// added, and what a sensor reads. The force is recorded with this much noise.
    pub(crate) fn recorded(
        &self,
        samples: usize,
        (excitation, noise, sensor): (f64, f64, Sensor),
        random: &mut Random,
    ) -> Recording {
        let (w, phase) = (TAU * 2.0, random.uniform(0.0, TAU));
        let [spring, damper] = [self.mass * w * w, 1.4 * self.mass * w];
        let at = |k: usize| {
            let t = k as f64 * PERIOD_S;
            // It begins without a jump.
            let slow = 0.1 * libm::sin(TAU * 0.41 * t + phase);
            t.min(1.0) * (slow + 0.03 * libm::sin(TAU * 1.13 * t))
        };
        // The loop has an encoder of its own next to a sensor of the speed.
        let read = |x: f64| match sensor {
            Sensor::Speed(_) => x,
            other => other.read(x),
        };
        let (mut before, mut speed) = (0.0, 0.0);
        let mut added = Vec::new();
        let [mut force, position, speed] = self.moved(samples, |k, x| {
            let apart = at(k) - read(x);
            // What differences of steps would make of it is smoothed.
            speed += 0.2 * ((apart - before) / PERIOD_S - speed);
            before = apart;
            let sign = if random.uniform(0.0, 1.0) < 0.5 {
                -1.0
            } else {
                1.0
            };
            added.push(sign * excitation);
            spring * apart + damper * speed + sign * excitation
        });
        for slot in force.iter_mut().filter(|_| noise > 0.0) {
            *slot += noise * random.normal();
        }
        let counted = |x: Vec<f64>| x.into_iter().map(|x| sensor.read(x)).collect::<Vec<_>>();
        match sensor {
            Sensor::Position(_) => recording(force, counted(position), Quantity::Position),
            Sensor::Speed(_) => recording(force, counted(speed), Quantity::Velocity),
            Sensor::MeanSpeed(_) => {
                let position = counted(position);
                let went = position.windows(2).map(|x| (x[1] - x[0]) / PERIOD_S);
                let speed = std::iter::once(0.0).chain(went).collect();
                recording(force, speed, Quantity::Velocity)
            }
        }
    }

    /// The least standard errors that an unbiased estimate has of the figures (Cramér and
    /// Rao), where the steps of the encoder are noise of an even distribution: the force is
    /// known, and place, speed and an offset of the force are not. A delay between samples is
    /// sought next to them.
    pub(crate) fn bounds(&self, force: &[f64], sensor: Sensor) -> Vec<f64> {
        let samples = force.len();
        let is_speed = matches!(sensor, Sensor::Speed(_));
        let pushed = |table: &Self, more: f64| -> Vec<f64> {
            let [_, position, speed] = table.moved(samples, |k, _| force[k] + more);
            if is_speed { speed } else { position }
        };
        let position = |table: &Self| pushed(table, 0.0);
        let figures = self.figures();
        let mut columns: Vec<Vec<f64>> = Vec::new();
        let slope = |above: &Self, below: &Self, by: f64| -> Vec<f64> {
            let both = position(above).into_iter().zip(position(below));
            both.map(|(a, b)| (a - b) / by).collect()
        };
        for (index, figure) in figures.iter().enumerate() {
            let probe = 1e-3 * figure;
            let moved = |by: f64| {
                let mut figures = figures.clone();
                figures[index] += by;
                self.with(&figures)
            };
            columns.push(slope(&moved(probe), &moved(-probe), 2.0 * probe));
        }
        let n = samples as f64;
        columns.push(vec![1.0; samples]);
        if !is_speed {
            columns.push((0..samples).map(|k| k as f64 / n).collect());
        }
        let (more, plain) = (pushed(self, 1e-3), position(self));
        columns.push(more.iter().zip(&plain).map(|(a, b)| a - b).collect());
        if !self.late.is_multiple_of(FINE) {
            let late = |late: usize| Self {
                late,
                ..self.clone()
            };
            columns.push(slope(&late(self.late + 1), &late(self.late - 1), 1.0));
        }
        // Sizes of their own, so that the digits are enough.
        let sizes: Vec<f64> = columns
            .iter()
            .map(|column| column.iter().map(|x| x * x).sum::<f64>().sqrt())
            .collect();
        let matrix = DMatrix::from_fn(samples, columns.len(), |row, column| {
            columns[column][row] / sizes[column]
        });
        let r = matrix.qr().r();
        let noise = sensor.step() / 12.0_f64.sqrt();
        let inverse = r.try_inverse().unwrap();
        (0..figures.len())
            .map(|index| {
                let row: DVector<f64> = inverse.row(index).transpose();
                noise * row.norm() / sizes[index]
            })
            .collect()
    }
}
