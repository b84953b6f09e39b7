//! Tests.

mod syntax;
mod plan;
mod power;
mod rig;
mod machine;
