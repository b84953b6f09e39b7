//! The path that the load describes, and how far it is from the programmed one.
//!
//! ```text
//! stretches ─sampled→ command ─filter→ held ─transfer function→ load ─nearest→ contour error
//!                                              └──────────────→ force, power
//! ```
//!
//! It is the linear model: friction that reverses, backlash, and what the
//! machine's frame does are not in it.

mod circle;
mod follow;
mod prepare;
mod result;
mod run;

pub use circle::{BINS, Roundness};
pub use result::{
    ArcResult, AxisEffort, ContourRow, ContourSink, ContourSummary, ContourTrouble, Effort, Errors,
    PlotPoint, Settings,
};
pub use run::Tracer;
