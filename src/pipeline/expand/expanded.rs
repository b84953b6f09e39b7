//! A program with cycles written out.

use std::collections::{BTreeMap, BTreeSet};

use super::in_place::InPlace;
use super::origins::Origins;
use crate::source::lines;

/// A program with cycles written out.
pub(in crate::pipeline) struct Expanded {
    pub(in crate::pipeline) text: Vec<u8>,
    /// What its lines were before cycles were written out.
    before: Origins,
    /// The same, in the original.
    origins: Origins,
    /// Lines of the original that no longer stand as they were, or not in their place alone.
    moved: BTreeSet<u64>,
    /// N words of the blocks that were written in another way, by line of the original.
    n_words: BTreeMap<u64, f64>,
    /// How many blocks were written out.
    pub(in crate::pipeline) blocks: usize,
}

impl Expanded {
    /// A program, which may stand with blocks in place of calls, with lines in place of others.
    pub(super) fn new(
        (text, placed): (&[u8], Option<&InPlace>),
        written: &BTreeMap<u64, Vec<u8>>,
        n_words: &BTreeMap<u64, f64>,
    ) -> Self {
        let mut expanded = Self {
            text: Vec::with_capacity(text.len() + text.len() / 4),
            before: Origins::default(),
            origins: Origins::default(),
            moved: placed.map_or_else(BTreeSet::new, |placed| placed.moved.clone()),
            n_words: n_words.clone(),
            blocks: written.len() + placed.map_or(0, InPlace::calls),
        };
        for (number, text) in (1..).zip(lines(text)) {
            let bytes = written.get(&number).map_or(text, Vec::as_slice);
            let origin = placed.map_or(number, |placed| placed.origin(number));
            expanded.text.extend_from_slice(bytes);
            let count = lines(bytes).count();
            expanded.before.push(number, count);
            expanded.origins.push(origin, count);
            if count > 1 {
                expanded.moved.insert(origin);
            }
        }
        expanded
    }

    /// The line of the original that a line comes from; 0 stays 0.
    pub(in crate::pipeline) fn origin(&self, line: u64) -> u64 {
        self.origins.of(line)
    }

    /// What a line was before cycles were written out.
    pub(super) fn line_before(&self, line: u64) -> u64 {
        self.before.of(line)
    }

    /// Whether a line of the original stands as it was.
    pub(super) fn stands(&self, line: u64) -> bool {
        !self.moved.contains(&line)
    }

    /// The N word of a block that was written in another way.
    pub(super) fn n_word(&self, line: u64) -> Option<f64> {
        self.n_words.get(&line).copied()
    }
}
