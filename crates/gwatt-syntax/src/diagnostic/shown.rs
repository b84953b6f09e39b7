//! The line of a finding as it is shown: cut around the span where it is long.

use super::printable::decode;
use std::ops::Range;

use super::Diagnostic;

/// Characters of a line that are shown.
const SHOWN_CHARS: usize = 120;
/// Characters shown before the span where the line is longer than that.
const SHOWN_BEFORE: usize = 40;

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
