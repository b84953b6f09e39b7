//! A period in the first line, and in each line the name of each signal in front of its
//! value.

use super::written::{Foreign, Read, Written, figure, with_rows};

/// Reads lines of names and values; the period, in nanoseconds, stands between these words.
pub(super) fn read(text: &str, before: &str, after: &str) -> Read {
    let mut lines = text.lines().enumerate();
    let (_, first) = lines.next().unwrap_or_default();
    let wanted = || format!("\"{before}1000000{after}\", or another number");
    let period_ns = first
        .trim_end()
        .strip_prefix(before)
        .and_then(|rest| rest.strip_suffix(after))
        .and_then(|number| number.trim().parse::<u64>().ok());
    let Some(period_ns) = period_ns.filter(|period| *period > 0) else {
        return Err(Foreign::new(0, first, 0, wanted()));
    };
    let rows: Vec<(usize, &str)> = lines.filter(|(_, line)| !line.trim().is_empty()).collect();
    // One row more is written than was sampled, whatever is in it.
    let (_, rows) = rows.split_last().unwrap_or((&(0, ""), &[]));
    let names: Vec<&str> = match rows.first() {
        Some((_, line)) => line.split_ascii_whitespace().step_by(2).collect(),
        None => Vec::new(),
    };
    let mut table = Written::new(names.iter().map(|name| (*name).to_owned()));
    for (row, (index, line)) in rows.iter().enumerate() {
        let words: Vec<&str> = line.split_ascii_whitespace().collect();
        // Words are parts of the line: where they begin in it.
        let at = |word: Option<&&str>| {
            word.map_or(line.len(), |word| {
                word.as_ptr().addr() - line.as_ptr().addr()
            })
        };
        for (place, name) in names.iter().enumerate() {
            let label = words.get(2 * place);
            if label != Some(name) {
                return Err(Foreign::new(*index, line, at(label), *name));
            }
            let value = words.get(2 * place + 1);
            if value.and_then(|value| figure(value)).is_none() {
                let wanted = format!("the value of {name}");
                return Err(Foreign::new(*index, line, at(value), wanted));
            }
        }
        if let Some(more) = words.get(2 * names.len()) {
            return Err(Foreign::new(*index, line, at(Some(more)), "nothing more"));
        }
        let time_s = row as f64 * period_ns as f64 * 1e-9;
        let values = words.iter().skip(1).step_by(2).copied();
        table.add(*index as u64 + 1, time_s, values);
    }
    with_rows(table, 1, "names of signals, each with its value")
}
