//! Axes of which all is known, and recordings of them.

use std::env;
use std::f64::consts::TAU;
use std::ops::Range;
use std::thread;

use gwatt_identify::{Factor, Kind, Quantity, Recording, Signal, TransferFunction};

pub(crate) const PERIOD_S: f64 = 1e-3;

/// The numbers of cases that `GWATT_CASES` names, as in `20..40`; else from 0 on so many.
pub(crate) fn wanted(all: u64) -> Range<u64> {
    let named = env::var("GWATT_CASES").ok();
    let range = named.as_deref().and_then(|named| {
        let (from, to) = named.split_once("..")?;
        Some(from.parse().ok()?..to.parse().ok()?)
    });
    range.unwrap_or(0..all)
}

/// What comes of cases, in two threads.
pub(crate) fn in_two_threads<T: Send>(cases: usize, case: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let halves = thread::scope(|scope| {
        let half = |odd: usize| {
            let case = &case;
            scope.spawn(move || (odd..cases).step_by(2).map(case).collect::<Vec<_>>())
        };
        let threads = [half(0), half(1)];
        threads.map(|thread| thread.join().unwrap())
    });
    halves.into_iter().flatten().collect()
}

/// `SplitMix64`, and normal deviates of it (Box & Muller).
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn uniform(&mut self, from: f64, to: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        from + (to - from) * ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub(crate) fn normal(&mut self) -> f64 {
        let radius = (-2.0 * libm::log(1.0 - self.uniform(0.0, 1.0))).sqrt();
        radius * libm::cos(TAU * self.uniform(0.0, 1.0))
    }
}

/// A motion that is prescribed: position, speed and acceleration by sample.
#[derive(Clone)]
pub(crate) struct Motion {
    pub(crate) position: Vec<f64>,
    pub(crate) velocity: Vec<f64>,
    pub(crate) acceleration: Vec<f64>,
}

impl Motion {
    /// A sum of three sines of about 0.3, 1 and 3 Hz; `stroke` is about that of all.
    pub(crate) fn sines(samples: usize, stroke: f64, random: &mut Random) -> Self {
        let parts: Vec<[f64; 3]> = [(0.4, 0.31), (0.13, 0.97), (0.03, 3.1)]
            .into_iter()
            .map(|(share, hz)| {
                let hz = hz * random.uniform(0.9, 1.1);
                [share * stroke, TAU * hz, random.uniform(0.0, TAU)]
            })
            .collect();
        let mut out = Self::still(samples);
        for k in 0..samples {
            for [a, w, phase] in &parts {
                let (s, c) = libm::sincos(w * k as f64 * PERIOD_S + phase);
                out.position[k] += a * s;
                out.velocity[k] += a * w * c;
                out.acceleration[k] -= a * w * w * s;
            }
        }
        out
    }

    /// To and fro at several speeds with smooth ramps, some of them slow; without a stop.
    pub(crate) fn strokes(samples: usize, stroke: f64, random: &mut Random) -> Self {
        let mut out = Self::still(samples);
        let (mut at, mut k, mut index) = (0.0, 0, 0);
        let fast = 3.0 * stroke * random.uniform(0.8, 1.2);
        while k < samples {
            let speed = fast * [1.0, 0.3, 0.6, 0.15][index / 2 % 4];
            let way = stroke * if index / 2 % 4 == 3 { 0.3 } else { 1.0 };
            let sign = if index % 2 == 0 { 1.0 } else { -1.0 };
            // Half a sine of speed at either end, even speed between.
            let ramp_s = (0.15_f64).min(way / speed);
            let even_s = way / speed - ramp_s;
            let whole = ((2.0 * ramp_s + even_s) / PERIOD_S) as usize;
            for step in 0..whole.min(samples - k) {
                let t = step as f64 * PERIOD_S;
                let to_end = (whole as f64 * PERIOD_S - t).max(0.0);
                let near = t.min(to_end).min(ramp_s);
                let (s, c) = libm::sincos(TAU * near / ramp_s / 2.0);
                let v = speed * 0.5 * (1.0 - c);
                let slope = if t <= to_end { 1.0 } else { -1.0 };
                let a = if near < ramp_s {
                    slope * speed * 0.5 * s * TAU / 2.0 / ramp_s
                } else {
                    0.0
                };
                let before = if k == 0 { 0.0 } else { out.velocity[k - 1] };
                at += 0.5 * (sign * v + before) * PERIOD_S;
                out.position[k] = at;
                out.velocity[k] = sign * v;
                out.acceleration[k] = sign * a;
                k += 1;
            }
            index += 1;
        }
        out
    }

    fn still(samples: usize) -> Self {
        Self {
            position: vec![0.0; samples],
            velocity: vec![0.0; samples],
            acceleration: vec![0.0; samples],
        }
    }
}

/// A rigid axis with all that it may have besides mass and friction.
#[derive(Clone, Copy)]
pub(crate) struct Axis {
    pub(crate) mass: f64,
    pub(crate) viscous: f64,
    pub(crate) coulomb: f64,
    pub(crate) offset: f64,
    /// Period and amplitude.
    pub(crate) cogging: Option<[f64; 2]>,
    /// Rise and speed.
    pub(crate) stribeck: Option<[f64; 2]>,
    /// Width of the play, and share of the mass that is moved through it.
    pub(crate) backlash: Option<[f64; 2]>,
}

impl Axis {
    pub(crate) const PLAIN: Self = Self {
        mass: 80.0,
        viscous: 300.0,
        coulomb: 25.0,
        offset: -6.0,
        cogging: None,
        stribeck: None,
        backlash: None,
    };

    /// The force that moves it.
    pub(crate) fn force(&self, motion: &Motion) -> Vec<f64> {
        if let Some([width, share]) = self.backlash {
            return self.through_play(motion, width, share);
        }
        let moved = motion.position.iter().zip(&motion.velocity);
        moved
            .zip(&motion.acceleration)
            .map(|((x, v), a)| self.mass * a + self.friction(*v) + self.offset + self.at(*x))
            .collect()
    }

    /// Where a force moves it, in the middle of each sample.
    pub(crate) fn moved_by(&self, force: &[f64]) -> Vec<f64> {
        self.read_within(force, 0.5)
    }

    /// Where a force moves it that is held for each sample, after such a share of it.
    pub(crate) fn read_within(&self, force: &[f64], share: f64) -> Vec<f64> {
        const STEPS: usize = 20;
        let read_at = (share * STEPS as f64) as usize;
        let h = PERIOD_S / STEPS as f64;
        let (mut x, mut v) = (0.0, 0.0);
        let moved = force.iter().map(|force| {
            let mut middle = x;
            for step in 0..STEPS {
                if step == read_at {
                    middle = x;
                }
                let smooth = self.viscous * v + self.coulomb * libm::tanh(v / 1e-3);
                v += h * (force - smooth - self.offset) / self.mass;
                x += h * v;
            }
            middle
        });
        moved.collect()
    }

    fn friction(&self, v: f64) -> f64 {
        let sign = if v == 0.0 { 0.0 } else { v.signum() };
        let falling = self.stribeck.map_or(0.0, |[rise, speed]| {
            rise * libm::exp(-(v / speed) * (v / speed))
        });
        self.viscous * v + sign * (self.coulomb + falling)
    }

    fn at(&self, x: f64) -> f64 {
        self.cogging.map_or(0.0, |[period, amplitude]| {
            amplitude * libm::sin(TAU * x / period + 0.7)
        })
    }

    /// A load that is pushed by a spring and a damper at either end of a play, in steps of
    /// 20 µs; all friction is the load's.
    fn through_play(&self, motion: &Motion, width: f64, share: f64) -> Vec<f64> {
        const STEPS: usize = 50;
        let h = PERIOD_S / STEPS as f64;
        let load = share * self.mass;
        // 40 Hz with a damping of 0.5: nothing rings.
        let w = TAU * 40.0;
        let (spring, damper) = (load * w * w, load * w);
        let (mut x, mut v) = (motion.position[0], motion.velocity[0]);
        let mut out = Vec::new();
        for k in 0..motion.position.len() {
            let mut sum = 0.0;
            for step in 0..STEPS {
                let dt = step as f64 * h;
                let speed = motion.velocity[k] + motion.acceleration[k] * dt;
                let place = motion.position[k] + dt * motion.velocity[k];
                let apart = place - x;
                let push = if apart > 0.5 * width {
                    (spring * (apart - 0.5 * width) + damper * (speed - v)).max(0.0)
                } else if apart < -0.5 * width {
                    (spring * (apart + 0.5 * width) + damper * (speed - v)).min(0.0)
                } else {
                    0.0
                };
                let smooth = self.viscous * v + self.coulomb * libm::tanh(v / 1e-4);
                v += h * (push - smooth) / load;
                x += h * v;
                sum += push;
            }
            let own = (1.0 - share) * self.mass * motion.acceleration[k];
            out.push(own + sum / STEPS as f64 + self.offset);
        }
        out
    }
}

/// Noise of the force, and steps of the encoder.
#[derive(Clone, Copy)]
pub(crate) struct Sensors {
    pub(crate) force: f64,
    pub(crate) step: f64,
}

/// A recording of force and position.
pub(crate) fn recorded(
    force: &[f64],
    position: &[f64],
    sensors: Sensors,
    random: &mut Random,
) -> Recording {
    let noisy = force.iter().map(|f| f + sensors.force * random.normal());
    let counted = position
        .iter()
        .map(|x| sensors.step * libm::round(x / sensors.step));
    recording(noisy.collect(), counted.collect(), Quantity::Position)
}

/// A recording of a force and a motion.
pub(crate) fn recording(force: Vec<f64>, motion: Vec<f64>, quantity: Quantity) -> Recording {
    let signal = |name: &str, quantity, values| Signal {
        name: name.to_owned(),
        quantity,
        kind: Kind::Linear,
        values,
    };
    Recording {
        period_s: PERIOD_S,
        signals: vec![
            signal("force_n", Quantity::Force, force),
            signal("motion", quantity, motion),
        ],
        ignored: Vec::new(),
        notes: Vec::new(),
    }
}

pub(crate) fn pair(hz: f64, damping: f64) -> Factor {
    Factor::Pair {
        omega_rad_s: TAU * hz,
        damping,
    }
}

/// One or two anti-resonances, each with a resonance above it, and a drive that swings.
pub(crate) fn plant(random: &mut Random) -> TransferFunction {
    let count = if random.uniform(0.0, 1.0) < 0.6 { 1 } else { 2 };
    let mut hz = random.uniform(12.0, 60.0);
    let (mut zeros, mut poles) = (Vec::new(), Vec::new());
    for _ in 0..count {
        zeros.push(pair(hz, random.uniform(0.01, 0.08)));
        hz *= random.uniform(1.2, 1.5);
        poles.push(pair(hz, random.uniform(0.01, 0.08)));
        hz *= random.uniform(1.3, 1.8);
    }
    poles.push(pair(hz.max(120.0) * 1.3, random.uniform(0.03, 0.1)));
    TransferFunction {
        gain: 1.0 / random.uniform(0.005, 0.1),
        zeros,
        poles,
        delay_s: 0.0,
    }
}

/// A drive that swings, and nothing else.
pub(crate) fn stiff(random: &mut Random) -> TransferFunction {
    TransferFunction {
        gain: 1.0 / random.uniform(0.005, 0.1),
        zeros: Vec::new(),
        poles: vec![pair(
            random.uniform(120.0, 250.0),
            random.uniform(0.03, 0.1),
        )],
        delay_s: 0.0,
    }
}
