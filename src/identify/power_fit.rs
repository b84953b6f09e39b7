//! Parameters of the power model from a log of speeds, accelerations and the
//! drive's power.
//!
//! `P = v·(m·a + b·v + Fc·sign v)`, divided by the efficiency where it is
//! positive and multiplied where it is not, plus the standby power. Terms that
//! the log does not show are left out.

use std::io::Read;

use super::column::{Kind, Quantity, Reading, axis_of, read};
use super::normal::Normal;
use super::rigid::Figure;
use super::rows::{Rows, no_number};
use super::trouble::{Outcome, Trouble};

/// Rows at most.
const ROWS_MAX: usize = 50_000_000;

/// Speeds (m/s), accelerations (m/s²) and powers (W) of one axis.
#[derive(Debug, Clone, Default)]
pub struct PowerLog {
    /// Speeds.
    pub velocity: Vec<f64>,
    /// Accelerations.
    pub acceleration: Vec<f64>,
    /// Powers.
    pub power: Vec<f64>,
    /// Doubts about columns.
    pub notes: Vec<String>,
    /// Sliding or turning.
    pub rotary: bool,
}

/// A column that tells by itself whether its name is right.
#[derive(Debug, Default, Clone)]
struct Electrical {
    name: String,
    values: Vec<f64>,
}

/// The fitted power model; kg·m², N·m·s/rad and N·m where the axis turns.
#[derive(Debug, Clone, PartialEq)]
pub struct PowerModel {
    /// Mass or inertia.
    pub mass: Figure,
    /// Viscous friction.
    pub viscous: Figure,
    /// Coulomb friction.
    pub coulomb: Figure,
    /// Efficiency; 1 where the log shows no other.
    pub efficiency: f64,
    /// Power at rest, W; 0 where the log shows none.
    pub standby_w: Figure,
    /// Share of the power's square that the model explains: about the mean where
    /// there is a standby power, else about zero.
    pub r2: f64,
    /// The same about the mean, in any case.
    pub r2_centered: f64,
    /// Root of the mean square of what is left, W.
    pub rms_w: f64,
    /// Largest power measured, W.
    pub peak_measured_w: f64,
    /// Largest power of the model, W.
    pub peak_model_w: f64,
    /// By which factor measured peaks exceed the model's: the largest ratio where
    /// the model is above half of its peak; at least 1.
    pub peak_factor: f64,
    /// Rows.
    pub rows: usize,
}

/// Names whose units a maker fixes, after the axis letter and the number: those
/// of the SMART lab of the University of Michigan; mm, s, kW.
const KNOWN: [(&str, Quantity, f64); 3] = [
    ("actualvelocity", Quantity::Velocity, 1e-3),
    ("actualacceleration", Quantity::Acceleration, 1e-3),
    ("outputpower", Quantity::Power, 1e3),
];

/// `X1_ActualVelocity` as axis and `actualvelocity`.
fn numbered(name: &str) -> Option<(char, String)> {
    let (front, rest) = name.trim().split_once('_')?;
    let mut chars = front.chars();
    let letter = chars.next()?.to_ascii_uppercase();
    let digits = chars.as_str();
    (letter.is_ascii_alphabetic()
        && !digits.is_empty()
        && digits.chars().all(|c| c.is_ascii_digit()))
    .then(|| (letter, rest.to_ascii_lowercase()))
}

impl PowerLog {
    /// Adds the rows of a CSV file, for one axis. Rows without a value are
    /// passed over.
    ///
    /// # Errors
    ///
    /// When a column is missing or the file cannot be read.
    pub fn add(&mut self, input: impl Read, axis: char) -> Outcome<()> {
        let mut rows = Rows::open(input)?;
        let mut wanted: [Option<(usize, f64)>; 3] = [None; 3];
        let mut electrical: [Option<(usize, Electrical)>; 2] = [None, None];
        for (index, name) in rows.names.iter().enumerate() {
            let (slot, factor) = match self.meaning(name, axis)? {
                Some((Quantity::Velocity, factor)) => (0, factor),
                Some((Quantity::Acceleration, factor)) => (1, factor),
                Some((Quantity::Power, factor)) => (2, factor),
                _ => {
                    let found = electrical_slot(name, axis);
                    if let Some(place) = found.and_then(|slot| electrical.get_mut(slot)) {
                        let column = Electrical {
                            name: name.clone(),
                            values: Vec::new(),
                        };
                        *place = Some((index, column));
                    }
                    continue;
                }
            };
            if let Some(place) = wanted.get_mut(slot) {
                *place = Some((index, factor));
            }
        }
        let names = ["velocity_mm_s", "accel_mm_s2", "power_w"];
        for (place, name) in wanted.iter().zip(names) {
            if place.is_none() {
                return Err(Trouble::new(
                    format!("the log has no column {name} for axis {axis}"),
                    format!(
                        "name it {name} or {}_{name}; other units: see --help",
                        axis.to_ascii_lowercase()
                    ),
                ));
            }
        }
        while let Some(line) = rows.next_line()? {
            let mut row = [f64::NAN; 3];
            for ((slot, place), name) in row.iter_mut().zip(&wanted).zip(names) {
                let Some((index, factor)) = *place else {
                    continue;
                };
                let cell = rows.cell(index);
                match cell.parse::<f64>() {
                    Ok(value) => *slot = value * factor,
                    Err(_) if cell.is_empty() => {}
                    Err(_) => {
                        let name = rows.names.get(index).map_or(name, String::as_str);
                        return Err(no_number(line, name, cell));
                    }
                }
            }
            let [v, a, p] = row;
            if v.is_finite() && a.is_finite() && p.is_finite() {
                self.velocity.push(v);
                self.acceleration.push(a);
                self.power.push(p);
            }
            for (index, column) in electrical.iter_mut().flatten() {
                let cell = rows.cell(*index);
                column.values.push(cell.parse().unwrap_or(f64::NAN));
            }
            if self.power.len() > ROWS_MAX {
                return Err(Trouble::new(
                    format!("the log has more than {ROWS_MAX} rows"),
                    "cut it",
                ));
            }
        }
        if let [Some((_, current)), Some((_, voltage))] = &electrical
            && !self.notes.iter().any(|note| note.contains(&current.name))
        {
            self.notes.extend(swapped(current, voltage));
        }
        Ok(())
    }

    fn meaning(&mut self, name: &str, axis: char) -> Outcome<Option<(Quantity, f64)>> {
        if let Some((letter, rest)) = numbered(name) {
            let known = KNOWN.iter().find(|(word, _, _)| *word == rest);
            return Ok(known
                .filter(|_| letter == axis)
                .map(|(_, quantity, factor)| (*quantity, *factor)));
        }
        if axis_of(name).is_some_and(|letter| letter != axis) {
            return Ok(None);
        }
        match read(name) {
            Reading::Known(meaning) => {
                if meaning.quantity == Quantity::Velocity {
                    self.rotary = meaning.kind == Kind::Rotary;
                }
                Ok(Some((meaning.quantity, meaning.to_si)))
            }
            Reading::UnitInDoubt(
                quantity @ (Quantity::Velocity | Quantity::Acceleration | Quantity::Power),
            ) => Err(Trouble::new(
                format!("the unit of column {name} is in doubt"),
                format!(
                    "end its name with the unit, one of: {}",
                    super::column::units_of(quantity)
                ),
            )),
            _ => Ok(None),
        }
    }
}

/// Which of current and bus voltage a column says it is.
fn electrical_slot(name: &str, axis: char) -> Option<usize> {
    let rest = match numbered(name) {
        Some((letter, rest)) if letter == axis => rest,
        None if axis_of(name).is_none_or(|letter| letter == axis) => name.to_ascii_lowercase(),
        _ => return None,
    };
    let plain = rest.replace('_', "");
    if plain.contains("outputcurrent") || plain.contains("motorcurrent") {
        Some(0)
    } else if plain.contains("busvoltage") {
        Some(1)
    } else {
        None
    }
}

/// Notices a bus voltage that swings about zero next to a current that stands
/// still at hundreds.
fn swapped(current: &Electrical, voltage: &Electrical) -> Option<String> {
    let spread = |x: &[f64]| -> Option<(f64, f64)> {
        let sound: Vec<f64> = x.iter().copied().filter(|x| x.is_finite()).collect();
        let n = sound.len() as f64;
        let mean = sound.iter().sum::<f64>() / n;
        let square = sound.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / n;
        (n > 10.0 && mean.abs() > 0.0).then(|| (mean, square.sqrt() / mean.abs()))
    };
    let (amps, amps_spread) = spread(&current.values)?;
    let (volts, volts_spread) = spread(&voltage.values)?;
    let is_swapped =
        amps > 20.0 && amps_spread < 0.05 && volts_spread > 0.2 && volts.abs() < 0.2 * amps;
    is_swapped.then(|| {
        format!(
            "{} stands at {amps:.0} and hardly changes, as a bus voltage does, while {} changes with the load about {volts:.2}, as a current does: their names look swapped",
            current.name, voltage.name
        )
    })
}

/// One row: products whose factors are mass, viscous and Coulomb friction.
fn columns(v: f64, a: f64) -> [f64; 3] {
    [v * a, v * v, v.abs()]
}

/// Fits the power model.
///
/// # Errors
///
/// When the log does not determine it.
pub fn fit(log: &PowerLog) -> Outcome<PowerModel> {
    let n = log.power.len();
    if n < 50 {
        return Err(Trouble::new(
            format!("the log is too short: {n} rows"),
            "log at least some seconds of motion, with accelerations",
        ));
    }
    let weak = || {
        Trouble::new(
            "the log does not tell mass and friction apart: there is too little motion",
            "log rapids and feeds at several speeds, with starts and stops",
        )
    };
    let plain = solve(log, 1.0, false).ok_or_else(weak)?;
    let standby = solve(log, 1.0, true).ok_or_else(weak)?;
    let has_standby = standby
        .figures
        .get(3)
        .is_some_and(|s| s.value > 4.0 * s.std);
    let start = if has_standby { standby } else { plain };
    let best = (10..20)
        .map(|k| f64::from(k) * 0.05)
        .filter_map(|efficiency| solve(log, efficiency, has_standby))
        .min_by(|a, b| a.rest.total_cmp(&b.rest))
        .filter(|found| {
            // One parameter more must pay, and clearly.
            n as f64 * libm::log(start.rest / found.rest) > libm::log(n as f64) + 10.0
        })
        .unwrap_or(start);
    finish(log, &best, has_standby)
}

struct Solved {
    figures: Vec<Figure>,
    efficiency: f64,
    rest: f64,
}

impl Solved {
    fn value(&self, index: usize) -> f64 {
        self.figures.get(index).map_or(0.0, |figure| figure.value)
    }

    fn power(&self, v: f64, a: f64) -> f64 {
        let mechanical: f64 = columns(v, a)
            .iter()
            .enumerate()
            .map(|(index, x)| x * self.value(index))
            .sum();
        self.value(3) + mechanical * share(mechanical, self.efficiency)
    }
}

fn share(mechanical: f64, efficiency: f64) -> f64 {
    if mechanical >= 0.0 {
        1.0 / efficiency
    } else {
        efficiency
    }
}

/// Least squares at an efficiency; which rows drive and which brake follows from
/// the round before.
fn solve(log: &PowerLog, efficiency: f64, standby: bool) -> Option<Solved> {
    let mut solved: Option<Solved> = None;
    let rounds = if efficiency < 1.0 { 4 } else { 1 };
    for _ in 0..rounds {
        let mut normal = Normal::new(3 + usize::from(standby));
        for ((v, a), p) in log.velocity.iter().zip(&log.acceleration).zip(&log.power) {
            let mechanical = solved.as_ref().map_or(*p, |solved| {
                let terms = columns(*v, *a);
                terms
                    .iter()
                    .enumerate()
                    .map(|(i, x)| x * solved.value(i))
                    .sum()
            });
            let factor = share(mechanical, efficiency);
            let [x, y, z] = columns(*v, *a).map(|x| x * factor);
            let row = [x, y, z, 1.0];
            normal.add(row.get(..3 + usize::from(standby))?, *p);
        }
        let solution = normal.solve()?;
        let noise = solution.rest / normal.rows.saturating_sub(4).max(1) as f64;
        let figures = solution
            .x
            .iter()
            .zip(solution.inverse.diagonal().iter())
            .map(|(x, d)| Figure {
                value: *x,
                std: (d * noise).sqrt(),
            })
            .collect();
        solved = Some(Solved {
            figures,
            efficiency,
            rest: solution.rest,
        });
    }
    // The sign of the last round may differ from that of the one before.
    solved.map(|mut solved| {
        let triples = log.velocity.iter().zip(&log.acceleration).zip(&log.power);
        solved.rest = triples
            .map(|((v, a), p)| {
                let gap = p - solved.power(*v, *a);
                gap * gap
            })
            .sum();
        solved
    })
}

fn finish(log: &PowerLog, best: &Solved, has_standby: bool) -> Outcome<PowerModel> {
    let n = log.power.len() as f64;
    let mean = log.power.iter().sum::<f64>() / n;
    let about =
        |centre: f64| -> f64 { log.power.iter().map(|p| (p - centre) * (p - centre)).sum() };
    let r2_centered = 1.0 - best.rest / about(mean);
    let model: Vec<f64> = log
        .velocity
        .iter()
        .zip(&log.acceleration)
        .map(|(v, a)| best.power(*v, *a))
        .collect();
    let peak = |x: &[f64]| x.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let peak_model_w = peak(&model);
    let peak_factor = model
        .iter()
        .zip(&log.power)
        .filter(|(model, _)| **model >= 0.5 * peak_model_w && peak_model_w > 0.0)
        .map(|(model, measured)| measured / model)
        .fold(1.0, f64::max);
    let figure = |index: usize| {
        best.figures.get(index).copied().unwrap_or(Figure {
            value: 0.0,
            std: 0.0,
        })
    };
    if figure(0).value <= 0.0 {
        return Err(Trouble::new(
            format!("the mass comes out as {:.3}, not positive", figure(0).value),
            "check units and signs of speed, acceleration and power, and that they are of the same time",
        ));
    }
    Ok(PowerModel {
        mass: figure(0),
        viscous: figure(1),
        coulomb: figure(2),
        efficiency: best.efficiency,
        standby_w: figure(3),
        r2: if has_standby {
            r2_centered
        } else {
            1.0 - best.rest / about(0.0)
        },
        r2_centered,
        rms_w: (best.rest / n).sqrt(),
        peak_measured_w: peak(&log.power),
        peak_model_w,
        peak_factor,
        rows: log.power.len(),
    })
}
