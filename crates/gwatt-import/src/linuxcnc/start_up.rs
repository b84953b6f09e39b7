//! The start-up code: modes in force before a program says so.
//!
//! Sources: LinuxCNC documentation, "INI Configuration", `[RS274NGC]`; "G-Code Overview" for how
//! blocks are cut into words: blanks do not matter.

use super::config::{Config, INCH, named};
use crate::found::{Found, shown};
use crate::ini::{Item, first};
use crate::text::{Log, Place};

/// A word: its letter and number.
struct Word<'t> {
    letter: char,
    value: f64,
    /// Such as `G90.1`, without zeros and blanks that say nothing.
    name: String,
    place: Place<'t>,
}

/// What holds in gwatt at the beginning too, or moves nothing and raises no limit. G7, G20, G64,
/// G90.1 and G95 have fields; G93 is refused.
const COUNTED: [&str; 26] = [
    "G7", "G8", "G17", "G20", "G21", "G40", "G49", "G50", "G54", "G64", "G80", "G90", "G90.1",
    "G91.1", "G92.1", "G92.2", "G93", "G94", "G95", "G97", "G98", "M5", "M9", "M48", "M49", "M53",
];

/// Modes without a field, of which a message says what counts instead: word, why, help.
const SPECIAL: [(&str, &str, &str); 3] = [
    (
        "G91",
        "coordinates count as absolute until the program says otherwise",
        "write G90 or G91 at the beginning of each program",
    ),
    (
        "G96",
        "S counts as revolutions per minute until the program says otherwise, which may be too low",
        "write G96 or G97 at the beginning of each program",
    ),
    (
        "M52",
        "the pin motion.adaptive-feed multiplies all speeds, and counts as 1",
        "where it may be above 1, multiply `feed` of `override_max_percent` under [limits] by its largest value",
    ),
];

/// `RS274NGC_STARTUP_CODE`: what has a field is taken, and the rest is named.
pub(super) fn read(config: &Config<'_>, found: &mut Found, log: &mut Log) {
    let item = ["RS274NGC_STARTUP_CODE", "STARTUP_CODE"]
        .iter()
        .find_map(|key| {
            let own = first(&config.items, "RS274NGC", key);
            own.or_else(|| first(&config.items, "EMC", key))
        });
    let words = item.map_or(Vec::new(), |item| words(item, log));
    let has = |name: &str| words.iter().any(|word| word.name == name);
    let inch = has("G20") || (config.linear == INCH && !has("G21"));
    let unit_mm = if inch { INCH } else { 1.0 };
    if inch {
        let units = first(&config.items, "TRAJ", "LINEAR_UNITS");
        let source = if has("G20") { item } else { units };
        found.language("units = \"inch\"", source.map_or(String::new(), named));
    }
    let Some(item) = item else { return };
    if has("G7") {
        found.language("diameter = true", named(item));
    }
    if has("G90.1") {
        found.language("arc_centre = \"absolute\"", named(item));
    }
    feed(item, &words, unit_mm, found, log);
    if has("G64") {
        // P of several is refused by the interpreter.
        let given = words.iter().filter(|word| word.letter == 'P');
        let tolerance = given.map(|word| word.value).fold(0.0, f64::max);
        let field = format!("power_on_tolerance_mm = {}", shown(tolerance * unit_mm));
        found.language(field, named(item));
    }
    left_out(item, &words, found, log);
}

/// G93 to G95, and F.
fn feed(item: &Item<'_>, words: &[Word<'_>], unit_mm: f64, found: &mut Found, log: &mut Log) {
    let of = |name: &str| words.iter().find(|word| word.name == name);
    if let Some(word) = of("G93") {
        let message =
            "G93 of the start-up code has no field in a machine file: F would count too low";
        let help = "put G94 in its place, and write G93 into the programs that need it";
        log.error(&word.place, message.to_owned(), help);
        return;
    }
    if of("G95").is_some() {
        found.language("feed = \"per-revolution\"", named(item));
        return;
    }
    let given = words
        .iter()
        .find(|word| word.letter == 'F' && word.value > 0.0);
    if let Some(word) = given {
        let field = format!("power_on_feed_mm_min = {}", shown(word.value * unit_mm));
        found.language(field, named(item));
    }
}

/// Names the words that have no field.
fn left_out(item: &Item<'_>, words: &[Word<'_>], found: &mut Found, log: &mut Log) {
    let has = |name: &str| words.iter().any(|word| word.name == name);
    for word in words {
        if let Some((name, why, help)) = SPECIAL.iter().find(|(name, ..)| *name == word.name) {
            let message =
                format!("{name} of the start-up code has no field in a machine file: {why}");
            found.remarks.push(format!("{}: {why}", named(item)));
            log.warning(&word.place, message, help);
        }
    }
    let is_counted = |word: &Word<'_>| match word.letter {
        'G' | 'M' => {
            let offset_is_none = word.name == "G43" && has("H0");
            let is_special = SPECIAL.iter().any(|(name, ..)| *name == word.name);
            offset_is_none || is_special || COUNTED.contains(&word.name.as_str())
        }
        'P' => has("G64") || has("M52"),
        'H' => word.value == 0.0,
        'D' | 'S' => has("G96"),
        'F' => !has("G95"),
        'N' => true,
        _ => false,
    };
    let left: Vec<&Word<'_>> = words.iter().filter(|word| !is_counted(word)).collect();
    let Some(first) = left.first() else { return };
    let names: Vec<&str> = left.iter().map(|word| word.name.as_str()).collect();
    let names = names.join(" ");
    let message = format!(
        "`{names}` of the start-up code has no field in a machine file, and does not count"
    );
    let help = "write it at the beginning of each program where it changes what the program does";
    log.warning(&first.place, message, help);
    found
        .remarks
        .push(format!("{}: `{names}` does not count", named(item)));
}

/// The words of a block, without comments; what cannot be read is named.
fn words<'t>(item: &Item<'t>, log: &mut Log) -> Vec<Word<'t>> {
    let mut list = Vec::new();
    let mut rest = item.value;
    loop {
        rest = rest.trim_start();
        let Some(letter) = rest.chars().next() else {
            return list;
        };
        if letter == ';' {
            return list;
        }
        if letter == '(' {
            rest = rest.split_once(')').map_or("", |(_, after)| after);
            continue;
        }
        let length = letter.len_utf8();
        let number = number_length(rest.get(length..).unwrap_or(""));
        let Some((whole, after)) = rest.split_at_checked(length + number) else {
            return list;
        };
        let digits: String = whole
            .chars()
            .skip(1)
            .filter(|c| !c.is_whitespace())
            .collect();
        let value = digits.parse::<f64>().ok().filter(|value| value.is_finite());
        let Some(value) = value.filter(|_| letter.is_ascii_alphabetic()) else {
            let message = format!("`{rest}` of the start-up code is not read, and does not count");
            let help = "only letters with numbers are: see what it sets, and write that at the beginning of \
                        each program";
            log.warning(&item.place.of(rest), message, help);
            return list;
        };
        let letter = letter.to_ascii_uppercase();
        list.push(Word {
            letter,
            value,
            name: format!("{letter}{}", shown(value)),
            place: item.place.of(whole.trim_end()),
        });
        rest = after;
    }
}

/// The length of a number that may have blanks in it.
fn number_length(text: &str) -> usize {
    let in_number = |c: char| c.is_ascii_digit() || c == '.' || c == ' ' || c == '\t';
    let signed = text.trim_start_matches([' ', '\t']);
    let unsigned = signed.strip_prefix(['+', '-']).unwrap_or(signed);
    let digits = unsigned.trim_start_matches(in_number);
    text.len() - digits.len()
}
