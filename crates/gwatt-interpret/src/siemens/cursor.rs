//! What only this language has in its text: quotes, and parentheses that nest.

use crate::expression::{Cursor, Outcome};

impl Cursor<'_> {
    /// A text in quotes, without them.
    pub(super) fn quoted(&mut self) -> Outcome<String> {
        self.peek();
        let start = self.at;
        let inside = self.text.get(start + 1..).unwrap_or_default();
        let Some(length) = memchr::memchr(b'"', inside) else {
            let message = "a text in quotes is not closed";
            return Err(self.fault("expression", message, "write a second `\"`", start));
        };
        self.at = start + length + 2;
        Ok(String::from_utf8_lossy(inside.get(..length).unwrap_or_default()).into_owned())
    }

    /// Passes over `( … )`, whatever it holds.
    pub(super) fn pass_over_parentheses(&mut self) -> Outcome<()> {
        if self.peek() != Some(b'(') {
            return Ok(());
        }
        let start = self.at;
        let mut depth = 0_usize;
        while let Some(byte) = self.text.get(self.at) {
            match byte {
                b'"' => {
                    self.quoted()?;
                    continue;
                }
                b'(' => depth += 1,
                b')' => depth -= 1,
                _ => {}
            }
            self.at += 1;
            if depth == 0 {
                return Ok(());
            }
        }
        Err(self.missing(")", start))
    }
}
