//! Jerk-limited profiles: the fastest way from one state to another under
//! limits of speed, acceleration and jerk.
//!
//! Input: a [`State`] to start from, a target, and [`JerkLimits`]. Output: a
//! [`JerkProfile`] of phases of constant jerk.
//!
//! * [`speed_target`]: to a speed and an acceleration, wherever that is: two or
//!   three phases.
//! * [`position_target`]: to a position with a speed and an acceleration: up to
//!   seven phases.
//!
//! A start outside the limits is first brought in, at full jerk; those phases
//! are counted apart. Units are mm and s in the names; any other unit of length
//! (degrees, revolutions) does as well.

mod bring_in;
mod family;
mod limits;
mod position;
mod profile;
mod root;
mod speed;

pub use super::phase::State;
pub use limits::{JerkError, JerkLimits};
pub use position::position_target;
pub use profile::JerkProfile;
pub use speed::speed_target;
