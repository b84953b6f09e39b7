//! System variables: the few whose value the program itself decides.
//!
//! "System variables": `$AA_IW` and `$AA_IM` are the positions of an axis in
//! work and machine coordinates, `$P_EP` the end of the last block.

use super::reading::Reading;
use super::value::Val;
use crate::expression::Outcome;
use gwatt_machine::AxisId;

impl Reading<'_, '_, '_> {
    pub(super) fn system_variable(&mut self) -> Outcome<Val> {
        let start = self.cursor.at;
        let name = self.cursor.name();
        self.cursor.at += name.len();
        if name == "$PI" {
            return Ok(Val::Number(std::f64::consts::PI));
        }
        if let Some(axis) = self.plane_axis(&name) {
            return Ok(axis);
        }
        if matches!(name.as_str(), "$AA_IW" | "$P_EP" | "$AA_IM")
            && self.cursor.peek() == Some(b'[')
        {
            let letter = self.axis_in_brackets()?;
            if let Some(value) = self.position(&name, letter) {
                return Ok(Val::Number(value));
            }
        }
        let message = format!("{name} is the control's, and gwatt does not know its value");
        let help =
            "give the program a variable with a value instead, or take what depends on it out";
        Err(self.cursor.fault("unknown-value", message, help, start))
    }

    fn position(&self, name: &str, letter: u8) -> Option<f64> {
        let axis = AxisId::from_letter(letter)? as usize;
        self.control.machine.axes.get(axis)?.as_ref()?;
        let at = &self.control.position.at;
        let needed = if axis < 3 { 0b111 } else { 1 << axis };
        // Offsets that nobody has given are 0 here, as they are in all machine coordinates.
        let apart = name != "$AA_IM" && self.control.coordinate_unknown(axis);
        if self.control.position.unknown.0 & needed != 0 || apart {
            return None;
        }
        let mm = match name {
            "$AA_IW" | "$P_EP" => self.state.program_place(at).get(axis).copied()?,
            "$AA_IM" => at.get(axis)? - self.state.turns.get(axis)?,
            _ => return None,
        };
        let diameter = if axis == 0 && self.state.diameter && name != "$AA_IM" {
            2.0
        } else {
            1.0
        };
        let unit = self.control.unit_of(axis);
        Some(mm / unit * diameter)
    }
}
