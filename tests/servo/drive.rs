//! A drive and its load, stepped in time: a P position loop, a P or PI velocity loop,
//! Coulomb and viscous friction, weight. SI throughout.

use std::f64::consts::TAU;

/// The loops of a drive, as a machine file gives them.
#[derive(Debug, Clone, Copy)]
pub struct Loops {
    pub position_gain_1_s: f64,
    pub velocity_bandwidth_hz: f64,
    /// 0: no integral part.
    pub velocity_integral_time_s: f64,
    pub velocity_feedforward: f64,
    pub acceleration_feedforward: f64,
}

/// What a drive moves, and what that costs.
#[derive(Debug, Clone, Copy)]
pub struct Load {
    pub mass: f64,
    pub coulomb: f64,
    pub viscous: f64,
    pub gravity: f64,
    pub efficiency: f64,
    pub copper: f64,
}

impl Load {
    /// Electrical power at a speed and a force.
    pub fn power_w(&self, v: f64, force: f64) -> f64 {
        let p = v * force;
        let converted = if p > 0.0 {
            p / self.efficiency
        } else {
            p * self.efficiency
        };
        converted + self.copper * force * force
    }
}

/// What is commanded at an instant: place, speed, acceleration.
pub type Wanted = [f64; 3];

/// The drive of an axis in motion.
pub struct Drive {
    loops: Loops,
    /// The mass for which the loops are set.
    tuned: f64,
    load: Load,
    /// Place, speed, and what the velocity loop has added up.
    state: [f64; 3],
}

impl Drive {
    /// At rest where it is wanted to be, its weight held.
    pub fn new(loops: Loops, tuned: f64, load: Load) -> Self {
        let held = load.gravity / (tuned * TAU * loops.velocity_bandwidth_hz);
        let state = if loops.velocity_integral_time_s > 0.0 {
            [0.0, 0.0, held * loops.velocity_integral_time_s]
        } else {
            [-held / loops.position_gain_1_s, 0.0, 0.0]
        };
        Self {
            loops,
            tuned,
            load,
            state,
        }
    }

    /// What is missing of the speed that the position loop asks for.
    fn missing(&self, [r, speed, _]: Wanted, [x, v, _]: [f64; 3]) -> f64 {
        let loops = &self.loops;
        loops.position_gain_1_s * (r - x) + loops.velocity_feedforward * speed - v
    }

    fn force_in(&self, wanted: Wanted, state: [f64; 3]) -> f64 {
        let loops = &self.loops;
        let mut asked = self.missing(wanted, state);
        if loops.velocity_integral_time_s > 0.0 {
            asked += state[2] / loops.velocity_integral_time_s;
        }
        let fed = loops.acceleration_feedforward * wanted[2];
        self.tuned * (TAU * loops.velocity_bandwidth_hz * asked + fed)
    }

    /// Speed and force now.
    pub fn now(&self, wanted: Wanted) -> [f64; 2] {
        [self.state[1], self.force_in(wanted, self.state)]
    }

    /// A step in time, by Runge and Kutta's rule of fourth order; what is wanted at its
    /// beginning, in its middle and at its end. Friction keeps its sign inside a
    /// step, and holds what comes to rest.
    pub fn step(&mut self, wanted: [Wanted; 3], dt: f64) {
        let load = self.load;
        let [x, v, _] = self.state;
        let free = self.force_in(wanted[0], self.state) - load.gravity;
        let sticks = v == 0.0 && free.abs() < load.coulomb;
        let sign = if v == 0.0 { free.signum() } else { v.signum() };
        let rate = |wanted: Wanted, state: [f64; 3]| {
            let drag = load.coulomb * sign + load.viscous * state[1] + load.gravity;
            let accel = (self.force_in(wanted, state) - drag) / load.mass;
            let missing = self.missing(wanted, state);
            if sticks {
                [0.0, 0.0, missing]
            } else {
                [state[1], accel, missing]
            }
        };
        let state = self.state;
        let from = |slope: [f64; 3], time: f64| [0, 1, 2].map(|i| state[i] + time * slope[i]);
        let first = rate(wanted[0], state);
        let second = rate(wanted[1], from(first, 0.5 * dt));
        let third = rate(wanted[1], from(second, 0.5 * dt));
        let fourth = rate(wanted[2], from(third, dt));
        let mean = [0, 1, 2].map(|i| (first[i] + 2.0 * (second[i] + third[i]) + fourth[i]) / 6.0);
        self.state = from(mean, dt);
        if v != 0.0 && self.state[1] * v < 0.0 {
            // It has turned: it stops once, and sticks or goes on with the next step.
            self.state[0] = x + 0.5 * v * dt;
            self.state[1] = 0.0;
        }
    }
}
