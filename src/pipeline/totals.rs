//! Adds up judged moves: figures, rows, and what does not fit.

use std::io;

use super::by_line::ByLine;
use super::describe::{axes, row};
use super::over_time::OverTime;
use super::row::Detail;
use super::{Certificate, Failure, Options, Row, RowSink, Summary, Unfit};
use crate::interpret::{Move, MoveKind};
use crate::machine::Machine;
use crate::power::{Assessment, PowerModel, Rating, Want};
use crate::source::split_line_end;

/// The worst moves that a summary keeps.
pub(super) const WORST: usize = 10;
/// Longest text of a line that is kept.
const TEXT_MAX: usize = 200;

/// Adds up the moves of a program.
pub(super) struct Totals<'m, 'r> {
    machine: &'m Machine,
    model: PowerModel,
    rows: Option<&'r mut (dyn RowSink + 'r)>,
    summary: Summary,
    /// The limits, where peaks below them may be passed over.
    floors_w: Option<[f64; 2]>,
    energy_j: f64,
    failed: Option<io::Error>,
    /// Names of the files of subprograms, by number less 1.
    files: Vec<String>,
    by_line: Option<ByLine>,
}

/// The limits of the converter, drawn and fed back, W; `None` where there are several.
fn limits_w(machine: &Machine, model: &PowerModel) -> Option<[f64; 2]> {
    let regen_limit_w = model.regen_limit_w(0).unwrap_or(f64::INFINITY);
    (machine.converters.len() <= 1).then(|| [model.limit_w(0), regen_limit_w])
}

/// What is wanted where it counts alone whether moves fit.
pub(super) fn whether_fits(machine: &Machine, model: &PowerModel) -> Want {
    let Some([floor_w, regen_floor_w]) = limits_w(machine, model) else {
        return Want::PEAKS;
    };
    Want {
        floor_w,
        regen_floor_w,
        ..Want::PEAKS
    }
}

impl<'m, 'r> Totals<'m, 'r> {
    pub(super) fn new(
        machine: &'m Machine,
        options: &Options,
        rows: Option<&'r mut (dyn RowSink + 'r)>,
    ) -> Self {
        let rows_wanted = rows.is_some();
        let model = PowerModel::new(machine);
        let floors_w = limits_w(machine, &model);
        let summary = Summary {
            certificate: options.certificate,
            ..Summary::default()
        };
        Self {
            machine,
            model,
            rows,
            summary,
            floors_w,
            energy_j: 0.0,
            failed: None,
            files: Vec::new(),
            by_line: rows_wanted.then(ByLine::default),
        }
    }

    /// What is wanted of the next move: peaks below those found so far need
    /// not be exact where no row shows them.
    pub(super) fn want(&self) -> Want {
        if Detail::of(self.rows.as_deref()) == Detail::Figures {
            return Want::ALL;
        }
        let Some([limit_w, regen_limit_w]) = self.floors_w else {
            return Want::PEAKS;
        };
        Want {
            energy: false,
            floor_w: self.summary.peak_w.min(limit_w),
            regen_floor_w: self.summary.regen_w.min(regen_limit_w),
            accel: true,
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
            row.file = self.file(mv.text);
            self.write(&row);
        }
        self.count(mv, assessment, text, help);
    }

    /// Learns the names of files of subprograms.
    #[inline]
    pub(super) fn learn_files(&mut self, names: &[String]) {
        if names.len() > self.files.len() {
            let known = self.files.len();
            self.files.extend(names.iter().skip(known).cloned());
        }
    }

    /// Adds up by line too.
    pub(super) fn keep_lines(&mut self) {
        self.by_line = Some(ByLine::default());
    }

    /// The name of a text; empty for the program itself.
    fn file(&self, text: u16) -> String {
        let index = usize::from(text).checked_sub(1);
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

    /// How long the moves last that were added so far, s.
    pub(super) fn duration_s(&self) -> f64 {
        self.summary.duration_s
    }

    /// Adds a dwell that was put in, which is none of the program's moves.
    pub(super) fn wait(&mut self, mv: &Move, assessment: &Assessment, text: &[u8]) {
        self.add(mv, assessment, text);
        self.summary.moves -= 1;
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
        summary.moves += u64::from(mv.kind != MoveKind::Spindle);
        for (own, turns) in summary.knobs.iter_mut().zip(mv.kind.knobs()) {
            *own |= turns;
        }
        summary.duration_s += assessment.duration_s;
        self.energy_j += demand.energy_j;
        if let Some(by_line) = &mut self.by_line {
            by_line.add(mv, assessment);
        }
        if demand.peak_w > summary.peak_w {
            summary.peak_w = demand.peak_w;
            summary.peak_line = mv.line;
        }
        if demand.regen_w > summary.regen_w {
            summary.regen_w = demand.regen_w;
            summary.regen_line = mv.line;
        }
        summary.ahead |= assessment.ahead;
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
        self.summary.moves += u64::from(mv.kind == MoveKind::Spindle);
        if mv.run > 1 && self.join_run(mv, assessment) {
            return;
        }
        let listed = self.summary.unfit.len() < Summary::KEPT;
        let worst = &self.summary.worst;
        let among_worst =
            worst.len() < WORST || worst.last().is_some_and(|last| overload > last.overload);
        if !listed && !among_worst {
            return;
        }
        let mut unfit = unfit(&self.model, mv, assessment, text, help());
        unfit.file = self.file(mv.text);
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

    /// Joins a further run of a line to the ones that were kept; false
    /// where none was.
    fn join_run(&mut self, mv: &Move, assessment: &Assessment) -> bool {
        let file = self.file(mv.text);
        let same =
            |unfit: &Unfit| unfit.line == mv.line && unfit.kind == mv.kind && unfit.file == file;
        let Summary { unfit, worst, .. } = &mut self.summary;
        let overload = assessment.demand.load_ratio;
        let mut known = false;
        let mut worse = false;
        for found in unfit.iter_mut().chain(worst).filter(|found| same(found)) {
            known = true;
            found.runs += 1;
            if overload > found.overload {
                worse = true;
                found.overload = overload;
                found.peak_w = assessment.demand.peak_w;
                found.regen_w = assessment.demand.regen_w;
            }
        }
        if worse {
            let order = |a: &Unfit, b: &Unfit| b.overload.total_cmp(&a.overload);
            self.summary.worst.sort_by(order);
        }
        known
    }

    /// The error of the rows, if there was one.
    pub(super) fn check(&mut self) -> Result<(), Failure> {
        self.failed
            .take()
            .map_or(Ok(()), |error| Err(Failure::Output(error)))
    }

    /// Takes what was found about limits over time.
    pub(super) fn rate(&mut self, ratings: Vec<Rating>, lower: Vec<Vec<Rating>>) {
        self.summary.lower = lower;
        self.summary.over_time = OverTime::list(ratings, self.machine, |text| self.file(text));
    }

    /// The figures, with the energy where it was wanted of all moves; lines,
    /// notes and conditions are still to be filled in.
    pub(super) fn finish(mut self, energy: bool) -> Summary {
        let by_line = self.by_line.take().unwrap_or_default();
        let by_line = by_line.finish(|text| self.file(text));
        let mut summary = self.summary;
        summary.by_line = by_line;
        summary.energy_j = energy.then_some(self.energy_j);
        summary.certificate = summary.certificate.or(Some(Certificate::Planned));
        summary
    }
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
        file: String::new(),
        runs: 1,
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
