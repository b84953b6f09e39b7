//! Two hundred recordings that are wrong in some way, of which none may be called good, and
//! two hundred that are right, of which few may not.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use gwatt_identify::flexible::{self, Choice, Method};
use gwatt_identify::{
    Factor, Given, Measured, Quantity, Recording, TransferFunction, judgement, rigid, simulate,
};

use crate::simulated::{
    Axis, Motion, PERIOD_S, Random, Sensors, in_two_threads, pair, plant, recorded, recording,
};

/// What came out: the verdict's word, or that it is refused.
type Word = String;

fn rigid_word(recording: Recording) -> Word {
    match rigid::fit_all(&[recording], None, None) {
        Ok(found) => judgement::rigid(&found).word().to_owned(),
        Err(trouble) => format!("refused: {trouble}"),
    }
}

fn flexible_word(recording: &Recording, order: Option<usize>) -> Word {
    let choice = Choice {
        method: Method::Iv,
        given: Given {
            order,
            ..Given::default()
        },
        from_command: false,
    };
    match flexible::identify(recording, &choice) {
        Ok(found) => judgement::flexible(&found).word().to_owned(),
        Err(trouble) => format!("refused: {trouble}"),
    }
}

pub(crate) fn axis(random: &mut Random) -> Axis {
    Axis {
        mass: random.uniform(40.0, 150.0),
        viscous: random.uniform(100.0, 600.0),
        coulomb: random.uniform(10.0, 50.0),
        offset: random.uniform(-20.0, 20.0),
        ..Axis::PLAIN
    }
}

pub(crate) fn motion(random: &mut Random) -> Motion {
    let stroke = random.uniform(0.08, 0.3);
    if random.uniform(0.0, 1.0) < 0.5 {
        Motion::sines(12_000, stroke, random)
    } else {
        Motion::strokes(12_000, stroke, random)
    }
}

fn sensors(random: &mut Random) -> Sensors {
    Sensors {
        force: random.uniform(0.5, 8.0),
        step: 1e-6,
    }
}

/// A plain axis, with what this makes of its force and motion.
fn changed(random: &mut Random, change: impl Fn(&mut Vec<f64>, &mut Motion)) -> Word {
    let (axis, mut motion, sensors) = (axis(random), motion(random), sensors(random));
    let mut force = axis.force(&motion);
    change(&mut force, &mut motion);
    rigid_word(recorded(&force, &motion.position, sensors, random))
}

/// An axis with another force.
fn other(random: &mut Random, with: impl Fn(Axis, f64) -> Axis) -> Word {
    let (plain, motion, sensors) = (axis(random), motion(random), sensors(random));
    let squares: f64 = plain.force(&motion).iter().map(|f| f * f).sum();
    let rms = (squares / motion.position.len() as f64).sqrt();
    let force = with(plain, rms).force(&motion);
    rigid_word(recorded(&force, &motion.position, sensors, random))
}

fn rms(x: &[f64]) -> f64 {
    (x.iter().map(|x| x * x).sum::<f64>() / x.len() as f64).sqrt()
}

/// Position and speed of one motion, of which one has another unit or rate.
fn two_columns(random: &mut Random, factor: f64) -> Word {
    let (axis, motion, sensors) = (axis(random), motion(random), sensors(random));
    let force = axis.force(&motion);
    let mut recording = recorded(&force, &motion.position, sensors, random);
    let speed = motion.velocity.iter().map(|v| factor * v).collect();
    let more = crate::simulated::recording(Vec::new(), speed, Quantity::Velocity);
    recording.signals.extend(more.signals.into_iter().skip(1));
    rigid_word(recording)
}

/// A torque with power up to 200 Hz.
pub(crate) fn torque(samples: usize, random: &mut Random) -> Vec<f64> {
    let lines: Vec<[f64; 2]> = (0..400)
        .map(|k| [0.5 * f64::from(k + 2), random.uniform(0.0, TAU)])
        .collect();
    (0..samples)
        .map(|k| {
            let t = k as f64 * PERIOD_S;
            lines
                .iter()
                .map(|[hz, phase]| 0.1 * libm::cos(TAU * hz * t + phase))
                .sum()
        })
        .collect()
}

fn accelerated(
    plant: &TransferFunction,
    torque: &[f64],
    noise: f64,
    random: &mut Random,
) -> Vec<f64> {
    let clean = simulate(plant, Measured::Direct, PERIOD_S, torque).unwrap();
    let noise = noise * rms(&clean);
    clean.iter().map(|a| a + noise * random.normal()).collect()
}

/// A flexible axis that is recorded for eight seconds.
fn flexible_case(random: &mut Random, change: impl Fn(&mut TransferFunction)) -> Recording {
    let mut plant = plant(random);
    change(&mut plant);
    let torque = torque(8000, random);
    let motion = accelerated(&plant, &torque, 0.03, random);
    recording(torque, motion, Quantity::Acceleration)
}

/// A kind of recording, and what comes of one of it.
type Kind = (&'static str, fn(&mut Random) -> Word);

const WRONG: [Kind; 20] = [
    ("reversed", |random| {
        changed(random, |force, _| force.iter_mut().for_each(|f| *f = -*f))
    }),
    ("speed in other units", |random| two_columns(random, 1e-3)),
    ("position at another rate", |random| {
        two_columns(random, 2.0)
    }),
    ("force of another axis", |random| {
        let (other, axis) = (axis(random), motion(random));
        let force = other.force(&axis);
        changed(random, |slot, _| slot.clone_from(&force))
    }),
    ("force 30 ms late", |random| {
        changed(random, |force, _| force.rotate_right(30))
    }),
    ("cogging", |random| {
        other(random, |axis, rms| Axis {
            cogging: Some([0.012, 0.4 * rms]),
            ..axis
        })
    }),
    ("backlash", |random| {
        other(random, |axis, _| Axis {
            backlash: Some([0.003, 0.7]),
            ..axis
        })
    }),
    ("force cut off in the recording", |random| {
        let (axis, motion) = (axis(random), motion(random));
        let force = axis.force(&motion);
        let limit = 1.2 * rms(&force);
        let force: Vec<f64> = force.iter().map(|f| f.clamp(-limit, limit)).collect();
        let none = Sensors {
            force: 0.0,
            step: 1e-6,
        };
        rigid_word(recorded(&force, &motion.position, none, random))
    }),
    ("force beyond what the drive gives", |random| {
        let (axis, motion, sensors) = (axis(random), motion(random), sensors(random));
        let wanted: Vec<f64> = axis.force(&motion).iter().map(|f| 1.3 * f).collect();
        let limit = rms(&wanted);
        let given: Vec<f64> = wanted.iter().map(|f| f.clamp(-limit, limit)).collect();
        rigid_word(recorded(&wanted, &axis.moved_by(&given), sensors, random))
    }),
    ("negative viscous friction", |random| {
        other(random, |axis, _| Axis {
            viscous: -axis.viscous,
            ..axis
        })
    }),
    ("0.1 s", |random| {
        changed(random, |force, motion| {
            force.truncate(100);
            motion.position.truncate(100);
        })
    }),
    ("a spring", |random| {
        changed(random, |force, motion| {
            let (force_rms, x_rms) = (rms(force), rms(&motion.position));
            for (f, x) in force.iter_mut().zip(&motion.position) {
                *f += 0.7 * force_rms / x_rms * x;
            }
        })
    }),
    ("position named speed", |random| {
        let (axis, motion) = (axis(random), motion(random));
        rigid_word(recording(
            axis.force(&motion),
            motion.position,
            Quantity::Velocity,
        ))
    }),
    ("a resonance at 15 Hz, rigid", |random| {
        let torque = torque(12_000, random);
        let plant = TransferFunction {
            gain: 50.0,
            zeros: vec![pair(random.uniform(8.0, 18.0), 0.03)],
            poles: vec![pair(random.uniform(20.0, 26.0), 0.04)],
            delay_s: 0.0,
        };
        let motion = accelerated(&plant, &torque, 0.02, random);
        rigid_word(recording(torque, motion, Quantity::Acceleration))
    }),
    ("friction that grows with the square", |random| {
        changed(random, |force, motion| {
            let (force_rms, v_rms) = (rms(force), rms(&motion.velocity));
            for (f, v) in force.iter_mut().zip(&motion.velocity) {
                *f -= 0.9 * force_rms * v * v.abs() / (v_rms * v_rms);
            }
        })
    }),
    ("flexible: reversed", |random| {
        let mut recording = flexible_case(random, |_| {});
        recording.reverse();
        flexible_word(&recording, None)
    }),
    ("flexible: too few poles", |random| {
        flexible_word(&flexible_case(random, |_| {}), Some(2))
    }),
    ("flexible: negative damping", |random| {
        let recording = flexible_case(random, |plant| {
            if let Some(Factor::Pair { damping, .. }) = plant.zeros.first_mut() {
                *damping = -0.05;
            }
        });
        flexible_word(&recording, None)
    }),
    ("flexible: another axis", |random| {
        let own = flexible_case(random, |_| {});
        let mut other = flexible_case(random, |_| {});
        other.signals.truncate(1);
        other.signals.extend(own.signals.into_iter().skip(1));
        flexible_word(&other, None)
    }),
    ("flexible: 0.3 s, noisy", |random| {
        let plant = plant(random);
        let torque = torque(300, random);
        let motion = accelerated(&plant, &torque, 0.5, random);
        flexible_word(&recording(torque, motion, Quantity::Acceleration), None)
    }),
];

fn right(seed: u64) -> (&'static str, Word) {
    let mut random = Random(1000 + seed);
    if seed.is_multiple_of(2) {
        ("rigid", changed(&mut random, |_, _| {}))
    } else {
        let recording = flexible_case(&mut random, |_| {});
        ("flexible", flexible_word(&recording, None))
    }
}

/// What came of each kind, as counts of words.
type Table = BTreeMap<&'static str, BTreeMap<Word, usize>>;

fn table(cases: usize, case: impl Fn(usize) -> (&'static str, Word) + Sync) -> Table {
    let mut table = Table::new();
    for (kind, word) in in_two_threads(cases, case) {
        *table.entry(kind).or_default().entry(word).or_default() += 1;
    }
    for (kind, words) in &table {
        println!("{kind}: {words:?}");
    }
    table
}

fn good(table: &Table) -> usize {
    table.values().filter_map(|words| words.get("good")).sum()
}

/// Some of the cases, always.
#[test]
fn some_wrong_recordings_are_not_good() {
    let found = table(15, |index| {
        let (kind, case) = WRONG[index];
        (kind, case(&mut Random(7 + index as u64)))
    });
    assert_eq!(good(&found), 0, "{found:?}");
}

#[test]
#[ignore = "minutes"]
fn no_wrong_recording_is_good() {
    let found = table(10 * WRONG.len(), |index| {
        let (kind, case) = WRONG[index % WRONG.len()];
        (kind, case(&mut Random(index as u64)))
    });
    assert_eq!(good(&found), 0, "{found:?}");
}

#[test]
#[ignore = "minutes"]
fn right_recordings_are_good() {
    let found = table(200, |index| right(index as u64));
    assert!(good(&found) >= 196, "{found:?}");
}
