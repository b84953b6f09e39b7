//! Logs of speeds, accelerations and the power of one axis' drive.

use std::io::Read;

use super::column::{Kind, Quantity, Reading, axis_of, read};
use super::error::{IdentifyError, Outcome};
use super::rows::{Rows, no_number};

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
    /// Where each log that was added begins.
    pub starts: Vec<usize>,
}

/// A column whose values show whether its name is right.
#[derive(Debug, Default, Clone)]
struct Electrical {
    name: String,
    values: Vec<f64>,
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
        self.starts.push(self.power.len());
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
                return Err(IdentifyError::new(
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
                match rows.number(index) {
                    Some(value) => *slot = value * factor,
                    None if rows.cell(index).is_empty() => {}
                    None => {
                        let name = rows.names.get(index).map_or(name, String::as_str);
                        return Err(no_number(line, name, &rows.cell(index)));
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
                column.values.push(rows.number(*index).unwrap_or(f64::NAN));
            }
            if self.power.len() > ROWS_MAX {
                return Err(IdentifyError::new(
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
            ) => Err(IdentifyError::new(
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
