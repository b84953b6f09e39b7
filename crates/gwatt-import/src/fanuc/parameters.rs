//! Parameters by number, each with its axis, path or spindle.

use std::collections::BTreeMap;

use crate::found::Figure;
use crate::near::Job;
use crate::text::{Log, Place};

/// Millimetres of an inch.
const INCH: f64 = 25.4;

/// A value.
pub(crate) struct Value<'t> {
    /// `A` axis, `L` or `T` path, `S` spindle; a blank where there is one value.
    pub(crate) of: char,
    /// Which one, from 1.
    pub(crate) index: usize,
    pub(crate) text: &'t str,
    pub(crate) source: String,
    pub(crate) place: Place<'t>,
    /// Which of all lines it stands in.
    row: usize,
}

impl Value<'_> {
    /// The path that it is for.
    fn path(&self) -> Option<usize> {
        matches!(self.of, 'L' | 'T').then_some(self.index)
    }
}

/// A bit of a parameter.
pub(crate) struct Bit {
    pub(crate) on: bool,
    pub(crate) index: usize,
    pub(crate) source: String,
}

/// All parameters.
pub(crate) struct Parameters<'t> {
    list: BTreeMap<u32, Vec<Value<'t>>>,
}

/// The number of a line of parameters, and the rest of it.
pub(crate) fn number(line: &str) -> Option<(u32, &str)> {
    let rest = line.trim_start().strip_prefix(['N', 'n'])?;
    let digits = rest.bytes().take_while(u8::is_ascii_digit).count();
    let number = rest.get(..digits)?.parse().ok()?;
    let tail = rest.get(digits..)?;
    let first = tail.trim_start().chars().next()?;
    matches!(
        first.to_ascii_uppercase(),
        'A' | 'L' | 'T' | 'S' | 'K' | 'P' | 'M' | 'I' | 'Q'
    )
    .then_some((number, tail))
}

impl<'t> Parameters<'t> {
    /// Reads all lines; of several for the same value the last counts, and what is for paths
    /// without axes does not.
    pub(crate) fn new(job: &'t Job, log: &mut Log) -> Self {
        let mut list: BTreeMap<u32, Vec<Value<'t>>> = BTreeMap::new();
        for (row, (_, place)) in job.places().enumerate() {
            let line = place.line();
            let code = line.split(['(', ';']).next().unwrap_or(line);
            if let Some((number, rest)) = number(code) {
                let list = list.entry(number).or_default();
                let known = list.len();
                values(number, rest, &place, list, log);
                for value in list.iter_mut().skip(known) {
                    value.row = row;
                }
            }
        }
        for values in list.values_mut() {
            let mut last = BTreeMap::new();
            for value in values.iter() {
                last.insert((value.of, value.index), value.row);
            }
            values.retain(|value| last.get(&(value.of, value.index)) == Some(&value.row));
        }
        let mut read = Self { list };
        read.drop_paths_without_axes();
        read
    }

    /// Parameter 981 gives each axis its path.
    fn drop_paths_without_axes(&mut self) {
        let there = self.of(981).filter(|it| self.exists(it.index));
        let used: Vec<usize> = there
            .filter_map(|it| it.text.parse().ok())
            .filter(|path| *path > 0)
            .collect();
        let is_used = |value: &Value<'_>| value.path().is_none_or(|path| used.contains(&path));
        for values in self.list.values_mut() {
            if values.iter().any(|it| it.path().is_some() && is_used(it)) {
                values.retain(is_used);
            }
        }
    }

    /// The value of the path that an axis belongs to, or that of the control.
    pub(crate) fn of_path(&self, number: u32, axis: usize) -> Option<&Value<'t>> {
        let path = self.axis(981, axis).and_then(|it| it.text.parse().ok());
        let own = self
            .of(number)
            .find(|it| path.is_some() && it.path() == path);
        own.or_else(|| self.of(number).find(|it| it.of != 'A' && it.of != 'S'))
    }

    /// The values of a parameter.
    pub(crate) fn of(&self, number: u32) -> impl Iterator<Item = &Value<'t>> {
        self.list.get(&number).into_iter().flatten()
    }

    /// The value of an axis.
    pub(crate) fn axis(&self, number: u32, index: usize) -> Option<&Value<'t>> {
        self.of(number)
            .find(|value| value.of == 'A' && value.index == index)
    }

    /// The numbers of a parameter; reports what is none.
    pub(crate) fn figures(&self, number: u32, log: &mut Log) -> Vec<Figure> {
        let read = |value: &Value<'t>| {
            let read = log.number(&value.place, value.text)?;
            Some(Figure::new(read, value.source.clone()))
        };
        self.of(number).filter_map(read).collect()
    }

    /// The speeds of a parameter in mm/min, of axes that are there, paths and the control.
    pub(crate) fn speeds(&self, number: u32, log: &mut Log) -> Vec<Figure> {
        let there = self
            .of(number)
            .filter(|it| it.of != 'A' || self.exists(it.index));
        let read = |value: &Value<'t>| {
            let read = log.number(&value.place, value.text)?;
            let speed = read * self.speed_unit(value.text);
            Some(Figure::new(speed, value.source.clone()))
        };
        there.filter_map(read).collect()
    }

    /// Whether an axis is there: one whose name (1020) is 0 is none.
    pub(crate) fn exists(&self, index: usize) -> bool {
        let name = self.axis(1020, index);
        name.is_none_or(|name| name.text.parse() != Ok(0.0_f64))
    }

    /// A bit of the first value.
    pub(crate) fn bit(&self, number: u32, bit: usize) -> Option<Bit> {
        self.bits(number, bit).into_iter().next()
    }

    /// A bit of all values: the last digit is bit 0.
    pub(crate) fn bits(&self, number: u32, bit: usize) -> Vec<Bit> {
        let read = |value: &Value<'t>| {
            let bits =
                value.text.len() == 8 && value.text.bytes().all(|b| matches!(b, b'0' | b'1'));
            let digit = value.text.bytes().rev().nth(bit).filter(|_| bits)?;
            Some(Bit {
                on: digit == b'1',
                index: value.index,
                source: value.source.clone(),
            })
        };
        self.of(number).filter_map(read).collect()
    }

    /// Millimetres of the unit of speeds with a decimal point: 25.4 on an inch machine (1001,
    /// bit INM).
    pub(crate) fn inch(&self) -> f64 {
        let inch = self.bit(1001, 0).is_some_and(|bit| bit.on);
        if inch { INCH } else { 1.0 }
    }

    /// Millimetres of the unit of a speed as it is written.
    pub(crate) fn speed_unit(&self, text: &str) -> f64 {
        let inch = self.inch();
        // Whole numbers count tenths of an inch.
        if inch > 1.0 && !text.contains('.') {
            inch / 10.0
        } else {
            inch
        }
    }

    /// Millimetres (degrees) of the unit of a position as it is written: whole numbers count
    /// least increments (1004 or 1013: IS-A, IS-B, IS-C).
    pub(crate) fn position_unit(&self, text: &str, rotary: bool) -> f64 {
        let is_inch = self.inch() > 1.0 && !rotary;
        if text.contains('.') {
            return if is_inch { INCH } else { 1.0 };
        }
        let set = |bit| {
            [1004, 1013]
                .iter()
                .any(|number| self.bit(*number, bit).is_some_and(|bit| bit.on))
        };
        let step = match (set(0), set(1)) {
            (true, false) => 0.01,
            (false, true) => 0.0001,
            _ => 0.001,
        };
        if is_inch { step / 10.0 * INCH } else { step }
    }
}

/// The values of a line: `A1P36000A2P36000`, `L1P…`, `S1P…`, `P…`.
fn values<'t>(
    number: u32,
    rest: &'t str,
    place: &Place<'t>,
    list: &mut Vec<Value<'t>>,
    log: &mut Log,
) {
    let (mut of, mut index) = (' ', 0);
    let mut from = 0;
    while let Some(tail) = rest.get(from..) {
        let skipped = tail.len() - tail.trim_start().len();
        let tail = tail.trim_start();
        let Some(letter) = tail.chars().next() else {
            break;
        };
        let body = tail.get(letter.len_utf8()..).unwrap_or("");
        let blanks = body.len() - body.trim_start().len();
        let trimmed = body.trim_start();
        let length = trimmed
            .find(|c: char| c.is_whitespace() || c.is_ascii_alphabetic())
            .unwrap_or(trimmed.len());
        let text = trimmed.get(..length).unwrap_or("");
        match letter.to_ascii_uppercase() {
            selector @ ('A' | 'L' | 'T' | 'S' | 'K') => {
                let Ok(read) = text.parse() else {
                    let message = format!("`{letter}{text}` names no axis, path or spindle");
                    log.error(
                        &place.of(tail.get(..1).unwrap_or("")),
                        message,
                        "write it as A1 P…",
                    );
                    return;
                };
                (of, index) = (selector, read);
            }
            'P' | 'M' => {
                let which = if of == ' ' {
                    String::new()
                } else {
                    format!(" {of}{index}")
                };
                list.push(Value {
                    of,
                    index,
                    text,
                    source: place.source(&format!("N{number:05}{which} {letter}{text}")),
                    place: place.of(if text.is_empty() { tail } else { text }),
                    row: 0,
                });
            }
            'I' => {
                let message = "values in inches (I) are not read".to_owned();
                log.error(
                    &place.of(tail),
                    message,
                    "write the parameters in metric units",
                );
                return;
            }
            // What the line holds: Q1 parameters, Q0 compensation of pitch errors.
            'Q' if text == "1" => {}
            // Words that no parameter of interest has.
            _ => return,
        }
        from += skipped + letter.len_utf8() + blanks + length;
    }
}
