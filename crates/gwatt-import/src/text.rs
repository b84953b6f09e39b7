//! Files as lines, places in them, and what is found to say about them.

use std::ops::Range;

use gwatt_syntax::diagnostic::Diagnostic;
use gwatt_syntax::source::{Span, lines, split_line_end};

/// A file that is read, with the name that messages have.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct File {
    /// Its name or path.
    pub name: String,
    /// What stands in it.
    pub bytes: Vec<u8>,
}

/// The largest file that is read, in bytes: settings are far smaller.
pub const MAX_BYTES: usize = 16 << 20;

/// A file as text.
pub(crate) struct Text {
    pub(crate) name: String,
    pub(crate) lines: Vec<String>,
}

impl Text {
    /// The lines of a file. What is not UTF-8, in comments, is replaced.
    ///
    /// # Errors
    /// A file that is too large, or no text.
    pub(crate) fn new(file: &File) -> Result<Self, Box<Diagnostic>> {
        let refuse = |message: String, help: &str| {
            let mut refused = Diagnostic::error("import-file", message).help(help);
            refused.file = Some(file.name.clone());
            Box::new(refused)
        };
        if file.bytes.len() > MAX_BYTES {
            return Err(refuse(
                format!("{} is larger than 16 MiB", file.name),
                "settings of a control are smaller: give the file that holds them",
            ));
        }
        if file.bytes.contains(&0) {
            return Err(refuse(
                format!("{} is a binary file, or text in UTF-16", file.name),
                "save it as plain text (ASCII or UTF-8)",
            ));
        }
        let bytes = file
            .bytes
            .strip_prefix(b"\xef\xbb\xbf")
            .unwrap_or(&file.bytes);
        // Fanuc: parameter 100, bit NCR, ends blocks with LF CR CR.
        let joined = String::from_utf8_lossy(bytes).replace("\n\r\r", "\n");
        let bytes = joined.as_bytes();
        let line = |line| String::from_utf8_lossy(split_line_end(line).0).into_owned();
        Ok(Self {
            name: file.name.clone(),
            lines: lines(bytes).map(line).collect(),
        })
    }

    /// A line.
    pub(crate) fn place(&self, line: usize) -> Place<'_> {
        Place {
            text: self,
            line,
            span: 0..0,
        }
    }
}

/// A place in a line.
#[derive(Clone)]
pub(crate) struct Place<'t> {
    text: &'t Text,
    line: usize,
    /// Bytes of the line.
    pub(crate) span: Range<usize>,
}

impl<'t> Place<'t> {
    /// The whole line.
    pub(crate) fn line(&self) -> &'t str {
        self.text.lines.get(self.line).map_or("", String::as_str)
    }

    /// Its number from 1.
    pub(crate) fn number(&self) -> usize {
        self.line + 1
    }

    /// The file.
    pub(crate) fn file(&self) -> &'t str {
        &self.text.name
    }

    /// The place of a piece of its line.
    pub(crate) fn of(&self, piece: &str) -> Self {
        let line = self.line();
        let start = (piece.as_ptr() as usize).wrapping_sub(line.as_ptr() as usize);
        let start = if start <= line.len() { start } else { 0 };
        Self {
            span: start..(start + piece.len()).min(line.len()),
            ..self.clone()
        }
    }

    /// How a value is shown with its source: `$120=500.000 (line 14)`.
    pub(crate) fn source(&self, shown: &str) -> String {
        let shown = shown.split_whitespace().collect::<Vec<_>>().join(" ");
        let shown: String = shown.chars().filter(|c| !c.is_control()).take(80).collect();
        format!("{shown} (line {})", self.number())
    }
}

/// What is found to say, in the order in which it is found.
#[derive(Default)]
pub(crate) struct Log {
    pub(crate) list: Vec<Diagnostic>,
}

/// More findings help nobody.
const MOST: usize = 100;

impl Log {
    /// A value that cannot be taken.
    pub(crate) fn error(&mut self, place: &Place<'_>, message: String, help: &str) {
        self.push(Diagnostic::error("import-value", message), place, help);
    }

    /// What changes how the machine moves and is not taken over.
    pub(crate) fn warning(&mut self, place: &Place<'_>, message: String, help: &str) {
        self.push(Diagnostic::warning("import-left-out", message), place, help);
    }

    /// What concerns no line.
    pub(crate) fn whole(&mut self, file: &str, message: String, help: &str) {
        let mut found = Diagnostic::error("import-file", message).help(help);
        found.file = Some(file.to_owned());
        self.list.push(found);
    }

    /// A warning that concerns no line.
    pub(crate) fn hint(&mut self, file: &str, message: String, help: &str) {
        let mut found = Diagnostic::warning("import-left-out", message).help(help);
        found.file = Some(file.to_owned());
        if !self.list.contains(&found) {
            self.list.push(found);
        }
    }

    fn push(&mut self, found: Diagnostic, place: &Place<'_>, help: &str) {
        if self.list.len() >= MOST {
            return;
        }
        let span = Span::new(place.span.start, place.span.end);
        let mut found = found.at(place.number() as u64, span, place.line().as_bytes());
        found.file = Some(place.file().to_owned());
        if !help.is_empty() {
            found = found.help(help);
        }
        if !self.list.contains(&found) {
            self.list.push(found);
        }
    }

    /// The number that stands at `place`; reports what is none.
    pub(crate) fn number(&mut self, place: &Place<'_>, text: &str) -> Option<f64> {
        let found = text.parse::<f64>().ok().filter(|number| number.is_finite());
        if found.is_none() {
            let message = format!("`{text}` is not a number");
            self.error(
                place,
                message,
                "write the number that the control has, without a unit",
            );
        }
        found
    }

    /// A number above 0.
    pub(crate) fn positive(&mut self, place: &Place<'_>, text: &str, what: &str) -> Option<f64> {
        let number = self.number(place, text)?;
        if number > 0.0 {
            return Some(number);
        }
        let message = format!("{number} is not valid for {what}");
        self.error(
            place,
            message,
            "a value above 0 is needed: look at the control",
        );
        None
    }
}
