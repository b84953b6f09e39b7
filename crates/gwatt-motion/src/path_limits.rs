//! Limits along the path, as Klipper has them instead of limits of X and Y.

use gwatt_machine::{Axis, AxisId, AxisValues, CornerRule, Machine};

/// What Klipper's `SET_VELOCITY_LIMIT` sets for its look-ahead.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Square {
    /// Speed at a corner of 90 degrees, mm/s.
    pub corner_mm_s: f64,
    /// Share of each hill of speed that is cruised at least.
    pub cruise_ratio: f64,
}

impl Square {
    /// What the profile of the machine says; `None` where it has another rule for corners.
    #[must_use]
    pub fn of(machine: &Machine) -> Option<Self> {
        let rules = machine.controller.planner.look_ahead?;
        let CornerRule::SquareCorner { velocity_mm_s, .. } = rules.corner else {
            return None;
        };
        Some(Self {
            corner_mm_s: velocity_mm_s,
            cruise_ratio: rules.min_cruise_ratio,
        })
    }

    /// What bounds both: the higher speed at corners, the lower share of hills to cruise.
    #[must_use]
    pub fn or_faster(self, other: Self) -> Self {
        Self {
            corner_mm_s: self.corner_mm_s.max(other.corner_mm_s),
            cruise_ratio: self.cruise_ratio.min(other.cruise_ratio),
        }
    }
}

/// The largest steps of speed at corners, as M205 of Marlin and M566 of `RepRapFirmware` set them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpeedSteps {
    /// Of X, Y, Z and E, mm/s; infinite where none is given.
    pub mm_s: [f64; 4],
    /// Only between two moves that extrude or two that do not.
    pub same_kind_only: bool,
}

impl SpeedSteps {
    /// The axes that have such words.
    pub const AXES: [AxisId; 4] = [AxisId::X, AxisId::Y, AxisId::Z, AxisId::E];

    /// What the profile of the machine says; `None` where it has another rule for corners.
    #[must_use]
    pub fn of(machine: &Machine) -> Option<Self> {
        let (steps, same_kind_only) = match &machine.controller.planner.look_ahead?.corner {
            CornerRule::ClassicJerk { step_mm_s } => (*step_mm_s, false),
            CornerRule::SpeedStep {
                step_mm_s,
                same_kind_only,
            } => (*step_mm_s, *same_kind_only),
            _ => return None,
        };
        Some(Self {
            mm_s: Self::AXES.map(|axis| steps[axis as usize]),
            same_kind_only,
        })
    }

    /// The steps of all axes, of which `own` are the profile's.
    #[must_use]
    pub fn over(&self, own: &AxisValues) -> AxisValues {
        let mut all = *own;
        for (axis, step) in Self::AXES.into_iter().zip(self.mm_s) {
            all[axis as usize] = step;
        }
        all
    }

    /// The larger ones of both.
    #[must_use]
    pub fn or_faster(self, other: Self) -> Self {
        let mut faster = self;
        for (step, other) in faster.mm_s.iter_mut().zip(other.mm_s) {
            *step = step.max(other);
        }
        faster.same_kind_only &= other.same_kind_only;
        faster
    }
}

/// X and Y, which Klipper's limits along the path are those of.
const XY: [usize; 2] = [0, 1];
/// X, Y and Z: no faster than the path, whatever its direction.
const XYZ: [usize; 3] = [0, 1, 2];
/// The one value that X and Y share, where the firmware has no other for them.
fn shared(machine: &Machine, value: impl Fn(&Axis) -> f64) -> Option<f64> {
    if !machine.controller.language.printer.velocity_limit {
        return None;
    }
    let [x, y] = XY.map(|axis| machine.axes[axis].as_ref().map(&value));
    x.filter(|_| x == y)
}

/// The acceleration along the path that holds without a word, mm/s²: Klipper's
/// `max_accel`, which the machine file gives for X and Y; infinite where they differ.
#[must_use]
pub fn own_path_accel(machine: &Machine) -> f64 {
    shared(machine, |axis| axis.accel_mm_s2).unwrap_or(f64::INFINITY)
}

/// The speed along the path that holds without a word, mm/s; `None` where X and Y differ,
/// and where the firmware has a limit for each axis.
#[must_use]
pub fn own_path_speed(machine: &Machine) -> Option<f64> {
    shared(machine, |axis| axis.rapid_mm_s)
}

/// Raises the limits of X and Y, mm/s², to a limit along the path: they have no other, so
/// that one above the machine file's is theirs.
pub fn raise_to_path(machine: &Machine, limits: &mut AxisValues, path_mm_s2: f64) {
    for axis in XY {
        if let Some(data) = &machine.axes[axis] {
            limits[axis] = data.accel_mm_s2.max(path_mm_s2);
        }
    }
}

/// Lowers the limits of X, Y and Z, mm/s², to a limit along the path, for a move whose
/// direction is not known: where the firmware limits the path, none of them accelerates
/// harder than it does.
pub fn hold_to_path(machine: &Machine, limits: &mut AxisValues, path_mm_s2: f64) {
    if machine.controller.language.printer.velocity_limit {
        for axis in XYZ {
            limits[axis] = limits[axis].min(path_mm_s2);
        }
    }
}
