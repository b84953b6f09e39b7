//! Findings that a comment of their own line names as known:
//! `(gwatt: known peak-power 6000 W of 3600 W)`.

use super::baseline::Known;

/// What such comments begin with.
const BEGIN: &[u8] = b"gwatt:";

/// What a comment of a line says.
#[derive(Debug, PartialEq)]
pub(super) enum Comment {
    /// Nothing about known findings.
    None,
    /// A rule, its figure and its limit, W.
    Known(String, f64, f64),
    /// It begins as one, and goes on as none.
    Unclear,
}

/// Reads the comment of a line.
pub(super) fn comment(line: &[u8]) -> Comment {
    let begins = |part: &[u8]| part.eq_ignore_ascii_case(BEGIN);
    let Some(at) = line.windows(BEGIN.len()).position(begins) else {
        return Comment::None;
    };
    let before = line.get(..at).unwrap_or_default();
    if !before.iter().any(|byte| matches!(byte, b'(' | b';')) {
        return Comment::None;
    }
    let text = String::from_utf8_lossy(line.get(at + BEGIN.len()..).unwrap_or_default());
    let text = text.split([')', ';']).next().unwrap_or_default();
    let mut words = text.split_whitespace();
    if !words
        .next()
        .is_some_and(|word| word.eq_ignore_ascii_case("known"))
    {
        return Comment::None;
    }
    let words: Vec<&str> = words.collect();
    let watts = |text: &str| {
        text.parse::<f64>()
            .ok()
            .filter(|it| it.is_finite() && *it >= 0.0)
    };
    match words.as_slice() {
        [rule, value, "W", "of", limit, "W"] => match (watts(value), watts(limit)) {
            (Some(value), Some(limit)) => {
                Comment::Known((*rule).to_ascii_lowercase(), value, limit)
            }
            _ => Comment::Unclear,
        },
        _ => Comment::Unclear,
    }
}

impl Known {
    /// The finding as the comment of its line has it.
    pub(super) fn as_commented(&self, rule: String, value: f64, limit: f64) -> Self {
        Self {
            rule,
            value: Some(value),
            limit,
            ..self.clone()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Comment, comment};

    #[test]
    fn comments_of_both_kinds_are_read() {
        let known = || Comment::Known("peak-power".into(), 6000.0, 3600.5);
        assert_eq!(
            comment(b"G0 X1 (gwatt: known peak-power 6000 W of 3600.5 W)"),
            known()
        );
        assert_eq!(
            comment(b"G0 X1 ; GWATT: KNOWN peak-power 6000 W of 3600.5 W"),
            known()
        );
        assert_eq!(comment(b"G0 X1 (known)"), Comment::None);
        assert_eq!(comment(b"(gwatt: rapid)"), Comment::None);
        assert_eq!(
            comment(b"gwatt: known peak-power 6000 W of 3600 W"),
            Comment::None
        );
        for wrong in [
            "(gwatt: known peak-power)",
            "(gwatt: known peak-power 6 kW of 3 kW)",
            "(gwatt: known peak-power inf W of 3 W)",
            "(gwatt: known)",
        ] {
            assert_eq!(comment(wrong.as_bytes()), Comment::Unclear, "{wrong}");
        }
    }
}
