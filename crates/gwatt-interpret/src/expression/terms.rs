//! What a language writes in expressions: operators with their priorities, functions, constants
//! and brackets, as tables.

use super::function::Function;
use super::operator::{Operator, Prefix, Rules};

/// How an operator is written, and its priority: the higher, the tighter it binds. Where one
/// token begins with another, the longer stands first.
pub(crate) type Infix = (&'static str, Operator, u8);

/// The tables of a language.
#[derive(Debug)]
pub(crate) struct Terms {
    pub(crate) brackets: [u8; 2],
    pub(crate) infixes: &'static [Infix],
    /// Next to the sign.
    pub(crate) prefixes: &'static [(&'static str, Prefix)],
    pub(crate) functions: &'static [(&'static str, Function)],
    pub(crate) constants: &'static [(&'static str, f64)],
    pub(crate) rules: Rules,
}

impl Terms {
    /// The function with this name.
    pub(crate) fn function(&self, name: &str) -> Option<Function> {
        named(self.functions, name)
    }

    /// The value that a name stands for.
    pub(crate) fn constant(&self, name: &str) -> Option<f64> {
        named(self.constants, name)
    }

    /// The result of an operator, or what is wrong.
    pub(crate) fn infix(&self, operator: Operator, a: f64, b: f64) -> Result<f64, &'static str> {
        operator.apply(a, b, &self.rules)
    }
}

/// Whether a token begins with this byte: quicker than the whole comparison, which most tokens
/// of a table then need not pass.
pub(super) fn begins(token: &str, byte: u8) -> bool {
    token.as_bytes().first() == Some(&byte)
}

fn named<T: Copy>(table: &[(&'static str, T)], name: &str) -> Option<T> {
    let first = *name.as_bytes().first()?;
    let mut table = table.iter();
    let found = table.find(|(known, _)| begins(known, first) && *known == name)?;
    Some(found.1)
}
