//! A recording of the power that a machine draws.

use std::io::Read;

use crate::column::{Quantity, Reading, axis_of, read};
use crate::column_map::MappedColumn;
use crate::error::{IdentifyError, Outcome};
use crate::rows::{Rows, no_number};

/// Samples at most.
const SAMPLES_MAX: usize = 20_000_000;
/// Samples at least.
const SAMPLES_MIN: usize = 20;

/// Power over time, as a meter or the drives have recorded it.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PowerTrace {
    /// Times, s, ascending.
    pub time_s: Vec<f64>,
    /// Power drawn at these times, W; what is fed back counts negative.
    pub power_w: Vec<f64>,
    /// The power of single axes, where columns have it.
    pub axes: Vec<AxisTrace>,
    /// How columns were understood.
    pub notes: Vec<String>,
}

/// The recorded power of one axis.
#[derive(Debug, Clone, PartialEq)]
pub struct AxisTrace {
    /// The letter of the axis, large.
    pub letter: char,
    /// Its power at the times of the log, W; NaN in rows without a value.
    pub power_w: Vec<f64>,
}

impl PowerTrace {
    /// Reads a table with a column of times (`time_s`, `time_ms`) and one of powers
    /// (`power_w`, `power_kw`); several of single axes (`x_power_w`) are kept, and added up
    /// where there is none of all. `map` says what other columns hold. Rows without a value
    /// are passed over.
    ///
    /// # Errors
    ///
    /// When a column is missing, a cell is no number, or times do not ascend.
    pub fn read(input: impl Read, map: &[MappedColumn]) -> Outcome<Self> {
        let mut rows = Rows::open(input)?;
        let columns = Columns::of(&rows.names, map)?;
        let axes = columns.axes.iter().map(|(letter, _)| AxisTrace {
            letter: *letter,
            power_w: Vec::new(),
        });
        let mut trace = Self {
            notes: columns.notes.clone(),
            axes: axes.collect(),
            ..Self::default()
        };
        while let Some(line) = rows.next_line()? {
            let value = |index: usize| -> Outcome<Option<f64>> {
                let cell = rows.cell(index);
                match rows.number(index) {
                    Some(value) => Ok(Some(value)),
                    None if cell.is_empty() => Ok(None),
                    None => {
                        let name = rows.names.get(index).map_or("", String::as_str);
                        Err(no_number(line, name, &cell))
                    }
                }
            };
            let (index, to_s) = columns.time;
            let time_s = value(index)?.map(|time| time * to_s);
            let mut sum_w = Some(0.0);
            for (index, to_w) in &columns.powers {
                let power = value(*index)?.map(|power| power * to_w);
                sum_w = sum_w.zip(power).map(|(sum, power)| sum + power);
            }
            let both = time_s
                .zip(sum_w)
                .filter(|(t, w)| t.is_finite() && w.is_finite());
            let Some((time_s, power_w)) = both else {
                continue;
            };
            if trace.time_s.last().is_some_and(|last| time_s <= *last) {
                return Err(IdentifyError::new(
                    format!("line {line}: the time does not go on"),
                    "times must ascend: cut the log there, or sort it",
                ));
            }
            trace.time_s.push(time_s);
            trace.power_w.push(power_w);
            for ((_, (index, to_w)), axis) in columns.axes.iter().zip(&mut trace.axes) {
                let power_w = value(*index)?.map_or(f64::NAN, |power| power * to_w);
                axis.power_w.push(power_w);
            }
            if trace.time_s.len() > SAMPLES_MAX {
                return Err(IdentifyError::new(
                    format!("the log has more than {SAMPLES_MAX} rows"),
                    "cut it, or record at a lower rate",
                ));
            }
        }
        if trace.time_s.len() < SAMPLES_MIN {
            return Err(IdentifyError::new(
                format!(
                    "the log has {} rows with time and power",
                    trace.time_s.len()
                ),
                format!("at least {SAMPLES_MIN} are needed"),
            ));
        }
        Ok(trace)
    }

    /// The middle one of the times between two samples, s.
    #[must_use]
    pub fn step_s(&self) -> f64 {
        let pairs = self.time_s.iter().zip(self.time_s.iter().skip(1));
        let mut steps: Vec<f64> = pairs.map(|(a, b)| b - a).collect();
        let middle = steps.len() / 2;
        if steps.is_empty() {
            return 0.0;
        }
        *steps.select_nth_unstable_by(middle, f64::total_cmp).1
    }
}

/// Which columns hold what, with the factors that make s and W of them.
struct Columns {
    time: (usize, f64),
    powers: Vec<(usize, f64)>,
    /// Of single axes, with their letters.
    axes: Vec<(char, (usize, f64))>,
    notes: Vec<String>,
}

impl Columns {
    fn of(names: &[String], map: &[MappedColumn]) -> Outcome<Self> {
        let mut times = Vec::new();
        let mut whole = Vec::new();
        let mut by_axis = Vec::new();
        let mut put = |quantity, place: (usize, f64), axis: Option<char>| match quantity {
            Quantity::Time => times.push(place),
            Quantity::Power => match axis {
                Some(axis) => by_axis.push((axis.to_ascii_uppercase(), place)),
                None => whole.push(place),
            },
            _ => {}
        };
        if map.is_empty() {
            for (index, name) in names.iter().enumerate() {
                if let Reading::Known(meaning) = read(name) {
                    put(meaning.quantity, (index, meaning.to_si), axis_of(name));
                }
            }
        }
        for mapped in map {
            let place = (mapped.index(names)?, mapped.meaning.to_si);
            put(mapped.meaning.quantity, place, None);
        }
        let missing = |what: &str, name: &str| {
            IdentifyError::new(
                format!("the log has no column of {what}"),
                format!(
                    "name it {name}, or say which it is: --map {what}=COLUMN*1{}",
                    &name[name.len() - 1..]
                ),
            )
        };
        let [time] = times.as_slice() else {
            return Err(if times.is_empty() {
                missing("time", "time_s")
            } else {
                IdentifyError::new(
                    "the log has several columns of time",
                    "say which: --map time=COLUMN*1s",
                )
            });
        };
        let mut notes = Vec::new();
        let powers = match (whole.as_slice(), map.is_empty()) {
            ([], _) if by_axis.is_empty() => return Err(missing("power", "power_w")),
            ([], _) => {
                notes.push(format!(
                    "the power is the sum of {} columns of single axes, without what else the machine draws",
                    by_axis.len()
                ));
                by_axis.iter().map(|(_, place)| *place).collect()
            }
            ([_], _) | (_, false) => whole,
            _ => {
                return Err(IdentifyError::new(
                    "the log has several columns of power",
                    "say which: --map power=COLUMN*1W; several of these are added up",
                ));
            }
        };
        Ok(Self {
            time: *time,
            powers,
            axes: by_axis,
            notes,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn log(header: &str, row: impl Fn(usize) -> String) -> Outcome<PowerTrace> {
        let rows: Vec<String> = (0..30).map(row).collect();
        PowerTrace::read(format!("{header}\n{}\n", rows.join("\n")).as_bytes(), &[])
    }

    #[test]
    fn times_and_powers_come_in_their_units() {
        let trace = log("time_ms,power_kw", |k| format!("{},{}", 10 * k, k)).unwrap();
        assert_eq!(trace.time_s[3], 0.03);
        assert_eq!(trace.power_w[3], 3000.0);
        assert!((trace.step_s() - 0.01).abs() < 1e-12);
        assert!(trace.notes.is_empty());
    }

    #[test]
    fn powers_of_axes_are_added_up() {
        let trace = log("time_s,x_power_w,y_power_w", |k| format!("{k},{k},10")).unwrap();
        assert_eq!(trace.power_w[5], 15.0);
        assert!(trace.notes[0].contains("sum of 2 columns"));
        // One of all is what counts.
        let trace = log("time_s,x_power_w,power_w", |k| format!("{k},{k},10")).unwrap();
        assert_eq!(trace.power_w[5], 10.0);
    }

    #[test]
    fn what_is_no_log_is_refused() {
        let message =
            |header: &str, row: fn(usize) -> String| log(header, row).unwrap_err().message;
        let two = |k: usize| format!("{k},1");
        assert_eq!(
            message("time_s,load", two),
            "the log has no column of power"
        );
        assert_eq!(
            message("clock,power_w", two),
            "the log has no column of time"
        );
        assert_eq!(
            message("time_s,time_ms,power_w", |k| format!("{k},{k},1")),
            "the log has several columns of time"
        );
        assert_eq!(
            message("time_s,power_w,power_kw", |k| format!("{k},{k},1")),
            "the log has several columns of power"
        );
        assert_eq!(
            message("time_s,power_w", |k| format!("{},1", k % 7)),
            "line 9: the time does not go on"
        );
        assert!(message("time_s,power_w", |k| format!("{k},x")).contains("not a number"));
        let short = PowerTrace::read("time_s,power_w\n0,1\n1,2\n".as_bytes(), &[]);
        assert_eq!(
            short.unwrap_err().message,
            "the log has 2 rows with time and power"
        );
    }
}
