//! Figures by line, for programs whose lines run more than once.

use std::collections::BTreeMap;

use super::line_key::LineKey;
use crate::interpret::Move;
use crate::power::Assessment;

/// What all runs of a line come to.
#[derive(Debug, Clone, PartialEq)]
pub struct LineSummary {
    /// Line from 1.
    pub line: u64,
    /// The file that it stands in; empty for the program itself.
    pub file: String,
    /// How often it ran.
    pub runs: u64,
    /// Time of all runs in s.
    pub duration_s: f64,
    /// Largest bus power of all runs in W.
    pub peak_w: f64,
    /// Largest power fed back of all runs in W.
    pub regen_w: f64,
    /// Energy of all runs in J.
    pub energy_j: f64,
}

/// Lines of a program that runs straight through which are kept in case it does
/// not: beyond, a summary by line says no more than the rows.
const LINES_MAX: usize = 1 << 16;

/// Adds moves up by line.
#[derive(Debug, Default)]
pub(super) struct ByLine {
    lines: BTreeMap<LineKey, LineSummary>,
    /// Some line has run more than once.
    repeats: bool,
    given_up: bool,
}

impl ByLine {
    pub(super) fn add(&mut self, mv: &Move, assessment: &Assessment) {
        if self.given_up {
            return;
        }
        self.repeats |= mv.run > 1;
        if !self.repeats && self.lines.len() >= LINES_MAX {
            self.given_up = true;
            self.lines.clear();
            return;
        }
        let entry = self.lines.entry((mv.text, mv.line)).or_insert(LineSummary {
            line: mv.line,
            file: String::new(),
            runs: 0,
            duration_s: 0.0,
            peak_w: f64::NEG_INFINITY,
            regen_w: 0.0,
            energy_j: 0.0,
        });
        entry.runs = entry.runs.max(u64::from(mv.run));
        entry.duration_s += assessment.duration_s;
        entry.peak_w = entry.peak_w.max(assessment.demand.peak_w);
        entry.regen_w = entry.regen_w.max(assessment.demand.regen_w);
        entry.energy_j += assessment.demand.energy_j;
    }

    /// The lines in order; nothing where each ran once.
    pub(super) fn finish(self, file: impl Fn(u16) -> String) -> Vec<LineSummary> {
        if !self.repeats {
            return Vec::new();
        }
        let lines = self.lines.into_iter();
        lines
            .map(|((text, _), summary)| LineSummary {
                file: file(text),
                ..summary
            })
            .collect()
    }
}
