//! Recordings: tables whose names, or a map, say which quantities and units they hold.

use std::io::Read;

use super::column::{Kind, Meaning, Quantity, Reading, axis_of, read, units_of};
use super::column_map::MappedColumn;
use super::error::{IdentifyError, Outcome};
use super::preset::Preset;
use super::rows::{Lines, Rows, no_number};
use super::sampling::even;

/// Fewer samples than this are never enough.
const SAMPLES_MIN: usize = 32;
/// More samples than this are refused: they would not fit into memory.
const SAMPLES_MAX: usize = 50_000_000;

/// One recorded signal, in SI.
#[derive(Debug, Clone)]
pub struct Signal {
    /// Name in the header.
    pub name: String,
    /// What it is.
    pub quantity: Quantity,
    /// Sliding or turning.
    pub kind: Kind,
    /// Samples.
    pub values: Vec<f64>,
}

/// Signals that were sampled evenly.
#[derive(Debug, Clone)]
pub struct Recording {
    /// Sampling period, s.
    pub period_s: f64,
    /// Signals besides the time.
    pub signals: Vec<Signal>,
    /// Columns that were passed over.
    pub ignored: Vec<String>,
    /// Remarks on times and samples.
    pub notes: Vec<String>,
}

/// How a recording is read.
#[derive(Debug, Clone, Default)]
pub struct ReadAs {
    /// Of columns with an axis letter in front, those of this one.
    pub axis: Option<char>,
    /// Columns that are given by hand; they go before what names say.
    pub map: Vec<MappedColumn>,
    /// Samples a second, for a recording without times.
    pub rate_hz: Option<f64>,
    /// The layout of a maker that it has.
    pub preset: Option<Preset>,
}

impl Recording {
    /// Reads CSV; of columns with an axis letter in front, those of `axis`.
    ///
    /// # Errors
    ///
    /// Anything that keeps the data from being used, with what to do.
    pub fn read(input: impl Read, axis: Option<char>) -> Outcome<Self> {
        let read_as = ReadAs {
            axis,
            ..ReadAs::default()
        };
        Self::read_as(input, &read_as)
    }

    /// Reads a table in the way that is given.
    ///
    /// # Errors
    ///
    /// Anything that keeps the data from being used, with what to do.
    pub fn read_as(input: impl Read, how: &ReadAs) -> Outcome<Self> {
        let Some(preset) = how.preset else {
            return Self::of_rows(Rows::open(input)?, how);
        };
        let table = preset.open(input)?;
        let mut map = preset.columns(&table.names, how.axis, &how.map)?;
        map.extend_from_slice(&how.map);
        let how = ReadAs { map, ..how.clone() };
        let rows = Rows::named(table.names, table.text, table.before);
        let mut recording = Self::of_rows(rows, &how)?;
        recording.ignored.extend(table.ignored);
        Ok(recording)
    }

    fn of_rows<R: Read>(mut rows: Rows<R>, how: &ReadAs) -> Outcome<Self> {
        let (columns, ignored) = columns(&rows.names, how)?;
        let mut values: Vec<Vec<f64>> = vec![Vec::new(); columns.len()];
        let mut lines = Lines::default();
        while let Some(line) = rows.next_line()? {
            lines.add(line);
            for ((index, name, _), list) in columns.iter().zip(&mut values) {
                let value = rows.number(*index).unwrap_or(f64::NAN);
                if !value.is_finite() {
                    return Err(no_number(line, name, &rows.cell(*index)));
                }
                list.push(value);
            }
            if values.first().is_some_and(|list| list.len() > SAMPLES_MAX) {
                return Err(IdentifyError::new(
                    format!("the recording has more than {SAMPLES_MAX} samples"),
                    "cut it, or record at a lower rate",
                ));
            }
        }
        let samples = values.first().map_or(0, Vec::len);
        if samples < SAMPLES_MIN {
            return Err(IdentifyError::new(
                format!("the recording is too short: {samples} samples"),
                format!("record at least {SAMPLES_MIN} samples, better several seconds"),
            ));
        }
        for ((_, _, meaning), values) in columns.iter().zip(&mut values) {
            for value in values {
                *value *= meaning.to_si;
            }
        }
        let at = columns
            .iter()
            .position(|(_, _, meaning)| meaning.quantity == Quantity::Time);
        let (period_s, notes) = match (at, how.rate_hz) {
            (Some(at), _) => {
                let time = values.get_mut(at).map(std::mem::take).unwrap_or_default();
                even(&time, &mut values, &lines)?
            }
            (None, rate_hz) => (1.0 / rate_hz.unwrap_or(1.0), Vec::new()),
        };
        let signals = columns.into_iter().zip(values);
        Ok(Self {
            period_s,
            signals: signals
                .filter(|((_, _, meaning), _)| meaning.quantity != Quantity::Time)
                .map(|((_, name, meaning), values)| Signal {
                    name,
                    quantity: meaning.quantity,
                    kind: meaning.kind,
                    values,
                })
                .collect(),
            ignored,
            notes,
        })
    }

    /// Whether its force is a torque.
    #[must_use]
    pub fn is_rotary(&self) -> bool {
        let force = self.get(Quantity::Force);
        let force = force.or_else(|| self.get(Quantity::Excitation));
        force.is_some_and(|force| force.kind == Kind::Rotary)
    }

    /// Refers what was recorded at a motor to the slide that its screw drives:
    /// torques become forces, angles become travel. `force_per_torque` is in N per
    /// N·m, and so in rad of the motor per m of the slide. Signals that are about
    /// sliding stay as they are.
    ///
    /// # Errors
    ///
    /// An angle of the load: the load of a screw slides.
    pub fn refer_to_slide(&mut self, force_per_torque: f64) -> Outcome<()> {
        for signal in &mut self.signals {
            if signal.kind != Kind::Rotary {
                continue;
            }
            let factor = match signal.quantity {
                Quantity::Force | Quantity::Excitation => force_per_torque,
                Quantity::Command
                | Quantity::Position
                | Quantity::Velocity
                | Quantity::Acceleration => 1.0 / force_per_torque,
                Quantity::Time | Quantity::Power => continue,
            };
            if signal.name.to_ascii_lowercase().contains("load_") {
                return Err(IdentifyError::new(
                    format!("{} turns, but the load of a screw slides", signal.name),
                    "leave --lead-mm out if the load turns; name the column without load_ if it is the motor's encoder",
                ));
            }
            for value in &mut signal.values {
                *value *= factor;
            }
            signal.kind = Kind::Linear;
        }
        Ok(())
    }

    /// Turns force, torque, excitation and command about: they were counted the other
    /// way than the motion.
    pub fn reverse(&mut self) {
        for signal in &mut self.signals {
            if matches!(
                signal.quantity,
                Quantity::Force | Quantity::Excitation | Quantity::Command
            ) {
                for value in &mut signal.values {
                    *value = -*value;
                }
            }
        }
    }

    /// The signal of a quantity.
    #[must_use]
    pub fn get(&self, quantity: Quantity) -> Option<&Signal> {
        self.signals
            .iter()
            .find(|signal| signal.quantity == quantity)
    }

    /// Number of samples.
    #[must_use]
    pub fn len(&self) -> usize {
        self.signals.first().map_or(0, |signal| signal.values.len())
    }

    /// True without samples.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

type Column = (usize, String, Meaning);

fn columns(header: &[String], how: &ReadAs) -> Outcome<(Vec<Column>, Vec<String>)> {
    let mut columns: Vec<Column> = Vec::new();
    for mapped in &how.map {
        let index = mapped.index(header)?;
        let name = header.get(index).cloned().unwrap_or_default();
        if columns
            .iter()
            .any(|(_, _, known)| known.quantity == mapped.meaning.quantity)
        {
            return Err(IdentifyError::new(
                format!("--map gives two columns for one quantity: {name} is the second"),
                "give each quantity once",
            ));
        }
        columns.push((index, name, mapped.meaning));
    }
    let by_hand = columns.clone();
    let mut ignored = Vec::new();
    for (index, name) in header.iter().enumerate() {
        if by_hand.iter().any(|(used, _, _)| *used == index) {
            continue;
        }
        let is_given = |quantity| {
            let mut given = by_hand.iter();
            given.any(|(_, _, known)| known.quantity == quantity)
        };
        let is_ours = match (axis_of(name), how.axis) {
            (Some(found), Some(wanted)) => found == wanted,
            _ => true,
        };
        match read(name) {
            Reading::Known(meaning) if is_ours && !is_given(meaning.quantity) => {
                if let Some((_, other, _)) = columns
                    .iter()
                    .find(|(_, _, known)| known.quantity == meaning.quantity)
                {
                    return Err(IdentifyError::new(
                        format!("{other} and {name} are the same quantity"),
                        "leave one of them in the file, or put the axis letter in front, such as x_position_mm",
                    ));
                }
                columns.push((index, name.clone(), meaning));
            }
            Reading::UnitInDoubt(quantity) if is_ours && !is_given(quantity) => {
                return Err(IdentifyError::new(
                    format!("the unit of column {name} is in doubt"),
                    format!(
                        "end its name with the unit, one of: {}; or give it by --map",
                        units_of(quantity)
                    ),
                ));
            }
            _ => ignored.push(name.clone()),
        }
    }
    let has_time = columns
        .iter()
        .any(|(_, _, meaning)| meaning.quantity == Quantity::Time);
    match (has_time, how.rate_hz) {
        (false, None) => Err(IdentifyError::new(
            "there is no column time_s",
            "name the column of time time_s (or time_ms), or give --rate-hz; the header must name quantities and units",
        )),
        (true, Some(_)) => Err(IdentifyError::new(
            "the recording has times: --rate-hz has no meaning",
            "leave --rate-hz out",
        )),
        _ => Ok((columns, ignored)),
    }
}
