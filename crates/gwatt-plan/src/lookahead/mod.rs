//! Look-ahead: several moves planned together.
//!
//! Input: path elements in order and the rules of a controller as data. Output:
//! a profile for each piece of path, with the speeds at its ends, and the arcs
//! that the controller lays round corners.

mod blend;
mod chord;
mod corner;
mod rounding;
mod element;
mod glide;
mod line;
mod join;
mod linuxcnc;
mod passage;
mod pending;
mod planner;
mod pieces;
mod ramp;
mod runs;
mod turn;
mod vector;
mod window;
mod node;

pub use chord::chord_count;
pub use element::{CornerSet, Curve, Element, Joint, common_accel};
pub use glide::Gliding;
pub use line::Line;
pub use linuxcnc::LATE_CYCLES;
pub use pieces::{Blend, Piece, Planned};
pub use planner::PathPlanner;
pub use ramp::{Slack, Speeds2};
