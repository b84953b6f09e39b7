//! How a recorded line runs again.

use super::{Item, Outcome, Target, Trace};
use crate::control::Control;
use crate::expression::{Name, parameter_number, work_out};
use crate::jump::{Transfer, Verb};
use crate::report::Report;
use arrayvec::ArrayVec;
use gwatt_syntax::{Block, Word};

impl Control<'_> {
    /// Executes a block from its record: true when the program does not go on at
    /// the next line; `None` where there is no record, or none that fits, and
    /// nothing has happened then.
    pub(crate) fn replay(
        &mut self,
        block: &mut Block,
        report: &mut Report<'_, '_>,
    ) -> Option<bool> {
        let (text, line) = (self.text, report.line);
        let trace = self.traces.take(text, line)?;
        let outcome = (*trace.text == *report.text)
            .then(|| self.follow(&trace, block))
            .flatten();
        let transfers = outcome.map(|outcome| self.take_effect(&trace, outcome, block, report));
        self.traces.put(text, line, trace);
        transfers
    }

    /// Works out what a recorded block says; its words come into `block`.
    fn follow(&self, trace: &Trace, block: &mut Block) -> Option<Outcome> {
        let mut assignments = ArrayVec::new();
        let mut transfer = trace.transfer.clone();
        let mut argument = 0;
        let mut at = 0;
        let mut next = |end: usize| {
            let ops = trace.ops.get(at..end)?;
            at = end;
            work_out(ops, self)
        };
        block.words.clear();
        for item in &trace.items {
            match item {
                Item::Word { word, end } => {
                    // Fanuc: an address with a null variable is as if not written.
                    if let Some(value) = next(*end)? {
                        block.words.push(Word { value, ..*word });
                    }
                }
                Item::Assign { name, end, .. } => {
                    let number = match name {
                        Target::Known(_) => None,
                        Target::Number(end) => Some(parameter_number(next(*end)?)?),
                    };
                    assignments.try_push((next(*end)?, number)).ok()?;
                }
                Item::Guard { holds, end } => {
                    if (next(*end)?.unwrap_or(0.0) != 0.0) != *holds {
                        return None;
                    }
                }
                Item::Condition { end } => {
                    let holds = next(*end)?.unwrap_or(0.0) != 0.0;
                    match &mut transfer {
                        Some(Transfer::Structure {
                            verb: Verb::If(it) | Verb::While(it),
                            ..
                        }) => {
                            *it = holds;
                        }
                        Some(Transfer::Loop { holds: it, .. }) => *it = holds,
                        Some(Transfer::Goto(_)) if !holds => transfer = None,
                        Some(Transfer::Goto(_)) => {}
                        _ => return None,
                    }
                }
                Item::Value { end } => {
                    let value = next(*end)?;
                    match &mut transfer {
                        Some(Transfer::Structure { verb, .. }) => match verb {
                            Verb::Repeat(times) => *times = value.unwrap_or(0.0),
                            Verb::EndSub(it) | Verb::Return(it) => *it = value,
                            _ => return None,
                        },
                        _ => return None,
                    }
                }
                Item::Argument { end } => {
                    let value = next(*end)?;
                    argument += 1;
                    match &mut transfer {
                        Some(Transfer::Structure {
                            verb: Verb::Call(values),
                            ..
                        }) => {
                            *values.get_mut(argument)? = value;
                        }
                        _ => return None,
                    }
                }
            }
        }
        block.issues.clear();
        block.words_end = trace.words_end;
        Some(Outcome {
            assignments,
            transfer,
        })
    }

    fn take_effect(
        &mut self,
        trace: &Trace,
        outcome: Outcome,
        block: &mut Block,
        report: &mut Report<'_, '_>,
    ) -> bool {
        self.begun = true;
        self.callee = None;
        let assigned = trace.items.iter().filter_map(|item| match item {
            Item::Assign { name, span, .. } => Some((name, *span)),
            _ => None,
        });
        for ((name, span), (value, number)) in assigned.zip(outcome.assignments) {
            let goes_on = match (name, number) {
                (Target::Known(name), _) => self.take_assignment(name, Ok(value), span, report),
                (Target::Number(_), number) => {
                    let name = Name::Number(number.unwrap_or_default());
                    self.take_assignment(&name, Ok(value), span, report)
                }
            };
            if !goes_on {
                block.words.clear();
                return false;
            }
        }
        self.transfer = outcome.transfer;
        self.transfer.is_some()
    }
}
