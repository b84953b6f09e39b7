//! How deep the blocks have to be lowered that controllers run through.
//!
//! Lowering one block changes how its neighbours run: the next one accelerates
//! from a lower speed, and may then exceed the limit although it did not before.
//! The program is planned again with the changes, and blocks that do not fit
//! then are lowered one step deeper, until all fit. A deeper step depends less
//! on the neighbours, so that this ends: after [`ROUNDS`] rounds all lines go
//! deeper together, however many of them take turns.

use std::collections::HashMap;

use super::pace::{Paced, Paces};
use super::place::Place;
use gwatt_motion::Move;

/// Lines that are remembered one by one; with more, all lines count.
const LINES_MAX: usize = 1 << 17;

/// Rounds in which lines go deeper one by one, and how far all go in each round
/// after those.
const ROUNDS: u32 = 24;
const STRIDE: u8 = 3;

/// How deep the lines of a program have to be lowered.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Depths {
    lines: HashMap<Place, u8>,
    /// All lines at least.
    everywhere: u8,
    /// How often it went deeper.
    rounds: u32,
    /// Speeds that lines are held to by measure, in place of going deeper.
    paces: Option<Paces>,
}

/// A line that exceeds the limit next to others as they are written.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Deeper {
    /// Where it stands.
    pub place: Place,
    /// What the plan says of it, where the controller's planner drives it as one move.
    pub paced: Option<Paced>,
}

impl Depths {
    /// Where moves are held to speeds by measure.
    #[must_use]
    pub fn by_measure(paces: Paces) -> Self {
        Self {
            paces: Some(paces),
            ..Self::default()
        }
    }

    /// The speeds that lines are held to.
    #[must_use]
    pub fn paces(&self) -> Option<&Paces> {
        self.paces.as_ref()
    }

    /// The same, to be changed.
    pub fn paces_mut(&mut self) -> Option<&mut Paces> {
        self.paces.as_mut()
    }

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
    pub fn deepen(&mut self, lines: &[Deeper]) -> bool {
        let mut lower = false;
        if let Some(paces) = &mut self.paces {
            if !paces.measures() {
                return false;
            }
            lower = paces.lower(lines.iter().filter_map(|line| line.paced));
        }
        // Those that no word slows down, and pieces of lines, are lowered by rounds.
        let places: Vec<Place> = lines.iter().map(|line| line.place).collect();
        let deeper = self.go_deeper(&places) || lower;
        self.rounds += u32::from(deeper);
        deeper
    }

    /// How often it went deeper.
    #[must_use]
    pub fn rounds(&self) -> u32 {
        self.rounds
    }

    fn go_deeper(&mut self, lines: &[Place]) -> bool {
        if self.rounds >= ROUNDS || self.lines.len() + lines.len() > LINES_MAX {
            return self.all_deeper();
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
        // Where a line is as deep as can be, others have their share in it.
        deeper || self.all_deeper()
    }

    /// Lowers all lines together.
    fn all_deeper(&mut self) -> bool {
        let before = self.everywhere;
        let late = self.rounds >= ROUNDS;
        let stride = if late { STRIDE } else { 1 };
        self.everywhere = (before + stride).min(Self::DEEPEST);
        self.everywhere > before
    }

    /// Lines that [`Self::deepen`] is given at most.
    #[must_use]
    pub fn wanted() -> usize {
        LINES_MAX
    }
}

#[cfg(test)]
mod tests {
    use super::super::place::Place;
    use super::{Deeper, Depths};

    fn lines(places: &[Place]) -> Vec<Deeper> {
        let line = |place: &Place| Deeper {
            place: *place,
            paced: None,
        };
        places.iter().map(line).collect()
    }

    #[test]
    fn each_round_goes_one_step_deeper() {
        let mut depths = Depths::default();
        for _ in 0..Depths::DEEPEST {
            assert!(depths.deepen(&lines(&[(0, 7), (0, 7), (0, 9)])));
        }
        assert_eq!(depths.everywhere, 0);
        assert!(depths.deepen(&lines(&[(0, 7), (1, 7)])));
        assert_eq!(depths.everywhere, 0);
        // As deep as can be: all go with it.
        assert!(depths.deepen(&lines(&[(0, 7)])));
        assert_eq!(depths.everywhere, 1);
    }

    /// However the lines take turns, there is a last round.
    #[test]
    fn lines_that_take_turns_come_to_an_end() {
        let mut depths = Depths::default();
        let mut line = 0;
        while depths.deepen(&lines(&[(0, line)])) {
            line += 1;
            assert!(line < 1000);
        }
        let together = u32::from(Depths::DEEPEST.div_ceil(super::STRIDE));
        assert_eq!(depths.rounds(), super::ROUNDS + together);
        assert_eq!(depths.everywhere, Depths::DEEPEST);
    }

    #[test]
    fn more_lines_than_are_remembered_count_all() {
        let mut depths = Depths::default();
        let places: Vec<_> = (0..=Depths::wanted() as u64)
            .map(|line| (0, line))
            .collect();
        let lines = lines(&places);
        for _ in 0..Depths::DEEPEST {
            assert!(depths.deepen(&lines));
        }
        assert!(!depths.deepen(&lines));
        assert!(depths.lines.is_empty());
    }
}
