//! The machine description: TOML in, validated model out.

mod axis;
mod controller;
mod model;

pub use axis::{ALL_AXES, AXES, Axis, AxisId, AxisKind, AxisSet, AxisValues};
pub use controller::*;
pub use model::*;
