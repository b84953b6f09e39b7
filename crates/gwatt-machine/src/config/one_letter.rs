//! Addresses of one letter.

use super::findings::Findings;
use super::value::At;
use super::word;

pub(super) fn one_letter(findings: &mut Findings<'_>, text: &At<String>) -> Option<u8> {
    let letter = word::letter(&text.value);
    if letter.is_none() {
        let message = format!("\"{}\" is not a letter", text.value);
        findings.error("machine-word", &text.span, message, None);
    }
    letter
}
