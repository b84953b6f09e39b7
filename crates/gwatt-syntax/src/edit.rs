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

#[cfg(test)]
mod tests {
    use super::*;

    fn applied(original: &str, mut edits: Vec<Edit>) -> Option<String> {
        let mut out = b"> ".to_vec();
        let done = apply(original.as_bytes(), &mut edits, &mut out);
        assert!(done || out == b"> ", "nothing is written on refusal");
        done.then(|| String::from_utf8(out).unwrap())
    }

    #[test]
    fn edits_leave_all_other_bytes_alone() {
        let edits = vec![
            Edit::replace(Span::new(7, 11), "F900"),
            Edit::replace(Span::new(0, 2), ""),
            Edit::insert(11, " P1"),
            Edit::insert(11, " Q2"),
        ];
        let text = applied("G1 X10 F1200\r\n", edits);
        assert_eq!(text.as_deref(), Some(">  X10 F900 P1 Q20\r\n"));
    }

    #[test]
    fn no_edits_change_nothing() {
        assert_eq!(applied("G0\r", vec![]).as_deref(), Some("> G0\r"));
    }

    #[test]
    fn edits_at_both_ends_are_allowed() {
        let edits = vec![Edit::insert(3, "!"), Edit::insert(0, "(")];
        assert_eq!(applied("abc", edits).as_deref(), Some("> (abc!"));
    }

    #[test]
    fn overlaps_and_spans_outside_are_refused() {
        let over = vec![
            Edit::replace(Span::new(0, 2), "x"),
            Edit::replace(Span::new(1, 3), "y"),
        ];
        assert_eq!(applied("abc", over), None);
        assert_eq!(applied("abc", vec![Edit::insert(4, "x")]), None);
        let backwards = Span { start: 2, end: 1 };
        assert_eq!(applied("abc", vec![Edit::replace(backwards, "x")]), None);
        let inside = vec![Edit::replace(Span::new(0, 3), "x"), Edit::insert(1, "y")];
        assert_eq!(applied("abc", inside), None);
    }
}
