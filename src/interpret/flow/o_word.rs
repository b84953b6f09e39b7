//! O-words: subroutines, branches and loops (`LinuxCNC`, "O Codes").

use super::text::Search;
use super::{Flow, Loop, LoopKind, Trouble};
use crate::interpret::execute::Interpreter;
use crate::interpret::statement::Keyword;
use crate::interpret::transfer::{Label, Verb};
use crate::source::Span;

/// Repetitions that one loop may ask for.
const REPEATS_MAX: f64 = 1e12;

impl Flow {
    pub(super) fn structure(
        &mut self,
        label: Label,
        verb: Verb,
        interpreter: &mut Interpreter<'_>,
    ) -> Result<(), Trouble> {
        let undecided = self.undecided.take();
        match verb {
            // Not called: passed over.
            Verb::Sub => self.behind(&label, &[Keyword::EndSub], "endsub"),
            Verb::EndSub(value) | Verb::Return(value) => self.return_from(value, interpreter),
            Verb::Call(arguments) => {
                let mut begin = self.find_program(&label)?;
                // Behind its `sub`.
                begin.line += 1;
                self.enter(begin, 1, Some(arguments), true, interpreter)
            }
            Verb::If(true) | Verb::EndIf => Ok(()),
            Verb::If(false) => self.next_branch(label),
            Verb::ElseIf(condition) if undecided.as_ref() == Some(&label) => {
                if self.holds(condition, interpreter)? {
                    Ok(())
                } else {
                    self.next_branch(label)
                }
            }
            Verb::ElseIf(_) | Verb::Else => self.behind(&label, &[Keyword::EndIf], "endif"),
            Verb::While(holds) => self.begin_while(label, holds),
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
                let times = times.round();
                if !(times.abs() <= REPEATS_MAX) {
                    let message = format!("{times} is too many repetitions");
                    return Err(Trouble::new("endless", message, "write a smaller number"));
                }
                if times < 1.0 {
                    return self.behind(&label, &[Keyword::EndRepeat], "endrepeat");
                }
                let left = times as u64 - 1;
                self.begin_loop_of(label, LoopKind::Repeat { left });
                Ok(())
            }
            Verb::EndRepeat => self.end_repeat(&label),
            Verb::Break => self.break_loop(&label),
            Verb::Continue => self.continue_loop(&label),
        }
    }

    /// Goes on behind one of these O-words.
    fn behind(
        &mut self,
        label: &Label,
        keywords: &'static [Keyword],
        name: &str,
    ) -> Result<(), Trouble> {
        self.next.line = self.find_o_word(label, keywords, name)? + 1;
        Ok(())
    }

    fn find_o_word(
        &mut self,
        label: &Label,
        keywords: &'static [Keyword],
        name: &str,
    ) -> Result<usize, Trouble> {
        let search = Search::OWord(label.clone(), keywords);
        let from = self.now.line + 1;
        self.texts
            .get_mut(self.now.text)
            .and_then(|text| text.find(&search, from))
            .ok_or_else(|| {
                let message = format!("there is no `{label} {name}` behind this");
                Trouble::new("o-word", message, "give each O-word its counterpart")
            })
    }

    /// Goes on at the next branch of an IF.
    fn next_branch(&mut self, label: Label) -> Result<(), Trouble> {
        const BRANCHES: &[Keyword] = &[Keyword::ElseIf, Keyword::Else, Keyword::EndIf];
        let line = self.find_o_word(&label, BRANCHES, "endif")?;
        let found = Search::OWord(label.clone(), &[Keyword::ElseIf]);
        let text = self.texts.get_mut(self.now.text);
        let else_if = text.and_then(|text| text.find(&found, self.now.line + 1)) == Some(line);
        if else_if {
            self.next.line = line;
            self.undecided = Some(label);
        } else {
            self.next.line = line + 1;
        }
        Ok(())
    }

    /// The condition of an ELSEIF.
    fn holds(&self, condition: Span, interpreter: &Interpreter<'_>) -> Result<bool, Trouble> {
        interpreter
            .condition(self.text(), condition)
            .map_err(|fault| Trouble::new(fault.rule, fault.message, fault.help))
    }

    fn return_from(
        &mut self,
        value: Option<f64>,
        interpreter: &mut Interpreter<'_>,
    ) -> Result<(), Trouble> {
        if self.leave(interpreter).is_none() {
            return Err(stray("endsub"));
        }
        interpreter.returned(value);
        Ok(())
    }

    fn begin_while(&mut self, label: Label, holds: bool) -> Result<(), Trouble> {
        // The end of a DO loop.
        if self.running(&label) == Some(LoopKind::Do) {
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
        self.behind(&label, &[Keyword::EndWhile], "endwhile")
    }

    fn begin_loop_of(&mut self, label: Label, kind: LoopKind) {
        let line = self.now.line;
        // One that was left by other means is over.
        self.take_loop(&label);
        self.loops.push(Loop { label, kind, line });
    }

    fn end_repeat(&mut self, label: &Label) -> Result<(), Trouble> {
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

    fn break_loop(&mut self, label: &Label) -> Result<(), Trouble> {
        let Some(running) = self.take_loop(label) else {
            return Err(stray("break"));
        };
        let (keywords, name) = end_of(running.kind);
        self.behind(label, keywords, name)
    }

    fn continue_loop(&mut self, label: &Label) -> Result<(), Trouble> {
        let Some(kind) = self.running(label) else {
            return Err(stray("continue"));
        };
        if kind == LoopKind::While {
            if let Some(running) = self.take_loop(label) {
                self.next.line = running.line;
            }
            return Ok(());
        }
        let (keywords, name) = end_of(kind);
        self.next.line = self.find_o_word(label, keywords, name)?;
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

fn stray(name: &str) -> Trouble {
    let message = format!("{name} without what it belongs to");
    Trouble::new("o-word", message, "give each O-word its counterpart")
}
