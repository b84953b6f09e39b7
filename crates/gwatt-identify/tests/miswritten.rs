//! Recordings of which a column is not what its name says: swapped, late, held, cut to pieces,
//! counted in too few bits. None may be called good with a mass that is wrong.

use gwatt_identify::flexible::{self, Choice, Method};
use gwatt_identify::{
    Figure, Given, Judgement, Kind, Measured, Quantity, Recording, Signal, judgement, rigid,
    simulate,
};

use crate::simulated::{PERIOD_S, Random, in_two_threads, plant, wanted};
use crate::sweep;

use Quantity::{Acceleration, Force, Position, Velocity};

/// All signals of an axis, sample by sample.
pub(crate) struct Columns {
    pub(crate) force: Vec<f64>,
    pub(crate) position: Vec<f64>,
    pub(crate) velocity: Vec<f64>,
    pub(crate) acceleration: Vec<f64>,
}

/// What came of a recording.
pub(crate) struct Outcome {
    pub(crate) word: String,
    /// Found mass, and the true one.
    pub(crate) mass: Option<(Figure, f64)>,
    /// The same of viscous friction.
    pub(crate) viscous: Option<(Figure, f64)>,
}

impl Outcome {
    fn is_off(found: Option<(Figure, f64)>, share: f64) -> bool {
        found.is_some_and(|(figure, truth)| {
            let apart = (figure.value - truth).abs();
            apart > 2.0 * figure.std && apart > share * truth.abs()
        })
    }

    /// Whether it is called good with a mass that is off by more than it says, and by 5 %.
    pub(crate) fn misleads(&self) -> bool {
        self.word == "good" && Self::is_off(self.mass, 0.05)
    }

    /// The same of viscous friction, and 20 %.
    pub(crate) fn misleads_on_friction(&self) -> bool {
        self.word == "good" && Self::is_off(self.viscous, 0.2)
    }
}

impl Columns {
    fn of(&self, quantity: Quantity) -> &[f64] {
        match quantity {
            Position => &self.position,
            Velocity => &self.velocity,
            Acceleration => &self.acceleration,
            _ => &self.force,
        }
    }

    fn all(&mut self) -> [&mut Vec<f64>; 4] {
        [
            &mut self.force,
            &mut self.position,
            &mut self.velocity,
            &mut self.acceleration,
        ]
    }

    /// A recording of the force and these of its motion, with noise and steps of sensors.
    pub(crate) fn recorded(
        &self,
        seen: &[Quantity],
        noise: [f64; 4],
        random: &mut Random,
    ) -> Recording {
        let [force, position, velocity, acceleration] = noise;
        let mut signals = Vec::new();
        for quantity in [Force].iter().chain(seen) {
            let mut values = self.of(*quantity).to_vec();
            for value in &mut values {
                *value = match quantity {
                    Position => position * libm::round(*value / position),
                    Velocity => *value + velocity * random.normal(),
                    Acceleration => *value + acceleration * random.normal(),
                    _ => *value + force * random.normal(),
                };
            }
            signals.push(Signal {
                name: format!("{quantity:?}"),
                quantity: *quantity,
                kind: Kind::Linear,
                values,
            });
        }
        let shortest = signals.iter().map(|signal| signal.values.len()).min();
        for signal in &mut signals {
            signal.values.truncate(shortest.unwrap_or_default());
        }
        Recording {
            period_s: PERIOD_S,
            signals,
            ignored: Vec::new(),
            notes: Vec::new(),
        }
    }
}

/// What is done to the columns, and which motion they show then.
type Kinds = (
    &'static str,
    &'static [&'static [Quantity]],
    fn(&mut Columns, &mut Random),
);

const ANY: &[&[Quantity]] = &[&[Position], &[Velocity], &[Position, Velocity]];
const ONE: &[&[Quantity]] = &[&[Position], &[Velocity]];

/// A first-order lag of so many samples.
fn lagged(x: &mut [f64], samples: f64) {
    let share = 1.0 - libm::exp(-1.0 / samples);
    let mut state = x.first().copied().unwrap_or_default();
    for value in x {
        state += share * (*value - state);
        *value = state;
    }
}

/// Three to eight places, and how many samples from there on.
fn blocks(samples: usize, random: &mut Random) -> Vec<(usize, usize)> {
    let count = random.uniform(3.0, 9.0) as usize;
    let mut found: Vec<(usize, usize)> = (0..count)
        .map(|_| {
            let at = random.uniform(0.05, 0.9) * samples as f64;
            (at as usize, random.uniform(10.0, 200.0) as usize)
        })
        .collect();
    found.sort_by_key(|(at, _)| std::cmp::Reverse(*at));
    found
}

fn late(x: &mut Vec<f64>, samples: f64) {
    let by = samples as usize;
    let first = x.first().copied().unwrap_or_default();
    x.splice(0..0, std::iter::repeat_n(first, by));
    x.truncate(x.len() - by);
}

fn early(x: &mut Vec<f64>, samples: f64) {
    let by = samples as usize;
    let last = x.last().copied().unwrap_or_default();
    x.drain(..by);
    x.extend(std::iter::repeat_n(last, by));
}

fn wrapped(x: &mut [f64], share: f64) {
    let most = x.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let end = share * most;
    for value in x {
        *value = (*value + end).rem_euclid(2.0 * end) - end;
    }
}

fn held(x: &mut [f64], samples: usize) {
    for run in x.chunks_mut(samples) {
        let first = run[0];
        run.fill(first);
    }
}

const WRONG: &[Kinds] = &[
    (
        "force and speed swapped",
        &[&[Velocity], &[Position, Velocity]],
        |it, _| {
            std::mem::swap(&mut it.force, &mut it.velocity);
        },
    ),
    ("force and position swapped", &[&[Position]], |it, _| {
        std::mem::swap(&mut it.force, &mut it.position);
    }),
    ("position given as speed", &[&[Velocity]], |it, _| {
        it.velocity.clone_from(&it.position);
    }),
    ("speed given as position", &[&[Position]], |it, _| {
        it.position.clone_from(&it.velocity);
    }),
    ("force after a lag", ANY, |it, random| {
        lagged(&mut it.force, random.uniform(2.0, 10.0));
    }),
    ("force late", ANY, |it, random| {
        late(&mut it.force, random.uniform(2.0, 11.0));
    }),
    ("force early, as set", ANY, |it, random| {
        early(&mut it.force, random.uniform(2.0, 11.0));
    }),
    (
        "speed after a lag",
        &[&[Velocity], &[Position, Velocity]],
        |it, random| {
            lagged(&mut it.velocity, random.uniform(2.0, 10.0));
        },
    ),
    (
        "speed late",
        &[&[Velocity], &[Position, Velocity]],
        |it, random| {
            late(&mut it.velocity, random.uniform(2.0, 11.0));
        },
    ),
    ("position early, as set", ONE, |it, random| {
        let samples = random.uniform(15.0, 50.0);
        for column in [&mut it.force, &mut it.velocity] {
            lagged(column, samples);
        }
    }),
    ("blocks left out", ANY, |it, random| {
        for (at, count) in blocks(it.force.len(), random) {
            for column in it.all() {
                let end = (at + count).min(column.len());
                column.drain(at.min(end)..end);
            }
        }
    }),
    ("blocks of the force left out", ANY, |it, random| {
        for (at, count) in blocks(it.force.len(), random) {
            let end = (at + count).min(it.force.len());
            it.force.drain(at.min(end)..end);
        }
    }),
    ("blocks twice", ANY, |it, random| {
        for (at, count) in blocks(it.force.len(), random) {
            for column in it.all() {
                let end = (at + count).min(column.len());
                let block = column[at.min(end)..end].to_vec();
                column.splice(end..end, block);
            }
        }
    }),
    (
        "position in too few bits",
        &[&[Position], &[Position, Velocity]],
        |it, random| {
            wrapped(&mut it.position, random.uniform(0.3, 0.95));
        },
    ),
    ("force in too few bits", ANY, |it, random| {
        wrapped(&mut it.force, random.uniform(0.4, 0.95));
    }),
    ("force at a slower rate", ANY, |it, random| {
        held(&mut it.force, random.uniform(4.0, 25.0) as usize);
    }),
    ("motion at a slower rate", ONE, |it, random| {
        let samples = random.uniform(4.0, 25.0) as usize;
        for column in it.all().into_iter().skip(1) {
            held(column, samples);
        }
    }),
    ("force without its sign", ANY, |it, _| {
        it.force.iter_mut().for_each(|force| *force = force.abs());
    }),
    ("speed without its sign", &[&[Velocity]], |it, _| {
        it.velocity
            .iter_mut()
            .for_each(|speed| *speed = speed.abs());
    }),
    ("spikes of the force", ANY, |it, random| {
        let most = it.force.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        for _ in 0..40 {
            let at = random.uniform(0.0, it.force.len() as f64) as usize;
            it.force[at] = 5.0 * most;
        }
    }),
];

pub(crate) fn rigid_columns(random: &mut Random) -> (Columns, [f64; 2]) {
    let (axis, motion) = (sweep::axis(random), sweep::motion(random));
    let columns = Columns {
        force: axis.force(&motion),
        position: motion.position,
        velocity: motion.velocity,
        acceleration: motion.acceleration,
    };
    (columns, [axis.mass, axis.viscous])
}

pub(crate) fn rigid_outcome(recording: Recording, [mass, viscous]: [f64; 2]) -> Outcome {
    match rigid::fit_all(&[recording], None, None) {
        Ok(found) => Outcome {
            word: judgement::rigid(&found).word().to_owned(),
            mass: Some((found.mass, mass)),
            viscous: found.viscous.map(|b| (b, viscous)),
        },
        Err(trouble) => refused(&trouble.message),
    }
}

fn refused(message: &str) -> Outcome {
    Outcome {
        word: format!("refused: {}", message.chars().take(40).collect::<String>()),
        mass: None,
        viscous: None,
    }
}

pub(crate) fn flexible_outcome(
    recording: &Recording,
    method: Method,
    [mass, viscous]: [f64; 2],
) -> Outcome {
    let choice = Choice {
        method,
        given: Given::default(),
        from_command: false,
    };
    match flexible::identify(recording, &choice) {
        Ok(found) => Outcome {
            word: judgement::flexible(&found).word().to_owned(),
            mass: found.inertia.map(|j| (j, mass)),
            viscous: found.viscous.map(|b| (b, viscous)),
        },
        Err(trouble) => refused(&trouble.message),
    }
}

fn as_rigid(kind: &Kinds, random: &mut Random) -> Outcome {
    let (mut columns, truth) = rigid_columns(random);
    (kind.2)(&mut columns, random);
    let seen = kind.1[random.uniform(0.0, kind.1.len() as f64) as usize];
    let noise = [random.uniform(0.5, 8.0), 1e-6, 1e-4, 0.01];
    rigid_outcome(columns.recorded(seen, noise, random), truth)
}

fn rms(x: &[f64]) -> f64 {
    (x.iter().map(|x| x * x).sum::<f64>() / x.len() as f64).sqrt()
}

fn summed(x: &[f64]) -> Vec<f64> {
    let mut sum = 0.0;
    let each = x.iter().map(|x| {
        sum += PERIOD_S * x;
        sum
    });
    each.collect()
}

fn as_flexible(kind: &Kinds, method: Method, random: &mut Random) -> Outcome {
    let plant = plant(random);
    let force = sweep::torque(8000, random);
    // Of a speed or position differences are simulated.
    let moved = |measured| simulate(&plant, measured, PERIOD_S, &force).unwrap();
    let mut columns = Columns {
        position: summed(&summed(&moved(Measured::Position))),
        velocity: summed(&moved(Measured::Velocity)),
        acceleration: moved(Measured::Direct),
        force,
    };
    let noise = [
        1e-9,
        1e-6 * rms(&columns.position),
        1e-4 * rms(&columns.velocity),
        0.03 * rms(&columns.acceleration),
    ];
    (kind.2)(&mut columns, random);
    let mut choices = vec![kind.1[random.uniform(0.0, kind.1.len() as f64) as usize]];
    if kind.1 == ANY {
        choices.push(&[Acceleration]);
    }
    let seen = choices[random.uniform(0.0, choices.len() as f64) as usize];
    let recording = columns.recorded(seen, noise, random);
    flexible_outcome(&recording, method, [1.0 / plant.gain, 0.0])
}

const METHODS: [(&str, Case<Kinds>); 5] = [
    ("rigid", as_rigid),
    ("iv", |kind, random| as_flexible(kind, Method::Iv, random)),
    ("frequency", |kind, random| {
        as_flexible(kind, Method::Frequency, random)
    }),
    ("arx", |kind, random| as_flexible(kind, Method::Arx, random)),
    ("subspace", |kind, random| {
        as_flexible(kind, Method::Subspace, random)
    }),
];

/// How a method identifies a case of a kind.
pub(crate) type Case<Kind> = fn(&Kind, &mut Random) -> Outcome;

/// How many cases of these kinds mislead, by those of the methods that `GWATT_METHODS` names,
/// else by `methods`; `named` gives the name of a kind, and `seed` that of the random numbers.
pub(crate) fn misled<Kind: Sync>(
    cases: &[(&str, Case<Kind>)],
    methods: &str,
    kinds: &[Kind],
    named: fn(&Kind) -> &str,
    seed: fn(u64) -> u64,
) -> usize {
    let methods = std::env::var("GWATT_METHODS").unwrap_or_else(|_| methods.to_owned());
    let seeds = wanted(10);
    let mut misled = 0;
    for (name, case) in cases.iter().filter(|(name, _)| methods.contains(name)) {
        for kind in kinds {
            let found = in_two_threads(seeds.clone().count(), |index| {
                case(kind, &mut Random(seed(seeds.start + index as u64)))
            });
            println!("{name}, {}", line(named(kind), &found));
            misled += found.iter().filter(|it| it.misleads()).count();
        }
    }
    misled
}

/// A line of what came of cases of a kind.
fn line(kind: &str, found: &[Outcome]) -> String {
    let mut words = std::collections::BTreeMap::new();
    for outcome in found {
        *words.entry(outcome.word.as_str()).or_insert(0) += 1;
    }
    let count = |test: fn(&Outcome) -> bool| found.iter().filter(|it| test(it)).count();
    let worst: Vec<String> = found
        .iter()
        .filter(|it| it.misleads() || it.misleads_on_friction())
        .filter_map(|it| it.mass)
        .map(|(mass, truth)| format!("{:.3}±{:.3}", mass.value / truth, mass.std / truth))
        .collect();
    let [by_mass, by_friction] = [
        count(Outcome::misleads),
        count(Outcome::misleads_on_friction),
    ];
    format!("{kind}: MASS {by_mass} FRICTION {by_friction} {words:?} {worst:?}")
}

#[test]
#[ignore = "minutes"]
fn columns_that_are_something_else_are_not_good() {
    let found = misled(&METHODS, "rigid", WRONG, |kind| kind.0, |it| 31 * it + 5);
    assert_eq!(found, 0);
}

/// A force after a lag of 6 ms on a plain axis.
#[test]
fn a_force_that_is_late_is_out_of_step() {
    let mut random = Random(5);
    let (mut columns, truth) = rigid_columns(&mut random);
    lagged(&mut columns.force, 6.0);
    let recording = columns.recorded(&[Position], [1.0, 1e-6, 0.0, 0.0], &mut random);
    let found = rigid::fit_all(std::slice::from_ref(&recording), None, None).unwrap();
    assert_eq!(rigid_outcome(recording, truth).word, "out of step");
    // The other way round: forces act earlier than they were recorded.
    let late_s = found.out_of_step_s.unwrap();
    assert!((late_s.value + 6e-3).abs() < 1e-3, "{late_s:?}");
    assert_eq!(found.lateness_s, None);
    let of = |late_s| Judgement::OutOfStep { late_s }.to_string();
    assert_eq!(
        of(-0.006),
        "out of step: the force belongs to motion 6.0 ms earlier, more than a drive that samples makes of it; record the actual force and motion at the same time, without filters"
    );
    assert_eq!(of(0.006), of(-0.006).replace("earlier", "later"));
}

/// What no recording shows: half of the force gives half of the mass, and all else is as it was.
#[test]
fn a_scale_of_the_force_is_not_seen() {
    let mut random = Random(8);
    let (mut columns, [mass, _]) = rigid_columns(&mut random);
    columns.force.iter_mut().for_each(|force| *force *= 0.5);
    let recording = columns.recorded(&[Position], [1.0, 1e-6, 0.0, 0.0], &mut random);
    let found = rigid::fit_all(&[recording], None, None).unwrap();
    assert_eq!(judgement::rigid(&found).word(), "good");
    assert!(
        (found.mass.value / mass - 0.5).abs() < 0.01,
        "{:?}",
        found.mass
    );
}
