//! Bytes of a program: spans within a line, and lines out of a stream.

use std::io::{ErrorKind, Read};

use memchr::{memchr, memchr2};

/// A range of bytes within one line (line end included).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
pub struct Span {
    /// Offset of the first byte.
    pub start: u32,
    /// Offset after the last byte.
    pub end: u32,
}

impl Span {
    /// The span from `start` to before `end`, in bytes of a line, which is
    /// shorter than 4 GiB.
    #[must_use]
    pub fn new(start: usize, end: usize) -> Self {
        Self {
            start: start as u32,
            end: end as u32,
        }
    }

    /// The bytes of `line` that the span covers; none where it leaves the line.
    #[must_use]
    pub fn of(self, line: &[u8]) -> &[u8] {
        line.get(self.start as usize..self.end as usize)
            .unwrap_or_default()
    }

    /// Number of bytes.
    #[must_use]
    pub fn len(self) -> u32 {
        self.end.saturating_sub(self.start)
    }

    /// True for a span of no bytes.
    #[must_use]
    pub fn is_empty(self) -> bool {
        self.start >= self.end
    }
}

/// Longest line that is read, in bytes, its line end included.
pub const MAX_LINE_BYTES: usize = 8 << 20;

/// Room for many lines at once; grows for a line that is longer.
const BUFFER_BYTES: usize = 256 << 10;

/// Why a program cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum SourceError {
    /// A line longer than [`MAX_LINE_BYTES`].
    #[error(
        "line {line} is longer than {} MiB: this is not a part program, or its line ends were lost; \
         export it again with a line end after each block",
        MAX_LINE_BYTES >> 20
    )]
    LineTooLong {
        /// Line number from 1.
        line: u64,
    },
    /// A NUL byte: a binary file, or text in UTF-16.
    #[error(
        "line {line} holds a NUL byte: this is a binary file, or text in UTF-16; \
         save the program as plain text (ASCII or UTF-8)"
    )]
    Binary {
        /// Line number from 1.
        line: u64,
    },
    /// The reader failed.
    #[error(
        "the program cannot be read; check the file, the drive or the connection it comes from"
    )]
    Io(#[from] std::io::Error),
}

/// CRs before an LF that are one line end together with it: programs that went through a
/// conversion twice have two.
const CRS: usize = 8;

/// Offset after the first line end of `bytes`: LF, CR, and an LF after CRs each are one.
///
/// `None` when there is no line end, and also when `bytes` ends in CRs, since
/// an LF that follows would belong to them.
fn line_length(bytes: &[u8]) -> Option<usize> {
    let at = memchr2(b'\n', b'\r', bytes)?;
    let end = bytes.get(at..).unwrap_or_default();
    let crs = end
        .iter()
        .take(CRS)
        .take_while(|byte| **byte == b'\r')
        .count();
    match end.get(crs) {
        Some(b'\n') => Some(at + crs + 1),
        Some(_) => Some(at + 1),
        None => None,
    }
}

/// The same where nothing comes after `bytes`: their length where there is no line end.
fn last_line_length(bytes: &[u8]) -> usize {
    memchr2(b'\n', b'\r', bytes).map_or(bytes.len(), |at| at + 1)
}

/// How many CRs `bytes` end in, of those that may belong to one line end.
fn last_crs(bytes: &[u8]) -> usize {
    let last = bytes.iter().rev().take(CRS);
    last.take_while(|byte| **byte == b'\r').count()
}

/// The lines of `bytes`, each with its line end; the last may lack one.
pub fn lines(bytes: &[u8]) -> impl Iterator<Item = &[u8]> {
    let mut rest = bytes;
    std::iter::from_fn(move || {
        if rest.is_empty() {
            return None;
        }
        let length = line_length(rest).unwrap_or_else(|| last_line_length(rest));
        let (line, after) = rest.split_at_checked(length)?;
        rest = after;
        Some(line)
    })
}

/// A line without its line end, and the line end.
#[must_use]
pub fn split_line_end(line: &[u8]) -> (&[u8], &[u8]) {
    let end = match line {
        [before @ .., b'\n'] => 1 + last_crs(before),
        [.., b'\r'] => 1,
        _ => 0,
    };
    line.split_at_checked(line.len() - end)
        .unwrap_or((line, &[]))
}

/// Lines out of a stream, one at a time, in a buffer that is used again.
///
/// Memory is bounded whatever the stream holds: the buffer grows only for a
/// line that does not fit, up to [`MAX_LINE_BYTES`].
#[derive(Debug)]
pub struct LineReader<R> {
    reader: R,
    buffer: Vec<u8>,
    /// First byte that was not handed out yet.
    start: usize,
    /// First byte of the line that was handed out last.
    last: usize,
    /// End of what was read.
    end: usize,
    /// End of what is known to hold neither a line end nor a lone last CR.
    searched: usize,
    /// Place of a NUL byte in what was read.
    nul: Option<usize>,
    /// Lines handed out so far.
    line: u64,
    at_end: bool,
}

impl<R: Read> LineReader<R> {
    /// Reads lines from `reader`; needs no buffering around it.
    pub fn new(reader: R) -> Self {
        Self {
            reader,
            buffer: vec![0; BUFFER_BYTES],
            start: 0,
            last: 0,
            end: 0,
            searched: 0,
            nul: None,
            line: 0,
            at_end: false,
        }
    }

    /// The line that was handed out last.
    #[inline]
    pub fn last_line(&self) -> &[u8] {
        self.buffer.get(self.last..self.start).unwrap_or_default()
    }

    /// What lines are read from; what was read ahead is gone.
    pub fn get_mut(&mut self) -> &mut R {
        &mut self.reader
    }

    /// The next line with its number from 1, its line end included; `None`
    /// after the last one.
    ///
    /// # Errors
    ///
    /// [`SourceError`]: a line too long, a NUL byte in the line, or a reader
    /// that fails. Asked again after an error, it does not go past that line.
    #[inline]
    pub fn next_line(&mut self) -> Result<Option<(u64, &[u8])>, SourceError> {
        let found = self
            .buffer
            .get(self.start..self.end)
            .and_then(line_length)
            .map(|length| self.start + length);
        let Some(end) = found.map_or_else(|| self.read_line(), |end| Ok(Some(end)))? else {
            return Ok(None);
        };
        let line = self.line + 1;
        if self.nul.is_some_and(|nul| nul < end) {
            return Err(SourceError::Binary { line });
        }
        let bytes = self.buffer.get(self.start..end).unwrap_or_default();
        self.line = line;
        self.last = self.start;
        self.start = end;
        Ok(Some((line, bytes)))
    }

    /// Reads until a whole line is there; gives its end in the buffer.
    #[cold]
    fn read_line(&mut self) -> Result<Option<usize>, SourceError> {
        self.searched = self.start;
        loop {
            if self.at_end {
                let rest = self.buffer.get(self.start..self.end).unwrap_or_default();
                return Ok((!rest.is_empty()).then(|| self.start + last_line_length(rest)));
            }
            // CRs at the very end are looked at again: an LF may follow them.
            let unread = self.buffer.get(self.start..self.end).unwrap_or_default();
            self.searched = self.searched.max(self.end - last_crs(unread));
            if self.end - self.start > MAX_LINE_BYTES {
                return Err(SourceError::LineTooLong {
                    line: self.line + 1,
                });
            }
            self.fill()?;
            let fresh = self.buffer.get(self.searched..self.end);
            if let Some(length) = fresh.and_then(line_length) {
                let end = self.searched + length;
                if end - self.start > MAX_LINE_BYTES {
                    return Err(SourceError::LineTooLong {
                        line: self.line + 1,
                    });
                }
                return Ok(Some(end));
            }
        }
    }

    /// Moves what is left to the front, makes room, and reads once.
    fn fill(&mut self) -> Result<(), SourceError> {
        if self.start > 0 {
            self.buffer.copy_within(self.start..self.end, 0);
            self.nul = self.nul.and_then(|nul| nul.checked_sub(self.start));
            self.searched -= self.start;
            self.end -= self.start;
            self.start = 0;
        }
        if self.end == self.buffer.len() {
            self.buffer.resize(self.buffer.len() * 2, 0);
        }
        let room = self.buffer.get_mut(self.end..).unwrap_or_default();
        let count = loop {
            match self.reader.read(room) {
                Ok(count) => break count.min(room.len()),
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => return Err(error.into()),
            }
        };
        if self.nul.is_none() {
            self.nul = memchr(0, room.get(..count).unwrap_or_default()).map(|at| self.end + at);
        }
        self.end += count;
        self.at_end = count == 0;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Gives each part in a read of its own, then nothing.
    struct Parts(std::vec::IntoIter<Vec<u8>>);

    impl Read for Parts {
        fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
            let Some(part) = self.0.next() else {
                return Ok(0);
            };
            buffer[..part.len()].copy_from_slice(&part);
            Ok(part.len())
        }
    }

    fn parts(parts: &[&str]) -> LineReader<Parts> {
        let parts: Vec<Vec<u8>> = parts.iter().map(|part| part.as_bytes().to_vec()).collect();
        LineReader::new(Parts(parts.into_iter()))
    }

    fn all(reader: &mut LineReader<impl Read>) -> Vec<String> {
        let mut lines = Vec::new();
        while let Some((_, line)) = reader.next_line().unwrap() {
            lines.push(String::from_utf8(line.to_vec()).unwrap());
        }
        lines
    }

    #[test]
    fn line_ends_may_be_mixed() {
        let lines = all(&mut parts(&["a\nb\rc\r\n\n\r\r\nlast"]));
        assert_eq!(lines, ["a\n", "b\r", "c\r\n", "\n", "\r\r\n", "last"]);
        let many = format!("a{}\n", "\r".repeat(CRS + 1));
        for text in [many.as_str(), "a\r\rb\r\r", "\r\r\r", "a\r\r\n\r\r\nb"] {
            let lines = all(&mut parts(&[text]));
            assert_eq!(lines.concat(), text);
            let whole = super::lines(text.as_bytes());
            assert!(whole.eq(lines.iter().map(String::as_bytes)), "{lines:?}");
            let no_end_within = |line: &str| {
                let (text, _) = split_line_end(line.as_bytes());
                !text.contains(&b'\r')
            };
            assert!(lines.iter().all(|line| no_end_within(line)), "{lines:?}");
        }
    }

    #[test]
    fn a_line_end_in_two_reads_is_one() {
        assert_eq!(
            all(&mut parts(&["a\r", "\nb\r", "c\r"])),
            ["a\r\n", "b\r", "c\r"]
        );
        assert_eq!(all(&mut parts(&["a\r", "\r", "\nb"])), ["a\r\r\n", "b"]);
    }

    #[test]
    fn an_empty_stream_has_no_lines() {
        assert!(all(&mut parts(&[])).is_empty());
    }

    #[test]
    fn a_nul_is_refused_where_it_stands() {
        let mut reader = parts(&["a\nb", "\0\nc\n"]);
        assert!(matches!(reader.next_line(), Ok(Some((1, b"a\n")))));
        for _ in 0..2 {
            let error = reader.next_line().unwrap_err();
            assert!(matches!(error, SourceError::Binary { line: 2 }));
        }
    }

    #[test]
    fn the_longest_line_is_read_and_a_longer_one_refused() {
        let mut text = vec![b'x'; MAX_LINE_BYTES - 1];
        text.push(b'\n');
        let mut reader = LineReader::new(text.as_slice());
        assert!(reader.next_line().is_ok_and(|line| line.is_some()));
        text.insert(0, b'x');
        let with_end = LineReader::new(text.as_slice()).next_line().map(drop);
        assert!(matches!(
            with_end,
            Err(SourceError::LineTooLong { line: 1 })
        ));
        text.pop();
        text.push(b'x');
        let without = LineReader::new(text.as_slice()).next_line().map(drop);
        assert!(matches!(without, Err(SourceError::LineTooLong { line: 1 })));
    }

    #[test]
    fn line_ends_are_taken_off_once() {
        let cases: [(&[u8], &[u8]); 6] = [
            (b"a\r\r\n", b"\r\r\n"),
            (b"a\r\n", b"\r\n"),
            (b"a\n", b"\n"),
            (b"a\r", b"\r"),
            (b"a", b""),
            (b"\n", b"\n"),
        ];
        for (line, end) in cases {
            let (text, found) = split_line_end(line);
            assert_eq!(found, end);
            assert_eq!([text, found].concat(), line);
        }
        assert_eq!(split_line_end(b"a\n\r").0, b"a\n");
    }

    #[test]
    fn a_span_outside_its_line_covers_nothing() {
        assert_eq!(Span::new(1, 3).of(b"abcd"), b"bc");
        assert_eq!(Span::new(1, 9).of(b"abcd"), b"");
        assert_eq!(Span { start: 3, end: 1 }.of(b"abcd"), b"");
    }
}
