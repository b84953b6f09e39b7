//! Operators and functions (programming manual, "User Task", "Arithmetic Operation Function"):
//! comparisons as `EQ`, logic on bits as `AND`.

use crate::expression::Function as F;
use crate::expression::Operator as O;
use crate::expression::{Prefix, RULES, Terms};

pub(super) static TERMS: Terms = Terms {
    brackets: *b"[]",
    infixes: &[
        ("*", O::Times, 8),
        ("/", O::Divide, 8),
        ("+", O::Plus, 7),
        ("-", O::Minus, 7),
        ("GT", O::Greater, 6),
        ("GE", O::GreaterEqual, 6),
        ("LT", O::Less, 6),
        ("LE", O::LessEqual, 6),
        ("EQ", O::Equal, 5),
        ("NE", O::NotEqual, 5),
        ("AND", O::BitAnd, 4),
        ("EOR", O::BitExclusiveOr, 3),
        ("XOR", O::BitExclusiveOr, 3),
        ("OR", O::BitOr, 2),
    ],
    prefixes: &[("NOT", Prefix::Not)],
    functions: &[
        ("ABS", F::Abs),
        ("ATAN", F::Atan),
        ("ATAN2", F::Angle),
        ("COS", F::Cos),
        ("FIX", F::Trunc),
        ("FUP", F::Outward),
        ("MOD", F::Modulo),
        ("ROUND", F::Round),
        ("SIN", F::Sin),
        ("SQRT", F::Sqrt),
        ("TAN", F::Tan),
    ],
    constants: &[],
    rules: RULES,
};
