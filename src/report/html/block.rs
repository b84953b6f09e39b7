//! One row of a report, as the page keeps it.

use crate::pipeline::Row;

/// A row and its place among all rows.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Block {
    /// Place among the rows, from 0.
    pub index: u64,
    /// The row.
    pub row: Row,
}

impl Block {
    /// The larger of peak by limit and power fed back by its limit.
    pub fn load(&self) -> f64 {
        load(&self.row, self.row.peak_w, self.row.regen_w)
    }

    /// The same in the written program; 0 where there is none.
    pub fn load_after(&self) -> f64 {
        let [peak_w, regen_w] = after_w(&self.row);
        load(&self.row, peak_w, regen_w)
    }
}

/// Peak and power fed back in the written program, W; 0 where it has no such move.
pub(super) fn after_w(row: &Row) -> [f64; 2] {
    [row.peak_after_w, row.regen_after_w].map(|power_w| power_w.unwrap_or(0.0))
}

/// How much of its limits a row takes: 1 is the limit.
pub(super) fn load(row: &Row, peak_w: f64, regen_w: f64) -> f64 {
    let back = row.regen_limit_w.map_or(0.0, |limit_w| regen_w / limit_w);
    larger(peak_w / row.limit_w, back)
}

/// The larger of two values; what is not a number counts as larger than all.
pub(super) fn larger(a: f64, b: f64) -> f64 {
    if a >= b {
        a
    } else if b > a {
        b
    } else {
        f64::INFINITY
    }
}
