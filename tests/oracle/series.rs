//! Reads a series over time and works it out again: speeds follow from
//! accelerations, forces from both, powers from speeds and forces, what a
//! converter sees from powers; no acceleration and no jerk is above its limit, and
//! no instant draws more than the report says of its line.

use std::collections::HashMap;
use std::io;

use gwatt::pipeline::{Row, SeriesSink};
use gwatt::power::{AxisInstant, Instant};

use super::electrical::{AxisState, SpindleLoad};
use super::plant::{Axis, LETTERS, Plant};

/// Rounding of figures that follow from each other at once.
const ROUNDING: f64 = 1e-6;
/// Differences that are kept.
const KEPT: usize = 5;

/// What a controller's own rules permit beyond the limits of axes.
#[derive(Debug, Clone, Copy)]
pub struct Rules {
    /// How far accelerations may exceed an axis' own, as a factor.
    pub accel: f64,
    /// Share of the change of a speed by which chords of time may miss a curve.
    pub chord: f64,
    /// The time in which an axis makes a small step of speed at a corner, s.
    pub kink_s: f64,
    /// Whether axes step in speed at corners.
    pub steps: bool,
    /// Whether corners and blends ask for more than the jerk of an axis.
    pub blends: bool,
}

/// Takes the rows of a series.
pub struct Watch<'p> {
    plant: &'p Plant,
    rules: Rules,
    last: Option<(f64, u64, Instant)>,
    /// Largest power drawn and fed back as shown, by converter.
    pub peaks_w: Vec<[f64; 2]>,
    /// The same with servo factors, by line and converter.
    by_line: HashMap<(u64, usize), [f64; 2]>,
    pub energy_j: f64,
    pub rows: u64,
    pub wrong: Vec<String>,
}

/// The sign of a motion.
fn sign(own: &AxisInstant) -> f64 {
    if own.velocity_mm_s == 0.0 {
        0.0
    } else {
        own.velocity_mm_s.signum()
    }
}

fn near(a: f64, b: f64, scale: f64) -> bool {
    (a - b).abs() <= ROUNDING * (a.abs() + b.abs() + scale)
}

impl<'p> Watch<'p> {
    pub fn new(plant: &'p Plant, rules: Rules) -> Self {
        Self {
            plant,
            rules,
            last: None,
            peaks_w: vec![[0.0; 2]; plant.converters.len()],
            by_line: HashMap::new(),
            energy_j: 0.0,
            rows: 0,
            wrong: Vec::new(),
        }
    }

    /// How long the series lasts.
    pub fn duration_s(&self) -> f64 {
        self.last.as_ref().map_or(0.0, |last| last.0)
    }

    fn differs(&mut self, what: &str, time_s: f64, line: u64, values: &[f64]) {
        if self.wrong.len() < KEPT {
            self.wrong
                .push(format!("{what} in line {line} at {time_s} s: {values:?}"));
        }
    }

    /// Force and power of an axis.
    fn forces(&mut self, axis: &Axis, time_s: f64, line: u64, own: &AxisInstant) {
        let state = |sign: f64| AxisState {
            v: own.velocity_mm_s,
            a: own.accel_mm_s2,
            sign,
        };
        let force = |sign: f64| axis.force(state(sign), [1.0; 2]);
        let scale = axis.mass * axis.accel * axis.unit + axis.gravity.abs();
        let v = own.velocity_mm_s;
        let signs: &[f64] = if v == 0.0 {
            &[-1.0, 0.0, 1.0]
        } else {
            &[v.signum()]
        };
        // Where it comes to rest, rounding leaves it a speed.
        let stands = v.abs() < 1e-7 * axis.speed;
        if !signs
            .iter()
            .any(|sign| near(own.force_n, force(*sign), scale))
            && !stands
        {
            self.differs("force", time_s, line, &[own.force_n, force(sign(own))]);
        }
        let power_w = axis.electrical_w(v, own.force_n);
        if !near(own.power_w, power_w, 1e-3) {
            self.differs("power of an axis", time_s, line, &[own.power_w, power_w]);
        }
        let most = axis.accel * self.rules.accel;
        if own.accel_mm_s2.abs() > most * (1.0 + ROUNDING) {
            self.differs("acceleration", time_s, line, &[own.accel_mm_s2, most]);
        }
        let limit = axis.force_n(v.abs());
        if own.force_n.abs() > limit * (1.0 + 1e-3) {
            self.differs("force of the drive", time_s, line, &[own.force_n, limit]);
        }
    }

    /// What converters see: the sum of all, and one of the loads' combinations.
    fn buses(&mut self, time_s: f64, line: u64, now: &Instant) {
        let plant = self.plant;
        let mut states = [AxisState::default(); LETTERS.len()];
        for (state, own) in states.iter_mut().zip(&now.axes) {
            *state = AxisState {
                v: own.velocity_mm_s,
                a: own.accel_mm_s2,
                sign: sign(own),
            };
        }
        // Whether an axis speeds up or comes to rest cannot be seen of one instant, and
        // with limits of jerk not even whether it moves.
        let known = now
            .axes
            .iter()
            .all(|own| own.velocity_mm_s != 0.0 || own.accel_mm_s2 == 0.0);
        let soft = plant.axes.iter().any(|axis| axis.jerk < f64::INFINITY);
        let known = known && !(soft && now.axes.iter().all(|own| own.velocity_mm_s == 0.0));
        let spindle = plant.spindle.as_ref().map(|spindle| spindle.converter);
        for (which, converter) in plant.converters.iter().enumerate() {
            let own = |axis: &&Axis| converter.axes.contains(&axis.index);
            let powers = plant
                .axes
                .iter()
                .filter(own)
                .map(|axis| now.axes[axis.index].power_w);
            let beside_w = if spindle == Some(which) {
                now.spindle.power_w + now.spindle.cutting_w
            } else {
                0.0
            };
            let powers: Vec<f64> = powers.collect();
            // Of a drive that is switched off nothing is certain: what it draws without
            // motion may stand apart from what it feeds back.
            let base_w = plant.spindle.as_ref().filter(|_| spindle == Some(which));
            let base_w = base_w.map_or(0.0, |spindle| spindle.base_w);
            let flows = |apart_w: f64| {
                let (mut drawn_w, mut fed_w) = (converter.base_w + apart_w, 0.0);
                for power_w in powers.iter().chain([&(beside_w - apart_w)]) {
                    drawn_w += power_w.max(0.0);
                    fed_w += (-power_w).max(0.0);
                }
                (drawn_w, fed_w)
            };
            let shown_w = now.bus_w[which];
            let load_w = |mask: u32| {
                let loads = plant.loads.iter().enumerate();
                let on = loads.filter(|(bit, load)| mask & (1 << bit) != 0 && load.1 == which);
                on.map(|(_, load)| load.0).sum::<f64>()
            };
            let sum = |(drawn_w, fed_w): (f64, f64), mask: u32| {
                let credit = if converter.credit { fed_w } else { 0.0 };
                drawn_w + load_w(mask) - credit
            };
            let together = flows(0.0);
            let scale = together.0 + together.1 + 1e-3;
            let masks = 0..1_u32 << plant.loads.len();
            let ways = masks.flat_map(|mask| [(together, mask), (flows(base_w), mask)]);
            let Some((flow, mask)) =
                { ways }.find(|(flow, mask)| near(shown_w, sum(*flow, *mask), scale))
            else {
                self.differs(
                    "bus power",
                    time_s,
                    line,
                    &[shown_w, together.0, together.1],
                );
                continue;
            };
            let (expected_w, uncertain_w) = if converter.credit {
                let drawn_w = sum(flow, mask);
                ((-drawn_w).max(0.0), (base_w - drawn_w).max(0.0))
            } else {
                (flow.1, flow.1)
            };
            let shown_w = now.regen_w[which];
            if !(near(shown_w, expected_w, scale) || near(shown_w, uncertain_w, scale)) {
                self.differs(
                    "power fed back",
                    time_s,
                    line,
                    &[now.regen_w[which], expected_w],
                );
            }
            self.peaks_w[which][0] = self.peaks_w[which][0].max(now.bus_w[which]);
            self.peaks_w[which][1] = self.peaks_w[which][1].max(now.regen_w[which]);
            let load = SpindleLoad {
                power_w: beside_w,
                idle_w: 0.0,
            };
            if !known {
                continue;
            }
            let bus = plant.bus(which, &states, mask, load);
            let peaks = self
                .by_line
                .entry((line, which))
                .or_insert([f64::NEG_INFINITY; 2]);
            peaks[0] = peaks[0].max(bus.drawn_w);
            peaks[1] = peaks[1].max(bus.fed_w);
        }
    }

    /// Speeds from one row to the next.
    fn motion(&mut self, time_s: f64, line: u64, now: &Instant) {
        let Some((last_s, last_line, last)) = self.last.take() else {
            return;
        };
        let dt = time_s - last_s;
        for axis in &self.plant.axes {
            let (from, to) = (&last.axes[axis.index], &now.axes[axis.index]);
            let mean = 0.5 * (from.accel_mm_s2 + to.accel_mm_s2);
            let change = to.velocity_mm_s - from.velocity_mm_s - mean * dt;
            let slack =
                self.rules.chord * axis.accel * self.rules.accel * dt + ROUNDING * axis.speed;
            let joint = line != last_line || dt == 0.0;
            let kink = if joint {
                axis.accel * self.rules.kink_s
            } else {
                0.0
            };
            if change.abs() > slack + kink && !(self.rules.steps && joint) {
                let values = [from.velocity_mm_s, to.velocity_mm_s, mean, dt];
                self.differs("a step of speed", time_s, line, &values);
            }
            let jump = (to.accel_mm_s2 - from.accel_mm_s2).abs();
            let most = axis.jerk * dt * (1.0 + self.rules.chord) + 1e-3 * axis.accel;
            if jump > most && !self.rules.blends {
                let values = [from.accel_mm_s2, to.accel_mm_s2, dt];
                self.differs("jerk", time_s, line, &values);
            }
        }
        for which in 0..self.plant.converters.len() {
            self.energy_j += 0.5 * dt * (last.bus_w[which] + now.bus_w[which]);
        }
    }

    /// Compares what was seen with the rows of a report.
    pub fn compare(&mut self, rows: &[Row]) {
        let mut output: HashMap<(u64, usize), [f64; 2]> = HashMap::new();
        for row in rows {
            let named = self
                .plant
                .converters
                .iter()
                .position(|it| it.name == row.converter);
            let peaks = output
                .entry((row.line, named.unwrap()))
                .or_insert([row.peak_w, row.regen_w]);
            *peaks = [peaks[0].max(row.peak_w), peaks[1].max(row.regen_w)];
        }
        let mut low = Vec::new();
        for (at, own) in &self.by_line {
            let Some(output) = output.get(at) else {
                continue;
            };
            let slack_w = ROUNDING * (own[0].abs() + own[1]) + 1e-6;
            let low_by = [own[0] - output[0], own[1] - output[1]];
            let converter = &self.plant.converters[at.1];
            let limits = [converter.limit_w, converter.regen_limit_w];
            // Of several converters a row has the figures of its worst moment.
            let ratio = |[drawn_w, fed_w]: [f64; 2]| (drawn_w / limits[0]).max(fed_w / limits[1]);
            let several = self.plant.converters.len() > 1;
            if several && ratio(*own) <= ratio(*output) * (1.0 + ROUNDING) + 1e-9 {
                continue;
            }
            if low_by.into_iter().any(|low_w| low_w > slack_w) {
                low.push((at.0, *own, *output));
            }
        }
        low.sort_by_key(|found| found.0);
        for (line, own, output) in low {
            self.differs(
                "read too low",
                0.0,
                line,
                &[own[0], output[0], own[1], output[1]],
            );
        }
    }
}

impl SeriesSink for Watch<'_> {
    fn row(&mut self, time_s: f64, line: u64, now: &Instant) -> io::Result<()> {
        self.rows += 1;
        if !now.unknown_axes.is_empty() {
            // Bounds, with which nothing adds up.
            self.last = None;
            return Ok(());
        }
        for axis in &self.plant.axes {
            self.forces(axis, time_s, line, &now.axes[axis.index]);
        }
        self.buses(time_s, line, now);
        self.motion(time_s, line, now);
        self.last = Some((time_s, line, now.clone()));
        Ok(())
    }
}
