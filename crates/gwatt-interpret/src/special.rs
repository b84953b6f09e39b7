//! Motion words that make several moves, or moves that no word may change:
//! which there are, what they keep from block to block, and their dispatch.

mod words;

use super::code::{GCode, Motion};
use super::cycle::Held;
use super::reading::Reading;
use super::spline::Spline;
use crate::rules::{CycleWords, LanguageRules, rules_of};
use gwatt_machine::{AxisValues, Language};

/// Moves that one block may make: they are held in memory together.
const MOVES_OF_A_BLOCK: usize = 100_000;

/// Bit of the words that move, in `Words::groups`.
const MOTION_GROUP: u32 = 1;

/// How the spindle turns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Turning {
    Stopped,
    Clockwise,
    CounterClockwise,
}

impl Turning {
    /// The M word that sets it.
    pub(super) fn m_word(self) -> f64 {
        match self {
            Self::Stopped => 5.0,
            Self::Clockwise => 3.0,
            Self::CounterClockwise => 4.0,
        }
    }

    /// The M word that does the same to the spindle where it is not known whether the axes stop
    /// for it: M13, M14 and M19.
    pub(super) fn other_word(self) -> f64 {
        match self {
            Self::Stopped => 19.0,
            Self::Clockwise => 13.0,
            Self::CounterClockwise => 14.0,
        }
    }

    /// The other direction.
    pub(super) fn reversed(self) -> Self {
        match self {
            Self::Stopped => Self::Stopped,
            Self::Clockwise => Self::CounterClockwise,
            Self::CounterClockwise => Self::Clockwise,
        }
    }
}

/// What these words keep from block to block.
#[derive(Debug)]
pub(super) struct Special {
    /// Number × 10 of the cycle whose values are kept; 0 outside a cycle.
    pub(super) active: u16,
    pub(super) held: Held,
    pub(super) spline: Spline,
    /// G98 (true) or G99.
    pub(super) to_initial: bool,
    pub(super) spindle: Turning,
    /// Where the control believes the axes to be, if they stand elsewhere (G88
    /// of `LinuxCNC`): the next move makes up for it.
    pub(super) left: Option<AxisValues>,
    /// The motion word before the cycle, which is in force again after G80.
    before: Motion,
    /// Speed of a move in step with the spindle, mm/s.
    pub(super) speed_mm_s: Option<f64>,
    /// Moves made by repetition so far, and how many there may be.
    repeated: u64,
    most: u64,
}

impl Special {
    pub(super) fn new(rules: &LanguageRules, reading: &Reading) -> Self {
        Self {
            active: 0,
            held: Held::default(),
            spline: Spline::default(),
            // LinuxCNC starts with G99 (as its interpreter shows), Fanuc and
            // Haas with G98.
            to_initial: rules.cycles != CycleWords::Rs274,
            spindle: Turning::Stopped,
            left: None,
            before: Motion::None,
            speed_mm_s: None,
            repeated: 0,
            most: reading.limits.repeated_moves,
        }
    }

    /// The motion word before the cycle.
    pub(super) fn before(&self) -> Motion {
        self.before
    }

    /// M3, M4 and M5 (number × 10).
    pub(super) fn turn_spindle(&mut self, number: u16) {
        self.spindle = match number {
            30 => Turning::Clockwise,
            40 => Turning::CounterClockwise,
            _ => Turning::Stopped,
        };
    }
}

/// The special motion word with this number × 10.
pub(super) fn special_code(number: u16, language: &Language) -> Option<GCode> {
    let words = rules_of(language).cycles;
    let rs274 = words == CycleWords::Rs274;
    let cycles = language.mill_cycles && words != CycleWords::None;
    match number {
        382..=385 if rs274 => {}
        50..=53 | 330 | 331 if rs274 && cycles => {}
        730 | 740 | 760 if cycles => {}
        810..=890 if cycles && number.is_multiple_of(10) => {}
        310 if cycles && !rs274 => return Some(GCode::Skip),
        980 | 990 if cycles => return Some(GCode::Retract(number == 980)),
        _ => return None,
    }
    Some(GCode::Motion(Motion::Special(number)))
}
