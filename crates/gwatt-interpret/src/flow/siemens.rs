//! The order of execution in SINUMERIK programs ("Job Planning": jumps, check
//! structures, repetition of sections, subprograms).

use super::outline::Outline;
use super::section::Section;
use super::text::Text;
use super::{Flow, FlowError, Place, Style};
use crate::execute::Interpreter;
use crate::jump::{Direction, Siemens};
use crate::parameters::LOCALS;

impl Flow {
    pub(super) fn siemens(
        &mut self,
        word: Siemens,
        interpreter: &mut Interpreter<'_>,
    ) -> Result<(), FlowError> {
        self.is_siemens = true;
        match word {
            Siemens::Next | Siemens::If(true) | Siemens::While(true) | Siemens::Until(true) => {
                Ok(())
            }
            Siemens::If(false) | Siemens::Else => self.behind_partner("ENDIF"),
            Siemens::While(false) => self.behind_partner("ENDWHILE or ENDFOR"),
            Siemens::Until(false) => {
                let begin = self.partner("REPEAT")?;
                self.next.line = begin + 1;
                Ok(())
            }
            Siemens::Back => {
                let begin = self.partner("beginning")?;
                if self.outline(self.now.text)?.counts(begin) {
                    interpreter.count_on();
                }
                self.next.line = begin;
                Ok(())
            }
            Siemens::Jump {
                to,
                direction,
                quiet,
            } => self.jump(&to, direction, quiet),
            Siemens::Repeat {
                from,
                to,
                block,
                times,
            } => self.repeat(&from, to.as_deref(), block, times),
            Siemens::Call { name, times, again } => {
                if again {
                    self.next = self.now;
                }
                self.call_siemens(&name, times, interpreter)
            }
            Siemens::Return => {
                if self.leave(interpreter).is_none() {
                    interpreter.end();
                }
                let depth = self.calls.len();
                self.sections.retain(|section| section.depth <= depth);
                Ok(())
            }
        }
    }

    /// The outline of a text, made when it is first asked for.
    fn outline(&mut self, text: usize) -> Result<&Outline, FlowError> {
        let text = self.texts.get_mut(text);
        text.map(Text::outline)
            .ok_or_else(|| FlowError::new("flow", "there is no such text", ""))
    }

    fn partner(&mut self, what: &str) -> Result<usize, FlowError> {
        let line = self.now.line;
        self.outline(self.now.text)?.partner(line).ok_or_else(|| {
            let message = format!("there is no {what} for this");
            FlowError::new(
                "structure",
                message,
                "give each IF, WHILE, FOR, LOOP and REPEAT its end",
            )
        })
    }

    fn behind_partner(&mut self, what: &str) -> Result<(), FlowError> {
        self.next.line = self.partner(what)? + 1;
        Ok(())
    }

    fn len(&self) -> usize {
        self.texts.get(self.now.text).map_or(0, Text::len)
    }

    fn jump(&mut self, to: &str, direction: Direction, quiet: bool) -> Result<(), FlowError> {
        let (here, len) = (self.now.line, self.len());
        let outline = self.outline(self.now.text)?;
        let found = match direction {
            Direction::Start => Some(outline.start(here)),
            Direction::Forwards => outline.forwards(to, here, len),
            Direction::Backwards => outline.backwards(to, here),
            Direction::Both => outline
                .forwards(to, here, len)
                .or_else(|| outline.backwards(to, here)),
        };
        match found {
            Some(line) => self.next.line = line,
            None if quiet => {}
            None => {
                let message = format!("there is no {to} to jump to in this direction");
                let help = "write the label with `:` after it, or the block's number";
                return Err(FlowError::new("no-such-block", message, help));
            }
        }
        Ok(())
    }

    /// "Repeat program section": a label is looked for towards the beginning
    /// first.
    fn repeat(
        &mut self,
        from: &str,
        to: Option<&str>,
        block: bool,
        times: u64,
    ) -> Result<(), FlowError> {
        let (here, len) = (self.now.line, self.len());
        let outline = self.outline(self.now.text)?;
        let find = |label: &str| {
            outline
                .backwards(label, here)
                .or_else(|| outline.forwards(label, here, len))
        };
        let missing = |label: &str| {
            let message = format!("there is no {label} to repeat");
            let help = "write the label with `:` after it";
            FlowError::new("no-such-block", message, help)
        };
        let first = find(from).ok_or_else(|| missing(from))?;
        let last = match to {
            _ if block => first,
            Some(to) => find(to).ok_or_else(|| missing(to))?,
            None if first > here => outline.label_end(first, len).unwrap_or(first),
            None => outline
                .label_end(first, here)
                .unwrap_or(here.saturating_sub(1)),
        };
        if last < first || (first..=last).contains(&here) {
            let message = "a section that ends before it begins, or repeats itself";
            let help = "write the labels in the order of the program, around other blocks";
            return Err(FlowError::new("flow", message, help));
        }
        if times == 0 {
            return Ok(());
        }
        if self.sections.len() >= self.limits.depth {
            let message = format!("more than {} calls inside one another", self.limits.depth);
            let help = "look for a section that repeats itself; --max-depth sets this limit";
            return Err(FlowError::new("call-depth", message, help));
        }
        self.sections.push(Section {
            text: self.now.text,
            depth: self.calls.len(),
            first,
            last,
            left: times - 1,
            back: here + 1,
        });
        self.next.line = first;
        Ok(())
    }

    /// At the end of a repeated section: again, or after its REPEAT.
    pub(super) fn end_section(&mut self) {
        while let Some(section) = self.sections.last_mut() {
            if section.depth > self.calls.len() {
                self.sections.pop();
                continue;
            }
            let inside = section.text == self.next.text && section.depth == self.calls.len();
            if !inside {
                return;
            }
            if (section.first..=section.last).contains(&self.next.line) {
                return;
            }
            let ended = self.now.line == section.last && self.next.line == section.last + 1;
            if ended && section.left > 0 {
                section.left -= 1;
                self.next.line = section.first;
                return;
            }
            // Done, or left by a jump.
            let back = section.back;
            self.sections.pop();
            if ended {
                self.next.line = back;
                self.now.line = back.saturating_sub(1);
            }
        }
    }

    fn call_siemens(
        &mut self,
        name: &str,
        times: u64,
        interpreter: &mut Interpreter<'_>,
    ) -> Result<(), FlowError> {
        if times == 0 {
            return Ok(());
        }
        let begin = self.find_siemens(name)?;
        let own = Some(Box::new([None; LOCALS]));
        self.enter(begin, times, own, Style::Program, interpreter)
    }

    /// A subprogram: in the texts that are there, or in a file of its own. A main program
    /// comes last: one may call the subprogram that has its name.
    fn find_siemens(&mut self, name: &str) -> Result<Place, FlowError> {
        let stem = name
            .strip_prefix("_N_")
            .unwrap_or(name)
            .trim_end_matches(".SPF")
            .trim_end_matches(".MPF")
            .trim_end_matches("_SPF")
            .trim_end_matches("_MPF");
        if let Some((_, text)) = self.named.iter().find(|(known, _)| known == stem) {
            return Ok(Place {
                text: *text,
                line: 0,
            });
        }
        if let Some(place) = self.find_header(stem, false)? {
            return Ok(place);
        }
        let main = self.find_header(stem, true)?;
        let bytes = match (self.library.load_subprogram(stem)?, main) {
            (Some(bytes), _) => bytes,
            (None, Some(place)) => return Ok(place),
            (None, None) => self.library.load_siemens(stem)?,
        };
        let text = self.texts.len();
        self.texts.push(Text::new(bytes));
        self.named.push((stem.to_owned(), text));
        Ok(Place { text, line: 0 })
    }

    /// A program or subprogram with a header, in the texts that are there.
    fn find_header(&mut self, stem: &str, main: bool) -> Result<Option<Place>, FlowError> {
        for text in 0..self.texts.len() {
            if let Some(line) = self.outline(text)?.program(stem, main) {
                return Ok(Some(Place { text, line }));
            }
        }
        Ok(None)
    }
}
