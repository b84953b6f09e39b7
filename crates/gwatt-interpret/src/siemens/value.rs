//! Values and variables of a program.
//!
//! "Flexible NC programming", "Variables" and "Definition of user variables":
//! DEF with a type, arrays of up to three dimensions, R parameters.

use crate::expression::truth;
use std::collections::HashMap;

/// Variables, and elements of one array, that a program may have.
pub(super) const COUNT_MAX: usize = 100_000;
/// Bytes of a text that is kept.
const TEXT_MAX: usize = 1000;

/// A value.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Val {
    /// REAL, INT, and BOOL as 0 or 1.
    Number(f64),
    Text(String),
}

/// The type of a variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Real,
    Int,
    Bool,
    Char,
    Text,
}

impl Kind {
    /// The type with this name.
    pub(super) fn named(name: &str) -> Option<Self> {
        Some(match name {
            "REAL" => Self::Real,
            "INT" => Self::Int,
            "BOOL" => Self::Bool,
            "CHAR" => Self::Char,
            // An axis is kept by its name.
            "STRING" | "AXIS" => Self::Text,
            _ => return None,
        })
    }

    /// What a variable holds before it is assigned.
    pub(super) fn default(self) -> Val {
        match self {
            Self::Text => Val::Text(String::new()),
            _ => Val::Number(0.0),
        }
    }

    /// A value as a variable of this type keeps it ("Possible type
    /// conversions": REAL to INT rounds, BOOL is 0 or not).
    pub(super) fn convert(self, value: Val) -> Result<Val, &'static str> {
        match (self, value) {
            (Self::Text, Val::Text(mut text)) => {
                let end = text
                    .char_indices()
                    .map(|(at, _)| at)
                    .find(|at| *at >= TEXT_MAX);
                text.truncate(end.unwrap_or(text.len()));
                Ok(Val::Text(text))
            }
            (Self::Text, Val::Number(_)) => Err("a number is no text"),
            (_, Val::Text(_)) => Err("a text is no number"),
            (Self::Real, number) => Ok(number),
            (Self::Bool, Val::Number(value)) => Ok(Val::Number(truth(value != 0.0))),
            (Self::Int | Self::Char, Val::Number(value)) => {
                let rounded = (value + 0.5).floor();
                if rounded.abs() <= 2_147_483_648.0 {
                    Ok(Val::Number(rounded))
                } else {
                    Err("it is beyond the whole numbers of the control")
                }
            }
        }
    }
}

/// A variable, or an array of them.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Variable {
    pub(super) kind: Kind,
    /// Lengths of the dimensions; 1 for those that it does not have.
    pub(super) dimensions: [usize; 3],
    pub(super) values: Vec<Val>,
}

impl Variable {
    /// A variable with default values; `None` where it has too many.
    pub(super) fn new(kind: Kind, dimensions: [usize; 3]) -> Option<Self> {
        let count = dimensions
            .iter()
            .try_fold(1_usize, |product, length| product.checked_mul(*length))
            .filter(|count| (1..=COUNT_MAX).contains(count))?;
        Some(Self {
            kind,
            dimensions,
            values: vec![kind.default(); count],
        })
    }

    /// Where an element stands; `None` outside.
    pub(super) fn place(&self, index: [usize; 3]) -> Option<usize> {
        let [a, b, c] = self.dimensions;
        let [i, j, k] = index;
        (i < a && j < b && k < c).then_some((i * b + j) * c + k)
    }
}

/// What stands between the parentheses of a call.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Argument {
    pub(super) value: Val,
    /// The caller's variable, where it is one: VAR parameters give back.
    pub(super) variable: Option<String>,
    /// The whole of it, where that is an array.
    pub(super) array: Option<Variable>,
}

/// The variables of one program.
#[derive(Debug, Default)]
pub(super) struct Scope {
    pub(super) variables: HashMap<String, Variable>,
    pub(super) arguments: Vec<Option<Argument>>,
    /// VAR parameters with the caller's variables.
    pub(super) given_back: Vec<(String, String)>,
    /// SAVE: the state to return to.
    pub(super) saved: Option<Box<super::saved::Saved>>,
}
