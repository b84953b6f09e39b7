//! Tests.

mod syntax;
mod plan;
mod power;
mod rig;
mod limit;
mod machine;
