//! Knobs in force: words by which a program lowers acceleration or rapid speed.

use super::moves::MoveKind;
use crate::machine::{AXES, AxisValues, Knob, KnobTarget, Machine};

/// Limits in force after the knobs that a program has turned.
#[derive(Debug, Clone, PartialEq)]
pub struct KnobState {
    /// Acceleration limits of feed moves, mm/s².
    pub feed_accel_mm_s2: AxisValues,
    /// Acceleration limits of rapids, mm/s².
    pub rapid_accel_mm_s2: AxisValues,
    /// Limits along the path of moves that extrude, of others, and of those
    /// that M204's P and T spare (Marlin's M204 P, T and R); infinite without one.
    pub path_accel_mm_s2: [f64; 3],
    /// Share of the rapid speed.
    pub rapid_factor: f64,
    /// A knob that is set and does not act yet, with its value.
    pub(super) pending: Option<(usize, f64)>,
}

impl KnobState {
    /// The machine's own limits.
    #[must_use]
    pub fn new(machine: &Machine) -> Self {
        let accel =
            std::array::from_fn(|axis| machine.axes[axis].map_or(0.0, |axis| axis.accel_mm_s2));
        Self {
            feed_accel_mm_s2: accel,
            rapid_accel_mm_s2: accel,
            path_accel_mm_s2: [f64::INFINITY; 3],
            rapid_factor: 1.0,
            pending: None,
        }
    }

    /// Acceleration limits of moves of this kind, mm/s².
    pub(super) fn accel(&self, kind: MoveKind) -> &AxisValues {
        if kind == MoveKind::Rapid {
            &self.rapid_accel_mm_s2
        } else {
            &self.feed_accel_mm_s2
        }
    }

    /// Sets the limit along the path; `letter` says for which moves.
    pub(super) fn turn_path(&mut self, letter: u8, value: f64, mm_per_unit: f64) {
        let accel = value * mm_per_unit;
        match letter {
            b'P' => self.path_accel_mm_s2[0] = accel,
            b'T' => self.path_accel_mm_s2[1] = accel,
            b'R' => self.path_accel_mm_s2[2] = accel,
            _ => self.path_accel_mm_s2[..2].fill(accel),
        }
    }

    /// Turns a knob for one axis, or for all (`None`); `mm_per_unit` is the
    /// program's unit of length.
    pub(super) fn turn(
        &mut self,
        machine: &Machine,
        knob: &Knob,
        axis: Option<usize>,
        value: f64,
        mm_per_unit: f64,
    ) {
        if knob.target == KnobTarget::RapidSpeed {
            self.rapid_factor = value / 100.0;
            return;
        }
        let which = axis.map_or(0..AXES, |axis| axis..axis + 1);
        for axis in which {
            let Some(data) = &machine.axes[axis] else {
                continue;
            };
            let accel = knob.unit.accel_mm_s2(data, value, mm_per_unit);
            if knob.target != KnobTarget::RapidAccel {
                self.feed_accel_mm_s2[axis] = accel;
            }
            if knob.target != KnobTarget::FeedAccel {
                self.rapid_accel_mm_s2[axis] = accel;
            }
        }
    }
}
