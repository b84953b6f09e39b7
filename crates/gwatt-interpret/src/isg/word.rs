//! Addresses with their values ("Word syntax", "Programming of coordinates by
//! parameters", "Dwell time (G04), (#TIME)").

use super::block::Reading;
use crate::expression::{Grammar, Outcome};
use crate::jump::Go;
use gwatt_syntax::Block;

impl Reading<'_, '_, '_> {
    /// What begins with `byte`, whatever it is.
    pub(super) fn item(&mut self, byte: u8, block: &mut Block) -> Outcome<Option<Go>> {
        let start = self.cursor.at;
        match byte {
            b'$' => return self.flow_word(block),
            b'#' => return self.command(block),
            b'0'..=b'9' | b'.' if self.dwells => {
                let value = self.number()?;
                self.cursor.add_word(b'P', value, start, start, block)?;
            }
            b'"' => {
                self.cursor.pass_over_rest();
                return Err(self.cursor.refused("a text in quotes", "a macro", start));
            }
            _ if byte.is_ascii_alphabetic() || byte == b'@' => return self.address(block),
            b'\\' if self.is_line_break() => {
                self.cursor.at += 1;
                let message = "`\\` joins this line with the next one to one block, which gwatt does \
                               not follow: it reads a block from one line";
                let help = "write the whole block on one line";
                return Err(self.cursor.fault("line-break", message, help, start));
            }
            _ => {
                self.cursor.at += 1;
                let message = format!("`{}` has no meaning here", byte as char);
                let help = "write comments in ( ) or after `;`";
                return Err(self.cursor.fault("syntax", message, help, start));
            }
        }
        Ok(None)
    }

    /// Whether nothing comes after the byte at this place ("Line break in NC block").
    fn is_line_break(&self) -> bool {
        let rest = self.cursor.text.get(self.cursor.at + 1..);
        rest.is_some_and(|rest| rest.trim_ascii().is_empty())
    }

    /// A letter with its value, an assignment, or a call.
    fn address(&mut self, block: &mut Block) -> Outcome<Option<Go>> {
        let start = self.cursor.at;
        let letter = self.cursor.byte(0);
        let variable = match letter {
            b'P' => matches!(self.cursor.byte(1), b'0'..=b'9' | b'P' | b'['),
            b'V' => self.cursor.byte(1) == b'.',
            b'@' => self.cursor.byte(1) == b'P',
            _ => false,
        };
        if variable && self.dwells {
            // `G04 P1`: the parameter's value; as on other controls, where it
            // has none.
            let value = self.dwell_value()?;
            self.cursor.add_word(b'P', value, start, start, block)?;
            return Ok(None);
        }
        if variable {
            self.assignment()?;
            return Ok(None);
        }
        if letter == b'D' && self.cursor.name() == "DYNOVR" {
            self.cursor.pass_over_rest();
            let reason = "a word of TwinCAT NC I, another interpreter";
            return Err(self.cursor.refused("DynOvr", reason, start));
        }
        if letter == b'L' {
            return self.call(block).map(Some);
        }
        self.cursor.at += 1;
        if letter != b'@' {
            self.value_of(letter, start, block)?;
            return Ok(None);
        }
        let named = self.cursor.byte(0);
        self.cursor.at += 1;
        let Some(letter) = self
            .letter_in_cycle(named)
            .filter(|_| self.state.is_called())
        else {
            let message = "@ stands before P, X, Y, Z, I, J, K and S in cycles";
            let help = "call the cycle by L CYCLE [NAME=… @P1=…]";
            return Err(self.cursor.fault("syntax", message, help, start));
        };
        self.value_of(letter, start, block)?;
        Ok(None)
    }

    fn dwell_value(&mut self) -> Outcome<f64> {
        let mut literal = self.cursor.clone();
        if let Ok(value) = self.number() {
            return Ok(value);
        }
        literal.at += 1;
        let value = literal.number()?;
        self.cursor = literal;
        Ok(value)
    }

    /// The value of an address whose letter has been taken.
    fn value_of(&mut self, letter: u8, start: usize, block: &mut Block) -> Outcome<()> {
        let named = self.cursor.byte(0).is_ascii_digit()
            && matches!(letter, b'X'..=b'Z' | b'A'..=b'C' | b'S');
        if named {
            // `X1=10`: after a name that ends in a digit `=` is required.
            let mut ahead = self.cursor.clone();
            ahead.digits();
            if ahead.assigns() {
                self.cursor.at = ahead.at;
                let name = String::from_utf8_lossy(
                    self.cursor.text.get(start..ahead.at).unwrap_or_default(),
                )
                .into_owned();
                return Err(self
                    .cursor
                    .refused(&name, "an axis or spindle by a name", start));
            }
        }
        if matches!(letter, b'G' | b'M') {
            self.cursor.peek();
            let number = self.cursor.at;
            let value = self.plain_or_expression()?;
            if letter == b'G' && super::is_ramp(value) {
                return self.ramp_times(start, block);
            }
            self.dwells |= letter == b'G' && value == 4.0;
            self.cursor.add_word(letter, value, start, number, block)?;
            if self.cursor.assigns() {
                let start = self.cursor.at;
                self.cursor.at += 1;
                self.cursor.peek();
                let number = self.cursor.at;
                let value = self.number()?;
                self.cursor.add_word(b'=', value, start, number, block)?;
            }
            return Ok(());
        }
        if self.cursor.assigns() {
            self.cursor.at += 1;
        }
        self.cursor.peek();
        let number = self.cursor.at;
        if self.cursor.byte(0) == b'[' {
            self.check_brackets(letter, start)?;
        }
        let value = self.number()?;
        if matches!(letter, b'N' | b'O' | b'P' | b'V') {
            let message = format!("{} has no meaning here", letter as char);
            let help = "a block number stands at the beginning of its block";
            return Err(self.cursor.fault("syntax", message, help, start));
        }
        self.cursor.add_word(letter, value, start, number, block)
    }

    /// `G1`, not `G1 + X5`: numbers of codes are no expressions.
    fn plain_or_expression(&mut self) -> Outcome<f64> {
        match self.cursor.byte(0) {
            b'0'..=b'9' | b'.' => self.cursor.number(),
            _ => self.number(),
        }
    }

    /// `X[OVERRIDE FEED_FACT=20]`, `S[REV1000 M3]`: commands to one axis.
    fn check_brackets(&mut self, letter: u8, start: usize) -> Outcome<()> {
        let mut ahead = self.cursor.clone();
        ahead.at += 1;
        let word = ahead.name();
        let commands = [
            "ABS",
            "CAX",
            "GANTRY",
            "HOMING",
            "INDP",
            "INDP_ASYN",
            "INDP_SYN",
            "M3",
            "M4",
            "M5",
            "MANUAL",
            "OSC",
            "OVERRIDE",
            "POS",
            "REV",
            "SPLINE",
            "STOP",
        ];
        let revolutions = word.starts_with("REV") || word.starts_with("POS");
        if word != "ABS" && (commands.contains(&word.as_str()) || revolutions) {
            self.cursor.brackets()?;
            let name = format!("{}[{word} …]", letter as char);
            return Err(self
                .cursor
                .refused(&name, "a command to one axis or spindle", start));
        }
        Ok(())
    }

    /// `LL NAME` and `L NAME` ("Local subroutines", "Global subroutines").
    fn call(&mut self, block: &Block) -> Outcome<Go> {
        let start = self.cursor.at;
        let local = self.cursor.byte(1) == b'L' && matches!(self.cursor.byte(2), b' ' | b'\t');
        self.cursor.at += if local { 2 } else { 1 };
        let next = self.cursor.peek();
        let mut name = String::new();
        if next == Some(b'"') {
            let rest = self
                .cursor
                .text
                .get(self.cursor.at + 1..)
                .unwrap_or_default();
            if let Some(end) = memchr::memchr(b'"', rest) {
                name = String::from_utf8_lossy(rest.get(..end).unwrap_or_default()).into_owned();
                self.cursor.at += end + 2;
            }
        } else if next.is_some() {
            let rest = self.cursor.text.get(self.cursor.at..).unwrap_or_default();
            let outside = |byte: &u8| matches!(byte, b' ' | b'\t' | b'(' | b';' | b'[');
            let length = rest.iter().position(outside).unwrap_or(rest.len());
            name = String::from_utf8_lossy(rest.get(..length).unwrap_or_default()).into_owned();
            self.cursor.at += length;
        }
        if name == "CYCLE" && next != Some(b'"') {
            return self.cycle(local, start, block);
        }
        if name.is_empty() {
            let message = "a call without the name of a subprogram";
            let help = "write LL and the name of a local subprogram, or L and the name of a file";
            return Err(self.cursor.fault("subprogram", message, help, start));
        }
        if name.starts_with("V.") {
            return Err(self
                .cursor
                .refused(&format!("L {name}"), "a call by a variable", start));
        }
        if self.cursor.peek() == Some(b'[') {
            self.cursor.pass_over_rest();
            let message = "parameters after the name of a subprogram";
            let help = "call a cycle by L CYCLE [NAME=… @P1=…]";
            return Err(self.cursor.fault("subprogram", message, help, start));
        }
        if local {
            return Ok(Go::Local(name));
        }
        // A path of the control is another one here.
        let file = name.rsplit(['/', '\\']).next().unwrap_or_default();
        Ok(Go::File(file.to_owned()))
    }
}
