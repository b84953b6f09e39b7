//! What was worked out while a text was read, kept so that it can be worked out
//! again without the text.
//!
//! A reader meets operands and operators in the order of their values: that is
//! the postfix form of the expression already.

use arrayvec::ArrayVec;

use super::function::Function;
use super::operator::Operator;
use super::value::{Name, Read, Value, Variables, infix};

/// Values that wait for an operator.
const WAITING_MAX: usize = 16;

/// A step of a calculation on a stack of values.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Op {
    Number(f64),
    /// `#5`, `#<name>`, and the parameter whose number is the last value.
    Numbered(u32),
    Named(Box<str>),
    Indirect,
    Negate,
    Infix(Operator),
    Of(Function),
}

/// Notes steps while a text is read, if it records at all.
#[derive(Debug, Default)]
pub(crate) struct Tape {
    pub(crate) ops: Vec<Op>,
    pub(crate) records: bool,
    /// Something was read that steps do not show.
    pub(crate) lost: bool,
}

impl Tape {
    #[inline]
    pub(super) fn push(&mut self, op: Op) {
        if self.records {
            self.ops.push(op);
        }
    }

    /// Forgets the steps from `from` on, if they are a number as it is written.
    pub(crate) fn forget_number(&mut self, from: usize) -> bool {
        let fixed = matches!(self.ops.get(from..), Some([Op::Number(_)]));
        if fixed {
            self.ops.truncate(from);
        }
        fixed
    }

    /// A parameter is used whose name was read from step `from` on.
    pub(super) fn load(&mut self, from: usize, name: &Name<'_>) {
        if !self.records {
            return;
        }
        match name {
            Name::Text(text) => self.ops.push(Op::Named(Box::from(text.as_ref()))),
            Name::Number(number) if self.forget_number(from) => {
                self.ops.push(Op::Numbered(*number));
            }
            Name::Number(_) => self.ops.push(Op::Indirect),
        }
    }
}

/// The number of a parameter that a value names, if it names any.
pub(crate) fn parameter_number(value: Value) -> Option<u32> {
    let value = value.unwrap_or(0.0);
    let number = value.round();
    let is_one = (value - number).abs() <= 1e-4 && (0.0..=1e9).contains(&number);
    is_one.then_some(number as u32)
}

/// What the steps lead to. `None` where anything is wrong, which the text then
/// shows.
pub(crate) fn work_out(ops: &[Op], variables: &impl Variables) -> Option<Value> {
    let mut waiting: ArrayVec<Value, WAITING_MAX> = ArrayVec::new();
    // The last value stays out of the stack.
    let mut last = match ops.first()? {
        Op::Number(number) => Some(*number),
        Op::Numbered(number) => known(variables.numbered(*number))?,
        Op::Named(name) => known(variables.named(name))?,
        _ => return None,
    };
    for op in ops.get(1..)? {
        let next = match op {
            Op::Number(number) => Some(*number),
            Op::Numbered(number) => known(variables.numbered(*number))?,
            Op::Named(name) => known(variables.named(name))?,
            Op::Indirect => {
                last = known(variables.numbered(parameter_number(last)?))?;
                continue;
            }
            Op::Negate => {
                last = last.map(|value| -value);
                continue;
            }
            Op::Infix(operator) => {
                last = Some(infix(*operator, waiting.pop()?, last, variables).ok()?);
                continue;
            }
            Op::Of(function) => {
                let value = last.unwrap_or(0.0);
                let values = match function.values() {
                    2 => [waiting.pop()?.unwrap_or(0.0), value, 0.0],
                    _ => [value, 0.0, 0.0],
                };
                last = Some(function.apply(values).ok()?);
                continue;
            }
        };
        waiting.try_push(last).ok()?;
        last = next;
    }
    waiting.is_empty().then_some(last)
}

fn known(read: Read) -> Option<Value> {
    match read {
        Read::Value(value) => Some(value),
        Read::Unknown(_) | Read::Missing => None,
    }
}
