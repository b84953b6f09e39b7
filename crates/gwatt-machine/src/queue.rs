//! What words that move no axis do to moves that are planned ahead: whether the
//! motion stops before them.

use crate::printer::Command;

/// Comments that act (`LinuxCNC`, "Messages"), in the order of their numbers.
pub const MESSAGES: [&str; 4] = ["MSG", "DEBUG", "PRINT", "LOG"];

/// The letter under which an active comment is kept.
pub const MESSAGE: u8 = b'(';

/// A word, or all words of a letter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct QueueWord {
    /// Its letter; [`MESSAGE`] for an active comment.
    pub letter: u8,
    /// Ten times its number, or the place of a comment in [`MESSAGES`]; `None`:
    /// whatever the number.
    pub number: Option<u16>,
}

impl QueueWord {
    fn is(self, letter: u8, number: u16) -> bool {
        self.letter == letter && self.number.is_none_or(|own| own == number)
    }
}

/// Which words stop the motion; what no list names may stop it or not.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Queue {
    /// The motion has stopped before they act.
    pub stops: Vec<QueueWord>,
    /// The same where they change what is in force, else they do nothing.
    pub stops_on_change: Vec<QueueWord>,
    /// They act while the axes move on. Lines before and after them are not put
    /// together.
    pub passes: Vec<QueueWord>,
    /// The same, but such lines may be.
    pub joins: Vec<QueueWord>,
    /// Extended commands of printers that the lists name.
    pub names: Vec<(Command, QueueEffect)>,
    /// Whether S in a block that moves acts with the motion, as in grbl's laser mode.
    pub laser_mode: LaserMode,
}

/// Whether the power of a laser follows the motion ($32 of grbl): S in a block that moves stops
/// nothing then.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum LaserMode {
    /// It is off, or the control has none.
    #[default]
    Off,
    /// It is on.
    On,
    /// The control has one, and the machine file does not say whether it is on.
    Unknown,
}

/// What a word does to the motion before it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum QueueEffect {
    /// It stops.
    Stop,
    /// It stops if the word changes what is in force.
    StopOnChange,
    /// It goes on; lines before and after the word stay apart.
    Pass,
    /// It goes on as if nothing stood there.
    Join,
}

impl Queue {
    /// What the profile says of a word, by letter and ten times its number;
    /// `None` where it says nothing.
    #[must_use]
    pub fn effect(&self, letter: u8, number: u16) -> Option<QueueEffect> {
        let lists = [
            (&self.stops, QueueEffect::Stop),
            (&self.stops_on_change, QueueEffect::StopOnChange),
            (&self.passes, QueueEffect::Pass),
            (&self.joins, QueueEffect::Join),
        ];
        let named = |list: &[QueueWord]| list.iter().any(|word| word.is(letter, number));
        let found = lists.into_iter().find(|(list, _)| named(list));
        found.map(|(_, effect)| effect)
    }

    /// The same of an extended command, by its name in any case.
    #[must_use]
    pub fn effect_of_name(&self, name: &[u8]) -> Option<QueueEffect> {
        let found = self.names.iter().find(|(own, _)| own.is_macro(name));
        found.map(|(_, effect)| *effect)
    }
}

#[cfg(test)]
mod tests {
    use super::{Command, LaserMode, Queue, QueueEffect, QueueWord};

    #[test]
    fn a_letter_alone_stands_for_all_its_words() {
        let word = |letter, number| QueueWord { letter, number };
        let queue = Queue {
            stops: vec![word(b'S', None), word(b'M', Some(80))],
            stops_on_change: vec![word(b'M', Some(90))],
            passes: vec![word(b'M', Some(620))],
            joins: vec![word(b'T', None)],
            names: vec![(Command::Macros("SET_LED".to_owned()), QueueEffect::Join)],
            laser_mode: LaserMode::Off,
        };
        assert_eq!(queue.effect(b'S', 15), Some(QueueEffect::Stop));
        assert_eq!(queue.effect(b'M', 80), Some(QueueEffect::Stop));
        assert_eq!(queue.effect(b'M', 90), Some(QueueEffect::StopOnChange));
        assert_eq!(queue.effect(b'M', 620), Some(QueueEffect::Pass));
        assert_eq!(queue.effect(b'T', 30), Some(QueueEffect::Join));
        assert_eq!(queue.effect(b'M', 70), None);
        assert_eq!(
            queue.effect_of_name(b"set_led_template"),
            Some(QueueEffect::Join)
        );
        assert_eq!(queue.effect_of_name(b"SET_PIN"), None);
    }
}
