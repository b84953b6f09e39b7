//! The figures at the top of a page: those of the report.

use serde_json::{Value, json};

use super::columns::{figure, known};
use super::shown::{Compared, Found, Page};
use crate::machine::{Converter, Machine};
use crate::pipeline::{Certificate, LimitSummary, OverTime, Summary, Unfit};
use crate::power::PowerModel;
use crate::report::checked::Verdict;
use crate::report::over_time;

/// What is said of the program as a whole.
pub(super) fn head(page: &Page<'_>) -> Value {
    let (before, after) = match page.found {
        Found::Report(summary) => (summary, None),
        Found::Limit { summary, .. } => (&summary.before, Some(&summary.after)),
        Found::Diff(compared) => (compared.summaries[0], Some(compared.summaries[1])),
    };
    let last = after.unwrap_or(before);
    let (limited, compared) = match page.found {
        Found::Report(_) => (None, None),
        Found::Limit { summary, .. } => (Some(limited(summary)), None),
        Found::Diff(compared) => (None, Some(compared)),
    };
    let over_time = match compared {
        Some(compared) => both(compared, over_time_list),
        None => over_time_list(last, ""),
    };
    let notes_of = |summary: &Summary| -> Vec<String> {
        let notes = summary.notes.iter();
        notes.map(|note| note.message.clone()).collect()
    };
    let (notes, conditions) = match compared {
        Some(Compared {
            summaries, names, ..
        }) => (
            of_both(&summaries.map(notes_of), names),
            of_both(&summaries.map(|it| it.conditions.clone()), names),
        ),
        None => (notes_of(before), last.conditions.clone()),
    };
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
        "limits": limits(page.machine),
        "compared": compared.map(comparison),
        "helps": before.unfit.iter().chain(&before.worst).filter_map(help).collect::<Vec<_>>(),
        "over_time": over_time,
        "conditions": conditions,
        "notes": notes,
    })
}

/// The verdict in words.
pub(super) fn word(page: &Page<'_>) -> &'static str {
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
        Found::Diff(compared) if ceases(compared) => "ceases to fit",
        Found::Diff(_) => "nothing ceases to fit",
    }
}

/// Whether that is good.
pub(super) fn fits(page: &Page<'_>) -> bool {
    match page.found {
        Found::Report(summary) => summary.fits(),
        Found::Limit { summary, .. } => summary.certified,
        Found::Diff(compared) => !ceases(compared),
    }
}

fn ceases(compared: Compared<'_>) -> bool {
    compared.comparison.verdict() != Verdict::Fits
}

/// What a page of two machines has besides: the figures of the comparison, and what the second
/// machine bears.
fn comparison(compared: Compared<'_>) -> Value {
    let Compared {
        other, comparison, ..
    } = compared;
    let [begin, cease] = comparison.limit_changes();
    json!({
        "names": compared.names,
        "machine": other.name,
        "controller": other.controller.language.name,
        "begin": comparison.begin,
        "cease": comparison.cease,
        "limits_begin": begin,
        "limits_cease": cease,
        "limits": limits(other),
    })
}

/// What is said of each of two machines, with its name.
fn both(compared: Compared<'_>, list: fn(&Summary, &str) -> Vec<Value>) -> Vec<Value> {
    let all = compared.summaries.into_iter().zip(compared.names);
    all.flat_map(|(summary, name)| list(summary, name))
        .collect()
}

/// What is said of both machines, then what is said of one, with its name.
fn of_both(lists: &[Vec<String>; 2], names: [&str; 2]) -> Vec<String> {
    let [first, second] = lists;
    let shared = first.iter().filter(|it| second.contains(it)).cloned();
    let mut list: Vec<String> = shared.collect();
    for (own, other, name) in [(first, second, names[0]), (second, first, names[1])] {
        let alone = own.iter().filter(|it| !other.contains(it));
        list.extend(alone.map(|it| format!("{name}: {it}")));
    }
    list
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
fn limits(machine: &Machine) -> Vec<Value> {
    let model = PowerModel::new(machine);
    let converters = machine.converters.iter().enumerate();
    let limit = |(index, it): (usize, &Converter)| {
        let overload = it.ratings.overload.iter();
        json!({
            "name": it.name,
            "limit_w": figure(model.limit_w(index)),
            "peak_power_w": figure(it.peak_power_w),
            "regen_limit_w": known(model.regen_limit_w(index), figure),
            "credit_regen": it.credit_regen,
            "margin": figure(machine.limits.margin),
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

/// What is said of limits over time; `machine` is the name of the machine, where there are two.
fn over_time_list(summary: &Summary, machine: &str) -> Vec<Value> {
    let item = |found: &OverTime| {
        let overload = over_time::overload(found);
        json!({
            "machine": machine,
            "title": found.title(),
            "figures": over_time::figures(&found.rating),
            "fits": found.rating.fits(),
            "line": found.rating.line,
            "time_s": figure(found.rating.time_s),
            "above_w": known(overload.as_ref().map(|it| it.0), figure),
            "label": overload.map(|it| it.1),
            "help": if found.rating.fits() { "" } else { found.help() },
        })
    };
    summary.over_time.iter().map(item).collect()
}
