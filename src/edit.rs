//! Edits of a text: replacements of spans, every other byte kept.

use crate::source::Span;

/// One replacement: the bytes of `span` in the original become `text`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Edit {
    /// What is replaced; empty for an insertion before `span.start`.
    pub span: Span,
    /// What stands there afterwards.
    pub text: Vec<u8>,
}

impl Edit {
    /// Replaces `span` by `text`.
    pub fn replace(span: Span, text: impl Into<Vec<u8>>) -> Self {
        Self {
            span,
            text: text.into(),
        }
    }

    /// Inserts `text` before the byte at `at`.
    pub fn insert(at: u32, text: impl Into<Vec<u8>>) -> Self {
        Self::replace(Span { start: at, end: at }, text)
    }
}

/// Writes `original` with `edits` applied to the end of `out`.
///
/// Edits are put in order of their place (insertions at one place keep the
/// order given). Returns false, and writes nothing, when two overlap or one
/// leaves the text.
#[must_use]
pub fn apply(original: &[u8], edits: &mut [Edit], out: &mut Vec<u8>) -> bool {
    edits.sort_by_key(|edit| (edit.span.start, edit.span.end));
    let mut end = 0;
    for edit in edits.iter() {
        if edit.span.start < end
            || edit.span.end < edit.span.start
            || edit.span.end as usize > original.len()
        {
            return false;
        }
        end = edit.span.end;
    }
    let mut at = 0;
    for edit in edits.iter() {
        out.extend_from_slice(&original[at..edit.span.start as usize]);
        out.extend_from_slice(&edit.text);
        at = edit.span.end as usize;
    }
    out.extend_from_slice(&original[at..]);
    true
}
