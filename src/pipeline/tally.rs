//! Adds up judged moves: figures, rows, and what does not fit.

use std::io;

use super::{Certificate, Failure, Options, Row, RowSink, Start, Summary, Unfit};
use crate::interpret::Move;
use crate::machine::{AxisSet, Machine, PathMode};
use crate::power::{Assessment, PowerModel};
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
    smallest_limit_w: f64,
    exact: bool,
}

impl<'m, 'r> Tally<'m, 'r> {
    pub(super) fn new(
        machine: &'m Machine,
        options: &Options,
        rows: Option<&'r mut (dyn RowSink + 'r)>,
    ) -> Self {
        let model = PowerModel::new(machine);
        // Only the largest peak is wanted of a single converter without rows.
        let exact = rows.is_some() || machine.converters.len() > 1;
        let smallest_limit_w = model.limit_w(0);
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
            smallest_limit_w,
            exact,
        }
    }

    /// Peaks below this are not wanted exactly, W.
    pub(super) fn floor_w(&self) -> f64 {
        if self.exact {
            f64::NEG_INFINITY
        } else {
            self.summary.peak_w.min(self.smallest_limit_w)
        }
    }

    /// Takes the next judged move.
    pub(super) fn take(&mut self, mv: &Move, assessment: &Assessment, text: &[u8]) {
        if self.rows.is_some() {
            let row = row(
                self.machine,
                &self.model,
                mv,
                assessment,
                self.summary.duration_s,
            );
            self.write(&row);
        }
        self.add(mv, assessment, text);
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

    /// Adds a move to the figures, without a row.
    pub(super) fn add(&mut self, mv: &Move, assessment: &Assessment, text: &[u8]) {
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
            self.keep_unfit(mv, assessment, text);
        }
    }

    #[cold]
    fn keep_unfit(&mut self, mv: &Move, assessment: &Assessment, text: &[u8]) {
        let overload = assessment.demand.load_ratio;
        self.summary.unfit_count += 1;
        let listed = self.summary.unfit.len() < Summary::KEPT;
        let worst = &self.summary.worst;
        let among_worst =
            worst.len() < WORST || worst.last().is_some_and(|last| overload > last.overload);
        if !listed && !among_worst {
            return;
        }
        let unfit = unfit(&self.model, mv, assessment, text);
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

    /// The figures; lines, notes and conditions are still to be filled in.
    pub(super) fn finish(self) -> Summary {
        let mut summary = self.summary;
        summary.energy_j = self.rows.is_some().then_some(self.energy_j);
        summary.certificate = summary.certificate.or(Some(Certificate::Planned));
        summary
    }
}

/// Axes that really move, or may.
pub(super) fn axes(mv: &Move) -> AxisSet {
    AxisSet(mv.moving.0 | mv.unknown_start.0)
}

/// The row of a judged move that begins at `start_s`.
pub(super) fn row(
    machine: &Machine,
    model: &PowerModel,
    mv: &Move,
    assessment: &Assessment,
    start_s: f64,
) -> Row {
    let demand = &assessment.demand;
    let limit_w = model.limit_w(demand.converter);
    Row {
        line: mv.line,
        n_word: mv.number,
        kind: mv.kind,
        axes: axes(mv),
        start_s,
        duration_s: assessment.duration_s,
        peak_w: demand.peak_w,
        regen_w: demand.regen_w,
        limit_w,
        ratio: (demand.peak_w > 0.0).then(|| limit_w / demand.peak_w),
        energy_j: demand.energy_j,
        action: "",
        knob: String::new(),
        value_before: None,
        value_after: None,
        peak_after_w: None,
        duration_after_s: None,
        regen_after_w: None,
        certificate: assessment.certificate,
        regen_limit_w: model.regen_limit_w(demand.converter),
        converter: machine
            .converters
            .get(demand.converter)
            .map_or_else(String::new, |it| it.name.clone()),
    }
}

fn unfit(model: &PowerModel, mv: &Move, assessment: &Assessment, text: &[u8]) -> Unfit {
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
        help: String::new(),
        text: text.get(..TEXT_MAX).unwrap_or(text).to_vec(),
    }
}

/// What the figures rest on, in plain sentences.
pub(super) fn conditions(machine: &Machine, options: &Options, summary: &Summary) -> Vec<String> {
    let percent = |factor: f64| factor * 100.0;
    let limits = &machine.limits;
    let mut conditions = vec![match summary.certificate {
        Some(Certificate::Robust) => {
            "robust: blended moves hold for any look-ahead, blending and filtering that \
             keeps each axis inside its own limits; times are those with a stop at each block"
                .to_owned()
        }
        _ => "planned: every block ends at rest (exact stop)".to_owned(),
    }];
    if machine.path.mode == Some(PathMode::ExactStop) {
        conditions
            .push("path.mode of the machine file is exact-stop: G64 is overridden".to_owned());
    }
    conditions.push(format!(
        "overrides at most: feed {} %, rapid {} %, spindle {} %",
        percent(limits.feed_override_max),
        percent(limits.rapid_override_max),
        percent(limits.spindle_override_max)
    ));
    conditions.push(format!(
        "margin {} % of the converter's power",
        percent(limits.margin)
    ));
    conditions.push(match options.start {
        Start::Unknown => "start position unknown".to_owned(),
        Start::At(at) if at.iter().all(|value| *value == 0.0) => {
            "start position 0 for every axis".to_owned()
        }
        Start::At(_) => "start position as given".to_owned(),
    });
    conditions.push(
        if options.block_delete {
            "blocks with / are skipped"
        } else {
            "blocks with / are executed"
        }
        .to_owned(),
    );
    conditions.push(
        "cutting forces are not counted; emergency stop and feed hold are outside".to_owned(),
    );
    if !machine.unchecked.is_empty() {
        conditions.push(format!("not checked yet: {}", machine.unchecked.join(", ")));
    }
    conditions
}
