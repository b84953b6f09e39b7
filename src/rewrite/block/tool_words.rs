//! Words that leave their block: those that select and change the tool.

use std::fmt::Write as _;

use crate::interpret::ToolWords;
use crate::rewrite::number::with_blanks;
use crate::source::Span;
use crate::syntax::Block;

/// The words that select and change the tool, on a line of their own.
pub(super) fn tool_line(words: &ToolWords, text: &[u8]) -> String {
    let mut line = String::new();
    for word in words.spans() {
        let gap = if line.is_empty() { "" } else { " " };
        let _ = write!(line, "{gap}{}", String::from_utf8_lossy(word.of(text)));
    }
    line
}

/// The words that select and change the tool with the blanks that go with them; in one where
/// both stand first.
pub(super) fn without_tool(words: &ToolWords, text: &[u8], block: &Block) -> [Option<Span>; 2] {
    let change = words.change;
    let Some(tool) = words.select else {
        return [Some(without(change, text, block)), None];
    };
    let (one, other) = if tool.start < change.start {
        (tool, change)
    } else {
        (change, tool)
    };
    let gone = without(one, text, block);
    if gone.end < other.start || gone.start < one.start {
        return [Some(gone), Some(without(other, text, block))];
    }
    let after = text.get(other.end as usize..).unwrap_or_default();
    let blanks = after.iter().take_while(|byte| matches!(byte, b' ' | b'\t'));
    let end = other.end + blanks.count() as u32;
    [Some(Span { end, ..gone }), None]
}

/// A word with the blanks that go with it.
pub(super) fn without(word: Span, text: &[u8], block: &Block) -> Span {
    let first = block.words.first().map(|first| first.span);
    if first != Some(word) {
        return with_blanks(text, word);
    }
    let after = text.get(word.end as usize..).unwrap_or_default();
    let blanks = after.iter().take_while(|byte| matches!(byte, b' ' | b'\t'));
    Span {
        end: word.end + blanks.count() as u32,
        ..word
    }
}
