//! Operators and functions (TF5200 "Arithmetic expressions", "Overview of all available
//! calculation operations"; what is true: "The IF - ELSE branch").

use crate::expression::Function as F;
use crate::expression::Operator as O;
use crate::expression::{Prefix, RULES, Terms};

pub(super) static TERMS: Terms = Terms {
    brackets: *b"[]",
    infixes: &[
        ("**", O::Power, 9),
        ("*", O::Times, 8),
        ("/", O::Divide, 8),
        ("MOD", O::Modulo, 8),
        ("+", O::Plus, 7),
        ("-", O::Minus, 7),
        ("<=", O::LessEqual, 6),
        (">=", O::GreaterEqual, 6),
        ("<", O::Less, 6),
        (">", O::Greater, 6),
        ("==", O::Equal, 5),
        ("!=", O::NotEqual, 5),
        ("&&", O::And, 1),
        ("||", O::Or, 1),
        ("AND", O::And, 1),
        ("OR", O::Or, 1),
        ("&", O::BitAnd, 4),
        ("^", O::BitExclusiveOr, 3),
        ("|", O::BitOr, 2),
    ],
    prefixes: &[("NOT", Prefix::Not)],
    functions: &[
        ("ABS", F::Abs),
        ("ACOS", F::Acos),
        ("ACOT", F::Acot),
        ("ASIN", F::Asin),
        ("ATAN", F::Atan),
        ("COS", F::Cos),
        ("COT", F::Cot),
        ("DEXP", F::PowerOfTen),
        ("EXP", F::Exp),
        ("FRACT", F::Fract),
        ("INT", F::Trunc),
        ("LN", F::Log),
        ("LOG", F::Log10),
        ("MAX", F::Max),
        ("MIN", F::Min),
        ("ROUND", F::Round),
        ("SIN", F::Sin),
        ("SQR", F::Square),
        ("SQRT", F::Sqrt),
        ("TAN", F::Tan),
    ],
    constants: &[("PI", std::f64::consts::PI), ("TRUE", 1.0), ("FALSE", 0.0)],
    rules: RULES,
};
