//! Sizing as JSON.

use std::io::{self, Write};

use serde::Serialize;

use super::table::name;
use super::{Step, rungs};
use crate::pipeline::Certificate;
use crate::pipeline::size::{Curve, Outcome, ProgramSize, Rung, Size, Sizing, Trial};
use crate::report::figure::Figure;
use crate::report::finding::Finding;

#[derive(Serialize)]
struct Whole<'a> {
    machine: &'a str,
    converter: &'a str,
    /// The programs together, by the converter's peak power, highest first.
    curve: Vec<PointRecord>,
    unlimited: Option<UnlimitedRecord>,
    loss: Option<LossRecord>,
    rating: SizingRecord<'a>,
    capacitance: Option<SizingRecord<'a>>,
}

#[derive(Serialize)]
struct PointRecord {
    peak_power_w: Figure,
    duration_s: Option<Figure>,
    fits: bool,
}

/// Where nothing is slowed, and from which peak power on that is so.
#[derive(Serialize)]
struct UnlimitedRecord {
    duration_s: Figure,
    peak_power_w: Figure,
}

/// The first loss of time that was wished for, and the peak power that it takes.
#[derive(Serialize)]
struct LossRecord {
    percent: Figure,
    peak_power_w: Figure,
}

#[derive(Serialize)]
struct SizingRecord<'a> {
    sized: &'static str,
    programs: Vec<ProgramRecord<'a>>,
    #[serde(flatten)]
    curve: Option<CurveRecord>,
}

#[derive(Serialize)]
struct ProgramRecord<'a> {
    program: &'a str,
    outcome: &'static str,
    #[serde(flatten)]
    size: Option<SizeRecord>,
    /// Why it is certified nowhere, or not at `next_lower`.
    reasons: Vec<Finding<'a>>,
}

#[derive(Serialize)]
struct SizeRecord {
    duration_s: Figure,
    peak_w: Figure,
    regen_w: Figure,
    duration_unlimited_s: Figure,
    nothing_slowed_from: Figure,
    certified_from: Figure,
    next_lower: Option<Figure>,
}

#[derive(Serialize)]
struct CurveRecord {
    duration_s: Figure,
    nothing_slowed_from: Figure,
    certified_from: Figure,
    steps: Vec<StepRecord>,
}

#[derive(Serialize)]
struct StepRecord {
    step: &'static str,
    wished_loss: Option<Figure>,
    peak_power_w: Figure,
    continuous_power_w: Option<Figure>,
    regen_power_w: Option<Figure>,
    capacitance_f: Option<Figure>,
    #[serde(flatten)]
    total: TrialRecord,
    loss: Option<Figure>,
    /// In the order of the programs that were sized.
    programs: Vec<TrialRecord>,
}

#[derive(Serialize)]
struct TrialRecord {
    certified: bool,
    certificate: Option<&'static str>,
    duration_s: Option<Figure>,
    edited_lines: Option<u64>,
    peak_w: Option<Figure>,
    regen_w: Option<Figure>,
}

impl From<&Trial> for TrialRecord {
    fn from(trial: &Trial) -> Self {
        let figure = |value: f64| trial.certified.then_some(Figure(value));
        Self {
            certified: trial.certified,
            certificate: trial
                .certificate
                .filter(|_| trial.certified)
                .map(Certificate::name),
            duration_s: figure(trial.duration_s),
            edited_lines: trial.certified.then_some(trial.edited_lines),
            peak_w: figure(trial.peak_w),
            regen_w: figure(trial.regen_w),
        }
    }
}

/// The figures as JSON.
///
/// # Errors
/// Those of `out`.
pub fn size_json(
    size: &Size,
    machine: &str,
    converter: &str,
    mut out: impl Write,
) -> io::Result<()> {
    let curve = size.rating.curve.as_ref();
    let wished = curve.and_then(|curve| curve.losses.first());
    let whole = Whole {
        machine,
        converter,
        curve: curve.map(points).unwrap_or_default(),
        unlimited: curve.map(|curve| UnlimitedRecord {
            duration_s: Figure(curve.duration_s),
            peak_power_w: Figure(curve.enough),
        }),
        loss: wished.map(|(loss, rung)| LossRecord {
            percent: Figure(100.0 * loss),
            peak_power_w: Figure(rung.peak_power_w),
        }),
        rating: sizing(&size.rating),
        capacitance: size.capacitance.as_ref().map(sizing),
    };
    serde_json::to_writer_pretty(&mut out, &whole)?;
    writeln!(out)?;
    out.flush()
}

/// Each rating once, though it may be the machine's own or that for a loss as well.
fn points(curve: &Curve) -> Vec<PointRecord> {
    let mut rungs = rungs(curve);
    rungs.dedup_by(|(_, a), (_, b)| a.peak_power_w == b.peak_power_w);
    let point = |(_, rung): (Step, &Rung)| {
        let fits = rung.total.certified;
        PointRecord {
            peak_power_w: Figure(rung.peak_power_w),
            duration_s: fits.then_some(Figure(rung.total.duration_s)),
            fits,
        }
    };
    rungs.into_iter().map(point).collect()
}

fn sizing(sizing: &Sizing) -> SizingRecord<'_> {
    let programs = sizing.programs.iter();
    SizingRecord {
        sized: name(sizing.quantity),
        programs: programs.map(|(name, it)| program(name, it)).collect(),
        curve: sizing.curve.as_ref().map(curve),
    }
}

fn program<'a>(program: &'a str, outcome: &'a Outcome) -> ProgramRecord<'a> {
    let found = |outcome, size, reasons: &'a [_]| ProgramRecord {
        program,
        outcome,
        size,
        reasons: reasons.iter().map(Finding::from).collect(),
    };
    match outcome {
        Outcome::Refused(_) => found("refused", None, &[]),
        Outcome::Idle => found("idle", None, &[]),
        Outcome::Never { reasons, .. } => found("never", None, reasons),
        Outcome::Sized(size) => {
            let reasons = size.below.as_ref().map(|(_, reasons)| reasons.as_slice());
            found("sized", Some(record(size)), reasons.unwrap_or_default())
        }
    }
}

fn record(size: &ProgramSize) -> SizeRecord {
    SizeRecord {
        duration_s: Figure(size.duration_s),
        peak_w: Figure(size.peak_w),
        regen_w: Figure(size.regen_w),
        duration_unlimited_s: Figure(size.unlimited.duration_s),
        nothing_slowed_from: Figure(size.enough),
        certified_from: Figure(size.lowest),
        next_lower: size.below.as_ref().map(|(value, _)| Figure(*value)),
    }
}

fn curve(curve: &Curve) -> CurveRecord {
    CurveRecord {
        duration_s: Figure(curve.duration_s),
        nothing_slowed_from: Figure(curve.enough),
        certified_from: Figure(curve.lowest),
        steps: rungs(curve)
            .into_iter()
            .map(|(at, rung)| step(at, rung))
            .collect(),
    }
}

fn step(step: Step, rung: &Rung) -> StepRecord {
    StepRecord {
        step: step.name(),
        wished_loss: step.wished().map(Figure),
        peak_power_w: Figure(rung.peak_power_w),
        continuous_power_w: rung.continuous_power_w.map(Figure),
        regen_power_w: rung.regen_power_w.map(Figure),
        capacitance_f: rung.capacitance_f.map(Figure),
        total: TrialRecord::from(&rung.total),
        loss: rung.total.certified.then_some(Figure(rung.loss)),
        programs: rung.trials.iter().map(TrialRecord::from).collect(),
    }
}
