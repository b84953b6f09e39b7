//! How operators are written in RS274/NGC and in Fanuc's macros, and what is
//! their own there.

use super::value::Value;
use crate::operator::{Operator, Rules};

/// `LinuxCNC` compares with a tolerance with EQ and NE, and exactly with the others.
const RS274: Rules = Rules {
    tolerance: 1e-4,
    holds: |value| value != 0.0,
    rest: |a, b| {
        let rest = libm::fmod(a, b);
        if rest < 0.0 { rest + b.abs() } else { rest }
    },
    bits: |_| Err("a logical operation on bits"),
};

/// Between conditions, as in IF [[#1 EQ 1] AND [#2 EQ 2]], the bits of 0 and 1 are
/// what is wanted too.
const MACRO: Rules = Rules {
    tolerance: 0.0,
    holds: |value| value != 0.0,
    rest: libm::fmod,
    bits: |value| {
        const MOST: f64 = 4_294_967_295.0;
        if value.abs() > MOST {
            return Err("a logical operation on a number of more than 32 bits");
        }
        Ok(value.round() as i64)
    },
};

/// The operator that `text`, upper case without blanks, begins with, and its
/// length.
pub(super) fn read(text: &[u8], fanuc: bool) -> Option<(Operator, usize)> {
    use Operator::{
        And, BitAnd, BitExclusiveOr, BitOr, Divide, Equal, ExclusiveOr, Greater, GreaterEqual,
        Less, LessEqual, Minus, Modulo, NotEqual, Or, Plus, Power, Times,
    };
    let at = |at: usize| text.get(at).copied().unwrap_or_default();
    Some(match [at(0), at(1), at(2)] {
        [b'*', b'*', _] => (Power, 2),
        [b'*', ..] => (Times, 1),
        [b'/', ..] => (Divide, 1),
        [b'+', ..] => (Plus, 1),
        [b'-', ..] => (Minus, 1),
        [b'M', b'O', b'D'] => (Modulo, 3),
        [b'A', b'N', b'D'] => (if fanuc { BitAnd } else { And }, 3),
        [b'X', b'O', b'R'] => (if fanuc { BitExclusiveOr } else { ExclusiveOr }, 3),
        [b'O', b'R', _] => (if fanuc { BitOr } else { Or }, 2),
        [b'E', b'Q', _] => (Equal, 2),
        [b'N', b'E', _] => (NotEqual, 2),
        [b'G', b'T', _] => (Greater, 2),
        [b'G', b'E', _] => (GreaterEqual, 2),
        [b'L', b'T', _] => (Less, 2),
        [b'L', b'E', _] => (LessEqual, 2),
        _ => return None,
    })
}

/// The higher binds tighter; equal ones bind from the left.
pub(super) fn precedence(operator: Operator) -> u8 {
    match operator {
        Operator::Power => 5,
        Operator::Times | Operator::Divide | Operator::Modulo | Operator::BitAnd => 4,
        Operator::Plus | Operator::Minus | Operator::BitOr | Operator::BitExclusiveOr => 3,
        Operator::And | Operator::Or | Operator::ExclusiveOr => 1,
        _ => 2,
    }
}

/// The result, or what is wrong.
pub(super) fn apply(
    operator: Operator,
    left: Value,
    right: Value,
    fanuc: bool,
) -> Result<f64, &'static str> {
    // Fanuc: null equals null only, and is 0 everywhere else.
    if fanuc && (left.is_none() || right.is_none()) {
        let same = f64::from(u8::from(left == right));
        match operator {
            Operator::Equal => return Ok(same),
            Operator::NotEqual => return Ok(1.0 - same),
            _ => {}
        }
    }
    let rules = if fanuc { &MACRO } else { &RS274 };
    operator.apply(left.unwrap_or(0.0), right.unwrap_or(0.0), rules)
}
