//! How operators are written where brackets are square.
//!
//! ISG: TF5200 "Arithmetic expressions"; a value is true from 0.5 on ("The
//! IF - ELSE branch"). OSP: programming manual, "User Task", "Arithmetic
//! Operation Function": comparisons as `EQ`, logic on bits as `AND`.

use super::cursor::Cursor;
use super::style::Style;
use crate::operator::{Operator, Rules};

/// The largest number that logic on bits takes.
const BITS_MAX: f64 = 4_294_967_295.0;

/// A value is true from 0.5 on.
pub(super) const RULES: Rules = Rules {
    tolerance: 0.0,
    holds: |value| value.abs() >= 0.5,
    rest: libm::fmod,
    bits: |value| {
        if value.fract() == 0.0 && (0.0..=BITS_MAX).contains(&value) {
            Ok(value as i64)
        } else {
            Err("a logical operation on what is no whole number of 32 bits")
        }
    },
};

/// The operator that is next, and its length. It stays.
pub(super) fn operator(cursor: &mut Cursor<'_>, style: Style) -> Option<(Operator, usize)> {
    use Operator::{
        And, BitAnd, BitExclusiveOr, BitOr, Divide, Equal, Greater, GreaterEqual, Less, LessEqual,
        Minus, Modulo, NotEqual, Or, Plus, Power, Times,
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
        (b'^', _, Style::Isg) => (BitExclusiveOr, 1),
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
                ("EOR" | "XOR", Style::Osp) => BitExclusiveOr,
                _ => return None,
            };
            (operator, name.len())
        }
    };
    Some(found)
}

/// The higher binds tighter; equal ones bind from the left.
pub(super) fn priority(operator: Operator) -> u8 {
    match operator {
        Operator::Power => 9,
        Operator::Times | Operator::Divide | Operator::Modulo => 8,
        Operator::Plus | Operator::Minus => 7,
        Operator::Greater | Operator::GreaterEqual | Operator::Less | Operator::LessEqual => 6,
        Operator::Equal | Operator::NotEqual => 5,
        Operator::BitAnd => 4,
        Operator::BitExclusiveOr => 3,
        Operator::BitOr => 2,
        Operator::And | Operator::Or | Operator::ExclusiveOr => 1,
    }
}
