//! Turning cycles of Fanuc and Haas lathes (B-63604EN, "Canned Cycle", "Multiple
//! Repetitive Cycle"; Haas lathe operator's manual, "Canned Cycles").
//!
//! Each part of a cycle is a move of its own. Numbers here are those of G-code
//! systems A and B.

mod contour;
mod drill;
mod groove;
mod passes;
mod piece;
mod pockets;
mod rough;
mod single;
mod state;
mod thread;
mod words;

use state::Held;
pub(super) use state::Turning;
pub(crate) use state::{Contour, ContourCycle};

use super::letters::bit;
use gwatt_machine::AxisValues;

/// Numbers of the special motion words of lathes: G32; G90, G92 and G94 of
/// system A, by which G77, G78 and G79 they are in system B.
pub(super) const THREAD: u16 = 320;
pub(super) const BOX: u16 = 770;
pub(super) const THREAD_BOX: u16 = 780;
pub(super) const FACE: u16 = 790;

const X: usize = 0;
const Z: usize = 2;

/// Why it is not known how a cycle goes in detail.
const BY_PARAMETER: &str = "its return, escape or chamfer is a parameter of the control: give it \
                            in the program (R), or escape_mm and groove_return_mm under \
                            [language] of the machine file";

/// Why it is not known how the tool goes from pass to pass.
const TYPE_TWO: &str = "the first block of the contour names X and Z (type II): how the tool goes \
                        from pass to pass is a matter of the control; where the contour has no \
                        pocket leave out the axis that does not move there, or write under \
                        [language] of the machine file type_2 = \"as-type-1\" or \
                        \"along-contour\", as the control goes";

/// `at` with other places of X and Z.
fn xz(at: AxisValues, x: f64, z: f64) -> AxisValues {
    let mut place = at;
    place[X] = x;
    place[Z] = z;
    place
}
