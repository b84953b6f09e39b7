//! Expressions: what stands in them besides numbers and operators between these.

use super::reading::Reading;
use super::terms::TERMS;
use super::value::Val;
use crate::expression::{Cursor, Grammar, Operator, Outcome, Terms};

impl<'t> Grammar<'t> for Reading<'_, '_, 't> {
    type Value = Val;

    fn terms(&self) -> &'static Terms {
        &TERMS
    }

    fn cursor(&mut self) -> &mut Cursor<'t> {
        &mut self.cursor
    }

    fn number_of(&self, value: &Val, start: usize) -> Outcome<f64> {
        match value {
            Val::Number(value) => Ok(*value),
            Val::Text(_) => {
                let message = "a text stands where a number is needed";
                let help = "write a number";
                Err(self.cursor.fault("expression", message, help, start))
            }
        }
    }

    fn value_of(&mut self, number: f64) -> Val {
        Val::Number(number)
    }

    fn infix(&mut self, operator: Operator, left: Val, right: Val, start: usize) -> Outcome<Val> {
        let (a, b) = match (&left, &right) {
            _ if operator == Operator::Chain => {
                return Ok(Val::Text(shown(&left) + &shown(&right)));
            }
            (Val::Text(a), Val::Text(b)) if operator.compares() => (f64::from(a.cmp(b) as i8), 0.0),
            (Val::Number(a), Val::Number(b)) => (*a, *b),
            _ => {
                let message = "an operator between a text and a number";
                let help = "compare and calculate with values of one type";
                return Err(self.cursor.fault("expression", message, help, start));
            }
        };
        let result = TERMS.infix(operator, a, b);
        self.cursor.worked_out(result, start).map(Val::Number)
    }

    fn own_operand(&mut self) -> Outcome<Val> {
        let first = self.cursor.peek();
        let start = self.cursor.at;
        match first {
            Some(b'"') => return self.cursor.quoted().map(Val::Text),
            Some(b'\'') => return self.constant().map(Val::Number),
            Some(b'$') => return self.system_variable(),
            _ => {}
        }
        let name = self.cursor.name();
        if name.is_empty() {
            self.cursor.at += usize::from(first.is_some());
            let help = "write a number, a variable, or an expression in parentheses";
            let message = "a value is missing here";
            return Err(self.cursor.fault("expression", message, help, start));
        }
        self.cursor.at += name.len();
        if let Some(constant) = TERMS.constant(&name) {
            return Ok(Val::Number(constant));
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

impl Reading<'_, '_, '_> {
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

    /// A function with its arguments in parentheses, the first of which is next.
    fn function(&mut self, name: &str, start: usize) -> Outcome<f64> {
        let Some(function) = TERMS.function(name) else {
            let message = format!("{name} is no function that gwatt knows");
            let help = "the functions are SIN COS TAN ASIN ACOS ATAN2 SQRT ABS POT TRUNC ROUND ROUNDUP LN EXP MINVAL MAXVAL BOUND";
            return Err(self.cursor.fault("expression", message, help, start));
        };
        self.cursor.at += 1;
        let (values, _) = self.arguments(function.values(), function.values())?;
        self.cursor.worked_out(function.apply(values), start)
    }
}

/// A value in a text.
fn shown(value: &Val) -> String {
    match value {
        Val::Number(value) => value.to_string(),
        Val::Text(text) => text.chars().take(400).collect(),
    }
}
