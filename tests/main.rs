//! Tests.

mod layers;
mod interpret;
mod siemens;
mod syntax;
mod plan;
mod power;
mod rig;
mod limit;
mod machine;
mod printers;
mod cli;
mod readme;
