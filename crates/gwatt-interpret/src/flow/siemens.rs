//! The order of execution in SINUMERIK programs ("Job Planning": jumps, check
//! structures, repetition of sections, subprograms).

use super::landmarks::Part;
use super::section::Section;
use super::{Flow, FlowError, Place};
use crate::execute::Interpreter;
use crate::jump::{Direction, Siemens};

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
                self.next.line = self.partner("REPEAT")?.begin + 1;
                Ok(())
            }
            Siemens::Back => {
                let part = self.partner("beginning")?;
                if part.counts {
                    interpreter.count_on();
                }
                self.next.line = part.begin;
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
                self.leave_or_end(interpreter);
                let depth = self.calls.len();
                self.sections.retain(|section| section.depth <= depth);
                Ok(())
            }
        }
    }

    fn partner(&mut self, what: &str) -> Result<Part, FlowError> {
        self.part_here()?.ok_or_else(|| {
            let message = format!("there is no {what} for this");
            FlowError::new(
                "structure",
                message,
                "give each IF, WHILE, FOR, LOOP and REPEAT its end",
            )
        })
    }

    fn behind_partner(&mut self, what: &str) -> Result<(), FlowError> {
        self.next.line = self.partner(what)?.next + 1;
        Ok(())
    }

    fn jump(&mut self, to: &str, direction: Direction, quiet: bool) -> Result<(), FlowError> {
        let (here, len) = (self.now.line, self.len());
        let marks = self.landmarks(self.now.text)?;
        let found = match direction {
            Direction::Start => Some(marks.start(here)),
            Direction::Forwards => marks.forwards(to, here, len),
            Direction::Backwards => marks.backwards(to, here),
            Direction::Both => marks
                .forwards(to, here, len)
                .or_else(|| marks.backwards(to, here)),
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
        let marks = self.landmarks(self.now.text)?;
        let find = |label: &str| {
            marks
                .backwards(label, here)
                .or_else(|| marks.forwards(label, here, len))
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
            None if first > here => marks.label_end(first, len).unwrap_or(first),
            None => marks
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
        self.enter_named(begin, times, interpreter)
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
        if let Some(place) = self.find_head(stem, false)? {
            return Ok(place);
        }
        let main = self.find_head(stem, true)?;
        let bytes = match (self.library.load_subprogram(stem)?, main) {
            (Some(bytes), _) => bytes,
            (None, Some(place)) => return Ok(place),
            (None, None) => self.library.load_siemens(stem)?,
        };
        let text = self.add_named(stem, bytes);
        Ok(Place { text, line: 0 })
    }
}
