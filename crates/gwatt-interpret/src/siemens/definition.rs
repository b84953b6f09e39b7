//! DEF, PROC and the assignment of variables and arrays.
//!
//! "Definition of user variables (DEF)", "Definition and initialization of
//! array variables (DEF, SET, REP)", "Subprogram with parameter transfer
//! (PROC)".

use super::reading::Reading;
use super::saved::Saved;
use super::value::{COUNT_MAX, Kind, Scope, Val, Variable};
use crate::expression::{Grammar, Outcome};

/// Dimensions of something that is no array.
const SINGLE: [usize; 3] = [1; 3];

impl Reading<'_, '_, '_> {
    /// `DEF REAL A, B=3, C[10,3]=SET(…)`, after DEF.
    pub(super) fn definition(&mut self) -> Outcome<()> {
        // Where it holds and who may change it: no matter here.
        while ["NCK", "CHAN", "PHU", "SYNR", "SYNW", "SYNRW"]
            .iter()
            .any(|word| self.cursor.take_name(word))
        {}
        let kind = self.kind("DEF")?;
        loop {
            self.cursor.peek();
            let start = self.cursor.at;
            let name = self.cursor.name();
            if name.is_empty() || name.starts_with('$') {
                self.cursor.at += 1;
                let message = "DEF without the name of a variable";
                let help = "write DEF, a type and names, as in DEF REAL WIDTH=10, HEIGHT";
                return Err(self.cursor.fault("definition", message, help, start));
            }
            self.cursor.at += name.len();
            self.define(kind, &name, start)?;
            if !self.cursor.take(b',') {
                return Ok(());
            }
        }
    }

    fn kind(&mut self, word: &'static str) -> Outcome<Kind> {
        self.cursor.peek();
        let start = self.cursor.at;
        let name = self.cursor.name();
        self.cursor.at += name.len();
        let Some(kind) = Kind::named(&name) else {
            let message = format!("{word} with {name}, which is no type that gwatt knows");
            let help = "the types are REAL INT BOOL CHAR STRING AXIS";
            return Err(self.cursor.fault("definition", message, help, start));
        };
        if kind == Kind::Text {
            // The length of a text.
            self.index()?;
        }
        Ok(kind)
    }

    fn define(&mut self, kind: Kind, name: &str, start: usize) -> Outcome<()> {
        if let Some(number) = self.r_parameter(name)? {
            // An R parameter that is defined again: it stays what it is.
            let value = if self.cursor.take(b'=') {
                self.expression()?
            } else {
                kind.default()
            };
            let done = self.state.set_r(number, value);
            return done.map_err(|reason| self.cannot(name, reason, start));
        }
        let mut dimensions = SINGLE;
        if self.cursor.peek() == Some(b'[') {
            dimensions = self.index()?.map(|length| length.max(1));
        }
        let Some(variable) = Variable::new(kind, dimensions) else {
            return Err(self.cannot(name, "it has more than 100000 elements", start));
        };
        let Some(scope) = self.state.scopes.last_mut() else {
            return Ok(());
        };
        if scope.variables.len() >= COUNT_MAX {
            return Err(self.cannot(name, "there are more than 100000 variables", start));
        }
        scope.variables.insert(name.to_owned(), variable);
        if self.cursor.take(b'=') {
            self.fill(name, [0; 3], start)?;
        }
        Ok(())
    }

    fn cannot(&self, name: &str, reason: &str, start: usize) -> crate::expression::Fault {
        let message = format!("{name} cannot take this value: {reason}");
        let help = "define it by DEF with the type that it needs";
        self.cursor.fault("assignment", message, help, start)
    }

    /// After `NAME[i] =`: a value, or SET and REP for the elements from there.
    pub(super) fn fill(&mut self, name: &str, index: [usize; 3], start: usize) -> Outcome<()> {
        let set = self.cursor.take_name("SET");
        let lists = set || self.cursor.take_name("REP") || self.cursor.peek() == Some(b'(');
        let is_array = self
            .state
            .scopes
            .last()
            .and_then(|scope| scope.variables.get(name))
            .is_some_and(|variable| variable.values.len() > 1);
        if !lists || !is_array {
            let value = self.expression()?;
            return self.assign(name, index, value, start);
        }
        let repeats = !set
            && self
                .cursor
                .text
                .get(..self.cursor.at)
                .is_some_and(|before| {
                    before
                        .get(before.len().saturating_sub(3)..)
                        .is_some_and(|word| word.eq_ignore_ascii_case(b"REP"))
                });
        self.cursor.expect(b'(')?;
        let mut values: Vec<Option<Val>> = Vec::new();
        while self.cursor.peek() != Some(b')') {
            if values.len() >= COUNT_MAX {
                return Err(self.cannot(name, "there are more than 100000 values", start));
            }
            if self.cursor.take(b',') {
                values.push(None);
                continue;
            }
            values.push(Some(self.expression()?));
            if !self.cursor.take(b',') {
                break;
            }
        }
        self.cursor.expect(b')')?;
        self.enter_values(name, index, values, repeats, start)
    }

    fn enter_values(
        &mut self,
        name: &str,
        index: [usize; 3],
        values: Vec<Option<Val>>,
        repeats: bool,
        start: usize,
    ) -> Outcome<()> {
        let variable = self
            .state
            .scopes
            .last_mut()
            .and_then(|scope| scope.variables.get_mut(name));
        let Some(variable) = variable else {
            return Ok(());
        };
        let kind = variable.kind;
        let slots = variable
            .place(index)
            .and_then(|place| variable.values.get_mut(place..));
        let reason = match slots {
            None => Some("the first index is outside the array"),
            Some(slots) if repeats => {
                let (value, count) = match values.as_slice() {
                    [Some(value)] => (Some(value), slots.len()),
                    [Some(value), Some(Val::Number(count))] if *count >= 0.0 => {
                        (Some(value), *count as usize)
                    }
                    _ => (None, 0),
                };
                match value.map(|value| kind.convert(value.clone())) {
                    Some(Ok(value)) => {
                        slots
                            .iter_mut()
                            .take(count)
                            .for_each(|slot| *slot = value.clone());
                        None
                    }
                    Some(Err(reason)) => Some(reason),
                    None => Some("REP takes a value and a number of elements"),
                }
            }
            Some(slots) if values.len() > slots.len() => {
                Some("there are more values than elements")
            }
            Some(slots) => {
                let mut wrong = None;
                for (slot, value) in slots.iter_mut().zip(values) {
                    match value.map(|value| kind.convert(value)) {
                        Some(Ok(value)) => *slot = value,
                        Some(Err(reason)) => wrong = Some(reason),
                        None => {}
                    }
                }
                wrong
            }
        };
        match reason {
            Some(reason) => Err(self.cannot(name, reason, start)),
            None => Ok(()),
        }
    }

    /// `PROC NAME(REAL A, VAR INT B, BOOL C=TRUE) SAVE …`, after PROC: the
    /// parameters get the arguments of the call.
    pub(super) fn procedure(&mut self) -> Outcome<()> {
        let name = self.cursor.name();
        self.cursor.at += name.len();
        if self.cursor.take(b'(') {
            let mut position = 0;
            while !self.cursor.take(b')') {
                if position > 0 {
                    self.cursor.expect(b',')?;
                }
                self.parameter(position)?;
                position += 1;
            }
        }
        while !self.cursor.name().is_empty() {
            let start = self.cursor.at;
            let word = self.cursor.name();
            self.cursor.at += word.len();
            match word.as_str() {
                "SAVE" => {
                    let saved = Saved {
                        modal: self.control.modal.clone(),
                        frame: self.state.frame.clone(),
                        modes: self.state.modes(),
                        levels: self.control.knobs.levels,
                    };
                    if let Some(Scope { saved: slot, .. }) = self.state.scopes.last_mut() {
                        *slot = Some(Box::new(saved));
                    }
                }
                "SBLOF" | "SBLON" | "DISPLOF" | "DISPLON" | "ACTBLOCNO" | "ICYCOF" | "ICYCON"
                | "PREPRO" => {}
                _ => {
                    let message = format!("PROC with {word}, which gwatt does not follow");
                    let help = "nothing is estimated for a program that is not understood";
                    return Err(self.cursor.fault("unsupported-word", message, help, start));
                }
            }
        }
        Ok(())
    }

    fn parameter(&mut self, position: usize) -> Outcome<()> {
        let gives_back = self.cursor.take_name("VAR");
        let kind = self.kind("PROC")?;
        self.cursor.peek();
        let start = self.cursor.at;
        let name = self.cursor.name();
        self.cursor.at += name.len();
        let mut dimensions = SINGLE;
        if self.cursor.peek() == Some(b'[') {
            dimensions = self.index()?.map(|length| length.max(1));
        }
        let Some(mut variable) = Variable::new(kind, dimensions) else {
            return Err(self.cannot(&name, "it has more than 100000 elements", start));
        };
        let given = self.cursor.take(b'=');
        if given {
            let value = self.expression()?;
            variable.values = vec![value; variable.values.len()];
        }
        let Some(scope) = self.state.scopes.last_mut() else {
            return Ok(());
        };
        let argument = scope.arguments.get(position).cloned().flatten();
        if argument.is_none() && !given && !self.state.is_called() {
            // By itself the program runs nowhere: what it is called with decides.
            self.state.uncalled = true;
        }
        let single = dimensions == SINGLE;
        let Some(scope) = self.state.scopes.last_mut() else {
            return Ok(());
        };
        if let Some(argument) = &argument {
            match &argument.array {
                Some(array) if array.dimensions == dimensions && array.kind == kind => {
                    variable.values.clone_from(&array.values);
                }
                None if single => {}
                _ => {
                    let reason = "the call gives it something of another type or length";
                    return Err(self.cannot(&name, reason, start));
                }
            }
            if let Some(callers) = argument.variable.clone().filter(|_| gives_back) {
                if scope.given_back.iter().any(|(_, other)| *other == callers) {
                    let reason = "the call gives one variable to two VAR parameters";
                    return Err(self.cannot(&name, reason, start));
                }
                scope.given_back.push((name.to_string(), callers));
            }
        } else if !single && !given && self.state.is_called() {
            let reason = "it is an array, and the call gives it nothing";
            return Err(self.cannot(&name, reason, start));
        }
        let first = match argument {
            Some(argument) if single => Some(argument.value),
            _ if single => variable.values.first().cloned(),
            _ => None,
        };
        if let Some(scope) = self.state.scopes.last_mut()
            && scope.variables.len() < COUNT_MAX
        {
            scope.variables.insert(name.to_string(), variable);
        }
        match first {
            Some(value) => self.assign(&name, [0; 3], value, start),
            None => Ok(()),
        }
    }
}
