//! Groups of levels that a move may get.

use super::change::Permit;
use arrayvec::ArrayVec;
use gwatt_machine::{KnobArgument, KnobTarget, LEVEL_GROUPS, Machine};

/// Groups of levels, by the indices of their knobs.
pub(super) type Groups = ArrayVec<usize, LEVEL_GROUPS>;

/// The groups whose levels may be written for moves of this kind, as feeds (true) or rapids.
pub(super) fn groups(machine: &Machine, permit: &Permit, as_feed: bool) -> Groups {
    let mut found = Groups::new();
    if !permit.levels {
        return found;
    }
    for (index, knob) in machine.controller.knobs.iter().enumerate() {
        let acts = match knob.target {
            KnobTarget::FeedAccel => as_feed,
            KnobTarget::RapidAccel | KnobTarget::RapidSpeed => !as_feed,
            KnobTarget::Accel => true,
            KnobTarget::Jerk
            | KnobTarget::Speed
            | KnobTarget::SpeedShare
            | KnobTarget::CruiseRatio => false,
        };
        let may = knob.verified && (knob.between_moves || permit.rests);
        if knob.argument == KnobArgument::Level && acts && may {
            // There are no more groups than this.
            let _ = found.try_push(index);
        }
    }
    found
}
