//! Why a move cannot be lowered, and what would permit it.

use super::case::Case;
use super::change::Change;
use super::lever::{FEED_NOT_ALLOWED, NO_KNOB, Obstacle, SpeedLever, UNTOUCHABLE, speed_cap};
use super::options::{Allowed, LimitOptions};
use super::solver::Solver;
use gwatt_machine::{AxisSet, RapidKnob, RapidPath};
use gwatt_motion::{CYCLE, MoveKind, TURNING_CYCLE};

/// What can always be done about a block that may not be changed.
const BY_HAND: &str = "change it by hand";
/// The same for a cycle that could not be written out.
const STAYS_A_CYCLE: &str = "it cannot be written out as single blocks here: more power, slower \
     axes or blocks written by hand are needed";

/// The same for rapids whose axes move each for itself, and where they may run along lines.
const NOT_STRAIGHT: &str = "where the control moves them along a line (a parameter), say rapid = \
     \"linear\" under [path]; or permit lines where there is room: `clearance` under [path] and \
     --allow straighten";
const BELOW_CLEARANCE: &str = "where the control moves them along a line (a parameter), say \
     rapid = \"linear\" under [path]; it may become a line only beyond the `clearance` under [path]";

impl Solver<'_> {
    pub(super) fn no_speed_lever(&self, case: Case<'_>) -> Obstacle {
        let Case { mv, permit, .. } = case;
        let capped = speed_cap(self.machine, mv, permit);
        if !permit.edit || mv.kind != MoveKind::Rapid && !permit.feed_word && capped.is_none() {
            return Obstacle::new(
                UNTOUCHABLE,
                format!("the block may not be changed: {}", permit.reason),
                self.help_or(case, BY_HAND),
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
        let each_for_itself = self.machine.path.rapid == RapidPath::Independent
            && self.machine.controller.rapid_knob == RapidKnob::G1
            && AxisSet(mv.moving.0 | mv.unknown_start.0).iter().count() > 1;
        if each_for_itself && !mv.unknown_start.is_empty() {
            return Obstacle::new(
                NO_KNOB,
                "the rapid may not be written as a feed: where it starts is not known",
                "give --start X…,Y…,Z…, or what its place rests on ([offsets], reference_mm, \
                 --tool-table); or write the move as a feed by hand",
            );
        }
        if permit.reason.is_empty() && each_for_itself {
            return Obstacle::new(
                NO_KNOB,
                "the rapid may not be written as a feed: its axes move each for itself, not along \
                 a line",
                if self.how.allowed.straighten {
                    BELOW_CLEARANCE
                } else {
                    NOT_STRAIGHT
                },
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
        let usual = "write the move as a feed by hand, or lower the rapid speed of the machine";
        let help = self.help_or(case, usual);
        Obstacle::new(NO_KNOB, message, help)
    }

    /// What can be done about the reason for which a block may not be changed, or else what
    /// `usual` says. What is permitted already is not named.
    fn help_or(&self, case: Case<'_>, usual: &'static str) -> &'static str {
        let cycle = [CYCLE, TURNING_CYCLE].contains(&case.permit.reason);
        if cycle && self.how.allowed.expand {
            return STAYS_A_CYCLE;
        }
        case.permit.help_or(usual)
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

    /// No value helps. What is too much is named: what is drawn, or what is fed back.
    pub(super) fn too_much(&self, case: Case<'_>) -> Obstacle {
        let back = self.back_limit_w(case);
        if let Some(limit_w) = back.filter(|it| self.is_more_back(case, *it)) {
            return fed_back(case, limit_w);
        }
        Obstacle::new(
            "no-solution",
            format!(
                "no value of the permitted words brings {} W down to the limit",
                figure(case.assessment.demand.peak_w)
            ),
            if self.may_go_slower(case) {
                "at its speed base load and friction leave too little: --allow feed permits lower \
                 feeds"
            } else {
                "base load and friction leave too little: a larger converter, or another strategy"
            },
        )
    }

    /// No value helps a block that the control blends with its neighbours.
    pub(super) fn no_value_for_all(&self, case: Case<'_>) -> Obstacle {
        if let Some(limit_w) = self.back_limit_w(case).filter(|it| *it <= 0.0)
            && self.is_more_back(case, limit_w)
        {
            return fed_back(case, limit_w);
        }
        let help = "a word for acceleration, or path.mode = \"exact-stop\" if the machine stops \
                    at every block";
        let message = "no value of the permitted words brings this block and its neighbours down \
                       to the limit";
        let feed = if self.how.allowed.feed {
            ""
        } else {
            "--allow feed, "
        };
        Obstacle::new("no-solution", message, format!("{feed}{help}"))
    }

    /// Whether a lower feed is a way that was not permitted.
    fn may_go_slower(&self, case: Case<'_>) -> bool {
        let Case { mv, permit, .. } = case;
        let cuts = mv.kind != MoveKind::Rapid && !permit.positions;
        cuts && permit.edit && permit.feed_word && !self.how.allowed.feed
    }

    fn back_limit_w(&self, case: Case<'_>) -> Option<f64> {
        self.model.regen_limit_w(case.assessment.demand.converter)
    }

    /// Whether a move exceeds what may be fed back, and by more than what may be drawn.
    fn is_more_back(&self, case: Case<'_>, limit_w: f64) -> bool {
        let demand = &case.assessment.demand;
        let drawn = demand.peak_w / self.model.limit_w(demand.converter);
        demand.regen_w > limit_w * drawn.max(1.0)
    }

    pub(super) fn no_accel_lever(&self, case: Case<'_>) -> Obstacle {
        if !case.permit.edit {
            let message = format!("the block may not be changed: {}", case.permit.reason);
            return Obstacle::new(UNTOUCHABLE, message, self.help_or(case, BY_HAND));
        }
        let message = format!(
            "the controller `{}` has no word for this acceleration",
            self.machine.controller.name
        );
        Obstacle::new(NO_KNOB, message, "use --strategy optimal or speed")
    }
}

/// No value brings down what is fed back.
fn fed_back(case: Case<'_>, limit_w: f64) -> Obstacle {
    let message = format!(
        "no value of the permitted words brings the {} W that are fed back down to the limit of \
         {} W",
        figure(case.assessment.demand.regen_w),
        figure(limit_w)
    );
    Obstacle::new("no-solution", message, back_help(limit_w))
}

/// A power in W with the digits that distinguish it from 0.
fn figure(power_w: f64) -> String {
    if power_w == 0.0 || power_w >= 10.0 {
        format!("{power_w:.0}")
    } else {
        format!("{power_w:.2}")
    }
}

/// What can be done where too much is fed back.
fn back_help(limit_w: f64) -> &'static str {
    if limit_w <= 0.0 {
        "with `regen_power_w` of 0 no axis may brake: leave it out where the capacitors of the \
         bus take what small drives feed back (`capacitance_f` and `bus_max_v` count that), or \
         give what the supply or its braking resistor takes"
    } else {
        "`regen_power_w` is what the supply or its braking resistor takes: a larger resistor, or \
         `credit_regen = true` where other axes on the bus take what one feeds back"
    }
}
