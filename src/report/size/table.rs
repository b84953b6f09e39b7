//! Sizing as CSV: a line for each program at each value.

use std::io::{self, Write};

use serde::Serialize;

use super::{Step, reasons_text, rungs, sized};
use crate::pipeline::Certificate;
use crate::pipeline::size::{Quantity, Rung, Size, Sizing, Trial};
use crate::report::figure::Figure;

#[derive(Serialize)]
struct Line<'a> {
    sized: &'static str,
    step: &'static str,
    wished_loss: Option<Figure>,
    peak_power_w: Figure,
    continuous_power_w: Option<Figure>,
    regen_power_w: Option<Figure>,
    capacitance_f: Option<Figure>,
    program: &'a str,
    certified: bool,
    certificate: &'static str,
    duration_s: Option<Figure>,
    loss: Option<Figure>,
    edited_lines: Option<u64>,
    peak_w: Option<Figure>,
    regen_w: Option<Figure>,
    reason: String,
}

/// The figures as CSV; of several programs there is a line for all together, without a
/// name.
///
/// # Errors
/// Those of `out`.
pub fn size_csv(size: &Size, out: impl Write) -> io::Result<()> {
    let mut out = csv::WriterBuilder::new()
        .terminator(csv::Terminator::CRLF)
        .from_writer(out);
    for sizing in [Some(&size.rating), size.capacitance.as_ref()]
        .into_iter()
        .flatten()
    {
        let Some(curve) = &sizing.curve else { continue };
        for (step, rung) in rungs(curve) {
            for line in lines(sizing, step, rung) {
                out.serialize(line)?;
            }
        }
    }
    out.flush()
}

fn lines<'a>(sizing: &'a Sizing, step: Step, rung: &'a Rung) -> Vec<Line<'a>> {
    let programs = sized(sizing).zip(&rung.trials);
    let mut lines: Vec<Line<'_>> = programs
        .map(|((name, size), trial)| {
            let loss = trial.duration_s / size.unlimited.duration_s - 1.0;
            line(sizing.quantity, step, rung, name, trial, loss)
        })
        .collect();
    if lines.len() > 1 {
        let all = line(sizing.quantity, step, rung, "", &rung.total, rung.loss);
        lines.push(all);
    }
    lines
}

fn line<'a>(
    quantity: Quantity,
    step: Step,
    rung: &Rung,
    program: &'a str,
    trial: &Trial,
    loss: f64,
) -> Line<'a> {
    // What is not certified is not written: it has no figures.
    let figure = |value: f64| trial.certified.then_some(Figure(value));
    Line {
        sized: name(quantity),
        step: step.name(),
        wished_loss: step.wished().map(Figure),
        peak_power_w: Figure(rung.peak_power_w),
        continuous_power_w: rung.continuous_power_w.map(Figure),
        regen_power_w: rung.regen_power_w.map(Figure),
        capacitance_f: rung.capacitance_f.map(Figure),
        program,
        certified: trial.certified,
        certificate: trial
            .certificate
            .filter(|_| trial.certified)
            .map_or("", Certificate::name),
        duration_s: figure(trial.duration_s),
        loss: figure(loss.max(0.0)),
        edited_lines: trial.certified.then_some(trial.edited_lines),
        peak_w: figure(trial.peak_w),
        regen_w: figure(trial.regen_w),
        reason: reasons_text(&trial.reasons)
            .into_iter()
            .next()
            .unwrap_or_default(),
    }
}

/// The name of what is varied in CSV and JSON.
pub(super) fn name(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::Rating => "peak_power_w",
        Quantity::Capacitance => "capacitance_f",
    }
}
