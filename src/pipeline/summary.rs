//! What a run over a program comes to.

use crate::diagnostic::Diagnostic;
use crate::interpret::MoveKind;
use crate::machine::{AxisSet, Machine};
use crate::power::{Ladder, Rating};

use super::by_line::LineSummary;
use super::executor::ONLY_SUBPROGRAMS;
use super::outcome::{Ideal, Pause, Price};
use super::over_time::OverTime;
use super::row::Certificate;

/// Moves of a program that does not fit of which all is looked into that takes many times as
/// long as to read it: the words that `limit` would write, and limits over time at lower
/// overrides.
pub(super) const AT_LENGTH_MAX: u64 = 20_000;

/// A move that does not fit.
#[derive(Debug, Clone, PartialEq)]
pub struct Unfit {
    /// Line from 1.
    pub line: u64,
    /// The file that it stands in; empty for the program itself.
    pub file: String,
    /// Runs of the line that do not fit; the figures are those of the worst.
    pub runs: u64,
    /// Block number without N.
    pub n_word: Option<f64>,
    /// What kind of move.
    pub kind: MoveKind,
    /// Axes that start together.
    pub axes: AxisSet,
    /// Peak in W and its limit.
    pub peak_w: f64,
    /// See `peak_w`.
    pub limit_w: f64,
    /// Regenerative peak in W and its limit.
    pub regen_w: f64,
    /// See `regen_w`.
    pub regen_limit_w: Option<f64>,
    /// How far over: the larger of peak/limit and regenerative peak/limit.
    pub overload: f64,
    /// What would help, such as "lower the feed to F812"; may be empty.
    pub help: String,
    /// The line, without its end; cut if it is long.
    pub text: Vec<u8>,
}

/// The figures of one analysis.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Summary {
    /// Number of lines read.
    pub lines: u64,
    /// Number of moves, dwells and runs of the spindle that do not fit included.
    pub moves: u64,
    /// Whether overrides of feeds and of rapids change anything.
    pub knobs: [bool; 2],
    /// Cycle time in s.
    pub duration_s: f64,
    /// Largest bus power in W, and where (0: no move).
    pub peak_w: f64,
    /// See `peak_w`.
    pub peak_line: u64,
    /// Largest power fed back in W, and where.
    pub regen_w: f64,
    /// See `regen_w`.
    pub regen_line: u64,
    /// Energy drawn in J; only where rows were asked for.
    pub energy_j: Option<f64>,
    /// Number of moves that do not fit.
    pub unfit_count: u64,
    /// The first of them, in program order; `Summary::KEPT` at most.
    pub unfit: Vec<Unfit>,
    /// Figures by line, where rows were asked for and lines run several times.
    pub by_line: Vec<LineSummary>,
    /// The worst ten, worst first.
    pub worst: Vec<Unfit>,
    /// What the converters bear over time, where the machine limits it.
    pub over_time: Vec<OverTime>,
    /// The same at lower overrides, where these are looked at: by setting.
    pub lower: Vec<Vec<Rating>>,
    /// Which certificate the figures belong to: robust when any move needs it.
    pub certificate: Option<Certificate>,
    /// Some moves are planned together, with the controller's look-ahead.
    pub ahead: bool,
    /// Under which conditions they hold, in plain sentences.
    pub conditions: Vec<String>,
    /// Warnings and notes.
    pub notes: Vec<Diagnostic>,
}

impl Summary {
    /// How many moves that do not fit are kept.
    pub const KEPT: usize = 1000;

    /// Whether the file holds only subprograms, so that nothing was looked at.
    #[must_use]
    pub fn only_subprograms(&self) -> bool {
        self.notes.iter().any(|note| note.rule == ONLY_SUBPROGRAMS)
    }

    /// The same as far as the largest overrides go.
    pub(super) fn fits_at_largest(&self) -> bool {
        let kept = |rating: &Rating| rating.bound.is_some() || rating.fits();
        self.unfit_count == 0 && self.over_time.iter().all(|found| kept(&found.rating))
    }

    /// True when every move fits, and all limits over time are kept.
    #[must_use]
    pub fn fits(&self) -> bool {
        self.unfit_count == 0 && self.over_time.iter().all(|found| found.rating.fits())
    }
}

/// What `limit` did.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LimitSummary {
    /// The program as it came.
    pub before: Summary,
    /// The program as written.
    pub after: Summary,
    /// Number of lines that were changed or inserted.
    pub edited_lines: u64,
    /// Where the written program waits though the original does not, in program order.
    pub pauses: Vec<Pause>,
    /// Some of its blocks may be skipped: they begin with `/`.
    pub may_skip: bool,
    /// True when the certificate holds: only then may the output be delivered.
    pub certified: bool,
    /// True where all of it holds but that some moves may still draw too much: the written
    /// program is the original made slower.
    pub slower: bool,
    /// Why it does not, each with its line; `Summary::KEPT` at most.
    pub reasons: Vec<Diagnostic>,
    /// What would make it fit, where that was asked for, what changes least first: see
    /// [`price`](super::price).
    pub prices: Vec<Price>,
    /// What a word for acceleration would bring, where that was asked for and is worth a
    /// line: see [`ideal`](super::ideal).
    pub ideal: Option<Ideal>,
}

impl Summary {
    /// What settles limits over time at lower overrides.
    pub(super) fn ladder(&self, machine: &Machine) -> Ladder {
        let ratings: Vec<Rating> = self.over_time.iter().map(|found| found.rating).collect();
        let peaks_w = [self.peak_w, self.regen_w];
        Ladder::new(machine, &ratings, self.moves, self.knobs, peaks_w)
    }

    /// Takes what it found.
    pub(super) fn settle(&mut self, ladder: &Ladder) {
        ladder.conclude(self.over_time.iter_mut().map(|found| &mut found.rating));
    }
}
