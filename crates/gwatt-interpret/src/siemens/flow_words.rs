//! Words that say where the program goes on.
//!
//! "Program jumps (GOTOS, GOTOB, GOTOF, GOTO, GOTOC)", "Program branch (CASE)",
//! "Repeat program section (REPEAT, REPEATB, ENDLABEL)", "Check structures",
//! "Subprogram technique".

use super::reading::Reading;
use super::value::{Argument, Val};
use super::{Called, ModalCall, cycle_call};
use crate::expression::{Grammar, Outcome};
use crate::jump::{Direction, Siemens as Go};

/// Repetitions that one word may ask for.
const TIMES_MAX: f64 = 1e6;
/// Arguments of a call.
const ARGUMENTS_MAX: usize = 127;

impl Reading<'_, '_, '_> {
    /// Takes a word that says where the program goes on.
    pub(super) fn flow_word(&mut self, name: &str, start: usize) -> Outcome<Option<Go>> {
        Ok(Some(match name {
            "GOTO" | "GOTOF" | "GOTOB" | "GOTOC" | "GOTOS" => self.jump(name)?,
            "IF" => {
                let holds = self.condition()?;
                let word = self.cursor.name();
                if word.starts_with("GOTO") {
                    self.cursor.at += word.len();
                    let jump = self.jump(&word)?;
                    if holds { jump } else { Go::Next }
                } else {
                    Go::If(holds)
                }
            }
            "ELSE" => Go::Else,
            "ENDIF" | "LOOP" | "ENDLABEL" => Go::Next,
            "ENDLOOP" | "ENDWHILE" | "ENDFOR" => Go::Back,
            "WHILE" => Go::While(self.condition()?),
            "UNTIL" => Go::Until(self.condition()?),
            "FOR" => self.counting(start)?,
            "REPEAT" | "REPEATB" => self.repetition(name == "REPEATB", start)?,
            "CASE" => self.case()?,
            "RET" | "ENDPROC" => {
                if self.cursor.peek() == Some(b'(') {
                    self.cursor.pass_over_parentheses()?;
                    let reason = "a return to another place";
                    return Err(self.cursor.refused("RET( )", reason, start));
                }
                Go::Return
            }
            "CALL" | "EXTCALL" => {
                let parenthesis = self.cursor.take(b'(');
                let name = self.text()?;
                if parenthesis {
                    self.cursor.expect(b')')?;
                }
                let file = name.rsplit(['/', '\\']).next().unwrap_or_default();
                self.program_call(&file.to_ascii_uppercase(), start)?
            }
            "MCALL" => {
                self.state.modal_call = None;
                let name = self.cursor.name();
                if !name.is_empty() {
                    let start = self.cursor.at;
                    self.cursor.at += name.len();
                    let what = self.called(&name, start)?;
                    let depth = self.state.scopes.len();
                    let set_at = (self.control.text, self.control.parameters.line);
                    self.state.modal_call = Some(ModalCall {
                        what,
                        depth,
                        set_at,
                    });
                }
                Go::Next
            }
            _ => return Ok(None),
        }))
    }

    fn condition(&mut self) -> Outcome<bool> {
        Ok(self.number()? != 0.0)
    }

    /// The destination of a jump.
    fn jump(&mut self, word: &str) -> Outcome<Go> {
        let to = if word == "GOTOS" {
            String::new()
        } else {
            self.destination()?
        };
        Ok(Go::Jump {
            to,
            direction: match word {
                "GOTOF" => Direction::Forwards,
                "GOTOB" => Direction::Backwards,
                "GOTOS" => Direction::Start,
                _ => Direction::Both,
            },
            quiet: word == "GOTOC",
        })
    }

    /// A label, or a block number as `N10`.
    fn destination(&mut self) -> Outcome<String> {
        let first = self.cursor.peek();
        let start = self.cursor.at;
        let name = self.cursor.name();
        if first.is_some_and(|byte| byte.is_ascii_digit() || byte == b':') {
            self.cursor.at += usize::from(first == Some(b':'));
            let number = self.cursor.number()?;
            return Ok(format!("N{number}"));
        }
        if first == Some(b'"') {
            return Ok(self.cursor.quoted()?.to_ascii_uppercase());
        }
        if name.is_empty() || name.starts_with('$') {
            self.cursor.at += usize::from(first.is_some());
            let message = "a jump without its destination";
            let help = "write a label or the number of a block";
            return Err(self.cursor.fault("flow", message, help, start));
        }
        self.cursor.at += name.len();
        let defined = self
            .state
            .scopes
            .last()
            .and_then(|scope| scope.variables.get(name.as_str()))
            .and_then(|variable| variable.values.first());
        if let Some(Val::Text(text)) = defined {
            return Ok(text.to_ascii_uppercase());
        }
        Ok(name.into())
    }

    /// `FOR variable = start TO end`.
    fn counting(&mut self, start: usize) -> Outcome<Go> {
        let name = self.cursor.name();
        self.cursor.at += name.len();
        let r = self.r_parameter(&name)?;
        let index = self.index()?;
        self.cursor.expect(b'=')?;
        let first = self.number()?;
        if !self.cursor.take_name("TO") {
            let message = "FOR without TO";
            let help = "write FOR R1 = 0 TO 10";
            return Err(self.cursor.fault("flow", message, help, start));
        }
        let last = self.number()?;
        let again = std::mem::take(&mut self.state.again);
        let mut value = first;
        if again {
            let here = if let Some(number) = r {
                self.state.r.get(&number).copied().map(Val::Number)
            } else {
                let known = self
                    .state
                    .scopes
                    .last()
                    .and_then(|scope| scope.variables.get(name.as_str()))
                    .and_then(|variable| variable.values.get(variable.place(index)?))
                    .or_else(|| self.state.globals.get(name.as_str()));
                known.cloned()
            };
            if let Some(Val::Number(here)) = here {
                value = here + 1.0;
            }
        }
        match r {
            Some(number) => {
                self.state.r.insert(number, value);
            }
            None => self.assign(&name, index, Val::Number(value), start)?,
        }
        Ok(Go::While(value <= last))
    }

    /// REPEAT … UNTIL, or a section between labels with P times.
    fn repetition(&mut self, block: bool, start: usize) -> Outcome<Go> {
        let mut labels = Vec::new();
        loop {
            let name = self.cursor.name();
            let is_times = name
                .strip_prefix('P')
                .is_some_and(|digits| digits.bytes().all(|byte| byte.is_ascii_digit()));
            if name.is_empty() || is_times || labels.len() == 2 {
                break;
            }
            self.cursor.at += name.len();
            labels.push(String::from(name));
        }
        let mut labels = labels.into_iter();
        let Some(from) = labels.next() else {
            return Ok(Go::Next);
        };
        let to = labels.next();
        if block && to.is_some() {
            let message = "REPEATB with two labels";
            let help = "it repeats one block: name that one";
            return Err(self.cursor.fault("flow", message, help, start));
        }
        let times = self.times()?.unwrap_or(1);
        Ok(Go::Repeat {
            from,
            to,
            block,
            times,
        })
    }

    /// `P3`, `P=3`, if it is next.
    fn times(&mut self) -> Outcome<Option<u64>> {
        let name = self.cursor.name();
        let start = self.cursor.at;
        let Some(digits) = name.strip_prefix('P') else {
            return Ok(None);
        };
        let value = if digits.is_empty() {
            self.cursor.at += 1;
            if self.cursor.take(b'=') {
                self.number()?
            } else {
                self.cursor.number()?
            }
        } else {
            let Ok(value) = digits.parse::<f64>() else {
                return Ok(None);
            };
            self.cursor.at += name.len();
            value
        };
        if (0.0..=TIMES_MAX).contains(&value) {
            return Ok(Some(value as u64));
        }
        let message = "a repetition of less than 0 or more than 1000000 times";
        let help = "write a smaller number";
        Err(self.cursor.fault("flow", message, help, start))
    }

    /// `CASE (…) OF 1 GOTOF A 2 GOTOF B DEFAULT GOTOF C`.
    fn case(&mut self) -> Outcome<Go> {
        let value = self.expression()?;
        let start = self.cursor.at;
        let mut wrong = !self.cursor.take_name("OF");
        let mut taken = None;
        while !wrong && self.cursor.peek().is_some() {
            let matches = self.cursor.take_name("DEFAULT") || self.expression()? == value;
            let word = self.cursor.name();
            wrong = !word.starts_with("GOTO");
            if wrong {
                break;
            }
            self.cursor.at += word.len();
            let jump = self.jump(&word)?;
            if matches && taken.is_none() {
                taken = Some(jump);
            }
        }
        if wrong {
            let message = "CASE is not complete here";
            let help = "write CASE (…) OF 1 GOTOF A 2 GOTOF B DEFAULT GOTOF C";
            return Err(self.cursor.fault("flow", message, help, start));
        }
        Ok(taken.unwrap_or(Go::Next))
    }

    /// A name that is none of the language: a cycle, or a subprogram.
    pub(super) fn call(&mut self, name: &str, start: usize) -> Outcome<Option<Go>> {
        if cycle_call::Kind::named(name).is_some() {
            if let Called::Cycle(call) = self.called(name, start)? {
                self.extra().cycle = Some(call);
            }
            return Ok(None);
        }
        self.program_call(name, start).map(Some)
    }

    fn program_call(&mut self, name: &str, start: usize) -> Outcome<Go> {
        let what = self.called(name, start)?;
        let times = self.times()?.unwrap_or(1);
        match what {
            Called::Program { name, arguments } => {
                let depth = self.state.scopes.len();
                let modal = self.state.modal_call.as_ref();
                let sets = |modal: &ModalCall| {
                    modal.depth == depth && matches!(modal.what, Called::Cycle(_))
                };
                if modal.is_some_and(sets) {
                    let message = "a subprogram while MCALL has set a cycle: whether its moves call \
                                   it is not known";
                    let help = "write MCALL before it, which ends that";
                    return Err(self.cursor.fault("flow", message, help, start));
                }
                self.state.pending = arguments;
                let again = false;
                Ok(Go::Call { name, times, again })
            }
            Called::Cycle(_) => {
                let message = "a cycle that is called by CALL";
                let help = "write its name alone";
                Err(self.cursor.fault("flow", message, help, start))
            }
        }
    }

    /// What is called, with its arguments.
    fn called(&mut self, name: &str, start: usize) -> Outcome<Called> {
        if let Some(super::names::Name::Refused(reason)) = super::names::Name::of(name) {
            return Err(self.cursor.refused(name, reason, start));
        }
        let arguments = self.arguments()?;
        if let Some(kind) = cycle_call::Kind::named(name) {
            let mut values = Vec::new();
            for (argument, place) in arguments.into_iter().zip(1..) {
                values.push(match argument {
                    Some(argument) if says_nothing(kind, place, &argument.value) => None,
                    Some(argument) => Some(self.number_of(&argument.value, start)?),
                    None => None,
                });
            }
            let span = self.cursor.span(start);
            return Ok(Called::Cycle(cycle_call::Call {
                kind,
                values,
                feeds: name == "CYCLE85",
                span,
            }));
        }
        let name = name.to_owned();
        Ok(Called::Program { name, arguments })
    }

    fn arguments(&mut self) -> Outcome<Vec<Option<Argument>>> {
        let mut arguments = Vec::new();
        if !self.cursor.take(b'(') {
            return Ok(arguments);
        }
        let start = self.cursor.at;
        while !self.cursor.take(b')') {
            if arguments.len() >= ARGUMENTS_MAX {
                let message = "a call with more than 127 arguments";
                let help = "pass them in variables";
                return Err(self.cursor.fault("flow", message, help, start));
            }
            if self.cursor.take(b',') {
                arguments.push(None);
                continue;
            }
            let name = self.cursor.name();
            let from = self.cursor.at;
            let value = self.expression()?;
            let written = self.cursor.text.get(from..self.cursor.at);
            let alone = written.is_some_and(|text| text.trim_ascii().len() == name.len());
            let variables = self.state.scopes.last().map(|scope| &scope.variables);
            let variable = variables
                .and_then(|variables| variables.get(name.as_str()))
                .filter(|_| alone);
            arguments.push(Some(Argument {
                value,
                array: variable.filter(|it| it.values.len() > 1).cloned(),
                variable: variable.is_some().then(|| name.into()),
            }));
            if self.cursor.peek() != Some(b')') {
                self.cursor.expect(b',')?;
            }
        }
        Ok(arguments)
    }
}

/// Whether an argument of a cycle is a text that says nothing about moves.
fn says_nothing(kind: cycle_call::Kind, place: usize, value: &Val) -> bool {
    matches!(value, Val::Text(text) if kind.passes_text(place, text))
}
