//! What each command does.

pub mod check;
pub mod contour;
pub mod dialect;
pub mod diff;
pub mod excite;
pub mod identify;
pub mod limit;
pub mod machine;
pub mod moves;
pub mod power_fit;
pub mod report;
pub mod size;
pub mod plan;
pub mod spindle;
pub mod tune;
pub mod verify;

mod beside;
mod clash;
mod designed;
mod filter_force;
mod in_order;
mod input;
mod interrupt;
mod into;
mod limit_set;
mod listing;
mod machine_import;
mod many;
mod model_choice;
mod output;
mod page;
mod places;
mod recorded;
mod rows;
mod series;
mod schedule_file;
mod settings;
mod setup;
mod signal;
mod terminal;
mod together;

pub use output::print;
pub use terminal::{Shown, Terminal};
