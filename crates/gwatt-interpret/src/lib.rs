#![doc = include_str!("../README.md")]
//!
//! # A line at a time
//!
//! [`Interpreter::execute`] takes a block, changes the modal state and gives the
//! [`Step`]s of the line with its [`Facts`]: whether its words may be changed, and
//! what depends on them. Where a block does not go on at the next line, [`Flow`]
//! decides which line comes next. Files of subprograms are found below the paths of
//! [`Reading`], or on a [`Shelf`].

mod arc;
mod arc_words;
mod block_order;
mod calls;
mod macro_block;
mod code;
mod compensation;
mod control;
mod cycle;
mod data_setting;
mod datum;
mod datum_words;
mod dialect;
mod fast_path;
mod execute;
mod expression;
mod facts;
mod feed_expression;
mod feed_speed;
mod hidden_words;
mod first_motion;
mod flow;
mod g_codes;
mod given;
mod grbl;
mod grbl_words;
mod frame;
mod isg;
mod knob;
mod knob_words;
mod languages;
mod level_words;
mod loads;
mod label;
mod laser;
mod lathe_cycle;
mod letters;
mod m_words;
mod modal;
mod motion;
mod named_parameters;
mod nci;
mod offsets;
mod osp;
mod own_moves;
mod own_state;
mod output_knob;
mod passed_over;
mod parameter_file;
mod parameters;
mod places;
mod pocket;
mod position;
mod program_coordinates;
mod printer;
mod probe;
mod queue_words;
mod reading;
mod reference;
mod report;
mod rules;
mod settings;
mod shelf;
mod special;
mod spline;
mod siemens;
mod statement;
mod subprogram;
mod system_parameters;
mod thread;
mod thread_cycle;
mod speed_share;
mod spindle_speed;
mod spindle_announced;
mod fast_path_state;
mod stray;
mod state_words;
mod target_coordinates;
mod tool_table;
mod tools;
mod jump;
mod turned_arc;
mod turning;
mod vector;
mod words;
mod written_out;

pub use code::Motion;
pub use control::Effects;
pub use dialect::NO_POINT;
pub use execute::Interpreter;
pub use facts::{
    CalledCycle, Facts, MOVES_OF_ITSELF, OWN_MOVES, Passage, RUNS_A_FILE, SETS_UNKNOWN,
    TOOL_CHANGE_UNKNOWN, TWO_OF_A_GROUP, ToolWords,
};
pub use fast_path_state::FastPathState;
pub use flow::{Flow, Limits, Place};
pub use given::GivenVariable;
pub use gwatt_motion::{
    Action, ActionKind, Arc, Corner, FeedMode, Move, MoveKind, Square, Start, Step, Stray,
};
pub use knob::KnobState;
pub use modal::{FEED_MODE_UNKNOWN, Feed, Modal, NumberText};
pub use parameter_file::ParameterFile;
pub use reading::{BlockDelete, ProbeResult, ProbeWay, Reading};
pub use report::Diagnostics;
pub use shelf::Shelf;
pub use tool_table::{Tool, ToolTable};
