//! The comment that says of a feed that it stands for a rapid: written where `limit` turns a
//! rapid into a feed, and known again when the written program is limited once more.

use crate::machine::Language;
use crate::source::split_line_end;

/// Most characters of a mark: lines of programs are short.
const LONGEST: usize = 32;

/// Words at the beginning of comments that act (`LinuxCNC`, FluidNC): no mark may be one.
const ACTING: [&str; 13] = [
    "MSG",
    "DEBUG",
    "PRINT",
    "LOG",
    "LOGOPEN",
    "LOGAPPEND",
    "LOGCLOSE",
    "PROBEOPEN",
    "PROBECLOSE",
    "PY",
    "PYRUN",
    "PYRELOAD",
    "ABORT",
];

/// What the comment says.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RapidMark(String);

/// Why a text cannot be a mark.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum RapidMarkError {
    /// Its length, or the characters in it.
    #[error(
        "`{0}` is no mark: 1 to {LONGEST} letters, digits, blanks, `-`, `_` and `.` are one, with no \
         blank at its ends"
    )]
    Characters(String),
    /// Such a comment acts on some control.
    #[error("`{0}` is no mark: a comment that begins with this word acts on some controls")]
    Acts(String),
}

impl RapidMark {
    /// The usual one, in capitals: every control takes them.
    pub const USUAL: &'static str = "RAPID";

    /// A mark of this text.
    ///
    /// # Errors
    /// See [`RapidMarkError`].
    pub fn new(text: &str) -> Result<Self, RapidMarkError> {
        let taken = |byte: u8| byte.is_ascii_alphanumeric() || b" -_.".contains(&byte);
        let fits = (1..=LONGEST).contains(&text.len()) && text.trim() == text;
        if !fits || !text.bytes().all(taken) {
            return Err(RapidMarkError::Characters(text.to_owned()));
        }
        let word = text.split(|c: char| !c.is_ascii_alphabetic()).next();
        if word.is_some_and(|word| ACTING.iter().any(|acts| acts.eq_ignore_ascii_case(word))) {
            return Err(RapidMarkError::Acts(text.to_owned()));
        }
        Ok(Self(text.to_owned()))
    }

    /// The comment as a language has it.
    #[must_use]
    pub fn comment(&self, language: &Language) -> Comment {
        let to_line_end = language.family.facts().comment_to_line_end;
        let text = if to_line_end {
            format!("; {}", self.0)
        } else {
            format!("({})", self.0)
        };
        Comment { text, to_line_end }
    }
}

impl Default for RapidMark {
    fn default() -> Self {
        Self(Self::USUAL.to_owned())
    }
}

/// A mark as a comment.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Comment {
    text: String,
    /// It goes from `;` to the end of the line; else it stands in parentheses.
    to_line_end: bool,
}

impl Comment {
    /// As it is written.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Whether a line has exactly this comment: in parentheses, or as the first one after
    /// `;`, up to the next `;`.
    #[must_use]
    pub fn is_in(&self, line: &[u8]) -> bool {
        let (text, _) = split_line_end(line);
        let mut from = 0;
        while let Some([start, end]) = self.next(text, from) {
            let comment = text.get(start..end).unwrap_or_default();
            if self.to_line_end {
                let mut parts = comment.split(|byte| *byte == b';').skip(1);
                let own = self.text.as_bytes().get(2..);
                return parts.next().map(<[u8]>::trim_ascii) == own;
            }
            if comment == self.text.as_bytes() {
                return true;
            }
            from = end;
        }
        false
    }

    /// Where it is put into a line, and what: before all other comments, so that the last
    /// one, which may act, stays the last.
    pub(super) fn put_into(&self, line: &[u8], spaced: bool) -> (usize, String) {
        let (text, _) = split_line_end(line);
        let blank = |there: bool| if there && spaced { " " } else { "" };
        let Some([at, _]) = self.next(text, 0) else {
            let end = text.trim_ascii_end().len();
            return (end, format!("{}{}", blank(true), self.text));
        };
        let before = text.get(..at).and_then(<[u8]>::last);
        let joined = before.is_some_and(|byte| !matches!(byte, b' ' | b'\t'));
        let comment = &self.text;
        (at, format!("{}{comment}{}", blank(joined), blank(true)))
    }

    /// Start and end of the next comment, from a place on; what stands in quotes is none.
    fn next(&self, text: &[u8], from: usize) -> Option<[usize; 2]> {
        let mut at = from;
        while let Some(byte) = text.get(at) {
            let rest = text.get(at + 1..).unwrap_or_default();
            match byte {
                b';' => return Some([at, text.len()]),
                b'(' if !self.to_line_end => {
                    let length = memchr::memchr(b')', rest)?;
                    return Some([at, at + length + 2]);
                }
                b'"' => at += memchr::memchr(b'"', rest).map_or(0, |length| length + 1),
                _ => {}
            }
            at += 1;
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::{Comment, RapidMark};

    fn comment(to_line_end: bool) -> Comment {
        let text = if to_line_end { "; RAPID" } else { "(RAPID)" };
        Comment {
            text: text.to_owned(),
            to_line_end,
        }
    }

    #[test]
    fn only_exactly_this_comment_counts() {
        let is_in = |line: &str| comment(false).is_in(line.as_bytes());
        assert!(is_in("G1 X1 F500 (RAPID)\r\n"));
        assert!(is_in("(a)(RAPID) G1X1"));
        assert!(!is_in("G1 X1 (rapid)"));
        assert!(!is_in("G1 X1 ( RAPID )"));
        assert!(!is_in("G1 X1 ((RAPID)"));
        assert!(!is_in("G1 X1 (RAPID"));
        assert!(!is_in("G1 X1 ; (RAPID)"));
        assert!(!is_in("G1 X1 \"(RAPID)\""));
        let is_in = |line: &str| comment(true).is_in(line.as_bytes());
        assert!(is_in("G1 X1 F500 ; RAPID"));
        assert!(is_in("G1 X1 F500;RAPID ; go\n"));
        assert!(!is_in("G1 X1 F500 ; go ; RAPID"));
        assert!(!is_in("G1 X1 ; RAPIDS"));
        assert!(!is_in("MSG(\";RAPID\")"));
        assert!(!is_in("G1 X1 (RAPID)"));
    }

    #[test]
    fn it_stands_before_all_other_comments() {
        let put = |to_line_end, line: &str, spaced| {
            let (at, words) = comment(to_line_end).put_into(line.as_bytes(), spaced);
            let put = format!("{}{words}{}", &line[..at], &line[at..]);
            assert!(comment(to_line_end).is_in(put.as_bytes()), "{put}");
            put
        };
        assert_eq!(put(false, "G1 X1 \r\n", true), "G1 X1 (RAPID) \r\n");
        assert_eq!(put(false, "G1X1\n", false), "G1X1(RAPID)\n");
        assert_eq!(put(false, "G1 X1 (go)\n", true), "G1 X1 (RAPID) (go)\n");
        assert_eq!(put(false, "G1 X1(go)", true), "G1 X1 (RAPID) (go)");
        assert_eq!(put(false, "(MSG, a) G1 X1", true), "(RAPID) (MSG, a) G1 X1");
        assert_eq!(put(false, "G1X1;go", false), "G1X1(RAPID);go");
        assert_eq!(put(true, "G1 X1\n", true), "G1 X1 ; RAPID\n");
        assert_eq!(
            put(true, "G1 X=IC(5) ; go\n", true),
            "G1 X=IC(5) ; RAPID ; go\n"
        );
        assert_eq!(put(true, "G1X1;go", false), "G1X1; RAPID;go");
    }

    #[test]
    fn texts_that_could_act_or_end_the_comment_are_no_marks() {
        for text in ["RAPID", "was G0", "g0-limited_2.5"] {
            assert!(RapidMark::new(text).is_ok(), "{text}");
        }
        let long = "R".repeat(33);
        for text in [
            "",
            " R",
            "R ",
            "a)",
            "(a",
            "a;b",
            "a\nb",
            "Eilgänge",
            "a\"",
            &long,
        ] {
            let error = RapidMark::new(text).unwrap_err().to_string();
            assert!(error.contains("1 to 32 letters"), "{error}");
        }
        for text in ["MSG", "msg R", "Debug-R", "PRINT", "log 5", "ProbeOpen x"] {
            let error = RapidMark::new(text).unwrap_err().to_string();
            assert!(error.ends_with("acts on some controls"), "{error}");
        }
    }
}
