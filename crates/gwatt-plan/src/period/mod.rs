//! The interpolation-period planner: jerk-limited speed with a region of
//! constant torque and one of constant power.
//!
//! Input: speed and acceleration as the last period put them out, a target, and
//! limits that depend on the speed. Output: speed and acceleration of the next
//! period. [`Ramp`] is the whole curve at once.
//!
//! Units are free: a speed of one unit, its change in one second, and so on.

mod cell;
mod climb;
mod curve;
mod envelope;
mod limits;
mod panels;
mod phase;
mod planner;
mod position;
mod ramp;

pub use curve::{Curve, LimitError, MAX_PIECES};
pub use limits::{Jerk, Limits};
pub use phase::{Motion, RampPhase};
pub use planner::{SpeedPlanner, Step};
pub use position::{PositionPlanner, PositionStep};
pub use ramp::Ramp;
