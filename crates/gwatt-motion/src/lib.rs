#![doc = include_str!("../README.md")]
//!
//! # What is what
//!
//! A [`Step`] is a [`Move`] (a path element or a dwell) or an [`Action`]. Positions
//! are in mm or degrees and machine coordinates, times in s. A move carries what was
//! in force when it was commanded: its feed, the limits of acceleration, what happens
//! at its end ([`Corner`]), and how far the control may stray from it ([`Stray`]).

mod fixed;
mod path_limits;
mod moves;
mod length;
mod start;

pub use fixed::{CYCLE, TURNING_CYCLE};
pub use length::path_length;
pub use moves::*;
pub use path_limits::{
    SpeedSteps, Square, hold_to_path, own_path_accel, own_path_speed, raise_to_path,
};
pub use start::Start;
