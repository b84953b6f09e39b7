//! A block, word by word ("Program Configuration", "Sequence Name").

use super::Osp;
use crate::control::Control;
use crate::expression::Fault;
use crate::expression::{Cursor, Grammar, Ident, Lexis, Outcome, Uses};
use crate::jump::Go;
use crate::macro_block::{Note, not_finite};
use crate::own_state::OwnState;
use crate::report::Report;
use gwatt_syntax::{Block, Word};

/// A block while it is read.
pub(super) struct Reading<'c, 't> {
    pub(super) state: &'c mut Osp,
    pub(super) cursor: Cursor<'t>,
    pub(super) notes: Vec<Note>,
    pub(super) uses: Uses,
    /// NOEX stands in the block.
    pub(super) passive: bool,
    /// The first of the addresses of two letters that is given a value, and where.
    pub(super) reserved: Option<(Ident, usize)>,
    pub(super) lathe: bool,
}

impl Control<'_> {
    /// Reads a block that is more than plain words. True when the program does
    /// not go on at the next line.
    #[cold]
    pub(crate) fn osp_words(&mut self, block: &mut Block, report: &mut Report<'_, '_>) -> bool {
        let OwnState::Osp(state) = &mut self.own else {
            return false;
        };
        let text = report.text.get(..block.text_end as usize);
        let mut reading = Reading {
            state,
            cursor: Cursor::new(text.unwrap_or(report.text), Lexis::Comments),
            notes: Vec::new(),
            uses: Uses::default(),
            passive: false,
            reserved: None,
            lathe: self.machine.controller.language.dialect.diameter,
        };
        let read = reading.read(block);
        let notes = reading.notes;
        self.spindle.tool_rpm = state.tool_rpm;
        self.begun |= read.is_ok();
        self.take_reading(read, notes, block, report)
    }
}

impl Control<'_> {
    /// The value of an expression.
    pub(crate) fn osp_value(&mut self, text: &[u8]) -> Option<f64> {
        let OwnState::Osp(state) = &mut self.own else {
            return None;
        };
        let mut reading = Reading {
            state,
            cursor: Cursor::new(text, Lexis::Comments),
            notes: Vec::new(),
            uses: Uses::default(),
            passive: false,
            reserved: None,
            lathe: false,
        };
        reading.whole()
    }
}

impl Reading<'_, '_> {
    /// Reads the block: its words get their values. Gives where the program
    /// goes on, if that is not the next line.
    fn read(&mut self, block: &mut Block) -> Outcome<Option<Go>> {
        if let Some(fault) = not_finite(block) {
            return Err(fault);
        }
        block.words.clear();
        block.issues.clear();
        if self.cursor.peek() == Some(b'$') {
            return self.header();
        }
        if self.cursor.take(b'/') {
            self.cursor.digits();
        }
        if self.state.draws {
            self.state.draws = self.cursor.name() != "END";
            return Ok(None);
        }
        let name = self.cursor.name();
        if name.starts_with('O') && name.len() > 1 && !self.assigns(&name) {
            return self.program_name(&name);
        }
        let statement = matches!(name.as_str(), "NCYL" | "NMSG" | "NOEX");
        if name.starts_with('N') && name.len() > 1 && !self.assigns(&name) && !statement {
            self.cursor.at += name.len();
        }
        let mut go = None;
        while self.cursor.peek().is_some() {
            let start = self.cursor.at;
            if let Some(found) = self.item(block)? {
                if go.is_some() {
                    let message = "two words of a block say where the program goes on";
                    let help = "write two blocks";
                    return Err(self.cursor.fault("flow", message, help, start));
                }
                go = Some(found);
            }
            block.words_end = self.cursor.end() as u32;
        }
        if let Some((name, start)) = self.reserved.take()
            && (self.lathe || !block.words.is_empty())
        {
            let message = format!("{name}, an address of two letters, which is not followed");
            let help = "write what it does in single words";
            return Err(self.cursor.fault("unsupported-word", message, help, start));
        }
        let moves = |word: &&Word| word.letter == b'G' && word.value < 4.0;
        if self.state.only_keeps
            && let Some(word) = block.words.iter().find(moves)
        {
            let message = "NCYL without a canned cycle";
            let help = "write it in the block of G73 to G89";
            return Err(Fault::new("unsupported-word", message, help, word.span));
        }
        if self.passive
            && let Some(word) = block.words.first()
        {
            let message = "NOEX with words: whether they move, the control's mode says";
            let help = "keep assignments in it, and write the words in a block of their own";
            return Err(Fault::new("unsupported-word", message, help, word.span));
        }
        Ok(go)
    }

    /// `$NAME.MIN%`: the header of a file. Other lines with a dollar sign belong to the block
    /// before them.
    fn header(&self) -> Outcome<Option<Go>> {
        let text = self.cursor.text.trim_ascii_start();
        let mut parts = text
            .get(1..)
            .unwrap_or_default()
            .split(|byte| *byte == b'.');
        let in_name = |byte: &u8| byte.is_ascii_alphanumeric() || b"-_".contains(byte);
        let name = parts.next().unwrap_or_default();
        // MIN, SSB, SUB: three letters, and no number as the value of a word has it.
        let kind = parts.next().unwrap_or_default();
        let letters = kind.iter().take_while(|byte| byte.is_ascii_alphabetic());
        if name.iter().all(in_name) && !name.is_empty() && letters.count() == 3 {
            return Ok(None);
        }
        let message = "a line that begins with $ belongs to the block before it, which is not \
                       followed";
        let help = "write the block in one line";
        let start = self.cursor.at;
        Err(self.cursor.fault("unsupported-word", message, help, start))
    }

    fn assigns(&self, name: &str) -> bool {
        let mut ahead = self.cursor.clone();
        ahead.at += name.len();
        ahead.assigns()
    }

    /// `O1000`, `OMAIN`: where a program begins.
    fn program_name(&mut self, name: &str) -> Outcome<Option<Go>> {
        let start = self.cursor.at;
        self.cursor.at += name.len();
        let begun = std::mem::replace(&mut self.state.begun, true);
        if !begun {
            return Ok(None);
        }
        if self.state.is_called() {
            let message = "the subprogram ends without RTS";
            let help = "write RTS at its end";
            return Err(self.cursor.fault("subprogram", message, help, start));
        }
        let message = "a second program name ends the program; \
                       programs after it run where they are called";
        self.note("several-programs", message, start);
        Ok(Some(Go::End))
    }

    pub(super) fn note(&mut self, rule: &'static str, message: &'static str, start: usize) {
        let span = self.cursor.span(start);
        self.notes.push((rule, message, span));
    }
}
