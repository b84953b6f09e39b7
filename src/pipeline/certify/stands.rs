//! Whether the axes stand where a rapid stood them still: before a feed that takes the place of
//! one, and after it.

use crate::interpret::{Move, MoveKind};
use crate::machine::{Machine, PathMode, RapidJoint};
use crate::pipeline::entry::rests;
use crate::pipeline::expected::ExpectedMove;

/// What the written program has done with the axes last.
#[derive(Debug)]
pub(super) struct Stands {
    /// They stand.
    stand: bool,
    /// They have to before anything moves.
    must: bool,
}

impl Stands {
    /// Before the program.
    pub(super) fn new() -> Self {
        Self {
            stand: true,
            must: false,
        }
    }

    /// A stop that the original does not have.
    pub(super) fn stop(&mut self) {
        *self = Self::new();
    }

    /// Takes the next move; false where it runs on from the one before it, though a rapid
    /// stopped there. `original`: what it was, where it may have changed.
    pub(super) fn take(
        &mut self,
        machine: &Machine,
        original: Option<&ExpectedMove>,
        mv: &Move,
    ) -> bool {
        if mv.kind == MoveKind::Dwell {
            self.stop();
            return true;
        }
        if !mv.moves_axes() {
            return true;
        }
        let was_rapid = |it: &ExpectedMove| it.as_feed && it.kind == MoveKind::Rapid;
        let blends = original.is_some_and(was_rapid)
            && mv.path_mode == PathMode::LookAhead
            && machine.controller.planner.rapid_joint != RapidJoint::All;
        let right = self.stand || !(blends || self.must);
        self.stand = rests(machine, mv) || mv.path_mode == PathMode::ExactStop;
        self.must = blends;
        right
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pipeline::{Moves, Options};

    /// A feed in place of a rapid runs on neither from the feed before it nor into the one
    /// after it.
    #[test]
    fn a_stop_that_is_missing_is_seen() {
        let machine = Machine::from_toml(
            "a.toml",
            "schema = 1\nname = \"a\"\ncontroller = \"fanuc\"\n[converter]\npeak_power_w = 1000\n\
             [axes.X]\nrapid_mm_min = 9000\naccel_mm_s2 = 2000\nmass_kg = 100\n",
        )
        .unwrap()
        .0;
        let program = "G64 G1 X1 F600\nG0 X9\nG1 X2\n";
        let moves: Vec<_> = Moves::of(program, &machine, &Options::default())
            .collect::<Result<_, _>>()
            .unwrap();
        let [feed, rapid, last] = &moves[..] else {
            unreachable!()
        };
        let unchanged = ExpectedMove::standing;
        let as_feed = ExpectedMove {
            as_feed: true,
            ..unchanged(rapid)
        };
        let written = Move {
            kind: MoveKind::Feed,
            ..rapid.clone()
        };
        let run = |stops: [bool; 2]| {
            let mut stands = Stands::new();
            let mut right = [stands.take(&machine, None, feed), false, false];
            for (index, (original, mv)) in [(Some(&as_feed), &written), (None, last)]
                .into_iter()
                .enumerate()
            {
                if stops[index] {
                    stands.stop();
                }
                right[index + 1] = stands.take(&machine, original, mv);
            }
            right
        };
        assert_eq!(run([true, true]), [true, true, true]);
        assert_eq!(run([false, true]), [true, false, true]);
        assert_eq!(run([true, false]), [true, true, false]);
    }
}
