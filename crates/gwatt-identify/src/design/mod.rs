//! The signal that determines an axis best, of which something is known already.
//!
//! ```text
//! first recording ─flexible→ Known ─line_power→ spectrum ─multisine→ signal ─foreseen→ errors
//! ```
//!
//! Each candidate is scaled to what the axis may do, and its standard errors are worked
//! out before anything is recorded; the one with the smallest errors is proposed.

mod candidate;
mod foreseen;
mod known;
mod line_power;
mod multisine;
mod proposal;

pub use candidate::Kind;
pub use foreseen::Foreseen;
pub use known::Known;
pub use proposal::{Bounds, Candidate, Proposal, propose};
