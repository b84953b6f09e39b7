//! GOTO, WHILE and M99.

use super::text::Search;
use super::{Flow, FlowError, Place, Style};
use crate::execute::Interpreter;

impl Flow {
    pub(super) fn go_to(&mut self, block: u64) -> Result<(), FlowError> {
        self.next = self.find_block(block, self.next)?;
        Ok(())
    }

    /// A block of the program that `at` belongs to, which may have one with this number only:
    /// which of several is found first is not known.
    pub(super) fn find_only_block(&mut self, block: u64, at: Place) -> Result<Place, FlowError> {
        let text = self.texts.get_mut(at.text);
        let found = text.and_then(|text| {
            let line = text.find(&Search::FirstBlock(block), at.line)?;
            let again = text.find(&Search::NextBlock(block), line);
            Some((line, again))
        });
        match found {
            Some((line, None)) => Ok(Place { line, ..at }),
            Some((line, Some(again))) => {
                let message = format!(
                    "block N{block} is called, which stands in lines {} and {} of its program",
                    line + 1,
                    again + 1
                );
                let help = "number one of them otherwise";
                Err(FlowError::new("no-such-block", message, help))
            }
            None => {
                let message = format!("there is no block N{block} in the program that is called");
                let help = "write the number of a block that exists";
                Err(FlowError::new("no-such-block", message, help))
            }
        }
    }

    pub(super) fn begin_loop(&mut self, number: u8, holds: bool) -> Result<(), FlowError> {
        if holds {
            return Ok(());
        }
        let end = self.find_here(&Search::EndLoop(number), self.next.line);
        let Some(end) = end else {
            let message = format!("there is no END{number} for this loop");
            return Err(FlowError::new(
                "loop",
                message,
                "end each loop with END and its number",
            ));
        };
        self.next.line = end + 1;
        Ok(())
    }

    pub(super) fn end_loop(&mut self, number: u8) -> Result<(), FlowError> {
        let begin = self.find_here(&Search::BeginLoop(number), self.now.line);
        let Some(begin) = begin else {
            let message = format!("there is no DO{number} for this END");
            return Err(FlowError::new(
                "loop",
                message,
                "begin each loop with WHILE [ … ] DO and its number",
            ));
        };
        self.next.line = begin;
        Ok(())
    }

    /// M99: back to the caller. A main program begins again: twice is enough to
    /// see what that means for the converter.
    pub(super) fn end_of_subprogram(
        &mut self,
        block: Option<u64>,
        interpreter: &mut Interpreter<'_>,
    ) -> Result<(), FlowError> {
        if self
            .calls
            .last()
            .is_some_and(|frame| frame.style == Style::Sub)
        {
            let message = "M99 ends a program that M98 has called";
            let help = "end what `o… call` has called with endsub or return";
            return Err(FlowError::new("subprogram", message, help));
        }
        if let Some(back) = self.leave(interpreter) {
            if let Some(block) = block
                && self.next == back
            {
                self.next = self.find_block(block, back)?;
            }
            return Ok(());
        }
        if let Some(block) = block {
            return self.go_to(block);
        }
        if self.again {
            interpreter.end();
        }
        self.again = true;
        self.next = Place { text: 0, line: 0 };
        interpreter.begin_again();
        Ok(())
    }

    fn find_here(&mut self, search: &Search, from: usize) -> Option<usize> {
        self.texts.get_mut(self.now.text)?.find(search, from)
    }
}
