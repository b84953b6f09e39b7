//! Numbers and words in the style of the block around them.

use crate::interpret::Feed;
use crate::machine::{Family, LowerOf};
use crate::source::Span;
use crate::syntax::Block;

/// Decimals of a coordinate: finer than any control takes.
const DECIMALS: f64 = 1e6;
const FINE_DECIMALS: f64 = 1e10;

/// By how much [`at_most`] nests brackets deeper.
const DEPTH: usize = 3;

/// How a block is written.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Style {
    /// Words are separated by blanks.
    pub(super) spaced: bool,
    /// Letters are small.
    pub(super) lower: bool,
}

impl Style {
    /// The style of a block; blanks where it has too few words to show one.
    pub(super) fn of(text: &[u8], block: &Block) -> Self {
        let first = block
            .number
            .iter()
            .chain(&block.words)
            .map(|word| word.span)
            .next();
        let start = first.map_or(0, |span| span.start as usize);
        let words = text
            .get(start..block.words_end as usize)
            .unwrap_or_default();
        let single = block.words.len() + usize::from(block.number.is_some()) < 2;
        Self {
            // After the name of a variable (X=R1) a word needs one.
            spaced: single || words.iter().any(|byte| matches!(byte, b' ' | b'\t' | b'=')),
            lower: words.first().is_some_and(u8::is_ascii_lowercase),
        }
    }

    /// A letter in the style of the block.
    pub(super) fn letter(self, letter: u8) -> u8 {
        if self.lower {
            letter.to_ascii_lowercase()
        } else {
            letter
        }
    }
}

/// A number as decimals, never with an exponent; `point`: with a decimal point
/// even when it is whole.
pub(super) fn decimal(value: f64, point: bool) -> String {
    let mut text = value.to_string();
    if point && !text.contains('.') {
        text.push('.');
    }
    text
}

/// An expression of the program with a value that it does not exceed, where the language can
/// say that.
pub(super) fn at_most(family: Family, expression: &[u8], most: f64) -> Option<String> {
    let expression = std::str::from_utf8(expression).ok()?.trim();
    let most = decimal(most, true);
    match family.facts().lower_of {
        LowerOf::Brackets(deepest) if depth(expression) + DEPTH > deepest => None,
        // The lower of a and b is (a + b - |a - b|) / 2.
        LowerOf::Brackets(_) => Some(format!(
            "[[{expression}+{most}-ABS[{expression}-{most}]]/2]"
        )),
        LowerOf::Function { open, close } => Some(format!("{open}{expression},{most}{close}")),
        LowerOf::None => None,
    }
}

/// Whether a language can say that an expression does not exceed a value.
pub(crate) fn has_at_most(family: Family, expression: &[u8]) -> bool {
    at_most(family, expression, 0.0).is_some()
}

/// How deep brackets are nested.
fn depth(expression: &str) -> usize {
    let mut open = 0_usize;
    let mut deepest = 0;
    for byte in expression.bytes() {
        match byte {
            b'[' => open += 1,
            b']' => open = open.saturating_sub(1),
            _ => {}
        }
        deepest = deepest.max(open);
    }
    deepest
}

/// True for a number that was written with a decimal point.
pub(super) fn has_point(text: &[u8]) -> bool {
    text.contains(&b'.')
}

/// The text that puts a feed back in force under another or the same unit.
pub(super) fn feed_again(feed: &Feed, mm_per_unit: f64) -> String {
    let text = feed.text.as_bytes();
    if feed.mm_per_unit == mm_per_unit && !text.is_empty() {
        let text = String::from_utf8_lossy(text);
        if text.contains(char::is_alphabetic) {
            // What it is worked out from.
            return text.into_owned();
        }
        return text.chars().filter(|c| !c.is_whitespace()).collect();
    }
    let value = feed.value * feed.mm_per_unit / mm_per_unit;
    // Down in the twelfth digit: a feed never goes up.
    let scale = libm::pow(
        10.0,
        (11.0 - libm::floor(libm::log10(value))).clamp(0.0, 15.0),
    )
    .round();
    decimal((value * scale).floor() / scale, has_point(text))
}

/// A number like `0`, `00` or `0.` with its last digit before the point set.
pub(super) fn with_digit(number: &[u8], digit: u8) -> Vec<u8> {
    let mut text = number.to_vec();
    let whole = text
        .iter()
        .position(|byte| *byte == b'.')
        .unwrap_or(text.len());
    match text
        .get_mut(..whole)
        .and_then(|digits| digits.iter_mut().rev().find(|byte| byte.is_ascii_digit()))
    {
        Some(last) => *last = digit,
        None => text.insert(whole, digit),
    }
    text
}

/// A coordinate as it is written, finer than any control takes.
pub(super) fn rounded(value: f64) -> f64 {
    rounded_to(DECIMALS, value)
}

/// The same where later blocks work out their places from it.
pub(super) fn rounded_finely(value: f64) -> f64 {
    rounded_to(FINE_DECIMALS, value)
}

fn rounded_to(decimals: f64, value: f64) -> f64 {
    let rounded = (value * decimals).round() / decimals;
    // No -0.
    if rounded == 0.0 { 0.0 } else { rounded }
}

/// A word with the blanks before it.
pub(super) fn with_blanks(text: &[u8], word: Span) -> Span {
    let before = text.get(..word.start as usize).unwrap_or_default();
    let blanks = before
        .iter()
        .rev()
        .take_while(|byte| matches!(byte, b' ' | b'\t'));
    Span {
        start: word.start - blanks.count() as u32,
        end: word.end,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interpret::NumberText;

    #[test]
    fn decimals_keep_the_point() {
        assert_eq!(decimal(83.333, false), "83.333");
        assert_eq!(decimal(800.0, false), "800");
        assert_eq!(decimal(800.0, true), "800.");
        assert_eq!(decimal(1e21, false), "1000000000000000000000");
        assert_eq!(decimal(1e-7, false), "0.0000001");
    }

    #[test]
    fn motion_digits() {
        assert_eq!(with_digit(b"0", b'1'), b"1");
        assert_eq!(with_digit(b"00", b'1'), b"01");
        assert_eq!(with_digit(b"0.", b'1'), b"1.");
        assert_eq!(with_digit(b"0.0", b'1'), b"1.0");
        assert_eq!(with_digit(b".0", b'1'), b"1.0");
    }

    #[test]
    fn a_feed_comes_back_as_it_was_written() {
        let feed = Feed {
            value: 1000.0,
            mm_per_unit: 1.0,
            text: NumberText::new(b"1000."),
            expression: NumberText::default(),
        };
        assert_eq!(feed_again(&feed, 1.0), "1000.");
        assert_eq!(feed_again(&feed, 25.4), "39.3700787401");
    }
}
