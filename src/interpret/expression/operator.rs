//! Operators between two values.

use super::value::Value;

/// An operator; its precedence and meaning depend on the language.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::interpret) enum Operator {
    Power,
    Times,
    Divide,
    Modulo,
    Plus,
    Minus,
    Equal,
    NotEqual,
    Greater,
    GreaterEqual,
    Less,
    LessEqual,
    And,
    Or,
    ExclusiveOr,
}

/// How far two values may differ and yet be equal: `LinuxCNC` compares so with
/// EQ and NE, and exactly with the others.
const EQUAL_TOLERANCE: f64 = 1e-4;

impl Operator {
    /// The operator that `text`, upper case without blanks, begins with, and its
    /// length.
    pub(super) fn read(text: &[u8]) -> Option<(Self, usize)> {
        use Operator::{
            And, Divide, Equal, ExclusiveOr, Greater, GreaterEqual, Less, LessEqual, Minus, Modulo,
            NotEqual, Or, Plus, Power, Times,
        };
        let at = |at: usize| text.get(at).copied().unwrap_or_default();
        Some(match [at(0), at(1), at(2)] {
            [b'*', b'*', _] => (Power, 2),
            [b'*', ..] => (Times, 1),
            [b'/', ..] => (Divide, 1),
            [b'+', ..] => (Plus, 1),
            [b'-', ..] => (Minus, 1),
            [b'M', b'O', b'D'] => (Modulo, 3),
            [b'A', b'N', b'D'] => (And, 3),
            [b'X', b'O', b'R'] => (ExclusiveOr, 3),
            [b'O', b'R', _] => (Or, 2),
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
    pub(super) fn precedence(self, fanuc: bool) -> u8 {
        match self {
            Self::Power => 5,
            Self::Times | Self::Divide | Self::Modulo => 4,
            Self::And if fanuc => 4,
            Self::Plus | Self::Minus => 3,
            Self::Or | Self::ExclusiveOr if fanuc => 3,
            Self::And | Self::Or | Self::ExclusiveOr => 1,
            _ => 2,
        }
    }

    /// The result, or what is wrong.
    pub(super) fn apply(self, left: Value, right: Value, fanuc: bool) -> Result<f64, &'static str> {
        // Fanuc: null equals null only, and is 0 everywhere else.
        if fanuc && (left.is_none() || right.is_none()) {
            match self {
                Self::Equal => return Ok(truth(left == right)),
                Self::NotEqual => return Ok(truth(left != right)),
                _ => {}
            }
        }
        let (a, b) = (left.unwrap_or(0.0), right.unwrap_or(0.0));
        let tolerance = if fanuc { 0.0 } else { EQUAL_TOLERANCE };
        let same = a == b || (a - b).abs() < tolerance;
        Ok(match self {
            Self::Power if a < 0.0 && b.fract() != 0.0 => {
                return Err("a negative number to a power that is not whole");
            }
            Self::Power => libm::pow(a, b),
            Self::Times => a * b,
            Self::Divide | Self::Modulo if b == 0.0 => return Err("a division by zero"),
            Self::Divide => a / b,
            Self::Modulo if fanuc => libm::fmod(a, b),
            Self::Modulo => {
                let rest = libm::fmod(a, b);
                if rest < 0.0 { rest + b.abs() } else { rest }
            }
            Self::Plus => a + b,
            Self::Minus => a - b,
            Self::Equal => truth(same),
            Self::NotEqual => truth(!same),
            Self::Greater => truth(a > b),
            Self::GreaterEqual => truth(a >= b),
            Self::Less => truth(a < b),
            Self::LessEqual => truth(a <= b),
            // Between conditions, as in IF [[#1 EQ 1] AND [#2 EQ 2]], the bits
            // of 0 and 1 are what is wanted too.
            Self::And if fanuc => return bits(a, b, |a, b| a & b),
            Self::Or if fanuc => return bits(a, b, |a, b| a | b),
            Self::ExclusiveOr if fanuc => return bits(a, b, |a, b| a ^ b),
            Self::And => truth(a != 0.0 && b != 0.0),
            Self::Or => truth(a != 0.0 || b != 0.0),
            Self::ExclusiveOr => truth((a != 0.0) != (b != 0.0)),
        })
    }
}

fn truth(yes: bool) -> f64 {
    f64::from(u8::from(yes))
}

/// Fanuc's logical operations work on 32 bits.
fn bits(a: f64, b: f64, join: fn(i64, i64) -> i64) -> Result<f64, &'static str> {
    const MOST: f64 = 4_294_967_295.0;
    if a.abs() > MOST || b.abs() > MOST {
        return Err("a logical operation on a number of more than 32 bits");
    }
    Ok(join(a.round() as i64, b.round() as i64) as f64)
}
