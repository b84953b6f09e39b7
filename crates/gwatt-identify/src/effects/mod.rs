//! What a rigid axis with friction does not explain, each by its sign in the recording:
//! cogging is a force that is periodic in position and not in time, backlash one that is
//! missing after each reversal, Stribeck friction one that falls with the speed near zero,
//! saturation one that ends at a largest value.

mod cogging;
mod effect;
mod found;
mod play;
mod saturation;
mod search;
mod settled;
mod shape;

pub use effect::{Effect, Saturation};
pub(super) use found::{Found, found};
pub(super) use search::add_known;
pub(super) use shape::Shape;
