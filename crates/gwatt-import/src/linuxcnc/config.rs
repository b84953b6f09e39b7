//! Values of the INI file of LinuxCNC.

use super::hal::Hal;
use crate::found::Figure;
use crate::ini::{Item, first};
use crate::text::Log;

/// Seconds of a minute, millimetres of an inch.
pub(super) const MIN: f64 = 60.0;
pub(super) const INCH: f64 = 25.4;

/// A section alone, as [`Config::positive`] takes it.
pub(super) fn section(name: &str) -> Vec<String> {
    vec![name.to_owned()]
}

/// The values, and how many millimetres and degrees a unit of the machine has.
pub(super) struct Config<'j> {
    pub(super) items: Vec<Item<'j>>,
    pub(super) linear: f64,
    pub(super) angular: f64,
    pub(super) hal: Hal,
}

impl Config<'_> {
    pub(super) fn item(&self, sections: &[String], key: &str) -> Option<&Item<'_>> {
        sections
            .iter()
            .find_map(|section| first(&self.items, section, key))
    }

    pub(super) fn positive(
        &self,
        log: &mut Log,
        sections: &[String],
        key: &str,
        factor: f64,
    ) -> Option<Figure> {
        let item = self.item(sections, key)?;
        let value = log.positive(&item.place, item.value, key)?;
        Some(Figure::new(value * factor, named(item)))
    }

    pub(super) fn number(
        &self,
        log: &mut Log,
        sections: &[String],
        key: &str,
        factor: f64,
    ) -> Option<Figure> {
        let item = self.item(sections, key)?;
        let value = log.number(&item.place, item.value)?;
        Some(Figure::new(value * factor, named(item)))
    }
}

/// A value with its section.
pub(super) fn named(item: &Item<'_>) -> String {
    format!("[{}] {}", item.section, item.source())
}
