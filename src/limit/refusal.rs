//! Why a move cannot be lowered, and what would permit it.

use super::case::Case;
use super::change::Change;
use super::lever::{FEED_NOT_ALLOWED, NO_KNOB, Obstacle, SpeedLever, UNTOUCHABLE, speed_knob};
use super::options::{Allowed, LimitOptions};
use super::solver::Solver;
use crate::interpret::MoveKind;
use crate::machine::{RapidKnob, RapidPath};

/// What can always be done about a block that may not be changed.
const BY_HAND: &str = "change it by hand";

impl Solver<'_> {
    pub(super) fn no_speed_lever(&self, case: Case<'_>) -> Obstacle {
        let Case { mv, permit, .. } = case;
        let capped = speed_knob(self.machine, mv);
        if !permit.edit || mv.kind != MoveKind::Rapid && !permit.feed_word && capped.is_none() {
            return Obstacle::new(
                UNTOUCHABLE,
                format!("the block may not be changed: {}", permit.reason),
                permit.help_or(BY_HAND),
            );
        }
        if mv.kind != MoveKind::Rapid {
            // Next to others it is known once the program was limited with the permission.
            let alone = !case.assessment.ahead && !case.assessment.blended;
            let by_f = (permit.feed_word && alone).then(|| {
                self.allowing_feeds()
                    .speed(case, SpeedLever::FeedWord, &Change::default())
            });
            let help = match by_f.flatten().and_then(|it| it.feed) {
                Some(feed) => format!("it fits at F{feed}: --allow feed permits that"),
                None => "--allow feed permits lower feeds".to_owned(),
            };
            return Obstacle::new(
                FEED_NOT_ALLOWED,
                "cutting feeds are not changed without permission",
                help,
            );
        }
        if !mv.unknown_start.is_empty() {
            return Obstacle::new(
                NO_KNOB,
                "the rapid may not be written as a feed: where it starts is not known",
                "give --start X…,Y…,Z…, or write the move as a feed by hand",
            );
        }
        let each_for_itself = self.machine.path.rapid == RapidPath::Independent
            && self.machine.controller.rapid_knob == RapidKnob::G1
            && mv.moving.iter().count() > 1;
        if permit.reason.is_empty() && each_for_itself {
            return Obstacle::new(
                NO_KNOB,
                "the rapid may not be written as a feed: its axes move each for itself, not along \
                 a line",
                "where the control moves them along a line (a parameter), say rapid = \"linear\" \
                 under [path]; or permit lines where there is room: `clearance` under [path] and \
                 --allow straighten",
            );
        }
        let message = if permit.reason.is_empty() {
            format!(
                "the controller `{}` has no word that lowers this rapid",
                self.machine.controller.name
            )
        } else {
            format!("the rapid may not be written as a feed: {}", permit.reason)
        };
        let help = permit
            .help_or("write the move as a feed by hand, or lower the rapid speed of the machine");
        Obstacle::new(NO_KNOB, message, help)
    }

    /// The same where cutting feeds may be lowered.
    fn allowing_feeds(&self) -> Self {
        Self {
            how: LimitOptions {
                allowed: Allowed {
                    feed: true,
                    ..Allowed::NOTHING
                },
                ..self.how
            },
            model: self.model.clone(),
            ..*self
        }
    }

    pub(super) fn no_accel_lever(&self, case: Case<'_>) -> Obstacle {
        if !case.permit.edit {
            let message = format!("the block may not be changed: {}", case.permit.reason);
            return Obstacle::new(UNTOUCHABLE, message, case.permit.help_or(BY_HAND));
        }
        let message = format!(
            "the controller `{}` has no word for this acceleration",
            self.machine.controller.name
        );
        Obstacle::new(NO_KNOB, message, "use --strategy optimal or speed")
    }
}

/// No value helps.
pub(super) fn too_much(case: Case<'_>) -> Obstacle {
    Obstacle::new(
        "no-solution",
        format!(
            "no value of the permitted words brings {:.0} W down to the limit",
            case.assessment.demand.peak_w
        ),
        "base load and friction leave too little: a larger converter, or another strategy",
    )
}
