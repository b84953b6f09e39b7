//! Reads a text from the left and works out its value on the way.

use std::borrow::Cow;

use super::function::Function;
use super::operator;
use super::tape::{Op, Tape, parameter_number};
use super::value::{
    FROM_KEPT, Fault, Held, KEPT, PROBED, Read, Value, Variables, passed_on, remedy,
};
use crate::operator::Operator;
use gwatt_syntax::diagnostic::excerpt;
use gwatt_syntax::source::Span;

/// Brackets and signs inside one another.
const DEPTH_MAX: u32 = 64;

/// Stands for a value that is not known, in an expression whose value is not used.
const STAND_IN: Value = Some(1.0);

/// Letters of the longest keyword.
const AHEAD: usize = 9;

/// Whole numbers of so many digits are exact in an `f64`.
const EXACT_DIGITS: usize = 15;

/// A place in the text of a block, which moves on as the text is understood.
#[derive(Debug)]
pub(crate) struct Reader<'t> {
    pub(crate) text: &'t [u8],
    pub(crate) at: usize,
    /// What is worked out on the way, where that is wanted.
    pub(crate) tape: Tape,
    depth: u32,
    /// Whether an unknown value is passed on instead of being an error.
    passes_on: bool,
    /// The first one that was, and the error that it would have been.
    unknown: Option<(&'static str, Fault)>,
}

/// The next few bytes without blanks, and where each ends.
#[derive(Debug, Default)]
struct Ahead {
    bytes: [u8; AHEAD],
    ends: [usize; AHEAD],
}

/// Names one parameter.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Name<'t> {
    Number(u32),
    Text(Cow<'t, str>),
}

impl std::fmt::Display for Name<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Number(number) => write!(f, "#{number}"),
            Self::Text(name) => write!(f, "#<{name}>"),
        }
    }
}

type Outcome<T> = Result<T, Fault>;

impl<'t> Reader<'t> {
    pub(crate) fn new(text: &'t [u8], at: usize) -> Self {
        Self {
            text,
            at,
            tape: Tape::default(),
            depth: 0,
            passes_on: false,
            unknown: None,
        }
    }

    /// The next byte after blanks and comments, upper case; it stays.
    pub(crate) fn peek(&mut self) -> Option<u8> {
        loop {
            match self.text.get(self.at)? {
                b' ' | b'\t' => self.at += 1,
                b'(' => {
                    let rest = self.text.get(self.at..)?;
                    self.at += memchr::memchr(b')', rest)? + 1;
                }
                b';' => return None,
                byte => return Some(byte.to_ascii_uppercase()),
            }
        }
    }

    /// Takes `byte` if it is next.
    pub(crate) fn take(&mut self, byte: u8) -> bool {
        let next = self.peek() == Some(byte);
        self.at += usize::from(next);
        next
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
        let last = length.checked_sub(1).and_then(|last| ahead.ends.get(last));
        self.at = last.copied().unwrap_or(self.at);
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

    /// What stands at the place, and where.
    pub(crate) fn fault(
        &self,
        rule: &'static str,
        message: impl Into<String>,
        help: &'static str,
        start: usize,
    ) -> Fault {
        let end = self.at.max(start + 1).min(self.text.len());
        Fault::new(rule, message, help, Span::new(start.min(end), end))
    }

    /// A number, a parameter, a function or brackets, with signs before it: what
    /// may stand after the letter of a word.
    pub(crate) fn value(&mut self, variables: &impl Variables) -> Outcome<Value> {
        let start = self.at;
        self.depth += 1;
        if self.depth > DEPTH_MAX {
            let message = format!("more than {DEPTH_MAX} brackets and signs in one another");
            return Err(self.fault("expression", message, "take the expression apart", start));
        }
        let value = self.operand(variables);
        self.depth -= 1;
        value
    }

    fn operand(&mut self, variables: &impl Variables) -> Outcome<Value> {
        match self.peek() {
            Some(b'[') => self.brackets(variables),
            Some(b'#') => self.parameter(variables),
            Some(b'-') => {
                self.at += 1;
                let value = self.value(variables)?;
                self.tape.push(Op::Negate);
                Ok(value.map(|value| -value))
            }
            Some(b'+') => {
                self.at += 1;
                self.value(variables)
            }
            Some(b'0'..=b'9' | b'.') => {
                let number = self.number(!variables.fanuc())?;
                self.tape.push(Op::Number(number));
                Ok(Some(number))
            }
            Some(b'A'..=b'Z') => self.function(variables).map(Some),
            _ => {
                let start = self.at;
                self.at += 1;
                Err(self.fault(
                    "expression",
                    "a value is missing here",
                    "write a number, a parameter such as #1, or an expression in brackets",
                    start,
                ))
            }
        }
    }

    /// `[ … ]`.
    pub(crate) fn brackets(&mut self, variables: &impl Variables) -> Outcome<Value> {
        let start = self.at;
        if !self.take(b'[') {
            let message = "`[` is missing here";
            return Err(self.fault("expression", message, "write [ … ]", start));
        }
        let value = self.expression(variables)?;
        if !self.take(b']') {
            let message = "`]` is missing here";
            let help = "close each bracket, and write operators between values";
            return Err(self.fault("expression", message, help, self.at));
        }
        Ok(value)
    }

    /// Operands with operators between them.
    pub(crate) fn expression(&mut self, variables: &impl Variables) -> Outcome<Value> {
        self.operators(0, variables)
    }

    /// Operators that bind tighter than `least`, from the left.
    fn operators(&mut self, least: u8, variables: &impl Variables) -> Outcome<Value> {
        let mut left = self.value(variables)?;
        let fanuc = variables.fanuc();
        loop {
            // Most values have nothing after them.
            let may_follow =
                |byte: u8| byte.is_ascii_alphabetic() || matches!(byte, b'*' | b'/' | b'+' | b'-');
            if !self.peek().is_some_and(may_follow) {
                return Ok(left);
            }
            let ahead = self.ahead();
            let Some((found, length)) = operator::read(&ahead.bytes, fanuc) else {
                return Ok(left);
            };
            let precedence = operator::precedence(found);
            if precedence <= least {
                return Ok(left);
            }
            let start = self.at;
            self.take_ahead(&ahead, length);
            self.depth += 1;
            let right = self.operators(precedence, variables)?;
            self.depth -= 1;
            let result = operator::apply(found, left, right, fanuc)
                .map_err(|wrong| self.impossible(wrong, start))?;
            self.tape.push(Op::Apply(found));
            left = Some(self.finite(result, start)?);
        }
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
        if !text.is_empty() && text.len() <= EXACT_DIGITS && text.iter().all(u8::is_ascii_digit) {
            let digits = text.iter().map(|digit| u64::from(digit - b'0'));
            return Ok(digits.fold(0, |sum, digit| sum * 10 + digit) as f64);
        }
        let plain = if text.contains(&b' ') || text.contains(&b'\t') {
            let digits = text.iter().filter(|byte| !matches!(byte, b' ' | b'\t'));
            Cow::Owned(digits.copied().collect::<Vec<u8>>())
        } else {
            Cow::Borrowed(text)
        };
        let value = std::str::from_utf8(&plain)
            .ok()
            .and_then(|text| text.parse::<f64>().ok());
        match value {
            Some(value) if value.is_finite() => Ok(value),
            _ => Err(self.fault(
                "expression",
                format!("`{}` is not a number", excerpt(text, 40)),
                "write digits with at most one point",
                start,
            )),
        }
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
            Read::Missing => Err(self.fault(
                "no-such-parameter",
                format!("{name} has no value"),
                "assign it before it is used",
                start,
            )),
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
        let value = self.expression(variables);
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
        let value = self.value(variables)?;
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

    /// A function with its argument in brackets.
    fn function(&mut self, variables: &impl Variables) -> Outcome<f64> {
        let start = self.at;
        let ahead = self.ahead();
        let fanuc = variables.fanuc();
        let Some((function, length)) = Function::read(&ahead.bytes, fanuc) else {
            let rest = self.text.get(start..).unwrap_or_default();
            let letters = rest.iter().take_while(|byte| byte.is_ascii_alphabetic());
            self.at += letters.count();
            let name = excerpt(self.text.get(start..self.at).unwrap_or_default(), 40);
            let message = format!("`{name}` is no function");
            let help =
                "the functions are ABS ACOS ASIN ATAN COS EXISTS EXP FIX FUP LN ROUND SIN SQRT TAN";
            return Err(self.fault("expression", message, help, start));
        };
        self.take_ahead(&ahead, length);
        if function == Function::Exists {
            return self.exists(variables);
        }
        if !self.take(b'[') {
            let message = "the argument of a function stands in brackets";
            return Err(self.fault("expression", message, "write SIN[…]", start));
        }
        let x = self.expression(variables)?.unwrap_or(0.0);
        let second = if fanuc && self.take(b',') {
            Some(self.expression(variables)?.unwrap_or(0.0))
        } else {
            None
        };
        if !self.take(b']') {
            let message = "`]` is missing here";
            let help = "close each bracket, and write operators between values";
            return Err(self.fault("expression", message, help, self.at));
        }
        let (result, op) = match (function, second) {
            (Function::Power, Some(exponent)) => (
                operator::apply(Operator::Power, Some(x), Some(exponent), fanuc),
                Op::Apply(Operator::Power),
            ),
            (Function::Atan, Some(across)) => (Ok(libm::atan2(x, across).to_degrees()), Op::Angle),
            (_, Some(_)) => {
                let wrong = "a second argument of a function that takes one";
                return Err(self.impossible(wrong, start));
            }
            // ATAN[y]/[x] is one function of two values.
            (Function::Atan, None) if self.slash_bracket() => {
                let across = self.brackets(variables)?.unwrap_or(0.0);
                (Ok(libm::atan2(x, across).to_degrees()), Op::Angle)
            }
            (Function::Atan, None) if !fanuc => {
                return Err(self.impossible("ATAN[…] without /[…] after it", start));
            }
            (function, None) => (function.apply(x, fanuc), Op::Of(function)),
        };
        self.tape.push(op);
        let result = result.map_err(|wrong| self.impossible(wrong, start))?;
        self.finite(result, start)
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
        Ok(f64::from(u8::from(read != Read::Missing)))
    }

    fn impossible(&self, wrong: &'static str, start: usize) -> Fault {
        let help = "check the values that go into it";
        self.fault("arithmetic", wrong, help, start)
    }

    fn finite(&self, value: f64, start: usize) -> Outcome<f64> {
        if value.is_finite() {
            return Ok(value);
        }
        Err(self.impossible("a result beyond all numbers", start))
    }
}
