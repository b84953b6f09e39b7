//! Sections with keys and values, as LinuxCNC and Klipper have them.

use crate::near::Job;
use crate::text::Place;

/// A value of a section.
pub(crate) struct Item<'t> {
    pub(crate) section: String,
    pub(crate) key: String,
    pub(crate) value: &'t str,
    /// As it is written, key included.
    pub(crate) whole: &'t str,
    pub(crate) place: Place<'t>,
}

impl Item<'_> {
    /// How it is shown as a source.
    pub(crate) fn source(&self) -> String {
        self.place.source(self.whole)
    }
}

/// What separates keys and values, and begins comments.
#[derive(Clone, Copy)]
pub(crate) struct Style {
    pub(crate) separators: &'static [char],
    /// Klipper's block of saved values begins its lines with this.
    pub(crate) saved: Option<&'static str>,
    /// Comments may follow a value.
    pub(crate) inline: &'static [char],
}

/// All values in the order in which the control reads them.
pub(crate) fn items(job: &Job, style: Style) -> Vec<Item<'_>> {
    let mut items = Vec::new();
    let mut section = String::new();
    let mut last_piece = 0;
    for (piece, place) in job.places() {
        if piece != last_piece {
            section.clear();
            last_piece = piece;
        }
        let line = place.line();
        let saved = style.saved.and_then(|saved| line.strip_prefix(saved));
        let line = saved.unwrap_or(line);
        let indented = line.starts_with([' ', '\t']) && saved.is_none();
        let trimmed = line.trim();
        if trimmed.is_empty() || trimmed.starts_with(['#', ';']) {
            continue;
        }
        if let Some(name) = trimmed.strip_prefix('[') {
            let name = name.split(']').next().unwrap_or("");
            name.trim().clone_into(&mut section);
            continue;
        }
        // Klipper: what is indented goes on with the value before it.
        if style.saved.is_some() && indented {
            continue;
        }
        let Some((key, value)) = trimmed.split_once(style.separators) else {
            continue;
        };
        let end = comment(value, style.inline);
        let value = value.get(..end).unwrap_or(value).trim();
        let length = value.as_ptr() as usize + value.len() - trimmed.as_ptr() as usize;
        items.push(Item {
            section: section.clone(),
            key: key.trim().to_owned(),
            value,
            whole: trimmed.get(..length).unwrap_or(trimmed),
            place: place.of(value),
        });
    }
    items
}

/// Where a comment after a value begins.
fn comment(value: &str, marks: &[char]) -> usize {
    let mut before = ' ';
    for (at, c) in value.char_indices() {
        if marks.contains(&c) && before.is_whitespace() {
            return at;
        }
        before = c;
    }
    value.len()
}

/// The first value of a key, which is the one that LinuxCNC finds (`inifile.cc`).
pub(crate) fn first<'i, 't>(
    items: &'i [Item<'t>],
    section: &str,
    key: &str,
) -> Option<&'i Item<'t>> {
    items.iter().find(|item| is_of(item, section, key))
}

/// The last value of a key, as Klipper has it.
pub(crate) fn last<'i, 't>(
    items: &'i [Item<'t>],
    section: &str,
    key: &str,
) -> Option<&'i Item<'t>> {
    items.iter().rev().find(|item| is_of(item, section, key))
}

fn is_of(item: &Item<'_>, section: &str, key: &str) -> bool {
    item.section.eq_ignore_ascii_case(section) && item.key.eq_ignore_ascii_case(key)
}
