//! What a share of the speed leaves that a control takes while it moves (`LinuxCNC`'s adaptive
//! feed), where that is not the plan: it comes into force some cycles late.

use std::borrow::Cow;

use super::demand::Demand;
use super::model::PowerModel;
use gwatt_machine::{CornerRule, Machine};
use gwatt_motion::{Move, MoveKind};
use gwatt_plan::lookahead::LATE_CYCLES;
use gwatt_plan::{Overrides, blended_bound};

/// A move at its whole speed: what holds for it holds at any share, and while that changes.
pub(super) fn unpaced(mv: &Move) -> Cow<'_, Move> {
    if mv.pace >= 1.0 {
        return Cow::Borrowed(mv);
    }
    let mut whole = mv.clone();
    whole.pace = 1.0;
    if mv.kind == MoveKind::Rapid {
        whole.rapid_factor /= mv.pace;
    } else {
        whole.feed_mm_s /= mv.pace;
    }
    Cow::Owned(whole)
}

impl PowerModel {
    /// The demand of a move that is so slow at its pace that it may exceed it before that is
    /// in force; `speed_mm_s` and `accel_mm_s2` are those of its plan.
    #[must_use]
    pub fn late(
        &self,
        machine: &Machine,
        mv: &Move,
        [speed_mm_s, accel_mm_s2]: [f64; 2],
        largest: Overrides,
    ) -> Option<Demand> {
        if mv.pace >= 1.0 || mv.length_mm <= 0.0 {
            return None;
        }
        let rules = machine.controller.planner.look_ahead?;
        let CornerRule::LinuxCnc { cycle_s, .. } = rules.corner else {
            return None;
        };
        let late_mm_s = LATE_CYCLES * cycle_s * accel_mm_s2;
        let whole_mm_s = speed_mm_s / mv.pace;
        if speed_mm_s <= 0.0 || speed_mm_s >= late_mm_s.min(whole_mm_s) {
            return None;
        }
        let pace = late_mm_s.min(whole_mm_s) / whole_mm_s;
        let mut early = unpaced(mv).into_owned();
        early.rapid_factor *= pace;
        early.feed_mm_s *= pace;
        let bound = blended_bound(machine, &early, largest);
        Some(self.robust(&early, &bound, &early.accel_mm_s2))
    }
}
