//! Takes the rows of a report for a page.

use std::io;

use super::bars::Bars;
use super::block::{Other, Passing, after_w};
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
    /// The same of those that fit on one machine only, where two are compared.
    pub(super) differ: Peaks,
    /// The largest powers, and those of the written program or on the second machine.
    pub(super) before: Peaks,
    pub(super) after: Peaks,
    /// Rows that were changed.
    pub(super) changed: u64,
    /// When the last move of the first machine ended, s.
    ended_s: f64,
}

fn weight(it: Passing<'_>) -> f64 {
    it.weight()
}

impl Default for PageRows {
    fn default() -> Self {
        let differs = |it: Passing<'_>| match it.other {
            Some(_) if !it.row.action.is_empty() => it.weight(),
            _ => 0.0,
        };
        Self {
            count: 0,
            bars: Bars::default(),
            path: Path::default(),
            worst: Peaks::new(BLOCKS, weight),
            differ: Peaks::new(BLOCKS, differs),
            before: Peaks::new(PEAKS, |it| it.row.peak_w),
            after: Peaks::new(PEAKS, |it| after_w(it.row)[0]),
            changed: 0,
            ended_s: 0.0,
        }
    }
}

impl PageRows {
    /// Takes what the first of two machines does, what the second one does, or both where they
    /// make the same move. `change` says whether it begins or ceases to fit, and is empty
    /// where it does neither.
    pub fn pair(&mut self, first: Option<&Row>, second: Option<&Row>, change: &'static str) {
        let other = second.map(|row| Other {
            alone: first.is_none(),
            limit_w: row.limit_w,
            regen_limit_w: row.regen_limit_w,
            converter: row.converter.clone(),
            certificate: row.certificate,
        });
        let Some(known) = first.or(second) else {
            return;
        };
        let mut row = known.clone();
        row.action = change;
        if first.is_none() {
            // It takes no time and no power there.
            row.start_s = self.ended_s;
            [row.duration_s, row.peak_w, row.regen_w, row.energy_j] = [0.0; 4];
            row.converter.clear();
        }
        self.ended_s = row.start_s + row.duration_s;
        row.start_after_s = second.map(|it| it.start_s);
        row.duration_after_s = second.map(|it| it.duration_s);
        row.peak_after_w = second.map(|it| it.peak_w);
        row.regen_after_w = second.map(|it| it.regen_w);
        // A move that the second machine does not make is compared all the same.
        let other = other.unwrap_or_else(|| Other {
            alone: false,
            limit_w: row.limit_w,
            regen_limit_w: row.regen_limit_w,
            converter: String::new(),
            certificate: row.certificate,
        });
        self.add(&row, Some(&other));
    }

    fn add(&mut self, row: &Row, other: Option<&Other>) {
        let next = Passing {
            index: self.count,
            row,
            other,
        };
        self.count += 1;
        self.bars.add(next);
        self.path.add(next);
        for peaks in [
            &mut self.worst,
            &mut self.differ,
            &mut self.before,
            &mut self.after,
        ] {
            peaks.add(next);
        }
        self.changed += u64::from(!row.action.is_empty());
    }

    /// All peaks that are kept, by which they are kept.
    pub(super) fn peaks(&self) -> [&Peaks; 4] {
        [&self.worst, &self.differ, &self.before, &self.after]
    }
}

impl RowSink for PageRows {
    fn row(&mut self, row: &Row) -> io::Result<()> {
        self.add(row, None);
        Ok(())
    }
}

impl Restart for PageRows {
    fn restart(&mut self) -> io::Result<()> {
        *self = Self::default();
        Ok(())
    }
}
