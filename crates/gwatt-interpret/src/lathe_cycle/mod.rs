//! G70, G71 and G72 of `LinuxCNC`: finishing and roughing about a contour that
//! stands in a subroutine ("G70 Lathe finishing cycle", "G71 G72 Lathe roughing
//! cycles"; what the manual leaves open is as its interpreter 2.9 does it).
//!
//! The subroutine is executed for its O words and assignments; of its other words
//! only X, Z, U, W, I, K, R, A, C and the motion words count.

pub(crate) mod contour;
mod passes;
mod piece;
mod shape;
mod words;

use super::code::GCode;
use super::label::Label;
use super::vector::Vector;

const X: usize = 0;
const Z: usize = 2;

/// Arcs shorter than this are left out.
const SAME_PLACE_MM: f64 = 1e-4;
/// Why no word of such a block is changed.
const FIXED: &str = "it is a turning cycle";

/// A cycle whose contour is still to be read.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LatheCycle {
    /// The subroutine of the contour.
    pub(crate) contour: Label,
    /// From where it works: Z and X, program units.
    start: Vector,
    cycle: Cycle,
}

/// The cycles; lengths in program units.
#[derive(Debug, Clone, PartialEq)]
enum Cycle {
    /// G70: distances of the first and the last pass from the contour.
    Finish { first: f64, last: f64, times: u32 },
    /// G71, and G72 (facing).
    Rough(RoughCycle),
}

/// The values of a roughing cycle.
#[derive(Debug, Clone, Copy, PartialEq)]
struct RoughCycle {
    facing: bool,
    pockets: Pockets,
    /// What is left for finishing, next to the contour and in Z and X.
    left: f64,
    shift: Vector,
    depth: f64,
    retract: f64,
}

/// What happens to valleys after the first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Pockets {
    /// G71, G72.
    Cut,
    /// G71.1, G72.1: they are left.
    Left,
    /// G71.2, G72.2: what that has left.
    Only,
}

/// Why a contour cannot be followed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Fault {
    Short,
    Back,
    Shift,
    Parallel,
    Level,
    Corner,
    Endless,
    Many,
}

impl Fault {
    fn message(self) -> &'static str {
        match self {
            Self::Short => "the contour of the cycle needs two moves at least",
            Self::Back => "the contour of the cycle goes back on itself",
            Self::Shift => "the contour of the cycle does not survive being shifted that far",
            Self::Parallel => {
                "two lines of the contour lie in one line, which the cycle cannot join"
            }
            Self::Level => "the cycle finds no way along its contour",
            Self::Corner => "a corner of the contour does not take its A or C",
            Self::Endless => "the cycle comes to no end",
            Self::Many => "the cycle makes more than 90000 moves",
        }
    }
}

/// G70 to G72.2 of `LinuxCNC`.
pub(super) fn lathe_cycle_code(number: u16) -> Option<GCode> {
    let known = matches!(number, 700 | 710..=712 | 720..=722);
    known.then_some(GCode::LatheCycle(number))
}
