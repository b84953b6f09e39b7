//! Operators and functions of RS274/NGC and of Fanuc's macros.
//!
//! RS274/NGC as in the `LinuxCNC` documentation ("G-Code Overview": Parameters, Expressions, Binary
//! Operators, Functions), Fanuc custom macro B as in B-63944EN ("Custom Macro": Variables,
//! Arithmetic and Logic Operation). A name that another begins with stands after it.

use super::function::Function as F;
use super::operator::Operator as O;
use super::operator::{BITS_MAX, NO_BITS, Rules};
use super::terms::Terms;

/// `LinuxCNC` compares with a tolerance with EQ and NE, and exactly with the others.
pub(super) static RS274: Terms = Terms {
    brackets: *b"[]",
    infixes: &[
        ("**", O::Power, 5),
        ("*", O::Times, 4),
        ("/", O::Divide, 4),
        ("+", O::Plus, 3),
        ("-", O::Minus, 3),
        ("MOD", O::Modulo, 4),
        ("AND", O::And, 1),
        ("XOR", O::ExclusiveOr, 1),
        ("OR", O::Or, 1),
        ("EQ", O::Equal, 2),
        ("NE", O::NotEqual, 2),
        ("GT", O::Greater, 2),
        ("GE", O::GreaterEqual, 2),
        ("LT", O::Less, 2),
        ("LE", O::LessEqual, 2),
    ],
    prefixes: &[],
    functions: &[
        ("ABS", F::Abs),
        ("ACOS", F::Acos),
        ("ASIN", F::Asin),
        ("ATAN", F::Atan),
        ("COS", F::Cos),
        ("EXISTS", F::Exists),
        ("EXP", F::Exp),
        ("FIX", F::Floor),
        ("FUP", F::Ceil),
        ("LN", F::Ln),
        ("ROUND", F::RoundInteger),
        ("SIN", F::Sin),
        ("SQRT", F::Sqrt),
        ("TAN", F::Tan),
    ],
    constants: &[],
    rules: Rules {
        same: |a, b| a == b || (a - b).abs() < 1e-4,
        less: |a, b| a < b,
        holds: |value| value != 0.0,
        rest: |a, b| {
            let rest = libm::fmod(a, b);
            if rest < 0.0 { rest + b.abs() } else { rest }
        },
        bits: |_| Err("a logical operation on bits"),
    },
};

/// Between conditions, as in IF [[#1 EQ 1] AND [#2 EQ 2]], the bits of 0 and 1 are
/// what is wanted too.
pub(super) static MACRO_B: Terms = Terms {
    brackets: *b"[]",
    infixes: &[
        ("**", O::Power, 5),
        ("*", O::Times, 4),
        ("/", O::Divide, 4),
        ("+", O::Plus, 3),
        ("-", O::Minus, 3),
        ("MOD", O::Modulo, 4),
        ("AND", O::BitAnd, 4),
        ("XOR", O::BitExclusiveOr, 3),
        ("OR", O::BitOr, 3),
        ("EQ", O::Equal, 2),
        ("NE", O::NotEqual, 2),
        ("GT", O::Greater, 2),
        ("GE", O::GreaterEqual, 2),
        ("LT", O::Less, 2),
        ("LE", O::LessEqual, 2),
    ],
    prefixes: &[],
    functions: &[
        ("ABS", F::Abs),
        ("ACOS", F::Acos),
        ("ACS", F::Acos),
        ("ASIN", F::Asin),
        ("ASN", F::Asin),
        ("ATAN", F::Atan),
        ("ATN", F::Atan),
        ("COS", F::Cos),
        ("EXP", F::Exp),
        ("FIX", F::Trunc),
        ("FUP", F::Outward),
        ("LN", F::Ln),
        ("POW", F::Power),
        ("ROUND", F::Round),
        ("SIN", F::Sin),
        ("SQRT", F::Sqrt),
        ("SQR", F::Sqrt),
        ("TAN", F::Tan),
        ("RND", F::Round),
    ],
    constants: &[],
    rules: Rules {
        same: |a, b| a == b,
        less: |a, b| a < b,
        holds: |value| value != 0.0,
        rest: libm::fmod,
        bits: |value| match value.abs() {
            ..=BITS_MAX => Ok(value.round() as i64),
            _ => Err(NO_BITS),
        },
    },
};
