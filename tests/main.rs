//! Tests.

mod layers;
mod conformance;
mod expressions;
mod flow;
mod interpret;
mod cycles;
mod coordinates;
mod syntax;
mod plan;
mod power;
mod rig;
mod limit;
mod machine;
mod printers;
mod cli;
mod readme;
