//! Values that are worked out where brackets are square and `( … )` is a
//! comment: the ISG kernel and Okuma's OSP.

mod cursor;
mod function;
mod ident;
mod operator;
mod style;
mod variables;

pub(super) use cursor::{Cursor, Lexis, Outcome};
pub(super) use ident::Ident;
pub(super) use style::Style;
pub(super) use variables::{Kept, Uses, keep};

use self::function::Function;
use self::operator::{RULES, operator, priority};

/// Brackets and signs inside one another.
const DEPTH_MAX: u32 = 64;

/// What a language keeps under names.
pub(super) trait Names {
    fn style(&self) -> Style;

    /// The value of the variable that begins at the cursor; `None` where none
    /// does.
    fn variable(&mut self, cursor: &mut Cursor<'_>) -> Outcome<Option<f64>>;
}

/// The value of an expression.
pub(super) fn expression<N: Names + ?Sized>(
    cursor: &mut Cursor<'_>,
    names: &mut N,
) -> Outcome<f64> {
    deeper(cursor, |cursor| operators(cursor, names, 0))
}

/// The value of an expression that the text of the cursor holds, and nothing else.
pub(super) fn whole_value<N: Names>(cursor: &mut Cursor<'_>, names: &mut N) -> Option<f64> {
    let value = expression(cursor, names).ok()?;
    cursor.peek().is_none().then_some(value)
}

fn deeper(
    cursor: &mut Cursor<'_>,
    read: impl FnOnce(&mut Cursor<'_>) -> Outcome<f64>,
) -> Outcome<f64> {
    let start = cursor.at;
    cursor.depth += 1;
    if cursor.depth > DEPTH_MAX {
        let message = format!("more than {DEPTH_MAX} brackets and signs in one another");
        let help = "take the expression apart";
        return Err(cursor.fault("expression", message, help, start));
    }
    let value = read(cursor);
    cursor.depth -= 1;
    value
}

/// Operators that bind tighter than `least`, from the left.
fn operators<N: Names + ?Sized>(cursor: &mut Cursor<'_>, names: &mut N, least: u8) -> Outcome<f64> {
    let mut left = unary(cursor, names)?;
    while let Some((operator, length)) = operator(cursor, names.style()) {
        if priority(operator) <= least {
            break;
        }
        let start = cursor.at;
        cursor.at += length;
        let right = operators(cursor, names, priority(operator))?;
        left = operator
            .apply(left, right, &RULES)
            .map_err(|wrong| impossible(cursor, wrong, start))?;
        left = finite(cursor, left, start)?;
    }
    Ok(left)
}

fn unary<N: Names + ?Sized>(cursor: &mut Cursor<'_>, names: &mut N) -> Outcome<f64> {
    deeper(cursor, |cursor| {
        if cursor.take(b'-') {
            Ok(-unary(cursor, names)?)
        } else if cursor.take(b'+') {
            unary(cursor, names)
        } else if cursor.take_name("NOT") {
            let value = unary(cursor, names)?;
            Ok(f64::from(u8::from(value.abs() < 0.5)))
        } else {
            operand(cursor, names)
        }
    })
}

fn operand<N: Names + ?Sized>(cursor: &mut Cursor<'_>, names: &mut N) -> Outcome<f64> {
    let first = cursor.peek();
    let start = cursor.at;
    match first {
        Some(b'[') => {
            cursor.at += 1;
            let value = expression(cursor, names)?;
            cursor.expect(b']')?;
            return Ok(value);
        }
        Some(b'0'..=b'9' | b'.') => return cursor.number(),
        _ => {}
    }
    let name = cursor.name();
    if let Some(function) = Function::named(&name, names.style()) {
        let mut ahead = cursor.clone();
        ahead.at += name.len();
        if ahead.peek() == Some(b'[') {
            cursor.at = ahead.at + 1;
            return call(cursor, names, function, start);
        }
    }
    if let Some(constant) = Function::constant(&name, names.style()) {
        cursor.at += name.len();
        return Ok(constant);
    }
    if let Some(value) = names.variable(cursor)? {
        return Ok(value);
    }
    cursor.at += name.len().max(usize::from(first.is_some()));
    let message = if name.is_empty() {
        "a value is missing here".to_owned()
    } else {
        format!("{name} is no variable or function that gwatt knows")
    };
    let help = "write a number, a variable, a function as SIN[…], or an expression in [ ]";
    Err(cursor.fault("expression", message, help, start))
}

/// A function whose bracket has been opened.
fn call<N: Names + ?Sized>(
    cursor: &mut Cursor<'_>,
    names: &mut N,
    function: Function,
    start: usize,
) -> Outcome<f64> {
    let x = expression(cursor, names)?;
    let mut y = None;
    if cursor.take(b',') {
        y = Some(expression(cursor, names)?);
    }
    cursor.expect(b']')?;
    let value = function
        .apply(x, y)
        .map_err(|wrong| impossible(cursor, wrong, start))?;
    finite(cursor, value, start)
}

fn impossible(cursor: &Cursor<'_>, wrong: &'static str, start: usize) -> super::expression::Fault {
    let help = "check the values that go into it";
    cursor.fault("arithmetic", wrong, help, start)
}

fn finite(cursor: &Cursor<'_>, value: f64, start: usize) -> Outcome<f64> {
    if value.is_finite() {
        return Ok(value);
    }
    Err(impossible(cursor, "a result beyond all numbers", start))
}
