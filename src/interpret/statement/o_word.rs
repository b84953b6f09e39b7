//! O-words: subroutines, branches and loops (`LinuxCNC`, "O Codes").

use super::{For, Statement, Unread};
use crate::interpret::execute::Control;
use crate::interpret::expression::Reader;
use crate::interpret::parameters::LOCALS;
use crate::interpret::transfer::{Label, Transfer, Verb};
use crate::source::Span;
use crate::syntax::{Block, Word};

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
            let message = "an O-word stands behind other words";
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
            let value = reader.value(self)?.unwrap_or(0.0);
            statement.recorder.fixed(from, reader);
            if !(0.0..4e9).contains(&value) || (value - value.round()).abs() > 1e-4 {
                let message = format!("{value} is not the number of a subroutine");
                return Err(reader
                    .fault("o-word", message, "write a whole positive number", start)
                    .into());
            }
            Label::Number(value.round() as u32)
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
            let help = "write sub, endsub, call, return, if, elseif, else, endif, while, endwhile, do, repeat, endrepeat, break or continue behind it";
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

/// The words that make an O-word flow.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(in crate::interpret) enum Keyword {
    Sub,
    EndSub,
    Return,
    Call,
    If,
    ElseIf,
    Else,
    EndIf,
    While,
    EndWhile,
    Do,
    Repeat,
    EndRepeat,
    Break,
    Continue,
}

impl Keyword {
    /// Whether it begins a branch or a loop; `while` may also end one.
    pub(in crate::interpret) fn opens(self) -> bool {
        matches!(self, Self::If | Self::While | Self::Do | Self::Repeat)
    }

    /// As it is written.
    pub(in crate::interpret) fn name(self) -> &'static str {
        let found = KEYWORDS.iter().find(|(_, keyword)| *keyword == self);
        found.map_or("", |(name, _)| name)
    }
}

// What begins like another stands behind it.
const KEYWORDS: [(&str, Keyword); 15] = [
    ("sub", Keyword::Sub),
    ("endsub", Keyword::EndSub),
    ("return", Keyword::Return),
    ("call", Keyword::Call),
    ("if", Keyword::If),
    ("elseif", Keyword::ElseIf),
    ("else", Keyword::Else),
    ("endif", Keyword::EndIf),
    ("while", Keyword::While),
    ("endwhile", Keyword::EndWhile),
    ("do", Keyword::Do),
    ("repeat", Keyword::Repeat),
    ("endrepeat", Keyword::EndRepeat),
    ("break", Keyword::Break),
    ("continue", Keyword::Continue),
];

/// Takes the keyword that is next.
fn keyword(reader: &mut Reader<'_>) -> Option<Keyword> {
    KEYWORDS
        .iter()
        .find(|(name, _)| reader.take_name(name.as_bytes()))
        .map(|(_, keyword)| *keyword)
}

/// The O-word at the beginning of a line that is passed over: its label, where
/// it does not have to be worked out, and what it does.
pub(in crate::interpret) fn glance(line: &[u8]) -> Option<(Label, Option<Keyword>)> {
    let mut reader = Reader::new(line.trim_ascii_end(), 0);
    while matches!(reader.peek(), Some(b'/' | b'N' | b'0'..=b'9' | b'.')) {
        reader.at += 1;
    }
    if reader.peek() == Some(b'<') {
        // A program name of Fanuc, alone in its line.
        let name = reader.angle_name().ok()?.into_owned();
        return reader.peek().is_none().then_some((Label::Name(name), None));
    }
    if !(reader.take(b'O') || reader.take(b':')) {
        return None;
    }
    let label = match reader.peek()? {
        b'<' => Label::Name(reader.angle_name().ok()?.into_owned()),
        b'0'..=b'9' => Label::Number(reader.number(true).ok()? as u32),
        _ => return None,
    };
    Some((label, keyword(&mut reader)))
}
