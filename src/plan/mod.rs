//! Moves to profiles: how speed runs along each move.

mod profile;

pub use profile::*;
