//! A line of names that are always the same, and lines of numbers.

use super::written::{Foreign, Read, Written, figure, with_rows};

/// Reads a table with these names, separated by commas, the first one of which is the time
/// in seconds. Lines with two hashes before them are about the sensor.
pub(super) fn read(text: &str, names: &str) -> Read {
    let mut lines = text.lines().enumerate();
    let (at, first) = lines
        .find(|(_, line)| !line.starts_with("##"))
        .unwrap_or_default();
    if first.trim_end() != names {
        return Err(Foreign::new(at, first, 0, names));
    }
    let signals = names.split(',').skip(1);
    let mut table = Written::new(signals.map(str::to_owned));
    let mut last = at + 1;
    for (index, line) in lines {
        last = index + 1;
        if line.trim().is_empty() {
            continue;
        }
        let (time, values) = line.split_once(',').unwrap_or((line, ""));
        let Some(time_s) = figure(time.trim()) else {
            return Err(Foreign::new(index, line, 0, "a time"));
        };
        table.add(
            index as u64 + 1,
            time_s,
            values.trim_end().split(',').map(str::trim),
        );
    }
    with_rows(table, last, "numbers")
}
