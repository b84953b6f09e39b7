//! Machine files and controller profiles: TOML in, checked values out.
//!
//! Text → tree (`document`) → checked against the schema (`structure`) →
//! structs (`machine_file`, `controller_file`) → `Machine`, `Controller`
//! (`assemble`, `axis`, `converter`, `parts`, `preset`, `profile`, `servo`, `spindle`). All mistakes of a file are
//! collected on the way, each with its line.

mod assemble;
mod converter_name;
mod axis;
mod axis_table;
mod controller_file;
mod converter;
mod document;
mod drive_curve;
mod findings;
mod hints;
mod kinematics;
mod level_words;
mod listed_words;
mod levels;
mod load;
mod look_ahead;
mod machine_file;
mod named_knob;
mod offsets;
mod outputs;
mod own_language;
mod part_tables;
mod parts;
mod path_accel;
mod plausible;
mod plausible_parts;
mod preset;
mod printer;
mod printer_table;
mod profile;
mod one_letter;
mod quantity;
mod ratings;
mod response;
mod schema;
mod servo;
mod spindle;
mod structure;
mod switched_load;
mod tool;
mod value;
mod word;

pub use load::Loaded;
pub use schema::{controller_schema, schema};
