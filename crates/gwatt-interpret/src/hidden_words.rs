//! Comments that are none for the control: words after a `;` where that ends a block are
//! another block of the same line, and firmware of printers may know no parentheses.

use super::control::Control;
use super::report::Report;
use gwatt_syntax::source::Span;
use gwatt_syntax::{Block, Word};

impl Control<'_> {
    /// Whether a comment of the block may be none for the control.
    #[inline]
    pub(super) fn may_hide_words(&self, text: &[u8], block: &Block) -> bool {
        let language = &self.machine.controller.language;
        if self.rules.words_in_parentheses {
            return memchr::memchr(b'(', text).is_some();
        }
        block.words_end != block.text_end && language.dialect.semicolon_ends_block
    }

    /// Whether words stand in it that the control would execute, which is an error.
    #[cold]
    pub(super) fn refuses_hidden_words(&self, block: &Block, report: &mut Report<'_, '_>) -> bool {
        let text = report.text;
        if !self.may_hide_words(text, block) {
            return false;
        }
        if self.rules.words_in_parentheses {
            let moves = |word: &Word| word.letter == b'G' && (0.0..4.0).contains(&word.value);
            let words =
                words_in_parentheses(text).filter(|_| block.words.first().is_some_and(moves));
            let Some(span) = words else {
                return false;
            };
            let message = "not all firmware takes words in parentheses for a comment";
            let error = report.error("unknown-text", message, span);
            error.help("write comments after a `;`");
            return true;
        }
        let Some(span) = second_block(text, block) else {
            return false;
        };
        report
            .error(
                "second-block",
                "`;` ends a block on this control, and another one follows on the same line",
                span,
            )
            .help("write each block on a line of its own, and comments in `( … )`");
        true
    }
}

/// Where a letter with a number stands in parentheses before a `;`.
fn words_in_parentheses(text: &[u8]) -> Option<Span> {
    let end = memchr::memchr(b';', text).unwrap_or(text.len());
    let (mut start, mut before) = (None, b' ');
    for (at, byte) in text.get(..end)?.iter().enumerate() {
        match byte {
            b'(' => start = start.or(Some(at)),
            b')' => start = None,
            _ => {}
        }
        let number = byte.is_ascii_digit() || matches!(byte, b'+' | b'-' | b'.');
        if let Some(start) = start
            && number
            && before.is_ascii_alphabetic()
        {
            return Some(Span::new(start, at + 1));
        }
        before = *byte;
    }
    None
}

/// Where words stand after a `;`.
fn second_block(text: &[u8], block: &Block) -> Option<Span> {
    let text = text.get(..block.text_end as usize)?;
    let (mut depth, mut ended) = (0_u32, false);
    for (at, byte) in text.iter().enumerate().skip(block.words_end as usize) {
        match byte {
            b'(' => depth += 1,
            b')' => depth = depth.saturating_sub(1),
            _ if depth > 0 => {}
            b';' => ended = true,
            b' ' | b'\t' => {}
            _ if ended => {
                let rest = text.get(at..)?;
                return begins_block(rest).then(|| Span::new(at, text.len()));
            }
            _ => {}
        }
    }
    None
}

/// Whether a text begins as a block does: with a word, a variable or a block delete.
fn begins_block(text: &[u8]) -> bool {
    let [first, rest @ ..] = text else {
        return false;
    };
    let next = rest.iter().find(|byte| !matches!(byte, b' ' | b'\t'));
    let number = next.is_some_and(|byte| {
        byte.is_ascii_digit() || matches!(byte, b'+' | b'-' | b'.' | b'#' | b'[')
    });
    let keyword = [&b"IF["[..], b"WHILE[", b"GOTO"];
    let keyword = keyword.iter().any(|word| {
        let start = text.get(..word.len());
        start.is_some_and(|start| start.eq_ignore_ascii_case(word))
    });
    keyword || number && (first.is_ascii_alphabetic() || matches!(first, b'#' | b'/'))
}

#[cfg(test)]
mod tests {
    use super::*;
    use gwatt_syntax::scan_line;

    fn found(line: &str) -> Option<&str> {
        let mut block = Block::default();
        scan_line(line.as_bytes(), false, &mut block);
        let span = second_block(line.as_bytes(), &block)?;
        line.get(span.start as usize..span.end as usize)
    }

    #[test]
    fn words_are_no_comment() {
        assert_eq!(found("G0 X1.; G0 X500.;\n"), Some("G0 X500.;"));
        assert_eq!(found("G0 X1.;;X500.\n"), Some("X500."));
        assert_eq!(found("; #100=5.\n"), Some("#100=5."));
        assert_eq!(found("G0 X1. (a;b) ; (T1) GOTO 10\n"), Some("GOTO 10"));
        for line in [
            "G0 X1.;\n",
            "G0 X1. ; drill\n",
            "G0 X1. (a; X500.)\n",
            "; -- 5 --\n",
        ] {
            assert_eq!(found(line), None, "{line}");
        }
    }
}
