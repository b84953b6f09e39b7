//! Lists of words and of axes in controller profiles and machine files.

use super::findings::Findings;
use super::value::At;
use super::word;
use crate::axis::{AxisId, AxisSet};

/// The axes of these letters.
pub(crate) fn axes_named(findings: &mut Findings<'_>, letters: &[At<String>]) -> AxisSet {
    let mut axes = AxisSet::default();
    for letter in letters {
        let named = match letter.value.as_bytes() {
            [byte] => AxisId::from_letter(*byte),
            _ => None,
        };
        if let Some(axis) = named {
            axes.insert(axis as usize);
        } else {
            let message = format!("\"{}\" is not the letter of an axis", letter.value);
            findings.error("machine-word", &letter.span, message, None);
        }
    }
    axes
}

/// Letters and numbers × 10 of G and M words.
pub(crate) fn moving_words(findings: &mut Findings<'_>, words: &[At<String>]) -> Vec<(u8, u16)> {
    let mut found = Vec::new();
    for text in words {
        if let Some(code @ (b'G' | b'M', _)) = word::code(&text.value) {
            found.push(code);
        } else {
            let message = format!("\"{}\" is not a G or M word", text.value);
            let help = Some("such as \"M6\" or \"G88.6\"".to_owned());
            findings.error("machine-word", &text.span, message, help);
        }
    }
    found
}

/// Ignored G words (number × 10) and M numbers.
pub(crate) fn ignored(findings: &mut Findings<'_>, words: &[At<String>]) -> (Vec<u16>, Vec<u16>) {
    let (mut g, mut m) = (Vec::new(), Vec::new());
    for text in words {
        match word::code(&text.value) {
            Some((b'G', code)) => g.push(code),
            Some((b'M', code)) if code % 10 == 0 => m.push(code / 10),
            _ => {
                let message = format!("\"{}\" is not a G or M word", text.value);
                let help = Some("such as \"G187\" or \"M48\"".to_owned());
                findings.error("machine-word", &text.span, message, help);
            }
        }
    }
    (g, m)
}
