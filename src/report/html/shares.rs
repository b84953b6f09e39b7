//! The planned power over time: who draws how much of it, in bounded memory.

use std::io;

use super::block::Block;
use super::door::{BASE, Door, Sample, UNKNOWN, VALUES};
use super::rows::PageRows;
use crate::machine::Machine;
use crate::pipeline::SeriesSink;
use crate::power::{Instant, VoltageCurve};

/// Spans that are kept.
const SPANS_MAX: usize = 4000;
/// How far what is drawn may be from the planned power, by the converters' peak power.
const APART: f64 = 2e-3;
/// Rounding of times, as a share, and in s.
const ROUNDING: f64 = 1e-9;
/// See [`ROUNDING`].
const ROUNDING_S: f64 = 1e-9;

/// Which program a series shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// As it is.
    Before,
    /// As it was written, or on the second machine.
    After,
}

/// Some samples in a row.
#[derive(Debug, Clone)]
pub(super) struct Span {
    pub from_s: f64,
    pub to_s: f64,
    /// When most is drawn, and when most is fed back.
    pub drawn: Sample,
    pub back: Sample,
}

/// A peak, and what is drawn at its moment.
#[derive(Debug, Clone)]
pub(super) struct Moment {
    pub block: Block,
    /// The peak as the report has it, W.
    pub peak_w: f64,
    pub from_s: f64,
    pub to_s: f64,
    /// The converter that the peak is about; `None`: all.
    converter: Option<usize>,
    /// Its end has been met.
    over: bool,
    /// The sample with the largest power of that converter, and this power.
    pub sample: Option<(Sample, f64)>,
}

/// The planned power of a program, as a page shows it.
#[derive(Debug)]
pub struct PageSeries {
    pub(super) spans: Vec<Span>,
    /// Samples that a span holds when it is full, and those in the last one.
    size: u64,
    filled: u64,
    door: Door,
    last: Option<Sample>,
    /// In the order of time.
    pub(super) moments: Vec<Moment>,
    /// The first that is not over.
    now: usize,
    /// What is fed back, J.
    pub(super) fed_back_j: f64,
    /// The voltages of buses as the limits over time have them.
    pub(super) voltages: Vec<VoltageCurve>,
}

impl PageSeries {
    /// What is to be kept of a series of one of the programs that `rows` are about.
    #[must_use]
    pub fn new(machine: &Machine, rows: &PageRows, side: Side) -> Self {
        let peak_power_w: f64 = machine.converters.iter().map(|it| it.peak_power_w).sum();
        Self {
            spans: Vec::new(),
            size: 1,
            filled: 0,
            door: Door::new(APART * peak_power_w),
            last: None,
            moments: moments(machine, rows, side),
            now: 0,
            fed_back_j: 0.0,
            voltages: Vec::new(),
        }
    }

    /// A step between samples that shows a program of `duration_s` well, s.
    #[must_use]
    pub fn step_s(duration_s: f64) -> f64 {
        (duration_s / 1e5).clamp(1e-3, 1e6)
    }

    /// Takes what is still held back.
    pub fn finish(&mut self) {
        if let Some(last) = self.door.finish() {
            self.keep(last);
        }
    }

    /// Whether there are moves from an unknown start.
    pub(super) fn has_unknown(&self) -> bool {
        let mut spans = self.spans.iter();
        spans.any(|it| it.drawn.values_w[UNKNOWN] > 0.0)
    }

    /// Whether each span is one sample.
    pub(super) fn is_whole(&self) -> bool {
        self.size == 1
    }

    fn keep(&mut self, sample: Sample) {
        let alone = Span {
            from_s: sample.time_s,
            to_s: sample.time_s,
            drawn: sample,
            back: sample,
        };
        self.filled += 1;
        if self.filled <= self.size
            && let Some(last) = self.spans.last_mut()
        {
            last.join(&alone);
            return;
        }
        self.filled = 1;
        self.spans.push(alone);
        if self.spans.len() > SPANS_MAX {
            let pairs = self.spans.chunks(2).filter_map(|pair| {
                let mut span = pair.first()?.clone();
                if let Some(second) = pair.get(1) {
                    span.join(second);
                }
                Some(span)
            });
            self.spans = pairs.collect();
            self.size *= 2;
        }
    }

    /// Looks whether the sample is that of a peak.
    fn meet(&mut self, sample: &Sample, instant: &Instant) {
        let apart_s = ROUNDING_S + ROUNDING * sample.time_s;
        while let Some(moment) = self.moments.get(self.now)
            && moment.to_s + apart_s < sample.time_s
        {
            self.now += 1;
        }
        for moment in self.moments.iter_mut().skip(self.now) {
            if moment.from_s - apart_s > sample.time_s {
                return;
            }
            let power_w = match moment.converter {
                Some(which) => instant.bus_w.get(which).copied().unwrap_or(0.0),
                None => sample.values_w[0],
            };
            moment.meet(sample, power_w, apart_s);
        }
    }
}

impl SeriesSink for PageSeries {
    fn row(&mut self, time_s: f64, _line: u64, instant: &Instant) -> io::Result<()> {
        let sample = sample(time_s, instant);
        // From an unknown start it is a bound, of which no energy can be made.
        let known = instant.unknown_axes.is_empty();
        if let Some(last) = self.last.filter(|_| known) {
            let mean_w = f64::midpoint(last.values_w[1], sample.values_w[1]);
            self.fed_back_j += mean_w * (time_s - last.time_s);
        }
        self.last = Some(sample).filter(|_| known);
        self.meet(&sample, instant);
        if let Some(kept) = self.door.add(&sample) {
            self.keep(kept);
        }
        Ok(())
    }

    fn wants_voltages(&self) -> bool {
        true
    }

    fn voltages(&mut self, curves: Vec<VoltageCurve>) {
        self.voltages = curves;
    }
}

impl Moment {
    /// Takes a sample with this power of its converter. Where it begins and ends the power may
    /// jump: then the last sample of the one instant and the first of the other are its own.
    fn meet(&mut self, sample: &Sample, power_w: f64, apart_s: f64) {
        let is_at = |time_s: f64| (sample.time_s - time_s).abs() <= apart_s;
        let lasts = self.to_s - self.from_s > 2.0 * apart_s;
        let begins = lasts && is_at(self.from_s);
        if lasts && is_at(self.to_s) && std::mem::replace(&mut self.over, true) {
            return;
        }
        if begins || self.sample.is_none_or(|(_, most_w)| power_w > most_w) {
            self.sample = Some((*sample, power_w));
        }
    }
}

impl Span {
    /// Takes the next one in.
    pub(super) fn join(&mut self, next: &Self) {
        self.to_s = next.to_s;
        if next.drawn.values_w[0] > self.drawn.values_w[0] {
            self.drawn = next.drawn;
        }
        if next.back.values_w[1] > self.back.values_w[1] {
            self.back = next.back;
        }
    }
}

/// The largest peaks, in the order of time.
fn moments(machine: &Machine, rows: &PageRows, side: Side) -> Vec<Moment> {
    let peaks = match side {
        Side::Before => &rows.before,
        Side::After => &rows.after,
    };
    let several = machine.converters.len() > 1;
    let moment = |block: &Block| {
        let row = &block.row;
        let (peak_w, from_s, lasts_s) = match side {
            Side::Before if !block.is_on_first() => return None,
            Side::Before => (row.peak_w, row.start_s, row.duration_s),
            Side::After => (row.peak_after_w?, row.start_after_s?, row.duration_after_s?),
        };
        let name = match (side, &block.other) {
            (Side::After, Some(other)) => &other.converter,
            _ => &row.converter,
        };
        let names = machine.converters.iter();
        let converter = names.map(|it| &it.name).position(|it| it == name);
        Some(Moment {
            block: block.clone(),
            peak_w,
            from_s,
            to_s: from_s + lasts_s,
            converter: converter.filter(|_| several),
            over: false,
            sample: None,
        })
    };
    let mut list: Vec<Moment> = peaks.list.iter().filter_map(moment).collect();
    list.sort_by(|a, b| a.from_s.total_cmp(&b.from_s));
    list
}

/// Who draws what at an instant.
fn sample(time_s: f64, instant: &Instant) -> Sample {
    let mut values_w = [0.0; VALUES];
    let bus_w: f64 = instant.bus_w.iter().sum();
    let regen_w: f64 = instant.regen_w.iter().sum();
    let spindle = &instant.spindle;
    let mut left_w = bus_w;
    let own = [spindle.power_w, spindle.cutting_w];
    let powers = instant.axes.iter().map(|axis| axis.power_w).chain(own);
    for (place, power_w) in values_w.iter_mut().skip(2).zip(powers) {
        if !power_w.is_nan() {
            *place = power_w;
            left_w -= power_w.max(0.0);
        }
    }
    // Where what is fed back counts, less is drawn than all draw; rounding is none.
    if left_w > ROUNDING * bus_w {
        let known = instant.unknown_axes.is_empty();
        values_w[if known { BASE } else { UNKNOWN }] = left_w;
    }
    [values_w[0], values_w[1]] = [bus_w, regen_w];
    Sample { time_s, values_w }
}
