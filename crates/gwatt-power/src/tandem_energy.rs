//! Energy of two moves at once: it is not the sum of what each draws by itself, since
//! kinetic energy grows with the square of the sum of both speeds.
//!
//! Input: both pieces of path and the time that they share. Output: what is to be added
//! to the energy that was counted for each by itself, in J.

use super::instant::on_path;
use super::model::PowerModel;
use super::parabolic_blend::Ride;
use gwatt_machine::{AXES, AxisSet, AxisValues};
use gwatt_motion::Move;

/// Instants in the time that both share.
const SAMPLES: u32 = 64;

/// Speeds and accelerations of all axes, in mm/s and mm/s² (degrees for rotary axes).
#[derive(Clone, Copy)]
struct State {
    active: AxisSet,
    speed: AxisValues,
    accel: AxisValues,
}

impl State {
    fn of(ride: &Ride, t: f64) -> Self {
        let mut own = Self {
            active: ride.path.moving,
            speed: [0.0; AXES],
            accel: [0.0; AXES],
        };
        let along = ride.state(t);
        for axis in own.active.iter() {
            (own.speed[axis], own.accel[axis]) = on_path(&ride.path, axis, &along);
        }
        own
    }

    /// Both at once.
    fn and(&self, other: &Self) -> Self {
        Self {
            active: AxisSet(self.active.0 | other.active.0),
            speed: std::array::from_fn(|axis| self.speed[axis] + other.speed[axis]),
            accel: std::array::from_fn(|axis| self.accel[axis] + other.accel[axis]),
        }
    }

    /// What all converters draw, base load included, W; what is fed back is taken off where
    /// a converter credits it. Of `mv` only the switched loads are read.
    fn power_w(&self, model: &PowerModel, mv: &Move) -> f64 {
        let drawn_w = model.converters.iter().map(|converter| {
            let moving = AxisSet(self.active.0 & converter.axes.0);
            let axes_w = moving.iter().map(|axis| {
                let power = &model.axes[axis];
                let v = self.speed[axis] * power.si_per_unit;
                let sign = if v == 0.0 { 0.0 } else { v.signum() };
                let force = power.mass * self.accel[axis] * power.si_per_unit
                    + power.viscous * v
                    + power.coulomb * sign
                    + power.gravity;
                let own_w = power.electrical(v, force);
                if converter.credit_regen {
                    own_w
                } else {
                    own_w.max(0.0)
                }
            });
            converter.idle_w(mv, &model.axes, moving) + axes_w.sum::<f64>()
        });
        drawn_w.sum()
    }
}

/// The energy of two rides that share the last `overlap_s` of the first, less that of each
/// by itself, J.
pub(super) fn shared_energy_j(
    model: &PowerModel,
    mv: &Move,
    rides: [&Ride; 2],
    overlap_s: f64,
) -> f64 {
    let begins_s = [rides[0].duration_s() - overlap_s, 0.0];
    let step_s = overlap_s / f64::from(SAMPLES);
    let beyond_w = (0..SAMPLES).map(|sample| {
        let t = step_s * (f64::from(sample) + 0.5);
        let [first, next] = [0, 1].map(|i| State::of(rides[i], begins_s[i] + t));
        let apart_w = first.power_w(model, mv) + next.power_w(model, mv);
        first.and(&next).power_w(model, mv) - apart_w
    });
    step_s * beyond_w.sum::<f64>()
}
