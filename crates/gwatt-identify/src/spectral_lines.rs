//! A recording as the lines of its spectra.
//!
//! The difference of each section's state between the two ends of the recording
//! is all that the missing period leaves in a spectrum (Pintelon & Schoukens,
//! *System Identification*, 2nd ed., section 6.3.2): with it the fit of the lines is
//! that of the samples. Only those lines count to which the input has something to
//! say, mostly far fewer than samples.

use std::f64::consts::PI;
use std::ops::Range;

use nalgebra::Complex;

use super::candidate_models::LAG_MAX;
use super::data::Data;
use super::measured_noise::Noise;
use super::parallel::{Hold, Section, TAPS};
use super::places::thinned;
use super::spectrum::transform_of;
use super::state_space::Measured;

type C = Complex<f64>;

/// Lines up to this factor beyond the band, and so many rad per period more: what
/// swings freely shows there too.
const BEYOND: f64 = 1.3;
const FREE: f64 = 0.9;
/// The longest delay, in periods.
const LATE: usize = LAG_MAX + 4;

/// Lines of the spectra of input and output.
pub struct Lines {
    /// rad per period.
    theta: Vec<f64>,
    /// Points of the unit circle.
    z: Vec<C>,
    /// How each counts: the response of the filter that makes the noise white.
    weight: Vec<f64>,
    /// The input by how many samples it is late.
    inputs: Vec<Vec<C>>,
    output: Vec<f64>,
    measured: Measured,
    /// The band, rad per period.
    edge: f64,
    /// Sampling period, s.
    pub period_s: f64,
    /// Sum of squares of the output.
    pub power: f64,
    /// Samples that the lines were made of.
    pub samples: usize,
    /// True for commands as input.
    pub from_command: bool,
    /// The shortest delay, s.
    pub early_s: f64,
    /// First samples of differences to which the ends of a noisy signal add.
    ends: usize,
}

impl Lines {
    /// Of a recording as it is, after what makes its noise white, up to a little
    /// beyond a band. `None` when there is too little.
    #[must_use]
    pub fn new(data: &Data<'_>, noise: &Noise, band_rad_s: f64, most: usize) -> Option<Self> {
        let skip = data.skip();
        // A length that Fourier transforms like.
        let count = data.len().checked_sub(skip)? / 40 * 40;
        if count < 200 {
            return None;
        }
        let from = data.len() - count;
        let turn = 2.0 * PI / count as f64;
        let edge = (BEYOND * band_rad_s * data.period_s + FREE) / turn;
        let lines = (edge as usize).min(count / 2 - 1);
        let used: Vec<usize> = thinned(lines, most).iter().map(|line| line + 1).collect();
        let pick = |x: &[C]| -> Vec<C> { used.iter().map(|line| at(x, *line)).collect() };
        let theta: Vec<f64> = used.iter().map(|line| *line as f64 * turn).collect();
        let z: Vec<C> = theta.iter().map(|theta| on_circle(*theta)).collect();
        let output = pick(&transform_of(data.output.get(from..from + count)?));
        let input = pick(&transform_of(data.input.get(from..from + count)?));
        let times = data.measured.integrators();
        let held = |theta: f64| integrators(noise.leak, times, theta);
        // Parseval: a line and its image, each a sum over all samples.
        let share = (2.0 / count as f64).sqrt();
        let mut out = Self {
            weight: theta
                .iter()
                .map(|theta| share * response(&noise.taps, *theta) * held(*theta))
                .collect(),
            inputs: by_lateness(input, &z, data.input, from..from + count),
            output: Vec::new(),
            measured: data.measured,
            edge: BEYOND * band_rad_s * data.period_s,
            period_s: data.period_s,
            power: 0.0,
            z,
            theta,
            samples: count,
            from_command: data.from_command,
            early_s: data.early_s,
            ends: if noise.leak > 0.0 { times } else { 0 },
        };
        out.output = out.column(&output);
        out.power = out.output.iter().map(|x| x * x).sum();
        Some(out)
    }

    /// rad per period of each line.
    #[must_use]
    pub fn theta(&self) -> &[f64] {
        &self.theta
    }

    /// A little beyond the band, rad per period.
    #[must_use]
    pub fn edge(&self) -> f64 {
        self.edge
    }

    /// How the input runs between samples.
    #[must_use]
    pub fn measured(&self) -> Measured {
        self.measured
    }

    /// How each line counts.
    #[must_use]
    pub fn weight(&self) -> &[f64] {
        &self.weight
    }

    /// The output, as a column.
    #[must_use]
    pub fn output(&self) -> &[f64] {
        &self.output
    }

    /// Real and imaginary parts.
    #[must_use]
    pub fn rows(&self) -> usize {
        2 * self.theta.len()
    }

    /// The hold that runs between samples, so much of a period late.
    #[must_use]
    pub fn hold(&self, late: f64) -> Hold {
        Hold::new(self.measured, late)
    }

    /// The input, this many periods late.
    #[must_use]
    pub fn input(&self, late: usize) -> &[C] {
        self.inputs.get(late).map_or(&[], Vec::as_slice)
    }

    /// A column of the equations: weighted, real parts before imaginary ones.
    #[must_use]
    pub fn column(&self, x: &[C]) -> Vec<f64> {
        let pairs = || x.iter().zip(&self.weight);
        let re = pairs().map(|(x, w)| x.re * w);
        re.chain(pairs().map(|(x, w)| x.im * w)).collect()
    }

    /// What the differences of noise, which does not end where it began, add: something
    /// at each of the first samples.
    #[must_use]
    pub fn ends(&self) -> Vec<Vec<f64>> {
        let late = |samples: usize| -> Vec<f64> {
            let turned = self.theta.iter();
            let turned = turned.map(|theta| on_circle(-theta * samples as f64));
            self.column(&turned.collect::<Vec<C>>())
        };
        (0..self.ends).map(late).collect()
    }

    /// The input as taps weigh it, `lag` periods late.
    #[must_use]
    pub fn driven(&self, taps: &[f64; TAPS], lag: usize) -> Vec<C> {
        let mut out = vec![C::default(); self.theta.len()];
        for (input, tap) in self.inputs.iter().skip(lag).zip(taps) {
            add_scaled(&mut out, *tap, input);
        }
        out
    }

    /// `(z − Φ)⁻¹` times a vector.
    #[must_use]
    pub fn resolve(&self, section: &Section, right: impl Fn(usize, C) -> [C; 2]) -> [Vec<C>; 2] {
        let [a, b, c, d] = section.phi;
        let mut out = [Vec::new(), Vec::new()];
        for (k, z) in self.z.iter().copied().enumerate() {
            let [p, q] = right(k, z);
            let (x, y) = if section.degree == 1 {
                (p / (z - a), C::default())
            } else {
                let scale = inverse((z - a) * (z - d) - b * c);
                (((z - d) * p + q * b) * scale, ((z - a) * q + p * c) * scale)
            };
            let [first, second] = &mut out;
            first.push(x);
            second.push(y);
        }
        out
    }

    /// The states of a section that the input drives.
    #[must_use]
    pub fn states(&self, section: &Section, lag: usize) -> [Vec<C>; 2] {
        let [p, q] = self.taken_in(section, lag);
        self.resolve(section, |k, _| [at(&p, k), at(&q, k)])
    }

    /// What the input adds to the states.
    fn taken_in(&self, section: &Section, lag: usize) -> [Vec<C>; 2] {
        [
            self.driven(&section.gamma.map(|[first, _]| first), lag),
            self.driven(&section.gamma.map(|[_, second]| second), lag),
        ]
    }

    /// The states that one of them alone swings through from the first sample on.
    #[must_use]
    pub fn swing(&self, section: &Section, start: usize) -> [Vec<C>; 2] {
        self.resolve(section, |_, z| match start {
            0 => [z, C::default()],
            _ => [C::default(), z],
        })
    }

    /// How a section changes what it makes of its input, `states` being what it
    /// makes now: `X = (z − Φ)⁻¹·Γ·U` moves by `(z − Φ)⁻¹·(Φ'·X + Γ'·U)`.
    #[must_use]
    pub fn moved(
        &self,
        section: &Section,
        change: &Section,
        states: &[Vec<C>; 2],
        lag: usize,
    ) -> [Vec<C>; 2] {
        let [p, q] = self.taken_in(change, lag);
        self.resolve(section, |k, _| {
            let [x, y] = turned(change.phi, states, k);
            [x + at(&p, k), y + at(&q, k)]
        })
    }
}

/// Lines of a stretch of a signal by how many samples it is late; before its first sample
/// there was nothing. A sample later, the last one is out and one before the first is in,
/// and both stand where the stretch begins.
fn by_lateness(lines: Vec<C>, z: &[C], signal: &[f64], stretch: Range<usize>) -> Vec<Vec<C>> {
    let mut out = vec![lines];
    for late in 1..LATE + TAPS {
        let sample = |at: Option<usize>| at.and_then(|at| signal.get(at)).copied();
        let comes = sample(stretch.start.checked_sub(late)).unwrap_or_default();
        let goes = sample(stretch.end.checked_sub(late)).unwrap_or_default();
        let before = out.last().map_or(&[][..], Vec::as_slice);
        let next = before.iter().zip(z);
        out.push(next.map(|(x, z)| x * z.conj() + (comes - goes)).collect());
    }
    out
}

/// Adds a multiple of a signal.
pub fn add_scaled(column: &mut [C], factor: f64, x: &[C]) {
    if factor != 0.0 {
        for (slot, x) in column.iter_mut().zip(x) {
            *slot += x * factor;
        }
    }
}

/// A point of the unit circle.
#[must_use]
pub fn on_circle(theta: f64) -> C {
    let (sin, cos) = libm::sincos(theta);
    C::new(cos, sin)
}

/// `1/x`.
#[must_use]
pub fn inverse(x: C) -> C {
    x.conj() / x.norm_sqr()
}

/// The value at a place; 0 where there is none.
#[must_use]
pub fn at(x: &[C], k: usize) -> C {
    x.get(k).copied().unwrap_or_default()
}

/// What a matrix makes of states.
#[must_use]
pub fn turned(phi: [f64; 4], states: &[Vec<C>; 2], k: usize) -> [C; 2] {
    let [a, b, c, d] = phi;
    let [x, y] = states;
    let (x, y) = (at(x, k), at(y, k));
    [x * a + y * b, x * c + y * d]
}

/// Size of the whitening filter's response.
#[must_use]
pub fn response(taps: &[f64], theta: f64) -> f64 {
    let mut sum = C::new(1.0, 0.0);
    for (index, tap) in taps.iter().enumerate() {
        sum += on_circle(-theta * (index + 1) as f64) * *tap;
    }
    sum.norm()
}

/// Size of the response of leaky integrators; 1 without them.
#[must_use]
pub fn integrators(leak: f64, times: usize, theta: f64) -> f64 {
    if leak == 0.0 {
        return 1.0;
    }
    let each = (C::new(1.0, 0.0) - on_circle(-theta) * (1.0 - leak)).norm_sqr();
    libm::pow(each, -0.5 * times as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lines of what is late are those of the transform of what is late.
    #[test]
    fn what_is_late_has_the_lines_of_a_late_signal() {
        let signal: Vec<f64> = (0..47).map(|k| f64::from(k * k % 13) - 5.0).collect();
        let turn = 2.0 * PI / 40.0;
        let z: Vec<C> = (0..21)
            .map(|line| on_circle(turn * f64::from(line)))
            .collect();
        for from in [7, 2] {
            let lines = transform_of(&signal[from..from + 40]);
            let late = by_lateness(lines, &z, &signal, from..from + 40);
            assert_eq!(late.len(), LATE + TAPS);
            for (late, lines) in late.iter().enumerate() {
                let shifted: Vec<f64> = (0..40)
                    .map(|k| (from + k).checked_sub(late).map_or(0.0, |at| signal[at]))
                    .collect();
                for (found, expected) in lines.iter().zip(transform_of(&shifted)) {
                    assert!((found - expected).norm() < 1e-10, "{from} {late}");
                }
            }
        }
    }
}
