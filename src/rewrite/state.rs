//! The modal state that edits touch: motion word and feed.

use crate::interpret::{Corner, Feed, FeedMode, Modal, Motion};

/// Motion word, feed, units and path mode at one place of the original program.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mark {
    /// The motion word in force.
    pub motion: Motion,
    /// The F in force, with its text.
    pub feed: Option<Feed>,
    /// What F means.
    pub feed_mode: FeedMode,
    /// The number of the G word that says so, times ten.
    pub feed_mode_word: u16,
    /// Millimetres in a program unit.
    pub mm_per_unit: f64,
    /// How corners may be taken, where a word of the program has said so.
    pub corner: Option<Corner>,
}

/// The word of a motion, such as `G1`; none where no single digit says it.
pub(super) fn motion_word(motion: Motion) -> Option<String> {
    let digit = motion.digit()?;
    Some(format!("G{}", digit as char))
}

/// Decimals up to which a shorter number of the same length is looked for.
const SHORT_DECIMALS: usize = 15;

impl Mark {
    /// The mark of a modal state.
    #[must_use]
    pub fn of(modal: &Modal) -> Self {
        Self {
            motion: modal.motion,
            feed: modal.feed,
            feed_mode: modal.feed_mode,
            feed_mode_word: modal.feed_mode_word,
            mm_per_unit: modal.mm_per_unit,
            corner: modal.corner_known.then_some(modal.corner),
        }
    }

    /// The words that let corners be rounded again as they were; none where they are not
    /// known, where no corner is rounded, or where a number cannot be written exactly.
    #[must_use]
    pub fn blend_words(&self) -> Option<String> {
        let Corner::Round {
            tolerance_mm,
            join_mm,
        } = self.corner?
        else {
            return None;
        };
        let mut words = String::from("G64");
        if tolerance_mm > 0.0 || join_mm > 0.0 {
            words.push_str(&self.length_word('P', tolerance_mm)?);
        }
        // Without Q it is P.
        if join_mm != tolerance_mm {
            words.push_str(&self.length_word('Q', join_mm)?);
        }
        Some(words)
    }

    /// The words that end the exact stop of G61: those that let corners be rounded as they
    /// were, or G64 alone where no word has said how they are.
    #[must_use]
    pub fn blend_again(&self) -> Option<String> {
        match self.corner {
            None => Some(String::from("G64")),
            Some(_) => self.blend_words(),
        }
    }

    /// A word of a length, where it can be written exactly.
    fn length_word(&self, letter: char, length_mm: f64) -> Option<String> {
        let length = length_mm / self.mm_per_unit;
        // The shortest number that is read as that length.
        let shorter = (0..=SHORT_DECIMALS).map(|decimals| format!("{length:.decimals$}"));
        let mut texts = shorter.chain([length.to_string()]);
        let is_it = |text: &String| {
            let read = text.parse::<f64>();
            read.is_ok_and(|read| read * self.mm_per_unit == length_mm)
        };
        texts.find(is_it).map(|text| format!(" {letter}{text}"))
    }

    /// Whether F means length per minute.
    #[must_use]
    pub fn per_minute(&self) -> bool {
        self.feed_mode == FeedMode::PerMinute
    }

    /// The numbers of the G words that let F mean length per minute for one block, and then
    /// again what it means here, each times ten. On SINUMERIK those of constant surface
    /// speed say it too ("Constant cutting rate": G96 is with G95, G961 with G94).
    pub(super) fn per_minute_and_back(&self) -> [u16; 2] {
        let per_minute = match self.feed_mode_word {
            990 => 980,
            960 => 9610,
            970 => 9710,
            _ => 940,
        };
        [per_minute, self.feed_mode_word]
    }

    /// The feed as value and unit.
    #[must_use]
    pub fn feed_value(&self) -> Option<FeedValue> {
        self.feed.as_ref().map(|feed| FeedValue {
            value: feed.value,
            mm_per_unit: feed.mm_per_unit,
        })
    }
}

/// An F by value, to see whether two are the same.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FeedValue {
    /// The number in the program.
    pub value: f64,
    /// Millimetres in the unit that it was read in.
    pub mm_per_unit: f64,
}

/// What the written program has in force.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Written {
    pub(super) motion: Motion,
    pub(super) feed: Option<FeedValue>,
}

#[cfg(test)]
mod tests {
    use super::Mark;
    use crate::interpret::{Corner, FeedMode, Motion};

    /// 0.0008 · 25.4 / 25.4 is 0.0008000000000000001.
    #[test]
    fn tolerances_come_back_as_they_were_written() {
        let mark = |tolerance: f64, join: f64, mm_per_unit: f64| Mark {
            motion: Motion::Rapid,
            feed: None,
            feed_mode: FeedMode::PerMinute,
            feed_mode_word: 940,
            mm_per_unit,
            corner: Some(Corner::Round {
                tolerance_mm: tolerance * mm_per_unit,
                join_mm: join * mm_per_unit,
            }),
        };
        let words = mark(0.002, 0.0008, 25.4).blend_words();
        assert_eq!(words.as_deref(), Some("G64 P0.002 Q0.0008"));
        let words = mark(0.05, 0.05, 1.0).blend_words();
        assert_eq!(words.as_deref(), Some("G64 P0.05"));
    }
}
