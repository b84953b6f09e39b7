//! Periods in position: the spectrum of what is left over the place where it was left.

use std::cmp::Ordering;
use std::f64::consts::TAU;

use realfft::RealFftPlanner;
use realfft::num_complex::Complex;

/// Periods that the motion goes through at least: fewer are a slope or a bend.
const PERIODS_MIN: f64 = 3.0;
/// Places of a recording, at least and at most.
const PLACES: [usize; 2] = [1 << 10, 1 << 19];
/// Spectra are this many times finer than the range distinguishes.
const FINER: usize = 4;
/// A period has this many places at least.
const PLACES_A_PERIOD: usize = 4;
/// Lines that are looked at more closely.
const LINES: usize = 6;
/// A line stands out where it has so many times the power of the places next to it: from
/// two widths of a line up to twelve away.
const STANDS_OUT: f64 = 6.0;
const NEXT_TO_IT: [usize; 2] = [2, 12];

/// What a model leaves at the places of a motion.
pub struct Left {
    /// N (N·m).
    pub residual: Vec<f64>,
    /// m (rad).
    pub position: Vec<f64>,
    /// m/s (rad/s).
    pub speed: Vec<f64>,
}

/// Periods per m (rad) of the lines that stand out most, by their power, once with all
/// samples alike and once with all places alike.
pub fn lines(recordings: &[Left]) -> Vec<f64> {
    let ranges = recordings.iter().map(|left| ends(&left.position));
    let range = ranges.fold(0.0, |most: f64, (low, high)| most.max(high - low));
    let samples: usize = recordings.iter().map(|left| left.residual.len()).sum();
    if !(range > 0.0 && range.is_finite()) || samples < PLACES_A_PERIOD {
        return Vec::new();
    }
    let [least, most] = PLACES;
    let places = samples.saturating_mul(4).next_power_of_two();
    let places = places.clamp(least, most);
    let mut found = Vec::new();
    for by_place in [false, true] {
        let power = spectrum(recordings, range, places, by_place);
        for line in highest(&power) {
            let per_unit = line as f64 / (FINER as f64 * range);
            if !found.contains(&per_unit) {
                found.push(per_unit);
            }
        }
    }
    found
}

fn ends(x: &[f64]) -> (f64, f64) {
    x.iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
            (low.min(*x), high.max(*x))
        })
}

/// The power at each multiple of 1/(4·range), summed over the recordings, up to the shortest
/// period that the places show. That is a small part of the spectrum of all places and the
/// empty ones after them: it is put together from the spectra of every so manyth place, each
/// as short as that part.
fn spectrum(recordings: &[Left], range: f64, places: usize, by_place: bool) -> Vec<f64> {
    let parts = FINER * PLACES_A_PERIOD;
    let length = places / PLACES_A_PERIOD;
    let fft = RealFftPlanner::<f64>::new().plan_fft_forward(length);
    let mut scratch = fft.make_scratch_vec();
    let mut half = fft.make_output_vec();
    let turn = |k: usize| {
        let (sin, cos) = libm::sincos(-TAU * k as f64 / (parts * length) as f64);
        Complex::new(cos, sin)
    };
    let turns: Vec<Complex<f64>> = (0..length).map(turn).collect();
    let mut power = vec![0.0; length];
    for left in recordings {
        let sums = over_places(left, range, places, by_place);
        let mut lines = vec![Complex::<f64>::default(); length];
        for first in (0..parts).rev() {
            let mut part: Vec<f64> = sums.iter().skip(first).step_by(parts).copied().collect();
            part.resize(length, 0.0);
            // The lengths are those of the plan.
            if fft
                .process_with_scratch(&mut part, &mut half, &mut scratch)
                .is_err()
            {
                return Vec::new();
            }
            let mirrored = half.iter().skip(1).rev().skip(1).map(Complex::conj);
            let whole = half.iter().copied().chain(mirrored);
            for ((line, turn), value) in lines.iter_mut().zip(&turns).zip(whole) {
                *line = *line * turn + value;
            }
        }
        for (slot, line) in power.iter_mut().zip(&lines) {
            *slot += Complex::norm_sqr(line);
        }
    }
    power
}

/// What is left, summed up by places; with all samples alike, or all places.
fn over_places(left: &Left, range: f64, places: usize, by_place: bool) -> Vec<f64> {
    let mut sums = vec![0.0; places];
    let (low, _) = ends(&left.position);
    for ((residual, x), v) in left.residual.iter().zip(&left.position).zip(&left.speed) {
        let place = ((x - low) / range * places as f64) as usize;
        let weight = if by_place { v.abs() } else { 1.0 };
        if let Some(slot) = sums.get_mut(place.min(places - 1)) {
            *slot += weight * residual;
        }
    }
    sums
}

/// The highest lines that stand out, as their index.
fn highest(power: &[f64]) -> Vec<usize> {
    let first = libm::ceil(PERIODS_MIN * FINER as f64) as usize;
    let at = |k: usize| power.get(k).copied().unwrap_or_default();
    let is_top = |k: &usize| at(*k) > at(*k - 1) && at(*k) >= at(*k + 1);
    let mut tops: Vec<usize> = (first..power.len()).filter(is_top).collect();
    tops.sort_by(|a, b| at(*b).partial_cmp(&at(*a)).unwrap_or(Ordering::Equal));
    tops.truncate(LINES);
    let [near, far] = NEXT_TO_IT.map(|widths| widths * FINER);
    let stands_out = |k: &usize| {
        let below = power.get(k.saturating_sub(far)..k.saturating_sub(near));
        let above = power.get(k + near..(k + far).min(power.len()));
        let around = [below, above].into_iter().flatten().flatten();
        let (sum, count) = around.fold((0.0, 0.0), |(sum, n), x| (sum + x, n + 1.0));
        at(*k) * count > STANDS_OUT * sum
    };
    tops.retain(stands_out);
    tops
}

/// The largest share of a signal that one sine of the time explains.
pub fn periodic_in_time(x: &[f64]) -> f64 {
    let length = (2 * x.len()).next_power_of_two();
    let fft = RealFftPlanner::<f64>::new().plan_fft_forward(length.max(2));
    let mut padded = x.to_vec();
    padded.resize(length.max(2), 0.0);
    let mut spectrum = fft.make_output_vec();
    if fft.process(&mut padded, &mut spectrum).is_err() {
        return 0.0;
    }
    let most = spectrum.iter().map(Complex::norm_sqr).fold(0.0, f64::max);
    let all: f64 = x.iter().map(|x| x * x).sum();
    let share = 2.0 * most / (x.len() as f64 * all);
    if share.is_finite() { share } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A force of 7 periods per metre over a motion to and fro: not periodic in time.
    #[test]
    fn a_period_is_found_over_the_place() {
        let position: Vec<f64> = (0..4000)
            .map(|k| libm::sin(0.004 * f64::from(k)) + 0.3 * libm::sin(0.0091 * f64::from(k)))
            .collect();
        let residual: Vec<f64> = position.iter().map(|x| libm::sin(44.0 * x + 1.0)).collect();
        let share = periodic_in_time(&residual);
        assert!(share < 0.2, "{share}");
        let left = Left {
            residual,
            speed: vec![1.0; position.len()],
            position,
        };
        let found = lines(&[left]);
        let off = found
            .iter()
            .map(|found| (found - 44.0 / std::f64::consts::TAU).abs());
        assert!(off.fold(f64::INFINITY, f64::min) < 0.1, "{found:?}");
        let sine: Vec<f64> = (0..1000).map(|k| libm::sin(0.3 * f64::from(k))).collect();
        assert!((periodic_in_time(&sine) - 1.0).abs() < 0.05);
    }

    /// The lines are those of one transform of all places and the empty ones after them.
    #[test]
    fn parts_of_a_spectrum_are_those_of_the_whole() {
        let position: Vec<f64> = (0..500).map(|k| libm::sin(0.02 * f64::from(k))).collect();
        let left = Left {
            residual: position.iter().map(|x| libm::cos(60.0 * x) + x).collect(),
            speed: position.iter().map(|x| (1.0 - x * x).sqrt()).collect(),
            position,
        };
        let (range, places) = (2.0, 1 << 10);
        let found = spectrum(std::slice::from_ref(&left), range, places, true);
        let sums = over_places(&left, range, places, true);
        assert_eq!(found.len(), places / PLACES_A_PERIOD);
        for (k, found) in found.iter().enumerate() {
            let mut line = Complex::<f64>::default();
            for (n, sum) in sums.iter().enumerate() {
                let turn = -TAU * (k * n) as f64 / (FINER * places) as f64;
                line += Complex::new(libm::cos(turn), libm::sin(turn)) * sum;
            }
            let expected = line.norm_sqr();
            assert!((found - expected).abs() < 1e-9 * expected.max(1.0), "{k}");
        }
    }

    #[test]
    fn nothing_has_no_period() {
        assert!(lines(&[]).is_empty());
        let still = Left {
            residual: vec![1.0; 50],
            position: vec![2.0; 50],
            speed: vec![0.0; 50],
        };
        assert!(lines(&[still]).is_empty());
        assert_eq!(periodic_in_time(&[]), 0.0);
    }
}
