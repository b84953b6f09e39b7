//! What the flow of a program asks of the interpreter: subprograms begin and
//! end, lines run again.

use super::execute::Interpreter;
use super::expression::{Fault, Name, Reader, Value};
use super::isg::Pending;
use super::jump::Transfer;
use super::label::Label;
use super::parameters::{LOCALS, Scope};
use crate::own_state::OwnState;
use crate::rules::Macros;
use gwatt_syntax::source::Span;

impl Interpreter<'_> {
    /// Where the program goes on, if the last block said so.
    pub(crate) fn transfer(&mut self) -> Option<Transfer> {
        self.control.transfer.take()
    }

    /// A line of a program that is held whole begins: which run of it, and in
    /// which text it stands.
    pub fn begin_line(&mut self, run: u32, text: u16) {
        self.control.run = run;
        self.control.text = text;
    }

    /// A subprogram begins, with these variables of its own.
    pub(super) fn enter(&mut self, scope: Scope, arguments: Option<&[Value; LOCALS]>) {
        let none = [None; LOCALS];
        let arguments = arguments.unwrap_or(&none);
        self.control.parameters.enter(scope, arguments);
        self.control.enter_level();
        self.control.language.enter(&mut self.control);
    }

    /// A subprogram with its own variables has ended.
    pub(super) fn leave(&mut self, scope: Scope) {
        self.control.parameters.leave(scope);
        self.control.leave_level();
        self.control.language.leave(&mut self.control);
    }

    /// Whether `%` names programs, of which a file may have several.
    pub(super) fn percent_names_programs(&self) -> bool {
        self.control.rules.percent_names_programs
    }

    /// What the line that is executed next has to do with where it is reached
    /// from.
    pub(super) fn expect_next(&mut self, pending: Pending) {
        if let OwnState::Isg(isg) = &mut self.control.own {
            isg.pending = pending;
        }
    }

    /// Whether programs are written in RS274/NGC.
    pub(super) fn rs274(&self) -> bool {
        self.control.rules.macros == Macros::OWords
    }

    /// Whether O words are those of `FluidNC`.
    pub(super) fn loose_o_words(&self) -> bool {
        self.control.machine.controller.language.loose_o_words
    }

    /// Whether the program has begun with an O number.
    pub(super) fn in_program(&self) -> bool {
        self.control.has_program_number
    }

    /// A subroutine has returned a value, or none (`LinuxCNC`, "Subroutines":
    /// `#<_value>` and `#<_value_returned>`).
    pub(crate) fn returned(&mut self, value: Option<f64>) {
        let returned = f64::from(u8::from(value.is_some()));
        for (name, value) in [
            ("_value", value.unwrap_or(0.0)),
            ("_value_returned", returned),
        ] {
            // Two names cannot be too many.
            let _ = self
                .control
                .parameters
                .set(&Name::Text(name.into()), Ok(Some(value)));
        }
    }

    /// The O number that comes next is that of a program which is called.
    pub(crate) fn expect_program_number(&mut self) {
        self.control.has_program_number = false;
    }

    /// The program begins again.
    pub(crate) fn begin_again(&mut self) {
        self.control.begun = false;
        self.control.has_program_number = false;
    }

    /// FOR counts on when it is executed next.
    pub(crate) fn count_on(&mut self) {
        if let OwnState::Siemens(siemens) = &mut self.control.own {
            siemens.count_on();
        }
    }

    /// Whether the program is a subprogram with parameters, which nobody has called.
    #[must_use]
    pub fn is_uncalled(&self) -> bool {
        matches!(&self.control.own, OwnState::Siemens(siemens) if siemens.is_uncalled())
    }

    /// The program ends here.
    pub(crate) fn end(&mut self) {
        self.control.ended = true;
    }

    /// The label of an O-word that is worked out from what stands at a place of its line.
    pub(super) fn label(&self, text: &[u8], at: usize) -> Result<Label, Fault> {
        let mut reader = Reader::new(text.trim_ascii_end(), at);
        self.control.o_number(&mut reader, at)
    }

    /// The truth of a condition that stands in a line.
    pub(super) fn condition(&self, text: &[u8], span: Span) -> Result<bool, Fault> {
        let text = text.get(..span.end as usize).unwrap_or(text);
        let mut reader = Reader::new(text, span.start as usize);
        Ok(reader.brackets(&self.control)?.unwrap_or(0.0) != 0.0)
    }
}
