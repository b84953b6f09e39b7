//! Blocks to moves: modal state, coordinates, arcs.
//!
//! In: blocks of a program, one by one. Out: moves in machine coordinates and
//! actions. Reference: RS274/NGC as documented by LinuxCNC, with what a
//! controller profile says otherwise.

mod arc;
mod code;
mod execute;
mod knob;
mod modal;
mod motion;
mod moves;
mod position;
mod report;
mod words;

pub use code::Motion;
pub use execute::{Facts, Interpreter};
pub use knob::KnobState;
pub use modal::{Feed, Modal};
pub use moves::*;
pub use position::Start;
pub use report::Diagnostics;
