//! How the statements of a block are carried out.

use super::trace::{For, Target};
use super::{ASSIGNMENTS_MAX, Statement, Unread, program_name};
use crate::control::Control;
use crate::expression::{Fault, Function, Reader, Variables};
use crate::rules::Macros;
use gwatt_syntax::source::Span;
use gwatt_syntax::{Block, IssueKind, Word};

/// `,C2.` and `,R5.`: B-63944EN, "Optional Chamfering and Corner R"; B-63604EN,
/// "Chamfering and Corner R". `,A30.` ("Direct Drawing Dimension Programming") is
/// not read.
fn corner_word(
    control: &Control<'_>,
    reader: &mut Reader<'_>,
    statement: &mut Statement<'_>,
) -> Result<(), Fault> {
    let start = reader.at;
    reader.at += 1;
    let letter = reader.peek();
    let Some(letter @ (b'C' | b'R')) = letter else {
        let what = match letter {
            Some(b'A') => "an angle of a drawing (,A)",
            _ => "a word after a comma",
        };
        reader.at += 1;
        let message = format!("{what} is not supported");
        let help = "write the corner as a move of its own";
        return Err(reader.fault("corner-word", message, help, start));
    };
    reader.at += 1;
    reader.peek();
    let number = reader.at;
    let value = reader.value(control)?;
    let word = Word {
        letter,
        value: value.unwrap_or(0.0),
        span: Span::new(start, reader.at),
        number: Span::new(number, reader.at),
    };
    if statement.corner.replace(word).is_some() || word.value < 0.0 {
        let message = "a block takes one chamfer or rounded corner, from 0 on";
        return Err(reader.fault("corner-word", message, "write one of them", start));
    }
    Ok(())
}

impl Control<'_> {
    /// Reads a block that plain words could not express. Its words get their
    /// values, and its issues go. `record`: how it was read is kept.
    pub(crate) fn statement<'t>(
        &self,
        line: &'t [u8],
        block: &mut Block,
        record: bool,
    ) -> Result<Statement<'t>, Unread> {
        let macros = self.rules.macros;
        if macros == Macros::Own {
            return Err(Unread::Foreign);
        }
        let hopeless = |kind| matches!(kind, IssueKind::UnclosedComment | IssueKind::NotFinite);
        if block.issues.iter().any(|issue| hopeless(issue.kind)) {
            return Err(Unread::Foreign);
        }
        let text = line.get(..block.text_end as usize).unwrap_or(line);
        let mut reader = Reader::new(text, 0);
        reader.tape.records = record;
        self.skip_front(&mut reader, block);
        let mut statement = Statement::default();
        block.words.clear();
        while let Some(byte) = reader.peek() {
            let start = reader.at;
            match byte {
                b'#' => {
                    let from = reader.tape.ops.len();
                    let name = reader.parameter_name(self)?;
                    let target = Target::read(&name, from, &mut reader);
                    if !reader.take(b'=') {
                        return Err(Unread::Foreign);
                    }
                    let held = reader.assigned(self)?;
                    let span = Span::new(start, reader.at);
                    statement.recorder.assign(target, span, &reader);
                    if statement.assignments.len() == ASSIGNMENTS_MAX {
                        let message = "more than 64 assignments in a block";
                        return Err(reader
                            .fault("expression", message, "write two blocks", start)
                            .into());
                    }
                    statement.assignments.push((name, held, span));
                }
                b'<' if macros == Macros::MacroB => {
                    let name = reader.angle_name()?.into_owned();
                    program_name(name, start, &reader, &mut statement, block);
                }
                b':' | b'O' if macros == Macros::MacroB => {
                    self.program_word(&mut reader, &mut statement, block)?;
                }
                b',' if macros == Macros::MacroB => {
                    corner_word(self, &mut reader, &mut statement)?;
                }
                b'O' if macros == Macros::OWords => {
                    self.o_word(&mut reader, &mut statement, block)?;
                }
                b'A'..=b'Z'
                    if macros == Macros::MacroB && self.keyword(&mut reader, &mut statement)? => {}
                b'A'..=b'Z' | b'@' | b'^' => {
                    self.word(byte, &mut reader, &mut statement, block)?;
                }
                _ => return Err(Unread::Foreign),
            }
            block.words_end = reader.at as u32;
        }
        block.issues.clear();
        let angle = reader.unsure_angle_at;
        statement.unsure_angle = angle.map(|start| Span::new(start, reader.at));
        if record {
            let untold = statement.callee.is_some()
                || statement.corner.is_some()
                || statement.alarm.is_some();
            statement.recorder.lost |= untold;
            let recorder = std::mem::take(&mut statement.recorder);
            statement.trace = recorder.finish(line, reader, statement.transfer.as_ref(), block);
        }
        Ok(statement)
    }

    /// `:1000`, `O1000` and `O<NAME>`: the number of a program.
    fn program_word<'t>(
        &self,
        reader: &mut Reader<'t>,
        statement: &mut Statement<'t>,
        block: &mut Block,
    ) -> Result<(), Unread> {
        let start = reader.at;
        if reader.peek() == Some(b'O') {
            reader.at += 1;
            if reader.peek() != Some(b'<') {
                reader.at = start;
                return self.word(b'O', reader, statement, block);
            }
            let name = reader.angle_name()?.into_owned();
            program_name(name, start, reader, statement, block);
            return Ok(());
        }
        self.word(b'O', reader, statement, block)
    }

    /// Passes over the byte order mark, the block delete and the block number.
    fn skip_front(&self, reader: &mut Reader<'_>, block: &Block) {
        if reader.text.starts_with(b"\xEF\xBB\xBF") {
            reader.at = 3;
        }
        for _ in 0..2 {
            if reader.take(b'/') && reader.peek().is_some_and(|byte| byte.is_ascii_digit()) {
                reader.at += 1;
            }
            if block.number.is_some() && reader.take(b'N') {
                // The blanks in it are no end of it.
                reader.peek();
                let _ = reader.number(!self.fanuc());
            }
        }
    }

    /// ROUND in the value of a word: to the last decimal of its address (B-64484EN, "Arithmetic
    /// and logic operation"; Haas 96-8000, "Notes on functions").
    fn rounding(&self, letter: u8) -> Function {
        match letter {
            b'A'..=b'C' => Function::RoundThousandth,
            b'I'..=b'K' | b'Q' | b'R' | b'U'..=b'Z' if self.modal.mm_per_unit == 1.0 => {
                Function::RoundThousandth
            }
            b'I'..=b'K' | b'Q' | b'R' | b'U'..=b'Z' => Function::RoundTenThousandth,
            b'E' | b'F' => Function::RoundFeed,
            _ => Function::Round,
        }
    }

    /// A letter with its value.
    fn word(
        &self,
        letter: u8,
        reader: &mut Reader<'_>,
        statement: &mut Statement<'_>,
        block: &mut Block,
    ) -> Result<(), Unread> {
        let start = reader.at;
        reader.at += 1;
        // Two letters in a row are a name that this language does not have,
        // unless the second begins a function.
        reader.peek();
        let number = reader.at;
        let before = reader.at;
        reader.round = self.rounding(letter);
        let value = reader.value(self);
        reader.round = Function::Round;
        let value = match value {
            Ok(value) => value,
            Err(fault) if fault.rule == "expression" && fault.span.start as usize == before => {
                return Err(Unread::Foreign);
            }
            Err(fault) => return Err(fault.into()),
        };
        let word = Word {
            letter,
            value: value.unwrap_or(0.0),
            span: Span::new(start, reader.at),
            number: Span::new(number, reader.at),
        };
        statement.recorder.value(For::Word(word), reader);
        // Fanuc: an address with a null variable is as if not written.
        if value.is_none() {
            return Ok(());
        }
        if block.words.len() >= 256 {
            let message = "more than 256 words in a block";
            return Err(reader
                .fault("too-many-words", message, "write two blocks", start)
                .into());
        }
        block.words.push(word);
        Ok(())
    }
}
