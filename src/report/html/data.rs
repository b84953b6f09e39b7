//! What a page shows, as JSON.

use std::collections::BTreeMap;

use serde_json::{Value, json};

use super::block::Block;
use super::cell::Cell;
use super::columns::{column, drawn, figure, known, share, time, words};
use super::door::{BASE, UNKNOWN};
use super::figures;
use super::shares::{Moment, PageSeries};
use super::shown::Page;
use super::voltage;
use crate::machine::{ALL_AXES, AXES, RapidPath};

/// The rows that anything on the page is about, each once, by their place.
struct Blocks<'a> {
    list: Vec<&'a Block>,
    places: BTreeMap<u64, usize>,
}

impl<'a> Blocks<'a> {
    fn of(page: &Page<'a>) -> Self {
        let rows = page.rows;
        let bars = rows.bars.list.iter().map(|bar| &bar.lead);
        let lines = rows.path.list.iter().map(|line| &line.lead);
        let peaks = rows.peaks().into_iter().flat_map(|peaks| &peaks.list);
        let all: BTreeMap<u64, &Block> = bars
            .chain(lines)
            .chain(peaks)
            .map(|block| (block.index, block))
            .collect();
        let places = all.keys().copied().zip(0..).collect();
        let list = all.into_values().collect();
        Self { list, places }
    }

    fn place(&self, block: &Block) -> Value {
        Value::from(self.places.get(&block.index).copied().unwrap_or(0))
    }
}

/// All of a page.
pub(super) fn data(page: &Page<'_>) -> Value {
    let blocks = Blocks::of(page);
    let places = |list: &[Block]| -> Vec<Value> {
        let list = list.iter();
        list.map(|block| blocks.place(block)).collect()
    };
    let moments = |series: Option<&PageSeries>| {
        let list = series.map_or(&[][..], |series| &series.moments);
        let mut list: Vec<&Moment> = list.iter().collect();
        list.sort_by(|a, b| b.peak_w.total_cmp(&a.peak_w));
        list.into_iter()
            .map(|it| moment(page, &blocks, it))
            .collect::<Vec<_>>()
    };
    json!({
        "head": figures::head(page),
        "texts": {
            "line": page.texts.texts.keys().collect::<Vec<_>>(),
            "text": page.texts.texts.values().collect::<Vec<_>>(),
        },
        "blocks": columns(&blocks),
        "bars": bars(page, &blocks),
        "path": path(page, &blocks),
        "channels": channels(page),
        "shares": {
            "before": page.before.map(|series| shares(page, series)),
            "after": page.after.map(|series| shares(page, series)),
        },
        "voltage": voltage::data(page),
        "moments": {
            "before": moments(page.before),
            "after": moments(page.after),
        },
        "worst": places(&page.rows.worst.list),
        "differ": places(&page.rows.differ.list),
    })
}

fn moment(page: &Page<'_>, blocks: &Blocks<'_>, moment: &Moment) -> Value {
    let values = moment.sample.map(|(sample, _)| {
        let channels = channel_places(page).into_iter();
        channels
            .map(|place| drawn(sample.values_w[place]))
            .collect::<Vec<_>>()
    });
    json!({
        "block": blocks.place(&moment.block),
        "time_s": moment.sample.map(|(sample, _)| time(sample.time_s)),
        "peak_w": figure(moment.peak_w),
        "planned_w": moment.sample.map(|(_, power_w)| drawn(power_w)),
        "values_w": values,
    })
}

/// The rows, one list a figure.
fn columns(blocks: &Blocks<'_>) -> Value {
    let each = |value: fn(&Block) -> Value| column(blocks.list.iter().map(|it| value(it)));
    // Of a move that the first of two machines does not make nothing is known there.
    let first = |value: fn(&Block) -> Value| {
        let of_first = |it: &&Block| it.is_on_first().then(|| value(it));
        let list = blocks.list.iter().copied();
        column(list.map(|it| of_first(&it).unwrap_or_default()))
    };
    let axes: Vec<String> = blocks
        .list
        .iter()
        .map(|it| it.row.axes.to_string())
        .collect();
    json!({
        "count": blocks.list.len(),
        "row": Value::from(blocks.list.iter().map(|it| it.index).collect::<Vec<_>>()),
        "line": each(|it| it.row.line.into()),
        "run": each(|it| it.row.run.into()),
        "file": words(blocks.list.iter().map(|it| it.row.file.as_str())),
        "kind": words(blocks.list.iter().map(|it| it.row.kind.name())),
        "axes": words(axes.iter().map(String::as_str)),
        "start_s": first(|it| time(it.row.start_s)),
        "duration_s": first(|it| drawn(it.row.duration_s)),
        "peak_w": first(|it| drawn(it.row.peak_w)),
        "regen_w": first(|it| drawn(it.row.regen_w)),
        "limit_w": first(|it| drawn(it.row.limit_w)),
        "regen_limit_w": first(|it| known(it.row.regen_limit_w, drawn)),
        "load": first(|it| share(it.passing().load())),
        "energy_j": first(|it| drawn(it.row.energy_j)),
        "bound": each(|it| it.passing().is_bound().into()),
        "converter": words(blocks.list.iter().map(|it| it.row.converter.as_str())),
        "action": words(blocks.list.iter().map(|it| it.row.action)),
        "words": words(blocks.list.iter().map(|it| it.row.words.as_str())),
        "start_after_s": each(|it| known(it.row.start_after_s, time)),
        "duration_after_s": each(|it| known(it.row.duration_after_s, drawn)),
        "peak_after_w": each(|it| known(it.row.peak_after_w, drawn)),
        "regen_after_w": each(|it| known(it.row.regen_after_w, drawn)),
        "load_after": each(|it| share(it.passing().load_after())),
        "limit_after_w": each(|it| known(it.other.as_ref().map(|it| it.limit_w), drawn)),
        "converter_after": words(blocks.list.iter().map(|it| it.converter_after())),
    })
}

/// The peaks over time: exact figures, since the largest is that of the report.
fn bars(page: &Page<'_>, blocks: &Blocks<'_>) -> Value {
    let list = &page.rows.bars.list;
    json!({
        "count": list.len(),
        "first": Value::from(list.iter().map(|it| it.first).collect::<Vec<_>>()),
        "rows": column(list.iter().map(|it| it.rows.into())),
        "lead": Value::Array(list.iter().map(|it| blocks.place(&it.lead)).collect()),
        "bound": column(list.iter().map(|it| it.bound.into())),
        "changed": column(list.iter().map(|it| it.changed.into())),
        "from_s": column(list.iter().map(|it| time(it.span_s[0]))),
        "to_s": column(list.iter().map(|it| time(it.span_s[1]))),
        "peak_w": column(list.iter().map(|it| figure(it.most_w[0]))),
        "regen_w": column(list.iter().map(|it| figure(it.most_w[1]))),
        "from_after_s": column(list.iter().map(|it| time(it.after_s[0]))),
        "to_after_s": column(list.iter().map(|it| time(it.after_s[1]))),
        "peak_after_w": column(list.iter().map(|it| figure(it.most_after_w[0]))),
        "regen_after_w": column(list.iter().map(|it| figure(it.most_after_w[1]))),
    })
}

/// The way: points as cells, and lines between them.
fn path(page: &Page<'_>, blocks: &Blocks<'_>) -> Value {
    let path = &page.rows.path;
    let mut places: BTreeMap<Cell, usize> = BTreeMap::new();
    let mut points: Vec<Cell> = Vec::new();
    let mut ends = Vec::with_capacity(2 * path.list.len());
    for cell in path.list.iter().flat_map(|line| line.ends) {
        let place = *places.entry(cell).or_insert_with(|| {
            points.push(cell);
            points.len() - 1
        });
        ends.push(place);
    }
    let independent = page.machine.path.rapid == RapidPath::Independent;
    json!({
        "cell_mm": path.cell_mm(),
        "error_mm": drawn(path.error_mm()),
        "unknown": path.unknown,
        "independent": independent,
        "points": points.iter().flatten().collect::<Vec<_>>(),
        "ends": ends,
        "lead": path.list.iter().map(|it| blocks.place(&it.lead)).collect::<Vec<_>>(),
    })
}

/// Who draws: the axes, the spindle, cutting, and what is left.
pub(super) fn channels(page: &Page<'_>) -> Vec<String> {
    let places = channel_places(page).into_iter();
    let name = |place: usize| match place.checked_sub(2) {
        Some(axis) if axis < AXES => ALL_AXES
            .get(axis)
            .map_or('?', |id| char::from(id.letter()))
            .to_string(),
        Some(AXES) => "spindle".to_owned(),
        Some(own) if own == AXES + 1 => "cutting".to_owned(),
        Some(own) if own + 2 == UNKNOWN => "unknown start, at most".to_owned(),
        _ => "base load".to_owned(),
    };
    places.map(name).collect()
}

/// The places of these among the values of a sample.
pub(super) fn channel_places(page: &Page<'_>) -> Vec<usize> {
    let has = |axis: usize| page.machines().any(|it| it.axis_set.contains(axis));
    let axes = (0..AXES).filter(|axis| has(*axis)).map(|axis| axis + 2);
    let has_spindle = page.machines().any(|it| it.spindle.is_some());
    let spindle = [AXES + 2, AXES + 3].into_iter().filter(|_| has_spindle);
    let mut series = [page.before, page.after].into_iter().flatten();
    let unknown = series.any(PageSeries::has_unknown).then_some(UNKNOWN);
    axes.chain(spindle).chain([BASE]).chain(unknown).collect()
}

/// The planned power over time.
fn shares(page: &Page<'_>, series: &PageSeries) -> Value {
    let spans = &series.spans;
    let places = channel_places(page).into_iter();
    let (up, down): (Vec<Value>, Vec<Value>) = places
        .map(|place| {
            let up = spans
                .iter()
                .map(|it| drawn(it.drawn.values_w[place].max(0.0)));
            let down = spans
                .iter()
                .map(|it| drawn((-it.back.values_w[place]).max(0.0)));
            (column(up), column(down))
        })
        .unzip();
    json!({
        "whole": series.is_whole(),
        "count": spans.len(),
        "from_s": column(spans.iter().map(|it| time(it.from_s))),
        "to_s": if series.is_whole() { Value::Null } else { column(spans.iter().map(|it| time(it.to_s))) },
        "up": up,
        "down": down,
        // Of bounds no energy can be made.
        "fed_back_j": (!series.has_unknown()).then(|| figure(series.fed_back_j)),
    })
}
