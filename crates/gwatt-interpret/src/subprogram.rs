//! M97, M98, M99, G65, G66 and G67: calls of subprograms and macros.
//!
//! Fanuc B-63944EN ("Subprogram Function", "Macro Call"), Haas mill operator's
//! manual (M97, M98, M99, G65), `LinuxCNC` ("M98 and M99").

use super::code::GCode;
use super::control::{Control, Run};
use super::expression::Value;
use super::jump::{Call, Target, Transfer};
use super::label::Label;
use super::parameters::LOCALS;
use crate::rules::Macros;
use gwatt_syntax::Word;
use gwatt_syntax::source::Span;

/// Repetitions that one call may ask for.
const TIMES_MAX: f64 = 1e6;

/// Variables that the letters of a macro call set: argument specification I.
const ARGUMENT_I: [(u8, usize); 21] = [
    (b'A', 1),
    (b'B', 2),
    (b'C', 3),
    (b'D', 7),
    (b'E', 8),
    (b'F', 9),
    (b'H', 11),
    (b'I', 4),
    (b'J', 5),
    (b'K', 6),
    (b'M', 13),
    (b'Q', 17),
    (b'R', 18),
    (b'S', 19),
    (b'T', 20),
    (b'U', 21),
    (b'V', 22),
    (b'W', 23),
    (b'X', 24),
    (b'Y', 25),
    (b'Z', 26),
];

impl Control<'_> {
    /// M97, M98 and M99; false for other words.
    pub(super) fn subprogram_word(
        &mut self,
        number: u16,
        span: Span,
        run: &mut Run<'_, '_>,
    ) -> bool {
        let macros = self.rules.macros;
        let calls = matches!(number, 980 | 990);
        if calls && macros == Macros::OWords && run.block.words.iter().any(other_word) {
            run.report
                .error(
                    "subprogram",
                    "LinuxCNC does not execute the other words of this block",
                    span,
                )
                .help("write M98 and M99 in blocks of their own");
            return true;
        }
        if number == 970 && macros == Macros::MacroB && !self.dialect().m97_calls {
            return Self::ends_interrupt(span, run);
        }
        match (macros, number) {
            // M198 calls a program that stands in another memory.
            (Macros::OWords | Macros::MacroB, 980) | (Macros::MacroB, 970 | 1980) => {
                if let Some(call) = self.call(number, span, run) {
                    self.transfer = Some(Transfer::Call(call));
                }
            }
            (Macros::OWords | Macros::MacroB, 990) => {
                // LinuxCNC returns to after the call only.
                let block = match macros {
                    Macros::OWords => None,
                    _ => run.words.take(b'P').map(|block| block.max(0.0) as u64),
                };
                self.transfer = Some(Transfer::Return { block });
            }
            _ => return false,
        }
        run.facts.fixed = Some("it calls a subprogram or returns from one");
        true
    }

    /// M97 where it is no call: alone it ends the interrupt of M96, which is left to others; with
    /// P it is refused.
    fn ends_interrupt(span: Span, run: &mut Run<'_, '_>) -> bool {
        let calls = run.block.words.iter().any(|word| word.letter == b'P');
        if calls {
            run.report
                .error("subprogram", "M97 P calls nothing on this control", span)
                .help("write a subprogram and M98");
        }
        calls
    }

    /// The call of M97, M98 and M198.
    fn call(&mut self, number: u16, span: Span, run: &mut Run<'_, '_>) -> Option<Call> {
        let local = number == 970;
        let program = run.words.take(b'P');
        let times = run.words.take(b'L');
        if let Some(name) = self.callee.take() {
            return Some(Call {
                target: Target::Program(Label::Name(name)),
                times: repetitions(times, span, run)?,
                block: self.begins_at(number, true, span, run).ok()?,
                arguments: None,
            });
        }
        let block = self.begins_at(number, program.is_some(), span, run).ok()?;
        if block.is_some() && program.is_none() {
            return Some(Call {
                target: Target::Here,
                times: repetitions(times, span, run)?,
                block,
                arguments: None,
            });
        }
        let Some(program) = program.and_then(whole) else {
            run.report
                .error("subprogram", "a call without the number of a program", span)
                .help("write the number after P, as in M98 P1000");
            return None;
        };
        let repeat = times;
        if times.is_none() && !local && program > 9999 && self.rules.macros == Macros::MacroB {
            return Some(Call {
                target: Target::Short(program),
                times: 1,
                block,
                arguments: None,
            });
        }
        let target = if local {
            Target::Block(program)
        } else {
            Target::Program(Label::Number(u32::try_from(program).ok()?))
        };
        Some(Call {
            target,
            times: repetitions(repeat, span, run)?,
            block,
            arguments: None,
        })
    }

    /// The block that M98 begins at, where a word names one; an error when it was reported.
    fn begins_at(
        &self,
        number: u16,
        program: bool,
        span: Span,
        run: &mut Run<'_, '_>,
    ) -> Result<Option<u64>, ()> {
        let letter = self.machine.controller.language.dialect.call_block;
        let Some(letter) = letter.filter(|_| number == 980) else {
            return Ok(None);
        };
        let Some(value) = run.words.take(letter) else {
            return Ok(None);
        };
        let name = char::from(letter);
        let Some(block) = whole(value) else {
            let message = format!("{name} of M98 is not the number of a block");
            let help = format!("write the number after N of that block, as in M98 {name}100");
            run.report.error("subprogram", message, span).help(help);
            return Err(());
        };
        if program && letter == b'Q' {
            let message = "M98 begins at the block that Q names; on a Fanuc parameter 6005#0 \
                           (SQC) has to be 1 for that";
            run.report.note_once("call-from-block", message, span);
        }
        Ok(Some(block))
    }

    /// G65, G66 and G67: takes the whole block.
    pub(super) fn macro_call(&mut self, run: &mut Run<'_, '_>) -> bool {
        let found = run.words.g.iter().find_map(|(code, number, span)| {
            (*code == GCode::MacroCall).then_some((*number, *span))
        });
        let Some((number, span)) = found else {
            return false;
        };
        run.facts.fixed = Some("it calls a macro");
        run.words.unused = 0;
        if number == 670 {
            self.transfer = Some(Transfer::ModalCall(None));
            return true;
        }
        let mut arguments = [None; LOCALS];
        let (mut program, mut times) = (None, None);
        let mut after = false;
        // The second and further I J K are #7 to #9, #10 to #12 and so on.
        let mut sets = 0;
        let mut last = b'K';
        for word in &run.block.words {
            if !after {
                after = word.span == span;
                continue;
            }
            match word.letter {
                b'P' => program = Some(word.value),
                b'L' => times = Some(word.value),
                b'G' | b'N' | b'O' => {}
                letter @ (b'I' | b'J' | b'K') => {
                    if letter <= last {
                        sets += 1;
                    }
                    last = letter;
                    let variable = 3 * sets + 1 + usize::from(letter - b'I');
                    let value = self.argument(word, &mut run.report);
                    set(&mut arguments, variable, value);
                }
                letter => {
                    if let Some((_, variable)) = ARGUMENT_I.iter().find(|(name, _)| *name == letter)
                    {
                        let value = self.argument(word, &mut run.report);
                        set(&mut arguments, *variable, value);
                    }
                }
            }
        }
        let label = match self.callee.take() {
            Some(name) => Some(Label::Name(name)),
            None => program
                .and_then(whole)
                .and_then(|program| u32::try_from(program).ok())
                .map(Label::Number),
        };
        let Some(label) = label else {
            run.report
                .error(
                    "subprogram",
                    "a macro call without the number of a program",
                    span,
                )
                .help("write the number after P, as in G65 P9010");
            return true;
        };
        let Some(times) = repetitions(times, span, run) else {
            return true;
        };
        let call = Call {
            target: Target::Program(label),
            times,
            block: None,
            arguments: Some(Box::new(arguments)),
        };
        self.transfer = Some(if number == 650 {
            Transfer::Call(call)
        } else {
            Transfer::ModalCall(Some(call))
        });
        true
    }
}

/// What M98 and M99 of LinuxCNC do not use.
fn other_word(word: &Word) -> bool {
    !matches!(word.letter, b'M' | b'P' | b'L')
}

fn set(arguments: &mut [Value; LOCALS], variable: usize, value: f64) {
    if let Some(argument) = arguments.get_mut(variable) {
        *argument = Some(value);
    }
}

fn repetitions(times: Option<f64>, span: Span, run: &mut Run<'_, '_>) -> Option<u64> {
    match times {
        None => Some(1),
        Some(times) if (0.0..=TIMES_MAX).contains(&times) => Some(times as u64),
        Some(_) => {
            run.report
                .error(
                    "subprogram",
                    "a call that is repeated less than 0 or more than 1000000 times",
                    span,
                )
                .help("write a smaller number of repetitions");
            None
        }
    }
}

/// A whole number that is not negative.
fn whole(value: f64) -> Option<u64> {
    ((0.0..1e9).contains(&value) && value.fract() == 0.0).then_some(value as u64)
}
