//! Which controller a program is for, seen from marks in its text.
//!
//! Each mark counts for the profiles that it speaks for; those with the most points are
//! the answer, and ties stay ties. Nothing is executed.

mod line;
mod marks;
mod names;

use std::io::{self, Read};

use crate::source::{LineReader, SourceError};
use crate::syntax::{FOREIGN_BYTES, Foreign, foreign};
use line::Line;
use marks::{ENDINGS, MARKS};

pub use names::listed;

/// Marks are looked for in so many lines from the beginning.
pub const LINES_MAX: u64 = 100_000;

/// Points below which nothing is decided.
const POINTS_MIN: u32 = 3;

/// What was seen in a program.
#[derive(Debug, Default)]
pub struct Recognised {
    /// It is no program that any profile reads.
    pub foreign: Option<Foreign>,
    /// Why it is no program at all: it ends to be text, or no line of it has a word.
    pub no_program: Option<String>,
    /// The profiles with the most points, in the order of the built-in list; empty if
    /// there are too few marks to say.
    pub profiles: Vec<&'static str>,
    /// What speaks for them, in the order of the lines, such as `MSG( in line 2`.
    pub marks: Vec<String>,
}

impl Recognised {
    /// The marks in one phrase.
    #[must_use]
    pub fn seen(&self) -> String {
        self.marks.join(", ")
    }
}

/// Looks at a program; `file` is its name, whose ending may be a mark.
///
/// # Errors
/// A reader that fails. Where the text ends to be text, what was seen before counts.
pub fn recognise(mut input: impl Read, file: &str) -> io::Result<Recognised> {
    let mut head = Vec::new();
    let limit = u64::try_from(FOREIGN_BYTES).unwrap_or(u64::MAX);
    input.by_ref().take(limit).read_to_end(&mut head)?;
    if let Some(foreign) = foreign(&head) {
        return Ok(Recognised {
            foreign: Some(foreign),
            ..Recognised::default()
        });
    }
    let mut found = Found::of_name(file);
    let mut lines = LineReader::new(head.chain(input));
    let mut line = Line::default();
    let mut no_program = None;
    loop {
        match lines.next_line() {
            Ok(Some((number, bytes))) if number <= LINES_MAX => {
                line.set(bytes);
                found.look(&line, number);
            }
            Ok(_) => break,
            Err(SourceError::Io(error)) => return Err(error),
            Err(error @ (SourceError::Binary { .. } | SourceError::LineTooLong { .. })) => {
                no_program = Some(error.to_string());
                break;
            }
        }
    }
    if no_program.is_none() && !found.has_words {
        no_program = Some("there is no program in this file; give a part program".to_owned());
    }
    Ok(Recognised {
        no_program,
        ..found.judge()
    })
}

/// What was seen so far.
#[derive(Debug)]
struct Found {
    /// For each mark the line that it was seen in first.
    lines: [Option<u64>; MARKS.len()],
    ending: Option<&'static marks::Ending>,
    /// A line has more than comments.
    has_words: bool,
}

impl Found {
    fn of_name(file: &str) -> Self {
        let ending = file.rsplit_once('.').map_or("", |(_, ending)| ending);
        Self {
            lines: [None; MARKS.len()],
            ending: ENDINGS
                .iter()
                .find(|known| known.letters.eq_ignore_ascii_case(ending)),
            has_words: false,
        }
    }

    fn look(&mut self, line: &Line, number: u64) {
        if line.is_empty() {
            return;
        }
        self.has_words |= line.has_words();
        for (mark, seen) in MARKS.iter().zip(&mut self.lines) {
            if seen.is_none() && (mark.seen)(line) {
                *seen = Some(number);
            }
        }
    }

    /// Adds up the points.
    fn judge(&self) -> Recognised {
        let seen = || {
            let marks = MARKS.iter().zip(self.lines);
            marks.filter_map(|(mark, line)| Some((mark, line?)))
        };
        let points = |profile: &str| {
            let of_marks = seen().filter(|(mark, _)| mark.profiles.contains(&profile));
            let of_name = self
                .ending
                .filter(|known| known.profiles.contains(&profile));
            of_marks.map(|(mark, _)| mark.points).sum::<u32>()
                + of_name.map_or(0, |known| known.points)
        };
        let scored: Vec<(&'static str, u32)> = crate::machine::builtin::controllers()
            .iter()
            .map(|profile| (profile.name, points(profile.name)))
            .collect();
        let best = scored.iter().map(|(_, points)| *points).max();
        let best = best.filter(|best| *best >= POINTS_MIN);
        let profiles: Vec<&'static str> = scored
            .into_iter()
            .filter(|(_, points)| Some(*points) == best)
            .map(|(name, _)| name)
            .collect();
        let speaks = |for_them: &[&str]| profiles.iter().any(|name| for_them.contains(name));
        let of_name = self.ending.filter(|known| speaks(known.profiles));
        let mut of_marks: Vec<_> = seen()
            .filter(|(mark, _)| speaks(mark.profiles))
            .map(|(mark, line)| (line, mark.what))
            .collect();
        of_marks.sort_by_key(|(line, _)| *line);
        let of_name = of_name.map(|known| format!("the file's ending .{}", known.letters));
        let of_marks = of_marks
            .into_iter()
            .map(|(line, what)| format!("{what} in line {line}"));
        Recognised {
            foreign: None,
            no_program: None,
            marks: of_name.into_iter().chain(of_marks).collect(),
            profiles,
        }
    }
}

#[cfg(test)]
mod tests;
