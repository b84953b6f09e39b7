//! The colours of a unified diff.

use std::io::{self, Write};

use gwatt::report::Style;

/// Passes a unified diff on line by line: what goes in red, what comes in green.
pub struct DiffColours<W: Write> {
    out: W,
    style: Style,
    line: Vec<u8>,
}

impl<W: Write> DiffColours<W> {
    /// To `out`, as `style` says.
    pub fn new(out: W, style: Style) -> Self {
        Self {
            out,
            style,
            line: Vec::new(),
        }
    }

    /// Passes on what came without a line end.
    ///
    /// # Errors
    /// Those of the output.
    pub fn finish(mut self) -> io::Result<()> {
        self.pass_on()?;
        self.out.flush()
    }

    fn pass_on(&mut self) -> io::Result<()> {
        let line = self.line.trim_ascii_end();
        let rest = &self.line[line.len()..];
        let Ok(text) = std::str::from_utf8(line) else {
            self.out.write_all(&self.line)?;
            self.line.clear();
            return Ok(());
        };
        let set = match line.first() {
            Some(b'-') => self.style.bad(text),
            Some(b'+') => self.style.good(text),
            _ => text.to_owned(),
        };
        self.out.write_all(set.as_bytes())?;
        self.out.write_all(rest)?;
        self.line.clear();
        Ok(())
    }
}

impl<W: Write> Write for DiffColours<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if !self.style.colour {
            return self.out.write(bytes);
        }
        for piece in bytes.split_inclusive(|byte| *byte == b'\n') {
            self.line.extend_from_slice(piece);
            if piece.ends_with(b"\n") {
                self.pass_on()?;
            }
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}
