//! Moves that the INI file adds to words: those of a tool change, and remaps.
//!
//! Source: LinuxCNC documentation, "INI Configuration", `[EMCIO]`; "Remap: Extending G-Code".

use gwatt_machine::{ALL_AXES, AxisId};

use super::config::{Config, named};
use crate::found::Found;
use crate::ini::{Item, first};
use crate::text::Log;

/// Axes that M6 moves by itself.
pub(super) fn tool_change(config: &Config<'_>, found: &mut Found, log: &mut Log) {
    let set = |key: &str| {
        let item = first(&config.items, "EMCIO", key)?;
        let off = ["0", "NO", "FALSE", "OFF"];
        let off = off.iter().any(|off| item.value.eq_ignore_ascii_case(off));
        (!off && !item.value.is_empty()).then_some(item)
    };
    let place = set_text(config, "TOOL_CHANGE_POSITION");
    let (quill, g30) = (set("TOOL_CHANGE_QUILL_UP"), set("TOOL_CHANGE_AT_G30"));
    let known: Vec<AxisId> = ALL_AXES
        .into_iter()
        .filter(|id| found.axes[*id as usize].is_some())
        .collect();
    // Three places are those of X Y Z, six those of A B C too, nine those of all.
    let places = place.map_or(0, |item| {
        item.value
            .split([' ', '\t', ','])
            .filter(|it| !it.is_empty())
            .count()
    });
    let first = |count: usize| move |id: &AxisId| (*id as usize) < count;
    let axes: Vec<AxisId> = if g30.is_some() {
        known
    } else if place.is_some() {
        let count = places.max(3).next_multiple_of(3);
        known.into_iter().filter(first(count)).collect()
    } else if quill.is_some() {
        known.into_iter().filter(|id| *id == AxisId::Z).collect()
    } else {
        return;
    };
    let sources: Vec<String> = [place, quill, g30]
        .into_iter()
        .flatten()
        .map(named)
        .collect();
    let letters: Vec<String> = axes
        .iter()
        .map(|id| format!("\"{}\"", id.letter() as char))
        .collect();
    if letters.is_empty() {
        if let Some(item) = quill.or(g30).or(place) {
            let message = format!(
                "{}: M6 moves axes that the file does not describe",
                item.key
            );
            log.warning(&item.place, message, "give the file that describes them");
        }
        return;
    }
    found.language(
        format!("tool_change_moves = [{}]", letters.join(", ")),
        sources.join(", "),
    );
}

/// A value that is not empty.
fn set_text<'c, 'j>(config: &'c Config<'j>, key: &str) -> Option<&'c Item<'j>> {
    first(&config.items, "EMCIO", key).filter(|item| !item.value.is_empty())
}

/// Words that the builder of the machine has put in place of the interpreter's, or added.
pub(super) fn remaps(config: &Config<'_>, found: &mut Found, log: &mut Log) {
    let of_remap = |item: &&Item<'_>| {
        item.section.eq_ignore_ascii_case("RS274NGC") && item.key.eq_ignore_ascii_case("REMAP")
    };
    let mut words: Vec<String> = Vec::new();
    let mut sources: Vec<String> = Vec::new();
    for item in config.items.iter().filter(of_remap) {
        let Some(written) = item.value.split_whitespace().next() else {
            continue;
        };
        let word = written.to_ascii_uppercase();
        let place = item.place.of(written);
        if is_word(&word) {
            let message =
                format!("{word} is remapped: it counts as moving every axis at its full speed");
            let help = "it stands in `unknown_moves` under [language]; a word that moves no axis and raises \
                        no limit goes into `ignored` instead";
            log.warning(&place, message, help);
            if !words.contains(&word) {
                words.push(word);
                sources.push(named(item));
            }
        } else {
            let message = format!("`{word}` is remapped, and what its remap moves does not count");
            let help = "powers may be too low where it moves axes: write these moves into the programs, or \
                        list a word that stands next to it, such as M6, in `unknown_moves` under [language]";
            log.warning(&place, message, help);
            found.remarks.push(format!(
                "{}: what this remap moves does not count",
                named(item)
            ));
        }
    }
    if let (Some(first), Some(last)) = (sources.first(), sources.last()) {
        let source = if sources.len() == 1 {
            first.clone()
        } else {
            format!("{first} to {last}")
        };
        let words: Vec<String> = words.iter().map(|word| format!("\"{word}\"")).collect();
        found.language(format!("unknown_moves = [{}]", words.join(", ")), source);
    }
}

/// A G or M word with at most one decimal, as programs have it.
fn is_word(word: &str) -> bool {
    let digits = word.strip_prefix(['G', 'M']).unwrap_or("");
    let (whole, part) = digits.split_once('.').unwrap_or((digits, "0"));
    let number = |digits: &str, most: usize| {
        (1..=most).contains(&digits.len()) && digits.bytes().all(|byte| byte.is_ascii_digit())
    };
    number(whole, 4) && number(part, 1)
}
