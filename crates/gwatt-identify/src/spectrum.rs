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
    /// Complex values of which the variance at each frequency is the mean; 0 where that is
    /// not known.
    pub noise_values: usize,
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
        return Some(over_periods(input, output, instrument, period, period_s));
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
) -> FrequencyResponse {
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
    let used = count - first;
    for index in first..count {
        for (sum, x) in u.iter_mut().zip(part(input, index)) {
            *sum += x;
        }
        for (sum, x) in y.iter_mut().zip(part(output, index)) {
            *sum += x;
        }
    }
    let r = instrument.map(|r| part(r, first));
    let strength: Vec<f64> = r.as_ref().unwrap_or(&u).iter().map(|x| x.norm()).collect();
    let largest = strength.iter().copied().fold(0.0, f64::max);
    let last = bins.saturating_sub(usize::from(period.is_multiple_of(2)));
    // A line without excitation says nothing, of its noise neither.
    let lines: Vec<(usize, C, C)> = (1..last)
        .filter_map(|bin| {
            let (u, y) = (*u.get(bin)?, *y.get(bin)?);
            let is_excited = *strength.get(bin)? > 1e-4 * largest && u.norm_sqr() > 0.0;
            is_excited.then_some((bin, u, y))
        })
        .collect();
    let mut rest = vec![0.0; lines.len()];
    let mut total = vec![0.0; lines.len()];
    for index in first..count {
        let (pu, py) = (part(input, index), part(output, index));
        let sums = rest.iter_mut().zip(&mut total);
        for ((bin, u, y), (slot, all)) in lines.iter().zip(sums) {
            if let (Some(pu), Some(py)) = (pu.get(*bin), py.get(*bin)) {
                *slot += (py - y / u * pu).norm_sqr();
                *all += py.norm_sqr();
            }
        }
    }
    let free = used.saturating_sub(1).max(1);
    // Noise changes little from line to line, and few periods show little of it at each.
    let half = NOISE_VALUES.div_ceil(free);
    let smooth = averaged(&rest, half);
    let mut out = FrequencyResponse {
        periodic: true,
        noise_values: free * (2 * half + 1).min(lines.len()),
        ..FrequencyResponse::default()
    };
    let per_line = used as f64 / free as f64;
    let noise = rest.iter().zip(&total).zip(&smooth);
    for ((bin, u, y), ((left, total), smooth)) in lines.iter().zip(noise) {
        out.frequency_hz
            .push(*bin as f64 / (period as f64 * period_s));
        out.response.push(y / u);
        out.coherence.push((1.0 - left / total).clamp(0.0, 1.0));
        out.variance.push(smooth * per_line / u.norm_sqr());
        out.power.push(*total);
    }
    out
}

/// Means over so many neighbours on either side; at the ends over as many, so that none of few
/// values counts by chance.
fn averaged(x: &[f64], half: usize) -> Vec<f64> {
    let mut sums = vec![0.0];
    let mut sum = 0.0;
    for x in x {
        sum += x;
        sums.push(sum);
    }
    let window = (2 * half + 1).min(x.len());
    (0..x.len())
        .map(|index| {
            let from = index.saturating_sub(half).min(x.len() - window);
            match (sums.get(from), sums.get(from + window)) {
                (Some(a), Some(b)) => (b - a) / window as f64,
                _ => 0.0,
            }
        })
        .collect()
}

/// The least power of two, or three times one, that is no less.
fn smooth_length(least: usize) -> usize {
    let power = least.next_power_of_two();
    let less = 3 * (power / 4);
    if less >= least { less } else { power }
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
    let most = x.iter().fold(0.0_f64, |most, x| most.max((x - mean).abs()));
    if most == 0.0 {
        return None;
    }
    // Up to lags of a half nothing comes round the end of as much again. What single
    // precision may be wrong by, the last comparison puts right.
    let length = smooth_length(n + n / 2 + 1);
    let fft = RealFftPlanner::<f32>::new().plan_fft_forward(length);
    let mut data = Vec::with_capacity(length);
    data.extend(x.iter().map(|x| ((x - mean) / most) as f32));
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
            .is_some_and(|c| f64::from(c.re / power) > 0.99 * overlap - 1e-3)
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

    #[test]
    fn lengths_for_transforms() {
        assert_eq!(
            [12, 13, 16, 17, 24, 25].map(smooth_length),
            [12, 16, 16, 24, 24, 32]
        );
    }

    #[test]
    fn means_at_the_ends_are_of_as_many() {
        let x = [1.0, 2.0, 6.0, 3.0, 9.0];
        assert_eq!(averaged(&x, 1), [3.0, 3.0, 11.0 / 3.0, 6.0, 6.0]);
        assert_eq!(averaged(&x[..2], 3), [1.5, 1.5]);
        assert!(averaged(&[], 3).is_empty());
    }

    /// Of a signal with every second line, repeated four times, the lines between say nothing:
    /// neither of the response nor of its noise. Each variance is the mean of 34 values, two of
    /// each of 17 lines.
    #[test]
    fn lines_that_are_left_out_say_nothing() {
        let mut state = 1_u64;
        let mut random = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 33) as f64 / f64::from(1_u32 << 30) - 1.0
        };
        let phases: Vec<f64> = (0..40).map(|_| 3.0 * random()).collect();
        let input: Vec<f64> = (0..1600)
            .map(|k| {
                let turn = 2.0 * PI * f64::from(k) / 400.0;
                let each = phases.iter().enumerate();
                each.map(|(line, phase)| libm::cos((2 * line + 1) as f64 * turn + phase))
                    .sum()
            })
            .collect();
        let output: Vec<f64> = input.iter().map(|x| 2.0 * x + random()).collect();
        let found = measure(&input, &output, None, 1e-3, None).unwrap();
        assert!(found.periodic);
        assert_eq!((found.frequency_hz.len(), found.noise_values), (40, 34));
        // Noise from −1 to 1 has a variance of 1/3: 400/3 of a line, 1/3 of that as a mean of
        // three periods, by the square of 200, half of the length.
        let mean = found.variance.iter().sum::<f64>() / 40.0;
        let expected = 400.0 / 9.0 / (200.0 * 200.0);
        assert!((mean / expected - 1.0).abs() < 0.3, "{mean} {expected}");
    }

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
