//! How text for people is set: with colours or without, and how wide.

use anstyle::{AnsiColor, Style as Ansi};

use crate::diagnostic::excerpt;

/// Characters of a program line that text repeats at most, and at least where there is hardly
/// room for any.
const MOST: usize = super::finding::LINE_CHARS;
const LEAST: usize = 12;

/// How text for people is set.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Style {
    /// Verdicts have colours (ANSI).
    pub colour: bool,
    /// Columns of the terminal that lists are kept to; `None`: as wide as they are.
    pub columns: Option<usize>,
}

impl Style {
    /// Without colours, as wide as it is.
    pub const PLAIN: Self = Self {
        colour: false,
        columns: None,
    };

    /// What is as it should be.
    #[must_use]
    pub fn good(self, text: &str) -> String {
        self.in_colour(AnsiColor::Green, text)
    }

    /// What is not.
    #[must_use]
    pub fn bad(self, text: &str) -> String {
        self.in_colour(AnsiColor::Red, text)
    }

    fn in_colour(self, colour: AnsiColor, text: &str) -> String {
        if !self.colour {
            return text.to_owned();
        }
        let style = Ansi::new().fg_color(Some(colour.into())).bold();
        format!("{style}{text}{style:#}")
    }

    /// Whether there is room for a line of a program next to so many columns.
    pub(super) fn has_room(self, taken: usize) -> bool {
        self.columns.is_none_or(|columns| taken + LEAST < columns)
    }

    /// A line of a program, cut to the room that the rest of its row, `taken` columns, leaves.
    pub(super) fn cut(self, line: &[u8], taken: usize) -> String {
        let Some(columns) = self.columns else {
            return excerpt(line, MOST);
        };
        let room = columns.saturating_sub(taken).clamp(LEAST, MOST);
        let whole = excerpt(line, room);
        if whole.chars().count() <= room {
            return whole;
        }
        // The sign that it goes on takes room as well.
        excerpt(line, room - 1)
    }
}
