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
/// `first` says that the line is the first of its file. `block` is emptied
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
                let word = scan_word(line, text, at, byte)?;
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

/// Enters the block delete at `at`; gives the offset after it.
#[cold]
fn block_delete(text: &[u8], at: usize, block: &mut Block) -> usize {
    let level = text.get(at + 1).filter(|byte| byte.is_ascii_digit());
    block.delete_level = level.map_or(1, |digit| (digit - b'0').max(1));
    let end = at + 1 + usize::from(level.is_some());
    block.words_end = end as u32;
    end
}

/// Enters the N word, which must be the first, and a block delete after it;
/// gives the offset after them.
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
/// one that is not finite. `line` is `text` with the line end.
#[inline]
fn scan_word(line: &[u8], text: &[u8], start: usize, letter: u8) -> Option<Word> {
    let number = skip_blanks(text, start + 1);
    let sign = *text.get(number)?;
    let first = if matches!(sign, b'+' | b'-') {
        skip_blanks(text, number + 1)
    } else {
        number
    };
    let Scanned { value, end } = match short_number(line, first) {
        Some(scanned) => scanned,
        None => long_number(text, first)?,
    };
    if !value.is_finite() {
        return None;
    }
    Some(Word {
        letter: letter.to_ascii_uppercase(),
        value: if sign == b'-' { -value } else { value },
        span: Span::new(start, end),
        number: Span::new(number, end),
    })
}

/// A number without its sign.
struct Scanned {
    value: f64,
    /// Offset after it.
    end: usize,
}

/// The number at `start`, of any length; `None` without digits.
fn long_number(text: &[u8], start: usize) -> Option<Scanned> {
    // Wraps only where there are too many digits, which is asked below.
    let mut mantissa = 0_u64;
    let mut end = start;
    let mut point = None;
    while let Some(&byte) = text.get(end) {
        let digit = byte.wrapping_sub(b'0');
        if digit < 10 {
            mantissa = mantissa.wrapping_mul(10).wrapping_add(u64::from(digit));
        } else if byte == b'.' && point.is_none() {
            point = Some(end + 1);
        } else {
            break;
        }
        end += 1;
    }
    let digits = end - start - usize::from(point.is_some());
    if digits == 0 {
        return None;
    }
    let decimals = point.map_or(0, |point| end - point);
    let value = match POWERS_OF_TEN.get(decimals) {
        // Both operands are exact, so the quotient is rounded once: Clinger,
        // How to Read Floating Point Numbers Accurately (1990).
        Some(power) if digits <= MAX_DIGITS && mantissa < 1 << 53 => mantissa as f64 / power,
        _ => token::value(false, text.get(start..end)?),
    };
    Some(Scanned { value, end })
}

/// The same for a number of at most eight bytes, point included, all at once.
/// `None` for others, and too near to the end of a short line.
#[inline]
fn short_number(line: &[u8], start: usize) -> Option<Scanned> {
    // The last eight bytes of the line serve for a number that is nearer to its
    // end: zeros come after it.
    let from = start.min(line.len().checked_sub(8)?);
    let bytes = line.get(from..from + 8)?.try_into().ok()?;
    let word = u64::from_le_bytes(bytes).checked_shr(8 * (start - from) as u32)?;
    // A digit's byte becomes its value; the first byte is the lowest one.
    let values = word ^ 0x3030_3030_3030_3030;
    // The highest bit of each byte that is 10 or more. A carry reaches only
    // bytes after one of 0x8A and more, which ends the number.
    let others = (values.wrapping_add(0x7676_7676_7676_7676) | values) & 0x8080_8080_8080_8080;
    let mut bytes = others.trailing_zeros() / 8;
    let (mut digits, mut decimals) = (values, 0);
    let mut count = bytes;
    if bytes < 8 && (word >> (8 * bytes)) as u8 == b'.' {
        let point = bytes;
        let before = (1_u64 << (8 * point)) - 1;
        digits = values & before | values >> 8 & !before;
        bytes = (others & (others - 1)).trailing_zeros() / 8;
        count = bytes - 1;
        decimals = (count - point) as usize;
    }
    let end = start + bytes as usize;
    if count == 0
        || bytes == 8
            && line
                .get(end)
                .is_none_or(|next| matches!(next, b'0'..=b'9' | b'.'))
    {
        return None;
    }
    // With zeros in front they are eight; pairs, fours and all are joined.
    let eight = digits << (64 - 8 * count);
    let pairs = eight.wrapping_mul(10).wrapping_add(eight >> 8);
    let low = (pairs & 0x0000_00FF_0000_00FF).wrapping_mul(0x000F_4240_0000_0064);
    let high = (pairs >> 16 & 0x0000_00FF_0000_00FF).wrapping_mul(0x0000_2710_0000_0001);
    let mantissa = low.wrapping_add(high) >> 32;
    let value = mantissa as f64 / POWERS_OF_TEN.get(decimals)?;
    Some(Scanned { value, end })
}
