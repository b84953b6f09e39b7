//! A block, word by word ("Structure of NC blocks", "Program structure").

use super::{Isg, is_weight};
use crate::control::Control;
use crate::expression::{Cursor, Fault, Grammar, Lexis, Outcome, Uses};
use crate::fast_path::is_direct;
use crate::jump::Go;
use crate::macro_block::{Note, not_finite};
use crate::own_state::OwnState;
use crate::report::Report;
use gwatt_machine::{AXES, AxisId};
use gwatt_syntax::{Block, Word};

/// A block while it is read.
pub(super) struct Reading<'c, 'm, 't> {
    pub(super) control: &'c Control<'m>,
    pub(super) state: &'c mut Isg,
    pub(super) cursor: Cursor<'t>,
    pub(super) notes: Vec<Note>,
    /// Text and line.
    pub(super) place: (u16, u64),
    pub(super) uses: Uses,
    /// G4 stands in the block.
    pub(super) dwells: bool,
}

impl Control<'_> {
    /// Reads a block that is more than plain words. True when the program does
    /// not go on at the next line.
    #[cold]
    pub(crate) fn isg_words(&mut self, block: &mut Block, report: &mut Report<'_, '_>) -> bool {
        let Some(mut state) = self.own.take_isg() else {
            return false;
        };
        state.begun |= self.begun;
        let text = report.text.get(..block.text_end as usize);
        let mut reading = Reading {
            control: self,
            state: &mut state,
            cursor: Cursor::new(text.unwrap_or(report.text), Lexis::Comments),
            notes: Vec::new(),
            place: (self.text, report.line),
            uses: Uses::default(),
            dwells: false,
        };
        let read = reading.read(block);
        let notes = reading.notes;
        self.begun |= matches!(&read, Ok(go) if go.is_some() || !block.words.is_empty());
        let transfers = self.take_reading(read, notes, block, report);
        // What stands in a comment or a declaration is no move.
        self.direct = is_direct(self.machine) && !state.comments && !state.declares;
        if let Some(factor) = state.jerk_factor.take() {
            self.knobs.jerk_factor = [factor; AXES];
            self.settle();
        }
        let system = state.systems.in_force();
        self.own = OwnState::Isg(state);
        self.place_system(system);
        transfers
    }
}

impl Control<'_> {
    /// The value of an expression.
    pub(crate) fn isg_value(&mut self, text: &[u8]) -> Option<f64> {
        let mut state = self.own.take_isg()?;
        let mut reading = Reading {
            control: self,
            state: &mut state,
            cursor: Cursor::new(text, Lexis::Comments),
            notes: Vec::new(),
            place: (self.text, 0),
            uses: Uses::default(),
            dwells: false,
        };
        let value = reading.whole();
        self.own = OwnState::Isg(state);
        value
    }
}

impl Reading<'_, '_, '_> {
    /// Reads the block: its words get their values. Gives where the program
    /// goes on, if that is not the next line.
    fn read(&mut self, block: &mut Block) -> Outcome<Option<Go>> {
        if let Some(fault) = not_finite(block) {
            return Err(fault);
        }
        let tape = block.tape;
        block.words.clear();
        block.issues.clear();
        if self.state.comments {
            self.comment_goes_on();
            return Ok(None);
        }
        if tape {
            return Ok(self.program_head());
        }
        self.state.begun = true;
        self.front(block);
        if self.state.declares {
            self.declaration()?;
            return Ok(None);
        }
        let mut go = None;
        while let Some(byte) = self.cursor.peek() {
            let start = self.cursor.at;
            if let Some(found) = self.item(byte, block)? {
                if go.is_some() {
                    let message = "two words of a block say where the program goes on";
                    let help = "write two blocks";
                    return Err(self.cursor.fault("flow", message, help, start));
                }
                go = Some(found);
            }
            block.words_end = self.cursor.end() as u32;
        }
        pass_over_weights(block)?;
        self.end(go, block)
    }

    /// Passes over block delete, block number and labels.
    fn front(&mut self, block: &Block) {
        if self.cursor.text.starts_with(b"\xEF\xBB\xBF") {
            self.cursor.at = 3;
        }
        for _ in 0..2 {
            if block.delete_level > 0 && self.cursor.take(b'/') {
                self.cursor.digits();
            }
            if matches!(self.cursor.peek(), Some(b'N' | b'n')) && block.number.is_some() {
                self.cursor.at += 1;
                self.cursor.peek();
                self.cursor.digits();
                self.cursor.take(b':');
            }
        }
        // `[NAME]`: a label ("The $GOTO statement").
        if self.cursor.peek() == Some(b'[') {
            let _ = self.cursor.brackets();
        }
    }

    /// `%L NAME`, `%NAME` ("Subroutine techniques"): local subprograms stand
    /// before the main program, and end before the next `%`.
    fn program_head(&mut self) -> Option<Go> {
        if self.state.is_called() {
            return Some(Go::Return);
        }
        if is_local(self.cursor.text) && !self.state.begun {
            return Some(Go::Main);
        }
        if self.state.begun {
            return Some(Go::End);
        }
        self.state.begun = true;
        None
    }

    /// M17, M29, M2 and M30.
    fn end(&mut self, go: Option<Go>, block: &mut Block) -> Outcome<Option<Go>> {
        let ends = |word: &Word| word.letter == b'M' && matches!(word.value, 17.0 | 29.0);
        if let Some(word) = block.words.iter().copied().find(ends) {
            if !self.state.is_called() {
                let message = "M17 and M29 end subprograms: taken as the end of the program";
                self.notes.push(("subprogram-end", message, word.span));
                for found in block.words.iter_mut().filter(|word| ends(word)) {
                    found.value = 30.0;
                }
                return Ok(go);
            }
            block.words.retain(|word| !ends(word));
            return Ok(Some(Go::Return));
        }
        let aborts = |word: &&Word| word.letter == b'M' && matches!(word.value, 2.0 | 30.0);
        if self.state.is_called()
            && let Some(word) = block.words.iter().find(aborts)
        {
            let message = "M2 and M30 in a subprogram: the control warns, and aborts the program";
            let help = "end a subprogram by M17 or M29";
            return Err(Fault::new("subprogram", message, help, word.span));
        }
        Ok(go)
    }

    pub(super) fn note(&mut self, rule: &'static str, message: &'static str, start: usize) {
        let span = self.cursor.span(start);
        self.notes.push((rule, message, span));
    }
}

/// Axes next to a G word that weights what moves none have no places.
fn pass_over_weights(block: &mut Block) -> Outcome<()> {
    let is_weight = |word: &Word| word.letter == b'G' && is_weight(word.value);
    let Some(span) = block
        .words
        .iter()
        .find(|it| is_weight(it))
        .map(|it| it.span)
    else {
        return Ok(());
    };
    let is_axis = |word: &Word| AxisId::from_letter(word.letter).is_some();
    let others = |word: &Word| word.letter == b'G' && !is_weight(word);
    if block.words.iter().any(is_axis) && block.words.iter().any(others) {
        let message = "axes next to a G word that weights look-ahead or feedforward control, and \
                       to another one: whose they are is not known";
        let help = "write two blocks";
        return Err(Fault::new("unsupported-word", message, help, span));
    }
    block
        .words
        .retain(|word| !is_weight(word) && !is_axis(word));
    Ok(())
}

/// Whether a `%` line begins a local subprogram.
pub(crate) fn is_local(line: &[u8]) -> bool {
    let line = line.trim_ascii_start();
    let Some(rest) = line.strip_prefix(b"%") else {
        return false;
    };
    matches!(rest.trim_ascii_start(), [b'L' | b'l', b' ' | b'\t', ..])
}
