//! Which line of a program each line of another comes from.

/// For each line of a text the line that it comes from, from 1.
#[derive(Default)]
pub(super) struct Origins(Vec<u64>);

impl Origins {
    /// The next lines, so many, come from this one.
    pub(super) fn push(&mut self, origin: u64, count: usize) {
        self.0.extend(std::iter::repeat_n(origin, count));
    }

    /// How many lines there are.
    pub(super) fn len(&self) -> u64 {
        self.0.len() as u64
    }

    /// Where a line comes from; 0 stays 0.
    pub(super) fn of(&self, line: u64) -> u64 {
        let index = line.checked_sub(1).map(|index| index as usize);
        let origin = index.and_then(|index| self.0.get(index));
        origin.copied().unwrap_or(line)
    }
}
