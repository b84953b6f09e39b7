//! Cycles in files or subprograms of the program ("Cycles as global or local
//! subroutines (Call L | LL CYCLE)"): each has its own parameters @P, and names
//! the axes by their places in the plane.

use super::block::Reading;
use crate::expression::{Cursor, Grammar, Ident, Outcome};
use crate::jump::Go;
use gwatt_machine::ALL_AXES;
use gwatt_syntax::Block;

/// The highest @P.
const PARAMETER_MAX: u32 = 200;

/// Whether `@P` and its number are next; the number is at `cursor.at + 2`.
pub(super) fn is_parameter(cursor: &Cursor<'_>) -> bool {
    cursor.byte(0) == b'@' && cursor.byte(1) == b'P'
}

/// Takes `@P12`.
pub(super) fn parameter_name(cursor: &mut Cursor<'_>) -> Outcome<Ident> {
    let start = cursor.at;
    cursor.at += 2;
    let from = cursor.at;
    cursor.digits();
    let digits = cursor.text.get(from..cursor.at).unwrap_or_default();
    let number = std::str::from_utf8(digits).ok();
    if let Some(number @ 1..=PARAMETER_MAX) = number.and_then(|it| it.parse::<u32>().ok()) {
        return Ok(Ident::of(format_args!("@P{number}")));
    }
    let message = "the parameters of a cycle are @P1 to @P200";
    let help = "write @P and its number";
    Err(cursor.fault("no-such-parameter", message, help, start))
}

impl Reading<'_, '_, '_> {
    /// What stands in brackets after `L CYCLE` and `LL CYCLE`.
    pub(super) fn cycle(&mut self, local: bool, start: usize, block: &Block) -> Outcome<Go> {
        if !block.words.is_empty() {
            let message = "a cycle after other words";
            let help = "call it in a block of its own";
            return Err(self.cursor.fault("subprogram", message, help, start));
        }
        self.cursor.expect(b'[')?;
        self.state.arguments.clear();
        let mut file = None;
        while !self.cursor.take(b']') {
            let from = self.cursor.at;
            if is_parameter(&self.cursor) {
                let name = parameter_name(&mut self.cursor)?;
                self.cursor.expect(b'=')?;
                if self.cursor.peek() == Some(b'"') {
                    return Err(self.cursor.refused("a text for a cycle", "no number", from));
                }
                let value = self.number()?;
                self.state.arguments.insert(name, value);
            } else if self.cursor.take_name("NAME") {
                self.cursor.expect(b'=')?;
                file = Some(self.file_name());
            } else if self.cursor.name().starts_with("MODAL") {
                let reason = "a cycle after each block that moves";
                return Err(self.cursor.refused("MODAL", reason, from));
            } else {
                self.cursor.at = self.cursor.at.max(from + 1);
                let message = "after CYCLE stand NAME= and the parameters @P1= and so on";
                let help = "write L CYCLE [NAME=drill.cyc @P1=5]";
                return Err(self.cursor.fault("subprogram", message, help, from));
            }
            self.cursor.take(b',');
        }
        let Some(name) = file.filter(|name| !name.is_empty()) else {
            let message = "a cycle without its name";
            let help = "write L CYCLE [NAME=drill.cyc @P1=5]";
            return Err(self.cursor.fault("subprogram", message, help, start));
        };
        if self.cursor.peek().is_some() {
            let message = "words after a cycle";
            let help = "call it in a block of its own";
            return Err(self.cursor.fault("subprogram", message, help, start));
        }
        if local {
            return Ok(Go::Local(name));
        }
        // Those of the control's maker are encrypted, and moves that they make
        // are its own.
        if name.to_ascii_lowercase().starts_with("sys") {
            return Err(self
                .cursor
                .refused(&name, "a cycle of the control's maker", start));
        }
        let file = name.rsplit(['/', '\\']).next().unwrap_or_default();
        Ok(Go::File(file.to_owned()))
    }

    /// A name to a blank or the bracket, with quotes or without.
    fn file_name(&mut self) -> String {
        self.cursor.take(b'"');
        let rest = self.cursor.text.get(self.cursor.at..).unwrap_or_default();
        let outside = |byte: &u8| matches!(byte, b' ' | b'\t' | b'"' | b']' | b',');
        let length = rest.iter().position(outside).unwrap_or(rest.len());
        self.cursor.at += length;
        self.cursor.take(b'"');
        String::from_utf8_lossy(rest.get(..length).unwrap_or_default()).into_owned()
    }

    /// `@X`, `@I`, `@S` in a cycle: the letter they stand for in the plane.
    pub(super) fn letter_in_cycle(&self, letter: u8) -> Option<u8> {
        let [first, second, third] = self.control.modal.plane;
        let of = |axis: usize, center: bool| {
            let letter = ALL_AXES.get(axis)?.letter();
            // I, J and K belong to X, Y and Z.
            Some(if center { letter - b'X' + b'I' } else { letter })
        };
        match letter {
            b'X' | b'I' => of(first, letter == b'I'),
            b'Y' | b'J' => of(second, letter == b'J'),
            b'Z' | b'K' => of(third, letter == b'K'),
            b'S' => Some(b'S'),
            _ => None,
        }
    }
}
