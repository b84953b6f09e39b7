//! Tests.

mod plan;
mod power;
mod rig;
