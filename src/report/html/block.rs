//! One row of a report, as the page keeps it.

use crate::pipeline::{Certificate, Row};

/// What is known of a move on the second machine, where two are compared, besides the figures
/// of the written program.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Other {
    /// The first machine has no such move.
    pub alone: bool,
    /// Limits of the second machine, W.
    pub limit_w: f64,
    /// See `limit_w`.
    pub regen_limit_w: Option<f64>,
    /// Its converter that is loaded most.
    pub converter: String,
    /// What the figures there belong to.
    pub certificate: Certificate,
}

/// A row as it passes, and its place among all rows.
#[derive(Debug, Clone, Copy)]
pub(super) struct Passing<'a> {
    /// Place among the rows, from 0.
    pub index: u64,
    /// The row.
    pub row: &'a Row,
    /// The second machine, where two are compared.
    pub other: Option<&'a Other>,
}

/// A row that is kept.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Block {
    /// Place among the rows, from 0.
    pub index: u64,
    /// The row.
    pub row: Row,
    /// The second machine, where two are compared.
    pub other: Option<Other>,
}

impl Passing<'_> {
    /// Keeps it.
    pub fn keep(self) -> Block {
        Block {
            index: self.index,
            row: self.row.clone(),
            other: self.other.cloned(),
        }
    }

    /// The larger of peak by limit and power fed back by its limit: 1 is the limit.
    pub fn load(self) -> f64 {
        let row = self.row;
        load([row.peak_w, row.regen_w], row.limit_w, row.regen_limit_w)
    }

    /// The same in the written program or on the second machine; 0 where it has no such move.
    pub fn load_after(self) -> f64 {
        let powers_w = after_w(self.row);
        match self.other {
            Some(other) => load(powers_w, other.limit_w, other.regen_limit_w),
            None => load(powers_w, self.row.limit_w, self.row.regen_limit_w),
        }
    }

    /// By what the rows are ordered that a page shows: of two machines the larger load counts.
    pub fn weight(self) -> f64 {
        match self.other {
            Some(_) => larger(self.load(), self.load_after()),
            None => self.load(),
        }
    }

    /// Whether a figure is a bound: how the control blends moves there is not modelled.
    pub fn is_bound(self) -> bool {
        let others = self.other.map(|other| other.certificate);
        let all = [Some(self.row.certificate), others];
        all.contains(&Some(Certificate::Robust))
    }
}

impl Block {
    /// The same as it passed.
    pub fn passing(&self) -> Passing<'_> {
        Passing {
            index: self.index,
            row: &self.row,
            other: self.other.as_ref(),
        }
    }

    /// Whether it is of the first machine, which is the only one but where two are compared.
    pub fn is_on_first(&self) -> bool {
        self.other.as_ref().is_none_or(|other| !other.alone)
    }

    /// The converter of the second machine that is loaded most; empty where there is none.
    pub fn converter_after(&self) -> &str {
        self.other.as_ref().map_or("", |other| &other.converter)
    }

    /// Takes the place of this one, which keeps its memory.
    pub fn replace(&mut self, by: Passing<'_>) {
        self.index = by.index;
        self.row.clone_from(by.row);
        self.other = by.other.cloned();
    }
}

/// Peak and power fed back in the written program, W; 0 where it has no such move.
pub(super) fn after_w(row: &Row) -> [f64; 2] {
    [row.peak_after_w, row.regen_after_w].map(|power_w| power_w.unwrap_or(0.0))
}

fn load([peak_w, regen_w]: [f64; 2], limit_w: f64, regen_limit_w: Option<f64>) -> f64 {
    let back = regen_limit_w.map_or(0.0, |limit_w| regen_w / limit_w);
    larger(peak_w / limit_w, back)
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
