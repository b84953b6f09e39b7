//! How deep the blocks have to be lowered that controllers run through.
//!
//! Lowering one block changes how its neighbours run: the next one accelerates
//! from a lower speed, and may then exceed the limit although it did not before.
//! The program is planned anew with the changes, and blocks that do not fit
//! then are lowered one step deeper, until all fit. A deeper step depends less
//! on the neighbours, so that this ends.

use std::collections::HashMap;

use crate::interpret::Move;

/// Where a line stands: which text, and its number there from 1.
pub type Place = (u16, u64);

/// Lines that are remembered one by one; with more, all lines count.
const LINES_MAX: usize = 1 << 17;

/// How deep the lines of a program have to be lowered.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Depths {
    lines: HashMap<Place, u8>,
    /// All lines at least.
    everywhere: u8,
}

impl Depths {
    /// The deepest step. From the second on each asks for a tenth less power,
    /// whatever the neighbours do.
    pub const DEEPEST: u8 = 12;

    /// The depth of a move's line: 0 where it is lowered only if it does not fit
    /// as planned.
    #[must_use]
    pub fn of(&self, mv: &Move) -> u8 {
        if self.lines.is_empty() {
            return self.everywhere;
        }
        let own = self.lines.get(&(mv.text, mv.line)).copied();
        own.unwrap_or(0).max(self.everywhere)
    }

    /// Lowers these lines, in the order of the program, one step deeper; false
    /// when none can be.
    pub fn deepen(&mut self, lines: &[Place]) -> bool {
        if self.lines.len() + lines.len() > LINES_MAX {
            let deeper = self.everywhere < Self::DEEPEST;
            self.everywhere += u8::from(deeper);
            return deeper;
        }
        let mut deeper = false;
        let mut last = None;
        for line in lines {
            // The moves of a line stand together.
            if last.replace(line) == Some(line) {
                continue;
            }
            let depth = self.lines.entry(*line).or_default();
            if *depth < Self::DEEPEST {
                *depth = (*depth).max(self.everywhere) + 1;
                deeper = true;
            }
        }
        deeper
    }

    /// Lines that [`Self::deepen`] is to be told at most.
    #[must_use]
    pub fn wanted() -> usize {
        LINES_MAX
    }
}

#[cfg(test)]
mod tests {
    use super::Depths;

    #[test]
    fn each_round_goes_one_step_deeper() {
        let mut depths = Depths::default();
        for _ in 0..Depths::DEEPEST {
            assert!(depths.deepen(&[(0, 7), (0, 7), (0, 9)]));
        }
        assert!(!depths.deepen(&[(0, 7)]));
        assert!(depths.deepen(&[(0, 7), (1, 7)]));
    }

    #[test]
    fn more_lines_than_are_remembered_count_all() {
        let mut depths = Depths::default();
        let lines: Vec<_> = (0..=Depths::wanted() as u64)
            .map(|line| (0, line))
            .collect();
        for _ in 0..Depths::DEEPEST {
            assert!(depths.deepen(&lines));
        }
        assert!(!depths.deepen(&lines));
        assert!(depths.lines.is_empty());
    }
}
