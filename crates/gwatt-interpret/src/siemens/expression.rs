//! Expressions: operators in their priority, operands, variables.
//!
//! "Flexible NC programming", "Priority of the operations": comparisons bind
//! loosest, looser than AND and OR. "Precision correction on comparison errors":
//! values are equal when they differ by less than 1e-12 of themselves.

use super::function::Function;
use super::reading::Reading;
use super::value::{Val, truth};
use crate::formula::Outcome;

/// Brackets and signs inside one another.
const DEPTH_MAX: u32 = 64;
/// Relative difference of values that are equal.
const SAME: f64 = 1e-12;

/// An operator between two values.
#[derive(Debug, Clone, Copy)]
enum Operator {
    Times,
    Divide,
    Whole,
    Rest,
    Plus,
    Minus,
    Bits(fn(i64, i64) -> i64),
    Logic(fn(bool, bool) -> bool),
    Chain,
    Compare(fn(std::cmp::Ordering) -> bool),
}

impl Reading<'_, '_, '_> {
    /// The value of an expression.
    pub(super) fn expression(&mut self) -> Outcome<Val> {
        let start = self.cursor.at;
        self.cursor.depth += 1;
        if self.cursor.depth > DEPTH_MAX {
            let message = format!("more than {DEPTH_MAX} brackets and signs in one another");
            let help = "take the expression apart";
            return Err(self.cursor.fault("expression", message, help, start));
        }
        let value = self.operators(0);
        self.cursor.depth -= 1;
        value
    }

    /// An expression that must be a number.
    pub(super) fn number(&mut self) -> Outcome<f64> {
        self.cursor.peek();
        let start = self.cursor.at;
        let value = self.expression()?;
        self.as_number(&value, start)
    }

    pub(super) fn as_number(&self, value: &Val, start: usize) -> Outcome<f64> {
        match value {
            Val::Number(value) => Ok(*value),
            Val::Text(_) => {
                let message = "a text stands where a number is needed";
                let help = "write a number";
                Err(self.cursor.fault("expression", message, help, start))
            }
        }
    }

    /// Operators that bind tighter than `least`, from the left.
    fn operators(&mut self, least: u8) -> Outcome<Val> {
        let mut left = self.unary()?;
        while let Some((operator, priority, length)) = self.operator() {
            if priority <= least {
                break;
            }
            let start = self.cursor.at;
            self.cursor.at += length;
            let right = self.operators(priority)?;
            left = self.apply(operator, &left, &right, start)?;
        }
        Ok(left)
    }

    /// The operator that is next, its priority and length. It stays.
    fn operator(&mut self) -> Option<(Operator, u8, usize)> {
        use std::cmp::Ordering::{Equal, Greater, Less};
        let first = self.cursor.peek()?;
        let second = self.cursor.text.get(self.cursor.at + 1).copied();
        Some(match (first, second) {
            (b'=', Some(b'=')) => (Operator::Compare(|order| order == Equal), 1, 2),
            (b'<', Some(b'>')) => (Operator::Compare(|order| order != Equal), 1, 2),
            (b'<', Some(b'=')) => (Operator::Compare(|order| order != Greater), 1, 2),
            (b'>', Some(b'=')) => (Operator::Compare(|order| order != Less), 1, 2),
            (b'<', Some(b'<')) => (Operator::Chain, 2, 2),
            (b'<', _) => (Operator::Compare(|order| order == Less), 1, 1),
            (b'>', _) => (Operator::Compare(|order| order == Greater), 1, 1),
            (b'+', _) => (Operator::Plus, 9, 1),
            (b'-', _) => (Operator::Minus, 9, 1),
            (b'*', _) => (Operator::Times, 10, 1),
            (b'/', _) => (Operator::Divide, 10, 1),
            _ => {
                let name = self.cursor.name();
                let (operator, priority) = match name.as_str() {
                    "OR" => (Operator::Logic(|a, b| a || b), 3),
                    "XOR" => (Operator::Logic(|a, b| a != b), 4),
                    "AND" => (Operator::Logic(|a, b| a && b), 5),
                    "B_OR" => (Operator::Bits(|a, b| a | b), 6),
                    "B_XOR" => (Operator::Bits(|a, b| a ^ b), 7),
                    "B_AND" => (Operator::Bits(|a, b| a & b), 8),
                    "DIV" => (Operator::Whole, 10),
                    "MOD" => (Operator::Rest, 10),
                    _ => return None,
                };
                (operator, priority, name.len())
            }
        })
    }

    fn apply(&self, operator: Operator, left: &Val, right: &Val, start: usize) -> Outcome<Val> {
        let (a, b) = match (operator, left, right) {
            (Operator::Chain, _, _) => return Ok(Val::Text(shown(left) + &shown(right))),
            (Operator::Compare(holds), Val::Text(a), Val::Text(b)) => {
                return Ok(truth(holds(a.cmp(b))));
            }
            (_, Val::Number(a), Val::Number(b)) => (*a, *b),
            _ => {
                let message = "an operator between a text and a number";
                let help = "compare and calculate with values of one type";
                return Err(self.cursor.fault("expression", message, help, start));
            }
        };
        let result = match operator {
            Operator::Divide | Operator::Whole | Operator::Rest if b == 0.0 => {
                return Err(self.impossible("a division by zero", start));
            }
            Operator::Times => a * b,
            Operator::Divide => a / b,
            Operator::Whole => (a / b).trunc(),
            Operator::Rest => a - b * (a / b).trunc(),
            Operator::Plus => a + b,
            Operator::Minus => a - b,
            Operator::Bits(join) => {
                if a.abs().max(b.abs()) > 4_294_967_295.0 {
                    let message = "a logical operation on a number of more than 32 bits";
                    return Err(self.impossible(message, start));
                }
                join(a as i64, b as i64) as f64
            }
            Operator::Logic(join) => f64::from(u8::from(join(a != 0.0, b != 0.0))),
            Operator::Compare(holds) => {
                let same = (a - b).abs() <= SAME * a.abs().max(b.abs());
                let order = if same {
                    std::cmp::Ordering::Equal
                } else {
                    a.total_cmp(&b)
                };
                f64::from(u8::from(holds(order)))
            }
            Operator::Chain => 0.0,
        };
        self.finite(result, start)
    }

    /// An operand with signs and NOT before it.
    fn unary(&mut self) -> Outcome<Val> {
        self.cursor.peek();
        let start = self.cursor.at;
        self.cursor.depth += 1;
        if self.cursor.depth > DEPTH_MAX {
            let message = format!("more than {DEPTH_MAX} brackets and signs in one another");
            let help = "take the expression apart";
            return Err(self.cursor.fault("expression", message, help, start));
        }
        let value = if self.cursor.take(b'-') {
            let value = self.unary()?;
            Val::Number(-self.as_number(&value, start)?)
        } else if self.cursor.take(b'+') {
            self.unary()?
        } else if self.cursor.take_name("NOT") {
            let value = self.unary()?;
            truth(self.as_number(&value, start)? == 0.0)
        } else if self.cursor.take_name("B_NOT") {
            let value = self.unary()?;
            Val::Number(!(self.as_number(&value, start)? as i64) as f64)
        } else {
            self.operand()?
        };
        self.cursor.depth -= 1;
        Ok(value)
    }

    fn operand(&mut self) -> Outcome<Val> {
        let first = self.cursor.peek();
        let start = self.cursor.at;
        match first {
            Some(b'(') => {
                self.cursor.at += 1;
                let value = self.expression()?;
                self.cursor.expect(b')')?;
                Ok(value)
            }
            Some(b'0'..=b'9' | b'.') => self.cursor.number().map(Val::Number),
            Some(b'"') => self.cursor.quoted().map(Val::Text),
            Some(b'\'') => self.constant().map(Val::Number),
            Some(b'$') => self.system_variable(),
            _ => {
                let name = self.cursor.name();
                if name.is_empty() {
                    self.cursor.at += usize::from(first.is_some());
                    let help = "write a number, a variable, or an expression in parentheses";
                    let message = "a value is missing here";
                    return Err(self.cursor.fault("expression", message, help, start));
                }
                self.cursor.at += name.len();
                match name.as_str() {
                    "TRUE" => return Ok(truth(true)),
                    "FALSE" => return Ok(truth(false)),
                    _ => {}
                }
                if name.as_str() == "AXNAME" {
                    return self.axis_of_text(start);
                }
                if self.axis_letter(&name).is_some() && !self.is_variable(&name) {
                    return Ok(Val::Text(name.to_string()));
                }
                if self.cursor.peek() == Some(b'(') {
                    return self.function(&name, start).map(Val::Number);
                }
                self.variable(&name, start)
            }
        }
    }

    /// `'H1F'`, `'B101'`, `'A'` ("Variables": constants in quotes).
    fn constant(&mut self) -> Outcome<f64> {
        let start = self.cursor.at;
        let rest = self.cursor.text.get(start + 1..).unwrap_or_default();
        let inside = memchr::memchr(b'\'', rest).and_then(|end| rest.get(..end));
        let text = inside.and_then(|inside| std::str::from_utf8(inside).ok());
        self.cursor.at = start + 2 + text.map_or(0, str::len);
        let value = text.and_then(|text| match text.as_bytes() {
            [byte] => Some(i64::from(*byte)),
            [b'H' | b'h', ..] => i64::from_str_radix(text.get(1..)?, 16).ok(),
            [b'B' | b'b', ..] => i64::from_str_radix(text.get(1..)?, 2).ok(),
            _ => None,
        });
        if let Some(value) = value {
            return Ok(value as f64);
        }
        self.cursor.at = self.cursor.at.min(self.cursor.text.len());
        let message = "this is no constant";
        let help = "write 'H1F', 'B101' or one character in quotes";
        Err(self.cursor.fault("expression", message, help, start))
    }

    /// A function with its arguments in parentheses.
    fn function(&mut self, name: &str, start: usize) -> Outcome<f64> {
        let Some(function) = Function::named(name) else {
            let message = format!("{name} is no function that gwatt knows");
            let help = "the functions are SIN COS TAN ASIN ACOS ATAN2 SQRT ABS POT TRUNC ROUND ROUNDUP LN EXP MINVAL MAXVAL BOUND";
            return Err(self.cursor.fault("expression", message, help, start));
        };
        self.cursor.expect(b'(')?;
        let mut values = [0.0; 3];
        for (index, slot) in values.iter_mut().enumerate().take(function.values()) {
            if index > 0 {
                self.cursor.expect(b',')?;
            }
            *slot = self.number()?;
        }
        self.cursor.expect(b')')?;
        let result = function
            .apply(values)
            .map_err(|wrong| self.impossible(wrong, start))?;
        let value = self.finite(result, start)?;
        self.as_number(&value, start)
    }

    fn impossible(&self, wrong: &'static str, start: usize) -> super::super::expression::Fault {
        let help = "check the values that go into it";
        self.cursor.fault("arithmetic", wrong, help, start)
    }

    fn finite(&self, value: f64, start: usize) -> Outcome<Val> {
        if value.is_finite() {
            return Ok(Val::Number(value));
        }
        Err(self.impossible("a result beyond all numbers", start))
    }
}

/// A value in a text.
fn shown(value: &Val) -> String {
    match value {
        Val::Number(value) => value.to_string(),
        Val::Text(text) => text.chars().take(400).collect(),
    }
}
