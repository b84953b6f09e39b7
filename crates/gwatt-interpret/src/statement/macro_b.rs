//! Statements of Fanuc custom macro B (B-63944EN, "Branch and Repetition").

use super::{For, Statement, Target, Unread};
use crate::control::Control;
use crate::expression::{Reader, Value};
use crate::jump::Transfer;
use gwatt_syntax::source::Span;

impl Control<'_> {
    /// Takes a control statement if one is next.
    pub(super) fn keyword<'t>(
        &self,
        reader: &mut Reader<'t>,
        statement: &mut Statement<'t>,
    ) -> Result<bool, Unread> {
        if reader.take_name(b"GOTO") {
            statement.transfer = Some(Transfer::Goto(self.block_number(reader, statement)?));
        } else if takes_if(reader) {
            let before = reader.at;
            let holds = match self.macro_condition(reader) {
                Err(Unread::Fault(fault))
                    if fault.rule == "unknown-value" && raises_alarm(reader.text, before) =>
                {
                    // An alarm would only make the program shorter.
                    statement.alarm = Some(Span::new(before, reader.text.len()));
                    reader.at = reader.text.len();
                    return Ok(true);
                }
                holds => holds?,
            };
            if reader.take_name(b"THEN") {
                statement.recorder.value(For::Guard(holds), reader);
                self.then(holds, reader, statement)?;
            } else if reader.take_name(b"GOTO") {
                statement.recorder.value(For::Condition, reader);
                let block = self.block_number(reader, statement)?;
                statement.recorder.goes = Some(Transfer::Goto(block));
                statement.transfer = holds.then_some(Transfer::Goto(block));
            } else {
                let message = "IF without THEN or GOTO";
                let help = "write IF [ … ] THEN #1=… or IF [ … ] GOTO 100";
                return Err(reader.fault("macro", message, help, reader.at).into());
            }
        } else if reader.take_name(b"WHILE") {
            let holds = self.macro_condition(reader)?;
            statement.recorder.value(For::Condition, reader);
            if !reader.take_name(b"DO") {
                let message = "WHILE without DO";
                return Err(reader
                    .fault("macro", message, "write WHILE [ … ] DO1", reader.at)
                    .into());
            }
            let number = self.loop_number(reader, statement)?;
            statement.transfer = Some(Transfer::Loop { number, holds });
        } else if reader.take_name(b"DO") {
            let number = self.loop_number(reader, statement)?;
            let holds = true;
            statement.transfer = Some(Transfer::Loop { number, holds });
        } else if reader.take_name(b"END") {
            statement.transfer = Some(Transfer::EndLoop(self.loop_number(reader, statement)?));
        } else if [&b"DPRNT"[..], b"BPRNT", b"POPEN", b"PCLOS"]
            .iter()
            .any(|name| reader.take_name(name))
        {
            // Output to a printer or a file.
            reader.at = reader.text.len();
        } else {
            return Ok(false);
        }
        Ok(true)
    }

    /// What stands after THEN: an assignment.
    fn then<'t>(
        &self,
        holds: bool,
        reader: &mut Reader<'t>,
        statement: &mut Statement<'t>,
    ) -> Result<(), Unread> {
        reader.peek();
        let start = reader.at;
        let from = reader.tape.ops.len();
        let name = reader.parameter_name(self)?;
        let target = Target::read(&name, from, reader);
        if !reader.take(b'=') {
            let message = "THEN takes an assignment";
            return Err(reader
                .fault("macro", message, "write THEN #1=…", start)
                .into());
        }
        if let Some(at) = word_after(reader.text, reader.at) {
            let message = "a word after THEN and an assignment: whether it depends on the condition is \
                           not known";
            let help =
                "write it on a line of its own, with IF … GOTO around it where it depends on that";
            reader.at = at + 1;
            return Err(reader.fault("macro", message, help, at).into());
        }
        if holds {
            let held = reader.assigned(self)?;
            let span = Span::new(start, reader.at);
            statement.recorder.assign(target, span, reader);
            statement.assignments.push((name, held, span));
        } else {
            // What is not assigned need not have a value.
            reader.at = reader.text.len();
        }
        Ok(())
    }

    fn macro_condition(&self, reader: &mut Reader<'_>) -> Result<bool, Unread> {
        Ok(reader.brackets(self)?.unwrap_or(0.0) != 0.0)
    }

    fn block_number(
        &self,
        reader: &mut Reader<'_>,
        statement: &mut Statement<'_>,
    ) -> Result<u64, Unread> {
        let start = reader.at;
        let from = reader.tape.ops.len();
        let number = reader.value(self)?;
        statement.recorder.fixed(from, reader);
        match whole(number, 1e9) {
            Some(number) => Ok(number),
            None => Err(reader
                .fault(
                    "macro",
                    "GOTO needs the number of a block",
                    "write GOTO 100",
                    start,
                )
                .into()),
        }
    }

    fn loop_number(
        &self,
        reader: &mut Reader<'_>,
        statement: &mut Statement<'_>,
    ) -> Result<u8, Unread> {
        let start = reader.at;
        let from = reader.tape.ops.len();
        let number = reader.value(self)?;
        statement.recorder.fixed(from, reader);
        match whole(number, 3.0).filter(|number| *number > 0) {
            Some(number) => Ok(number as u8),
            None => Err(reader
                .fault(
                    "macro",
                    "loops are numbered 1, 2 and 3",
                    "write DO1 … END1",
                    start,
                )
                .into()),
        }
    }
}

/// The first word from `at` on, save S, which moves nothing: a letter by itself outside of brackets and
/// comments.
fn word_after(text: &[u8], at: usize) -> Option<usize> {
    let (mut depth, mut letters, mut comment) = (0_usize, 0_usize, false);
    for (index, byte) in text.iter().enumerate().skip(at) {
        match byte {
            b'(' => comment = true,
            b')' => comment = false,
            b'[' => depth += 1,
            b']' => depth = depth.saturating_sub(1),
            _ => {}
        }
        if byte.is_ascii_alphabetic() && depth == 0 && !comment {
            letters += 1;
        } else {
            let word = text.get(index.saturating_sub(1)).filter(|_| letters == 1);
            if word.is_some_and(|letter| !letter.eq_ignore_ascii_case(&b'S')) {
                return Some(index - 1);
            }
            letters = 0;
        }
    }
    None
}

/// Whether `THEN #3000=` stands after a condition.
fn raises_alarm(text: &[u8], from: usize) -> bool {
    let bare: Vec<u8> = text
        .iter()
        .skip(from)
        .filter(|byte| !byte.is_ascii_whitespace())
        .map(u8::to_ascii_uppercase)
        .collect();
    memchr::memmem::find(&bare, b"]THEN#3000=").is_some()
}

/// Takes IF with a condition after it; `IFIX[#1]` is an I word.
fn takes_if(reader: &mut Reader<'_>) -> bool {
    let before = reader.at;
    if reader.take_name(b"IF") && reader.peek() == Some(b'[') {
        return true;
    }
    reader.at = before;
    false
}

/// A whole number from 0 to `most`.
fn whole(value: Value, most: f64) -> Option<u64> {
    let value = value?;
    let number = value.round();
    ((0.0..=most).contains(&number) && (value - number).abs() < 1e-4).then_some(number as u64)
}

#[cfg(test)]
mod tests {
    use super::word_after;

    #[test]
    fn a_word_after_an_assignment_is_seen() {
        fn found(text: &str) -> Option<&str> {
            let at = text.find('=')? + 1;
            word_after(text.as_bytes(), at).map(|at| &text[at..])
        }
        assert_eq!(found("THEN #7=[10.*2.] Y[100.]"), Some("Y[100.]"));
        assert_eq!(found("THEN #7=#8X100. (A)"), Some("X100. (A)"));
        assert_eq!(found("THEN #7=#8 g1 X1."), Some("g1 X1."));
        for text in [
            "THEN #7=SIN[#1*X]",
            "THEN #7=#8 MOD 3",
            "THEN #3000=1(A B C)",
            "THEN #7=[#17*0.9] S[#18*0.85]",
        ] {
            assert_eq!(found(text), None, "{text}");
        }
    }
}
