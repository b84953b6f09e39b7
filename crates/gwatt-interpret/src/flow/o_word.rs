//! O-words: subroutines, branches and loops (`LinuxCNC`, "O Codes").

use super::library::Library;
use super::text::{Search, Text};
use super::{Flow, FlowError, Loop, LoopKind, Place, Style};
use crate::execute::Interpreter;
use crate::jump::Verb;
use crate::label::Label;
use crate::statement::keyword::Keyword;
use gwatt_syntax::source::Span;

/// Repetitions that one loop may ask for.
const REPEATS_MAX: f64 = 1e12;

impl Flow {
    /// Whether the program defines subprograms (`o… sub`).
    #[must_use]
    pub fn holds_subprograms(&self) -> bool {
        self.texts.first().is_some_and(|text| {
            (0..text.len()).any(|line| text.keyword(line) == Some(Keyword::Sub))
        })
    }

    pub(super) fn structure(
        &mut self,
        label: Label,
        verb: Verb,
        interpreter: &mut Interpreter<'_>,
    ) -> Result<(), FlowError> {
        let undecided = self.undecided.take();
        self.check_label(&label, &verb, interpreter.loose_o_words())?;
        // Only LinuxCNC remembers a break.
        self.broke &= !interpreter.loose_o_words();
        match verb {
            Verb::Sub => self.pass_sub(label, interpreter),
            Verb::EndSub(value) | Verb::Return(value) => self.return_from(value, interpreter),
            Verb::Call(arguments) => {
                let mut begin = self.find_sub(label)?;
                // After its `sub`.
                begin.line += 1;
                self.enter(begin, 1, Some(arguments), Style::Sub, interpreter)
            }
            Verb::If(true) | Verb::EndIf => Ok(()),
            Verb::If(false) => self.next_branch(label, interpreter),
            Verb::ElseIf(condition) if undecided.as_ref() == Some(&label) => {
                if self.holds(condition, interpreter)? {
                    Ok(())
                } else {
                    self.next_branch(label, interpreter)
                }
            }
            Verb::ElseIf(_) | Verb::Else => {
                self.continue_after(&label, &[Keyword::EndIf], "endif", interpreter)
            }
            Verb::While(holds) => self.begin_while(label, holds, interpreter),
            Verb::EndWhile => match self.take_loop(&label) {
                Some(running) if running.kind == LoopKind::While => {
                    self.next.line = running.line;
                    Ok(())
                }
                _ => Err(stray("endwhile")),
            },
            Verb::Do => {
                self.begin_loop_of(label, LoopKind::Do);
                Ok(())
            }
            Verb::Repeat(times) => {
                // As LinuxCNC rounds: 2.5 is 2.
                let times = times.round_ties_even();
                if times.abs() > REPEATS_MAX {
                    let message = format!("{times} is too many repetitions");
                    return Err(FlowError::new("endless", message, "write a smaller number"));
                }
                if times < 1.0 {
                    return self.continue_after(
                        &label,
                        &[Keyword::EndRepeat],
                        "endrepeat",
                        interpreter,
                    );
                }
                let left = times as u64 - 1;
                self.begin_loop_of(label, LoopKind::Repeat { left });
                Ok(())
            }
            Verb::EndRepeat => self.end_repeat(&label),
            Verb::Break => self.break_loop(&label, interpreter),
            Verb::Continue => self.continue_loop(&label, interpreter),
        }
    }

    /// A subroutine that is not called is passed over.
    fn pass_sub(&mut self, label: Label, interpreter: &Interpreter<'_>) -> Result<(), FlowError> {
        if !self.calls.is_empty() {
            return Err(nested());
        }
        if interpreter.in_program() {
            let message = "a subroutine begins inside a program with an O number";
            let help = "end the program with M2 or M30 before it";
            return Err(FlowError::new("o-word", message, help));
        }
        if let Some(known) = self.subs.get(&label)
            && *known != self.now
        {
            return Err(duplicate(&label, known.line));
        }
        self.continue_after(&label, &[Keyword::EndSub], "endsub", interpreter)?;
        self.subs.insert(label, self.now);
        Ok(())
    }

    /// Where a subroutine begins: one that was passed, one in a file of its own,
    /// or one further down, in this order as in `LinuxCNC`.
    fn find_sub(&mut self, label: Label) -> Result<Place, FlowError> {
        if let Some(place) = self.subs.get(&label) {
            return Ok(*place);
        }
        let search = Search::OWord(label.clone(), &[Keyword::Sub]);
        let (text, from) = match self.load(&label)? {
            Some(text) => (text, 0),
            None => (self.now.text, self.now.line + 1),
        };
        let begins = |text: &mut Text| {
            let line = text.find(&search, from)?;
            (text.keyword(line) == Some(Keyword::Sub)).then_some(line)
        };
        let Some(line) = self.texts.get_mut(text).and_then(begins) else {
            let program = self.texts.get_mut(text).and_then(|text| text.begin(&label));
            if program.is_some_and(|line| line >= from) {
                let message = format!("`call` calls the program {label}, which has no `sub`");
                return Err(FlowError::new("o-word", message, "call it with M98"));
            }
            return Err(Library::nothing(&label));
        };
        let place = Place { text, line };
        self.subs.insert(label, place);
        Ok(place)
    }

    /// Each branch and loop of a subroutine has its own label, and what belongs
    /// to it comes after it.
    fn check_label(&mut self, label: &Label, verb: &Verb, repeat: bool) -> Result<(), FlowError> {
        let keyword = verb.keyword();
        let text = self.texts.get(self.now.text);
        let runs = text.and_then(|text| text.runs.get(self.now.line));
        if runs.is_none_or(|runs| *runs > 1) {
            return Ok(());
        }
        let line = self.now.line;
        let key = (self.calls.last().map(|frame| frame.begin), label.clone());
        let known = self.labels.get(&key).copied();
        let matches = |of: &[Keyword]| known.is_some_and(|(keyword, _)| of.contains(&keyword));
        match keyword {
            Keyword::While if matches(&[Keyword::Do]) => Ok(()),
            _ if keyword.opens() => match known {
                Some((_, before)) if before != line && !repeat => Err(duplicate(label, before)),
                _ => {
                    self.labels.insert(key, (keyword, line));
                    Ok(())
                }
            },
            Keyword::ElseIf | Keyword::Else | Keyword::EndIf if !matches(&[Keyword::If]) => {
                Err(stray(keyword.name()))
            }
            Keyword::Break | Keyword::Continue if !matches(&[Keyword::While, Keyword::Do]) => {
                Err(stray(keyword.name()))
            }
            _ => Ok(()),
        }
    }

    /// Goes on after one of these O-words.
    fn continue_after(
        &mut self,
        label: &Label,
        keywords: &'static [Keyword],
        name: &str,
        interpreter: &Interpreter<'_>,
    ) -> Result<(), FlowError> {
        self.next.line = self.find_o_word(label, keywords, name, interpreter)? + 1;
        Ok(())
    }

    fn find_o_word(
        &mut self,
        label: &Label,
        keywords: &'static [Keyword],
        name: &str,
        interpreter: &Interpreter<'_>,
    ) -> Result<usize, FlowError> {
        let search = Search::OWord(label.clone(), keywords);
        let from = self.now.line + 1;
        let mut found = None;
        if let Some(text) = self.texts.get_mut(self.now.text) {
            let line = if text.works_out_labels() {
                text.find_worked_out(label, keywords, from, interpreter)
                    .map_err(|fault| FlowError::new(fault.rule, fault.message, fault.help))?
            } else {
                text.find(&search, from)
            };
            found = line.and_then(|line| Some((line, text.keyword(line)?)));
        }
        match found {
            Some((line, keyword)) if keywords.contains(&keyword) => Ok(line),
            Some((_, Keyword::Sub)) => Err(nested()),
            Some(_) => Err(duplicate(label, self.now.line)),
            None => {
                let message = format!("there is no `{label} {name}` after this");
                Err(FlowError::new(
                    "o-word",
                    message,
                    "give each O-word its counterpart",
                ))
            }
        }
    }

    /// Goes on at the next branch of an IF.
    fn next_branch(
        &mut self,
        label: Label,
        interpreter: &Interpreter<'_>,
    ) -> Result<(), FlowError> {
        const BRANCHES: &[Keyword] = &[Keyword::ElseIf, Keyword::Else, Keyword::EndIf];
        let line = self.find_o_word(&label, BRANCHES, "endif", interpreter)?;
        let text = self.texts.get(self.now.text);
        if text.and_then(|text| text.keyword(line)) == Some(Keyword::ElseIf) {
            self.next.line = line;
            self.undecided = Some(label);
        } else {
            self.next.line = line + 1;
        }
        Ok(())
    }

    /// The condition of an ELSEIF.
    fn holds(&self, condition: Span, interpreter: &Interpreter<'_>) -> Result<bool, FlowError> {
        interpreter
            .condition(self.text(), condition)
            .map_err(|fault| FlowError::new(fault.rule, fault.message, fault.help))
    }

    fn return_from(
        &mut self,
        value: Option<f64>,
        interpreter: &mut Interpreter<'_>,
    ) -> Result<(), FlowError> {
        match self.calls.last().map(|frame| frame.style) {
            Some(Style::Sub) => {}
            Some(Style::Program | Style::Macro) => {
                let message = "a program that M98 has called ends with M99";
                return Err(FlowError::new("o-word", message, "write M99"));
            }
            None => return Err(stray("endsub")),
        }
        self.leave(interpreter);
        interpreter.returned(value);
        Ok(())
    }

    fn begin_while(
        &mut self,
        label: Label,
        holds: bool,
        interpreter: &Interpreter<'_>,
    ) -> Result<(), FlowError> {
        // The end of a DO loop.
        if self.running(&label) == Some(LoopKind::Do) {
            if std::mem::take(&mut self.broke) && holds {
                let message = "a break has left a while loop before, which ends this do loop \
                               on LinuxCNC 2.9";
                let help = "write the loop with while and endwhile";
                return Err(FlowError::new("o-word", message, help));
            }
            if let Some(running) = self.take_loop(&label)
                && holds
            {
                self.next.line = running.line + 1;
                self.loops.push(running);
            }
            return Ok(());
        }
        if holds {
            self.begin_loop_of(label, LoopKind::While);
            return Ok(());
        }
        self.continue_after(&label, &[Keyword::EndWhile], "endwhile", interpreter)
    }

    fn begin_loop_of(&mut self, label: Label, kind: LoopKind) {
        let line = self.now.line;
        // One that was left by other means is over.
        self.take_loop(&label);
        self.loops.push(Loop { label, kind, line });
    }

    fn end_repeat(&mut self, label: &Label) -> Result<(), FlowError> {
        let Some(mut running) = self.take_loop(label) else {
            return Err(stray("endrepeat"));
        };
        let LoopKind::Repeat { left } = &mut running.kind else {
            return Err(stray("endrepeat"));
        };
        if *left > 0 {
            *left -= 1;
            self.next.line = running.line + 1;
            self.loops.push(running);
        }
        Ok(())
    }

    fn break_loop(
        &mut self,
        label: &Label,
        interpreter: &Interpreter<'_>,
    ) -> Result<(), FlowError> {
        let Some(running) = self.take_loop(label) else {
            return Err(stray("break"));
        };
        self.broke |= running.kind == LoopKind::While;
        let (keywords, name) = end_of(running.kind);
        self.continue_after(label, keywords, name, interpreter)
    }

    fn continue_loop(
        &mut self,
        label: &Label,
        interpreter: &Interpreter<'_>,
    ) -> Result<(), FlowError> {
        let Some(kind) = self.running(label) else {
            return Err(stray("continue"));
        };
        if kind == LoopKind::While {
            if let Some(running) = self.take_loop(label) {
                self.next.line = running.line;
            }
            return Ok(());
        }
        let ends: &[Keyword] = match kind {
            LoopKind::Do => &[Keyword::Break, Keyword::While],
            _ => end_of(kind).0,
        };
        let line = self.find_o_word(label, ends, end_of(kind).1, interpreter)?;
        let text = self.texts.get(self.now.text);
        if text.and_then(|text| text.keyword(line)) == Some(Keyword::Break) {
            // It goes on at the next line with the label, whatever that says.
            let message = "after this continue stands a break of the same do loop, \
                           which LinuxCNC would take";
            let help = "write the break before the continue, or the loop with while and endwhile";
            return Err(FlowError::new("o-word", message, help));
        }
        self.next.line = line;
        Ok(())
    }

    /// The kind of a loop of this subroutine that runs.
    fn running(&self, label: &Label) -> Option<LoopKind> {
        let own = self.calls.last().map_or(0, |frame| frame.loops);
        let loops = self.loops.get(own..)?;
        let found = loops.iter().rev().find(|running| running.label == *label);
        found.map(|running| running.kind)
    }

    /// Takes a loop that runs, with those inside it.
    fn take_loop(&mut self, label: &Label) -> Option<Loop> {
        self.running(label)?;
        while let Some(running) = self.loops.pop() {
            if running.label == *label {
                return Some(running);
            }
        }
        None
    }
}

/// What ends a loop.
fn end_of(kind: LoopKind) -> (&'static [Keyword], &'static str) {
    match kind {
        LoopKind::While => (&[Keyword::EndWhile], "endwhile"),
        LoopKind::Do => (&[Keyword::While], "while"),
        LoopKind::Repeat { .. } => (&[Keyword::EndRepeat], "endrepeat"),
    }
}

fn nested() -> FlowError {
    let message = "a subroutine begins inside another";
    FlowError::new("o-word", message, "end each subroutine before the next")
}

fn duplicate(label: &Label, line: usize) -> FlowError {
    let line = line + 1;
    let message = format!("the label {label} is used for two things, before in line {line}");
    let help = "give each branch and loop of a subroutine a label of its own";
    FlowError::new("o-word", message, help)
}

fn stray(name: &str) -> FlowError {
    let message = format!("{name} without what it belongs to");
    FlowError::new("o-word", message, "give each O-word its counterpart")
}
