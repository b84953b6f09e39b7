#![doc = include_str!("../README.md")]
//!
//! # From demand to adjustments
//!
//! Input: moves with their assessments, and what may be changed about each
//! ([`Permit`]). Output: for each move, in order, the [`Change`] that makes it fit, or
//! why there is none ([`Obstacle`]). [`Limiter`] takes the moves of a program,
//! [`Solver`] one by itself.

mod accels;
mod accel_grid;
mod alone;
mod along;
mod bounds;
mod by_axis;
mod case;
mod change;
mod decide;
mod depth;
mod first_feed;
mod halt;
mod held;
mod jerk;
mod joints;
mod law;
mod level;
mod level_groups;
mod knob_level;
mod lever;
mod limiter;
mod slot;
mod settle;
mod optimum;
mod options;
mod pace;
mod place;
mod refusal;
mod road;
mod root;
mod solver;
mod split;
mod stages;
mod steps;
mod stop;
mod window;
mod members;

pub use case::Ends;
pub use change::{Change, Permit};
pub use depth::{Deeper, Depths};
pub use first_feed::FirstFeed;
pub use lever::{FEED_NOT_ALLOWED, NO_KNOB, Obstacle, UNTOUCHABLE};
pub use limiter::Limiter;
pub use options::{Allowed, Law, LimitOptions, PresetElse, Strategy};
pub use pace::{Paced, Paces};
pub use place::Place;
pub use slot::{Outcome, Waiting};
pub use solver::Solver;
pub use split::{Piece, Split};
