//! Where an axis' settings stand, and `generic_cartesian`, whose steppers move carriages.
//!
//! Source: Klipper documentation, "Configuration reference", "Generic Cartesian Kinematics".

use gwatt_machine::AxisId;

use super::Config;
use crate::found::Found;
use crate::ini::{Item, last};
use crate::kinematics;
use crate::text::Log;

/// The sections of an axis.
pub(super) struct Section {
    /// That of travel and homing.
    pub(super) carriage: String,
    /// Those of its steppers.
    pub(super) steppers: Vec<String>,
}

/// The sections of an axis; `usual` is that of its first stepper.
pub(super) fn section_of(config: &Config<'_, '_>, id: AxisId, usual: &str) -> Section {
    let generic = last(config.items, "printer", "kinematics")
        .is_some_and(|item| item.value == "generic_cartesian");
    if !generic {
        let more = (1..16).map(|number| format!("{usual}{number}"));
        let more = more.filter(|section| config.has(section));
        return Section {
            carriage: usual.to_owned(),
            steppers: std::iter::once(usual.to_owned()).chain(more).collect(),
        };
    }
    let letter = (id.letter() as char).to_ascii_lowercase().to_string();
    let own = |item: &&Item<'_>| {
        let name = item.section.strip_prefix("carriage ").map(str::trim);
        name.is_some_and(|name| name.eq_ignore_ascii_case(&letter))
            || name.is_some() && item.key == "axis" && item.value.eq_ignore_ascii_case(&letter)
    };
    let carriage = config.items.iter().find(own);
    let carriage = carriage.map_or(format!("carriage {letter}"), |item| item.section.clone());
    let name = carriage.trim_start_matches("carriage ").trim().to_owned();
    let moved = steppers(config).filter(|item| names(item.value).any(|other| other == name));
    let steppers = moved.map(|item| item.section.clone()).collect();
    Section { carriage, steppers }
}

/// What each stepper moves: `carriages: x`, `carriages: x-y`.
fn steppers<'c, 't>(config: &'c Config<'_, 't>) -> impl Iterator<Item = &'c Item<'t>> {
    let items = config.items.iter();
    items.filter(|item| item.section.starts_with("stepper ") && item.key == "carriages")
}

/// The carriages of a sum, in which factors may stand.
fn names(sum: &str) -> impl Iterator<Item = &str> {
    let words = sum.split(|c: char| !(c.is_ascii_alphanumeric() || matches!(c, '_' | '.')));
    words.filter(|word| word.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_'))
}

/// Steppers that move several carriages each: two as in `CoreXY`, or what is not described.
pub(super) fn kinematics_of(config: &Config<'_, '_>, found: &mut Found, log: &mut Log) {
    let coupled: Vec<&Item<'_>> = steppers(config)
        .filter(|item| names(item.value).count() > 1)
        .collect();
    let plain = |sum: &str| sum.split_whitespace().collect::<String>();
    let sums: Vec<String> = coupled.iter().map(|item| plain(item.value)).collect();
    let pair = |sum: &str, sign: char| {
        let (first, second) = sum.split_once(sign)?;
        Some((first.to_owned(), second.to_owned()))
    };
    let core = |a: &str, b: &str| {
        let (plus, minus) = (pair(a, '+'), pair(b, '-'));
        let named = |text: &str| names(text).eq([text]);
        plus.is_some_and(|both| named(&both.0) && named(&both.1) && minus == Some(both))
    };
    match (coupled.as_slice(), sums.as_slice()) {
        ([], _) => {}
        ([first, _], [a, b]) if core(a, b) || core(b, a) => {
            let letters: String = a.chars().filter(char::is_ascii_alphabetic).collect();
            let name = match letters.as_str() {
                "xy" | "yx" => Some("corexy"),
                "xz" | "zx" => Some("corexz"),
                _ => None,
            };
            kinematics::core(found, log, &first.place, first.whole, name);
        }
        ([first, ..], _) => kinematics::refuse(log, &first.place, first.whole),
    }
}
