//! Blocks to moves: modal state, coordinates, arcs.
//!
//! In: blocks of a program, one by one. Out: moves in machine coordinates and
//! actions. Reference: RS274/NGC as documented by LinuxCNC, with what a
//! controller profile says otherwise.

mod arc;
mod arc_words;
mod calls;
mod beyond_words;
mod code;
mod compensation;
mod cycle;
mod data_setting;
mod dialect;
mod direct;
mod execute;
mod expression;
mod facts;
mod flow;
mod formula;
mod given;
mod grbl;
mod frame;
mod isg;
mod knob;
mod knob_words;
mod lathe_cycle;
mod m_words;
mod modal;
mod motion;
mod moves;
mod named_parameters;
mod offsets;
mod operator;
mod osp;
mod parameter_file;
mod parameters;
mod pocket;
mod position;
mod programmed;
mod printer;
mod probe;
mod queue_words;
mod reference;
mod report;
mod settings;
mod special;
mod spline;
mod siemens;
mod statement;
mod subprogram;
mod system_parameters;
mod thread;
mod thread_cycle;
mod spindle_speed;
mod spindle_told;
mod stance;
mod stray;
mod state_words;
mod targets;
mod tool_table;
mod tools;
mod transfer;
mod turned_arc;
mod turning;
mod vector;
mod words;
mod written_out;

pub(crate) use transfer::Transfer;

pub use code::Motion;
pub(crate) use cycle::FIXED as CYCLE;
pub use execute::Interpreter;
pub use facts::Facts;
pub(crate) use flow::Flow;
pub use flow::Limits;
pub use given::GivenVariable;
pub use knob::KnobState;
pub use modal::{Feed, Modal, NumberText};
pub(crate) use motion::path_length;
pub use moves::*;
pub use parameter_file::ParameterFile;
pub use position::{BlockDelete, ProbeResult, ProbeWay, Reading, Start};
pub use report::Diagnostics;
pub use stance::Stance;
pub use tool_table::{Tool, ToolTable};
pub(crate) use turning::FIXED as TURNING_CYCLE;
