//! Elements of XML: one for each signal with its name, one for each sample with its time and
//! its values by the number of the signal.

use super::written::{Foreign, Read, Written, figure, with_rows};

/// Elements: one for each signal in order, more about each, and one for each sample.
const SIGNAL: &str = "dataSignal";
const ABOUT: &str = "signal";
const SAMPLE: &str = "rec";
/// The element that holds them.
const FRAME: &str = "dataFrame";

/// An element's name, its attributes, and the index of its line.
struct Element<'a> {
    name: &'a str,
    rest: &'a str,
    line: usize,
}

impl<'a> Element<'a> {
    /// An attribute as it stands in the file.
    fn raw(&self, wanted: &str) -> Option<&'a str> {
        let mut rest = self.rest;
        loop {
            let (name, after) = rest.split_once('=')?;
            let after = after.trim_start();
            let quote = after.chars().next().filter(|c| "\"'".contains(*c))?;
            let (value, next) = after.get(1..)?.split_once(quote)?;
            if name.trim() == wanted {
                return Some(value);
            }
            rest = next;
        }
    }

    /// An attribute as text.
    fn text(&self, wanted: &str) -> Option<String> {
        let marks = [
            ("&lt;", "<"),
            ("&gt;", ">"),
            ("&quot;", "\""),
            ("&apos;", "'"),
            ("&amp;", "&"),
        ];
        let raw = self.raw(wanted)?.to_owned();
        Some(
            marks
                .iter()
                .fold(raw, |text, (mark, c)| text.replace(mark, c)),
        )
    }
}

/// The elements of a text, one after another, whatever holds them.
fn elements(text: &str) -> impl Iterator<Item = Element<'_>> {
    let (mut rest, mut line) = (text, 0);
    std::iter::from_fn(move || {
        loop {
            let (before, after) = rest.split_once('<')?;
            line += before.matches('\n').count();
            let (inside, next) = after.split_once('>')?;
            let here = line;
            line += inside.matches('\n').count();
            rest = next;
            let inside = inside.trim_end_matches('/');
            let end = inside.find(char::is_whitespace).unwrap_or(inside.len());
            let (name, attributes) = inside.split_at(end);
            if !name.is_empty() && !name.starts_with(['?', '!', '/']) {
                return Some(Element {
                    name,
                    rest: attributes,
                    line: here,
                });
            }
        }
    })
}

/// Reads samples of the signals that all of them have.
pub(super) fn read(text: &str) -> Read {
    let first = text.lines().next().unwrap_or_default();
    if !first.trim_start().starts_with('<') {
        return Err(Foreign::new(0, first, 0, "XML"));
    }
    if !elements(text).any(|element| element.name == FRAME) {
        let last = text.lines().count();
        return Err(Foreign::new(last, "", 0, format!("<{FRAME}>")));
    }
    let names = names(text);
    let keys: Vec<String> = (1..=names.len())
        .map(|number| format!("f{number}"))
        .collect();
    let samples = || elements(text).filter(|element| element.name == SAMPLE);
    let present: Vec<bool> = keys
        .iter()
        .map(|key| samples().all(|sample| sample.raw(key).is_some()))
        .collect();
    let pairs = || names.iter().zip(&present);
    let ours = pairs().filter(|(_, present)| **present);
    let mut table = Written::new(ours.map(|(name, _)| name.clone()));
    let others = pairs().filter(|(_, present)| !**present);
    table.ignored = others.map(|(name, _)| name.clone()).collect();
    let mut last = 0;
    for sample in samples() {
        last = sample.line;
        let Some(time_s) = sample.raw("time").and_then(figure) else {
            let wanted = format!("a time in <{SAMPLE}>");
            let shown = text.lines().nth(last).unwrap_or_default();
            let byte = shown.find(SAMPLE).unwrap_or_default();
            return Err(Foreign::new(last, shown, byte, wanted));
        };
        let values = keys.iter().zip(&present).filter(|(_, present)| **present);
        let values = values.map(|(key, _)| sample.raw(key).unwrap_or_default());
        table.add(last as u64 + 1, time_s, values);
    }
    with_rows(table, last, &format!("elements <{SAMPLE}> with times"))
}

/// The names of the signals in order: what they are described as, and their path where that
/// is the same for several.
fn names(text: &str) -> Vec<String> {
    let described = |element: &Element<'_>| {
        let description = element.text("description")?.replace(" (64 bit)", "");
        Some((description, element.text("name").unwrap_or_default()))
    };
    let about: Vec<(String, (String, String))> = elements(text)
        .filter(|element| element.name.eq_ignore_ascii_case(ABOUT))
        .filter_map(|element| Some((element.text("key")?, described(&element)?)))
        .collect();
    let signals = elements(text).filter(|element| element.name == SIGNAL);
    let all: Vec<(String, String)> = signals
        .map(|signal| {
            let key = signal.text("key").unwrap_or_default();
            let other = about.iter().find(|(known, _)| *known == key);
            let other = other.map(|(_, described)| described.clone());
            described(&signal).or(other).unwrap_or((key, String::new()))
        })
        .collect();
    all.iter()
        .map(|(description, path)| {
            let same = all.iter().filter(|(other, _)| other == description);
            match same.count() {
                1 => description.clone(),
                _ => format!("{description} {path}"),
            }
        })
        .collect()
}
