//! Where a program lies in a log: when it begins, and when it ends.
//!
//! The correlation of both curves (Pearson's, over the whole log, with the program's power at
//! rest before and after it) is largest where they lie over each other; it asks neither for the
//! scale of the meter nor for its zero. First both are averaged over a thousandth of the log,
//! and all shifts are tried at once (cross-correlation by FFT) for paces so close that the end
//! moves by one such window from one to the next. The best of them are then followed from
//! window to half the window, down to the samples of the log: narrow peaks of power would hide
//! the way there.

use realfft::RealFftPlanner;

use super::curve::Curve;
use super::trace::PowerTrace;

/// Windows of the log in the first search.
const WINDOWS: usize = 1024;
/// Paces that are looked at: the time that the program takes by the time that is planned.
const PACES: [f64; 2] = [0.5, 4.0];
/// Share of the program that must lie in the log.
const INSIDE: f64 = 0.5;
/// Places that are followed to the end.
const FOLLOWED: usize = 6;
/// Steps at a width of windows, at most.
const STEPS: usize = 40;
/// Correlation below which both have nothing in common.
const LEAST: f64 = 0.1;
/// The last windows, as a share of the time between two samples.
const FINEST: f64 = 1.0 / 32.0;

/// When a program begins and ends in a log, s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Place {
    pub(super) start_s: f64,
    pub(super) end_s: f64,
    pub(super) correlation: f64,
}

impl Place {
    /// The time that the program takes by the time that is planned.
    pub(super) fn pace(&self, curve: &Curve) -> f64 {
        (self.end_s - self.start_s) / curve.duration_s()
    }
}

/// The log in windows of one width.
struct Windows<'a> {
    curve: &'a Curve,
    /// Where the windows begin and end.
    edges_s: Vec<f64>,
    /// The log's means less the mean of all.
    means_w: Vec<f64>,
    /// The sum of their squares.
    square: f64,
}

impl<'a> Windows<'a> {
    fn new(curve: &'a Curve, log: &PowerTrace, count: usize) -> Self {
        let from = log.time_s.first().copied().unwrap_or_default();
        let to = log.time_s.last().copied().unwrap_or_default();
        let width = (to - from) / count as f64;
        let edges_s: Vec<f64> = (0..=count).map(|k| from + k as f64 * width).collect();
        let mut reader = Energy::new(log);
        let energies: Vec<f64> = edges_s.iter().map(|t| reader.at(*t)).collect();
        let pairs = energies.iter().zip(energies.iter().skip(1));
        let mut means_w: Vec<f64> = pairs.map(|(a, b)| (b - a) / width).collect();
        let mean = means_w.iter().sum::<f64>() / count as f64;
        for it in &mut means_w {
            *it -= mean;
        }
        let square = means_w.iter().map(|it| it * it).sum();
        Self {
            curve,
            edges_s,
            means_w,
            square,
        }
    }

    fn width_s(&self) -> f64 {
        match self.edges_s.as_slice() {
            [a, b, ..] => b - a,
            _ => 0.0,
        }
    }

    /// The correlation with the program between two times.
    fn correlation(&self, start_s: f64, end_s: f64) -> f64 {
        let pace = (end_s - start_s) / self.curve.duration_s();
        let first = self.edges_s.first().copied().unwrap_or_default();
        let last = self.edges_s.last().copied().unwrap_or_default();
        let inside = end_s.min(last) - start_s.max(first);
        if !(PACES[0]..=PACES[1]).contains(&pace) || inside < INSIDE * (end_s - start_s) {
            return -1.0;
        }
        let mut reader = self.curve.reader();
        let scale = pace / self.width_s();
        let mut before = None;
        let (mut sum, mut square, mut product) = (0.0, 0.0, 0.0);
        for (k, edge) in self.edges_s.iter().enumerate() {
            let energy_j = reader.energy_j((edge - start_s) / pace);
            if let Some(last) = before.replace(energy_j) {
                let mean = (energy_j - last) * scale - self.curve.rest_w();
                let own = k.checked_sub(1).and_then(|k| self.means_w.get(k));
                sum += mean;
                square += mean * mean;
                product += mean * own.copied().unwrap_or_default();
            }
        }
        correlation(
            product,
            square - sum * sum / self.means_w.len() as f64,
            self.square,
        )
    }

    /// Goes from a place to better ones near it, by steps of `step_s` and less.
    fn climb(&self, place: Place, step_s: f64) -> Place {
        let mut best = Place {
            correlation: self.correlation(place.start_s, place.end_s),
            ..place
        };
        let mut step = step_s;
        for _ in 0..STEPS {
            let ways = [
                (1.0, 1.0),
                (-1.0, -1.0),
                (1.0, 0.0),
                (-1.0, 0.0),
                (0.0, 1.0),
                (0.0, -1.0),
            ];
            let near = ways.map(|(a, b)| {
                let (start_s, end_s) = (best.start_s + a * step, best.end_s + b * step);
                Place {
                    start_s,
                    end_s,
                    correlation: self.correlation(start_s, end_s),
                }
            });
            match better(near.into_iter()) {
                Some(near) if near.correlation > best.correlation => best = near,
                _ if step > step_s / 4.0 => step /= 2.0,
                _ => break,
            }
        }
        best
    }
}

fn correlation(product: f64, square: f64, other: f64) -> f64 {
    let both = square * other;
    if both > 0.0 {
        product / both.sqrt()
    } else {
        -1.0
    }
}

/// The one with the largest correlation; the first of equals.
fn better(places: impl Iterator<Item = Place>) -> Option<Place> {
    places.reduce(|best, it| {
        if it.correlation > best.correlation {
            it
        } else {
            best
        }
    })
}

/// The energy of a log up to times that ascend.
struct Energy<'a> {
    log: &'a PowerTrace,
    at: usize,
    sum_j: f64,
}

impl<'a> Energy<'a> {
    fn new(log: &'a PowerTrace) -> Self {
        Self {
            log,
            at: 0,
            sum_j: 0.0,
        }
    }

    fn at(&mut self, time_s: f64) -> f64 {
        let sample = |k: usize| Some((*self.log.time_s.get(k)?, *self.log.power_w.get(k)?));
        loop {
            let (Some((t, w)), Some((next_t, next_w))) = (sample(self.at), sample(self.at + 1))
            else {
                return self.sum_j;
            };
            if next_t > time_s {
                let since = (time_s - t).max(0.0);
                let slope = (next_w - w) / (next_t - t);
                return self.sum_j + since * (w + slope * since / 2.0);
            }
            self.sum_j += (next_t - t) * (w + next_w) / 2.0;
            self.at += 1;
        }
    }
}

/// Finds the program in the log; `None` where nothing of both goes up and down together.
pub(super) fn align(curve: &Curve, log: &PowerTrace) -> Option<Place> {
    let count = WINDOWS.min(log.time_s.len() / 2).max(2);
    let windows = Windows::new(curve, log, count);
    let mut places = all_shifts(&windows);
    let step_s = log.step_s().max(1e-6);
    let mut count = count;
    let mut width_s = windows.width_s();
    let mut windows = windows;
    loop {
        let climbed = places.iter().map(|place| windows.climb(*place, width_s));
        places = climbed.collect();
        places.sort_by(|a, b| b.correlation.total_cmp(&a.correlation));
        places.dedup_by(|a, b| {
            (a.start_s - b.start_s).abs() < width_s / 2.0
                && (a.end_s - b.end_s).abs() < width_s / 2.0
        });
        // Samples may be as good as all at one end of the log.
        if width_s <= step_s || count >= 2 * log.time_s.len() {
            break;
        }
        count *= 2;
        windows = Windows::new(curve, log, count);
        width_s = windows.width_s();
        // The wider the windows, the more may still change.
        places.truncate(FOLLOWED.min(places.len()).max(1));
    }
    let mut best = *places.first()?;
    let mut step = width_s / 2.0;
    while step > step_s * FINEST {
        best = windows.climb(best, step);
        step /= 4.0;
    }
    (best.correlation > LEAST).then_some(best)
}

/// The best shift of each pace in wide windows, the best paces first.
fn all_shifts(windows: &Windows<'_>) -> Vec<Place> {
    let curve = windows.curve;
    let (duration_s, width_s) = (curve.duration_s(), windows.width_s());
    let count = windows.means_w.len();
    let log_s = width_s * count as f64;
    let slowest = PACES[1].min(log_s / INSIDE / duration_s);
    let most = libm::ceil(duration_s * slowest / width_s) as usize + 1;
    let size = (count + most).next_power_of_two();
    let mut planner = RealFftPlanner::<f64>::new();
    let (forward, back) = (
        planner.plan_fft_forward(size),
        planner.plan_fft_inverse(size),
    );
    let mut padded = windows.means_w.clone();
    padded.resize(size, 0.0);
    let mut spectrum = forward.make_output_vec();
    if forward.process(&mut padded, &mut spectrum).is_err() {
        return Vec::new();
    }
    let (mut own, mut correlated) = (forward.make_output_vec(), back.make_output_vec());
    let from = windows.edges_s.first().copied().unwrap_or_default();
    let mut found: Vec<Place> = Vec::new();
    let mut pace = PACES[0];
    while pace <= slowest {
        let length = (libm::ceil(duration_s * pace / width_s) as usize).clamp(1, most);
        let mut reader = curve.reader();
        let edges = (0..=length).map(|k| reader.energy_j(k as f64 * width_s / pace));
        let energies: Vec<f64> = edges.collect();
        let pairs = energies.iter().zip(energies.iter().skip(1));
        let means: Vec<f64> = pairs
            .map(|(a, b)| (b - a) * pace / width_s - curve.rest_w())
            .collect();
        let mut padded = means.clone();
        padded.resize(size, 0.0);
        if forward.process(&mut padded, &mut own).is_err() {
            break;
        }
        for (own, log) in own.iter_mut().zip(&spectrum) {
            *own = own.conj() * log;
        }
        if back.process(&mut own, &mut correlated).is_err() {
            break;
        }
        // The first shift has half of the program before the log.
        let half = length / 2;
        let best = (0..count).map(|shift| {
            let at = (size + shift - half) % size;
            let product = correlated.get(at).copied().unwrap_or_default() / size as f64;
            let from_s = from + (shift as f64 - half as f64) * width_s;
            let inside = means.get(half.saturating_sub(shift)..);
            let inside =
                inside.and_then(|it| it.get(..it.len().min(count - shift.saturating_sub(half))));
            Place {
                start_s: from_s,
                end_s: from_s + duration_s * pace,
                correlation: correlation(
                    product,
                    variance(inside.unwrap_or_default(), count),
                    windows.square,
                ),
            }
        });
        found.extend(better(best));
        pace += width_s / duration_s;
    }
    found.sort_by(|a, b| b.correlation.total_cmp(&a.correlation));
    found.truncate(2 * FOLLOWED);
    found
}

/// Variance, times so many windows, of those in which the program runs; it is 0 in the others.
fn variance(means: &[f64], count: usize) -> f64 {
    let (sum, square) = means
        .iter()
        .fold((0.0, 0.0), |(sum, square), it| (sum + it, square + it * it));
    square - sum * sum / count as f64
}

#[cfg(test)]
mod tests {
    use super::super::{Agreement, overlay};
    use super::*;

    /// Noise that is the same each time, between -1 and 1.
    fn noise(seed: &mut u64) -> f64 {
        *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (*seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// Ramps of 60 to 400 ms up to 0.5 to 4 kW and down, with pauses, of blocks from 1 on.
    fn program(seed: u64, blocks: u64) -> Curve {
        let mut seed = seed;
        let mut curve = Curve::new(150.0);
        let mut t = 0.0;
        curve.push(t, 150.0, 1);
        for block in 1..=blocks {
            let ramp = 0.23 + 0.17 * noise(&mut seed);
            let peak_w = 2250.0 + 1750.0 * noise(&mut seed);
            let pause = 0.5 + 0.49 * noise(&mut seed);
            for (length, w) in [
                (0.0, 150.0),
                (ramp, peak_w),
                (0.0, 300.0),
                (pause, 300.0),
                (0.0, 150.0),
            ] {
                t += length;
                curve.push(t, w, block);
            }
        }
        curve
    }

    /// What a meter records that averages over so many samples.
    fn log(
        curve: &Curve,
        step_s: f64,
        (start_s, pace, gain): (f64, f64, f64),
        average: f64,
    ) -> PowerTrace {
        let mut seed = 7;
        let end = start_s + pace * curve.duration_s() + 3.0;
        let width = average * step_s;
        let mut log = PowerTrace::default();
        let (mut from, mut to) = (curve.reader(), curve.reader());
        let mut k = 0.0;
        while k * step_s < end {
            let t = k * step_s;
            let at = |t: f64| (t - start_s) / pace;
            let mean = (to.energy_j(at(t)) - from.energy_j(at(t - width))) * pace / width;
            log.time_s.push(100.0 + t);
            log.power_w.push(gain * mean + 20.0 * noise(&mut seed));
            k += 1.0;
        }
        log
    }

    #[test]
    fn shift_and_pace_are_found() {
        for (seed, blocks, step_s, place) in [
            (1, 12, 0.004, (2.1, 1.0, 1.0)),
            (2, 40, 0.01, (0.0, 1.31, 1.0)),
            (3, 200, 0.02, (11.3, 0.87, 1.1)),
            (4, 900, 0.05, (40.0, 2.2, 0.9)),
        ] {
            let curve = program(seed, blocks);
            let log = log(&curve, step_s, place, 1.0);
            let found = overlay(&curve, &[], &log).unwrap();
            let (start_s, pace, gain) = place;
            assert_eq!(
                found.agreement(),
                Agreement::Good,
                "{seed}: {}",
                found.correlation
            );
            assert!(
                (found.start_s - 100.0 - start_s).abs() < 2.0 * step_s,
                "{seed}: {}",
                found.start_s
            );
            assert!(
                (found.pace / pace - 1.0).abs() < 1e-3,
                "{seed}: {}",
                found.pace
            );
            assert!(
                (found.gain / gain - 1.0).abs() < 0.01,
                "{seed}: {}",
                found.gain
            );
        }
    }

    /// A meter that averages over 20 samples shows less of short peaks: so does the prediction
    /// that it is compared with.
    #[test]
    fn what_the_meter_averages_over_is_found() {
        let curve = program(5, 60);
        let log = log(&curve, 0.005, (1.0, 1.0, 1.2), 20.0);
        let found = overlay(&curve, &[], &log).unwrap();
        assert!(
            (found.averaging_s - 0.1).abs() < 1e-4,
            "{}",
            found.averaging_s
        );
        assert!((found.gain - 1.2).abs() < 0.01, "{}", found.gain);
        assert!((found.factor.seen - 1.2).abs() < 0.05, "{:?}", found.factor);
        assert!(
            (found.margin() - (1.0 - 1.0 / 1.2)).abs() < 0.02,
            "{}",
            found.margin()
        );
        assert!(found.margin_of_others() >= found.margin());
    }

    /// One block draws 30 % more than predicted.
    #[test]
    fn the_block_that_exceeds_is_named() {
        let curve = program(6, 30);
        let mut log = log(&curve, 0.002, (0.5, 1.0, 1.0), 1.0);
        let (_, from, to) = curve.blocks()[16];
        for (t, w) in log.time_s.iter().zip(&mut log.power_w) {
            if (from..to).contains(&(t - 100.5)) {
                *w *= 1.3;
            }
        }
        let found = overlay(&curve, &[], &log).unwrap();
        let worst = found.blocks.iter().max_by(|a, b| {
            let excess = |it: &super::super::BlockPeaks| it.measured_w - it.predicted_w;
            excess(a).total_cmp(&excess(b))
        });
        let worst = worst.unwrap();
        assert_eq!((worst.block, worst.runs), (17, 1));
        assert!(
            (worst.measured_by_predicted() - 1.3).abs() < 0.05,
            "{worst:?}"
        );
    }

    /// After dense samples one that is a year later: windows are not as narrow as their steps.
    #[test]
    fn samples_may_lie_unevenly() {
        let curve = program(10, 12);
        let mut log = log(&curve, 0.01, (1.0, 1.0, 1.0), 1.0);
        log.time_s.push(3e7);
        log.power_w.push(150.0);
        // Nothing of a few seconds can be seen in windows of hours.
        assert!(overlay(&curve, &[], &log).is_err());
    }

    #[test]
    fn another_program_or_unit_is_not_good() {
        for gain in [1e-3, 1e3] {
            let mut log = log(&program(8, 40), 0.002, (1.0, 1.0, 1.0), 1.0);
            log.power_w.iter_mut().for_each(|it| *it *= gain);
            let found = overlay(&program(8, 40), &[], &log);
            assert_eq!(found.unwrap().agreement(), Agreement::AnotherUnit);
        }
        let log = log(&program(8, 40), 0.01, (1.0, 1.0, 1.0), 1.0);
        let found = overlay(&program(9, 40), &[], &log).unwrap();
        assert_eq!(
            found.agreement(),
            Agreement::AnotherProgram,
            "{}",
            found.correlation
        );
        let empty = overlay(&Curve::new(0.0), &[], &log).unwrap_err();
        assert_eq!(empty.message, "the program takes no time");
        let flat = PowerTrace {
            power_w: vec![200.0; log.time_s.len()],
            ..log
        };
        let found = overlay(&program(9, 40), &[], &flat).unwrap_err();
        assert_eq!(
            found.message,
            "the log does not go up and down as the program would"
        );
    }
}
