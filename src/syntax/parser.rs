//! The grammar of a line: bytes to pieces and a block, in nom.
//!
//! Every byte lands in exactly one piece. The items stand in order of
//! precedence in [`item`]; what none of them takes is unknown text up to the
//! next blank or word.

use nom::Parser;
use nom::branch::alt;
use nom::bytes::complete::{is_a, tag, take, take_while};
use nom::character::complete::space1;
use nom::combinator::{cond, fail, not, recognize, rest};
use nom::multi::many0_count;
use nom::sequence::{pair, preceded};

use super::expression::{expression, flow};
use super::token::{self, Parsed, WordText};
use super::{Block, Issue, IssueKind, MAX_ISSUES, Piece, PieceKind, Word};
use crate::source::{Span, split_line_end};

const BYTE_ORDER_MARK: &[u8] = b"\xEF\xBB\xBF";

/// Reads one line, its line end included, into its pieces and its block.
///
/// `first` tells that the line is the first of its file, where a byte order
/// mark may stand. `pieces` and `block` are emptied before. The pieces follow
/// one another without gaps and cover the line. The text of a line must be
/// shorter than 4 GiB.
pub fn parse_line(line: &[u8], first: bool, pieces: &mut Vec<Piece>, block: &mut Block) {
    pieces.clear();
    parse_block(line, first, block, |piece| pieces.push(piece));
}

/// As [`parse_line`], the pieces given away one by one.
pub(super) fn parse_block(
    line: &[u8],
    first: bool,
    block: &mut Block,
    mut emit: impl FnMut(Piece),
) {
    block.clear();
    let (text, line_end) = split_line_end(line);
    block.text_end = text.len() as u32;
    let mut place = Place::Beginning;
    let mut at = 0;
    if first && text.starts_with(BYTE_ORDER_MARK) {
        at = BYTE_ORDER_MARK.len();
        block.words_end = at as u32;
        emit(piece(PieceKind::ByteOrderMark, 0, at));
    }
    while let Some(input) = text.get(at..).filter(|input| !input.is_empty()) {
        // Some item takes every byte; were there a gap, the text is unknown.
        let (left, item) = item(input, place)
            .ok()
            .filter(|(left, _)| left.len() < input.len())
            .unwrap_or((&[], Item::Fault(IssueKind::UnknownText)));
        let end = text.len() - left.len();
        let kind = take_item(&item, Span::new(at, end), &mut place, block);
        emit(piece(kind, at, end));
        at = end;
    }
    if !line_end.is_empty() {
        emit(piece(PieceKind::LineEnd, text.len(), line.len()));
    }
}

fn piece(kind: PieceKind, start: usize, end: usize) -> Piece {
    let span = Span::new(start, end);
    Piece { kind, span }
}

/// How far a line has come; it decides what `%`, `/` and N mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Place {
    /// Nothing but blanks so far.
    Beginning,
    /// Block delete or comments, and no word so far.
    BeforeWords,
    /// Right behind the N word.
    BehindNumber,
    /// Anywhere else.
    Inside,
}

/// What stands at one place of a line.
#[derive(Debug, Clone)]
enum Item<'a> {
    /// Something without meaning for the block.
    Plain(PieceKind),
    /// `/` with its level.
    Delete(u8),
    Word(WordText<'a>),
    Fault(IssueKind),
}

/// One item from the front of `input`.
fn item(input: &[u8], place: Place) -> Parsed<'_, Item<'_>> {
    use IssueKind::{Expression, Flow, MissingLetter, MissingNumber, UnclosedComment, UnknownText};
    let tape = place == Place::Beginning;
    let delete = matches!(place, Place::Beginning | Place::BehindNumber);
    alt((
        space1.map(|_| Item::Plain(PieceKind::Blank)),
        preceded(enabled(tape), pair(tag("%"), rest)).map(|_| Item::Plain(PieceKind::Tape)),
        preceded(enabled(delete), token::block_delete).map(Item::Delete),
        pair(tag(";"), rest).map(|_| Item::Plain(PieceKind::LineComment)),
        token::comment.map(|_| Item::Plain(PieceKind::Comment)),
        pair(tag("("), rest).map(|_| Item::Fault(UnclosedComment)),
        flow.map(|_| Item::Fault(Flow)),
        token::word.map(Item::Word),
        expression.map(|_| Item::Fault(Expression)),
        token::number.map(|_| Item::Fault(MissingLetter)),
        lone_letter.map(|_| Item::Fault(MissingNumber)),
        unknown.map(|_| Item::Fault(UnknownText)),
    ))
    .parse(input)
}

/// Takes nothing where `yes`; fails otherwise.
fn enabled<'a>(
    yes: bool,
) -> impl Parser<&'a [u8], Output = Option<()>, Error = nom::error::Error<&'a [u8]>> {
    cond(!yes, fail())
}

/// A letter without a number, with what is left of a number behind it.
fn lone_letter(input: &[u8]) -> Parsed<'_, &[u8]> {
    let remains = take_while(|byte| matches!(byte, b'+' | b'-' | b'.'));
    recognize((not(token::name), token::letter, remains)).parse(input)
}

/// A run that begins nothing known, to the next blank, comment, expression or
/// word.
fn unknown(input: &[u8]) -> Parsed<'_, &[u8]> {
    let boundary = alt((is_a(" \t(;#[]<"), recognize(token::word)));
    recognize(pair(
        unknown_part,
        many0_count(preceded(not(boundary), unknown_part)),
    ))
    .parse(input)
}

/// A name, a text in quotes, or any byte.
fn unknown_part(input: &[u8]) -> Parsed<'_, &[u8]> {
    alt((token::name, token::quoted, take(1_usize))).parse(input)
}

/// Enters an item into the block; gives the kind of its piece.
fn take_item(item: &Item<'_>, span: Span, place: &mut Place, block: &mut Block) -> PieceKind {
    match item {
        Item::Plain(kind) => {
            take_plain(*kind, place, block);
            *kind
        }
        Item::Delete(level) => {
            *place = match *place {
                Place::Beginning => Place::BeforeWords,
                _ => Place::Inside,
            };
            // `/N10/2`: the second is not in its place.
            if block.delete_level > 0 {
                return fault(IssueKind::UnknownText, span, block);
            }
            block.delete_level = *level;
            block.words_end = span.end;
            PieceKind::BlockDelete
        }
        Item::Word(word) => take_word(*word, span, place, block),
        Item::Fault(kind) => {
            *place = Place::Inside;
            fault(*kind, span, block)
        }
    }
}

/// Enters what is neither a word nor a fault.
fn take_plain(kind: PieceKind, place: &mut Place, block: &mut Block) {
    match (kind, *place) {
        (PieceKind::Blank, _) => {}
        (PieceKind::Tape, _) => block.tape = true,
        (_, Place::Beginning) => *place = Place::BeforeWords,
        (_, Place::BehindNumber) => *place = Place::Inside,
        _ => {}
    }
}

/// Enters a word; one that has no value or no right to be there is a fault.
fn take_word(text: WordText<'_>, span: Span, place: &mut Place, block: &mut Block) -> PieceKind {
    let before = *place;
    *place = Place::Inside;
    if !text.value.is_finite() {
        return fault(IssueKind::NotFinite, span, block);
    }
    let word = Word {
        letter: text.letter.to_ascii_uppercase(),
        value: text.value,
        span,
        number: Span {
            start: span.end - text.number.len() as u32,
            end: span.end,
        },
    };
    match (word.letter, before) {
        (b'N', Place::Beginning | Place::BeforeWords) => {
            block.number = Some(word);
            *place = Place::BehindNumber;
        }
        (b'N', _) => return fault(IssueKind::UnknownText, span, block),
        _ => block.words.push(word),
    }
    block.words_end = span.end;
    PieceKind::Word
}

fn fault(kind: IssueKind, span: Span, block: &mut Block) -> PieceKind {
    if block.issues.len() < MAX_ISSUES {
        block.issues.push(Issue { kind, span });
    }
    PieceKind::Unknown
}
