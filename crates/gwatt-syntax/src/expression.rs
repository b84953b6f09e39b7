//! Variables, expressions and O-word flow: recognised as a whole, so that the
//! message names the construct and not its bytes.

use nom::Parser;
use nom::branch::alt;
use nom::bytes::complete::{tag, take_till, take_while1};
use nom::character::complete::{alpha1, one_of, space0};
use nom::combinator::{fail, opt, peek, recognize, verify};
use nom::multi::many0_count;
use nom::sequence::{pair, preceded};

use super::token::{self, Parsed};

/// Keywords that turn an O word into flow, in lower case.
const FLOW_KEYWORDS: [&[u8]; 15] = [
    b"break",
    b"call",
    b"continue",
    b"do",
    b"else",
    b"elseif",
    b"endif",
    b"endrepeat",
    b"endsub",
    b"endwhile",
    b"if",
    b"repeat",
    b"return",
    b"sub",
    b"while",
];

/// O-word flow: `o<name> …`, `o[…] …`, `o#1 …`, `o100 sub`, to the next comment
/// or the end of the text.
pub(super) fn flow(input: &[u8]) -> Parsed<'_, &[u8]> {
    let named = peek(one_of("<[#"));
    let keyword = verify(alpha1, |name: &[u8]| {
        FLOW_KEYWORDS
            .iter()
            .any(|keyword| keyword.eq_ignore_ascii_case(name))
    });
    let numbered = preceded(pair(token::number, space0), keyword);
    let head = (
        one_of("oO"),
        space0,
        alt((named.map(drop), numbered.map(drop))),
    );
    recognize(pair(head, until_comment)).parse(input)
}

/// What stands before the next comment, blanks before it left out.
fn until_comment(input: &[u8]) -> Parsed<'_, &[u8]> {
    let (_, text) = take_till(|byte| matches!(byte, b'(' | b';')).parse(input)?;
    let length = text.trim_ascii_end().len();
    match input.split_at_checked(length) {
        Some((text, rest)) => Ok((rest, text)),
        None => fail().parse(input),
    }
}

/// A variable or an expression, with the letter before it and the operators and
/// operands after it: `#1=5`, `X#<a>`, `X[1+2]`, `sqrt[2]`, `X=AC`.
pub(super) fn expression(input: &[u8]) -> Parsed<'_, &[u8]> {
    let assigned = (
        take_while1(|byte: u8| byte.is_ascii_alphabetic()),
        space0,
        peek(tag("=")),
    );
    let lettered = (token::letter, space0, opt(pair(one_of("+-"), space0)), bare);
    let head = alt((recognize(bare), recognize(lettered), recognize(assigned)));
    recognize(pair(head, many0_count(operation))).parse(input)
}

/// An expression that needs no letter before it.
fn bare(input: &[u8]) -> Parsed<'_, &[u8]> {
    alt((
        variable,
        brackets,
        angle,
        recognize((token::name, space0, brackets)),
        tag("]"),
    ))
    .parse(input)
}

/// `#1`, `##1`, `#<name>`, `#[…]`; also `#` alone.
fn variable(input: &[u8]) -> Parsed<'_, &[u8]> {
    let of = alt((token::digits, angle, brackets));
    recognize(pair(
        take_while1(|byte| byte == b'#'),
        opt(preceded(space0, of)),
    ))
    .parse(input)
}

/// `<name>`; without its end, what stands before the next `<`.
fn angle(input: &[u8]) -> Parsed<'_, &[u8]> {
    let name = take_till(|byte| matches!(byte, b'<' | b'>'));
    recognize((tag("<"), name, opt(tag(">")))).parse(input)
}

/// `[…]` to the matching bracket; without one, to the end of the text.
fn brackets(input: &[u8]) -> Parsed<'_, &[u8]> {
    let mut depth = 0_usize;
    let end = input.iter().position(|byte| {
        match byte {
            b'[' => depth += 1,
            b']' => depth = depth.saturating_sub(1),
            _ => {}
        }
        depth == 0
    });
    let length = end.map_or(input.len(), |end| end + 1);
    match input.split_at_checked(length) {
        Some((text @ [b'[', ..], rest)) => Ok((rest, text)),
        _ => fail().parse(input),
    }
}

/// An operator and, where there is one, its operand: `=5`, `+ #2`, `*[3]`.
fn operation(input: &[u8]) -> Parsed<'_, &[u8]> {
    let operand = alt((bare, token::digits, token::name_bytes));
    recognize((space0, one_of("=+-*/"), opt(preceded(space0, operand)))).parse(input)
}
