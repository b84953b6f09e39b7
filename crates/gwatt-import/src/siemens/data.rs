//! Machine data by name, with their indices.

use std::collections::BTreeMap;

use crate::near::Job;
use crate::text::Place;

/// A value.
pub(crate) struct Datum<'t> {
    pub(crate) name: &'t str,
    /// `0,AX1`.
    pub(crate) index: &'t str,
    pub(crate) text: &'t str,
    whole: &'t str,
    pub(crate) place: Place<'t>,
    /// `CHANDATA(n)` before it; 1 without one.
    pub(crate) channel: u32,
}

impl Datum<'_> {
    /// How it is shown as a source.
    pub(crate) fn source(&self) -> String {
        self.place.source(self.whole)
    }

    /// The last part of the index: the axis, or a number.
    pub(crate) fn axis(&self) -> &str {
        self.index.rsplit(',').next().unwrap_or("").trim()
    }

    /// What is the same in lines for the same value. Data of channels are those of each.
    fn key(&self) -> (String, &str, u32) {
        let of_channel = self.whole.contains("$MC_") || self.whole.contains("$SC_");
        let index = self.index.split_whitespace().collect::<String>();
        let channel = if of_channel { self.channel } else { 0 };
        (index.to_ascii_uppercase(), self.name, channel)
    }

    /// The first of two parts.
    pub(crate) fn number(&self) -> Option<usize> {
        let (first, _) = self.index.split_once(',')?;
        first.trim().parse().ok()
    }
}

/// The parts of a line: name, index, value, all of it.
pub(crate) fn line(line: &str) -> Option<(&str, &str, &str, &str)> {
    let start = line.find("$M").or_else(|| line.find("$S"))?;
    let rest = line.get(start..)?;
    let prefixed = ["$MA_", "$MC_", "$MN_", "$SC_", "$SA_", "$SN_"];
    let prefix = prefixed.iter().find(|prefix| rest.starts_with(**prefix))?;
    let before = line.get(..start)?.trim();
    // A number of the line, or nothing.
    let plain = before.is_empty()
        || before
            .strip_prefix('N')
            .is_some_and(|it| it.bytes().all(|b| b.is_ascii_digit()));
    let (left, right) = rest.split_once('=').filter(|_| plain)?;
    let left = left.trim();
    let (name, index) = match left.split_once('[') {
        Some((name, index)) => (name, index.trim_end_matches(']')),
        None => (left, ""),
    };
    let value = value(right.trim_start());
    let end = value.as_ptr() as usize + value.len() - line.as_ptr() as usize;
    Some((
        name.get(prefix.len()..)?,
        index.trim(),
        value,
        line.get(..end)?.trim_start(),
    ))
}

/// A value ends before a comment, or before the check sum of an archive (`'5a7e`).
fn value(right: &str) -> &str {
    let text = right.split(';').next().unwrap_or(right);
    if let Some(quoted) = text.strip_prefix('"') {
        let end = quoted.find('"').map_or(text.len(), |end| end + 2);
        return text.get(..end).unwrap_or(text);
    }
    let end = text.find(char::is_whitespace).unwrap_or(text.len());
    text.get(..end).unwrap_or(text)
}

/// All data.
pub(crate) struct Data<'t> {
    list: Vec<Datum<'t>>,
}

impl<'t> Data<'t> {
    /// Reads all lines; of several for the same value the last counts, as in the control.
    pub(crate) fn new(job: &'t Job) -> Self {
        let mut list: Vec<Datum<'t>> = Vec::new();
        let mut channel = 1;
        for (_, place) in job.places() {
            let text = place.line();
            if let Some(rest) = text.trim_start().strip_prefix("CHANDATA(") {
                let number = rest.split(')').next().and_then(|it| it.trim().parse().ok());
                channel = number.unwrap_or(channel);
                continue;
            }
            if let Some((name, index, value, whole)) = line(text) {
                list.push(Datum {
                    name,
                    index,
                    text: value,
                    whole,
                    place: place.of(value),
                    channel,
                });
            }
        }
        let mut last = BTreeMap::new();
        for (at, datum) in list.iter().enumerate() {
            last.insert(datum.key(), at);
        }
        let mut counts = vec![false; list.len()];
        for at in last.into_values() {
            if let Some(counts) = counts.get_mut(at) {
                *counts = true;
            }
        }
        let counting = list.into_iter().zip(counts).filter(|(_, counts)| *counts);
        Self {
            list: counting.map(|(datum, _)| datum).collect(),
        }
    }

    /// All values of a name.
    pub(crate) fn of<'d>(&'d self, name: &'d str) -> impl Iterator<Item = &'d Datum<'t>> {
        self.list.iter().filter(move |datum| datum.name == name)
    }

    /// The first value of the first channel.
    pub(crate) fn first(&self, name: &str) -> Option<&Datum<'t>> {
        self.list
            .iter()
            .find(|datum| datum.name == name && datum.channel == 1)
    }

    /// An entry of a table of the first channel.
    pub(crate) fn at(&self, name: &str, index: usize) -> Option<&Datum<'t>> {
        let mut list = self.list.iter();
        list.find(|it| it.name == name && it.channel == 1 && it.index.parse() == Ok(index))
    }

    /// Its text without quotes.
    pub(crate) fn entry(&self, name: &str, index: usize) -> Option<&str> {
        self.at(name, index).map(|it| it.text.trim_matches('"'))
    }

    /// The file of the first value.
    pub(crate) fn file(&self) -> &str {
        self.list.first().map_or("", |datum| datum.place.file())
    }

    /// Whether the name is there at all.
    pub(crate) fn has(&self, name: &str) -> bool {
        self.list.iter().any(|datum| datum.name == name)
    }
}
