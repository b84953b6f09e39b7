//! The largest of all rows, one for each line.

use super::block::{Block, Passing};

/// Rows in the order of a figure, the largest first.
#[derive(Debug)]
pub(super) struct Peaks {
    pub list: Vec<Block>,
    most: usize,
    figure: fn(Passing<'_>) -> f64,
}

impl Peaks {
    /// Keeps `most` rows by `figure`.
    pub fn new(most: usize, figure: fn(Passing<'_>) -> f64) -> Self {
        Self {
            list: Vec::with_capacity(most + 1),
            most,
            figure,
        }
    }

    /// Takes the next row.
    pub fn add(&mut self, next: Passing<'_>) {
        let row = next.row;
        let value = (self.figure)(next);
        let full = self.list.len() >= self.most;
        let least = self
            .list
            .last()
            .map_or(0.0, |last| (self.figure)(last.passing()));
        if value <= 0.0 || full && value <= least {
            return;
        }
        let same = |block: &Block| block.row.line == row.line && block.row.file == row.file;
        if let Some(place) = self.list.iter().position(same) {
            if self
                .list
                .get(place)
                .is_some_and(|known| (self.figure)(known.passing()) >= value)
            {
                return;
            }
            self.list.remove(place);
        }
        let place = self
            .list
            .partition_point(|block| (self.figure)(block.passing()) >= value);
        self.list.insert(place, next.keep());
        self.list.truncate(self.most);
    }
}
