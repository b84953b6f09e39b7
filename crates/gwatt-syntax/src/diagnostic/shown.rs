//! Bytes of a program as text that is safe to show.
//!
//! A program may hold any bytes: Latin-1 comments, tabs, NULs, sequences that
//! steer a terminal. Each character, and each byte that is none, becomes one
//! character that can be printed, so that columns and carets stay right.

use std::ops::Range;

use super::Diagnostic;

/// Characters of a line that are shown.
const SHOWN_CHARS: usize = 120;
/// Characters shown before the span where the line is longer than that.
const SHOWN_BEFORE: usize = 40;

/// The characters of `bytes` that can be printed, each with the number of bytes
/// it stands for.
pub(super) fn decode(bytes: &[u8]) -> impl Iterator<Item = (char, usize)> {
    bytes.utf8_chunks().flat_map(|chunk| {
        let valid = chunk.valid().chars();
        let invalid = chunk.invalid().iter();
        valid
            .map(|c| (printable(c), c.len_utf8()))
            .chain(invalid.map(|_| (char::REPLACEMENT_CHARACTER, 1)))
    })
}

/// `c`, or what is shown in its place: nothing may move the cursor, colour the
/// screen or turn the direction of the text.
fn printable(c: char) -> char {
    match c {
        '\t' => ' ',
        '\u{200B}'..='\u{200F}'
        | '\u{2028}'..='\u{202E}'
        | '\u{2060}'..='\u{206F}'
        | '\u{FEFF}' => char::REPLACEMENT_CHARACTER,
        c if c.is_control() => char::REPLACEMENT_CHARACTER,
        c => c,
    }
}

/// The first `max_chars` characters of `bytes` as printable text, with `…`
/// after them if there are more.
#[must_use]
pub fn excerpt(bytes: &[u8], max_chars: usize) -> String {
    let mut chars = decode(bytes).map(|(c, _)| c);
    let mut text: String = chars.by_ref().take(max_chars).collect();
    if chars.next().is_some() {
        text.push('…');
    }
    text
}

/// A line as it is shown, and where the span is in it.
#[derive(Debug)]
pub(super) struct Shown {
    pub(super) text: String,
    /// Bytes of `text` under which the carets stand.
    pub(super) marked: Range<usize>,
    /// True when `text` does not begin with the line.
    pub(super) cut_before: bool,
}

impl Shown {
    /// The line of `diagnostic`, cut around the span where it is long.
    pub(super) fn new(diagnostic: &Diagnostic) -> Self {
        let offset = diagnostic.text_offset;
        let start = diagnostic.span.start.saturating_sub(offset) as usize;
        let end = diagnostic.span.end.saturating_sub(offset) as usize;
        let mut ends = 0;
        let chars: Vec<(char, usize)> = decode(&diagnostic.text)
            .map(|(c, length)| {
                ends += length;
                (c, ends)
            })
            .collect();
        // Characters that end before the span, and those that end with it.
        let first = chars.partition_point(|&(_, at)| at <= start);
        let last = chars.partition_point(|&(_, at)| at <= end).max(first + 1);
        let from = if chars.len() > SHOWN_CHARS {
            first
                .saturating_sub(SHOWN_BEFORE)
                .min(chars.len() - SHOWN_CHARS)
        } else {
            0
        };
        let mut shown = Self {
            text: String::new(),
            marked: 0..0,
            cut_before: from > 0,
        };
        if from > 0 {
            shown.text.push('…');
        }
        for (index, &(c, _)) in chars.iter().enumerate().skip(from).take(SHOWN_CHARS) {
            if index == first {
                shown.marked.start = shown.text.len();
            }
            shown.text.push(c);
            if index < last {
                shown.marked.end = shown.text.len();
            }
        }
        // After the last character, as for something that is missing there.
        if first >= chars.len() {
            shown.marked = shown.text.len()..shown.text.len();
        }
        if from + SHOWN_CHARS < chars.len() {
            shown.text.push('…');
        }
        shown
    }
}
