//! Cutter radius compensation: G40, G41, G42, G41.1 and G42.1.
//!
//! The tool's centre runs next to the programmed path, and where a move ends
//! depends on the next one. Each move is therefore held back, with what follows
//! it without leaving its place in the plane, until the next is known.
//!
//! How outside corners are passed and where the first and the last move meet
//! the shifted path is data of the controller profile: as LinuxCNC 2.9 does it
//! (manual, "Cutter Compensation" and "G41, G42", "G41.1, G42.1"; what it leaves
//! open was measured), Fanuc (B-63944EN, "Details of Cutter Compensation";
//! B-63604EN, "Details of Tool Nose Radius Compensation") or SINUMERIK
//! ("Tool radius compensation").
//!
//! Blocks are executed as if there were no compensation; what a block gives
//! then goes through here.

mod corner;
mod fault;
mod follow;
mod hold;
mod insert;
mod radius;
mod refusals;
mod straight;
mod words;
mod control;

use self::fault::Fault;
use self::hold::{Hold, place};
pub(super) use self::insert::{Corners, Insert};
pub(super) use self::radius::{Choice, ContourFeed};
use super::vector::Vector;
use gwatt_machine::{CompensationLead, CutterCompensation};
use gwatt_motion::{Move, Step};

/// Longest text of a line that is kept.
const TEXT_MAX: usize = 256;

/// How far the compensation is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum State {
    /// On, but nothing has moved yet.
    Entry,
    /// The tool is next to the path.
    On,
    /// G40 was read: the next move begins next to the path and ends on it.
    Leaving,
    /// Off.
    Off,
}

/// Compensation that is on, or whose end is still to be seen.
#[derive(Debug)]
pub(super) struct Compensation {
    state: State,
    style: CutterCompensation,
    /// The radius is 0: the path is as programmed, whatever the style.
    passive: bool,
    /// The move that waits is the one that switched it on.
    entering: bool,
    /// A move in the plane has come in this block.
    moved: bool,
    /// Blocks without one since the last.
    idle: u32,
    /// What F speaks for on arcs.
    feed: ContourFeed,
    /// Whether the plane was mirrored when it was switched on.
    flipped: bool,
    /// Axes of the plane.
    plane: [usize; 2],
    /// +1: the tool is to the left of its way; -1: to the right.
    side: f64,
    radius_mm: f64,
    /// From the centre of a lathe tool's nose to the point that the machine
    /// moves.
    nose: Vector,
    /// Where it was switched on the tool was still next to an earlier path: the
    /// first move must be straight.
    straight_first: bool,
    hold: Hold,
    /// Lines whose moves are held back, or were until this block.
    texts: Vec<((u16, u64), Vec<u8>)>,
    /// The steps of a block: a buffer.
    own: Vec<Step>,
}

impl Compensation {
    /// Whether G41 or G42 is in force.
    pub(super) fn is_on(&self) -> bool {
        matches!(self.state, State::Entry | State::On)
    }

    /// Ten times the G word in force: 400 for G40, 410 for G41 and G41.1, 420 for G42
    /// and G42.1.
    pub(super) fn code(&self) -> f64 {
        match self.state {
            State::Entry | State::On if self.side > 0.0 => 410.0,
            State::Entry | State::On => 420.0,
            _ => 400.0,
        }
    }

    /// The line of a move that was held back.
    pub(super) fn text_of(&self, mv: &Move) -> Option<&[u8]> {
        let key = (mv.text, mv.line);
        let found = self.texts.iter().find(|(held, _)| *held == key);
        found.map(|(_, text)| text.as_slice())
    }

    /// Whether it shifts a path: not with a radius of 0.
    pub(super) fn shifts(&self) -> bool {
        !self.passive && self.state != State::Off
    }

    /// Whether it is on, or was until the last block.
    pub(super) fn is_at_work(&self) -> bool {
        self.state != State::Off
    }

    /// Whether moves wait for their ends.
    pub(super) fn holds(&self) -> bool {
        !self.hold.steps.is_empty()
    }

    /// Keeps the text of a line while its moves wait, and for the block that
    /// lets them go.
    fn remember(&mut self, key: (u16, u64), text: &[u8]) {
        let known = self.texts.last().is_some_and(|(last, _)| *last == key);
        if self.holds() && !known {
            let (text, _) = gwatt_syntax::source::split_line_end(text);
            self.texts
                .push((key, text.get(..TEXT_MAX).unwrap_or(text).to_vec()));
        }
    }

    /// Forgets the lines whose moves have been passed on before this block: all
    /// but the one that did so.
    fn forget(&mut self) {
        if std::mem::take(&mut self.hold.handed_on) {
            let last = self.texts.pop().filter(|_| self.holds());
            self.texts.clear();
            self.texts.extend(last);
        }
    }

    /// Whether a move after G40 takes the tool back: in LinuxCNC any, elsewhere
    /// the first in the plane.
    fn leaves_by(&self, mv: &Move) -> bool {
        self.style.lead == CompensationLead::AtEnd
            || mv.arc.is_some()
            || self
                .plane
                .iter()
                .any(|&axis| mv.start[axis] != mv.end[axis])
    }

    /// The first move after G40 begins where the tool is. True where its
    /// length is one of linear axes.
    fn leave(&mut self, mv: &mut Move) -> bool {
        self.state = State::Off;
        let end = self.plane.map(|axis| mv.end[axis]);
        place(mv, self.plane, self.hold.tool, end, None)
    }
}
