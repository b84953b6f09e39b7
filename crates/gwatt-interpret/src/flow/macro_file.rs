//! Macros of printers in files of their own, and where a subprogram's text ends.

use super::library::{self, Library};
use super::text::Text;
use super::{Flow, FlowError, Place, Style};
use crate::execute::Interpreter;
use gwatt_syntax::diagnostic::Diagnostic;

impl Flow {
    /// What the file of a macro holds, and back.
    pub(super) fn call_macro(
        &mut self,
        name: &str,
        interpreter: &mut Interpreter<'_>,
    ) -> Result<(), FlowError> {
        let known = self.named.iter().find(|(known, _)| known == name);
        let text = if let Some((_, text)) = known {
            *text
        } else {
            let Some(bytes) = self.library.load_named(&library::macro_files(name))? else {
                return Err(Library::no_macro(name));
            };
            if bytes.contains(&b'{') {
                let message = format!("the file of the macro {name} holds a template: `{{`");
                let help = "write the commands that it comes to, one a line";
                return Err(FlowError::new("macro-file", message, help));
            }
            self.texts.push(Text::new(bytes));
            self.named.push((name.to_owned(), self.texts.len() - 1));
            self.texts.len() - 1
        };
        let begin = Place { text, line: 0 };
        self.enter(begin, 1, None, Style::Macro, interpreter)
    }

    /// A text has ended inside a subprogram: macros go back then.
    pub(super) fn end_of_text(&mut self) -> Result<(), Box<Diagnostic>> {
        if self
            .calls
            .last()
            .is_none_or(|frame| frame.style != Style::Macro)
        {
            return Err(self.without_return());
        }
        // It has no variables of its own, which the interpreter would have to know of.
        if let Some(frame) = self.calls.pop() {
            self.loops.truncate(frame.loops);
            self.next = frame.back;
        }
        Ok(())
    }

    pub(super) fn without_return(&self) -> Box<Diagnostic> {
        let message = "the subprogram ends without a return";
        let help = if self.is_siemens {
            "end it with M17 or RET"
        } else if self.percent_names_programs {
            "end it with M17 or M29"
        } else {
            "end it with M99, or endsub"
        };
        self.trouble(FlowError::new("subprogram", message, help))
    }
}
