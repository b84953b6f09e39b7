//! gwatt's figures of a program next to those of the second implementation.

use std::io::Cursor;

use gwatt::interpret::MoveKind;
use gwatt::machine::{Machine, OverrideAt};
use gwatt::pipeline::{self, Options, Row, Summary};

use super::judge::{Figures, Judge, Step};
use super::over_time;
use super::plant::Plant;
use crate::machines::machine_from;
use crate::rows::Rows;

/// By what share a closed form may differ.
pub const CLOSED: f64 = 1e-6;
/// By what share a sampled figure may differ.
pub const SAMPLED: f64 = 1e-4;
/// By what share limits over time may: windows leave out a slice.
const OVER_TIME: f64 = 5e-3;
/// By what share sums of peaks that gwatt bounds may be above samples.
const LOOSE: f64 = 2e-2;
/// By what share of power times duration an energy may.
const ENERGY: f64 = 1e-3;
/// By what share steps of time may miss an S-curve under a curve of force.
const JERK_UNDER_CURVES: f64 = 3e-3;
/// By what share such moves may take longer than they must.
const BOUNDED: f64 = 1e-2;

/// What was compared.
#[derive(Debug, Default)]
pub struct Compared {
    pub blocks: usize,
    pub ratings: usize,
    /// What differs, in words.
    pub wrong: Vec<String>,
}

/// A machine of the library.
pub fn machine(toml: &str) -> Machine {
    machine_from(toml)
}

/// The steps of a program: its moves as the library reads them, and the speeds
/// of the spindle, which stand in lines of their own.
pub fn steps(machine: &Machine, program: &str) -> Vec<Step> {
    let mut moves = Vec::new();
    let input = Cursor::new(program.to_owned());
    pipeline::moves(input, machine, &Options::default(), &mut |mv, _| {
        moves.push(mv.clone());
        Ok(())
    })
    .unwrap_or_else(|failure| panic!("{failure:?}\n{program}"));
    let mut steps = Vec::new();
    let mut moves = moves.into_iter().peekable();
    for (index, line) in program.lines().enumerate() {
        if let Some((word, rpm)) = line.split_once(" S") {
            let rpm: f64 = rpm.parse().unwrap();
            let sign = ["M5", "M3", "M4"]
                .iter()
                .position(|own| *own == word)
                .unwrap();
            let rpm = [0.0, rpm, -rpm][sign];
            steps.push(Step::Spindle { rpm, on: sign > 0 });
        }
        while let Some(mv) = moves.next_if(|mv| mv.line == index as u64 + 1) {
            steps.push(Step::Move(Box::new(mv)));
        }
    }
    assert_eq!(moves.next(), None);
    steps
}

/// The rows of a program.
pub fn rows(machine: &Machine, program: &str) -> (Vec<Row>, Summary) {
    let mut rows = Rows::default();
    let input = Cursor::new(program.to_owned());
    let summary = pipeline::analyze(input, machine, &Options::default(), Some(&mut rows));
    let summary = summary.unwrap_or_else(|failure| panic!("{failure:?}\n{program}"));
    let mut rows = rows.0;
    rows.retain(|row| row.kind != MoveKind::Spindle);
    (rows, summary)
}

impl Compared {
    /// Compares a program on a machine, both as text.
    pub fn program(&mut self, toml: &str, program: &str) {
        let machine = machine(toml);
        let plant = Plant::new(toml);
        let steps = steps(&machine, program);
        let (rows_of_all, summary) = self::rows(&machine, program);
        let mut fastest = machine.clone();
        let limits = &mut fastest.limits;
        limits.override_at = Some(OverrideAt {
            feed: limits.feed_override_max,
            rapid: limits.rapid_override_max,
            spindle: limits.spindle_override_max,
        });
        let (rows, _) = self::rows(&fastest, program);
        let judged = |overrides: [f64; 2]| {
            let mut judge = Judge::new(&plant, overrides);
            steps
                .iter()
                .filter_map(|step| judge.take(step))
                .collect::<Vec<_>>()
        };
        // Times and energies are those at 100 %, or at the largest override below.
        let usual = plant.overrides.map(|factor| factor.min(1.0));
        let at_full = judged(usual);
        // Limits over time are shown at the largest overrides.
        let mut largest = Judge::new(&plant, plant.overrides).keeping();
        let mut at_most: Vec<Figures> =
            steps.iter().filter_map(|step| largest.take(step)).collect();
        assert_eq!(rows.len(), at_full.len(), "{program}");
        for ((row, full), most) in rows.iter().zip(&at_full).zip(&at_most) {
            self.row(&plant, row, full, most, true);
        }
        if plant.spindle.is_none() {
            for lower in [0.85, 0.7, 0.5, 0.3, 0.1] {
                let lowered = judged(plant.overrides.map(|factor| lower * factor));
                for (most, own) in at_most.iter_mut().zip(&lowered) {
                    most.include(own);
                }
            }
        }
        for ((row, full), most) in rows_of_all.iter().zip(&at_full).zip(&at_most) {
            self.row(&plant, row, full, most, false);
        }
        for found in &summary.over_time {
            let converter = plant
                .converters
                .iter()
                .position(|it| it.name == found.converter);
            let which = converter.unwrap();
            let slices = &largest.slices.as_ref().unwrap()[which];
            let (own, measure) = (&plant.converters[which], found.rating.measure);
            let value = over_time::value(own, measure, slices, plant.share);
            self.ratings += 1;
            if !over_time::is_covered(&found.rating, value, OVER_TIME) {
                self.wrong.push(format!("{:?}: {value}", found.rating));
            }
        }
    }

    /// Compares a row; `only` says that it is of these overrides alone, and not of all
    /// lower ones, of which a few are looked at here.
    fn row(&mut self, plant: &Plant, row: &Row, full: &Figures, most: &Figures, only: bool) {
        self.blocks += usize::from(only);
        if full.duration_s == 0.0 {
            return;
        }
        let curved = plant.axes.iter().any(|axis| !axis.curve.is_empty());
        let both = curved && plant.axes.iter().any(|axis| axis.jerk < f64::INFINITY);
        let share = match most.exact && full.exact {
            _ if both => JERK_UNDER_CURVES,
            true => CLOSED,
            false => SAMPLED,
        };
        // S-curves under curves, and curves of many kinks, may be bounded.
        let bounded = curved;
        let later = if bounded { BOUNDED } else { share };
        let mut differs = |what: &str, own: f64| {
            self.wrong.push(format!(
                "{what}: {own}; {} {:?} axes {} {} s, {} W, {} W back, {} J, {}",
                row.line,
                row.kind,
                row.axes,
                row.duration_s,
                row.peak_w,
                row.regen_w,
                row.energy_j,
                row.converter
            ));
        };
        let later_s = row.duration_s - full.duration_s;
        // Its times are those of these overrides.
        let late = later_s < -share * full.duration_s || later_s > later * full.duration_s;
        if late && !only {
            differs("duration", full.duration_s);
        }
        let named = plant
            .converters
            .iter()
            .position(|it| it.name == row.converter);
        let which = named.unwrap();
        let (peak_w, regen_w) = (most.peak_w[which], most.regen_w[which]);
        let slack_w = share * (peak_w.abs() + regen_w) + 1e-6;
        // Of several converters a row has the figures of the override at which one of
        // them is loaded most.
        let loaded = |drawn_w: f64, fed_w: f64| {
            let own = &plant.converters[which];
            (drawn_w / own.limit_w).max(fed_w / own.regen_limit_w)
        };
        let covered = loaded(row.peak_w, row.regen_w) >= loaded(peak_w, regen_w) - CLOSED;
        let several = plant.converters.len() > 1 && !only;
        if row.peak_w < peak_w - slack_w && !(several && covered) {
            differs("peak too low", peak_w);
        }
        if row.regen_w < regen_w - slack_w && !(several && covered) {
            differs("fed back too low", regen_w);
        }
        // The converter that is named is the one that is loaded most.
        let ratio = |peak_w: f64, regen_w: f64, which: usize| {
            let converter = &plant.converters[which];
            (peak_w / converter.limit_w).max(regen_w / converter.regen_limit_w)
        };
        let shown = ratio(row.peak_w, row.regen_w, which);
        for other in 0..plant.converters.len() {
            let own = ratio(most.peak_w[other], most.regen_w[other], other);
            if own > shown + SAMPLED * own.abs() + 1e-9 {
                differs("another converter is loaded more", own);
            }
        }
        let scale_j = full.duration_s * (peak_w.abs() + regen_w);
        // The spindle's drive may count while it is switched off.
        let drives = plant
            .spindle
            .as_ref()
            .is_some_and(|spindle| spindle.base_w > 0.0);
        let apart_j = row.energy_j - full.energy_j;
        let slack_j = ENERGY.max(2.0 * later) * scale_j + 1e-6;
        if !only && (apart_j < -slack_j || apart_j > slack_j && !drives) {
            differs("energy", full.energy_j);
        }
        // Of several converters the one that the spindle relieves keeps its larger
        // power: whether another one is loaded more then is not known.
        let relieved = plant.spindle.is_some() && plant.converters.len() > 1;
        // Where an axis may be later than planned, when axes meet is bounded too; what one
        // gives another may come at another time then.
        let meet = plant.independent && curved || plant.converters.iter().any(|own| own.credit);
        if only && !relieved && !drives && !meet {
            let loose_w = LOOSE.max(2.0 * later) * (peak_w.abs() + regen_w) + 1e-3;
            if row.peak_w > peak_w + loose_w {
                differs("peak too high", peak_w);
            }
            if row.regen_w > regen_w + loose_w {
                differs("fed back too high", regen_w);
            }
        }
    }
}
