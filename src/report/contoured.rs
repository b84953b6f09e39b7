//! Contour errors: for people, as CSV and JSON.

use std::fmt::Write as _;
use std::io::{self, Read, Write};

use serde_json::{Value, json};

use super::estimate::number;
use crate::contour::{ArcResult, ContourRow, ContourSummary, Errors, Roundness};

/// Columns of the CSV.
pub const CONTOUR_COLUMNS: &str = "line,run,move,start_s,duration_s,error_um,error_rms_um,\
corrected_error_um,corrected_error_rms_um,radius_mm,roundness_um,shrinkage_um,\
corrected_roundness_um,corrected_shrinkage_um";
/// Arcs that are shown to people.
const ARCS_MAX: usize = 12;
/// Micrometres in a millimetre.
const UM: f64 = 1e3;

/// Digits of a nanometre, and a few more.
fn um(mm: f64) -> f64 {
    super::figure::round_to_digits(mm * UM, 6)
}

fn round(value: f64) -> f64 {
    super::figure::round_to_digits(value, 9)
}

/// A row as CSV.
///
/// # Errors
/// Those of `out`.
pub fn contour_csv_row(row: &ContourRow, corrected: bool, out: &mut dyn Write) -> io::Result<()> {
    write!(
        out,
        "{},{},{},{},{}",
        row.line,
        row.run,
        row.kind.name(),
        round(row.start_s),
        round(row.duration_s)
    )?;
    for which in 0..2 {
        match errors_of(row, which, corrected) {
            Some(errors) => write!(out, ",{},{}", um(errors.largest_mm), um(errors.rms_mm()))?,
            None => write!(out, ",,")?,
        }
    }
    match &row.arc {
        Some(arc) => write!(out, ",{}", round(arc.radius_mm))?,
        None => write!(out, ",")?,
    }
    for which in 0..2 {
        match row.arc.as_ref().and_then(|arc| roundness(arc, which)) {
            Some(found) => write!(
                out,
                ",{},{}",
                um(found.roundness_mm),
                um(found.shrinkage_mm)
            )?,
            None => write!(out, ",,")?,
        }
    }
    writeln!(out)
}

fn errors_of(row: &ContourRow, which: usize, corrected: bool) -> Option<Errors> {
    let errors = row.errors.filter(|_| which == 0 || corrected)?;
    errors.get(which).copied()
}

fn roundness(arc: &ArcResult, which: usize) -> Option<&Roundness> {
    arc.roundness.get(which)?.as_ref()
}

/// A row as JSON.
///
/// # Errors
/// Those of `out`.
pub fn contour_json_row(row: &ContourRow, corrected: bool, out: &mut dyn Write) -> io::Result<()> {
    let error = |which, value: fn(Errors) -> f64| {
        number(errors_of(row, which, corrected).map(|errors| um(value(errors))))
    };
    let round_by = |which, value: fn(&Roundness) -> f64| {
        let found = row.arc.as_ref().and_then(|arc| roundness(arc, which));
        number(found.map(|found| um(value(found))))
    };
    let value = json!({
        "line": row.line,
        "run": row.run,
        "move": row.kind.name(),
        "start_s": round(row.start_s),
        "duration_s": round(row.duration_s),
        "error_um": error(0, |e| e.largest_mm),
        "error_rms_um": error(0, |e| e.rms_mm()),
        "corrected_error_um": error(1, |e| e.largest_mm),
        "corrected_error_rms_um": error(1, |e| e.rms_mm()),
        "radius_mm": number(row.arc.as_ref().map(|arc| round(arc.radius_mm))),
        "roundness_um": round_by(0, |r| r.roundness_mm),
        "shrinkage_um": round_by(0, |r| r.shrinkage_mm),
        "corrected_roundness_um": round_by(1, |r| r.roundness_mm),
        "corrected_shrinkage_um": round_by(1, |r| r.shrinkage_mm),
    });
    serde_json::to_writer(out, &value)?;
    Ok(())
}

/// The whole as JSON; `rows` are those of [`contour_json_row`], joined by commas.
///
/// # Errors
/// Those of reading and writing.
pub fn contour_json(
    program: &str,
    machine: &str,
    summary: &ContourSummary,
    rows: &mut dyn Read,
    out: &mut dyn Write,
) -> io::Result<()> {
    let with = |value: f64| number(summary.corrected.then_some(value));
    let axes: Vec<Value> = summary
        .axes
        .iter()
        .map(|axis| {
            let unit = if axis.rotary { "torque_nm" } else { "force_n" };
            let [peak, corrected_peak] = axis.force_peak_n;
            let [rms, corrected_rms] = axis.force_rms_n;
            json!({
                "axis": axis.letter.to_string(),
                format!("{unit}_peak"): round(peak),
                format!("{unit}_rms"): round(rms),
                format!("corrected_{unit}_peak"): with(round(corrected_peak)),
                format!("corrected_{unit}_rms"): with(round(corrected_rms)),
            })
        })
        .collect();
    let [errors, corrected] = summary.errors;
    let [line, corrected_line] = summary.lines;
    let [effort, corrected_effort] = summary.efforts;
    let value = json!({
        "program": program,
        "machine": machine,
        "duration_s": round(summary.duration_s),
        "period_s": summary.period_s,
        "corrected": summary.corrected,
        "error_um": um(errors.largest_mm),
        "error_rms_um": um(errors.rms_mm()),
        "error_line": line,
        "corrected_error_um": with(um(corrected.largest_mm)),
        "corrected_error_rms_um": with(um(corrected.rms_mm())),
        "corrected_error_line": summary.corrected.then_some(corrected_line),
        "peak_w": round(effort.peak_w),
        "regen_w": round(effort.regen_w),
        "corrected_peak_w": with(round(corrected_effort.peak_w)),
        "corrected_regen_w": with(round(corrected_effort.regen_w)),
        "axes": axes,
        "conditions": summary.conditions,
    });
    let head = serde_json::to_string_pretty(&value)?;
    let head = head.trim_end().trim_end_matches('}').trim_end();
    write!(out, "{head},\n  \"moves\": [")?;
    io::copy(rows, out)?;
    writeln!(out, "\n  ]\n}}")
}

/// The whole, for people; `arcs` in the order of the program.
#[must_use]
pub fn contour_text(
    program: &str,
    machine: &str,
    summary: &ContourSummary,
    arcs: &[ArcResult],
    more_arcs: u64,
) -> String {
    let mut text = format!("{program} on {machine}: contour error of the load\n");
    let names = ["without correction", "with correction"];
    let runs = if summary.corrected { 2 } else { 1 };
    for (which, name) in names.iter().enumerate().take(runs) {
        let (Some(errors), Some(line), Some(effort)) = (
            summary.errors.get(which),
            summary.lines.get(which),
            summary.efforts.get(which),
        ) else {
            continue;
        };
        let _ = write!(
            text,
            "  {name:<20} {:.2} µm at most (line {line}), {:.2} µm rms; {:.0} W",
            errors.largest_mm * UM,
            errors.rms_mm() * UM,
            effort.peak_w
        );
        for axis in &summary.axes {
            let peak = axis.force_peak_n.get(which).copied().unwrap_or(0.0);
            let unit = if axis.rotary { "N·m" } else { "N" };
            let _ = write!(text, ", {} {peak:.0} {unit}", axis.letter);
        }
        text.push('\n');
    }
    let mut untold = more_arcs;
    for arc in arcs {
        let found: Vec<String> = (0..2)
            .filter_map(|which| roundness(arc, which))
            .map(|r| {
                format!(
                    "{:.2} µm out of round, {:.2} µm smaller",
                    r.roundness_mm * UM,
                    r.shrinkage_mm * UM
                )
            })
            .collect();
        if found.is_empty() {
            untold += 1;
            continue;
        }
        let _ = writeln!(
            text,
            "  line {}, radius {} mm at {} mm/min: {}",
            arc.line,
            super::figure::round_to_digits(arc.radius_mm, 6),
            super::figure::round_to_digits(arc.speed_mm_s * 60.0, 5),
            found.join("; corrected ")
        );
    }
    if untold > 0 {
        let _ = writeln!(
            text,
            "  {untold} more arcs: too short for the load to settle, or in the files alone"
        );
    }
    for condition in &summary.conditions {
        let _ = writeln!(text, "  {condition}");
    }
    text
}

/// Keeps what people are shown of arcs, and what is drawn of them: those that
/// are least round.
#[derive(Debug, Default)]
pub struct ArcList {
    arcs: Vec<ArcResult>,
    /// Arcs that are not kept.
    pub more: u64,
}

impl ArcList {
    /// Takes an arc.
    pub fn take(&mut self, arc: &ArcResult) {
        if roundness(arc, 0).is_none() {
            self.more += 1;
            return;
        }
        self.arcs.push(arc.clone());
        if self.arcs.len() > ARCS_MAX {
            let round = |arc: &ArcResult| roundness(arc, 0).map_or(0.0, |r| r.roundness_mm);
            let least = self
                .arcs
                .iter()
                .enumerate()
                .min_by(|a, b| round(a.1).total_cmp(&round(b.1)));
            if let Some((index, _)) = least {
                self.arcs.remove(index);
                self.more += 1;
            }
        }
    }

    /// The arcs, in the order of the program.
    #[must_use]
    pub fn arcs(&self) -> &[ArcResult] {
        &self.arcs
    }
}
