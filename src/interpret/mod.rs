//! Blocks to moves: modal state, coordinates, arcs.

mod moves;

pub use moves::*;
