//! Tests.

mod layers;
mod conformance;
mod interpret;
mod syntax;
mod plan;
mod power;
mod rig;
mod limit;
mod machine;
mod cli;
mod readme;
