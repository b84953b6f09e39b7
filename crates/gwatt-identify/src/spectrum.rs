//! Measured frequency responses: cross-spectra averaged over stretches or, where
//! the excitation repeats, over its periods.

use std::f64::consts::PI;
use std::sync::Arc;

use nalgebra::Complex;
use realfft::{RealFftPlanner, RealToComplex};

type C = Complex<f64>;

/// A measured frequency response.
#[derive(Debug, Clone, Default)]
pub struct FrequencyResponse {
    /// Frequencies in Hz, ascending, 0 left out.
    pub frequency_hz: Vec<f64>,
    /// Output by input.
    pub response: Vec<C>,
    /// How much of the output the input explains, 0 to 1.
    pub coherence: Vec<f64>,
    /// Variance of the response.
    pub variance: Vec<f64>,
    /// Power of the output at each frequency, in any unit.
    pub power: Vec<f64>,
    /// True when whole periods of the excitation were averaged: nothing leaks.
    pub periodic: bool,
}

impl FrequencyResponse {
    /// Up to where the input explains most of the output, rad/s: beyond, a
    /// recording shows nothing but what fast modes make of slow motion.
    #[must_use]
    pub fn band_rad_s(&self) -> f64 {
        self.explained_rad_s(0.5)
    }

    /// Up to where the input shows in the output at all, rad/s.
    #[must_use]
    pub fn shown_rad_s(&self) -> f64 {
        self.explained_rad_s(0.3)
    }

    /// Up to where the input explains this share of the output, rad/s.
    fn explained_rad_s(&self, share: f64) -> f64 {
        const BINS: usize = 5;
        let explained = self.coherence.windows(BINS).rposition(|bins| {
            let sum: f64 = bins.iter().sum();
            sum > share * BINS as f64
        });
        let edge = explained.map_or(self.frequency_hz.len(), |first| first + BINS);
        let hz = self.frequency_hz.get(edge.saturating_sub(1));
        hz.map_or(f64::INFINITY, |hz| 2.0 * PI * hz)
    }
}

/// Averages the response of `output` to `input`. With an `instrument` (the
/// excitation of a closed loop) both are referred to it, which keeps the loop's
/// noise out. Lengths must be equal. `None` for fewer than 64 samples.
#[must_use]
pub fn measure(
    input: &[f64],
    output: &[f64],
    instrument: Option<&[f64]>,
    period_s: f64,
    stretch: Option<usize>,
) -> Option<FrequencyResponse> {
    let n = input.len().min(output.len());
    if n < 64 {
        return None;
    }
    let reference = instrument.unwrap_or(input);
    if stretch.is_none()
        && let Some(period) = repetition(reference)
        && n / period >= 3
    {
        return over_periods(input, output, instrument, period, period_s);
    }
    let length = stretch.unwrap_or_else(|| (n / 6).next_power_of_two().clamp(64, 1 << 11));
    Some(over_stretches(
        input,
        output,
        reference,
        length.min(n),
        period_s,
    ))
}

/// How two signals cohere, from frequency to frequency.
pub struct Coherent {
    /// Squares of the coherence, 0 to 1.
    pub coherence: Vec<f64>,
    /// Power of the first signal, and of the second.
    pub by_power: Vec<f64>,
    /// See there.
    pub power: Vec<f64>,
    /// So many stretches count as independent: chance alone makes `1/K`.
    pub independent: f64,
}

/// The coherence of two signals over short stretches.
#[must_use]
pub fn coherent(by: &[f64], signal: &[f64], period_s: f64) -> Coherent {
    const STRETCHES: usize = 32;
    let n = by.len().min(signal.len());
    let length = (n / STRETCHES).clamp(16, 1 << 12);
    let measured = over_stretches(by, signal, by, length, period_s);
    let own = over_stretches(by, by, by, length, period_s);
    Coherent {
        coherence: measured.coherence,
        by_power: own.power,
        power: measured.power,
        independent: (0.53 * (2 * n / length).max(1) as f64).max(1.0),
    }
}

/// Which share of a signal's power another one explains, as any linear system could
/// make the one of the other: the mean coherence by power, less the `1/K` that K
/// stretches seem to cohere by chance.
#[must_use]
pub fn explained_share(by: &[f64], signal: &[f64], period_s: f64) -> f64 {
    let found = coherent(by, signal, period_s);
    let chance = 1.0 / found.independent;
    let (mut explained, mut all) = (0.0, 0.0);
    for (coherence, power) in found.coherence.iter().zip(&found.power) {
        explained += power * (coherence - chance) / (1.0 - chance);
        all += power;
    }
    if all > 0.0 && chance < 1.0 {
        (explained / all).max(0.0)
    } else {
        0.0
    }
}

fn plan(length: usize) -> Arc<dyn RealToComplex<f64>> {
    RealFftPlanner::<f64>::new().plan_fft_forward(length)
}

/// The transform of a stretch, its mean taken off, under a window.
fn transform(fft: &Arc<dyn RealToComplex<f64>>, x: &[f64], window: &[f64]) -> Vec<C> {
    let mean = x.iter().sum::<f64>() / x.len().max(1) as f64;
    let mut data: Vec<f64> = x.iter().zip(window).map(|(x, w)| (x - mean) * w).collect();
    let mut out = fft.make_output_vec();
    data.resize(fft.len(), 0.0);
    // Lengths are those of the plan: it cannot refuse.
    let _ = fft.process(&mut data, &mut out);
    out
}

/// The transform of a signal as it is.
#[must_use]
pub fn transform_of(x: &[f64]) -> Vec<C> {
    let fft = plan(x.len());
    let mut data = x.to_vec();
    let mut out = fft.make_output_vec();
    // Lengths are those of the plan: it cannot refuse.
    let _ = fft.process(&mut data, &mut out);
    out
}

/// Up to where there is anything in a signal, rad/s.
#[must_use]
pub fn excited_rad_s(x: &[f64], period_s: f64) -> f64 {
    const SHARE: f64 = 1e-4;
    const BANDS: usize = 250;
    let lines = transform_of(x);
    let width = (lines.len() / BANDS).max(1);
    // Without the mean, next to which the rest would seem little.
    let powers: Vec<f64> = lines
        .get(1..)
        .unwrap_or_default()
        .chunks(width)
        .map(|band| band.iter().map(C::norm_sqr).sum())
        .collect();
    let most = powers.iter().copied().fold(0.0, f64::max);
    let last = powers.iter().rposition(|power| *power > SHARE * most);
    let edge = last.map_or(0, |last| (last + 1) * width);
    2.0 * PI * edge as f64 / (x.len().max(1) as f64 * period_s)
}

#[derive(Clone, Copy, Default)]
struct Sums {
    /// Of the input with the reference, of the output with it, and powers.
    ur: C,
    yr: C,
    rr: f64,
    uu: f64,
    yy: f64,
    yu: C,
}

/// Welch's method with Hann windows that overlap by half.
fn over_stretches(
    input: &[f64],
    output: &[f64],
    reference: &[f64],
    length: usize,
    period_s: f64,
) -> FrequencyResponse {
    let window: Vec<f64> = (0..length)
        .map(|k| 0.5 - 0.5 * libm::cos(2.0 * PI * (k as f64 + 0.5) / length as f64))
        .collect();
    let fft = plan(length);
    let bins = length / 2 + 1;
    let mut sums = vec![Sums::default(); bins];
    let mut stretches = 0_usize;
    let hop = (length / 2).max(1);
    let n = input.len().min(output.len()).min(reference.len());
    let mut start = 0;
    while start + length <= n {
        let part = |x: &[f64]| {
            let stretch = x.get(start..start + length).unwrap_or_default();
            transform(&fft, stretch, &window)
        };
        let (u, y) = (part(input), part(output));
        let r = part(reference);
        for (((sum, u), y), r) in sums.iter_mut().zip(&u).zip(&y).zip(&r) {
            sum.ur += u * r.conj();
            sum.yr += y * r.conj();
            sum.rr += r.norm_sqr();
            sum.uu += u.norm_sqr();
            sum.yy += y.norm_sqr();
            sum.yu += y * u.conj();
        }
        stretches += 1;
        start += hop;
    }
    let mut out = FrequencyResponse::default();
    // Half-overlapping Hann stretches count as about 0.53 of independent ones
    // each (Welch 1967).
    let independent = (0.53 * stretches as f64).max(1.0);
    let largest = sums.iter().map(|s| s.rr).fold(0.0, f64::max);
    for (bin, sum) in sums.iter().enumerate().skip(1).take(bins.saturating_sub(2)) {
        if sum.rr <= 1e-9 * largest || sum.ur.norm_sqr() == 0.0 {
            continue;
        }
        let g = sum.yr / sum.ur;
        let coherence = (sum.yr.norm_sqr() / (sum.rr * sum.yy)).clamp(0.0, 1.0);
        let rest = (sum.yy - 2.0 * (g.conj() * sum.yu).re + g.norm_sqr() * sum.uu).max(0.0);
        let variance = rest * sum.rr / sum.ur.norm_sqr() / independent;
        out.frequency_hz
            .push(bin as f64 / (length as f64 * period_s));
        out.response.push(g);
        out.coherence.push(if coherence.is_finite() {
            coherence
        } else {
            0.0
        });
        out.variance.push(variance);
        out.power.push(sum.yy);
    }
    out
}

/// Values of which the noise at a line is the mean, on either side.
const NOISE_VALUES: usize = 16;

/// Averages whole periods; the first is left out if there are three or more,
/// because the axis still swings in.
fn over_periods(
    input: &[f64],
    output: &[f64],
    instrument: Option<&[f64]>,
    period: usize,
    period_s: f64,
) -> Option<FrequencyResponse> {
    let n = input.len().min(output.len());
    let count = n / period;
    let first = usize::from(count >= 3);
    let fft = plan(period);
    let flat = vec![1.0; period];
    let part = |x: &[f64], index: usize| {
        let at = index * period;
        transform(&fft, x.get(at..at + period).unwrap_or_default(), &flat)
    };
    let bins = period / 2 + 1;
    let zero = C::new(0.0, 0.0);
    let (mut u, mut y) = (vec![zero; bins], vec![zero; bins]);
    let mut power = vec![0.0; bins];
    let used = count - first;
    for index in first..count {
        for ((sum, x), slot) in u.iter_mut().zip(part(input, index)).zip(&mut power) {
            *sum += x;
            *slot += x.norm_sqr();
        }
        for (sum, x) in y.iter_mut().zip(part(output, index)) {
            *sum += x;
        }
    }
    let r = instrument.map(|r| part(r, first));
    let strength: Vec<f64> = match &r {
        Some(r) => r.iter().map(|x| x.norm()).collect(),
        None => u.iter().map(|x| x.norm()).collect(),
    };
    let mut rest = vec![0.0; bins];
    let mut total = vec![0.0; bins];
    for index in first..count {
        let (pu, py) = (part(input, index), part(output, index));
        for (bin, (pu, py)) in pu.iter().zip(&py).enumerate() {
            if let (Some(u), Some(y), Some(slot), Some(all)) = (
                u.get(bin),
                y.get(bin),
                rest.get_mut(bin),
                total.get_mut(bin),
            ) {
                *slot += (py - y / u * pu).norm_sqr();
                *all += py.norm_sqr();
            }
        }
    }
    let largest = strength.iter().copied().fold(0.0, f64::max);
    let mut out = FrequencyResponse {
        periodic: true,
        ..FrequencyResponse::default()
    };
    let k = used as f64;
    // Noise changes little from line to line, and few periods show little of it at each.
    let smooth = averaged(&rest, NOISE_VALUES.div_ceil(used.saturating_sub(1).max(1)));
    for bin in 1..bins.saturating_sub(usize::from(period.is_multiple_of(2))) {
        let (u, y) = (*u.get(bin)?, *y.get(bin)?);
        if *strength.get(bin)? <= 1e-4 * largest || u.norm_sqr() == 0.0 {
            continue;
        }
        let (left, total) = (*rest.get(bin)?, *total.get(bin)?);
        out.frequency_hz
            .push(bin as f64 / (period as f64 * period_s));
        out.response.push(y / u);
        out.coherence.push((1.0 - left / total).clamp(0.0, 1.0));
        out.variance
            .push(smooth.get(bin)? / (k - 1.0).max(1.0) * k / u.norm_sqr());
        out.power.push(total);
    }
    Some(out)
}

/// Means over so many neighbours on either side, fewer at the ends; the line at 0 is left
/// out.
fn averaged(x: &[f64], half: usize) -> Vec<f64> {
    let mut sums = vec![0.0];
    let mut sum = 0.0;
    for (index, x) in x.iter().enumerate() {
        sum += if index == 0 { 0.0 } else { *x };
        sums.push(sum);
    }
    (0..x.len())
        .map(|index| {
            let half = half.min(index.saturating_sub(1)).min(x.len() - 1 - index);
            let (from, to) = (index - half.min(index), index + half + 1);
            match (sums.get(from), sums.get(to)) {
                (Some(a), Some(b)) => (b - a) / (to - from) as f64,
                _ => 0.0,
            }
        })
        .collect()
}

/// After how many samples a signal repeats itself, if it does.
#[must_use]
pub fn repetition(x: &[f64]) -> Option<usize> {
    const SHORTEST: usize = 32;
    // A level change is rare where the signal is held: compare few lags only,
    // those at which the autocorrelation is as large as at none.
    let n = x.len();
    if n < 4 * SHORTEST {
        return None;
    }
    let mean = x.iter().sum::<f64>() / n as f64;
    let length = (2 * n).next_power_of_two();
    let fft = plan(length);
    let mut data: Vec<f64> = x.iter().map(|x| x - mean).collect();
    data.resize(length, 0.0);
    let mut spectrum = fft.make_output_vec();
    fft.process(&mut data, &mut spectrum).ok()?;
    // Powers are real and the same on both sides: there and back are one transform.
    for (at, bin) in spectrum.iter().enumerate() {
        for at in [at, (length - at) % length] {
            if let Some(slot) = data.get_mut(at) {
                *slot = bin.norm_sqr();
            }
        }
    }
    fft.process(&mut data, &mut spectrum).ok()?;
    drop(data);
    let power = spectrum.first()?.re;
    if power <= 0.0 {
        return None;
    }
    let close = (SHORTEST..=n / 2).filter(|lag| {
        let overlap = (n - lag) as f64 / n as f64;
        spectrum
            .get(*lag)
            .is_some_and(|c| c.re / power > 0.99 * overlap - 1e-3)
    });
    // Of neighbouring lags the best is the period; the list is short.
    for lag in close.take(64) {
        let pairs = x.iter().zip(x.get(lag..)?);
        let (mut apart, mut size) = (0.0, 0.0);
        for (a, b) in pairs {
            apart += (a - b) * (a - b);
            size += (a - mean) * (a - mean);
        }
        if apart < 1e-4 * size {
            return Some(lag);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A signal explains itself and what a system makes of it; noise it does not.
    #[test]
    fn what_follows_from_a_signal_is_explained() {
        let mut state = 1_u64;
        let mut random = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 33) as f64 / f64::from(1_u32 << 30) - 1.0
        };
        let by: Vec<f64> = (0..8192).map(|_| random()).collect();
        let other: Vec<f64> = (0..8192).map(|_| random()).collect();
        let late: Vec<f64> = by
            .iter()
            .zip(by.iter().skip(1))
            .map(|(a, b)| a + 2.0 * b)
            .collect();
        assert!(explained_share(&by, &by, 1e-3) > 0.999);
        assert!(explained_share(&by, &late, 1e-3) > 0.97);
        assert!(explained_share(&by, &other, 1e-3) < 0.02);
        assert_eq!(explained_share(&by, &vec![0.0; 8192], 1e-3), 0.0);
    }
}
