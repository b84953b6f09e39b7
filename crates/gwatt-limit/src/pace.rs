//! Speeds that moves are held to where the controller plans them together.
//!
//! What such a move draws depends on its neighbours, so that no value can be solved for it
//! by itself. Instead the program is planned as it would be written, and each line that
//! exceeds is held to the speed at which its own excess would be gone; lines that have room
//! left after that are let go again as far as they have it.

use std::collections::{HashMap, HashSet};

use super::place::Place;
use gwatt_machine::AXES;
use gwatt_motion::{Move, MoveKind};
use gwatt_plan::SpeedBound;
use gwatt_power::{Assessment, PowerModel};

/// What the power of steps of speed grows with at most: a power of the speed.
const STEPS_POWER: f64 = 3.0;
/// How much lower a line goes in a round at least, as a share; that grows by rounds, so that
/// they end.
const LEAST: f64 = 1e-4;
const GROWTH: f64 = 1.6;
/// Rounds after which lines go no lower.
const ROUNDS: u32 = 16;
/// How far a line is let go at once.
const RAISE: f64 = 4.0;
/// The share of its room that it leaves.
const ROOM: f64 = 2e-4;

/// What the plan of a written program says of a line that was lowered, or has to be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Paced {
    /// Where it stands.
    pub place: Place,
    /// The speed that it reaches, mm/s at the largest override.
    pub speed_mm_s: f64,
    /// The one at which it would be at the limit if its neighbours ran as they do; `None`
    /// where that says nothing.
    pub fitting_mm_s: Option<f64>,
}

impl Paced {
    /// What the plan says of a move.
    #[must_use]
    pub fn of(model: &PowerModel, place: Place, mv: &Move, judged: &Assessment) -> Self {
        Self {
            place,
            speed_mm_s: judged.top_speed_mm_s,
            fitting_mm_s: fitting_mm_s(model, mv, judged),
        }
    }
}

/// The speed at which a move would be at the limit if what it draws besides its base fell
/// with its speed.
pub(super) fn fitting_mm_s(model: &PowerModel, mv: &Move, judged: &Assessment) -> Option<f64> {
    let rest = model.robust(mv, &SpeedBound::default(), &[0.0; AXES]);
    let base = model.load_with_spindle(&rest, &judged.spindle, 0.0);
    let load = judged.demand.load_ratio;
    let share = (1.0 - base) / (load - base);
    let by_steps = judged.loads.steps > 1.0 && judged.loads.own <= 1.0;
    let share = if by_steps {
        libm::pow(share, 1.0 / STEPS_POWER)
    } else {
        share
    };
    let speed_mm_s = judged.top_speed_mm_s * share;
    (base < 1.0 && load > base && speed_mm_s > 0.0 && speed_mm_s.is_finite()).then_some(speed_mm_s)
}

/// Which moves one share is for.
#[derive(Debug, Clone, PartialEq)]
enum Whose {
    /// All but rapids.
    Feeds,
    /// Those of these lines.
    Lines(HashSet<Place>),
}

/// The speeds that lines are held to, mm/s at the largest override.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Paces {
    lines: HashMap<Place, f64>,
    /// Moves that are held to one share of their own speeds, instead.
    common: Option<(Whose, f64)>,
    /// What the plan of the last round said of lines that were lowered.
    last: Vec<Paced>,
    /// Lines that exceeded the limit in it.
    over: Vec<Place>,
    rounds: u32,
}

impl Paces {
    /// Holds lines to one share of their own speeds, and no others: nothing goes lower from
    /// round to round.
    #[must_use]
    pub fn common(lines: impl Iterator<Item = Place>, share: f64) -> Self {
        Self {
            common: Some((Whose::Lines(lines.collect()), share)),
            ..Self::default()
        }
    }

    /// The same for all moves but rapids.
    #[must_use]
    pub fn all_feeds(share: f64) -> Self {
        Self {
            common: Some((Whose::Feeds, share)),
            ..Self::default()
        }
    }

    /// The speed that a move is held to, mm/s, where it is; `own_mm_s` is its own.
    #[must_use]
    pub fn of(&self, mv: &Move, own_mm_s: f64) -> Option<f64> {
        let place = (mv.text, mv.line);
        if let Some((whose, share)) = &self.common {
            let concerned = match whose {
                Whose::Feeds => mv.kind != MoveKind::Rapid,
                Whose::Lines(lines) => lines.contains(&place),
            };
            return concerned.then_some(share * own_mm_s);
        }
        self.lines.get(&place).copied()
    }

    /// Whether moves that exceed are held by measure, round by round.
    #[must_use]
    pub fn measures(&self) -> bool {
        self.common.is_none()
    }

    /// Takes what the plan said of lines that were lowered, and those that exceed.
    pub fn learn(&mut self, found: Vec<Paced>, over: impl Iterator<Item = Place>) {
        self.last = found;
        self.over = over.collect();
    }

    /// The lines that were lowered or exceeded the limit in the last round.
    pub fn places(&self) -> impl Iterator<Item = Place> {
        let lowered = self.last.iter().map(|it| it.place);
        lowered.chain(self.over.iter().copied())
    }

    /// The lines that exceeded it.
    pub fn exceeding(&self) -> impl Iterator<Item = Place> {
        self.over.iter().copied()
    }

    /// How often lines went lower.
    #[must_use]
    pub fn rounds(&self) -> u32 {
        self.rounds
    }

    /// Holds lines that exceed to lower speeds; false where that was done often enough.
    pub(super) fn lower(&mut self, over: impl Iterator<Item = Paced>) -> bool {
        if self.rounds >= ROUNDS || !self.measures() {
            return false;
        }
        let least = LEAST * libm::pow(GROWTH, f64::from(self.rounds));
        self.rounds += 1;
        let mut lower = false;
        for Paced {
            place,
            speed_mm_s,
            fitting_mm_s,
        } in over
        {
            let Some(fitting_mm_s) = fitting_mm_s else {
                continue;
            };
            let speed_mm_s = fitting_mm_s.min(speed_mm_s * (1.0 - least));
            let known = self.lines.entry(place).or_insert(f64::INFINITY);
            lower |= speed_mm_s < *known;
            *known = known.min(speed_mm_s);
        }
        lower
    }

    /// The same with each line let go as far as the plan of the last round leaves it room.
    #[must_use]
    pub fn raised(&self) -> Self {
        let mut lines = HashMap::new();
        for found in &self.last {
            let most_mm_s = found.speed_mm_s * RAISE;
            let room_mm_s = found.fitting_mm_s.map_or(0.0, |it| it * (1.0 - ROOM));
            let held_mm_s = room_mm_s.clamp(found.speed_mm_s.min(most_mm_s), most_mm_s);
            let known = lines.entry(found.place).or_insert(f64::INFINITY);
            *known = f64::min(*known, held_mm_s);
        }
        Self {
            lines,
            ..Self::default()
        }
    }
}
