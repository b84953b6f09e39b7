//! The figures at the top of a page: those of the report.

use serde_json::{Value, json};

use super::columns::{figure, known};
use super::shown::{Found, Page};
use crate::pipeline::{Certificate, LimitSummary, OverTime, Summary, Unfit};
use crate::power::{Measure, PowerModel};
use crate::report::over_time;

/// What is said of the program as a whole.
pub(super) fn head(page: &Page<'_>) -> Value {
    let (before, after) = match page.found {
        Found::Report(summary) => (summary, None),
        Found::Limit { summary, .. } => (&summary.before, Some(&summary.after)),
    };
    let last = after.unwrap_or(before);
    let limited = match page.found {
        Found::Report(_) => None,
        Found::Limit { summary, .. } => Some(limited(summary)),
    };
    let notes = before.notes.iter();
    json!({
        "gwatt": env!("CARGO_PKG_VERSION"),
        "program": page.program,
        "machine": page.machine.name,
        "controller": page.machine.controller.language.name,
        "rows": page.rows.count,
        "changed": page.rows.changed,
        "word": word(page),
        "fits": fits(page),
        "before": summary(before),
        "after": after.map(summary),
        "limited": limited,
        "limits": limits(page),
        "helps": before.unfit.iter().chain(&before.worst).filter_map(help).collect::<Vec<_>>(),
        "over_time": over_time_list(last),
        "conditions": last.conditions,
        "notes": notes.map(|note| note.message.as_str()).collect::<Vec<_>>(),
    })
}

/// The verdict in words.
fn word(page: &Page<'_>) -> &'static str {
    match page.found {
        Found::Report(summary) if summary.only_subprograms() => "only subprograms",
        Found::Report(summary) if summary.fits() => "fits",
        Found::Report(_) => "does not fit",
        Found::Limit { summary, .. } if summary.certified && summary.edited_lines == 0 => {
            "fits as it is"
        }
        Found::Limit { summary, .. } if summary.certified => "fits now",
        Found::Limit { partly: true, .. } => "not certified: written as far as it can be lowered",
        Found::Limit { .. } => "cannot be made to fit: nothing is written",
    }
}

fn fits(page: &Page<'_>) -> bool {
    match page.found {
        Found::Report(summary) => summary.fits(),
        Found::Limit { summary, .. } => summary.certified,
    }
}

fn limited(summary: &LimitSummary) -> Value {
    let reasons = summary.reasons.iter();
    json!({
        "edited_lines": summary.edited_lines,
        "reasons": reasons.map(|it| json!([it.line, it.message])).collect::<Vec<_>>(),
    })
}

fn summary(summary: &Summary) -> Value {
    json!({
        "peak_w": figure(summary.peak_w),
        "peak_line": summary.peak_line,
        "regen_w": figure(summary.regen_w),
        "regen_line": summary.regen_line,
        "duration_s": figure(summary.duration_s),
        "energy_j": known(summary.energy_j, figure),
        "moves": summary.moves,
        "unfit_count": summary.unfit_count,
        "certificate": summary.certificate.map(Certificate::name),
    })
}

/// What each converter bears.
fn limits(page: &Page<'_>) -> Vec<Value> {
    let model = PowerModel::new(page.machine);
    let converters = page.machine.converters.iter().enumerate();
    let limit = |(index, it): (usize, &crate::machine::Converter)| {
        let overload = it.ratings.overload.iter();
        json!({
            "name": it.name,
            "limit_w": figure(model.limit_w(index)),
            "peak_power_w": figure(it.peak_power_w),
            "regen_limit_w": known(model.regen_limit_w(index), figure),
            "credit_regen": it.credit_regen,
            "margin": figure(page.machine.limits.margin),
            "overload_w": overload.map(|it| figure(it.power_w)).collect::<Vec<_>>(),
            "continuous_w": known(it.ratings.continuous.map(|it| it.power_w), figure),
        })
    };
    converters.map(limit).collect()
}

/// What would bring a block down, by its line.
fn help(unfit: &Unfit) -> Option<Value> {
    let said = !unfit.help.is_empty() && unfit.file.is_empty();
    said.then(|| json!([unfit.line, unfit.help]))
}

fn over_time_list(summary: &Summary) -> Vec<Value> {
    let item = |found: &OverTime| {
        let above_w = match found.rating.measure {
            Measure::Overload { above_w, .. } => Some(above_w),
            _ => None,
        };
        json!({
            "title": found.title(),
            "figures": over_time::figures(&found.rating),
            "fits": found.rating.fits(),
            "line": found.rating.line,
            "time_s": figure(found.rating.time_s),
            "above_w": known(above_w, figure),
            "help": if found.rating.fits() { "" } else { found.help() },
        })
    };
    summary.over_time.iter().map(item).collect()
}
