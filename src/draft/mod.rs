//! A machine file out of what people know of their machine: the supply, and for each axis its
//! speed, its masses, and what drives it.
//!
//! Nothing is guessed: what has to be known is asked for, what may be left out counts as the file
//! says then, and [`Draft::left_out`] says so once.

mod axis;
mod error;
mod key;
mod kind;
mod parts;
mod write;

use std::f64::consts::TAU;

use crate::machine::{ALL_AXES, Machine};

pub use axis::{DraftAxis, Drive};
pub use error::DraftError;
pub use key::{Form, KEYS};
pub use kind::MachineKind;
pub use parts::{DraftLoad, DraftSpindle};

/// What is known of a machine.
#[derive(Debug, Clone, PartialEq)]
pub struct Draft {
    /// Its kind.
    pub kind: MachineKind,
    /// Its name.
    pub name: String,
    /// The controller profile; `None`: the usual one.
    pub controller: Option<String>,
    /// What the supply of the drives delivers at most, W.
    pub supply_w: f64,
    /// What it takes back, W.
    pub feeds_back_w: Option<f64>,
    /// What always runs, W.
    pub base_load_w: Option<f64>,
    /// The axes.
    pub axes: Vec<DraftAxis>,
    /// The spindle.
    pub spindle: Option<DraftSpindle>,
    /// Heaters, pumps and the like.
    pub loads: Vec<DraftLoad>,
}

impl Draft {
    /// Checks what does not concern one axis alone.
    ///
    /// # Errors
    /// See [`DraftError`].
    pub fn check(&self) -> Result<(), DraftError> {
        let positive = |watts: f64| watts.is_finite() && watts > 0.0;
        let not_negative = |watts: Option<f64>| watts.is_none_or(|it| it.is_finite() && it >= 0.0);
        if !positive(self.supply_w) {
            return Err(DraftError::Power("the supply", "above 0"));
        }
        if !not_negative(self.feeds_back_w) {
            return Err(DraftError::Power("what it takes back", "0 or more"));
        }
        if !not_negative(self.base_load_w) {
            return Err(DraftError::Power("the base load", "0 or more"));
        }
        if self.axes.is_empty() {
            return Err(DraftError::NoAxes);
        }
        for (index, axis) in self.axes.iter().enumerate() {
            let mut others = self.axes.iter().skip(index + 1);
            if others.any(|other| other.letter == axis.letter) {
                return Err(DraftError::Twice(axis.letter));
            }
        }
        Ok(())
    }

    /// Looks whether the motors bear what is asked of them, in the machine that was read back
    /// from the draft: one sentence each. Where the acceleration takes more torque than a motor
    /// has, the file gets that torque, which limits it.
    pub fn settle_motors(&mut self, machine: &Machine) -> Vec<String> {
        let mut said = Vec::new();
        for draft in &mut self.axes {
            let found = ALL_AXES.into_iter().zip(&machine.axes);
            let own = found
                .filter(|(id, _)| char::from(id.letter()) == draft.letter)
                .find_map(|(_, axis)| axis.as_ref());
            let (Some((motor, _)), Some(travel), Some(axis)) = (&draft.motor, draft.travel(), own)
            else {
                continue;
            };
            // N·m at the motor for each N at the load: the travel of a radian. For an axis that
            // turns: for each N·m.
            let lever_m = travel * axis.si_per_unit / TAU;
            let steady_nm = (axis.coulomb_n + axis.gravity_n.abs()) * lever_m;
            let moving_n = axis.mass_kg * axis.accel_mm_s2 * axis.si_per_unit;
            let needed_nm = steady_nm + moving_n * lever_m;
            let (letter, name) = (draft.letter, &motor.name);
            if needed_nm > motor.most_nm() {
                draft.torque_limits = true;
                said.push(format!(
                    "{letter}: {} {}/s2 takes {needed_nm:.3} N m of the motor {name}, which has \
                     {} at most: the file has its torque, which limits the acceleration",
                    axis.accel_mm_s2,
                    if draft.form == Form::Turn {
                        "degrees"
                    } else {
                        "mm"
                    },
                    motor.most_nm()
                ));
            }
            if steady_nm > motor.continuous_nm {
                said.push(format!(
                    "{letter}: friction and weight take {steady_nm:.3} N m of the motor {name}, \
                     which bears {} for ever",
                    motor.continuous_nm
                ));
            }
        }
        said
    }

    /// What was not given, and how it counts: one sentence each.
    #[must_use]
    pub fn left_out(&self) -> Vec<String> {
        let mut said = Vec::new();
        if self.controller.is_none() {
            let usual = self.kind.usual_controller();
            said.push(format!(
                "no controller given: programs are read as {usual} (`gwatt machine list` has all)"
            ));
        }
        if self.feeds_back_w.is_none() {
            let text = "nothing given of what the supply takes back: what braking axes feed back \
                        is not checked";
            said.push(text.to_owned());
        }
        if self.spindle.is_none() && self.kind != MachineKind::Printer {
            said.push("no spindle given: its power does not count".to_owned());
        }
        if self.loads.is_empty() && self.kind == MachineKind::Printer {
            let text = "no heaters given: they do not count, and draw most of a printer's power";
            said.push(text.to_owned());
        }
        if self.base_load_w.is_none() {
            said.push("no base load given: counted as 0 W".to_owned());
        }
        for (field, counted) in [
            (
                "rotor inertia",
                "counted as 0 kg m2, which is right for linear motors alone",
            ),
            (
                "friction",
                "counted as none; it often takes 2 to 10 % of the largest force, and `gwatt \
                 identify` finds it",
            ),
            ("efficiency", "counted as 1; the drive's losses come on top"),
            ("counterweight", "the whole weight counts"),
        ] {
            let axes: String = self
                .axes
                .iter()
                .filter(|axis| axis.lacks(field, self.kind))
                .map(|axis| axis.letter)
                .collect();
            if !axes.is_empty() {
                said.push(format!("{axes}: no {field} given: {counted}"));
            }
        }
        said
    }
}
