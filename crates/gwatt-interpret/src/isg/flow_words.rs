//! Words that say where the program goes on ("Control block statements").
//!
//! A condition holds from 0.5 on ("The IF - ELSE branch").

use super::Pending;
use super::block::Reading;
use crate::expression::{Grammar, Outcome};
use crate::jump::Go;
use gwatt_syntax::Block;

/// Values that $SWITCH and $CASE take for equal ("Switch branching").
const SAME: f64 = 1e-3;

impl Reading<'_, '_, '_> {
    /// A word that begins with `$`.
    pub(super) fn flow_word(&mut self, block: &Block) -> Outcome<Option<Go>> {
        let start = self.cursor.at;
        self.cursor.at += 1;
        let word = self.cursor.name();
        self.cursor.at += word.len();
        let pending = std::mem::take(&mut self.state.pending);
        if word != "GOTO" && !block.words.is_empty() {
            let message = format!("${word} after other words");
            let help = "write it in a block of its own";
            return Err(self.cursor.fault("flow", message, help, start));
        }
        let go = match word.as_str() {
            "IF" => {
                let holds = self.condition()?;
                if self.cursor.peek() == Some(b'$') {
                    self.goto_behind_if(holds, start)?
                } else {
                    Go::If(holds)
                }
            }
            "ELSEIF" if pending == Pending::Decide => Go::If(self.condition()?),
            "ELSEIF" | "ELSE" => {
                self.cursor.pass_over_rest();
                Go::BehindIf
            }
            "ENDIF" | "DO" | "REPEAT" | "DEFAULT" | "ENDSWITCH" => Go::Next,
            "WHILE" => Go::Loop(self.condition()?),
            "FOR" => self.counting(pending, start)?,
            "ENDWHILE" | "ENDFOR" => Go::Back,
            "ENDDO" => Go::Again(self.condition()?),
            "UNTIL" => Go::Again(!self.condition()?),
            "SWITCH" => Go::Switch(self.number()?),
            "CASE" => self.case(pending, start)?,
            "BREAK" => Go::Break,
            "CONTINUE" => Go::Continue,
            "GOTO" => self.jump()?,
            _ => {
                let message = format!("${word} is no statement of this language");
                let help = "the statements are $IF $ELSEIF $ELSE $ENDIF $SWITCH $CASE $DEFAULT $ENDSWITCH $FOR $WHILE $DO $REPEAT $BREAK $CONTINUE $GOTO";
                return Err(self.cursor.fault("flow", message, help, start));
            }
        };
        if word != "GOTO" && self.cursor.peek().is_some() {
            let start = self.cursor.at;
            self.cursor.pass_over_rest();
            let message = format!("what stands after ${word} is not understood");
            let help = "write it in a block of its own";
            return Err(self.cursor.fault("flow", message, help, start));
        }
        Ok(Some(go))
    }

    fn case(&mut self, pending: Pending, start: usize) -> Outcome<Go> {
        let Pending::Compare(value) = pending else {
            let message = "a $CASE is reached from the one before it";
            let help = "end each $CASE by $BREAK";
            return Err(self.cursor.fault("flow", message, help, start));
        };
        let fits = (self.number()? - value).abs() < SAME;
        Ok(if fits { Go::Next } else { Go::Switch(value) })
    }

    fn condition(&mut self) -> Outcome<bool> {
        Ok(self.number()?.abs() >= 0.5)
    }

    /// `$IF P1 > 5 $GOTO N100`.
    fn goto_behind_if(&mut self, holds: bool, start: usize) -> Outcome<Go> {
        self.cursor.at += 1;
        if !self.cursor.take_name("GOTO") {
            let message = "after $IF stands $GOTO or nothing";
            let help = "write what depends on it in blocks of its own, to $ENDIF";
            return Err(self.cursor.fault("flow", message, help, start));
        }
        let jump = self.jump()?;
        Ok(if holds { jump } else { Go::Next })
    }

    /// The destination of a jump: `N100`, `[NAME]`.
    fn jump(&mut self) -> Outcome<Go> {
        let start = self.cursor.at;
        match self.cursor.peek() {
            Some(b'[') => {
                let name = self.cursor.brackets()?;
                let name = String::from_utf8_lossy(name.trim_ascii());
                return Ok(Go::Jump(format!("[{name}]")));
            }
            Some(b'N' | b'n') => {
                self.cursor.at += 1;
                let number = self.number()?;
                if number >= 0.0 && number.fract() == 0.0 {
                    return Ok(Go::Jump(format!("N{number}")));
                }
            }
            _ => {}
        }
        let message = "$GOTO needs N and the number of a block, or a label in [ ]";
        let help = "write $GOTO N100, and N100: at its destination";
        Err(self.cursor.fault("flow", message, help, start))
    }

    /// `$FOR P1 = first, last, step` ("Counting loop"): the variable is counted
    /// at the end of each pass.
    fn counting(&mut self, pending: Pending, start: usize) -> Outcome<Go> {
        let Some(name) = self.variable_name()? else {
            let message = "$FOR without the variable that counts";
            let help = "write $FOR P1 = 1, 10, 1";
            return Err(self.cursor.fault("flow", message, help, start));
        };
        self.cursor.expect(b'=')?;
        let first = self.number()?;
        self.cursor.expect(b',')?;
        let last = self.number()?;
        self.cursor.expect(b',')?;
        let step = self.number()?;
        if step == 0.0 {
            let message = "$FOR with the step 0 never ends";
            let help = "write another step";
            return Err(self.cursor.fault("endless", message, help, start));
        }
        let key = (self.place.0, self.place.1, self.state.levels.len());
        let mut value = first;
        if pending == Pending::Count {
            if self.state.counts.get(&key) != Some(&(last, step)) {
                let message = "the end or the step of $FOR has changed while the loop runs";
                let help =
                    "which of them counts is not documented: keep them in variables that stay";
                return Err(self.cursor.fault("flow", message, help, start));
            }
            let here = self.read_back(&name).unwrap_or(first);
            value = here + step;
        } else {
            self.state.counts.insert(key, (last, step));
        }
        self.set(&name, value, start)?;
        let runs = if step > 0.0 {
            value <= last
        } else {
            value >= last
        };
        Ok(Go::Loop(runs))
    }

    fn read_back(&mut self, name: &str) -> Option<f64> {
        let mut levels = self.state.levels.iter().rev();
        let local = levels.find_map(|level| level.get(name)).copied();
        local.or_else(|| self.state.globals.get(name).copied())
    }
}
