//! Where a motion runs at constant speed, and when to look for that again.

use super::terms::Terms;
use gwatt_machine::{LookAhead, Machine};
use gwatt_plan::Overrides;
use gwatt_plan::lookahead::Line;

/// Moves that pass at most before another look where one was in vain.
pub(super) const PAUSE_MAX: usize = 8;

/// What is known of gliding beforehand, and how far it has come.
#[derive(Debug)]
pub(in super::super) struct Glider {
    pub(super) terms: Terms,
    /// Moves that pass before another look, and before the one after that.
    pub(super) wait: usize,
    pub(super) pause: usize,
    /// The planner does not know of the last moves.
    pub(super) glide: Option<Glide>,
}

/// Where a motion glides.
#[derive(Debug)]
pub(super) struct Glide {
    /// Of F, mm/s.
    pub(super) feed_mm_s: f64,
    /// The same under the override, and its inverse.
    pub(super) speed_mm_s: f64,
    pub(super) s_per_mm: f64,
    /// The last move, and room for the next one; they change places.
    pub(super) lines: [Line; 2],
    pub(super) last: usize,
    /// The first move of all.
    pub(super) begun: u64,
    /// The first move that is not final.
    pub(super) first: u64,
    /// Σ 2·a·L, at least, of the moves after the first one.
    pub(super) ramp2: f64,
}

impl Glider {
    /// `blocks`: moves that may be open; 0: nothing glides.
    pub fn new(machine: &Machine, rules: &LookAhead, overrides: Overrides, blocks: usize) -> Self {
        Self {
            terms: Terms::new(machine, rules, overrides.feed, blocks),
            wait: 0,
            pause: 1,
            glide: None,
        }
    }

    /// A look was in vain.
    pub(super) fn back_off(&mut self) {
        self.wait = self.pause;
        if self.pause < PAUSE_MAX {
            self.pause += 1;
        }
    }

    /// The first move over which the motion glides, if it does.
    pub fn begun(&self) -> Option<u64> {
        self.glide.as_ref().map(|glide| glide.begun)
    }
}
