//! How long identification takes: `cargo bench -p gwatt-identify --bench times`.
//!
//! An axis of 0.024 kg·m² with an anti-resonance at 40 Hz that is moved by random torques, and
//! a load that follows a random command; each at 1 kHz. A name as argument runs that alone.

use std::f64::consts::TAU;
use std::time::Instant;

use gwatt_identify::flexible::{self, Choice, Method};
use gwatt_identify::{
    Factor, Given, Kind, Measured, Quantity, Recording, Signal, TransferFunction, judgement,
    simulate,
};

const PERIOD_S: f64 = 1e-3;
const SHORT: usize = 16_000;
const LONG: usize = 1_000_000;

/// `SplitMix64`.
struct Random(u64);

impl Random {
    /// From −1 to 1.
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        2.0 * ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64 - 1.0
    }
}

fn slow_noise(samples: usize, size: f64, share: f64, random: &mut Random) -> Vec<f64> {
    let mut slow = 0.0;
    (0..samples)
        .map(|_| {
            slow += share * (random.next() - slow);
            size * slow
        })
        .collect()
}

/// Position and acceleration of a table that a mass swings on at 40 Hz, with friction of the
/// table.
fn moved(torque: &[f64], viscous: f64, coulomb: f64) -> (Vec<f64>, Vec<f64>) {
    const FINE: usize = 20;
    let (table, side) = (0.016, 0.008);
    let w = TAU * 40.0;
    let (spring, damper) = (side * w * w, 0.06 * side * w);
    let step_s = PERIOD_S / FINE as f64;
    let (mut x, mut v) = ([0.0; 2], [0.0; 2]);
    let moved = torque.iter().map(|torque| {
        let (mut first, before) = (0.0, x[0]);
        for step in 0..FINE {
            let [at, speed] = [x, v].map(|[table, side]: [f64; 2]| side - table);
            let pull = spring * at + damper * speed;
            let friction = viscous * v[0] + coulomb * libm::tanh(v[0] / 1e-3);
            let a = [(torque + pull - friction) / table, -pull / side];
            if step == 0 {
                first = a[0];
            }
            for ((x, v), a) in x.iter_mut().zip(&mut v).zip(a) {
                *v += a * step_s;
                *x += *v * step_s;
            }
        }
        (before, first)
    });
    moved.unzip()
}

fn noisy(x: Vec<f64>, share: f64, random: &mut Random) -> Vec<f64> {
    let squares: f64 = x.iter().map(|x| x * x).sum();
    let noise = share * (3.0 * squares / x.len() as f64).sqrt();
    x.into_iter().map(|x| x + noise * random.next()).collect()
}

fn by_torque(samples: usize, viscous: f64, coulomb: f64, noise: f64) -> Recording {
    let mut random = Random(1);
    let torque = slow_noise(samples, 10.0, 0.25, &mut random);
    let (_, motion) = moved(&torque, viscous, coulomb);
    let motion = noisy(motion, noise, &mut random);
    of((Quantity::Force, torque), (Quantity::Acceleration, motion))
}

/// Read by an encoder of 20 bits.
fn by_position(samples: usize, viscous: f64, coulomb: f64) -> Recording {
    let torque = slow_noise(samples, 10.0, 0.25, &mut Random(1));
    let (position, _) = moved(&torque, viscous, coulomb);
    let step = TAU / f64::from(1 << 20);
    let read = position.iter().map(|x| step * libm::round(x / step));
    let motion = read.collect();
    of((Quantity::Force, torque), (Quantity::Position, motion))
}

/// A load that follows a command with an anti-resonance at 40 Hz, 5 ms late.
fn by_command(samples: usize, measured: Quantity) -> Recording {
    let pair = |hz: f64, damping| Factor::Pair {
        omega_rad_s: TAU * hz,
        damping,
    };
    let load = TransferFunction {
        gain: 1.0,
        zeros: vec![pair(40.0, 0.03)],
        poles: vec![
            pair(45.0, 0.05),
            Factor::Real {
                time_constant_s: 4e-3,
            },
        ],
        delay_s: 5e-3,
    };
    let mut random = Random(2);
    let mut command = slow_noise(samples, 1.0, 0.1, &mut random);
    let mut at = 0.0;
    for x in &mut command {
        at += 0.05 * (*x - at);
        *x = at;
    }
    let answer = simulate(&load, Measured::Direct, PERIOD_S, &command).unwrap();
    let answer = if measured == Quantity::Acceleration {
        let mut second = vec![0.0; 2];
        second.extend(answer.windows(3).map(|w| (w[0] - 2.0 * w[1] + w[2]) / 1e-6));
        second
    } else {
        answer
    };
    let answer = noisy(answer, 0.01, &mut random);
    of((Quantity::Command, command), (measured, answer))
}

fn of(input: (Quantity, Vec<f64>), output: (Quantity, Vec<f64>)) -> Recording {
    let signal = |name: &str, (quantity, values)| Signal {
        name: name.to_owned(),
        quantity,
        kind: Kind::Rotary,
        values,
    };
    Recording {
        period_s: PERIOD_S,
        signals: vec![signal("input", input), signal("output", output)],
        ignored: Vec::new(),
        notes: Vec::new(),
    }
}

/// A name, how it is identified, and the recording that goes with it.
type Case = (&'static str, Method, fn() -> Recording);

const CASES: [Case; 17] = [
    ("16-s-friction-exact", Method::Iv, || {
        by_torque(SHORT, 0.048, 0.0, 0.0)
    }),
    ("16-s-dry-exact", Method::Iv, || {
        by_torque(SHORT, 0.048, 0.1, 0.0)
    }),
    ("16-s-dry", Method::Iv, || {
        by_torque(SHORT, 0.048, 0.1, 0.01)
    }),
    ("16-s-iv", Method::Iv, || by_torque(SHORT, 0.0, 0.0, 0.01)),
    ("16-s-frequency", Method::Frequency, || {
        by_torque(SHORT, 0.0, 0.0, 0.01)
    }),
    ("16-s-arx", Method::Arx, || by_torque(SHORT, 0.0, 0.0, 0.01)),
    ("16-s-subspace", Method::Subspace, || {
        by_torque(SHORT, 0.0, 0.0, 0.01)
    }),
    ("16-s-dry-position", Method::Iv, || {
        by_position(SHORT, 0.048, 0.1)
    }),
    ("1000000-position", Method::Iv, || {
        by_position(LONG, 0.0, 0.0)
    }),
    ("1000000-dry-position", Method::Iv, || {
        by_position(LONG, 0.048, 0.1)
    }),
    ("1000000-dry", Method::Iv, || {
        by_torque(LONG, 0.048, 0.1, 0.01)
    }),
    ("1000000-iv", Method::Iv, || by_torque(LONG, 0.0, 0.0, 0.01)),
    ("1000000-frequency", Method::Frequency, || {
        by_torque(LONG, 0.0, 0.0, 0.01)
    }),
    ("1000000-arx", Method::Arx, || {
        by_torque(LONG, 0.0, 0.0, 0.01)
    }),
    ("1000000-subspace", Method::Subspace, || {
        by_torque(LONG, 0.0, 0.0, 0.01)
    }),
    ("1000000-position-from-command", Method::Iv, || {
        by_command(LONG, Quantity::Position)
    }),
    ("1000000-acceleration-from-command", Method::Iv, || {
        by_command(LONG, Quantity::Acceleration)
    }),
];

/// Seconds that the processor worked, where Linux counts them: next to other programs a clock
/// says little.
fn worked_s() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/self/schedstat").ok()?;
    let nanoseconds: f64 = text.split(' ').next()?.parse().ok()?;
    Some(nanoseconds * 1e-9)
}

fn main() {
    let wanted = std::env::args().skip(1).find(|arg| !arg.starts_with('-'));
    for (name, method, recording) in CASES {
        if wanted.as_ref().is_some_and(|wanted| wanted != name) {
            continue;
        }
        let recording = recording();
        let choice = Choice {
            method,
            given: Given::default(),
            from_command: recording.get(Quantity::Command).is_some(),
        };
        let (began, before) = (Instant::now(), worked_s());
        let found = flexible::identify(&recording, &choice);
        let seconds = began.elapsed().as_secs_f64();
        let worked = before.zip(worked_s()).map_or(seconds, |(a, b)| b - a);
        let inertia = found.as_ref().ok().and_then(|it| it.inertia);
        let word = found.map(|it| judgement::flexible(&it).word());
        print!("{name}: {worked:.2} s of {seconds:.2} s, {word:?}");
        match inertia {
            Some(inertia) => println!(", {:.6} ± {:.6} kg·m²", inertia.value, inertia.std),
            None => println!(),
        }
    }
}
