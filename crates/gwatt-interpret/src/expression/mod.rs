//! Expressions and parameters in the text of a block.
//!
//! The value is worked out while the text is read. For lines that run again and
//! again, the steps of that are kept. RS274/NGC as in the `LinuxCNC` documentation ("G-Code
//! Overview": Parameters, Expressions, Binary Operators, Functions), Fanuc custom
//! macro B as in B-63944EN ("Custom Macro": Variables, Arithmetic and Logic
//! Operation).

mod function;
mod operator;
mod reader;
mod tape;
mod value;

pub(super) use reader::{Name, Reader};
pub(super) use tape::{Op, parameter_number, work_out};
pub(super) use value::{Fault, Held, KEPT, PROBED, Read, TOOL, Value, Variables, remedy};
