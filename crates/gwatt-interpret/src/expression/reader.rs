//! Expressions of RS274/NGC and of Fanuc's macros: parameters, and values that are null or not
//! known.

use std::borrow::Cow;
use std::ops::{Deref, DerefMut};

use super::cursor::{Cursor, Lexis, exact_decimal};
use super::engine::Grammar;
use super::fault::{Fault, Outcome};
use super::function::Function;
use super::operator::{Operator, Prefix, truth};
use super::tape::{Op, Tape, parameter_number};
use super::terms::{Infix, Terms};
use super::value::{
    FROM_KEPT, Held, KEPT, Name, PROBED, Read, Value, Variables, infix, passed_on, remedy, terms_of,
};
use gwatt_machine::InverseAngles;
use gwatt_syntax::diagnostic::excerpt;

/// Stands for a value that is not known, in an expression whose value is not used.
const STAND_IN: Value = Some(1.0);

/// Letters of the longest keyword.
const AHEAD: usize = 9;

/// A cursor that keeps what it comes across.
#[derive(Debug)]
pub(crate) struct Reader<'t> {
    cursor: Cursor<'t>,
    /// What is worked out on the way, where that is wanted.
    pub(crate) tape: Tape,
    /// What ROUND of Fanuc's macros does here.
    pub(crate) round: Function,
    /// The place of an inverse function whose value a setting decides that is not known.
    pub(crate) unsure_angle_at: Option<usize>,
    /// Whether an unknown value is passed on instead of being an error.
    passes_on: bool,
    /// The first one that was, and the error that it would have been.
    unknown: Option<(&'static str, Fault)>,
}

impl<'t> Deref for Reader<'t> {
    type Target = Cursor<'t>;

    fn deref(&self) -> &Cursor<'t> {
        &self.cursor
    }
}

impl<'t> DerefMut for Reader<'t> {
    fn deref_mut(&mut self) -> &mut Cursor<'t> {
        &mut self.cursor
    }
}

/// The next few bytes without blanks, and where each ends.
#[derive(Debug, Default)]
struct Ahead {
    bytes: [u8; AHEAD],
    ends: [usize; AHEAD],
}

impl Ahead {
    /// Where as many bytes end.
    fn end(&self, length: usize) -> Option<usize> {
        self.ends.get(length.checked_sub(1)?).copied()
    }

    /// The first of a table whose token is next, and its length.
    fn first_of<'a, T>(
        &self,
        table: &'a [T],
        token: impl Fn(&T) -> &str,
    ) -> Option<(&'a T, usize)> {
        let mut entries = table.iter().map(|entry| (entry, token(entry).as_bytes()));
        let found = entries.find(|(_, token)| self.bytes.starts_with(token))?;
        Some((found.0, found.1.len()))
    }
}

/// A reader with the parameters that its text may use.
struct WithVariables<'r, 't, V> {
    reader: &'r mut Reader<'t>,
    variables: &'r V,
}

impl<'t> Reader<'t> {
    pub(crate) fn new(text: &'t [u8], at: usize) -> Self {
        let mut cursor = Cursor::new(text, Lexis::Blanks);
        cursor.at = at;
        Self {
            cursor,
            tape: Tape::default(),
            round: Function::Round,
            unsure_angle_at: None,
            passes_on: false,
            unknown: None,
        }
    }

    /// What comes next without its blanks, upper case: LinuxCNC reads past blanks
    /// wherever they stand, and so do Fanuc's controls.
    fn ahead(&mut self) -> Ahead {
        self.peek();
        let mut ahead = Ahead::default();
        let rest = self.text.get(self.at..).unwrap_or_default();
        let seen = rest
            .iter()
            .enumerate()
            .filter(|(_, byte)| !matches!(byte, b' ' | b'\t'));
        for (slot, (offset, byte)) in ahead.bytes.iter_mut().zip(&mut ahead.ends).zip(seen) {
            *slot.0 = byte.to_ascii_uppercase();
            *slot.1 = self.at + offset + 1;
        }
        ahead
    }

    /// Takes as many bytes of what [`Self::ahead`] gave.
    fn take_ahead(&mut self, ahead: &Ahead, length: usize) {
        self.at = ahead.end(length).unwrap_or(self.at);
    }

    /// Takes a word of letters if it is next, in either case.
    pub(crate) fn take_name(&mut self, name: &[u8]) -> bool {
        let begins = |next: u8| {
            name.first()
                .is_some_and(|it| it.eq_ignore_ascii_case(&next))
        };
        if !self.peek().is_some_and(begins) {
            return false;
        }
        let ahead = self.ahead();
        let next = ahead
            .bytes
            .get(..name.len())
            .is_some_and(|text| text.eq_ignore_ascii_case(name));
        if next {
            self.take_ahead(&ahead, name.len());
        }
        next
    }

    fn with<'r, V>(&'r mut self, variables: &'r V) -> WithVariables<'r, 't, V> {
        let reader = self;
        WithVariables { reader, variables }
    }

    /// A number, a parameter, a function or brackets, with signs before it: what
    /// may stand after the letter of a word.
    pub(crate) fn value(&mut self, variables: &impl Variables) -> Outcome<Value> {
        self.with(variables).operand()
    }

    /// `[ … ]`.
    pub(crate) fn brackets(&mut self, variables: &impl Variables) -> Outcome<Value> {
        let start = self.at;
        if self.peek() != Some(b'[') {
            let message = "`[` is missing here";
            return Err(self.fault("expression", message, "write [ … ]", start));
        }
        self.with(variables).in_brackets()
    }

    /// An unsigned number; `blanks` may stand between its digits.
    pub(crate) fn number(&mut self, blanks: bool) -> Outcome<f64> {
        let start = self.at;
        let rest = self.text.get(start..).unwrap_or_default();
        let of_number = |byte: &u8| {
            byte.is_ascii_digit() || *byte == b'.' || blanks && matches!(byte, b' ' | b'\t')
        };
        let length = rest.iter().take_while(|byte| of_number(byte)).count();
        let text = rest.get(..length).unwrap_or_default().trim_ascii_end();
        self.at = start + text.len();
        if let Some(value) = exact_decimal(text) {
            return Ok(value);
        }
        let digits = text.iter().filter(|byte| !matches!(byte, b' ' | b'\t'));
        self.parsed(&digits.copied().collect::<Vec<u8>>(), start)
    }

    /// `#5`, `##5`, `#[…]` or `#<name>` and what it holds.
    fn parameter(&mut self, variables: &impl Variables) -> Outcome<Value> {
        let start = self.at;
        let from = self.tape.ops.len();
        let name = self.parameter_name(variables)?;
        let read = match &name {
            Name::Number(number) => variables.numbered(*number),
            Name::Text(text) => variables.named(text),
        };
        self.tape.load(from, &name);
        match read {
            Read::Value(value) => Ok(value),
            Read::Unknown(reason) => {
                let fault = self.unknown_value(&name, reason, start);
                if !self.passes_on {
                    return Err(fault);
                }
                self.unknown.get_or_insert((reason, fault));
                Ok(STAND_IN)
            }
            Read::Missing => {
                let is_global = matches!(&name, Name::Text(text) if text.starts_with('_'));
                let help = if is_global {
                    "assign it before it is used, or give its value with --set"
                } else {
                    "assign it before it is used"
                };
                let message = format!("{name} has no value");
                Err(self.fault("no-such-parameter", message, help, start))
            }
        }
    }

    fn unknown_value(&self, name: &Name<'_>, reason: &'static str, start: usize) -> Fault {
        let message = match reason {
            KEPT => format!("{name} holds {KEPT}, which is not known"),
            PROBED | FROM_KEPT => format!("{name} depends on {reason}, which is not known"),
            _ => format!("{name} depends on {reason}, which only the machine knows"),
        };
        self.fault("unknown-value", message, remedy(reason), start)
    }

    /// An expression that is assigned: what is unknown in it makes the whole unknown,
    /// which is no error before something depends on it.
    pub(crate) fn assigned(&mut self, variables: &impl Variables) -> Outcome<Held> {
        self.passes_on = true;
        let value = self.with(variables).expression();
        self.passes_on = false;
        match self.unknown.take() {
            None => value.map(Ok),
            Some((reason, _)) if value.is_ok() => Ok(Err(passed_on(reason))),
            // What came of the value that stands in for it says nothing.
            Some((_, fault)) => Err(fault),
        }
    }

    /// `#` and what names the parameter.
    pub(crate) fn parameter_name(&mut self, variables: &impl Variables) -> Outcome<Name<'t>> {
        let start = self.at;
        if !self.take(b'#') {
            let message = "`#` is missing here";
            return Err(self.fault("expression", message, "write a parameter, as #1", start));
        }
        if self.peek() == Some(b'<') {
            return self.angle_name().map(Name::Text);
        }
        // The number of a parameter is arithmetic, wherever it stands.
        let round = std::mem::replace(&mut self.round, Function::Round);
        let value = self.value(variables);
        self.round = round;
        let value = value?;
        let Some(number) = parameter_number(value) else {
            let value = value.unwrap_or(0.0);
            let message = format!("{value} is not the number of a parameter");
            let help = "parameters have whole positive numbers";
            return Err(self.fault("no-such-parameter", message, help, start));
        };
        Ok(Name::Number(number))
    }

    /// `<name>`: lower case, blanks left out.
    pub(crate) fn angle_name(&mut self) -> Outcome<Cow<'t, str>> {
        let start = self.at;
        let inside = self
            .text
            .get(start + 1..)
            .and_then(|rest| Some((rest, memchr::memchr(b'>', rest)?)))
            .and_then(|(rest, end)| rest.get(..end))
            .and_then(|name| std::str::from_utf8(name).ok());
        let Some(name) = inside else {
            let message = "a name in < > is not closed";
            return Err(self.fault("expression", message, "write <name>", start));
        };
        self.at = start + name.len() + 2;
        let plain = |byte: u8| !byte.is_ascii_uppercase() && byte != b' ' && byte != b'\t';
        if name.bytes().all(plain) {
            return Ok(Cow::Borrowed(name));
        }
        let letters = name.chars().filter(|letter| !matches!(letter, ' ' | '\t'));
        Ok(Cow::Owned(letters.collect::<String>().to_ascii_lowercase()))
    }

    /// What stands at `start` names no function.
    fn no_function(&mut self, start: usize) -> Fault {
        let rest = self.text.get(start..).unwrap_or_default();
        let letters = rest.iter().take_while(|byte| byte.is_ascii_alphabetic());
        self.at += letters.count();
        let name = excerpt(self.text.get(start..self.at).unwrap_or_default(), 40);
        let message = format!("`{name}` is no function");
        let help =
            "the functions are ABS ACOS ASIN ATAN COS EXISTS EXP FIX FUP LN ROUND SIN SQRT TAN";
        self.fault("expression", message, help, start)
    }

    /// `/[` is next: the slash is taken.
    fn slash_bracket(&mut self) -> bool {
        let before = self.at;
        if self.take(b'/') && self.peek() == Some(b'[') {
            return true;
        }
        self.at = before;
        false
    }

    /// `EXISTS[#<name>]`: whether the parameter has a value.
    fn exists(&mut self, variables: &impl Variables) -> Outcome<f64> {
        let start = self.at;
        // It asks whether there is a value, not for one.
        self.tape.lost = true;
        let open = self.take(b'[');
        self.peek();
        let name = self.parameter_name(variables)?;
        if !open || !self.take(b']') {
            let message = "EXISTS takes one parameter in brackets";
            return Err(self.fault("expression", message, "write EXISTS[#<name>]", start));
        }
        let read = match &name {
            Name::Number(number) => variables.numbered(*number),
            Name::Text(name) => variables.named(name),
        };
        Ok(truth(read != Read::Missing))
    }
}

impl<'t, V: Variables> Grammar<'t> for WithVariables<'_, 't, V> {
    type Value = Value;

    fn terms(&self) -> &'static Terms {
        terms_of(self.variables)
    }

    fn cursor(&mut self) -> &mut Cursor<'t> {
        self.reader
    }

    /// Null is 0.
    fn number_of(&self, value: &Value, _start: usize) -> Outcome<f64> {
        Ok(value.unwrap_or(0.0))
    }

    fn value_of(&mut self, number: f64) -> Value {
        self.reader.tape.push(Op::Number(number));
        Some(number)
    }

    fn written_number(&mut self) -> Outcome<f64> {
        self.reader.number(!self.variables.fanuc())
    }

    fn next_infix(&mut self) -> Option<(Infix, usize)> {
        // Most values have nothing after them.
        let may_follow =
            |byte: u8| byte.is_ascii_alphabetic() || matches!(byte, b'*' | b'/' | b'+' | b'-');
        if !self.reader.peek().is_some_and(may_follow) {
            return None;
        }
        let ahead = self.reader.ahead();
        let (found, length) = ahead.first_of(self.terms().infixes, |(token, ..)| token)?;
        Some((*found, ahead.end(length)?))
    }

    fn infix(
        &mut self,
        operator: Operator,
        left: Value,
        right: Value,
        start: usize,
    ) -> Outcome<Value> {
        let result = infix(operator, left, right, self.variables);
        self.reader.tape.push(Op::Infix(operator));
        self.reader.worked_out(result, start).map(Some)
    }

    /// The only one is a sign, which leaves null as it is.
    fn prefix(&mut self, _prefix: Prefix, value: Value, _start: usize) -> Outcome<Value> {
        self.reader.tape.push(Op::Negate);
        Ok(value.map(|value| -value))
    }

    fn own_operand(&mut self) -> Outcome<Value> {
        match self.reader.peek() {
            Some(b'#') => self.reader.parameter(self.variables),
            Some(b'A'..=b'Z') => self.function().map(Some),
            _ => {
                let start = self.reader.at;
                self.reader.at += 1;
                Err(self.reader.fault(
                    "expression",
                    "a value is missing here",
                    "write a number, a parameter such as #1, or an expression in brackets",
                    start,
                ))
            }
        }
    }
}

impl<V: Variables> WithVariables<'_, '_, V> {
    /// A function with its argument in brackets.
    fn function(&mut self) -> Outcome<f64> {
        let start = self.reader.at;
        let ahead = self.reader.ahead();
        let fanuc = self.variables.fanuc();
        let found = ahead.first_of(self.terms().functions, |(name, _)| name);
        let Some((&(_, function), length)) = found else {
            return Err(self.reader.no_function(start));
        };
        self.reader.take_ahead(&ahead, length);
        if function == Function::Exists {
            return self.reader.exists(self.variables);
        }
        if !self.reader.take(b'[') {
            let message = "the argument of a function stands in brackets";
            let help = "write SIN[…]";
            return Err(self.reader.fault("expression", message, help, start));
        }
        let (mut values, count) = self.arguments(1, if fanuc { 2 } else { 1 })?;
        let [_, across, _] = &mut values;
        let function = match (function, count) {
            // ATAN[y]/[x] is one function of two values.
            (Function::Atan, 1) if self.reader.slash_bracket() => {
                *across = self.in_brackets()?.unwrap_or(0.0);
                Ok(Function::Angle)
            }
            (Function::Atan, 1) if !fanuc => Err("ATAN[…] without /[…] after it"),
            (Function::Atan, 2) => Ok(Function::Angle),
            (Function::Power, 1) => Err("a function of another form"),
            (function, count) if count > function.values() => {
                Err("a second argument of a function that takes one")
            }
            (function, _) => Ok(function),
        };
        let result = function.and_then(|function| {
            let function = self.as_set(function);
            // Steps do not follow the unit, which another run may have changed.
            self.reader.tape.lost |=
                function == Function::RoundThousandth || function == Function::RoundTenThousandth;
            self.reader.tape.push(Op::Of(function));
            function.apply(values)
        });
        if fanuc && matches!(function, Ok(Function::Angle | Function::Asin)) {
            let (_, is_known) = self.variables.inverse_angles();
            // Another run may come to an angle that is to be noted.
            self.reader.tape.lost |= !is_known;
            let differs = matches!(result, Ok(angle) if !(0.0..=180.0).contains(&angle));
            if differs && !is_known {
                self.reader.unsure_angle_at.get_or_insert(start);
            }
        }
        self.reader.worked_out(result, start)
    }

    /// The function as the place and the settings of a Fanuc have it.
    fn as_set(&self, function: Function) -> Function {
        let from_zero = self.variables.inverse_angles().0 == InverseAngles::FromZero;
        match function {
            Function::Round => self.reader.round,
            Function::Angle if from_zero => Function::AngleFromZero,
            Function::Asin if from_zero => Function::AsinFromZero,
            function => function,
        }
    }
}
