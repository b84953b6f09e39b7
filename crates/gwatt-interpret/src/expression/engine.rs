//! Works an expression out while it is read: the same way in all languages.
//!
//! A language gives its tables, and what it has besides numbers, signs and brackets.

use super::cursor::Cursor;
use super::fault::Outcome;
use super::operator::{Operator, Prefix};
use super::terms::{Infix, Terms, begins};

/// Brackets and signs inside one another.
const DEPTH_MAX: u32 = 64;

/// How expressions are read in a language.
pub(crate) trait Grammar<'t> {
    type Value;

    fn terms(&self) -> &'static Terms;

    fn cursor(&mut self) -> &mut Cursor<'t>;

    /// What the language has for operands: variables, functions, texts. No sign, bracket or
    /// number is next.
    fn own_operand(&mut self) -> Outcome<Self::Value>;

    /// The number that a value which begins at `start` is.
    fn number_of(&self, value: &Self::Value, start: usize) -> Outcome<f64>;

    /// A number that is written, or worked out by an operator before its value.
    fn value_of(&mut self, number: f64) -> Self::Value;

    /// The result of an operator that stands at `start`.
    fn infix(
        &mut self,
        operator: Operator,
        left: Self::Value,
        right: Self::Value,
        start: usize,
    ) -> Outcome<Self::Value>;

    fn prefix(&mut self, prefix: Prefix, value: Self::Value, start: usize) -> Outcome<Self::Value> {
        let number = self.number_of(&value, start)?;
        let result = prefix.apply(number, &self.terms().rules);
        Ok(self.value_of(result))
    }

    fn written_number(&mut self) -> Outcome<f64> {
        self.cursor().number()
    }

    /// The operator that is next, and where it ends. It stays.
    fn next_infix(&mut self) -> Option<(Infix, usize)> {
        let infixes = self.terms().infixes;
        let cursor = self.cursor();
        let first = cursor.peek()?;
        // Most values have nothing after them.
        let candidates = infixes.iter().filter(|(token, ..)| begins(token, first));
        let mut candidates = candidates.peekable();
        candidates.peek()?;
        let name = cursor.name();
        let rest = cursor.text.get(cursor.at..)?;
        let is_next = |token: &str| match name.as_str() {
            "" => rest.starts_with(token.as_bytes()),
            name => name == token,
        };
        let found = candidates.find(|(token, ..)| is_next(token))?;
        Some((*found, cursor.at + found.0.len()))
    }

    /// The value of an expression.
    fn expression(&mut self) -> Outcome<Self::Value> {
        self.infixes(0)
    }

    /// An expression that must be a number.
    fn number(&mut self) -> Outcome<f64> {
        self.cursor().peek();
        let start = self.cursor().at;
        let value = self.expression()?;
        self.number_of(&value, start)
    }

    /// The number that the text is, and nothing else.
    fn whole(&mut self) -> Option<f64> {
        let value = self.number().ok()?;
        self.cursor().peek().is_none().then_some(value)
    }

    /// Operators that bind tighter than `least`, from the left.
    fn infixes(&mut self, least: u8) -> Outcome<Self::Value> {
        let mut left = self.operand()?;
        while let Some(((_, operator, priority), end)) = self.next_infix()
            && priority > least
        {
            let start = std::mem::replace(&mut self.cursor().at, end);
            let right = self.infixes(priority)?;
            left = self.infix(operator, left, right, start)?;
        }
        Ok(left)
    }

    /// An operand with what stands before it.
    fn operand(&mut self) -> Outcome<Self::Value> {
        let cursor = self.cursor();
        let next = cursor.peek();
        cursor.depth += 1;
        if cursor.depth > DEPTH_MAX {
            let message = format!("more than {DEPTH_MAX} brackets and signs in one another");
            let help = "take the expression apart";
            return Err(cursor.fault("expression", message, help, cursor.at));
        }
        let value = self.operand_at(next);
        self.cursor().depth -= 1;
        value
    }

    fn operand_at(&mut self, next: Option<u8>) -> Outcome<Self::Value> {
        let terms = self.terms();
        let cursor = self.cursor();
        let start = cursor.at;
        let prefix = match next {
            Some(b'0'..=b'9' | b'.') => {
                let number = self.written_number()?;
                return Ok(self.value_of(number));
            }
            Some(byte) if byte == terms.brackets[0] => return self.in_brackets(),
            Some(b'+') => {
                cursor.at += 1;
                return self.operand();
            }
            Some(b'-') => {
                cursor.at += 1;
                Some(Prefix::Minus)
            }
            Some(byte) => {
                let mut prefixes = terms.prefixes.iter();
                prefixes
                    .find(|(name, _)| begins(name, byte) && cursor.take_name(name))
                    .map(|(_, prefix)| *prefix)
            }
            None => None,
        };
        let Some(prefix) = prefix else {
            return self.own_operand();
        };
        let value = self.operand()?;
        self.prefix(prefix, value, start)
    }

    /// An expression in brackets, the first of which is next.
    fn in_brackets(&mut self) -> Outcome<Self::Value> {
        self.cursor().at += 1;
        let value = self.expression()?;
        let [_, close] = self.terms().brackets;
        self.cursor().expect(close)?;
        Ok(value)
    }

    /// From `least` to `most` values with commas between them, to the bracket at their end, and how
    /// many they are.
    fn arguments(&mut self, least: usize, most: usize) -> Outcome<([f64; 3], usize)> {
        let mut values = [0.0; 3];
        let mut count = 0;
        for slot in values.iter_mut().take(most) {
            if (1..least).contains(&count) {
                self.cursor().expect(b',')?;
            } else if count > 0 && !self.cursor().take(b',') {
                break;
            }
            *slot = self.number()?;
            count += 1;
        }
        let [_, close] = self.terms().brackets;
        self.cursor().expect(close)?;
        Ok((values, count))
    }
}
