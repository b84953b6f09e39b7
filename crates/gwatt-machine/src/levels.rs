//! Levels: words each of which selects one of several accelerations or rapid speeds, as
//! the machine file describes them.

use super::axis::{AXES, AxisSet, AxisValues};

/// Most groups of such words that a machine has.
pub const LEVEL_GROUPS: usize = 4;

/// A group of words of which one is in force at a time.
#[derive(Debug, Clone, PartialEq)]
pub struct Levels {
    /// From the gentlest on.
    pub list: Vec<Level>,
    /// Index of the level that holds when a program begins.
    pub power_on: usize,
    /// Index of the group, below [`LEVEL_GROUPS`].
    pub group: usize,
}

/// What one of them makes of the axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Level {
    /// Words that select it; the first is the one that is written.
    pub words: Vec<LevelWord>,
    /// Accelerations of the axes, mm/s² (degrees/s²).
    pub accel_mm_s2: AxisValues,
    /// Share of the rapid speed.
    pub rapid_factor: f64,
}

/// A word that selects a level.
#[derive(Debug, Clone, PartialEq)]
pub struct LevelWord {
    /// As it is written, such as `G187 P3` or `DYNFINISH`.
    pub text: String,
    /// Letters and numbers of its words, a G or M word first; empty for a name.
    pub codes: Vec<(u8, f64)>,
}

impl LevelWord {
    /// Whether it is this name; SINUMERIK does not care for capitals.
    #[must_use]
    pub fn is_named(&self, name: &str) -> bool {
        self.codes.is_empty() && self.text.eq_ignore_ascii_case(name)
    }

    /// Its G or M word, with the number × 10.
    #[must_use]
    pub fn code(&self) -> Option<(u8, u16)> {
        let (letter, number) = *self.codes.first()?;
        Some((letter, (number * 10.0 + 0.5) as u16))
    }
}

impl Level {
    /// Whether it lets no axis of a set be quicker than these limits do.
    #[must_use]
    pub fn is_within(&self, axes: AxisSet, accel_mm_s2: &AxisValues, rapid_factor: f64) -> bool {
        // Percentages are worked out on both sides.
        let within = |own: f64, limit: f64| own <= limit * (1.0 + 1e-12);
        within(self.rapid_factor, rapid_factor)
            && axes
                .iter()
                .all(|axis| within(self.accel_mm_s2[axis], accel_mm_s2[axis]))
    }

    /// The word that selects it.
    #[must_use]
    pub fn text(&self) -> &str {
        self.words.first().map_or("", |word| word.text.as_str())
    }
}

impl Levels {
    /// Whether one of its words begins with this G or M word (number × 10).
    #[must_use]
    pub fn begins(&self, letter: u8, number: u16) -> bool {
        self.words()
            .any(|(_, word)| word.code() == Some((letter, number)))
    }

    /// The level of a name.
    #[must_use]
    pub fn named(&self, name: &str) -> Option<usize> {
        let mut words = self.words();
        words
            .find(|(_, word)| word.is_named(name))
            .map(|(index, _)| index)
    }

    /// All words, with the index of the level of each.
    pub fn words(&self) -> impl Iterator<Item = (usize, &LevelWord)> {
        let levels = self.list.iter().enumerate();
        levels.flat_map(|(index, level)| level.words.iter().map(move |word| (index, word)))
    }

    /// The largest acceleration of each axis, and the largest share of the rapid speed, of
    /// all levels.
    #[must_use]
    pub fn largest(&self) -> (AxisValues, f64) {
        let mut accel_mm_s2 = [0.0_f64; AXES];
        let mut rapid_factor = 0.0_f64;
        for level in &self.list {
            rapid_factor = rapid_factor.max(level.rapid_factor);
            for (most, own) in accel_mm_s2.iter_mut().zip(&level.accel_mm_s2) {
                *most = most.max(*own);
            }
        }
        (accel_mm_s2, rapid_factor)
    }

    /// The quickest level within these limits of all axes.
    #[must_use]
    pub fn quickest_within(
        &self,
        axes: AxisSet,
        accel_mm_s2: &AxisValues,
        rapid_factor: f64,
    ) -> Option<usize> {
        let within = |level: &Level| level.is_within(axes, accel_mm_s2, rapid_factor);
        self.list.iter().rposition(within)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn level(text: &str, codes: &[(u8, f64)], accel: f64, rapid_factor: f64) -> Level {
        Level {
            words: vec![LevelWord {
                text: text.to_owned(),
                codes: codes.to_vec(),
            }],
            accel_mm_s2: [accel; AXES],
            rapid_factor,
        }
    }

    #[test]
    fn words_are_found_by_code_and_by_name() {
        let levels = Levels {
            list: vec![
                level("DYNFINISH", &[], 500.0, 1.0),
                level(
                    "G5.1 Q1 R5",
                    &[(b'G', 5.1), (b'Q', 1.0), (b'R', 5.0)],
                    1000.0,
                    0.5,
                ),
            ],
            power_on: 0,
            group: 0,
        };
        assert_eq!(levels.named("dynfinish"), Some(0));
        assert_eq!(levels.named("G5.1 Q1 R5"), None);
        assert!(levels.begins(b'G', 51));
        assert!(!levels.begins(b'Q', 10));
        assert_eq!(levels.largest(), ([1000.0; AXES], 1.0));
        let axes = AxisSet(1);
        assert_eq!(levels.quickest_within(axes, &[1000.0; AXES], 1.0), Some(1));
        assert_eq!(levels.quickest_within(axes, &[999.0; AXES], 1.0), Some(0));
        assert_eq!(levels.quickest_within(axes, &[499.0; AXES], 1.0), None);
        assert_eq!(levels.quickest_within(axes, &[1000.0; AXES], 0.4), None);
    }
}
