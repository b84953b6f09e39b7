//! The label of a block: what others jump to.

use crate::machine::Machine;
use crate::source::Span;
use crate::syntax::Block;

/// A label with the blanks after it.
#[derive(Debug)]
pub(super) struct Label {
    /// Where it stands in its line.
    pub(super) span: Span,
    /// As it is written at the front of another line.
    pub(super) text: Vec<u8>,
    /// Another line has it.
    pub(super) is_taken: bool,
    /// It stands before the mark for block delete.
    pub(super) before_mark: bool,
}

impl Label {
    /// The block number (of the ISG kernel with its colon), the number of the program, a name with
    /// a colon or in brackets; on OSP a sequence name as well.
    pub(super) fn of(text: &[u8], block: &Block, machine: &Machine) -> Option<Self> {
        let number = block.number.map(|word| word.span);
        let start = number.map_or_else(|| front(text, block), |span| span.start as usize);
        let mut end = number.map_or(start, |span| span.end as usize);
        if number.is_some() && text.get(end) == Some(&b':') {
            end += 1;
        }
        let rest = text.get(end..)?;
        let named = after_blanks(rest);
        let name = text.get(end + named..)?;
        if names_program(block) {
            end = block.words.first()?.span.end as usize;
        } else if let Some(length) = name_with_colon(name).or_else(|| name_in_brackets(name)) {
            end += named + length;
        } else if number.is_none() && machine.controller.language.dialect.osp {
            end += sequence_name(rest)?;
        }
        if end == start {
            return None;
        }
        let mut label = text.get(start..end)?.to_vec();
        label.push(b' ');
        let blanks = after_blanks(text.get(end..)?);
        Some(Self {
            span: Span::new(start, end + blanks),
            text: label,
            is_taken: false,
            before_mark: block.delete_level > 0
                && memchr::memchr(b'/', text).is_some_and(|mark| mark > start),
        })
    }
}

/// Whether a block begins with the number of its program, which has to stay the first word.
pub(super) fn names_program(block: &Block) -> bool {
    let first = block.words.first();
    first.is_some_and(|word| word.letter == b'O')
}

/// The mark for block delete as it is written: `/`, `/0`, `/2`.
pub(super) fn delete_mark(text: &[u8]) -> &str {
    let start = memchr::memchr(b'/', text).unwrap_or(text.len());
    let mark = text.get(start..).unwrap_or_default();
    let digits = mark.iter().skip(1).take_while(|it| it.is_ascii_digit());
    let length = (1 + digits.count()).min(mark.len());
    std::str::from_utf8(mark.get(..length).unwrap_or_default()).unwrap_or_default()
}

/// Where a block without a number begins after its mark for block delete.
fn front(text: &[u8], block: &Block) -> usize {
    let bom = usize::from(text.starts_with(b"\xEF\xBB\xBF")) * 3;
    let mut at = bom + after_blanks(text.get(bom..).unwrap_or_default());
    if block.delete_level > 0 && text.get(at) == Some(&b'/') {
        at += 1;
        let digits = text.get(at..).unwrap_or_default();
        at += digits.iter().take_while(|it| it.is_ascii_digit()).count();
        at += after_blanks(text.get(at..).unwrap_or_default());
    }
    at
}

fn after_blanks(text: &[u8]) -> usize {
    text.iter()
        .take_while(|it| matches!(it, b' ' | b'\t'))
        .count()
}

/// The length of `NAME:`.
fn name_with_colon(text: &[u8]) -> Option<usize> {
    let begins = text
        .first()
        .is_some_and(|it| it.is_ascii_alphabetic() || *it == b'_');
    let length = text
        .iter()
        .take_while(|it| it.is_ascii_alphanumeric() || **it == b'_')
        .count();
    let colon = text.get(length) == Some(&b':') && text.get(length + 1) != Some(&b'=');
    (begins && colon).then_some(length + 1)
}

/// The length of `[NAME]`.
fn name_in_brackets(text: &[u8]) -> Option<usize> {
    let begins = text.first() == Some(&b'[');
    let length = memchr::memchr(b']', text)?;
    begins.then_some(length + 1)
}

/// The length of a name such as `NLOOP` (OSP programming manual, "Sequence Name").
fn sequence_name(text: &[u8]) -> Option<usize> {
    let length = text
        .iter()
        .take_while(|it| it.is_ascii_alphanumeric())
        .count();
    let own = matches!(text, [b'N' | b'n', next, ..] if next.is_ascii_alphabetic());
    own.then_some(length)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::syntax::scan_line;

    fn label(machine: &str, line: &str) -> Option<String> {
        let machine = Machine::load(machine).unwrap().0;
        let mut block = Block::default();
        scan_line(line.as_bytes(), false, &mut block);
        let found = Label::of(line.as_bytes(), &block, &machine)?;
        assert!(found.text.ends_with(b" "));
        Some(String::from_utf8(found.span.of(line.as_bytes()).to_vec()).unwrap())
    }

    #[test]
    fn labels_are_found_with_their_blanks() {
        for (line, expected) in [
            ("N10 G0 X1\n", Some("N10 ")),
            ("/N10G0 X1\n", Some("N10")),
            ("/2 N10  G0 X1\n", Some("N10  ")),
            ("G0 X1\n", None),
            ("N20 MARK_1: G0 X1\n", Some("N20 MARK_1: ")),
            ("  MARK: G0 X1\n", Some("MARK: ")),
            ("/MARK: G0 X1\n", Some("MARK: ")),
            ("X:=1\n", None),
            ("N10: G0 X1\n", Some("N10: ")),
            ("[LOOP] G0 X1\n", Some("[LOOP] ")),
            ("N10 /G0 X1\n", Some("N10 ")),
            ("O1000 G0 X1\n", Some("O1000 ")),
        ] {
            assert_eq!(label("three-axis", line).as_deref(), expected, "{line}");
        }
    }
}
