//! Statements and addresses ("Branch Function", "Subprogram Functions",
//! "Mnemonic Codes").

use super::block::Reading;
use crate::expression::{Grammar, Outcome};
use crate::jump::Go;
use gwatt_syntax::Block;

/// Repetitions that one call may ask for.
const TIMES_MAX: f64 = 1e6;

/// Names that make moves: patterns, areas, automatic turning.
const REFUSED: [(&str, &str); 23] = [
    ("ARC", "a pattern of holes"),
    ("BHC", "a pattern of holes"),
    ("DGRDX", "a pattern of holes"),
    ("DGRDY", "a pattern of holes"),
    ("GRDX", "a pattern of holes"),
    ("GRDY", "a pattern of holes"),
    ("LAA", "a pattern of holes"),
    ("OMIT", "a pattern of holes"),
    ("RSTRT", "a pattern of holes"),
    ("SQRX", "a pattern of holes"),
    ("SQRY", "a pattern of holes"),
    ("FMILF", "area machining"),
    ("FMILR", "area machining"),
    ("PMIL", "area machining"),
    ("PMILR", "area machining"),
    ("RMILI", "area machining"),
    ("RMILO", "area machining"),
    ("COPY", "a copy of coordinates"),
    ("COPYE", "a copy of coordinates"),
    ("CHCOPY", "a copy of coordinates"),
    ("RTMCR", "the end of a system macro"),
    ("RTMDI", "the end of a manual input"),
    ("SCHK", "a check of the spindle"),
];

impl Reading<'_, '_> {
    /// One statement, assignment or address.
    pub(super) fn item(&mut self, block: &mut Block) -> Outcome<Option<Go>> {
        let start = self.cursor.at;
        let name = self.cursor.name();
        if name.is_empty() {
            self.cursor.at += 1;
            let byte = self.cursor.text.get(start).copied().unwrap_or_default();
            let message = format!("`{}` has no meaning here", byte as char);
            let help = "write comments in ( )";
            return Err(self.cursor.fault("syntax", message, help, start));
        }
        if let Some(go) = self.statement(&name, start)? {
            return Ok(Some(go));
        }
        if self.cursor.at > start {
            return Ok(None);
        }
        if self.assignment()? {
            return Ok(None);
        }
        if let Some((_, reason)) = REFUSED.iter().find(|(known, _)| name == *known) {
            self.cursor.at += name.len();
            return Err(self.cursor.refused(&name, reason, start));
        }
        let letters = name.bytes().take_while(u8::is_ascii_alphabetic).count();
        if letters > 1 {
            self.cursor.at += name.len();
            let message = format!("{name} is no word of this language");
            let help = "write `=` after the name of a variable; words are one letter and a number";
            return Err(self.cursor.fault("unknown-word", message, help, start));
        }
        self.address(block)?;
        Ok(None)
    }

    /// Takes a statement if one is next.
    fn statement(&mut self, name: &str, start: usize) -> Outcome<Option<Go>> {
        let length = name.len();
        let go = match name {
            "GOTO" => {
                self.cursor.at += length;
                self.jump()?
            }
            "IF" => {
                self.cursor.at += length;
                if self.cursor.peek() != Some(b'[') {
                    let message = "IF without its condition in [ ]";
                    let help = "write IF [V1 EQ 2] N10";
                    return Err(self.cursor.fault("flow", message, help, start));
                }
                let holds = self.number()?.abs() >= 0.5;
                self.cursor.take_name("GOTO");
                let jump = self.jump()?;
                if holds { jump } else { Go::Next }
            }
            "CALL" => {
                self.cursor.at += length;
                self.call(start)?
            }
            "MODIN" => {
                self.cursor.at += length;
                let (name, times) = self.callee(start)?;
                if times != 1 || !self.state.pending.is_empty() {
                    let message = "MODIN with repetitions or arguments";
                    let help = "write the calls out";
                    return Err(self.cursor.fault("flow", message, help, start));
                }
                Go::Modal(Some(name))
            }
            "MODOUT" => {
                self.cursor.at += length;
                Go::Modal(None)
            }
            "RTS" => {
                self.cursor.at += length;
                Go::Return
            }
            "NOEX" => {
                self.cursor.at += length;
                self.passive = true;
                return Ok(None);
            }
            "NCYL" => {
                self.cursor.at += length;
                self.state.only_keeps = true;
                return Ok(None);
            }
            // Drawings and messages.
            "DEF" => {
                self.cursor.pass_over_rest();
                self.state.draws = true;
                return Ok(None);
            }
            "CLEAR" | "DRAW" | "MSG" | "NMSG" => {
                self.cursor.pass_over_rest();
                return Ok(None);
            }
            _ => return Ok(None),
        };
        Ok(Some(go))
    }

    /// A sequence name: `N10`, `NLAP1`.
    fn jump(&mut self) -> Outcome<Go> {
        let start = self.cursor.at;
        let name = self.cursor.name();
        self.cursor.at += name.len();
        if name.starts_with('N') && name.len() > 1 {
            let digits = name.get(1..).unwrap_or_default();
            let label = match digits.parse::<u64>() {
                Ok(number) => format!("N{number}"),
                Err(_) => name.into(),
            };
            return Ok(Go::Jump(label));
        }
        let message = "a jump without its sequence name";
        let help = "write N and the name or number of the block, as in GOTO N10";
        Err(self.cursor.fault("flow", message, help, start))
    }

    fn call(&mut self, start: usize) -> Outcome<Go> {
        let (name, times) = self.callee(start)?;
        if times > 1 && !self.state.pending.is_empty() {
            let message = "a call with repetitions and variables";
            let help =
                "write a call for each: whether they get their values again is not documented";
            return Err(self.cursor.fault("subprogram", message, help, start));
        }
        Ok(Go::Call { name, times })
    }

    /// `O100 Q3 NAME=5`: the program, repetitions, and local variables of it.
    fn callee(&mut self, start: usize) -> Outcome<(String, u64)> {
        let name = self.cursor.name();
        self.cursor.at += name.len();
        if !name.starts_with('O') || name.len() < 2 {
            let message = "a call without the name of a program";
            let help = "write CALL O100";
            return Err(self.cursor.fault("subprogram", message, help, start));
        }
        let mut times = 1;
        self.state.pending.clear();
        while self.cursor.peek().is_some() {
            let from = self.cursor.at;
            let word = self.cursor.name();
            let letters = word.bytes().take_while(u8::is_ascii_alphabetic).count();
            if letters > 1 && !word.starts_with('V') {
                self.cursor.at += word.len();
                self.cursor.expect(b'=')?;
                let value = self.number()?;
                self.state.pending.insert(word, value);
                continue;
            }
            if self.cursor.byte(0) == b'Q' {
                self.cursor.at += 1;
                self.cursor.take(b'=');
                let value = self.number()?;
                if value.fract() == 0.0 && (0.0..=TIMES_MAX).contains(&value) {
                    times = value as u64;
                    continue;
                }
            } else {
                self.cursor.at += word.len().max(1);
            }
            let message = "after CALL stand Q with repetitions and variables by name";
            let help = "write CALL O100 Q3 NAME=5";
            return Err(self.cursor.fault("subprogram", message, help, from));
        }
        Ok((name.into(), times))
    }

    /// `X10`, `X=V1+5`.
    fn address(&mut self, block: &mut Block) -> Outcome<()> {
        let start = self.cursor.at;
        let letter = self.cursor.byte(0);
        self.cursor.at += 1;
        let assigns = self.cursor.assigns();
        if assigns {
            self.cursor.at += 1;
        }
        self.cursor.peek();
        let number = self.cursor.at;
        let value = if assigns {
            self.number()?
        } else {
            // Without `=` there is a number and nothing else.
            if self.cursor.byte(0) == b'[' || self.cursor.byte(0).is_ascii_alphabetic() {
                let message = "a value that is worked out needs `=` before it";
                let help = "write X=[…]";
                return Err(self.cursor.fault("syntax", message, help, start));
            }
            let negative = self.cursor.take(b'-');
            let _ = negative || self.cursor.take(b'+');
            let value = self.cursor.number()?;
            if negative { -value } else { value }
        };
        let lap = matches!(letter, b'N') && block.words.iter().any(is_automatic);
        if lap {
            return Err(self
                .cursor
                .refused("G85 N…", "automatic turning (LAP)", start));
        }
        if matches!(letter, b'N' | b'O' | b'V') {
            let message = format!("{} has no meaning here", letter as char);
            let help = "a sequence name stands at the beginning of its block";
            return Err(self.cursor.fault("syntax", message, help, start));
        }
        self.cursor.add_word(letter, value, start, number, block)
    }
}

/// G80 to G88, which on a lathe turn a contour.
fn is_automatic(word: &gwatt_syntax::Word) -> bool {
    word.letter == b'G' && (80.0..=88.0).contains(&word.value)
}
