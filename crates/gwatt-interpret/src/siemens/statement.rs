//! A block, word by word.
//!
//! "Fundamental Principles", "NC blocks", "Identifiers", "Value assignments":
//! one letter with a number needs no `=`, everything else does.

use super::names::Name;
use super::reading::Reading;
use super::value::{Kind, Val};
use super::{Measure, frame_words};
use crate::expression::{Grammar, Outcome};
use crate::jump::Siemens as Go;
use gwatt_machine::AxisId;
use gwatt_syntax::{Block, Word};

impl Reading<'_, '_, '_> {
    /// Reads the block: its words get their values. Gives where the program
    /// goes on, if that is not the next line.
    pub(super) fn read(&mut self, block: &mut Block) -> Outcome<Option<Go>> {
        self.front(block);
        block.words.clear();
        let mut go = None;
        while let Some(byte) = self.cursor.peek() {
            let start = self.cursor.at;
            if !(byte.is_ascii_alphabetic() || matches!(byte, b'_' | b'$')) {
                self.cursor.at += 1;
                let shown = gwatt_syntax::diagnostic::excerpt(&[byte], 1);
                let message = format!("`{shown}` has no meaning here");
                let help = "write comments after `;`, and `=` before values that are worked out";
                return Err(self.cursor.fault("syntax", message, help, start));
            }
            if let Some(found) = self.word(block)? {
                if go.is_some() {
                    let message = "two words of a block say where the program goes on";
                    let help = "write two blocks";
                    return Err(self.cursor.fault("flow", message, help, start));
                }
                go = Some(found);
            }
            block.words_end = self.cursor.end() as u32;
        }
        block.issues.clear();
        let selects = |word: &Word| word.letter == b'G' && is_work_offset(word.value);
        if self.state.extra.deselects && !block.words.iter().any(selects) {
            self.push_as(b'G', 500.0, 0, block);
        }
        Ok(go)
    }

    /// Passes over block delete, block number and labels.
    fn front(&mut self, block: &Block) {
        if self.cursor.text.starts_with(b"\xEF\xBB\xBF") {
            self.cursor.at = 3;
        }
        let digits = |reading: &mut Self| {
            while reading
                .cursor
                .text
                .get(reading.cursor.at)
                .is_some_and(u8::is_ascii_digit)
            {
                reading.cursor.at += 1;
            }
        };
        if block.delete_level > 0 && self.cursor.take(b'/') {
            digits(self);
        }
        match self.cursor.peek() {
            // A main block: `:10`.
            Some(b':') => {
                self.cursor.at += 1;
                self.cursor.peek();
                digits(self);
            }
            Some(b'N' | b'n') if block.number.is_some() => {
                self.cursor.at += 1;
                self.cursor.peek();
                digits(self);
            }
            _ => {}
        }
        if block.delete_level > 0 && self.cursor.take(b'/') {
            digits(self);
        }
        let before = self.cursor.at;
        let name = self.cursor.name();
        self.cursor.at += name.len();
        if name.is_empty() || name.starts_with('$') || !self.cursor.take(b':') {
            self.cursor.at = before;
        }
    }

    /// One word, whatever it is.
    fn word(&mut self, block: &mut Block) -> Outcome<Option<Go>> {
        let start = self.cursor.at;
        let name = self.cursor.name();
        self.cursor.at += name.len();
        if let Some(go) = self.flow_word(&name, start)? {
            // MCALL is done with: the program need not be held whole for it.
            return Ok(Some(go).filter(|_| name != "MCALL"));
        }
        if name.starts_with('$') {
            return self.set_system_variable(&name, start).map(|()| None);
        }
        let assigns = self.cursor.assigns();
        if self.is_variable(&name) && (assigns || self.cursor.peek() == Some(b'[')) {
            return self.assignment(&name, start).map(|()| None);
        }
        if name.as_str() == "AX" && self.cursor.peek() == Some(b'[') {
            return self.indirect_axis(start, block).map(|()| None);
        }
        if self.setting(&name, start, block)? {
            return Ok(None);
        }
        if self.level(&name, start)? {
            return Ok(None);
        }
        // `A3` is an angle, `A3=` a vector.
        let word = name.as_bytes().get(1).is_some_and(u8::is_ascii_digit) && !assigns;
        let known = match self.cursor.peek() {
            _ if word => None,
            Some(b'(') => Name::of_procedure(&name),
            _ => Name::of(&name),
        };
        match known {
            Some(Name::Data) => return self.pass_over().map(|()| None),
            Some(Name::Refused(reason)) => return Err(self.cursor.refused(&name, reason, start)),
            Some(Name::Alarm) => return Err(self.cursor.alarm(&name, start)),
            None => {}
        }
        if self.address(&name, assigns, start, block)? {
            return Ok(None);
        }
        if name == "L" || assigns || self.cursor.peek() == Some(b'[') {
            return self.assignment(&name, start).map(|()| None);
        }
        self.call(&name, start)
    }

    pub(super) fn is_variable(&self, name: &str) -> bool {
        let r = name
            .strip_prefix('R')
            .is_some_and(|digits| digits.bytes().all(|byte| byte.is_ascii_digit()));
        let defined = self
            .state
            .scopes
            .last()
            .is_some_and(|scope| scope.variables.contains_key(name));
        (r && name != "R") || name == "R" && self.cursor.clone().peek() == Some(b'[') || defined
    }

    /// `NAME = …`, `NAME[i] = …`, `R1 = …`.
    fn assignment(&mut self, name: &str, start: usize) -> Outcome<()> {
        if let Some(number) = self.r_parameter(name)? {
            self.cursor.expect(b'=')?;
            let value = self.expression()?;
            let done = self.state.set_r(number, value);
            return done.map_err(|reason| {
                let message = format!("R{number} cannot take this value: {reason}");
                let help = "R parameters hold numbers";
                self.cursor.fault("assignment", message, help, start)
            });
        }
        let index = self.index()?;
        self.cursor.expect(b'=')?;
        self.fill(name, index, start)
    }

    /// `$TC_…` describes tools, whose lengths are taken as 0 anyway; others may
    /// change offsets and limits.
    fn set_system_variable(&mut self, name: &str, start: usize) -> Outcome<()> {
        if !name.starts_with("$TC_") {
            let message =
                format!("{name} belongs to the control, and may change offsets or limits");
            let help = "take it out, or write what it does in words";
            return Err(self.cursor.fault("unsupported-word", message, help, start));
        }
        self.note("no-tool-table", frame_words::NO_TOOLS, start);
        if matches!(name, "$TC_DP6" | "$TC_DP15") {
            return self.set_radius(name == "$TC_DP15", start);
        }
        self.index()?;
        self.cursor.expect(b'=')?;
        self.expression().map(|_| ())
    }

    /// Passes over what belongs to a name that moves nothing.
    pub(super) fn pass_over(&mut self) -> Outcome<()> {
        if self.cursor.take(b'[') {
            while !self.cursor.take(b']') {
                if self.cursor.peek().is_none() {
                    return self.cursor.expect(b']');
                }
                self.cursor.at += 1;
            }
        }
        if self.cursor.peek() == Some(b'(') {
            self.cursor.pass_over_parentheses()?;
        }
        if self.cursor.assigns() {
            self.cursor.at += 1;
            self.measured()?;
        }
        Ok(())
    }

    /// An expression, or one in AC( ), IC( ), DC( ), ACP( ), ACN( ).
    pub(super) fn measured(&mut self) -> Outcome<(Measure, f64)> {
        let measure = match self.cursor.name().as_str() {
            "AC" => Measure::Absolute,
            "IC" => Measure::Increment,
            "DC" => Measure::Direct,
            "ACP" => Measure::Positive,
            "ACN" => Measure::Negative,
            _ => return Ok((Measure::Modal, self.number()?)),
        };
        self.cursor.at += self.cursor.name().len();
        self.cursor.expect(b'(')?;
        let value = self.number()?;
        self.cursor.expect(b')')?;
        Ok((measure, value))
    }

    /// A letter with its value; false when `name` is none.
    fn address(
        &mut self,
        name: &str,
        assigns: bool,
        start: usize,
        block: &mut Block,
    ) -> Outcome<bool> {
        let letter = name.bytes().next().unwrap_or_default();
        let rest = name.get(1..).unwrap_or_default();
        if rest.is_empty() {
            return self.letter(letter, assigns, start, block);
        }
        if !rest.starts_with(|c: char| c.is_ascii_digit()) {
            return Ok(false);
        }
        let number = rest.parse::<u32>().ok();
        if assigns && let Some(number) = number {
            self.cursor.at += 1;
            return self.extended(name, letter, number, start, block);
        }
        // The letter and its number; what stands after comes next.
        self.cursor.at = start + 1;
        if letter == b'L' {
            self.cursor.at = start + name.len();
            return Ok(false);
        }
        let value = self.cursor.number()?;
        self.push(letter, value, start, start + 1, block)?;
        Ok(true)
    }

    /// A letter alone, after it `=` or a number.
    fn letter(
        &mut self,
        letter: u8,
        assigns: bool,
        start: usize,
        block: &mut Block,
    ) -> Outcome<bool> {
        if !letter.is_ascii_uppercase() {
            return Ok(false);
        }
        let next = self.cursor.peek();
        if assigns {
            self.cursor.at += 1;
            self.cursor.peek();
            if letter == b'T' && self.cursor.peek() == Some(b'"') {
                // A tool by its name: its number is the control's.
                self.cursor.quoted()?;
                self.push(letter, 0.0, start, start, block)?;
                return Ok(true);
            }
            let number = self.cursor.at;
            let (measure, value) = self.measured()?;
            self.measure(letter, measure, start)?;
            self.push(letter, value, start, number, block)?;
            return Ok(true);
        }
        let negative = next == Some(b'-');
        match next {
            Some(b'+' | b'-' | b'.' | b'0'..=b'9') => {
                let number = self.cursor.at;
                self.cursor.at += usize::from(matches!(next, Some(b'+' | b'-')));
                let value = self.cursor.number()?;
                let value = if negative { -value } else { value };
                self.push(letter, value, start, number, block)?;
                Ok(true)
            }
            Some(b'[') => Ok(false),
            _ => {
                let message = format!("{} has no number", letter as char);
                let help = "write a number, or `=` and an expression";
                Err(self.cursor.fault("missing-number", message, help, start))
            }
        }
    }

    /// Keeps how the value of a letter is meant.
    pub(super) fn measure(&mut self, letter: u8, measure: Measure, start: usize) -> Outcome<()> {
        if measure == Measure::Modal {
            return Ok(());
        }
        if let Some(axis) = AxisId::from_letter(letter) {
            if let Some(slot) = self.extra().measures.get_mut(axis as usize) {
                *slot = measure;
            }
            return Ok(());
        }
        let absolute = match measure {
            Measure::Absolute => Some(true),
            Measure::Increment => Some(false),
            _ => None,
        };
        let center = matches!(letter, b'I' | b'J' | b'K');
        match absolute {
            Some(absolute) if center => {
                let index = usize::from(letter - b'I');
                if let Some(slot) = self.extra().center_absolute.get_mut(index) {
                    *slot = Some(absolute);
                }
                Ok(())
            }
            _ => {
                let message = format!("{} takes a plain value", letter as char);
                let help = "AC and IC go with axes and arc centres, DC with rotary axes";
                Err(self.cursor.fault("syntax", message, help, start))
            }
        }
    }

    /// A letter with a number of its own: `S1=500`, `M2=3`, `I1=…`, `X1=…`.
    fn extended(
        &mut self,
        name: &str,
        letter: u8,
        number: u32,
        start: usize,
        block: &mut Block,
    ) -> Outcome<bool> {
        self.cursor.peek();
        let from = self.cursor.at;
        if letter == b'T' && self.cursor.peek() == Some(b'"') {
            self.cursor.quoted()?;
            self.push(letter, 0.0, start, start, block)?;
            return Ok(true);
        }
        let (measure, value) = self.measured()?;
        let reference = block
            .words
            .iter()
            .any(|word| word.letter == b'G' && matches!(word.value, 74.0 | 75.0));
        match (letter, number) {
            (b'I' | b'J' | b'K', 1) => {
                let index = usize::from(letter - b'I');
                if let Some(slot) = self.extra().via.get_mut(index) {
                    *slot = Some((measure, value));
                }
            }
            (b'S' | b'M' | b'T' | b'D', 1) => {
                if letter == b'S' {
                    self.extra().spindles.speeds.push((number, value.abs()));
                }
                self.push(letter, value, start, from, block)?;
            }
            (b'S' | b'M', _) => {
                if letter == b'S' {
                    self.extra().spindles.speeds.push((number, value.abs()));
                }
                let message = "what other spindles than the first do is not counted";
                self.note("other-spindle", message, start);
            }
            (b'H', _) => {}
            (b'A' | b'B' | b'C', 2..=5) => {
                if let Some(Name::Refused(reason)) = Name::of(name) {
                    return Err(self.cursor.refused(name, reason, start));
                }
            }
            // "Reference point approach (G74)": machine axes.
            _ if reference && AxisId::from_letter(letter).is_some() => {
                self.push(letter, 0.0, start, from, block)?;
            }
            _ => {
                let message = format!("the machine has no axis {name}");
                let help = "axes have one letter here: describe it in the machine file as [axes.U] and the like, and name it so";
                return Err(self.cursor.fault("no-such-axis", message, help, start));
            }
        }
        Ok(true)
    }

    /// Adds a word to the block.
    pub(super) fn push(
        &mut self,
        letter: u8,
        value: f64,
        start: usize,
        number: usize,
        block: &mut Block,
    ) -> Outcome<()> {
        let refused = match letter {
            b'N' | b'O' => Some("a block number stands at the beginning of its block"),
            b'R' => Some("an R parameter needs `=` and its value"),
            b'P' => Some("P repeats a call, and stands after its name"),
            _ => None,
        };
        if let Some(message) = refused {
            let help = "write it in its place";
            return Err(self.cursor.fault("syntax", message, help, start));
        }
        self.cursor.add_word(letter, value, start, number, block)
    }

    /// Adds a word that the program writes by a name.
    pub(super) fn push_as(&mut self, letter: u8, value: f64, start: usize, block: &mut Block) {
        let span = self.cursor.span(start);
        block.words.push(Word {
            letter,
            value,
            span,
            number: span,
        });
    }

    /// A text, or a variable that holds one.
    pub(super) fn text(&mut self) -> Outcome<String> {
        self.cursor.peek();
        let start = self.cursor.at;
        let value = self.expression()?;
        if let Ok(Val::Text(text)) = Kind::Text.convert(value) {
            return Ok(text);
        }
        let message = "a text is needed here";
        let help = "write it in quotes";
        Err(self.cursor.fault("syntax", message, help, start))
    }
}

/// G54 to G57, G500 to G599.
fn is_work_offset(number: f64) -> bool {
    (54.0..=57.0).contains(&number) || (500.0..=599.0).contains(&number)
}
