//! Blocks of a subprogram, or of a section that is repeated, as they stand in place of the call.
//!
//! Input: a line that the call runs, and the call itself. Output: the line as it does the same
//! there, and the call as a comment. Whether all of it does the same is checked by the pipeline,
//! which reads it again.

use super::number::with_blanks;
use crate::edit::{Edit, apply};
use crate::interpret::Passage;
use crate::source::{Span, split_line_end};
use crate::syntax::{Block, Word};

/// A block, and what has to be known of it.
#[derive(Debug, Clone, Copy)]
pub struct CalledBlock<'a> {
    /// The line, line end included.
    pub text: &'a [u8],
    /// Its words.
    pub block: &'a Block,
    /// Its part in the order of execution.
    pub passage: Passage,
    /// Comments begin with `;` and reach to the end of their line.
    pub comment_to_line_end: bool,
}

impl CalledBlock<'_> {
    /// The block without its number, its label and its part in the order of execution; its comment
    /// alone where nothing of it is left to do, since some controls act on comments. `None`: it
    /// has none.
    ///
    /// # Errors
    /// Why it cannot stand in another place.
    pub fn in_place(&self) -> Result<Option<Vec<u8>>, &'static str> {
        let Block { words, issues, .. } = self.block;
        match self.passage {
            Passage::Other => return Err("a branch, a loop or a macro"),
            Passage::Call if self.only_passes() => return Ok(self.comment_alone()),
            Passage::Call => return Err("a call with other words in its block"),
            Passage::Edge if !issues.is_empty() && !words.is_empty() => {
                return Err("a return with other words in its block");
            }
            Passage::None | Passage::Edge => {}
        }
        let (text, line_end) = split_line_end(self.text);
        let code = &text[..self.comment()];
        let number = self.block.number.map(|word| word.span);
        let begin = number.map_or(0, |span| span.end as usize);
        let label = label(code, begin);
        let begin = label.map_or(begin, |span| span.end as usize);
        let statement = code.get(begin..).unwrap_or_default().trim_ascii();
        let passes = issues.is_empty()
            || self.passage == Passage::Edge
            || statement.is_empty()
            || begins_subprogram(statement);
        if passes && self.only_passes() {
            return Ok(self.comment_alone());
        }
        // What is worked out may be worked out from values of the subprogram itself.
        if code.iter().any(|byte| b"#=[$<\"".contains(byte)) {
            return Err("values that are worked out");
        }
        let edges = words
            .iter()
            .filter(|word| word.letter == b'O' || is_return(word));
        let spans = number.into_iter().chain(label);
        let spans = spans.chain(edges.map(|word| word.span));
        let mut edits: Vec<_> = spans
            .map(|span| Edit::replace(with_blanks(text, span), ""))
            .collect();
        let mut out = Vec::with_capacity(text.len() + 2);
        if !apply(text, &mut edits, &mut out) {
            return Err("words that overlap");
        }
        if number.is_some() || label.is_some() {
            let blanks = out.len() - out.trim_ascii_start().len();
            out.drain(..blanks);
        }
        out.extend_from_slice(if line_end.is_empty() { b"\n" } else { line_end });
        Ok(Some(out))
    }

    /// The call as a comment, after its number.
    ///
    /// # Errors
    /// Why the call has to stay.
    pub fn as_comment(&self) -> Result<Vec<u8>, &'static str> {
        if self.block.delete_level > 0 {
            return Err("its call may be skipped");
        }
        if !self.only_passes() {
            return Err("the block of its call does more than call it");
        }
        let (text, line_end) = split_line_end(self.text);
        let begin = self.block.number.map_or(0, |word| word.span.end as usize);
        let (call, rest) = (text.get(begin..self.comment()), &text[self.comment()..]);
        let call = call.unwrap_or_default().trim_ascii();
        if call.iter().any(|byte| b"()".contains(byte)) && !self.comment_to_line_end {
            return Err("its call has parentheses");
        }
        let mut out = text.get(..begin).unwrap_or_default().to_vec();
        if begin > 0 {
            out.push(b' ');
        }
        let [open, close]: [&[u8]; 2] = if self.comment_to_line_end {
            [b"; ", b" written out"]
        } else {
            [b"(", b" written out)"]
        };
        out.extend_from_slice(open);
        out.extend_from_slice(call);
        out.extend_from_slice(close);
        if !rest.is_empty() {
            out.push(b' ');
            out.extend_from_slice(rest);
        }
        out.extend_from_slice(if line_end.is_empty() { b"\n" } else { line_end });
        Ok(out)
    }

    /// Its comments on a line of their own.
    fn comment_alone(&self) -> Option<Vec<u8>> {
        let (text, line_end) = split_line_end(self.text);
        let comment = text[self.comment()..].trim_ascii_end();
        let end = if line_end.is_empty() { b"\n" } else { line_end };
        (!comment.is_empty()).then(|| [comment, end].concat())
    }

    /// Where its first comment begins, or its end.
    fn comment(&self) -> usize {
        let (text, _) = split_line_end(self.text);
        let opens = |byte: &u8| *byte == b';' || *byte == b'(' && !self.comment_to_line_end;
        text.iter().position(opens).unwrap_or(text.len())
    }

    /// Whether its words say nothing but where the program goes on.
    fn only_passes(&self) -> bool {
        self.block.words.iter().all(is_edge)
    }
}

/// Words of calls and returns, and their values.
fn is_edge(word: &Word) -> bool {
    match word.letter {
        b'M' => is_return(word) || [97.0, 98.0, 198.0].contains(&word.value),
        letter => b"OPLHQK".contains(&letter),
    }
}

fn is_return(word: &Word) -> bool {
    word.letter == b'M' && [17.0, 99.0].contains(&word.value)
}

/// A label that stands at this place: a name and `:`.
fn label(code: &[u8], at: usize) -> Option<Span> {
    let rest = code.get(at..)?;
    let colon = rest.iter().position(|byte| *byte == b':')?;
    let name = rest[..colon].trim_ascii_start();
    let mut bytes = name.trim_ascii_end().iter();
    let begins = bytes.next()?;
    let named = begins.is_ascii_alphabetic() || *begins == b'_';
    let all = bytes.all(|byte| byte.is_ascii_alphanumeric() || *byte == b'_');
    let start = at + colon - name.len();
    (named && all).then(|| Span::new(start, at + colon + 1))
}

/// `PROC NAME`, which does no more than begin a subprogram.
fn begins_subprogram(statement: &[u8]) -> bool {
    let text = statement.to_ascii_uppercase();
    let name = text.strip_prefix(b"PROC ").map(<[u8]>::trim_ascii);
    name.is_some_and(|name| {
        let mut bytes = name.iter();
        bytes.all(|byte| byte.is_ascii_alphanumeric() || *byte == b'_')
    })
}
