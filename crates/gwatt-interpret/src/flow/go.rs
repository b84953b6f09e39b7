//! The order of execution in programs of the ISG kernel (TF5200, "Control block
//! statements", "Subroutine techniques") and of Okuma's OSP ("Subprogram
//! Functions", "Branch Function").

use super::{Flow, FlowError, Place, Style};
use crate::execute::Interpreter;
use crate::isg::Pending;
use crate::jump::Go;
use crate::parameters::LOCALS;

use super::landmarks::{Landmarks, Part};
use super::text::Text;

impl Flow {
    pub(super) fn go(
        &mut self,
        word: Go,
        interpreter: &mut Interpreter<'_>,
    ) -> Result<(), FlowError> {
        self.percent_names_programs = interpreter.percent_names_programs();
        match word {
            Go::Next | Go::If(true) | Go::Loop(true) | Go::Again(false) => {}
            Go::Main => {
                let text = self.now.text;
                let Some(line) = self.landmarks(text)?.main() else {
                    let message = "local subprograms without a main program after them";
                    let help = "write % and a name before the main program";
                    return Err(FlowError::new("subprogram", message, help));
                };
                self.next.line = line + 1;
            }
            Go::End => interpreter.end(),
            Go::If(false) => {
                let part = self.part()?;
                self.next.line = part.next + usize::from(!part.next_decides);
                if part.next_decides {
                    interpreter.expect_next(Pending::Decide);
                }
            }
            Go::BehindIf | Go::Loop(false) => self.next.line = self.part()?.end + 1,
            Go::Back => {
                let part = self.part()?;
                self.next.line = part.begin;
                if part.counts {
                    interpreter.expect_next(Pending::Count);
                }
            }
            Go::Again(true) => self.next.line = self.part()?.begin + 1,
            Go::Switch(value) => {
                let part = self.part()?;
                self.next.line = part.next + usize::from(!part.next_decides);
                if part.next_decides {
                    interpreter.expect_next(Pending::Compare(value));
                }
            }
            Go::Break => self.next.line = self.around()? + 1,
            Go::Continue => self.next.line = self.around()?,
            Go::Jump(label) => self.jump_to(&label)?,
            Go::Local(name) => self.call_local(&name, interpreter)?,
            Go::File(name) => self.call_file(&name, interpreter)?,
            Go::Modal(name) => self.modal_named = name.map(|name| (name, self.calls.len())),
            Go::Call { name, times } => self.call_osp(&name, times, interpreter)?,
            Go::Return => self.leave_or_end(interpreter),
        }
        Ok(())
    }

    /// What the lines of a text are, found when it is first asked for.
    pub(super) fn landmarks(&mut self, text: usize) -> Result<&Landmarks, FlowError> {
        let find = match (self.is_siemens, self.percent_names_programs) {
            (true, _) => Landmarks::of_siemens,
            (_, true) => Landmarks::of_isg,
            _ => Landmarks::of_osp,
        };
        let text = self.texts.get_mut(text);
        text.map(|text| text.landmarks(find))
            .ok_or_else(|| FlowError::new("flow", "there is no such text", ""))
    }

    /// The structure that the line belongs to, if any.
    pub(super) fn part_here(&mut self) -> Result<Option<Part>, FlowError> {
        let Place { text, line } = self.now;
        Ok(self.landmarks(text)?.part(line))
    }

    fn part(&mut self) -> Result<Part, FlowError> {
        self.part_here()?.ok_or_else(|| {
            let message = "the other end of this statement is missing";
            let help = "give each $IF, $SWITCH, $FOR, $WHILE, $DO and $REPEAT its end";
            FlowError::new("structure", message, help)
        })
    }

    fn around(&mut self) -> Result<usize, FlowError> {
        let part = self.part_here()?;
        part.and_then(|part| part.around).ok_or_else(|| {
            let message = "there is no loop around this";
            let help = "write $BREAK in a loop or $SWITCH, $CONTINUE in a loop";
            FlowError::new("structure", message, help)
        })
    }

    fn jump_to(&mut self, label: &str) -> Result<(), FlowError> {
        let (line, len) = (self.now.line, self.len());
        let found = self.landmarks(self.now.text)?.find(label, line, len);
        let Some(found) = found else {
            let message = format!("there is no {label} to jump to in this program");
            let help = "write the label at the beginning of the block that is meant";
            return Err(FlowError::new("no-such-block", message, help));
        };
        self.next.line = found;
        Ok(())
    }

    pub(super) fn len(&self) -> usize {
        self.texts.get(self.now.text).map_or(0, Text::len)
    }

    /// Back to the caller; a main program ends.
    pub(super) fn leave_or_end(&mut self, interpreter: &mut Interpreter<'_>) {
        if self.leave(interpreter).is_none() {
            interpreter.end();
        }
    }

    fn call_local(
        &mut self,
        name: &str,
        interpreter: &mut Interpreter<'_>,
    ) -> Result<(), FlowError> {
        let text = self.now.text;
        let name_in_text = name.to_ascii_uppercase();
        let Some(line) = self.landmarks(text)?.program(&name_in_text, false) else {
            let message = format!("there is no local subprogram {name} in this file");
            let help = "define it before the main program, by %L and its name";
            return Err(FlowError::new("no-such-subprogram", message, help));
        };
        self.enter_named(Place { text, line }, 1, interpreter)
    }

    fn call_file(
        &mut self,
        name: &str,
        interpreter: &mut Interpreter<'_>,
    ) -> Result<(), FlowError> {
        let names = [name.to_owned(), format!("{name}.nc")];
        let text = self.text_named(name, &names)?;
        let line = self.landmarks(text)?.main();
        let begin = Place {
            text,
            line: line.map_or(0, |line| line + 1),
        };
        self.enter_named(begin, 1, interpreter)
    }

    /// CALL of OSP: in the files that are there, or in one of its own.
    fn call_osp(
        &mut self,
        name: &str,
        times: u64,
        interpreter: &mut Interpreter<'_>,
    ) -> Result<(), FlowError> {
        let head = name.to_ascii_uppercase();
        if let Some(begin) = self.find_head(&head, false)? {
            return self.enter_named(begin, times, interpreter);
        }
        let short = name.strip_prefix('O').unwrap_or(name);
        let names = ["SSB", "SUB", "LIB", "MSB", "MIN"]
            .into_iter()
            .flat_map(|ending| [format!("{name}.{ending}"), format!("{short}.{ending}")])
            .collect::<Vec<_>>();
        let text = self.text_named(name, &names)?;
        let Some(line) = self.landmarks(text)?.program(&head, false) else {
            let message = format!("the file of {name} does not hold it");
            let help = "begin the subprogram by its name";
            return Err(FlowError::new("no-such-subprogram", message, help));
        };
        self.enter_named(Place { text, line }, times, interpreter)
    }

    /// Where a subprogram, or a main program (`main`), begins in the texts that are there.
    pub(super) fn find_head(&mut self, name: &str, main: bool) -> Result<Option<Place>, FlowError> {
        for text in 0..self.texts.len() {
            if let Some(line) = self.landmarks(text)?.program(name, main) {
                return Ok(Some(Place { text, line }));
            }
        }
        Ok(None)
    }

    /// Calls the subprogram that MODIN has set, after a block that moved.
    pub(super) fn modal_call(
        &mut self,
        interpreter: &mut Interpreter<'_>,
    ) -> Result<(), FlowError> {
        match self.modal_named.clone() {
            // Moves of the subprogram itself do not call it.
            Some((name, depth)) if depth == self.calls.len() => {
                self.call_osp(&name, 1, interpreter)
            }
            _ => Ok(()),
        }
    }

    fn text_named(&mut self, name: &str, files: &[String]) -> Result<usize, FlowError> {
        if let Some((_, text)) = self.named.iter().find(|(known, _)| known == name) {
            return Ok(*text);
        }
        let Some(bytes) = self.library.load_named(files)? else {
            let message = format!("there is no subprogram {name}");
            let help = format!(
                "put {} into the program's folder or one given by --sub-path",
                files.first().map_or(name, String::as_str)
            );
            return Err(FlowError::new("no-such-subprogram", message, help));
        };
        Ok(self.add_named(name, bytes))
    }

    /// Keeps a text that was loaded by the name of its subprogram.
    pub(super) fn add_named(&mut self, name: &str, bytes: Vec<u8>) -> usize {
        let text = self.texts.len();
        self.texts.push(Text::new(bytes));
        self.named.push((name.to_owned(), text));
        text
    }

    pub(super) fn enter_named(
        &mut self,
        begin: Place,
        times: u64,
        interpreter: &mut Interpreter<'_>,
    ) -> Result<(), FlowError> {
        if times == 0 {
            return Ok(());
        }
        let own = Some(Box::new([None; LOCALS]));
        self.enter(begin, times, own, Style::Program, interpreter)
    }
}
