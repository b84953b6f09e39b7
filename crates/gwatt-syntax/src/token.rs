//! The smallest parts of a line, as nom parsers over bytes.
//!
//! Each takes the rest of a line without its line end, and none looks at a byte
//! more than a fixed number of times, so that a long line of garbage costs no
//! more than its length.

use nom::branch::alt;
use nom::bytes::complete::{is_not, tag, take_while, take_while_m_n, take_while1};
use nom::character::complete::{digit0, digit1, one_of, space0};
use nom::combinator::{consumed, fail, opt, recognize};
use nom::sequence::{delimited, pair, preceded, terminated};
use nom::{IResult, Parser};

/// Result of a parser over bytes.
pub(super) type Parsed<'a, T> = IResult<&'a [u8], T>;

/// Where the letter of a word may stand: a letter or one of `= * @ ^`.
pub(super) fn is_letter(byte: u8) -> bool {
    byte.is_ascii_alphabetic() || matches!(byte, b'=' | b'*' | b'@' | b'^')
}

/// True for the bytes of a name after its first.
fn is_name(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || byte == b'_'
}

/// Digits with at most one point; at least one digit.
pub(super) fn digits(input: &[u8]) -> Parsed<'_, &[u8]> {
    recognize(alt((
        recognize((digit1, opt((tag("."), digit0)))),
        recognize((tag("."), digit1)),
    )))
    .parse(input)
}

/// A number: sign, blanks and digits; gives the sign and the digits.
pub(super) fn number(input: &[u8]) -> Parsed<'_, (Option<char>, &[u8])> {
    pair(opt(terminated(one_of("+-"), space0)), digits).parse(input)
}

/// A number as it stands in the text, with its value.
#[derive(Debug, Clone, Copy)]
pub(super) struct WordText<'a> {
    /// The letter as written.
    pub(super) letter: u8,
    /// The number as written, sign included.
    pub(super) number: &'a [u8],
    /// Its value; infinite where f64 ends.
    pub(super) value: f64,
}

/// A letter, blanks and a number.
pub(super) fn word(input: &[u8]) -> Parsed<'_, WordText<'_>> {
    let (rest, (letter, (text, (sign, digits)))) =
        pair(terminated(letter, space0), consumed(number)).parse(input)?;
    let word = WordText {
        letter: letter.first().copied().unwrap_or_default(),
        number: text,
        value: value(sign == Some('-'), digits),
    };
    Ok((rest, word))
}

/// Whether a word is next.
pub(super) fn is_word(input: &[u8]) -> bool {
    (letter, space0, number).parse(input).is_ok()
}

/// The value of digits with at most one point, correctly rounded.
pub(super) fn value(negative: bool, digits: &[u8]) -> f64 {
    // Digits and a point are always text that the standard library reads.
    let value = std::str::from_utf8(digits)
        .ok()
        .and_then(|text| text.parse().ok())
        .unwrap_or(f64::INFINITY);
    if negative { -value } else { value }
}

/// The letter of a word.
pub(super) fn letter(input: &[u8]) -> Parsed<'_, &[u8]> {
    take_while_m_n(1, 1, is_letter).parse(input)
}

/// A name of two bytes or more, as `GOTO`, `SET_LIMIT` or `R_1`: a letter with
/// a letter or an underscore right after it; or anything after an underscore.
pub(super) fn name(input: &[u8]) -> Parsed<'_, &[u8]> {
    let begins = match input {
        [b'_', ..] => true,
        [first, second, ..] => {
            first.is_ascii_alphabetic() && (second.is_ascii_alphabetic() || *second == b'_')
        }
        _ => false,
    };
    // Looked at first: to read a run only to refuse it would be paid again for
    // each of its bytes.
    if begins {
        name_bytes(input)
    } else {
        fail().parse(input)
    }
}

/// Any run of letters, digits and underscores.
pub(super) fn name_bytes(input: &[u8]) -> Parsed<'_, &[u8]> {
    take_while1(is_name).parse(input)
}

/// `( … )` to the first closing parenthesis.
pub(super) fn comment(input: &[u8]) -> Parsed<'_, &[u8]> {
    recognize(delimited(
        tag("("),
        take_while(|byte| byte != b')'),
        tag(")"),
    ))
    .parse(input)
}

/// `"…"` with both quotes.
pub(super) fn quoted(input: &[u8]) -> Parsed<'_, &[u8]> {
    recognize(delimited(tag("\""), opt(is_not("\"")), tag("\""))).parse(input)
}

/// `/` with its level: the digit right after it, 1 without one and for `/0`.
pub(super) fn block_delete(input: &[u8]) -> Parsed<'_, u8> {
    let digit = take_while_m_n(1, 1, |byte: u8| byte.is_ascii_digit());
    let (rest, level) = preceded(tag("/"), opt(digit)).parse(input)?;
    let level = level.and_then(|digit: &[u8]| Some(digit.first()? - b'0'));
    Ok((rest, level.unwrap_or(1).max(1)))
}
