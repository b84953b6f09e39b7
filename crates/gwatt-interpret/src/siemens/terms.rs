//! Operators and functions ("Flexible NC programming", "Arithmetic operations").
//!
//! "Priority of the operations": comparisons bind loosest, looser than AND and OR. "Precision
//! correction on comparison errors": values are equal when they differ by less than 1e-12 of
//! themselves.

use crate::expression::Function as F;
use crate::expression::Operator as O;
use crate::expression::{BITS_MAX, NO_BITS, Prefix, Rules, Terms};

pub(super) static TERMS: Terms = Terms {
    brackets: *b"()",
    infixes: &[
        ("==", O::Equal, 1),
        ("<>", O::NotEqual, 1),
        ("<=", O::LessEqual, 1),
        (">=", O::GreaterEqual, 1),
        ("<<", O::Chain, 2),
        ("<", O::Less, 1),
        (">", O::Greater, 1),
        ("+", O::Plus, 9),
        ("-", O::Minus, 9),
        ("*", O::Times, 10),
        ("/", O::Divide, 10),
        ("DIV", O::Whole, 10),
        ("MOD", O::Modulo, 10),
        ("OR", O::Or, 3),
        ("XOR", O::ExclusiveOr, 4),
        ("AND", O::And, 5),
        ("B_OR", O::BitOr, 6),
        ("B_XOR", O::BitExclusiveOr, 7),
        ("B_AND", O::BitAnd, 8),
    ],
    prefixes: &[("NOT", Prefix::Not), ("B_NOT", Prefix::BitNot)],
    functions: &[
        ("ABS", F::Abs),
        ("ACOS", F::Acos),
        ("ASIN", F::Asin),
        ("ATAN2", F::Angle),
        ("BOUND", F::Bound),
        ("COS", F::Cos),
        ("EXP", F::Exp),
        ("LN", F::Ln),
        ("MAXVAL", F::Max),
        ("MINVAL", F::Min),
        ("POT", F::Square),
        ("ROUND", F::RoundUp),
        ("ROUNDUP", F::Ceil),
        ("SIN", F::Sin),
        ("SQRT", F::Sqrt),
        ("TAN", F::Tan),
        ("TRUNC", F::TruncCorrected),
    ],
    constants: &[("TRUE", 1.0), ("FALSE", 0.0)],
    rules: Rules {
        same,
        less: |a, b| a < b && !same(a, b),
        holds: |value| value != 0.0,
        rest: |a, b| a - b * (a / b).trunc(),
        bits: |value| match value.abs() {
            ..=BITS_MAX => Ok(value as i64),
            _ => Err(NO_BITS),
        },
    },
};

fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-12 * a.abs().max(b.abs())
}
