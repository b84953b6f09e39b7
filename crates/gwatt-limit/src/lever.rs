//! Levers: which words may bring one move down, and what stands in the way.

use super::change::Permit;
use super::level_groups::{Groups, groups};
use super::options::LimitOptions;
use gwatt_machine::{AxisSet, Knob, KnobArgument, KnobTarget, Machine, RapidKnob, RapidPath};
use gwatt_motion::{Move, MoveKind, own_path_speed};

/// What shares may differ by from rounding.
const ROUNDING: f64 = 1e-9;

/// The rule of a refusal for a block that may not be changed.
pub const UNTOUCHABLE: &str = "untouchable";

/// The rule of a refusal where no word lowers a move.
pub const NO_KNOB: &str = "no-knob";

/// The rule of a refusal where lower cutting feeds are not permitted.
pub const FEED_NOT_ALLOWED: &str = "feed-not-allowed";

/// The word that lowers the speed of a move.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum SpeedLever {
    /// F.
    FeedWord,
    /// G1 and F for G0.
    AsFeed,
    /// A percentage of the rapid speed: index of the knob.
    RapidPercent(usize),
    /// The largest speed: index of the knob.
    Cap(usize),
}

/// The levers of one move.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Levers {
    pub(super) speed: Option<SpeedLever>,
    /// Index of the knob for acceleration, of those without levels.
    pub(super) accel: Option<usize>,
    /// Index of the knob for jerk.
    pub(super) jerk: Option<usize>,
    /// Knobs with levels for the move as it is.
    pub(super) levels: Groups,
    /// The same for a rapid that is written as a feed.
    pub(super) feed_levels: Groups,
}

impl Levers {
    /// The knob for acceleration, with levels or without.
    pub(super) fn accel_word(&self, machine: &Machine) -> Option<usize> {
        let knobs = &machine.controller.knobs;
        let mut levels = self.levels.iter().copied();
        self.accel
            .or_else(|| levels.find(|index| knobs.get(*index).is_some_and(Knob::sets_accel)))
    }
}

/// Why a move cannot be brought down.
#[derive(Debug, Clone, PartialEq)]
pub struct Obstacle {
    /// Short stable name.
    pub rule: &'static str,
    /// What stands in the way.
    pub message: String,
    /// What would help.
    pub help: String,
}

impl Obstacle {
    pub(super) fn new(
        rule: &'static str,
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> Self {
        Self {
            rule,
            message: message.into(),
            help: help.into(),
        }
    }
}

/// The first verified knob with this target (or `Accel`), in whatever form.
pub(super) fn accel_knob(machine: &Machine, target: KnobTarget) -> Option<usize> {
    let knobs = &machine.controller.knobs;
    // Where there are levels, they are the accelerations that percentages are taken of.
    let has_levels = knobs
        .iter()
        .any(|knob| knob.levels.is_some() && knob.sets_accel());
    let suits = |knob: &Knob| {
        !has_levels
            && knob.lowers_accel()
            && (knob.target == target || knob.target == KnobTarget::Accel)
    };
    knobs.iter().position(suits)
}

/// The knob for the speed of rapids.
fn rapid_knob(machine: &Machine, permit: &Permit) -> Option<usize> {
    let knobs = &machine.controller.knobs;
    let levels = knobs.iter().filter_map(|knob| knob.levels.as_ref());
    // Where there are levels of it, they are the speed that a percentage is taken of.
    let has_levels = levels
        .flat_map(|levels| &levels.list)
        .any(|level| level.rapid_factor != 1.0);
    let suits = |knob: &Knob| {
        knob.verified
            && knob.levels.is_none()
            && match knob.target {
                KnobTarget::RapidSpeed => !has_levels,
                KnobTarget::SpeedShare => permit.line_before,
                _ => false,
            }
    };
    let knob = || knobs.iter().position(suits);
    permit.knobs.then(knob).flatten()
}

/// Whether the axes stand for a knob where its word is put back right away: a feed costs less.
fn costs_stops(machine: &Machine, permit: &Permit, knob: usize) -> bool {
    permit.apart && is_share(machine, knob)
}

/// Whether a knob sets a share of the speed of all moves.
fn is_share(machine: &Machine, knob: usize) -> bool {
    let knob = machine.controller.knobs.get(knob);
    knob.is_some_and(|knob| knob.target == KnobTarget::SpeedShare)
}

/// The knob for the largest speed that acts on a move, where it can be put back.
pub(super) fn speed_knob(machine: &Machine, mv: &Move) -> Option<usize> {
    let spares = machine.controller.language.printer.path_accel_spares;
    let suits = |knob: &Knob| {
        let acts = match knob.argument {
            KnobArgument::Value => {
                (mv.moving.0 | mv.unknown_start.0) & !spares.0 != 0
                    && own_path_speed(machine).is_some()
            }
            KnobArgument::Axes | KnobArgument::Index => mv.arc.is_none(),
            KnobArgument::Assign
            | KnobArgument::Dynamics
            | KnobArgument::Path(_)
            | KnobArgument::Output(_)
            | KnobArgument::Level => false,
        };
        knob.verified && knob.target == KnobTarget::Speed && acts
    };
    let moves = matches!(mv.kind, MoveKind::Feed | MoveKind::Arc);
    moves
        .then(|| machine.controller.knobs.iter().position(suits))
        .flatten()
}

/// The same where a line with its word may come before the block.
pub(super) fn speed_cap(machine: &Machine, mv: &Move, permit: &Permit) -> Option<usize> {
    let knob = || speed_knob(machine, mv);
    permit.knobs.then(knob).flatten()
}

/// The knob for acceleration that acts on a move: one along the path where there is such
/// a limit that could be put back.
fn accel_lever(machine: &Machine, mv: &Move, target: KnobTarget) -> Option<usize> {
    let printer = &machine.controller.language.printer;
    let retracts = printer.retracts(mv.moving, mv.path_accel_mm_s2);
    accel_knob(machine, target).filter(|index| {
        let knob = machine.controller.knobs.get(*index);
        knob.is_some_and(|knob| {
            if retracts && knob.argument == KnobArgument::Axes {
                return false;
            }
            let along = knob.argument != KnobArgument::Value || mv.path_accel_mm_s2.is_finite();
            along && (!knob.with_jerk || is_scaled_evenly(machine, mv))
        })
    })
}

/// Whether accelerations and jerk of a move are one share of the machine's own, for which a
/// word that acts on both can stand.
fn is_scaled_evenly(machine: &Machine, mv: &Move) -> bool {
    mv.moving.iter().all(|axis| {
        let own_mm_s2 = machine.axes[axis].map_or(0.0, |data| data.accel_mm_s2);
        (mv.accel_mm_s2[axis] - mv.jerk_factor * own_mm_s2).abs() <= ROUNDING * own_mm_s2
    })
}

/// The knob for the jerk of a move, where axes that move have such a limit.
fn jerk_lever(machine: &Machine, mv: &Move) -> Option<usize> {
    let limited = |axis: usize| machine.axes[axis].is_some_and(|data| data.jerk_mm_s3 > 0.0);
    let follows = matches!(mv.kind, MoveKind::Rapid | MoveKind::Feed | MoveKind::Arc);
    if !follows || !mv.unknown_start.is_empty() || !mv.moving.iter().any(limited) {
        return None;
    }
    // Where the command gives accelerations as well, those are the machine's own.
    let own = mv.jerk_factor == 1.0 && is_scaled_evenly(machine, mv);
    let suits = |knob: &Knob| {
        knob.verified
            && knob.target == KnobTarget::Jerk
            && (own || knob.argument != KnobArgument::Dynamics)
    };
    machine.controller.knobs.iter().position(suits)
}

/// What may be used to bring `mv` down.
pub(super) fn levers(machine: &Machine, how: LimitOptions, mv: &Move, permit: &Permit) -> Levers {
    if !permit.edit {
        return Levers::default();
    }
    let acts = |index: &usize| {
        let knob = machine.controller.knobs.get(*index);
        knob.is_some_and(|knob| permit.knobs && (permit.stands || !knob.stands()))
    };
    if mv.kind != MoveKind::Rapid {
        let speed = if permit.feed_word {
            Some(SpeedLever::FeedWord)
        } else {
            speed_cap(machine, mv, permit).map(SpeedLever::Cap)
        };
        return Levers {
            speed: speed.filter(|_| how.allowed.feed || permit.positions),
            accel: accel_lever(machine, mv, KnobTarget::FeedAccel).filter(acts),
            jerk: jerk_lever(machine, mv).filter(acts),
            levels: groups(machine, permit, true),
            feed_levels: Groups::new(),
        };
    }
    let as_feed = || rapid_as_feed(machine, how, mv, permit);
    // A share of the speed acts late where it is not known how far the way is.
    let in_time = |knob: &usize| mv.unknown_start.is_empty() || !is_share(machine, *knob);
    let speed = match rapid_knob(machine, permit).filter(in_time) {
        Some(knob) if !(costs_stops(machine, permit, knob) && as_feed()) => {
            Some(SpeedLever::RapidPercent(knob))
        }
        _ => as_feed().then_some(SpeedLever::AsFeed),
    };
    // A rapid written as a feed is under the knobs of feeds, which may differ.
    let accel = accel_lever(machine, mv, KnobTarget::RapidAccel).filter(acts);
    let both = |index: &usize| {
        let knob = machine.controller.knobs.get(*index);
        let one_for_all = |knob: &Knob| {
            knob.stands() || matches!(knob.argument, KnobArgument::Index | KnobArgument::Assign)
        };
        knob.is_some_and(|knob| knob.target == KnobTarget::Accel && one_for_all(knob))
    };
    Levers {
        speed,
        accel: accel.filter(|index| speed != Some(SpeedLever::AsFeed) || both(index)),
        jerk: jerk_lever(machine, mv).filter(acts),
        levels: groups(machine, permit, false),
        feed_levels: groups(machine, permit, true),
    }
}

/// Whether G1 runs the same path as this G0, or one that is permitted, no faster.
fn rapid_as_feed(machine: &Machine, how: LimitOptions, mv: &Move, permit: &Permit) -> bool {
    let commanded = AxisSet(mv.moving.0 | mv.unknown_start.0);
    let clear =
        || mv.unknown_start.is_empty() && machine.path.is_clear(mv.moving, &mv.start, &mv.end);
    let straight = machine.path.rapid == RapidPath::Linear
        || commanded.iter().count() == 1
        || how.allowed.straighten && clear();
    machine.controller.rapid_knob == RapidKnob::G1
        && straight
        && permit.as_feed
        && permit.feed_word
        && commanded
            .iter()
            .all(|axis| permit.feed_accel_mm_s2[axis] <= mv.accel_mm_s2[axis])
}
