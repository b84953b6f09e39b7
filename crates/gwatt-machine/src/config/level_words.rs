//! The words of `[[levels]]`: which a controller can have, and which mean something else
//! already.

use super::findings::Findings;
use super::value::OneOrMany;
use super::word;
use crate::axis::AxisId;
use crate::controller::{Controller, Language};
use crate::family::{Family, LevelWords};
use crate::levels::LevelWord;
use crate::model::Load;

/// M words that every control of these families reads itself.
const KNOWN_M: [u16; 10] = [17, 19, 29, 30, 60, 96, 97, 98, 99, 109];

/// Words that are taken already.
pub(crate) struct Taken<'a> {
    language: &'a Language,
    controller: &'a str,
    loads: &'a [Load],
    seen: Vec<LevelWord>,
}

impl<'a> Taken<'a> {
    pub(crate) fn new(controller: &'a Controller, loads: &'a [Load]) -> Self {
        Self {
            language: &controller.language,
            controller: &controller.name,
            loads,
            seen: Vec::new(),
        }
    }

    /// Whether the profile knows a document that says what a word does.
    fn is_documented(&self, wanted: &LevelWord) -> bool {
        self.language.levels.iter().any(|text| {
            let code = word::code(text);
            wanted.is_named(text) || code.is_some() && code == wanted.code()
        })
    }

    /// Why a word cannot select a level here.
    fn objection(&self, wanted: &LevelWord) -> Option<String> {
        let same = |other: &&LevelWord| {
            other.is_named(&wanted.text) || !wanted.codes.is_empty() && other.codes == wanted.codes
        };
        if self.seen.iter().any(|other| same(&other)) {
            return Some("it is given twice".to_owned());
        }
        if self.is_documented(wanted) {
            return None;
        }
        if self.language.family.facts().level_words == LevelWords::Documented {
            return Some(format!(
                "the controller `{}` is not known to have such a word",
                self.controller
            ));
        }
        let switches = |load: &Load| {
            let first = wanted.codes.first();
            first.is_some_and(|word| load.on.contains(word) || load.off.contains(word))
        };
        match wanted.code() {
            None => (!wanted.text.starts_with("DYN"))
                .then(|| "it is none of the dynamic modes".to_owned()),
            Some((b'M', _)) if self.loads.iter().any(switches) => {
                Some("it switches a [[load]]".to_owned())
            }
            Some((b'M', number)) => {
                let own = number < 100 || number % 10 != 0 || KNOWN_M.contains(&(number / 10));
                own.then(|| "it has a meaning of its own".to_owned())
            }
            Some((_, number)) => (!self.language.ignored_g.contains(&number)).then(|| {
                "it is none of the G words that move nothing (`ignored` in the controller \
                 profile, or under [language])"
                    .to_owned()
            }),
        }
    }
}

/// The words of a level, and whether documents say what they do.
pub(crate) fn words(
    findings: &mut Findings<'_>,
    texts: Option<&OneOrMany<String>>,
    taken: &mut Taken<'_>,
) -> (Vec<LevelWord>, bool) {
    let mut found = Vec::new();
    let mut documented = true;
    for text in texts.iter().flat_map(|texts| &texts.0) {
        let Some(word) = parse(&text.value, taken.language.family) else {
            let message = format!("\"{}\" is no word that could select a level", text.value);
            let help = "such as \"G187 P1\", \"M31\" or, on a SINUMERIK, \"DYNFINISH\"";
            findings.error("machine-levels", &text.span, message, Some(help.to_owned()));
            continue;
        };
        if let Some(reason) = taken.objection(&word) {
            let message = format!("\"{}\" cannot select a level: {reason}", text.value);
            findings.error("machine-levels", &text.span, message, None);
        }
        documented &= taken.is_documented(&word);
        taken.seen.push(word.clone());
        found.push(word);
    }
    (found, documented)
}

/// A name, or a G or M word with further words after it.
fn parse(text: &str, family: Family) -> Option<LevelWord> {
    let text = text.trim();
    let is_name = text.len() > 1 && text.bytes().all(|byte| byte.is_ascii_alphabetic());
    if is_name && family.facts().level_words == LevelWords::CodesAndNames {
        let text = text.to_ascii_uppercase();
        return Some(LevelWord {
            text,
            codes: Vec::new(),
        });
    }
    let mut codes = Vec::new();
    for part in text.split_ascii_whitespace() {
        let (letter, number) = word::parse(part)?;
        let first = codes.is_empty();
        let suits = match letter {
            b'G' | b'M' => first && word::code(part).is_some(),
            b'F' | b'N' | b'O' | b'S' | b'T' => false,
            _ => !first && AxisId::from_letter(letter).is_none(),
        };
        if !suits || codes.iter().any(|(other, _)| *other == letter) {
            return None;
        }
        codes.push((letter, number));
    }
    (!codes.is_empty()).then(|| LevelWord {
        text: text.to_ascii_uppercase(),
        codes,
    })
}
