//! The peaks of rows over time, in bounded memory.
//!
//! One bar a row; where there are too many, two neighbours become one as high as the
//! higher, so that no peak is lost.

use super::block::{Block, Passing, after_w, larger};

/// Bars that are kept.
pub(super) const BARS_MAX: usize = 4000;

/// Some rows one after the other.
#[derive(Debug, Clone)]
pub(super) struct Bar {
    /// How many rows.
    pub rows: u64,
    /// Index of the first.
    pub first: u64,
    /// When they run in the program as it is, s.
    pub span_s: [f64; 2],
    /// And in the written program.
    pub after_s: [f64; 2],
    /// Largest power drawn and largest power fed back, W.
    pub most_w: [f64; 2],
    /// The same in the written program.
    pub most_after_w: [f64; 2],
    /// A figure is a bound: how the control blends moves there is not modelled.
    pub bound: bool,
    /// Rows that were changed.
    pub changed: u64,
    /// The row that takes most of its limits.
    pub lead: Block,
}

/// The bars of all rows.
#[derive(Debug, Default)]
pub(super) struct Bars {
    pub list: Vec<Bar>,
    /// Rows that a bar holds when it is full.
    size: u64,
    /// When the row before ended in the written program, s.
    after_s: f64,
}

impl Bars {
    /// Takes the next row.
    pub fn add(&mut self, next: Passing<'_>) {
        let row = next.row;
        let from_s = row.start_after_s.unwrap_or(self.after_s);
        self.after_s = from_s + row.duration_after_s.unwrap_or(0.0);
        let after_s = [from_s, self.after_s];
        self.size = self.size.max(1);
        if let Some(last) = self.list.last_mut()
            && last.rows < self.size
        {
            last.take(next, after_s);
            return;
        }
        self.list.push(Bar::of(next, after_s));
        if self.list.len() > BARS_MAX {
            self.halve();
        }
    }

    /// Two bars become one.
    fn halve(&mut self) {
        let mut joined: Vec<Bar> = Vec::with_capacity(BARS_MAX);
        let mut bars = std::mem::take(&mut self.list).into_iter();
        while let Some(mut bar) = bars.next() {
            if let Some(next) = bars.next() {
                bar.join(next);
            }
            joined.push(bar);
        }
        self.list = joined;
        self.size *= 2;
    }
}

impl Bar {
    fn of(only: Passing<'_>, after_s: [f64; 2]) -> Self {
        let row = only.row;
        Self {
            rows: 1,
            first: only.index,
            span_s: [row.start_s, row.start_s + row.duration_s],
            after_s,
            most_w: [row.peak_w, row.regen_w],
            most_after_w: after_w(row),
            bound: only.is_bound(),
            changed: u64::from(!row.action.is_empty()),
            lead: only.keep(),
        }
    }

    /// Takes the next row.
    fn take(&mut self, next: Passing<'_>, after_s: [f64; 2]) {
        let row = next.row;
        self.rows += 1;
        self.span_s[1] = row.start_s + row.duration_s;
        self.after_s[1] = after_s[1];
        self.raise([row.peak_w, row.regen_w], after_w(row));
        self.bound |= next.is_bound();
        self.changed += u64::from(!row.action.is_empty());
        if next.weight() > self.lead.passing().weight() {
            self.lead.replace(next);
        }
    }

    /// Takes the next bar in.
    fn join(&mut self, next: Self) {
        self.rows += next.rows;
        self.span_s[1] = next.span_s[1];
        self.after_s[1] = next.after_s[1];
        self.raise(next.most_w, next.most_after_w);
        self.bound |= next.bound;
        self.changed += next.changed;
        if next.lead.passing().weight() > self.lead.passing().weight() {
            self.lead = next.lead;
        }
    }

    fn raise(&mut self, most_w: [f64; 2], most_after_w: [f64; 2]) {
        let pairs = self.most_w.iter_mut().zip(most_w);
        let after = self.most_after_w.iter_mut().zip(most_after_w);
        for (own, other) in pairs.chain(after) {
            *own = larger(*own, other);
        }
    }
}
