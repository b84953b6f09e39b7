//! The hot path: lines of plain words, read by hand in one pass.
//!
//! Nearly every line of a program is blanks, an N word, words and comments.
//! This scanner reads those and gives up on anything else, which then goes
//! through the grammar; `tests/syntax.rs` holds the two equal.

use memchr::memchr;

use super::parser::parse_block;
use super::{Block, Word, token};
use crate::source::{Span, split_line_end};

/// Reads one line, its line end included, into its block: the same block as
/// [`super::parse_line`] gives, many times faster for lines of plain words.
///
/// `first` tells that the line is the first of its file. `block` is emptied
/// before; nothing is allocated once its buffers have grown.
pub fn scan_line(line: &[u8], first: bool, block: &mut Block) {
    if scan_words(line, block).is_none() {
        parse_block(line, first, block, |_| {});
    }
}

/// Powers of ten that f64 holds exactly.
const POWERS_OF_TEN: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16,
    1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
];

/// Digits that a u64 takes without overflow.
const MAX_DIGITS: usize = 19;

/// Reads a line of plain words; `None` when it holds anything else.
///
/// What makes an O word flow, a keyword or a bracket, is no plain word, so O
/// needs no care here.
fn scan_words(line: &[u8], block: &mut Block) -> Option<()> {
    block.clear();
    let (text, _) = split_line_end(line);
    block.text_end = text.len() as u32;
    let mut at = skip_blanks(text, 0);
    if text.get(at) == Some(&b'/') {
        at = skip_blanks(text, block_delete(text, at, block));
    }
    while let Some(&byte) = text.get(at) {
        match byte {
            b' ' | b'\t' => at += 1,
            b'(' => at += memchr(b')', text.get(at..)?)? + 1,
            b';' => break,
            _ if token::is_letter(byte) => {
                let word = scan_word(text, at, byte)?;
                at = word.span.end as usize;
                if word.letter == b'N' {
                    at = block_number(text, word, block)?;
                } else {
                    block.words_end = word.span.end;
                    block.words.push(word);
                }
            }
            _ => return None,
        }
    }
    Some(())
}

/// Offset of the first byte from `at` on that is no blank.
#[inline]
fn skip_blanks(text: &[u8], mut at: usize) -> usize {
    while matches!(text.get(at), Some(b' ' | b'\t')) {
        at += 1;
    }
    at
}

/// Enters the block delete at `at`; gives the offset behind it.
#[cold]
fn block_delete(text: &[u8], at: usize, block: &mut Block) -> usize {
    let level = text.get(at + 1).filter(|byte| byte.is_ascii_digit());
    block.delete_level = level.map_or(1, |digit| (digit - b'0').max(1));
    let end = at + 1 + usize::from(level.is_some());
    block.words_end = end as u32;
    end
}

/// Enters the N word, which must be the first, and a block delete behind it;
/// gives the offset behind them.
fn block_number(text: &[u8], word: Word, block: &mut Block) -> Option<usize> {
    if block.number.is_some() || !block.words.is_empty() {
        return None;
    }
    block.words_end = word.span.end;
    block.number = Some(word);
    let at = skip_blanks(text, word.span.end as usize);
    match text.get(at) {
        Some(b'/') if block.delete_level == 0 => Some(block_delete(text, at, block)),
        _ => Some(at),
    }
}

/// The word whose letter stands at `start`; `None` without a number, and for
/// one that is not finite.
#[inline]
fn scan_word(text: &[u8], start: usize, letter: u8) -> Option<Word> {
    let number = skip_blanks(text, start + 1);
    let sign = *text.get(number)?;
    let first = if matches!(sign, b'+' | b'-') {
        skip_blanks(text, number + 1)
    } else {
        number
    };
    let Digits {
        mantissa,
        decimals,
        length,
    } = match eight_bytes(text, first).and_then(|bytes| few_digits(text, first, bytes)) {
        Some(digits) => digits,
        None => many_digits(text, first)?,
    };
    let at = first + length;
    // Both operands are exact, so the quotient is rounded once: Clinger,
    // How to Read Floating Point Numbers Accurately (1990).
    let value = match POWERS_OF_TEN.get(decimals) {
        Some(power) if mantissa < 1 << 53 => mantissa.cast_signed() as f64 / power,
        _ => finite_value(text.get(first..at)?)?,
    };
    Some(Word {
        letter: letter.to_ascii_uppercase(),
        value: if sign == b'-' { -value } else { value },
        span: Span::new(start, at),
        number: Span::new(number, at),
    })
}

/// What a number consists of.
struct Digits {
    /// All digits without the point; `u64::MAX` where there are too many.
    mantissa: u64,
    /// Digits behind the point.
    decimals: usize,
    /// Bytes of digits and point.
    length: usize,
}

/// Eight bytes from `at` on, the first one lowest; what lies behind the text
/// is 0. `None` for texts of less than eight bytes.
#[inline]
fn eight_bytes(text: &[u8], at: usize) -> Option<u64> {
    if let Some(bytes) = text.get(at..)?.first_chunk() {
        return Some(u64::from_le_bytes(*bytes));
    }
    let behind = at + 8 - text.len();
    let bytes = u64::from_le_bytes(*text.last_chunk()?);
    Some(bytes.checked_shr(8 * behind as u32).unwrap_or(0))
}

/// Digits that end within `bytes`, which begin at `at`: all eight are looked
/// at in one go.
#[inline]
fn few_digits(text: &[u8], at: usize, bytes: u64) -> Option<Digits> {
    let whole = leading_digits(bytes);
    let (digits, count, length) = if whole < 8 && bytes >> (8 * whole) & 0xff == u64::from(b'.') {
        // The point is taken out; a 0, no digit, moves up at the end.
        let before = (1 << (8 * whole)) - 1;
        let digits = bytes & before | bytes >> 8 & !before;
        let count = leading_digits(digits);
        (digits, count, count + 1)
    } else {
        (bytes, whole, whole)
    };
    let goes_on = || matches!(text.get(at + 8), Some(b'0'..=b'9' | b'.'));
    if count == 0 || length == 8 && goes_on() {
        return None;
    }
    Some(Digits {
        mantissa: number_of(digits << (8 * (8 - count))),
        decimals: (count - whole) as usize,
        length: length as usize,
    })
}

/// How many of eight bytes, from the lowest on, are digits.
#[inline]
fn leading_digits(bytes: u64) -> u32 {
    const ZEROS: u64 = u64::from_le_bytes([b'0'; 8]);
    const ABOVE_NINE: u64 = u64::from_le_bytes([0x80 - 10; 8]);
    const TOP_BITS: u64 = u64::from_le_bytes([0x80; 8]);
    // A byte that is no digit is 10 or more in `digits`; what it carries over
    // changes only bytes behind it.
    let digits = bytes ^ ZEROS;
    ((digits.wrapping_add(ABOVE_NINE) | digits) & TOP_BITS).trailing_zeros() / 8
}

/// The number that eight digits make, the lowest byte first; bytes of 0 count
/// as the digit 0.
#[inline]
fn number_of(digits: u64) -> u64 {
    // Neighbours are put together: ones to tens, pairs to fours, fours to all.
    let ones = digits & u64::from_le_bytes([0x0f; 8]);
    let pairs = (ones.wrapping_mul(10) + (ones >> 8)) & 0x00ff_00ff_00ff_00ff;
    let fours = (pairs.wrapping_mul(100) + (pairs >> 16)) & 0x0000_ffff_0000_ffff;
    (fours.wrapping_mul(10_000) + (fours >> 32)) & 0xffff_ffff
}

/// Any digits, one by one.
fn many_digits(text: &[u8], first: usize) -> Option<Digits> {
    // Wraps only where there are too many digits, which is asked below.
    let mut mantissa = 0_u64;
    let mut at = first;
    while let Some(digit) = digit(text, at) {
        mantissa = mantissa.wrapping_mul(10).wrapping_add(digit);
        at += 1;
    }
    let mut digits = at - first;
    let mut decimals = 0;
    if text.get(at) == Some(&b'.') {
        at += 1;
        let point = at;
        while let Some(digit) = digit(text, at) {
            mantissa = mantissa.wrapping_mul(10).wrapping_add(digit);
            at += 1;
        }
        decimals = at - point;
        digits += decimals;
    }
    (digits > 0).then_some(Digits {
        mantissa: if digits <= MAX_DIGITS {
            mantissa
        } else {
            u64::MAX
        },
        decimals,
        length: at - first,
    })
}

/// The value of many digits, if it is finite.
#[cold]
fn finite_value(digits: &[u8]) -> Option<f64> {
    Some(token::value(false, digits)).filter(|value| value.is_finite())
}

/// The digit at `at`.
#[inline]
fn digit(text: &[u8], at: usize) -> Option<u64> {
    let digit = text.get(at)?.wrapping_sub(b'0');
    (digit < 10).then_some(u64::from(digit))
}
