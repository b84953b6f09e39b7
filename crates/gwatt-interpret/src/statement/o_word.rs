//! O-words: subroutines, branches and loops (`LinuxCNC`, "O Codes").

use super::keyword::{KEYWORDS, Keyword};
use super::{For, Statement, Unread};
use crate::control::Control;
use crate::expression::{Fault, Reader};
use crate::jump::{Transfer, Verb};
use crate::label::Label;
use crate::parameters::LOCALS;
use gwatt_syntax::source::Span;
use gwatt_syntax::{Block, Word};

/// Arguments that a call may have.
const ARGUMENTS_MAX: usize = 30;

impl Control<'_> {
    /// An O-word with what it does, or a plain O word.
    pub(super) fn o_word(
        &self,
        reader: &mut Reader<'_>,
        statement: &mut Statement<'_>,
        block: &mut Block,
    ) -> Result<(), Unread> {
        let start = reader.at;
        if !block.words.is_empty() || !statement.assignments.is_empty() {
            let message = "an O-word stands after other words";
            let help = "write it first in a block of its own";
            reader.at += 1;
            return Err(reader.fault("o-word", message, help, start).into());
        }
        reader.at += 1;
        let number = {
            reader.peek();
            reader.at
        };
        let label = if reader.peek() == Some(b'<') {
            Label::Name(reader.angle_name()?.into_owned())
        } else {
            let from = reader.tape.ops.len();
            let label = self.o_number(reader, start)?;
            statement.recorder.fixed(from, reader);
            label
        };
        if reader.peek().is_none()
            && let Label::Number(value) = label
        {
            statement.recorder.lost = true;
            block.words.push(Word {
                letter: b'O',
                value: f64::from(value),
                span: Span::new(start, reader.at),
                number: Span::new(number, reader.at),
            });
            return Ok(());
        }
        let Some(verb) = self.verb(reader, statement)? else {
            let message = "this O-word says nothing that is known";
            let help = "write sub, endsub, call, return, if, elseif, else, endif, while, endwhile, do, repeat, endrepeat, break or continue after it";
            reader.at = reader.text.len();
            return Err(reader.fault("o-word", message, help, start).into());
        };
        if reader.peek().is_some() {
            let at = reader.at;
            reader.at = reader.text.len();
            let message = "nothing may follow an O-word in its block";
            return Err(reader
                .fault("o-word", message, "write two blocks", at)
                .into());
        }
        statement.transfer = Some(Transfer::Structure { label, verb });
        Ok(())
    }

    /// The number of an O-word that begins at `start`.
    pub(crate) fn o_number(&self, reader: &mut Reader<'_>, start: usize) -> Result<Label, Fault> {
        let value = reader.value(self)?.unwrap_or(0.0);
        if !(0.0..4e9).contains(&value) || (value - value.round()).abs() > 1e-4 {
            let message = format!("{value} is not the number of a subroutine");
            let help = "write a whole positive number";
            return Err(reader.fault("o-word", message, help, start));
        }
        Ok(Label::Number(value.round() as u32))
    }

    fn verb(
        &self,
        reader: &mut Reader<'_>,
        statement: &mut Statement<'_>,
    ) -> Result<Option<Verb>, Unread> {
        let Some(keyword) = keyword(reader) else {
            return Ok(None);
        };
        Ok(Some(match keyword {
            Keyword::Sub => Verb::Sub,
            Keyword::EndSub => Verb::EndSub(self.optional(reader, statement)?),
            Keyword::Return => Verb::Return(self.optional(reader, statement)?),
            Keyword::Call => {
                let mut arguments = [Some(0.0); LOCALS];
                let mut count = 0;
                while reader.peek() == Some(b'[') {
                    let start = reader.at;
                    let value = reader.brackets(self)?;
                    statement.recorder.value(For::Argument, reader);
                    count += 1;
                    match arguments.get_mut(count) {
                        Some(argument) if count <= ARGUMENTS_MAX => *argument = value,
                        _ => {
                            let message = "a call has at most 30 arguments";
                            return Err(reader
                                .fault("o-word", message, "pass them in #<_names>", start)
                                .into());
                        }
                    }
                }
                Verb::Call(Box::new(arguments))
            }
            Keyword::If => Verb::If(self.condition(reader, statement)?),
            Keyword::ElseIf => {
                let start = {
                    reader.peek();
                    reader.at
                };
                reader.at = reader.text.len();
                Verb::ElseIf(Span::new(start, reader.text.len()))
            }
            Keyword::Else => Verb::Else,
            Keyword::EndIf => Verb::EndIf,
            Keyword::While => Verb::While(self.condition(reader, statement)?),
            Keyword::EndWhile => Verb::EndWhile,
            Keyword::Do => Verb::Do,
            Keyword::Repeat => {
                let times = reader.brackets(self)?.unwrap_or(0.0);
                statement.recorder.value(For::Value, reader);
                Verb::Repeat(times)
            }
            Keyword::EndRepeat => Verb::EndRepeat,
            Keyword::Break => Verb::Break,
            Keyword::Continue => Verb::Continue,
        }))
    }

    fn condition(
        &self,
        reader: &mut Reader<'_>,
        statement: &mut Statement<'_>,
    ) -> Result<bool, Unread> {
        let value = reader.brackets(self)?;
        statement.recorder.value(For::Condition, reader);
        Ok(value.unwrap_or(0.0) != 0.0)
    }

    fn optional(
        &self,
        reader: &mut Reader<'_>,
        statement: &mut Statement<'_>,
    ) -> Result<Option<f64>, Unread> {
        if reader.peek() == Some(b'[') {
            let value = reader.brackets(self)?;
            statement.recorder.value(For::Value, reader);
            return Ok(value);
        }
        Ok(None)
    }
}

/// Takes the keyword that is next.
fn keyword(reader: &mut Reader<'_>) -> Option<Keyword> {
    KEYWORDS
        .iter()
        .find(|(name, _)| reader.take_name(name.as_bytes()))
        .map(|(_, keyword)| *keyword)
}

/// The O-word at the beginning of a line that is passed over.
pub(crate) enum Sight {
    /// Its label, and what it does.
    Plain(Label, Option<Keyword>),
    /// Its label is worked out from what stands at this place.
    WorkedOut { at: usize, keyword: Keyword },
}

impl Sight {
    /// That of a label that does not have to be worked out.
    pub(crate) fn plain(self) -> Option<(Label, Option<Keyword>)> {
        match self {
            Self::Plain(label, keyword) => Some((label, keyword)),
            Self::WorkedOut { .. } => None,
        }
    }
}

/// The O-word at the beginning of a line that is passed over: its label, where
/// it does not have to be worked out, and what it does.
pub(crate) fn glance(line: &[u8]) -> Option<(Label, Option<Keyword>)> {
    glance_at(line)?.plain()
}

/// The same with labels in brackets and in parameters.
pub(crate) fn glance_at(line: &[u8]) -> Option<Sight> {
    let mut reader = Reader::new(line.trim_ascii_end(), 0);
    while matches!(reader.peek(), Some(b'/' | b'N' | b'0'..=b'9' | b'.')) {
        reader.at += 1;
    }
    if reader.peek() == Some(b'<') {
        // A program name of Fanuc, alone in its line.
        let name = reader.angle_name().ok()?.into_owned();
        let alone = reader.peek().is_none();
        return alone.then_some(Sight::Plain(Label::Name(name), None));
    }
    if !(reader.take(b'O') || reader.take(b':')) {
        return None;
    }
    let label = match reader.peek()? {
        b'<' => Label::Name(reader.angle_name().ok()?.into_owned()),
        b'0'..=b'9' => Label::Number(reader.number(true).ok()? as u32),
        b'[' | b'#' => {
            let at = reader.at;
            pass_value(&mut reader)?;
            let keyword = keyword(&mut reader)?;
            return Some(Sight::WorkedOut { at, keyword });
        }
        _ => return None,
    };
    let keyword = keyword(&mut reader);
    Some(Sight::Plain(label, keyword))
}

/// Passes over `[ … ]`, `#1`, `#[ … ]` and `#<name>`.
fn pass_value(reader: &mut Reader<'_>) -> Option<()> {
    while reader.take(b'#') {}
    match reader.peek()? {
        b'<' => reader.angle_name().ok().map(|_| ()),
        b'0'..=b'9' => reader.number(true).ok().map(|_| ()),
        b'[' => {
            let mut depth = 0_usize;
            while let Some(byte) = reader.peek() {
                reader.at += 1;
                match byte {
                    b'[' => depth += 1,
                    b']' if depth == 1 => return Some(()),
                    b']' => depth -= 1,
                    _ => {}
                }
            }
            None
        }
        _ => None,
    }
}
