//! A program held whole, so that it can be jumped about in.

use std::collections::HashMap;

use super::landmarks::Landmarks;
use crate::execute::Interpreter;
use crate::expression::Fault;
use crate::label::Label;
use crate::statement::keyword::Keyword;
use crate::statement::{Sight, glance, glance_at};
use gwatt_syntax::source::lines;
use gwatt_syntax::{Block, scan_line};

/// A program, or a file of subprograms.
#[derive(Debug)]
pub(super) struct Text {
    bytes: Vec<u8>,
    /// Offset of each line, and the end.
    starts: Vec<usize>,
    /// How often each line has been executed.
    pub(super) runs: Vec<u32>,
    /// Lines that run again and again, as they were read.
    blocks: Vec<Option<Box<Block>>>,
    index: Option<Index>,
    landmarks: Option<Box<Landmarks>>,
    /// Places that have been looked for before.
    found: HashMap<(Search, usize), Option<usize>>,
}

/// Where subprograms begin.
#[derive(Debug, Default)]
struct Index {
    subs: HashMap<Label, usize>,
    /// `O1000` lines by number, and all of them in order.
    programs: HashMap<u32, usize>,
    borders: Vec<usize>,
    /// Some O-word has a label that is worked out: `o[#1] while`.
    works_out: bool,
}

/// What is looked for from some line on.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) enum Search {
    /// The next of these O-words with this label; or one that begins something
    /// with it, which is wrong there.
    OWord(Label, &'static [Keyword]),
    /// A block number.
    Block(u64),
    /// The same from the beginning of the program, and from after this line.
    FirstBlock(u64),
    NextBlock(u64),
    /// `END n`, forwards.
    EndLoop(u8),
    /// `DO n`, backwards.
    BeginLoop(u8),
}

impl Text {
    pub(super) fn new(bytes: Vec<u8>) -> Self {
        let mut starts = vec![0];
        let mut end = 0;
        for line in lines(&bytes) {
            end += line.len();
            starts.push(end);
        }
        let count = starts.len() - 1;
        Self {
            bytes,
            starts,
            runs: vec![0; count],
            blocks: Vec::new(),
            index: None,
            landmarks: None,
            found: HashMap::new(),
        }
    }

    /// What its lines are, as `find` finds it.
    pub(super) fn landmarks(&mut self, find: fn(&Self) -> Landmarks) -> &Landmarks {
        if self.landmarks.is_none() {
            self.landmarks = Some(Box::new(find(self)));
        }
        self.landmarks.get_or_insert_default()
    }

    /// Number of lines.
    pub(super) fn len(&self) -> usize {
        self.runs.len()
    }

    /// A line with its line end; lines count from 0 here.
    pub(super) fn line(&self, line: usize) -> &[u8] {
        let start = self.starts.get(line).copied().unwrap_or_default();
        let end = self.starts.get(line + 1).copied().unwrap_or(start);
        self.bytes.get(start..end).unwrap_or_default()
    }

    /// Reads a line into `block`, from its text or as it was read before.
    pub(super) fn read(&mut self, line: usize, block: &mut Block) {
        if let Some(Some(known)) = self.blocks.get(line) {
            block.copy_from(known);
            return;
        }
        scan_line(self.line(line), line == 0, block);
        if self.runs.get(line).is_some_and(|runs| *runs > 2) {
            if self.blocks.is_empty() {
                self.blocks.resize(self.len(), None);
            }
            if let Some(entry) = self.blocks.get_mut(line) {
                *entry = Some(Box::new(block.clone()));
            }
        }
    }

    /// The line of a subroutine's `sub`, or of a program's O number.
    pub(super) fn begin(&mut self, label: &Label) -> Option<usize> {
        let index = self.index();
        let sub = index.subs.get(label).copied();
        match label {
            Label::Number(number) => sub.or_else(|| index.programs.get(number).copied()),
            Label::Name(_) => sub,
        }
    }

    /// What the O-word at the beginning of a line does.
    pub(super) fn keyword(&self, line: usize) -> Option<Keyword> {
        match glance_at(self.line(line))? {
            Sight::Plain(_, keyword) => keyword,
            Sight::WorkedOut { keyword, .. } => Some(keyword),
        }
    }

    /// Whether some O-word has a label that is worked out.
    pub(super) fn works_out_labels(&mut self) -> bool {
        self.index().works_out
    }

    /// As [`Self::find`] of an O-word, with labels that are worked out. `LinuxCNC` does so
    /// for lines that it passes over, with the values that are in force then.
    pub(super) fn find_worked_out(
        &self,
        label: &Label,
        keywords: &[Keyword],
        from: usize,
        interpreter: &Interpreter<'_>,
    ) -> Result<Option<usize>, Fault> {
        for line in from..self.len() {
            let text = self.line(line);
            let (found, keyword) = match glance_at(text) {
                Some(Sight::Plain(found, Some(keyword))) => (found, keyword),
                Some(Sight::WorkedOut { at, keyword }) => (interpreter.label(text, at)?, keyword),
                _ => continue,
            };
            if is_wanted(keyword, found == *label, keywords) {
                return Ok(Some(line));
            }
        }
        Ok(None)
    }

    /// Whether that line is an O number alone.
    pub(super) fn is_program(&mut self, line: usize) -> bool {
        self.index().borders.binary_search(&line).is_ok()
    }

    /// The lines of the program that a line belongs to.
    fn program(&mut self, line: usize) -> (usize, usize) {
        let len = self.len();
        let borders = &self.index().borders;
        let next = borders.partition_point(|border| *border <= line);
        let begin = next.checked_sub(1).and_then(|at| borders.get(at).copied());
        (
            begin.unwrap_or(0),
            borders.get(next).copied().unwrap_or(len),
        )
    }

    fn index(&mut self) -> &Index {
        if self.index.is_none() {
            let mut index = Index::default();
            for line in 0..self.len() {
                let text = self.line(line);
                if memchr::memchr3(b'O', b'o', b':', text).is_none()
                    && memchr::memchr(b'<', text).is_none()
                {
                    continue;
                }
                let sight = glance_at(text);
                index.works_out |= matches!(sight, Some(Sight::WorkedOut { .. }));
                match sight.and_then(Sight::plain) {
                    Some((label, Some(Keyword::Sub))) => {
                        index.subs.entry(label).or_insert(line);
                    }
                    Some((Label::Number(number), None)) => {
                        index.programs.entry(number).or_insert(line);
                        index.borders.push(line);
                    }
                    Some((label @ Label::Name(_), None)) => {
                        index.subs.entry(label).or_insert(line);
                        index.borders.push(line);
                    }
                    _ => {}
                }
            }
            self.index = Some(index);
        }
        self.index.get_or_insert_default()
    }

    /// The line where something stands, looked for from `from` on.
    pub(super) fn find(&mut self, search: &Search, from: usize) -> Option<usize> {
        let key = (search.clone(), from);
        if let Some(found) = self.found.get(&key) {
            return *found;
        }
        let found = self.look(search, from);
        self.found.insert(key, found);
        found
    }

    fn look(&mut self, search: &Search, from: usize) -> Option<usize> {
        match search {
            Search::OWord(label, keywords) => (from..self.len()).find(|line| {
                let Some((found, Some(keyword))) = glance(self.line(*line)) else {
                    return false;
                };
                is_wanted(keyword, found == *label, keywords)
            }),
            Search::Block(number) => {
                // From here to the end of the program, then from its beginning.
                let (begin, end) = self.program(from);
                (from..end)
                    .chain(begin..from)
                    .find(|line| block_number(self.line(*line)) == Some(*number))
            }
            Search::FirstBlock(number) => {
                let (begin, end) = self.program(from);
                (begin..end).find(|line| block_number(self.line(*line)) == Some(*number))
            }
            Search::NextBlock(number) => {
                let (_, end) = self.program(from);
                (from + 1..end).find(|line| block_number(self.line(*line)) == Some(*number))
            }
            Search::EndLoop(number) => {
                let (_, end) = self.program(from);
                (from..end).find(|line| loop_end(self.line(*line)) == Some(*number))
            }
            Search::BeginLoop(number) => {
                let (begin, _) = self.program(from);
                (begin..from)
                    .rev()
                    .find(|line| loop_begin(self.line(*line)) == Some(*number))
            }
        }
    }
}

/// Whether an O-word, with the label that is looked for or another, is what is looked for.
fn is_wanted(keyword: Keyword, same_label: bool, keywords: &[Keyword]) -> bool {
    let wanted = keywords.contains(&keyword) || keyword.opens();
    // A subroutine begins inside another.
    let nested = keyword == Keyword::Sub && keywords.contains(&Keyword::EndSub);
    same_label && wanted || nested
}

/// The N word at the beginning of a line.
fn block_number(line: &[u8]) -> Option<u64> {
    let text = line.trim_ascii_start();
    let text = match text.strip_prefix(b"/") {
        Some(rest) => rest.trim_start_with_digit(),
        None => text,
    };
    let digits = text
        .strip_prefix(b"N")
        .or_else(|| text.strip_prefix(b"n"))?
        .trim_ascii_start();
    let length = digits
        .iter()
        .take_while(|byte| byte.is_ascii_digit())
        .count();
    std::str::from_utf8(digits.get(..length)?)
        .ok()?
        .parse()
        .ok()
}

/// Taking off what may stand after the slash of a block delete.
trait TrimDigit {
    fn trim_start_with_digit(&self) -> &Self;
}

impl TrimDigit for [u8] {
    fn trim_start_with_digit(&self) -> &[u8] {
        match self.split_first() {
            Some((first, rest)) if first.is_ascii_digit() => rest.trim_ascii_start(),
            _ => self.trim_ascii_start(),
        }
    }
}

/// The line without blanks, N word and comments, upper case; short lines only.
fn bare(line: &[u8]) -> Vec<u8> {
    let mut bare = Vec::new();
    let mut comment = false;
    for byte in line.iter().take(512) {
        match byte {
            b'(' => comment = true,
            b')' => comment = false,
            _ if comment || byte.is_ascii_whitespace() => {}
            _ => bare.push(byte.to_ascii_uppercase()),
        }
    }
    let words = match bare.strip_prefix(b"N") {
        Some(rest) => {
            let digits = rest.iter().take_while(|byte| byte.is_ascii_digit()).count();
            rest.get(digits..).unwrap_or_default()
        }
        None => &bare,
    };
    words.to_vec()
}

/// n of `END n`.
fn loop_end(line: &[u8]) -> Option<u8> {
    memchr::memchr2(b'E', b'e', line)?;
    match *bare(line).strip_prefix(b"END")? {
        [digit @ b'1'..=b'3'] => Some(digit - b'0'),
        _ => None,
    }
}

/// n of `WHILE [ … ] DO n` and `DO n`.
fn loop_begin(line: &[u8]) -> Option<u8> {
    memchr::memchr2(b'D', b'd', line)?;
    let bare = bare(line);
    match *bare {
        [.., b'D', b'O', digit @ b'1'..=b'3'] if bare.starts_with(b"WHILE") || bare.len() == 3 => {
            Some(digit - b'0')
        }
        _ => None,
    }
}
