//! Values of the files of Klipper.

use crate::found::{Figure, shown};
use crate::ini::{Item, last};
use crate::text::Log;

/// Seconds in a minute.
pub(super) const MIN: f64 = 60.0;

/// Values of the files.
pub(crate) struct Config<'i, 't> {
    pub(super) items: &'i [Item<'t>],
}

impl Config<'_, '_> {
    /// A value above 0.
    pub(super) fn positive(&self, log: &mut Log, section: &str, key: &str) -> Option<Figure> {
        let item = last(self.items, section, key)?;
        let value = log.positive(&item.place, item.value, &format!("`{key}`"))?;
        Some(Figure::new(value, item.source()))
    }

    /// How far a revolution of a section's motor moves its axis, as a comment.
    pub(super) fn travel_of_a_turn(&self, log: &mut Log, section: &str) -> Option<String> {
        let turn = self.positive(log, section, "rotation_distance")?;
        let gear = last(self.items, section, "gear_ratio");
        let gear = gear.map_or(String::new(), |it| format!(", {}", it.source()));
        let mm = shown(turn.value);
        Some(format!(
            "Travel of a revolution: {mm} mm, {}{gear}",
            turn.source
        ))
    }

    /// Any number.
    pub(super) fn number(&self, log: &mut Log, section: &str, key: &str) -> Option<Figure> {
        let item = last(self.items, section, key)?;
        let value = log.number(&item.place, item.value)?;
        Some(Figure::new(value, item.source()))
    }

    pub(super) fn has(&self, section: &str) -> bool {
        let mut items = self.items.iter();
        items.any(|item| item.section.eq_ignore_ascii_case(section))
    }
}
