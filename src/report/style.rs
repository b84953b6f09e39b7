//! How text for people is set: with colours or without, and how wide.

use anstyle::{AnsiColor, Style as Ansi};
use unicode_width::{UnicodeWidthChar, UnicodeWidthStr};

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

    /// A name, with its middle left out where there are fewer columns than that for it.
    pub(super) fn cut_name(self, name: &str, columns: usize) -> String {
        let columns = columns.max(LEAST);
        if self.columns.is_none() || name.width() <= columns {
            return name.to_owned();
        }
        // The end says more: the file, where the beginning has folders.
        let room = columns - 1;
        let head = taking(name.chars(), room / 3);
        let tail: String = taking(name.chars().rev(), room - head.width());
        let tail: String = tail.chars().rev().collect();
        format!("{head}…{tail}")
    }

    /// A text after its first `indent` columns, on further lines where it is longer than the
    /// terminal is wide.
    pub(super) fn wrapped(self, text: &str, indent: usize) -> String {
        let Some(columns) = self.columns.filter(|columns| *columns > 2 * indent) else {
            return text.to_owned();
        };
        let mut out = String::new();
        let mut taken = indent;
        for word in text.split(' ') {
            let width = word.width();
            if taken > indent && taken + 1 + width > columns {
                out.push('\n');
                out.extend(std::iter::repeat_n(' ', indent));
                taken = indent;
            } else if taken > indent {
                out.push(' ');
                taken += 1;
            }
            out.push_str(word);
            taken += width;
        }
        out
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

/// The first characters that take no more than these columns.
fn taking(characters: impl Iterator<Item = char>, columns: usize) -> String {
    let mut taken = 0;
    characters
        .take_while(|character| {
            taken += character.width().unwrap_or(0);
            taken <= columns
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::Style;

    #[test]
    fn the_middle_of_a_name_is_left_out() {
        let narrow = Style {
            columns: Some(80),
            ..Style::PLAIN
        };
        let name = "parts/2026/housing/op10-roughing.nc";
        assert_eq!(narrow.cut_name(name, 35), name);
        assert_eq!(
            narrow.cut_name(name, 20),
            "parts/…-roughing.nc".replace("…-", "…0-")
        );
        assert_eq!(Style::PLAIN.cut_name(name, 20), name);
        assert_eq!(
            narrow.cut_name("部品/加工プログラム.nc", 14),
            "部品…ラム.nc"
        );
    }
}
