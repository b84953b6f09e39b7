//! What is needed to read a block, and variables by name.

use super::value::{COUNT_MAX, Kind, Val};
use super::{Extra, Siemens};
use crate::control::Control;
use crate::expression::{Cursor, Grammar, Outcome};
use gwatt_syntax::source::Span;

/// Highest R parameter that a control can have.
const R_MAX: f64 = 32_535.0;

/// A block while it is read.
pub(super) struct Reading<'c, 'm, 't> {
    pub(super) control: &'c Control<'m>,
    pub(super) state: &'c mut Siemens,
    pub(super) cursor: Cursor<'t>,
    /// What is to be reported once, with its rule.
    pub(super) notes: Vec<(&'static str, &'static str, Span)>,
}

/// Why a variable cannot be assigned.
pub(super) enum Refused {
    Type(&'static str),
    Index,
    TooMany,
    UnknownType,
}

impl Reading<'_, '_, '_> {
    /// What the block says besides its words; from now on it says something.
    pub(super) fn extra(&mut self) -> &mut Extra {
        self.state.active = true;
        &mut self.state.extra
    }

    pub(super) fn note(&mut self, rule: &'static str, message: &'static str, start: usize) {
        let span = self.cursor.span(start);
        self.notes.push((rule, message, span));
    }

    /// The value of a variable whose name has been taken.
    pub(super) fn variable(&mut self, name: &str, start: usize) -> Outcome<Val> {
        if let Some(number) = self.r_parameter(name)? {
            if let Some(value) = self.state.r.get(&number) {
                return Ok(Val::Number(*value));
            }
            let message =
                format!("R{number} has no value yet: what it holds, only the control knows");
            let help = "assign it in the program before it is used";
            return Err(self.cursor.fault("unknown-value", message, help, start));
        }
        let index = self.index()?;
        let variable = self
            .state
            .scopes
            .last()
            .and_then(|scope| scope.variables.get(name));
        if let Some(variable) = variable {
            let value = variable
                .place(index)
                .and_then(|place| variable.values.get(place));
            return match value {
                Some(value) => Ok(value.clone()),
                None => Err(self.outside(name, start)),
            };
        }
        if let Some(value) = self.state.globals.get(name).filter(|_| index == [0; 3]) {
            return Ok(value.clone());
        }
        let message = format!("{name} is not defined in this program");
        let help = "define it by DEF, assign it before, or give what the control keeps, as in --set WIDTH=1";
        Err(self.cursor.fault("unknown-value", message, help, start))
    }

    fn outside(&self, name: &str, start: usize) -> crate::expression::Fault {
        let message = format!("an index of {name} is outside its array");
        let help = "indices count from 0 to one less than the length";
        self.cursor.fault("array-index", message, help, start)
    }

    /// The number of an R parameter: `R10` or `R[…]`.
    pub(super) fn r_parameter(&mut self, name: &str) -> Outcome<Option<u32>> {
        let start = self.cursor.at;
        let Some(digits) = name.strip_prefix('R') else {
            return Ok(None);
        };
        let number = if digits.is_empty() {
            if self.cursor.peek() != Some(b'[') {
                return Ok(None);
            }
            self.cursor.at += 1;
            let number = self.number()?;
            self.cursor.expect(b']')?;
            number
        } else {
            match digits.parse::<f64>() {
                Ok(number) if digits.bytes().all(|byte| byte.is_ascii_digit()) => number,
                _ => return Ok(None),
            }
        };
        if number.fract() == 0.0 && (0.0..=R_MAX).contains(&number) {
            return Ok(Some(number as u32));
        }
        let message = format!("there is no R parameter {number}");
        let help = "write a whole number from 0 on";
        Err(self.cursor.fault("no-such-parameter", message, help, start))
    }

    /// `[i]`, `[i,j]`, `[i,j,k]`; 0 where nothing stands.
    pub(super) fn index(&mut self) -> Outcome<[usize; 3]> {
        let mut index = [0; 3];
        if self.cursor.peek() != Some(b'[') {
            return Ok(index);
        }
        let start = self.cursor.at;
        self.cursor.at += 1;
        for (dimension, slot) in index.iter_mut().enumerate() {
            if dimension > 0 && !self.cursor.take(b',') {
                break;
            }
            let value = self.number()?;
            if !(value.fract() == 0.0 && (0.0..COUNT_MAX as f64).contains(&value)) {
                let message = format!("{value} is no index");
                let help = "indices are whole numbers from 0 on";
                return Err(self.cursor.fault("array-index", message, help, start));
            }
            *slot = value as usize;
        }
        self.cursor.expect(b']')?;
        Ok(index)
    }

    /// Gives a variable of this name a value.
    pub(super) fn assign(
        &mut self,
        name: &str,
        index: [usize; 3],
        value: Val,
        start: usize,
    ) -> Outcome<()> {
        let defined = self
            .state
            .scopes
            .last()
            .is_some_and(|scope| scope.variables.contains_key(name));
        match self.state.set_variable(name, index, value) {
            Ok(()) => {
                if !defined {
                    let message = "a variable that the program does not define: \
                                   taken as one that is defined on the control";
                    self.note("global-variable", message, start);
                }
                Ok(())
            }
            Err(Refused::Index) => Err(self.outside(name, start)),
            Err(refused) => {
                let message = match refused {
                    Refused::Type(reason) => format!("{name} cannot take this value: {reason}"),
                    Refused::UnknownType => format!(
                        "{name} is not defined in this program, so that its type is not known"
                    ),
                    _ => "more than 100000 variables".to_owned(),
                };
                let help = "define it by DEF with the type that it needs";
                Err(self.cursor.fault("assignment", message, help, start))
            }
        }
    }
}

impl Siemens {
    /// Gives a variable of the program that runs a value, or else a global one.
    pub(super) fn set_variable(
        &mut self,
        name: &str,
        index: [usize; 3],
        value: Val,
    ) -> Result<(), Refused> {
        if let Some(variable) = self
            .scopes
            .last_mut()
            .and_then(|scope| scope.variables.get_mut(name))
        {
            let value = variable.kind.convert(value).map_err(Refused::Type)?;
            let place = variable.place(index).ok_or(Refused::Index)?;
            let slot = variable.values.get_mut(place).ok_or(Refused::Index)?;
            *slot = value;
            return Ok(());
        }
        // INT would round it, BOOL would cut it off.
        let known = match &value {
            Val::Number(value) => value.fract() == 0.0,
            Val::Text(_) => true,
        };
        if index != [0; 3] || !known {
            return Err(Refused::UnknownType);
        }
        if self.globals.len() >= COUNT_MAX {
            return Err(Refused::TooMany);
        }
        self.globals.insert(name.to_owned(), value);
        Ok(())
    }

    /// Sets an R parameter.
    pub(super) fn set_r(&mut self, number: u32, value: Val) -> Result<(), &'static str> {
        if let Val::Number(value) = Kind::Real.convert(value)? {
            self.r.insert(number, value);
        }
        Ok(())
    }
}
