//! Axes by computed names ("Variable axis identifiers"): `AX[…]`, variables of the type
//! AXIS, AXNAME, and `$P_AXN1` to `$P_AXN3`.

use super::reading::Reading;
use super::value::Val;
use crate::expression::{Grammar, Outcome};
use gwatt_machine::AxisId;
use gwatt_syntax::Block;

impl Reading<'_, '_, '_> {
    /// `AX[…]=…`, where `AX` is no variable.
    pub(super) fn indirect_axis(&mut self, start: usize, block: &mut Block) -> Outcome<()> {
        let letter = self.axis_in_brackets()?;
        self.cursor.expect(b'=')?;
        self.cursor.peek();
        let number = self.cursor.at;
        let (measure, value) = self.measured()?;
        self.measure(letter, measure, start)?;
        self.push(letter, value, start, number, block)
    }

    /// The letter of the axis that stands in brackets.
    pub(super) fn axis_in_brackets(&mut self) -> Outcome<u8> {
        self.cursor.expect(b'[')?;
        let start = self.cursor.at;
        let axis = self.expression()?;
        let letter = match &axis {
            Val::Text(name) => self.axis_letter(name),
            Val::Number(_) => None,
        };
        let Some(letter) = letter else {
            let message = "this is the name of no axis of the machine";
            let help =
                "write an axis, a variable of the type AXIS, $P_AXN1 to $P_AXN3, or AXNAME(\"X\")";
            return Err(self.cursor.fault("no-such-axis", message, help, start));
        };
        self.cursor.expect(b']')?;
        Ok(letter)
    }

    /// The letter of an axis that the machine has.
    pub(super) fn axis_letter(&self, name: &str) -> Option<u8> {
        let [letter] = name.trim().as_bytes() else {
            return None;
        };
        let letter = letter.to_ascii_uppercase();
        let axis = AxisId::from_letter(letter)? as usize;
        self.control.machine.axes.get(axis)?.as_ref()?;
        Some(letter)
    }

    /// `AXNAME("X")`, after its name: the axis that a text names.
    pub(super) fn axis_of_text(&mut self, start: usize) -> Outcome<Val> {
        self.cursor.expect(b'(')?;
        let name = self.text()?;
        self.cursor.expect(b')')?;
        if let Some(letter) = self.axis_letter(&name) {
            return Ok(Val::Text(char::from(letter).to_string()));
        }
        let message = "AXNAME of a text that names no axis of the machine";
        let help = "write the letter of an axis in quotes";
        Err(self.cursor.fault("no-such-axis", message, help, start))
    }

    /// `$P_AXN1`, `$P_AXN2`, `$P_AXN3`: abscissa, ordinate and applicate of the plane in
    /// force; `None` for other names.
    pub(super) fn plane_axis(&self, name: &str) -> Option<Val> {
        let place = ["$P_AXN1", "$P_AXN2", "$P_AXN3"]
            .iter()
            .position(|known| *known == name)?;
        let axis = self.control.modal.plane.get(place)?;
        let letter = gwatt_machine::ALL_AXES.get(*axis)?.letter();
        Some(Val::Text(char::from(letter).to_string()))
    }
}
