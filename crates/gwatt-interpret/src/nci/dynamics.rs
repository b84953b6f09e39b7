//! Accelerations and jerk that a program has set: `DynOvr`, `#set param…Dynamics`.

use crate::knob::KnobState;
use gwatt_machine::{AXES, Axis, Machine};

/// X, Y and Z.
pub(super) const PATH_AXES: usize = 3;

/// What is in force, as shares of the machine's own values.
///
/// Whether `DynOvr` is a share of the machine's own values or of those that were set before, no
/// manual says: the machine's own are higher. What is set after it may be lowered by it or lift
/// it: it counts as it stands.
#[derive(Debug)]
pub(in crate::nci) struct Dynamics {
    /// Acceleration and jerk of each axis.
    shares: [[f64; 2]; AXES],
    /// Something was changed and does not act yet.
    pub(super) due: bool,
}

impl Default for Dynamics {
    fn default() -> Self {
        Self {
            shares: [[1.0; 2]; AXES],
            due: false,
        }
    }
}

impl Dynamics {
    /// A share of accelerations and jerk of all axes.
    pub(super) fn turn(&mut self, share: f64) {
        self.shares = [[share; 2]; AXES];
        self.due = true;
    }

    /// Acceleration, mm/s², and jerk, mm/s³, of an axis.
    pub(super) fn set(&mut self, axis: usize, own: &Axis, accel_mm_s2: f64, jerk_mm_s3: f64) {
        let jerk = if own.jerk_mm_s3 > 0.0 {
            jerk_mm_s3 / own.jerk_mm_s3
        } else {
            1.0
        };
        if let Some(shares) = self.shares.get_mut(axis) {
            *shares = [accel_mm_s2 / own.accel_mm_s2, jerk];
            self.due = true;
        }
    }

    /// Puts it in force.
    pub(super) fn act(&mut self, machine: &Machine, knobs: &mut KnobState) {
        self.due = false;
        for axis in machine.axis_set.iter() {
            let own_mm_s2 = machine.axes[axis].map_or(0.0, |data| data.accel_mm_s2);
            let [accel, jerk] = self.shares[axis];
            knobs.feed_accel_mm_s2[axis] = own_mm_s2 * accel;
            knobs.rapid_accel_mm_s2[axis] = own_mm_s2 * accel;
            knobs.jerk_factor[axis] = jerk;
        }
    }
}
