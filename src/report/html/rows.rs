//! Takes the rows of a report for a page.

use std::io;

use super::bars::Bars;
use super::block::{after_w, load};
use super::path::Path;
use super::peaks::Peaks;
use crate::pipeline::{Restart, Row, RowSink};

/// Peaks whose simultaneous powers are shown.
const PEAKS: usize = 10;
/// Blocks that are listed.
const BLOCKS: usize = 60;

/// What a page shows of the rows of a report; it does not grow with their number.
#[derive(Debug)]
pub struct PageRows {
    /// Rows so far.
    pub(super) count: u64,
    pub(super) bars: Bars,
    pub(super) path: Path,
    /// The blocks that take most of their limits.
    pub(super) worst: Peaks,
    /// The largest powers, and those of the written program.
    pub(super) before: Peaks,
    pub(super) after: Peaks,
    /// Rows that were changed.
    pub(super) changed: u64,
}

impl Default for PageRows {
    fn default() -> Self {
        Self {
            count: 0,
            bars: Bars::default(),
            path: Path::default(),
            worst: Peaks::new(BLOCKS, |row| load(row, row.peak_w, row.regen_w)),
            before: Peaks::new(PEAKS, |row| row.peak_w),
            after: Peaks::new(PEAKS, |row| after_w(row)[0]),
            changed: 0,
        }
    }
}

impl RowSink for PageRows {
    fn row(&mut self, row: &Row) -> io::Result<()> {
        let index = self.count;
        self.count += 1;
        self.bars.add(index, row);
        self.path.add(index, row);
        self.worst.add(index, row);
        self.before.add(index, row);
        self.after.add(index, row);
        self.changed += u64::from(!row.action.is_empty());
        Ok(())
    }
}

impl Restart for PageRows {
    fn restart(&mut self) -> io::Result<()> {
        *self = Self::default();
        Ok(())
    }
}
