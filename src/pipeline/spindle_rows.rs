//! Rows of the spindle alone, on their way to the certifier next to the moves.

use std::collections::VecDeque;

use super::describe::row;
use super::expected::Expected;
use crate::interpret::{Move, MoveKind};
use crate::machine::Machine;
use crate::power::{Assessment, PowerModel};

/// Rows that wait for the moves before them.
#[derive(Debug, Default)]
pub(super) struct SpindleRows {
    /// With the number of moves before each.
    rows: VecDeque<(u64, Move, Assessment)>,
    /// Moves that were judged, and those that were written.
    judged: u64,
    written: u64,
}

impl SpindleRows {
    /// Keeps a row of the spindle, and counts a move; true for a move.
    pub(super) fn judge(&mut self, mv: &Move, assessment: &Assessment) -> bool {
        if mv.kind == MoveKind::Spindle {
            self.rows.push_back((self.judged, mv.clone(), *assessment));
            return false;
        }
        self.judged += 1;
        true
    }

    /// A move is written.
    pub(super) fn write(&mut self) {
        self.written += 1;
    }

    /// Hands over the rows before the next move, where rows are wanted; their
    /// time passes.
    pub(super) fn hand_over(
        &mut self,
        (machine, model, exact): (&Machine, &PowerModel, bool),
        start_s: &mut f64,
        expected: &mut Vec<Expected>,
    ) {
        while let Some((_, mv, assessment)) = self.rows.pop_front_if(|it| it.0 <= self.written) {
            if exact {
                let mut row = row(machine, model, &mv, &assessment, *start_s);
                if !model.fits(&assessment.demand) {
                    row.action = "none possible";
                }
                let command = assessment.spindle.command;
                expected.push(Expected::Spindle(Box::new(row), command));
            }
            *start_s += assessment.duration_s;
        }
    }

    /// A move is written where no rows are wanted.
    pub(super) fn pass(&mut self) {
        self.rows.clear();
        self.written += 1;
    }

    /// Forgets all rows.
    pub(super) fn clear(&mut self) {
        self.rows.clear();
    }
}
