//! Whether places were stated by numbers with a decimal point or without one, where nobody has
//! said what those without mean. How far it is from a place of one kind to a place of the other
//! is not known then (B-63944EN, "Decimal Point Programming").

use super::has_point;
use gwatt_machine::{AXES, AxisSet};
use gwatt_syntax::Word;

/// What a place, or a way, is measured by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Kind {
    /// It is 0, by whatever number.
    #[default]
    Zero,
    /// Numbers with a point, and what the machine knows.
    Pointed,
    /// Numbers without one.
    Pointless,
    /// Numbers of both kinds.
    Both,
}

impl Kind {
    /// What a sum is measured by.
    pub(super) fn with(self, other: Self) -> Self {
        match (self, other) {
            (Self::Zero, kind) | (kind, Self::Zero) => kind,
            (one, other) if one == other => one,
            _ => Self::Both,
        }
    }

    fn is_pointless(self) -> bool {
        matches!(self, Self::Pointless | Self::Both)
    }
}

/// The kinds of the places of all axes.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct PointKinds {
    /// The program has had a number without a point. Before, there is one kind alone.
    pub(super) begun: bool,
    pub(super) places: [Kind; AXES],
    /// Axes whose origin was set by numbers without a point.
    loose: AxisSet,
    /// The levels of a canned cycle.
    pub(super) levels: Kind,
    /// A macro was given a number without a point: what is worked out may rest on it.
    argument: bool,
    /// How far the axes of the present block go is not known.
    pub(super) apart: bool,
}

impl PointKinds {
    /// Whether it is not known how far the axes of the present block go.
    #[inline]
    pub(crate) fn apart(&self) -> bool {
        self.apart
    }

    /// A block begins.
    pub(super) fn begin_block(&mut self) {
        self.apart = false;
    }

    /// There is a number without a point.
    pub(super) fn begin(&mut self, in_cycle: bool) {
        if !self.begun && in_cycle {
            self.levels = Kind::Pointed;
        }
        self.begun = true;
    }

    /// A macro is given a number without a point.
    pub(super) fn give_argument(&mut self) {
        self.begun = true;
        self.argument = true;
    }

    /// An axis goes to a place of the machine: whether it is not known how far that is.
    pub(crate) fn return_to_machine(&mut self, axis: usize) -> bool {
        let loose = self.loose.contains(axis);
        let here = if loose { Kind::Both } else { Kind::Pointed };
        let from = std::mem::replace(&mut self.places[axis], here);
        loose || from.is_pointless()
    }

    /// An axis word moves its axis: what its way is measured by.
    pub(super) fn go(&mut self, axis: usize, kind: Kind, incremental: bool) -> Kind {
        let from = self.places[axis];
        self.places[axis] = if incremental { from.with(kind) } else { kind };
        if incremental { kind } else { from.with(kind) }
    }

    /// The same to a place of the machine.
    pub(super) fn go_to_machine(&mut self, axis: usize, kind: Kind) -> Kind {
        let unknown = self.return_to_machine(axis);
        if kind.is_pointless() {
            self.places[axis] = Kind::Both;
        }
        if unknown || kind.is_pointless() {
            Kind::Both
        } else {
            Kind::Pointed
        }
    }

    /// The place of an axis, seen from another origin.
    pub(super) fn seen_from_elsewhere(&self, axis: usize) -> Kind {
        // The origins may be apart by a number without a point.
        let between = if self.loose.contains(axis) {
            Kind::Both
        } else {
            Kind::Pointed
        };
        self.places[axis].with(between)
    }

    /// Where an axis stands is called otherwise: by this number, or further on by it.
    pub(super) fn rename(&mut self, axis: usize, kind: Kind, further: bool) {
        let from = self.places[axis];
        if kind.is_pointless() || from.is_pointless() && !further {
            self.loose.insert(axis);
        }
        self.places[axis] = if further {
            self.seen_from_elsewhere(axis).with(kind)
        } else {
            kind
        };
    }

    pub(super) fn of(&self, word: Word, text: &[u8]) -> Kind {
        let number = word.number.of(text);
        let plain = number
            .iter()
            .all(|byte| byte.is_ascii_digit() || b"+-. \t".contains(byte));
        if self.argument && !plain {
            Kind::Both
        } else if word.value == 0.0 {
            Kind::Zero
        } else if has_point(number) {
            Kind::Pointed
        } else {
            Kind::Pointless
        }
    }
}
