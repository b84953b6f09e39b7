//! Whether figures of swinging tables are as sure as they say: by cells of frequency,
//! damping, friction, delay and encoder.

use std::env;
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::ops::Range;

use gwatt_identify::flexible::{self, Choice, Flexible, Method, Root};
use gwatt_identify::{Figure, Given, Judgement, Quantity, judgement};

use crate::simulated::{Random, wanted};
use crate::swinging::{FINE, Sensor, Swing, Table};

/// What the tables of a cell have in common.
struct Cell {
    name: &'static str,
    swings: usize,
    /// Of the lowest zero, Hz.
    hz: [f64; 2],
    damping: [f64; 2],
    viscous: f64,
    coulomb: f64,
    /// Delay in steps of the simulation.
    late: usize,
    sensor: Sensor,
    excitation: f64,
    /// Of the recorded force, N.
    noise: f64,
    /// What the drive gives at most, N.
    limit: f64,
}

const PLAIN: Cell = Cell {
    name: "",
    swings: 1,
    hz: [25.0, 60.0],
    damping: [0.01, 0.05],
    viscous: 0.0,
    coulomb: 0.0,
    late: 0,
    sensor: Sensor::Position(1e-6),
    excitation: 20.0,
    noise: 0.0,
    limit: f64::INFINITY,
};

const CELLS: [Cell; 18] = [
    Cell {
        name: "10-25 Hz",
        hz: [10.0, 25.0],
        ..PLAIN
    },
    Cell {
        name: "25-60 Hz",
        ..PLAIN
    },
    Cell {
        name: "60-150 Hz",
        hz: [60.0, 150.0],
        sensor: Sensor::Position(1e-7),
        ..PLAIN
    },
    Cell {
        name: "150-300 Hz",
        hz: [150.0, 260.0],
        sensor: Sensor::Position(1e-7),
        ..PLAIN
    },
    Cell {
        name: "damping 0.003-0.006",
        damping: [0.003, 0.006],
        ..PLAIN
    },
    Cell {
        name: "damping 0.05-0.1",
        damping: [0.05, 0.1],
        sensor: Sensor::Position(1e-7),
        ..PLAIN
    },
    Cell {
        name: "two",
        swings: 2,
        hz: [15.0, 40.0],
        ..PLAIN
    },
    Cell {
        name: "three",
        swings: 3,
        hz: [15.0, 35.0],
        sensor: Sensor::Position(1e-7),
        ..PLAIN
    },
    Cell {
        name: "viscous",
        viscous: 300.0,
        ..PLAIN
    },
    Cell {
        name: "Coulomb",
        viscous: 300.0,
        coulomb: 25.0,
        ..PLAIN
    },
    Cell {
        name: "two, Coulomb",
        swings: 2,
        hz: [15.0, 40.0],
        viscous: 300.0,
        coulomb: 25.0,
        ..PLAIN
    },
    Cell {
        name: "2 periods late",
        late: 2 * FINE,
        ..PLAIN
    },
    Cell {
        name: "1.5 periods late",
        late: 3 * FINE / 2,
        ..PLAIN
    },
    Cell {
        name: "10 µm",
        hz: [10.0, 30.0],
        sensor: Sensor::Position(1e-5),
        ..PLAIN
    },
    Cell {
        name: "speed",
        sensor: Sensor::Speed(1e-4),
        ..PLAIN
    },
    Cell {
        name: "speed, Coulomb",
        viscous: 300.0,
        coulomb: 25.0,
        sensor: Sensor::Speed(1e-4),
        ..PLAIN
    },
    Cell {
        name: "mean speed",
        sensor: Sensor::MeanSpeed(1e-6),
        ..PLAIN
    },
    Cell {
        name: "clipped and noisy",
        noise: 0.2,
        limit: 30.0,
        ..PLAIN
    },
];

const SAMPLES: usize = 16_000;
/// Recordings of a table.
const OF_ONE: u64 = 10;
/// What cannot be known to this share at best says nothing of errors.
const KNOWN: f64 = 0.2;

impl Cell {
    fn table(&self, random: &mut Random) -> Table {
        let mut hz = random.uniform(self.hz[0], self.hz[1]);
        let mut damping = || random.uniform(self.damping[0], self.damping[1]);
        let dampings: Vec<[f64; 2]> = (0..self.swings).map(|_| [damping(), damping()]).collect();
        let mut swings = Vec::new();
        for [zero, pole] in dampings {
            let above = hz * random.uniform(1.15, 1.35);
            swings.push(Swing {
                zero: [hz, zero],
                pole: [above, pole],
            });
            hz = above * random.uniform(1.3, 1.6);
        }
        Table {
            mass: random.uniform(15.0, 40.0),
            swings,
            viscous: self.viscous,
            coulomb: self.coulomb,
            late: self.late,
            limit: self.limit,
        }
    }
}

/// Errors of one cell.
#[derive(Default)]
struct Sums {
    inside: usize,
    all: usize,
    squares: f64,
    /// The same of recordings that are called good.
    good_inside: usize,
    good_all: usize,
    good_squares: f64,
    missing: usize,
    good: usize,
    recordings: usize,
}

/// Frequencies and dampings of the root nearest to this one.
fn nearest(roots: &[&Root], hz: f64) -> [Option<Figure>; 2] {
    let far = |root: &&&Root| libm::log(root.omega_rad_s.value / TAU / hz).abs();
    let near = roots.iter().min_by(|a, b| far(a).total_cmp(&far(b)));
    let found = near.filter(|root| far(root) < 0.08);
    let in_hz = |figure: Figure| Figure {
        value: figure.value / TAU,
        std: figure.std / TAU,
    };
    [
        found.map(|root| in_hz(root.omega_rad_s)),
        found.map(|root| root.damping),
    ]
}

/// What was found for each figure of a table.
fn found_of(table: &Table, found: &Flexible) -> Vec<Option<Figure>> {
    let zeros: Vec<&Root> = found.zeros.iter().chain(&found.unclear_zeros).collect();
    let poles: Vec<&Root> = found.poles.iter().collect();
    let mut out = vec![found.inertia];
    for swing in &table.swings {
        out.extend(nearest(&zeros, swing.zero[0]));
        out.extend(nearest(&poles, swing.pole[0]));
    }
    if table.viscous > 0.0 {
        out.push(found.viscous);
    }
    if table.coulomb > 0.0 {
        out.push(found.coulomb);
    }
    out
}

impl Sums {
    fn add(&mut self, table: &Table, bounds: &[f64], found: Option<&Flexible>, seed: u64) {
        self.recordings += 1;
        let verdict = found.map(judgement::flexible);
        let is_good = verdict == Some(Judgement::Good);
        self.good += usize::from(is_good);
        let figures = found.map_or(Vec::new(), |found| found_of(table, found));
        let is_loud = env::var_os("GWATT_LOUD").is_some();
        let mut line = String::new();
        for (index, (truth, bound)) in table.figures().into_iter().zip(bounds).enumerate() {
            if *bound > KNOWN * truth {
                continue;
            }
            let Some(figure) = figures.get(index).copied().flatten() else {
                self.missing += 1;
                line += " -";
                continue;
            };
            let (error, std) = (figure.value - truth, figure.std);
            let is_inside = error.abs() <= 2.0 * std;
            let square = (error / bound) * (error / bound);
            let _ = write!(line, " {:.2}/{:.2}", error / bound, std / bound);
            self.all += 1;
            self.inside += usize::from(is_inside);
            self.squares += square;
            if is_good {
                self.good_all += 1;
                self.good_inside += usize::from(is_inside);
                self.good_squares += square;
            }
        }
        if is_loud {
            println!("  {seed}: {:?}{line}", verdict.map(Judgement::word));
            if let Some(found) = found {
                println!(
                    "    left {:.4}, of which {:.4} missed, energy {:.1}; white {:.2}, steady {:.2} of their limits; leak {} and {} taps",
                    found.rel_error,
                    found.missed_share,
                    found.missed_energy,
                    found.whiteness.statistic / found.whiteness.limit,
                    found.steadiness.statistic / found.steadiness.limit,
                    found.leak,
                    found.noise_order,
                );
                let shares = figures.iter().flatten().map(|it| it.std / it.value);
                println!("    {:.4?}", shares.collect::<Vec<_>>());
            }
        }
    }

    fn line(&self, name: &str) -> String {
        let of = |part: usize, all: usize| 100.0 * part as f64 / all.max(1) as f64;
        let rms = |squares: f64, all: usize| (squares / all.max(1) as f64).sqrt();
        format!(
            "{name:22} {:5.1} % of {:4} inside, rms {:6.2} bounds; good {:5.1} %: {:5.1} % inside, rms {:5.2}; missing {}",
            of(self.inside, self.all),
            self.all,
            rms(self.squares, self.all),
            of(self.good, self.recordings),
            of(self.good_inside, self.good_all),
            rms(self.good_squares, self.good_all),
            self.missing,
        )
    }
}

fn sums(cell: &Cell, seeds: Range<u64>) -> Sums {
    let mut sums = Sums::default();
    for plant in seeds.start / OF_ONE..seeds.end.div_ceil(OF_ONE) {
        let table = cell.table(&mut Random(7000 + plant));
        let mut bounds = Vec::new();
        let (first, end) = (plant * OF_ONE, (plant + 1) * OF_ONE);
        for seed in seeds.start.max(first)..seeds.end.min(end) {
            let mut random = Random(100 + seed);
            let recording = table.recorded(
                SAMPLES,
                (cell.excitation, cell.noise, cell.sensor),
                &mut random,
            );
            if bounds.is_empty() {
                let force = recording.get(Quantity::Force).unwrap();
                bounds = table.bounds(&force.values, cell.sensor);
            }
            let choice = Choice {
                method: Method::Iv,
                given: Given::default(),
                from_command: false,
            };
            let found = flexible::identify(&recording, &choice);
            sums.add(&table, &bounds, found.ok().as_ref(), seed);
        }
    }
    sums
}

/// The least share of figures within two standard errors: chance alone leaves 93 % once in a
/// hundred times below this, of so many.
fn least_share(all: usize) -> f64 {
    0.93 - 2.33 * (0.93 * 0.07 / all.max(1) as f64).sqrt()
}

/// In each cell figures are within two of their standard errors as often as they must be, and
/// none is missing. `GWATT_CELL` names one cell, `GWATT_CASES` which recordings (as in `20..40`),
/// `GWATT_LOUD` prints errors and standard errors of each in units of the bound.
#[test]
#[ignore = "minutes: cargo test --release -p gwatt-identify -- --ignored --nocapture as_sure_as"]
fn figures_are_as_sure_as_they_say() {
    let named = env::var("GWATT_CELL").ok();
    let seeds = wanted(60);
    let mut wrong = Vec::new();
    for cell in CELLS {
        if named.as_ref().is_some_and(|name| name != cell.name) {
            continue;
        }
        let sums = sums(&cell, seeds.clone());
        println!("{}", sums.line(cell.name));
        let share = sums.inside as f64 / sums.all.max(1) as f64;
        if share < least_share(sums.all) || sums.missing > 0 {
            wrong.push(cell.name);
        }
    }
    assert!(wrong.is_empty(), "{wrong:?}");
}
