//! Rows of the spindle alone: whether they fit, and what became of those of the
//! original.

use super::{Expected, Verdict};
use crate::interpret::Move;
use crate::pipeline::advice::SPINDLE_HELP;
use crate::power::{Assessment, PowerModel};

/// Rows that are kept until the original's are met.
const ROWS: usize = 1024;

impl Verdict<'_, '_> {
    /// Rows of the spindle are no steps.
    pub(super) fn pass_spindle(&mut self) {
        while matches!(self.originals.get(self.done), Some(Expected::Spindle(..))) {
            self.done += 1;
        }
    }

    /// Passes over what is no move, and writes rows of the spindle.
    pub(super) fn pass_to_move(&mut self) {
        loop {
            match self.originals.get(self.judged) {
                Some(Expected::Action(_)) => {}
                Some(Expected::Spindle(row, command)) => {
                    let mut judged = self.spindle.iter();
                    let met = judged.position(|(_, after)| after.spindle.command == *command);
                    let met = met.and_then(|place| self.spindle.remove(place));
                    let (start_s, after) = met.unzip();
                    // Without one the program does not wait any more.
                    row.duration_after_s = Some(after.map_or(0.0, |it| it.duration_s));
                    row.start_after_s = start_s.or(Some(self.tally.duration_s()));
                    row.peak_after_w = after.map(|it| it.demand.peak_w);
                    row.regen_after_w = after.map(|it| it.demand.regen_w);
                    self.tally.write(row);
                }
                _ => return,
            }
            self.judged += 1;
        }
    }

    /// A row of the spindle in the written program.
    pub(super) fn judge_spindle(&mut self, mv: &Move, after: &Assessment, text: &[u8]) {
        if !self.model.fits(&after.demand) {
            let message = message(&self.model, after);
            self.reasons.push(
                (mv.text, mv.line),
                "spindle-power",
                message,
                SPINDLE_HELP,
                text,
            );
        }
        if self.spindle.len() >= ROWS {
            self.spindle.pop_front();
        }
        self.spindle.push_back((self.tally.duration_s(), *after));
        self.tally.add(mv, after, text);
    }
}

/// What the spindle alone asks for that does not fit.
fn message(model: &PowerModel, after: &Assessment) -> String {
    let demand = &after.demand;
    let limit_w = model.limit_w(demand.converter);
    if demand.peak_w > limit_w {
        return format!(
            "the spindle alone needs {:.1} W of {limit_w:.1} W",
            demand.peak_w
        );
    }
    let regen_limit_w = model.regen_limit_w(demand.converter).unwrap_or(0.0);
    let regen_w = demand.regen_w;
    format!("the spindle alone feeds back {regen_w:.1} W, and {regen_limit_w:.1} W are permitted")
}
