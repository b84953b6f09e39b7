//! Lines about each channel, each beginning with what it says; a blank line; and lines of
//! numbers. Channels may have times of their own, or share them.

use super::super::layout::cells;
use super::written::{Foreign, Read, Written, figure, with_rows};

/// Begins the file and the lines about channels, and stands over columns of times.
const NAME: &str = "Name";
const PERIOD: &str = "SampleTime[ms]";
const UNIT: &str = "Unit";
/// What a channel without a unit has for one.
const NO_UNIT: &str = "(None)";
/// What may end a file.
const END: &str = "EOF";
/// Times that are larger are file times, in units of 100 ns.
const FILE_TIME: f64 = 1e15;
const TICK_S: f64 = 1e-7;

/// A channel with its columns.
struct Channel {
    name: String,
    period: String,
    time: usize,
    value: usize,
}

/// The lines about channels.
struct Header {
    separator: u8,
    channels: Vec<Channel>,
    /// The index of the first line after them.
    end: usize,
}

/// Reads channels with the times of the first one of those that most have.
pub(super) fn read(text: &str) -> Read {
    let lines: Vec<&str> = text.lines().collect();
    let header = header(&lines)?;
    let rows = || {
        let rows = lines.iter().enumerate().skip(header.end);
        rows.map(|(index, line)| (index, *line, cells(line.as_bytes(), header.separator)))
            .take_while(|(_, line, _)| line.trim() != END)
            .filter(|(_, line, _)| !line.trim().is_empty())
    };
    let Some((_, _, first)) = rows().next() else {
        return Err(Foreign::new(header.end, "", 0, "numbers"));
    };
    let begins = |channel: &Channel| {
        let time = first.get(channel.time).and_then(|cell| figure(cell));
        (channel.period.clone(), time.map(f64::to_bits))
    };
    let alike = |channel: &Channel| {
        let same = |other: &&Channel| begins(other) == begins(channel);
        header.channels.iter().filter(same).count()
    };
    // Of as many the first.
    let reference = header.channels.iter().rev().max_by_key(|c| alike(c));
    let Some(reference) = reference else {
        return Err(Foreign::new(header.end, "", 0, "channels"));
    };
    let is_ours = |channel: &&Channel| begins(channel) == begins(reference);
    let ours: Vec<&Channel> = header.channels.iter().filter(is_ours).collect();
    let mut table = Written::new(ours.iter().map(|channel| channel.name.clone()));
    let others = header.channels.iter().filter(|channel| !is_ours(channel));
    table.ignored = others.map(|channel| channel.name.clone()).collect();
    let mut clock = Clock::default();
    for (index, line, row) in rows() {
        let cell = |at: usize| row.get(at).map_or("", String::as_str);
        // Shorter channels end before longer ones.
        if cell(reference.time).is_empty() {
            break;
        }
        let Some(time_s) = clock.seconds(cell(reference.time)) else {
            return Err(Foreign::new(index, line, 0, "a time"));
        };
        let values = ours.iter().map(|channel| cell(channel.value));
        table.add(index as u64 + 1, time_s, values);
    }
    with_rows(table, header.end, "numbers")
}

fn header(lines: &[&str]) -> Result<Header, Foreign> {
    let first = lines.first().copied().unwrap_or_default();
    let rest = first.strip_prefix(NAME).unwrap_or_default();
    let separator = rest.bytes().next().filter(|byte| b"\t;,:".contains(byte));
    let Some(separator) = separator else {
        let wanted = format!("\"{NAME}\" and a tab, semicolon, comma or colon");
        return Err(Foreign::new(0, first, 0, wanted));
    };
    let lead =
        |line: &str| line.strip_prefix(NAME).and_then(|r| r.bytes().next()) == Some(separator);
    let about = lines.iter().enumerate().skip(1);
    let Some((at, names)) = about.clone().find(|(_, line)| lead(line)) else {
        let wanted = "a line with the names of channels: export the file with its header";
        return Err(Foreign::new(lines.len(), "", 0, wanted));
    };
    let end = about
        .clone()
        .skip(at)
        .find(|(_, line)| line.trim().is_empty())
        .map_or(lines.len(), |(index, _)| index);
    let row = |word: &str| {
        let all = lines.get(at..end).unwrap_or_default();
        let rows = all.iter().map(|line| cells(line.as_bytes(), separator));
        let mut rows = rows.filter(|row| row.first().is_some_and(|cell| cell == word));
        rows.next().unwrap_or_default()
    };
    let (periods, units) = (row(PERIOD), row(UNIT));
    let mut channels = Vec::new();
    let mut time = 0;
    for (column, name) in cells(names.as_bytes(), separator).into_iter().enumerate() {
        if name == NAME {
            time = column;
            continue;
        }
        let of = |row: &[String]| row.get(column).cloned().unwrap_or_default();
        let unit = of(&units);
        // `mm (Length)`: the unit, and what it is one of.
        let unit = unit.split(" (").next().unwrap_or_default().trim();
        channels.push(Channel {
            name: if unit.is_empty() || unit == NO_UNIT {
                name
            } else {
                format!("{name} [{unit}]")
            },
            period: of(&periods),
            time,
            value: column,
        });
    }
    Ok(Header {
        separator,
        channels,
        end,
    })
}

/// Times as seconds.
#[derive(Default)]
struct Clock {
    first: Option<i64>,
}

impl Clock {
    /// Of milliseconds, or of file times, which have more digits than a fraction holds.
    fn seconds(&mut self, cell: &str) -> Option<f64> {
        let value = figure(cell)?;
        if value < FILE_TIME {
            return Some(1e-3 * value);
        }
        let ticks: i64 = cell.parse().ok()?;
        let first = *self.first.get_or_insert(ticks);
        Some(TICK_S * ticks.checked_sub(first)? as f64)
    }
}
