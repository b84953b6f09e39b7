//! "Ramp time weighting (G132/G133/G134/G233)": how fast acceleration builds up,
//! in percent of the machine's ramp times.

use super::block::Reading;
use crate::expression::{Grammar, Outcome};
use gwatt_machine::AxisId;
use gwatt_syntax::Block;

const NOTE: &str = "G132, G133, G134 and G233 lengthen the ramps of acceleration: \
                    taken as not there, which counts higher";

impl Reading<'_, '_, '_> {
    /// `G132 X200 Y150`, `G133 = 200`; the G word has been taken.
    pub(super) fn ramp_times(&mut self, start: usize, block: &Block) -> Outcome<()> {
        let mut fine = block.words.is_empty();
        let mut shorter = false;
        while fine && self.cursor.peek().is_some() {
            let letter = self.cursor.byte(0);
            if AxisId::from_letter(letter).is_some() {
                self.cursor.at += 1;
            } else {
                fine = self.cursor.peek() == Some(b'=');
            }
            if fine {
                self.cursor.take(b'=');
                let percent = self.number()?;
                shorter |= percent < 100.0;
                fine = percent > 0.0;
            }
        }
        if !fine {
            self.cursor.pass_over_rest();
            let message = "a ramp time is a percentage above 0, in a block of its own";
            let help = "write G133 = 200, or G132 X200 Y150";
            return Err(self.cursor.fault("knob-value", message, help, start));
        }
        let mut axes = self.control.machine.axes.iter().flatten();
        if shorter && axes.any(|axis| axis.jerk_mm_s3 > 0.0) {
            let reason = "a jerk above the machine file's";
            return Err(self
                .cursor
                .refused("a ramp time below 100 percent", reason, start));
        }
        self.note("smoothing", NOTE, start);
        Ok(())
    }
}
