//! Expressions in the text of a block, in all languages.
//!
//! The value is worked out while the text is read (`engine.rs`), by the tables of the language
//! (`terms.rs`, `operator.rs`, `function.rs`). What a language has besides them is next to its reader: parameters
//! of RS274/NGC and Fanuc, whose steps are kept for lines that run again and again, in
//! `reader.rs`, `tape.rs` and `value.rs`; variables of ISG and OSP in `square.rs`.

mod cursor;
mod engine;
mod fault;
mod function;
mod ident;
mod macro_terms;
mod operator;
mod reader;
mod square;
mod tape;
mod terms;
mod value;
mod variables;

pub(super) use cursor::{Cursor, Lexis};
pub(super) use engine::Grammar;
pub(super) use fault::{Fault, Outcome};
pub(super) use function::Function;
pub(super) use ident::Ident;
pub(super) use operator::{BITS_MAX, NO_BITS, Operator, Prefix, Rules, truth};
pub(super) use reader::Reader;
pub(super) use square::{Names, RULES};
pub(super) use tape::{Op, parameter_number, work_out};
pub(super) use terms::Terms;
pub(super) use value::{Held, KEPT, Name, PROBED, Read, TOOL, Value, Variables, remedy};
pub(super) use variables::{Kept, Uses, keep};
