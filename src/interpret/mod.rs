//! Blocks to moves: modal state, coordinates, arcs.
//!
//! In: blocks of a program, one by one. Out: moves in machine coordinates and
//! actions. Reference: RS274/NGC as documented by LinuxCNC, with what a
//! controller profile says otherwise.

mod arc;
mod arc_words;
mod code;
mod execute;
mod expression;
mod facts;
mod flow;
mod knob;
mod knob_words;
mod m_words;
mod modal;
mod motion;
mod moves;
mod parameters;
mod position;
mod printer;
mod reference;
mod report;
mod settings;
mod siemens;
mod statement;
mod subprogram;
mod system_parameters;
mod transfer;
mod words;

pub use code::Motion;
pub use execute::Interpreter;
pub use facts::Facts;
pub(crate) use flow::Flow;
pub use flow::Limits;
pub use knob::KnobState;
pub use modal::{Feed, Modal, NumberText};
pub use moves::*;
pub use position::{Reading, Start};
pub use report::Diagnostics;
