//! The grammar of a line: bytes to pieces and a block, in nom.
//!
//! Every byte lands in exactly one piece; what no item of [`item`] takes is
//! unknown text up to the next blank or word.

use nom::Parser;
use nom::branch::alt;
use nom::bytes::complete::{take, take_while};
use nom::character::complete::space1;
use nom::combinator::{not, peek, recognize, rest, verify};
use nom::multi::many0_count;
use nom::sequence::{pair, preceded};

use super::expression::{expression, flow};
use super::token::{self, Parsed, WordText};
use super::{Block, Issue, IssueKind, MAX_ISSUES, Piece, PieceKind, Word};
use crate::source::{Span, split_line_end};

const BYTE_ORDER_MARK: &[u8] = b"\xEF\xBB\xBF";

/// Reads one line, its line end included, into its pieces and its block.
///
/// `first` says that the line is the first of its file, where a byte order
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
    /// Right after the N word.
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

/// One item from the front of `input`. Its first byte says which may be there, so that not all of
/// them are tried at each place of a line.
fn item(input: &[u8], place: Place) -> Parsed<'_, Item<'_>> {
    use IssueKind::{Expression, Flow, MissingLetter, MissingNumber, UnclosedComment, UnknownText};
    let tape = place == Place::Beginning;
    let delete = matches!(place, Place::Beginning | Place::BehindNumber);
    match input {
        [b' ' | b'\t', ..] => space1.map(|_| Item::Plain(PieceKind::Blank)).parse(input),
        [b'%', ..] if tape => rest.map(|_| Item::Plain(PieceKind::Tape)).parse(input),
        [b'/', ..] if delete => token::block_delete.map(Item::Delete).parse(input),
        [b';', ..] => rest
            .map(|_| Item::Plain(PieceKind::LineComment))
            .parse(input),
        [b'(', ..] => alt((
            token::comment.map(|_| Item::Plain(PieceKind::Comment)),
            rest.map(|_| Item::Fault(UnclosedComment)),
        ))
        .parse(input),
        [b'0'..=b'9' | b'.' | b'+' | b'-', ..] => alt((
            token::number.map(|_| Item::Fault(MissingLetter)),
            unknown.map(|_| Item::Fault(UnknownText)),
        ))
        .parse(input),
        _ => alt((
            flow.map(|_| Item::Fault(Flow)),
            token::word.map(Item::Word),
            expression.map(|_| Item::Fault(Expression)),
            lone_letter.map(|_| Item::Fault(MissingNumber)),
            unknown.map(|_| Item::Fault(UnknownText)),
        ))
        .parse(input),
    }
}

/// A letter without a number, with what is left of a number after it.
fn lone_letter(input: &[u8]) -> Parsed<'_, &[u8]> {
    let remains = take_while(|byte| matches!(byte, b'+' | b'-' | b'.'));
    recognize((not(token::name), token::letter, remains)).parse(input)
}

/// A run that begins nothing known, to the next blank, comment, expression or
/// word.
fn unknown(input: &[u8]) -> Parsed<'_, &[u8]> {
    let inside = verify(peek(rest), |text: &[u8]| !ends_unknown(text));
    recognize(pair(
        unknown_part,
        many0_count(preceded(inside, unknown_part)),
    ))
    .parse(input)
}

/// Whether a blank, a comment, an expression or a word is next.
fn ends_unknown(text: &[u8]) -> bool {
    match text {
        [b' ' | b'\t' | b'(' | b';' | b'#' | b'[' | b']' | b'<', ..] => true,
        [byte, ..] if token::is_letter(*byte) => token::is_word(text),
        _ => false,
    }
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

#[cfg(test)]
mod tests {
    use super::*;

    /// The pieces of a line, blanks left out: words as they are written, the
    /// rest after the name of its kind or fault.
    fn pieces(line: &[u8]) -> Vec<String> {
        let (mut pieces, mut block) = <(Vec<Piece>, Block)>::default();
        parse_line(line, true, &mut pieces, &mut block);
        let mut issues = block.issues.iter();
        let name = |piece: &Piece| match piece.kind {
            PieceKind::Blank | PieceKind::LineEnd => None,
            PieceKind::Word => Some(String::new()),
            PieceKind::Unknown => {
                let issue = issues.next()?;
                assert_eq!(issue.span, piece.span);
                Some(format!("{:?}: ", issue.kind))
            }
            kind => Some(format!("{kind:?}: ")),
        };
        let names: Vec<Option<String>> = pieces.iter().map(name).collect();
        let texts = pieces.iter().map(|piece| piece.span.of(line));
        names
            .into_iter()
            .zip(texts)
            .filter_map(|(name, text)| Some(name? + &String::from_utf8_lossy(text)))
            .collect()
    }

    fn block(line: &[u8]) -> Block {
        let mut block = Block::default();
        parse_line(line, true, &mut Vec::new(), &mut block);
        block
    }

    #[test]
    fn words_need_no_blanks_and_may_hold_them() {
        assert_eq!(pieces(b"G1X10Y20"), ["G1", "X10", "Y20"]);
        assert_eq!(pieces(b"g 1 x - .5\ty+1."), ["g 1", "x - .5", "y+1."]);
        assert_eq!(
            pieces(b"G131 = 50*12@3^4"),
            ["G131", "= 50", "*12", "@3", "^4"]
        );
        assert_eq!(pieces(b"X1E5"), ["X1", "E5"]);
    }

    #[test]
    fn a_word_knows_its_value_and_its_places() {
        let expected = Word {
            letter: b'X',
            value: -0.5,
            span: Span::new(3, 8),
            number: Span::new(5, 8),
        };
        assert_eq!(block(b"g1 x -.5 (a)\r\n").words.get(1), Some(&expected));
        let values = block(b"X007 Y-0 Z0.1 A123456789012345678901234567890 B9007199254740993");
        let bits: Vec<u64> = values
            .words
            .iter()
            .map(|word| word.value.to_bits())
            .collect();
        let expected = [
            7.0,
            -0.0,
            0.1,
            123_456_789_012_345_678_901_234_567_890.0,
            9_007_199_254_740_992.0,
        ];
        assert_eq!(bits, expected.map(f64::to_bits));
    }

    #[test]
    fn numbers_and_letters_alone_are_faults() {
        assert_eq!(pieces(b"X1.2.3"), ["X1.2", "MissingLetter: .3"]);
        assert_eq!(pieces(b"X1 2"), ["X1", "MissingLetter: 2"]);
        assert_eq!(pieces(b"X1-2"), ["X1", "MissingLetter: -2"]);
        assert_eq!(pieces(b"G1 X Y2"), ["G1", "MissingNumber: X", "Y2"]);
        assert_eq!(pieces(b"X-.Y2"), ["MissingNumber: X-.", "Y2"]);
    }

    #[test]
    fn text_that_is_no_word_is_one_fault_a_run() {
        assert_eq!(
            pieces(b"G1GOTO100 X1"),
            ["G1", "UnknownText: GOTO100", "X1"]
        );
        assert_eq!(pieces(b"SET_LIMIT_1"), ["UnknownText: SET_LIMIT_1"]);
        assert_eq!(
            pieces(b"MSG(\"a\")"),
            ["UnknownText: MSG", "Comment: (\"a\")"]
        );
        assert_eq!(pieces(b"$J!&X10"), ["UnknownText: $J!&", "X10"]);
        assert_eq!(
            pieces(b"M117 \"a b\" X1"),
            ["M117", "UnknownText: \"a b\"", "X1"]
        );
        assert_eq!(pieces("Ø10 X1".as_bytes()), ["UnknownText: Ø10", "X1"]);
    }

    #[test]
    fn expressions_are_one_fault_each() {
        let cases = [
            "#1=5",
            "#<a b> = #2 + 1",
            "##3",
            "X#1",
            "Y-#<z>",
            "Z[1+[2*3]]",
            "sqrt[3**2 + 4]",
            "x round[1]",
            "IF [#1 GT 5]",
            "X=AC",
            "=[1]",
            "X[1",
            "]",
            "<a",
        ];
        for case in cases {
            assert_eq!(pieces(case.as_bytes()), [format!("Expression: {case}")]);
        }
        assert_eq!(pieces(b"X[1]Y2"), ["Expression: X[1]", "Y2"]);
    }

    #[test]
    fn o_words_are_words_unless_they_are_flow() {
        assert_eq!(pieces(b"O1001 (MAIN)"), ["O1001", "Comment: (MAIN)"]);
        for case in [
            "o<a> call [1]",
            "O100 SUB",
            "o1if [#1]",
            "O [1]",
            "o#1 endwhile",
        ] {
            let line = format!("{case} (c)");
            assert_eq!(
                pieces(line.as_bytes()),
                [format!("Flow: {case}"), "Comment: (c)".into()]
            );
        }
        assert_eq!(pieces(b"O1 X1 sub"), ["O1", "X1", "UnknownText: sub"]);
    }

    #[test]
    fn comments_hold_any_bytes() {
        assert_eq!(
            pieces(b"(a(b) G1 ;c(d"),
            ["Comment: (a(b)", "G1", "LineComment: ;c(d"]
        );
        assert_eq!(pieces(b"G1 (a ;b\n"), ["G1", "UnclosedComment: (a ;b"]);
        assert_eq!(pieces(b"(\xE9)"), ["Comment: (\u{FFFD})"]);
    }

    #[test]
    fn numbers_of_blocks_and_block_delete_have_their_places() {
        let level = |line: &[u8]| (block(line).delete_level, block(line).issues.len());
        assert_eq!(level(b" /G1"), (1, 0));
        assert_eq!(level(b"/2 N5 G1"), (2, 0));
        assert_eq!(level(b"N5 /0G1"), (1, 0));
        assert_eq!(level(b"G1 /2"), (0, 1));
        assert_eq!(level(b"/N5/2"), (1, 1));
        let number = |line: &[u8]| block(line).number.map(|word| word.value);
        assert_eq!(number(b"(a) n10G1"), Some(10.0));
        assert_eq!(number(b"N10 N20"), Some(10.0));
        assert_eq!(number(b"G1 N20"), None);
        assert_eq!(pieces(b"G1 N20"), ["G1", "UnknownText: N20"]);
    }

    #[test]
    fn the_tape_mark_takes_its_line() {
        assert!(block(b" % O1 (a)\n").tape);
        assert_eq!(pieces(b"%O1\n"), ["Tape: %O1"]);
        assert_eq!(pieces(b"G1 %"), ["G1", "UnknownText: %"]);
    }

    #[test]
    fn a_byte_order_mark_stands_only_at_the_beginning() {
        let line = b"\xEF\xBB\xBF%\n";
        assert_eq!(pieces(line), ["ByteOrderMark: \u{FEFF}", "Tape: %"]);
        let mut later = Block::default();
        parse_line(line, false, &mut Vec::new(), &mut later);
        assert_eq!(later.issues.len(), 1);
    }

    #[test]
    fn the_ends_of_words_and_text_are_known() {
        let ends = |line: &[u8]| (block(line).words_end, block(line).text_end);
        assert_eq!(ends(b"N1 G1 X1 (a)\r\n"), (8, 12));
        assert_eq!(ends(b"N10 /2 (a)\n"), (6, 10));
        assert_eq!(ends(b"/ (a)\r"), (1, 5));
        assert_eq!(ends(b"  "), (0, 2));
        assert_eq!(ends(b"\xEF\xBB\xBF(a)"), (3, 6));
    }

    #[test]
    fn a_long_line_costs_no_more_than_its_length() {
        let bits = [
            "<", "[", "]", "(", "\"", "#", "$", "A", "_", "5", "A ", "X-", "$5", "=", "A=", "O1",
            "O<", "#1+", "é", "N1", "/", "+", ".", "X[", "IF ",
        ];
        for bit in bits {
            let line = bit.repeat(300_000 / bit.len());
            assert!(block(line.as_bytes()).issues.len() <= MAX_ISSUES);
        }
    }
}
