//! Adds up judged moves: figures, rows, and what does not fit.

use std::io;

use super::describe::row;
use super::{Certificate, Failure, Options, Row, RowSink, Summary, Unfit};
use crate::interpret::Move;
use crate::machine::{AxisSet, Machine};
use crate::power::{Assessment, PowerModel, Want};
use crate::source::split_line_end;

/// The worst moves that a summary keeps.
const WORST: usize = 10;
/// Longest text of a line that is kept.
const TEXT_MAX: usize = 200;

/// Adds up the moves of a program.
pub(super) struct Tally<'m, 'r> {
    machine: &'m Machine,
    model: PowerModel,
    rows: Option<&'r mut (dyn RowSink + 'r)>,
    summary: Summary,
    energy_j: f64,
    failed: Option<io::Error>,
    /// Names of the files of subprograms, by number less 1.
    files: Vec<String>,
}

impl<'m, 'r> Tally<'m, 'r> {
    pub(super) fn new(
        machine: &'m Machine,
        options: &Options,
        rows: Option<&'r mut (dyn RowSink + 'r)>,
    ) -> Self {
        let model = PowerModel::new(machine);
        let summary = Summary {
            certificate: options.certificate,
            ..Summary::default()
        };
        Self {
            machine,
            model,
            rows,
            summary,
            energy_j: 0.0,
            failed: None,
            files: Vec::new(),
        }
    }

    /// What is wanted of the next move: peaks below those found so far need
    /// not be exact where no row shows them.
    pub(super) fn want(&self) -> Want {
        if self.rows.is_some() {
            return Want::ALL;
        }
        if self.machine.converters.len() > 1 {
            return Want::PEAKS;
        }
        let regen_limit_w = self.model.regen_limit_w(0).unwrap_or(f64::INFINITY);
        Want {
            energy: false,
            floor_w: self.summary.peak_w.min(self.model.limit_w(0)),
            regen_floor_w: self.summary.regen_w.min(regen_limit_w),
        }
    }

    /// Takes the next judged move; `help` says what would bring it down.
    pub(super) fn take(
        &mut self,
        mv: &Move,
        assessment: &Assessment,
        text: &[u8],
        help: impl FnOnce() -> String,
    ) {
        if self.rows.is_some() {
            let mut row = row(
                self.machine,
                &self.model,
                mv,
                assessment,
                self.summary.duration_s,
            );
            row.file = self.file(mv);
            self.write(&row);
        }
        self.count(mv, assessment, text, help);
    }

    /// Learns the names of files of subprograms.
    pub(super) fn learn_files(&mut self, names: &[String]) {
        let known = self.files.len();
        self.files.extend(names.iter().skip(known).cloned());
    }

    /// The file that a move's line stands in; empty for the program itself.
    pub(super) fn file(&self, mv: &Move) -> String {
        let index = usize::from(mv.text).checked_sub(1);
        let name = index.and_then(|index| self.files.get(index));
        name.cloned().unwrap_or_default()
    }

    /// Writes a row.
    pub(super) fn write(&mut self, row: &Row) {
        if self.failed.is_none()
            && let Some(rows) = &mut self.rows
            && let Err(error) = rows.row(row)
        {
            self.failed = Some(error);
        }
    }

    /// Adds a move to the figures, without a row and without advice.
    pub(super) fn add(&mut self, mv: &Move, assessment: &Assessment, text: &[u8]) {
        self.count(mv, assessment, text, String::new);
    }

    fn count(
        &mut self,
        mv: &Move,
        assessment: &Assessment,
        text: &[u8],
        help: impl FnOnce() -> String,
    ) {
        let summary = &mut self.summary;
        let demand = &assessment.demand;
        summary.moves += 1;
        summary.duration_s += assessment.duration_s;
        self.energy_j += demand.energy_j;
        if demand.peak_w > summary.peak_w {
            summary.peak_w = demand.peak_w;
            summary.peak_line = mv.line;
        }
        if demand.regen_w > summary.regen_w {
            summary.regen_w = demand.regen_w;
            summary.regen_line = mv.line;
        }
        if assessment.certificate == Certificate::Robust {
            summary.certificate = Some(Certificate::Robust);
        }
        if !self.model.fits(demand) {
            self.keep_unfit(mv, assessment, text, help);
        }
    }

    #[cold]
    fn keep_unfit(
        &mut self,
        mv: &Move,
        assessment: &Assessment,
        text: &[u8],
        help: impl FnOnce() -> String,
    ) {
        let overload = assessment.demand.load_ratio;
        self.summary.unfit_count += 1;
        let listed = self.summary.unfit.len() < Summary::KEPT;
        let worst = &self.summary.worst;
        let among_worst =
            worst.len() < WORST || worst.last().is_some_and(|last| overload > last.overload);
        if !listed && !among_worst {
            return;
        }
        let unfit = unfit(&self.model, mv, assessment, text, help());
        if among_worst {
            let at = self
                .summary
                .worst
                .partition_point(|other| other.overload >= overload);
            self.summary.worst.insert(at, unfit.clone());
            self.summary.worst.truncate(WORST);
        }
        if listed {
            self.summary.unfit.push(unfit);
        }
    }

    /// The error of the rows, if there was one.
    pub(super) fn check(&mut self) -> Result<(), Failure> {
        self.failed
            .take()
            .map_or(Ok(()), |error| Err(Failure::Output(error)))
    }

    /// The figures, with the energy where it was wanted of all moves; lines,
    /// notes and conditions are still to be filled in.
    pub(super) fn finish(self, energy: bool) -> Summary {
        let mut summary = self.summary;
        summary.energy_j = energy.then_some(self.energy_j);
        summary.certificate = summary.certificate.or(Some(Certificate::Planned));
        summary
    }
}

/// Axes that really move, or may.
pub(super) fn axes(mv: &Move) -> AxisSet {
    AxisSet(mv.moving.0 | mv.unknown_start.0)
}

fn unfit(
    model: &PowerModel,
    mv: &Move,
    assessment: &Assessment,
    text: &[u8],
    help: String,
) -> Unfit {
    let demand = &assessment.demand;
    let (text, _) = split_line_end(text);
    Unfit {
        line: mv.line,
        n_word: mv.number,
        kind: mv.kind,
        axes: axes(mv),
        peak_w: demand.peak_w,
        limit_w: model.limit_w(demand.converter),
        regen_w: demand.regen_w,
        regen_limit_w: model.regen_limit_w(demand.converter),
        overload: demand.load_ratio,
        help,
        text: text.get(..TEXT_MAX).unwrap_or(text).to_vec(),
    }
}
