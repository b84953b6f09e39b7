//! Kinds of machines.

use std::fmt;

/// Kinds of machines.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MachineKind {
    /// A mill: its Z is vertical.
    Mill,
    /// A lathe: the axes X and Z.
    Lathe,
    /// A router or an engraver: its Z is vertical.
    Router,
    /// A printer: its Z is vertical.
    Printer,
}

impl MachineKind {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Mill, Self::Lathe, Self::Router, Self::Printer];

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Mill => "mill",
            Self::Lathe => "lathe",
            Self::Router => "router",
            Self::Printer => "printer",
        }
    }

    /// The controller profile that is taken where none is given.
    #[must_use]
    pub fn usual_controller(self) -> &'static str {
        match self {
            Self::Mill => "iso",
            Self::Lathe => "fanuc-lathe",
            Self::Router => "grbl",
            Self::Printer => "marlin",
        }
    }

    /// Letters that its axes can have.
    #[must_use]
    pub fn letters(self) -> &'static str {
        match self {
            Self::Printer => "XYZUVWE",
            _ => "XYZUVWABC",
        }
    }

    /// Whether an axis goes up and down.
    #[must_use]
    pub fn is_vertical(self, letter: char) -> bool {
        letter == 'Z' && self != Self::Lathe
    }
}

impl fmt::Display for MachineKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
