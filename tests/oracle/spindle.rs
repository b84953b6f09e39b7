//! The spindle over time: constant torque up to the base speed, constant power
//! above it, no jerk limit.
//!
//! `dω/dt = A` below the base speed `ω_b`, `A·ω_b/ω` above, so that there `ω²` grows by `2·A·ω_b·t`;
//! `T = ω_b/A + (ω_m² − ω_b²)/(2·A·ω_b)` gives A. Torque `J·α + friction`, power
//! `T·ω`, by the efficiency like an axis.

use std::f64::consts::TAU;

use super::electrical::SpindleLoad;
use super::plant::Spindle;

const RAD_S_PER_RPM: f64 = TAU / 60.0;
/// Steps of a run between two speeds.
const STEPS: usize = 400;

/// Speed (rad/s) and acceleration (rad/s²).
type State = [f64; 2];

/// The runs of a spindle.
#[derive(Debug, Clone, Default)]
pub struct Turning {
    /// Stretches: when each begins, the state there, and the acceleration at its
    /// end; between them it is a straight line.
    knots: Vec<(f64, State, f64)>,
    /// Switched on and off: when, and whether it is on.
    switched: Vec<(f64, bool)>,
}

impl Spindle {
    /// Acceleration at a speed, both rad/s.
    fn accel(&self, omega: f64) -> f64 {
        let most = self.max_rpm * RAD_S_PER_RPM;
        let base = if self.base_rpm > 0.0 {
            self.base_rpm * RAD_S_PER_RPM
        } else {
            most
        };
        let accel = (base + (most * most - base * base) / (2.0 * base)) / self.accel_time_s;
        accel * (base / omega.abs().max(base))
    }

    /// What it draws, signed; without its base load.
    pub fn power_w(&self, [omega, alpha]: State) -> f64 {
        let sign = if omega == 0.0 { 0.0 } else { omega.signum() };
        let p = omega * (self.inertia * alpha + self.friction_nm * sign);
        if p > 0.0 {
            p / self.efficiency
        } else {
            p * self.efficiency
        }
    }
}

impl Turning {
    /// From `t` on the spindle is to turn at `rpm`, signed.
    pub fn command(&mut self, spindle: &Spindle, t: f64, rpm: f64, on: bool) {
        let [from, _] = self.at(t, t);
        let to = rpm * RAD_S_PER_RPM;
        self.knots.retain(|knot| knot.0 < t);
        self.switched.push((t, on));
        // Stops at rest and at the base speed, where the law changes.
        let base = spindle.base_rpm * RAD_S_PER_RPM;
        let mut stops = vec![from, to];
        let between = |v: &f64| (v - from) * (v - to) < 0.0;
        stops.extend([-base, 0.0, base].iter().filter(|v| between(v)));
        stops.sort_by(f64::total_cmp);
        stops.dedup();
        if to < from {
            stops.reverse();
        }
        let mut now = t;
        for pair in stops.windows(2) {
            let step = (pair[1] - pair[0]) / STEPS as f64;
            for i in 0..STEPS {
                let v = pair[0] + step * i as f64;
                let [a0, a1] = [v, v + step].map(|v| spindle.accel(v));
                let [begins, ends] = [a0, a1].map(|a| step.signum() * a);
                self.knots.push((now, [v, begins], ends));
                now += 2.0 * step.abs() / (a0 + a1);
            }
        }
        self.knots.push((now, [to, 0.0], 0.0));
    }

    /// When it reaches its speed.
    pub fn settled_s(&self) -> f64 {
        self.knots.last().map_or(0.0, |knot| knot.0)
    }

    /// Where its laws may change.
    pub fn breaks_s(&self) -> impl Iterator<Item = f64> {
        self.knots.iter().map(|knot| knot.0)
    }

    /// The state at `t`, by the law that holds at `inside`.
    pub fn at(&self, t: f64, inside: f64) -> State {
        let after = self.knots.partition_point(|knot| knot.0 <= inside);
        let Some(&(since, [v, a], next)) = after.checked_sub(1).and_then(|i| self.knots.get(i))
        else {
            return [0.0; 2];
        };
        let Some(&(until, ..)) = self.knots.get(after) else {
            return [v, a];
        };
        let dt = t - since;
        let j = (next - a) / (until - since);
        [v + dt * (a + 0.5 * j * dt), a + j * dt]
    }

    /// What it draws at that instant.
    pub fn spindle_load(&self, spindle: &Spindle, t: f64, inside: f64) -> SpindleLoad {
        let state = self.at(t, inside);
        let on = self.switched.iter().rfind(|(since, _)| *since <= inside);
        SpindleLoad {
            power_w: spindle.power_w(state),
            idle_w: if on.is_some_and(|(_, on)| *on) {
                spindle.base_w
            } else {
                0.0
            },
        }
    }
}
