//! Operators between two values.
//!
//! ISG: TF5200 "Arithmetic expressions"; a value is true from 0.5 on ("The
//! IF - ELSE branch"). OSP: programming manual, "User Task", "Arithmetic
//! Operation Function": comparisons as `EQ`, logic on bits as `AND`.

use super::{Cursor, Style};

/// The largest number that logic on bits takes.
const BITS_MAX: f64 = 4_294_967_295.0;

/// An operator.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Operator {
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
    BitAnd,
    BitXor,
    BitOr,
    And,
    Or,
}

/// The operator that is next, and its length. It stays.
pub(super) fn operator(cursor: &mut Cursor<'_>, style: Style) -> Option<(Operator, usize)> {
    use Operator::{
        And, BitAnd, BitOr, BitXor, Divide, Equal, Greater, GreaterEqual, Less, LessEqual, Minus,
        Modulo, NotEqual, Or, Plus, Power, Times,
    };
    let first = cursor.peek()?;
    let found = match (first, cursor.byte(1), style) {
        (b'+', ..) => (Plus, 1),
        (b'-', ..) => (Minus, 1),
        (b'/', ..) => (Divide, 1),
        (b'*', b'*', Style::Isg) => (Power, 2),
        (b'*', ..) => (Times, 1),
        (b'=', b'=', Style::Isg) => (Equal, 2),
        (b'!', b'=', Style::Isg) => (NotEqual, 2),
        (b'<', b'=', Style::Isg) => (LessEqual, 2),
        (b'>', b'=', Style::Isg) => (GreaterEqual, 2),
        (b'<', _, Style::Isg) => (Less, 1),
        (b'>', _, Style::Isg) => (Greater, 1),
        (b'&', b'&', Style::Isg) => (And, 2),
        (b'|', b'|', Style::Isg) => (Or, 2),
        (b'&', _, Style::Isg) => (BitAnd, 1),
        (b'|', _, Style::Isg) => (BitOr, 1),
        (b'^', _, Style::Isg) => (BitXor, 1),
        _ => {
            let name = cursor.name();
            let operator = match (name.as_str(), style) {
                ("MOD", Style::Isg) => Modulo,
                ("AND", Style::Isg) => And,
                ("OR", Style::Isg) => Or,
                ("EQ", Style::Osp) => Equal,
                ("NE", Style::Osp) => NotEqual,
                ("GT", Style::Osp) => Greater,
                ("GE", Style::Osp) => GreaterEqual,
                ("LT", Style::Osp) => Less,
                ("LE", Style::Osp) => LessEqual,
                ("AND", Style::Osp) => BitAnd,
                ("OR", Style::Osp) => BitOr,
                ("EOR" | "XOR", Style::Osp) => BitXor,
                _ => return None,
            };
            (operator, name.len())
        }
    };
    Some(found)
}

impl Operator {
    /// The higher binds tighter; equal ones bind from the left.
    pub(super) fn priority(self) -> u8 {
        match self {
            Self::Power => 9,
            Self::Times | Self::Divide | Self::Modulo => 8,
            Self::Plus | Self::Minus => 7,
            Self::Greater | Self::GreaterEqual | Self::Less | Self::LessEqual => 6,
            Self::Equal | Self::NotEqual => 5,
            Self::BitAnd => 4,
            Self::BitXor => 3,
            Self::BitOr => 2,
            Self::And | Self::Or => 1,
        }
    }

    /// The result, or what is wrong.
    pub(super) fn apply(self, a: f64, b: f64) -> Result<f64, &'static str> {
        let truth = |holds: bool| f64::from(u8::from(holds));
        let holds = |value: f64| value.abs() >= 0.5;
        Ok(match self {
            Self::Power if a < 0.0 && b.fract() != 0.0 => {
                return Err("a negative number to a power that is not whole");
            }
            Self::Power => libm::pow(a, b),
            Self::Divide | Self::Modulo if b == 0.0 => return Err("a division by zero"),
            Self::Times => a * b,
            Self::Divide => a / b,
            Self::Modulo => libm::fmod(a, b),
            Self::Plus => a + b,
            Self::Minus => a - b,
            Self::Equal => truth(a == b),
            Self::NotEqual => truth(a != b),
            Self::Greater => truth(a > b),
            Self::GreaterEqual => truth(a >= b),
            Self::Less => truth(a < b),
            Self::LessEqual => truth(a <= b),
            Self::BitAnd | Self::BitXor | Self::BitOr if !(is_bits(a) && is_bits(b)) => {
                return Err("a logical operation on what is no whole number of 32 bits");
            }
            Self::BitAnd => (a as u64 & b as u64) as f64,
            Self::BitXor => (a as u64 ^ b as u64) as f64,
            Self::BitOr => (a as u64 | b as u64) as f64,
            Self::And => truth(holds(a) && holds(b)),
            Self::Or => truth(holds(a) || holds(b)),
        })
    }
}

fn is_bits(value: f64) -> bool {
    value.fract() == 0.0 && (0.0..=BITS_MAX).contains(&value)
}
