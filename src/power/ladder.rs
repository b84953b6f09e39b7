//! Limits over time at lower overrides.
//!
//! A move that takes longer draws less, but what is drawn for longer may be worse: the
//! cruise of a hanging axis, a spindle that cuts on, a pause that is no longer than it
//! was. How that adds up over windows and in stores follows no simple rule, so the
//! program is planned and watched again at a ladder of overrides, feeds and rapids
//! together and each alone. Input: the moves of the program. Output: of each limit the
//! worst of all rungs.

use super::assess::Assessor;
use super::demand::Want;
use super::model::PowerModel;
use super::watch::{Rating, Watch};
use crate::interpret::{Action, Move};
use crate::machine::{Machine, OverrideAt};

/// Shares of the largest overrides, of feeds and rapids together.
const TOGETHER: [f64; 5] = [0.75, 0.5, 0.4, 0.25, 0.1];
/// Shares of one while the other is the largest.
const ALONE: [f64; 1] = [0.5];
/// By how much a lower override must be worse to be the one that is shown, as a share.
const WORSE: f64 = 1e-9;

/// The machine with its knobs at lower overrides; none where it limits nothing over
/// time, or where its knobs stand.
#[must_use]
pub fn rungs(machine: &Machine) -> Vec<Machine> {
    let limits = &machine.limits;
    let limited = || Watch::new(machine, &PowerModel::new(machine)).is_some();
    if limits.override_at.is_some() || !limited() {
        return Vec::new();
    }
    let together = TOGETHER.iter().map(|share| [*share, *share]);
    let alone = ALONE
        .iter()
        .flat_map(|share| [[*share, 1.0], [1.0, *share]]);
    let at = |[feed, rapid]: [f64; 2]| {
        let mut machine = machine.clone();
        machine.limits.override_at = Some(OverrideAt {
            feed: limits.feed_override_max * feed,
            rapid: limits.rapid_override_max * rapid,
            spindle: limits.spindle_override_max,
        });
        machine
    };
    together.chain(alone).map(at).collect()
}

/// Where the limits over time are looked at, in words.
pub fn rungs_in_words() -> String {
    let percent = |shares: &[f64]| {
        let shares = shares
            .iter()
            .map(|share| format!("{}", (share * 100.0).round()));
        shares.collect::<Vec<_>>().join(", ")
    };
    format!(
        "feed and rapid together at 100, {} % of the largest overrides, and each alone at {} %",
        percent(&TOGETHER),
        percent(&ALONE)
    )
}

impl Assessor<'_> {
    /// Watches the program at lower overrides too, each by an assessor for itself.
    #[must_use]
    pub fn with_lower(mut self, lower: Vec<Self>) -> Self {
        self.lower = lower;
        let watched = Want {
            energy: false,
            floor_w: f64::INFINITY,
            regen_floor_w: f64::INFINITY,
            accel: false,
        };
        for lower in &mut self.lower {
            lower.want = watched;
        }
        self
    }

    #[cold]
    pub(super) fn push_lower(&mut self, mv: &Move, text: &[u8]) {
        for lower in &mut self.lower {
            lower.push(mv, text, &mut |_, _, _| {});
        }
    }

    pub(super) fn end_line_lower(&mut self, moved: bool) {
        self.end_line(moved, &mut |_, _, _| {});
    }

    pub(super) fn act_lower(&mut self, action: &Action) {
        for lower in &mut self.lower {
            lower.act(action, &mut |_, _, _| {});
        }
    }

    pub(super) fn finish_lower(&mut self) {
        for lower in &mut self.lower {
            lower.finish(&mut |_, _, _| {});
        }
    }

    /// Of each limit the worst of all overrides that are looked at.
    pub(super) fn worst_ratings(&self, mut own: Vec<Rating>) -> Vec<Rating> {
        for lower in &self.lower {
            for (worst, found) in own.iter_mut().zip(lower.ratings()) {
                if found.load_ratio() > worst.load_ratio() * (1.0 + WORSE) {
                    *worst = Rating {
                        overrides: lower.machine.limits.override_at,
                        ..found
                    };
                }
            }
        }
        own
    }
}
