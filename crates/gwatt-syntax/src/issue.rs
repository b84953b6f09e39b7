//! What is wrong with the text of a block, and how to say it.

use crate::diagnostic::{Diagnostic, excerpt};
use crate::source::Span;

/// What is wrong with the text of a block.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Issue {
    /// Which fault.
    pub kind: IssueKind,
    /// Where in the line.
    pub span: Span,
}

/// The faults of a text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum IssueKind {
    /// A byte that begins nothing known; also N, `/` or `%` out of place.
    UnknownText,
    /// A letter without a number after it.
    MissingNumber,
    /// A number without a letter before it.
    MissingLetter,
    /// A number that is too large for f64.
    NotFinite,
    /// `(` without `)`.
    UnclosedComment,
    /// `#`, `[`, `<`, or a letter followed by one: variables and expressions.
    Expression,
    /// `O` with a name, or O-word flow (`o100 sub`, `if`, `while` …).
    Flow,
}

/// Characters of the program that a message quotes.
const QUOTED_CHARS: usize = 40;

impl Issue {
    /// The error to show: `line` is the number of the line from 1, `text` the
    /// line that the issue was found in.
    #[must_use]
    pub fn diagnostic(&self, line: u64, text: &[u8]) -> Diagnostic {
        let (rule, message, help) = self.kind.describe(self.span.of(text));
        Diagnostic::error(rule, message)
            .at(line, self.span, text)
            .help(help)
    }
}

impl IssueKind {
    /// Name of the rule in kebab case, message and help for a fault in `text`,
    /// the bytes that the issue covers.
    #[must_use]
    pub fn describe(self, text: &[u8]) -> (&'static str, String, &'static str) {
        let shown = excerpt(text, QUOTED_CHARS);
        match self {
            Self::UnknownText => describe_unknown(text, &shown),
            Self::MissingNumber => (
                "missing-number",
                format!("`{shown}` has no number after it"),
                "write the number right after the letter, as in `X12.5`",
            ),
            Self::MissingLetter => (
                "missing-letter",
                format!("the number `{shown}` has no letter before it"),
                "write the letter of the word, or take the blank or second point out of the number",
            ),
            Self::NotFinite => (
                "number-too-large",
                format!("the number of `{shown}` is too large"),
                "look for a lost decimal point: numbers end at about 1.8e308",
            ),
            Self::UnclosedComment => (
                "unclosed-comment",
                "the comment has no `)`".to_owned(),
                "close the comment on the same line, or begin it with `;`",
            ),
            Self::Expression => (
                "expression",
                format!("a variable or expression of this form is not supported: `{shown}`"),
                "write the number itself, or give the profile of the control that the program is for (--dialect)",
            ),
            Self::Flow => (
                "o-word-flow",
                format!("an O-word subroutine, branch or loop is not supported here: `{shown}`"),
                "give --dialect linuxcnc if the program is for LinuxCNC; otherwise write the blocks out in the order in which they are executed",
            ),
        }
    }
}

/// Texts for what is not understood; words out of place are called by name.
fn describe_unknown(text: &[u8], shown: &str) -> (&'static str, String, &'static str) {
    match text {
        [
            b'N' | b'n',
            b'0'..=b'9' | b' ' | b'\t' | b'+' | b'-' | b'.',
            ..,
        ] => (
            "misplaced-block-number",
            format!("the block number `{shown}` is not the first word of its block"),
            "write one N word a block, before all other words",
        ),
        [b'/', ..] => (
            "misplaced-block-delete",
            format!("block delete `{shown}` is not at the beginning of its block"),
            "write `/` before the first word, or right after the N word",
        ),
        [b'%', ..] => (
            "misplaced-tape-mark",
            format!("`{shown}` is not at the beginning of its line"),
            "write `%` on a line of its own",
        ),
        text if !text.is_ascii() => (
            "unknown-text",
            format!("`{shown}` is not understood"),
            "only plain ASCII characters may stand outside comments; retype the word, \
             or put the text into `( … )`",
        ),
        _ => (
            "unknown-text",
            format!("`{shown}` is not understood"),
            "a block consists of words, a letter and a number each; \
             put other text into `( … )`",
        ),
    }
}

#[cfg(test)]
mod tests {
    use insta::assert_snapshot;

    use crate::{Block, parse_line};

    /// The first issue of `line` as it is shown.
    fn shown(line: &[u8]) -> String {
        let mut block = Block::default();
        parse_line(line, false, &mut Vec::new(), &mut block);
        let diagnostic = block.issues[0].diagnostic(12, line);
        diagnostic.render("part.ngc", false)
    }

    #[test]
    fn unknown_text() {
        assert_snapshot!(shown(b"G1 X10 GOTO 5"), @r##"
        error[unknown-text]: `GOTO` is not understood
          --> part.ngc:12:8
           |
        12 | G1 X10 GOTO 5
           |        ^^^^
           |
           = help: a block consists of words, a letter and a number each; put other text into `( … )`
        "##);
    }

    #[test]
    fn text_that_is_not_ascii() {
        assert_snapshot!(shown(b"G1 X5 \xE91"), @r##"
        error[unknown-text]: `�1` is not understood
          --> part.ngc:12:7
           |
        12 | G1 X5 �1
           |       ^^
           |
           = help: only plain ASCII characters may stand outside comments; retype the word, or put the text into `( … )`
        "##);
    }

    #[test]
    fn misplaced_block_number() {
        assert_snapshot!(shown(b"G1 N20 X1"), @r##"
        error[misplaced-block-number]: the block number `N20` is not the first word of its block
          --> part.ngc:12:4
           |
        12 | G1 N20 X1
           |    ^^^
           |
           = help: write one N word a block, before all other words
        "##);
    }

    #[test]
    fn misplaced_block_delete() {
        assert_snapshot!(shown(b"G1 /2 X1"), @r##"
        error[misplaced-block-delete]: block delete `/2` is not at the beginning of its block
          --> part.ngc:12:4
           |
        12 | G1 /2 X1
           |    ^^
           |
           = help: write `/` before the first word, or right after the N word
        "##);
    }

    #[test]
    fn misplaced_tape_mark() {
        assert_snapshot!(shown(b"G1 % X1"), @r##"
        error[misplaced-tape-mark]: `%` is not at the beginning of its line
          --> part.ngc:12:4
           |
        12 | G1 % X1
           |    ^
           |
           = help: write `%` on a line of its own
        "##);
    }

    #[test]
    fn missing_number() {
        assert_snapshot!(shown(b"G1 X Y2"), @r##"
        error[missing-number]: `X` has no number after it
          --> part.ngc:12:4
           |
        12 | G1 X Y2
           |    ^
           |
           = help: write the number right after the letter, as in `X12.5`
        "##);
    }

    #[test]
    fn missing_letter() {
        assert_snapshot!(shown(b"G1 X1.2.3"), @r##"
        error[missing-letter]: the number `.3` has no letter before it
          --> part.ngc:12:8
           |
        12 | G1 X1.2.3
           |        ^^
           |
           = help: write the letter of the word, or take the blank or second point out of the number
        "##);
    }

    #[test]
    fn number_too_large() {
        assert_snapshot!(shown(format!("G1 X1{}.5", "0".repeat(400)).as_bytes()), @r##"
        error[number-too-large]: the number of `X100000000000000000000000000000000000000…` is too large
          --> part.ngc:12:4
           |
        12 | G1 X10000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000…
           |    ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^
           |
           = help: look for a lost decimal point: numbers end at about 1.8e308
        "##);
    }

    #[test]
    fn unclosed_comment() {
        assert_snapshot!(shown(b"G1 X1 (feed\r\n"), @r##"
        error[unclosed-comment]: the comment has no `)`
          --> part.ngc:12:7
           |
        12 | G1 X1 (feed
           |       ^^^^^
           |
           = help: close the comment on the same line, or begin it with `;`
        "##);
    }

    #[test]
    fn expression() {
        assert_snapshot!(shown(b"G1 X#1 Y2"), @r##"
        error[expression]: a variable or expression of this form is not supported: `X#1`
          --> part.ngc:12:4
           |
        12 | G1 X#1 Y2
           |    ^^^
           |
           = help: write the number itself, or give the profile of the control that the program is for (--dialect)
        "##);
    }

    #[test]
    fn flow() {
        assert_snapshot!(shown(b"N5 o100 sub (main)\n"), @r##"
        error[o-word-flow]: an O-word subroutine, branch or loop is not supported here: `o100 sub`
          --> part.ngc:12:4
           |
        12 | N5 o100 sub (main)
           |    ^^^^^^^^
           |
           = help: give --dialect linuxcnc if the program is for LinuxCNC; otherwise write the blocks out in the order in which they are executed
        "##);
    }
}
