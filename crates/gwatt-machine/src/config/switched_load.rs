//! Loads that program words switch.

use super::converter_name::converter_of;
use super::findings::Findings;
use super::machine_file::LoadTable;
use super::value::At;
use super::word;
use crate::controller::Controller;
use crate::model::{Converter, Load};

/// M words of printers whose value 0 switches off what they switch on: heaters of nozzle, bed
/// and chamber, with and without waiting, fans, and tools of `RepRapFirmware` (Marlin, "G-code
/// index": M104, M106, M109, M140, M141, M190, M191; `RepRapFirmware`, "G-code dictionary":
/// M568).
const BY_VALUE: [f64; 8] = [104.0, 106.0, 109.0, 140.0, 141.0, 190.0, 191.0, 568.0];

/// Reads a load.
pub(super) fn load(
    findings: &mut Findings<'_>,
    table: &At<LoadTable>,
    converters: &[Converter],
    controller: &Controller,
) -> Option<Load> {
    let mut read = |text: &At<String>| {
        let word = word::parse(&text.value);
        if word.is_none() {
            let message = format!("\"{}\" is not a program word", text.value);
            let help = Some("a letter and a number, such as \"M8\"".to_owned());
            findings.error("machine-load", &text.span, message, help);
        }
        word
    };
    let LoadTable {
        on,
        off,
        power_w,
        converter,
    } = &table.value;
    let mut on_words = Vec::new();
    for text in on.iter().flat_map(|list| &list.0) {
        on_words.extend(read(text));
    }
    let mut off_words = Vec::new();
    for text in off.iter().flat_map(|list| &list.0) {
        off_words.extend(read(text).map(|word| (word, &text.span)));
    }
    for (word, span) in &off_words {
        if on_words.contains(word) {
            let message = "the same word switches the load on and off";
            findings.error("machine-load", span, message, None);
        }
    }
    if off.is_none() && !follows_value(&on_words, controller) {
        let message = "`off` is missing in `load`";
        let help = "Word or words that switch it off; on printers heaters and fans need none, \
                    which the value 0 switches off";
        findings.error("machine-missing", &table.span, message, Some(help.into()));
    }
    let converter = match converter {
        Some(name) => converter_of(findings, name, converters)?,
        None if converters.len() > 1 => {
            let message = "with several converters, a load needs `converter`";
            findings.error("machine-missing", &table.span, message, None);
            return None;
        }
        None => 0,
    };
    if on_words.is_empty() {
        return None;
    }
    Some(Load {
        on: on_words,
        off: off_words.into_iter().map(|(word, _)| word).collect(),
        power_w: power_w.as_ref()?.value,
        converter,
    })
}

/// Whether each word that switches it on switches it off too, by the value 0.
fn follows_value(on: &[(u8, f64)], controller: &Controller) -> bool {
    let by_value = |&(letter, number): &(u8, f64)| letter == b'M' && BY_VALUE.contains(&number);
    controller.language.family.facts().printer && on.iter().all(by_value)
}
