//! Look-ahead: several moves planned together.
//!
//! Input: path elements in order and the rules of a controller as data. Output:
//! a profile for each piece of path, with the speeds at its ends, and the arcs
//! that the controller lays round corners.

mod blend;
mod chord;
mod corner;
mod element;
mod glide;
mod join;
mod linuxcnc;
mod passage;
mod pending;
mod planner;
mod ramp;
mod runs;
mod vector;
mod window;

pub use chord::chord_count;
pub use element::{Curve, Element, Joint, common_accel};
pub use glide::{Gliding, Line};
pub use linuxcnc::LATE_CYCLES;
pub use planner::{Blend, PathPlanner, Piece, Planned};
pub use ramp::{Slack, Speeds2};
