//! "Rotate the coordinate system in the plane (#ROTATION ON/OFF)", which is
//! what G68 and G69 do.

use super::block::Reading;
use crate::expression::Outcome;
use gwatt_machine::ALL_AXES;
use gwatt_syntax::Block;

impl Reading<'_, '_, '_> {
    /// `#ROTATION ON [ANGLE=30 CENTER1=10 CENTER2=5]` as G68.
    pub(super) fn rotation_on(&mut self, start: usize, block: &mut Block) -> Outcome<()> {
        let [angle, first, second] = self.named_values(["ANGLE", "CENTER1", "CENTER2"])?;
        if !block.words.is_empty() || self.cursor.peek().is_some() {
            let message = "#ROTATION ON with other words";
            let help = "write it in a block of its own";
            return Err(self.cursor.fault("rotation", message, help, start));
        }
        self.cursor.add_word(b'G', 68.0, start, start, block)?;
        self.cursor
            .add_word(b'R', angle.unwrap_or_default(), start, start, block)?;
        let [one, two, _] = self.control.modal.plane;
        for (axis, value) in [(one, first), (two, second)] {
            if let Some(letter) = ALL_AXES.get(axis).map(|axis| axis.letter()) {
                self.cursor
                    .add_word(letter, value.unwrap_or_default(), start, start, block)?;
            }
        }
        Ok(())
    }
}
