//! Tests.

mod layers;
mod syntax;
mod plan;
mod power;
mod rig;
mod limit;
mod machine;
mod cli;
mod readme;
