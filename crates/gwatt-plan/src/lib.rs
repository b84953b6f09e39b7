#![doc = include_str!("../README.md")]
//!
//! # From moves to profiles
//!
//! By itself a move is planned from rest to rest ([`plan()`]): a trapezoid or a
//! triangle under the limits that feed, axes and arcs set, or an S-curve where axes
//! limit their jerk. [`lookahead`] plans several moves together, [`period`] steps a
//! speed planner in interpolation periods, and [`jerk`] finds the shortest motion
//! between two states.

mod arc;
mod arc_plane;
mod bound;
pub mod curve;
mod drive;
mod driven_ramp;
pub mod jerk;
mod limits;
mod axis_limits;
mod path_limits;
pub mod lookahead;
pub mod period;
mod power_law;
mod phase;
mod profile;
#[cfg(test)]
mod random;
mod s_curve;
mod section;
mod slope;
mod spindle;
mod track;
mod trajectory;
mod overrides;

pub use bound::{PathShares, SpeedBound, blended_bound, blended_speed, path_bound, speed_bound};
pub use lookahead::Blend;
pub use overrides::{Caps, Overrides};
pub use phase::{Phase, PhaseKind, State};
pub use profile::{Phases, Profile};
pub use section::Section;
pub use spindle::{SpindleCaps, SpindleDrive};
pub use track::{AxisStates, Nearest, Track};
pub use trajectory::{
    PathFigures, Plan, Trajectory, UnknownMotion, driven_accel, is_independent, path_figures, plan,
    plan_with, ramps,
};
