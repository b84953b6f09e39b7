//! Expressions with numbers alone, where brackets are square and `( … )` is a comment: the ISG
//! kernel and Okuma's OSP.

use super::cursor::Cursor;
use super::engine::Grammar;
use super::fault::Outcome;
use super::function::Function;
use super::operator::{BITS_MAX, Operator, Rules};
use super::terms::Terms;

/// A value is true from 0.5 on.
pub(crate) const RULES: Rules = Rules {
    same: |a, b| a == b,
    less: |a, b| a < b,
    holds: |value| value.abs() >= 0.5,
    rest: libm::fmod,
    bits: |value| {
        if value.fract() == 0.0 && (0.0..=BITS_MAX).contains(&value) {
            Ok(value as i64)
        } else {
            Err("a logical operation on a value that is not a whole number of 32 bits")
        }
    },
};

/// What a language keeps under names.
pub(crate) trait Names<'t> {
    fn terms(&self) -> &'static Terms;

    fn cursor(&mut self) -> &mut Cursor<'t>;

    /// The value of the variable that begins at the cursor; `None` where none
    /// does.
    fn variable(&mut self) -> Outcome<Option<f64>>;
}

impl<'t, N: Names<'t>> Grammar<'t> for N {
    type Value = f64;

    fn terms(&self) -> &'static Terms {
        Names::terms(self)
    }

    fn cursor(&mut self) -> &mut Cursor<'t> {
        Names::cursor(self)
    }

    fn number_of(&self, value: &f64, _start: usize) -> Outcome<f64> {
        Ok(*value)
    }

    fn value_of(&mut self, number: f64) -> f64 {
        number
    }

    fn infix(&mut self, operator: Operator, left: f64, right: f64, start: usize) -> Outcome<f64> {
        let result = Names::terms(self).infix(operator, left, right);
        Names::cursor(self).worked_out(result, start)
    }

    fn own_operand(&mut self) -> Outcome<f64> {
        let cursor = Names::cursor(self);
        let something = cursor.peek().is_some();
        let start = cursor.at;
        let name = cursor.name();
        let terms = Names::terms(self);
        if let Some(function) = terms.function(&name) {
            let cursor = Names::cursor(self);
            cursor.at += name.len();
            if cursor.take(b'[') {
                return call(self, function, start);
            }
            cursor.at = start;
        }
        if let Some(constant) = terms.constant(&name) {
            Names::cursor(self).at += name.len();
            return Ok(constant);
        }
        if let Some(value) = self.variable()? {
            return Ok(value);
        }
        let cursor = Names::cursor(self);
        cursor.at += name.len().max(usize::from(something));
        let message = if name.is_empty() {
            "a value is missing here".to_owned()
        } else {
            format!("{name} is no variable or function that gwatt knows")
        };
        let help = "write a number, a variable, a function as SIN[…], or an expression in [ ]";
        Err(cursor.fault("expression", message, help, start))
    }
}

/// A function whose bracket has been opened.
fn call<'t, N: Names<'t>>(names: &mut N, function: Function, start: usize) -> Outcome<f64> {
    let (values, count) = names.arguments(1, 2)?;
    let result = match (count, function.values()) {
        (2, 1) => Err("a second value for a function of one"),
        (1, 2) => Err("a function that takes two values, as in MOD[7,3]"),
        _ => function.apply(values),
    };
    Names::cursor(names).worked_out(result, start)
}

#[cfg(test)]
mod tests {
    use super::super::cursor::{Cursor, Lexis};
    use super::super::engine::Grammar;
    use super::super::operator::{Operator, Prefix};
    use super::super::terms::Terms;
    use super::{Names, RULES};

    static TERMS: Terms = Terms {
        brackets: *b"[]",
        infixes: &[
            ("**", Operator::Power, 3),
            ("*", Operator::Times, 2),
            ("-", Operator::Minus, 1),
        ],
        prefixes: &[("NOT", Prefix::Not)],
        functions: &[],
        constants: &[("TWO", 2.0)],
        rules: RULES,
    };

    struct Plain<'t>(Cursor<'t>);

    impl<'t> Names<'t> for Plain<'t> {
        fn terms(&self) -> &'static Terms {
            &TERMS
        }

        fn cursor(&mut self) -> &mut Cursor<'t> {
            &mut self.0
        }

        fn variable(&mut self) -> super::Outcome<Option<f64>> {
            Ok(None)
        }
    }

    fn value(text: &str) -> Result<f64, String> {
        let mut plain = Plain(Cursor::new(text.as_bytes(), Lexis::Comments));
        plain.number().map_err(|fault| fault.message)
    }

    #[test]
    fn operators_of_a_table_bind_by_their_priority_and_from_the_left() {
        assert_eq!(value("9-4-3"), Ok(2.0));
        assert_eq!(value("1-2*TWO**3"), Ok(-15.0));
        assert_eq!(value("[1-2]*-TWO"), Ok(2.0));
        assert_eq!(value("NOT 0 - NOT 5"), Ok(1.0));
    }

    #[test]
    fn brackets_and_signs_count_once_each_towards_the_limit_of_depth() {
        let nested = |open: &str, close: &str, count| {
            value(&format!("{}1{}", open.repeat(count), close.repeat(count)))
        };
        let refused = Err("more than 64 brackets and signs in one another".to_owned());
        assert_eq!(nested("[", "]", 63), Ok(1.0));
        assert_eq!(nested("[", "]", 64), refused);
        assert_eq!(nested("-", "", 63), Ok(-1.0));
        assert_eq!(nested("-", "", 64), refused);
        assert_eq!(nested("2-1*1**[", "]", 63), Ok(1.0));
    }
}
