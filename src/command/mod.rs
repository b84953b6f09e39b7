//! What each command does.

pub mod check;
pub mod diff;
pub mod limit;
pub mod machine;
pub mod moves;
pub mod report;
pub mod spindle;

mod clash;
mod input;
mod output;
mod rows;
mod setup;
mod terminal;

pub use output::print;
pub use terminal::{Shown, Terminal};
