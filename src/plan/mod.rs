//! Moves to profiles: how speed runs along each move.
//!
//! Every block ends at rest (exact stop): a trapezoid or a triangle under the
//! limits that feed, axes and arcs set.

mod arc;
mod bound;
mod limits;
pub mod lookahead;
mod profile;
mod trajectory;

pub use bound::{SpeedBound, blended_bound, blended_speed, path_bound, speed_bound};
pub use lookahead::Blend;
pub use profile::{Phase, PhaseKind, Profile, State};
pub use trajectory::{
    Caps, Overrides, PathFigures, Plan, Trajectory, UnknownMotion, is_independent, path_figures,
    plan, plan_with,
};
