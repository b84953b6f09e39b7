//! A spindle's schedule: which speed is asked for at which time, as CSV.
//!
//! ```text
//! time_s,target_rpm,accel_rpm_s,jerk_rpm_s2,power_w,period_ms
//! 0,3000
//! 1.5,-3000,2000
//! ```
//!
//! Columns stand in any order; all but the first two may be missing, and so may
//! their values: then the spindle's own limit holds, and the period goes on.

use crate::diagnostic::Diagnostic;
use crate::plan::{SpindleCaps, SpindleDrive};
use crate::source::{Span, split_line_end};

/// Rows that are read.
pub(super) const ROWS_MAX: usize = 1_000_000;
/// Findings that are reported.
pub(super) const FINDINGS_MAX: usize = 20;

/// The columns: name, and other names that are understood.
const COLUMNS: [(&str, &[&str]); 6] = [
    ("time_s", &["time", "t", "t_s"]),
    ("target_rpm", &["target", "rpm", "speed_rpm", "s"]),
    ("accel_rpm_s", &["accel"]),
    ("jerk_rpm_s2", &["jerk"]),
    ("power_w", &["power"]),
    ("period_ms", &["period"]),
];

/// A row of the schedule.
#[derive(Debug, Clone, PartialEq)]
pub struct Command {
    /// Line number from 1.
    pub line: u64,
    /// The line.
    pub text: Vec<u8>,
    /// From when on, in s.
    pub time_s: f64,
    /// The speed in 1/min, signed.
    pub target_rpm: f64,
    /// Limits beyond the spindle's own.
    pub caps: SpindleCaps,
    /// The interpolation period from here on, in s, if it changes.
    pub period_s: Option<f64>,
}

/// The rows of a schedule, ascending in time; at least one.
#[derive(Debug, Clone, PartialEq)]
pub struct Schedule {
    /// The rows.
    pub commands: Vec<Command>,
}

/// A value and where it stands.
pub(super) type Field<'a> = (&'a str, Span);

struct Reader<'a> {
    drive: &'a SpindleDrive,
    found: Vec<Diagnostic>,
    commands: Vec<Command>,
    /// Which of `COLUMNS` each column is.
    columns: Option<Vec<usize>>,
}

impl Schedule {
    /// Reads a schedule for a spindle.
    ///
    /// # Errors
    /// What is wrong with it, each with its line.
    pub fn parse(bytes: &[u8], drive: &SpindleDrive) -> Result<Self, Vec<Diagnostic>> {
        let mut reader = Reader {
            drive,
            found: Vec::new(),
            commands: Vec::new(),
            columns: None,
        };
        for (number, line) in lines(bytes) {
            match line {
                Ok(text) => reader.line(number, text),
                Err(error) => reader.found.push(error),
            }
            if reader.found.len() >= FINDINGS_MAX {
                break;
            }
        }
        if reader.found.is_empty() && reader.commands.is_empty() {
            let help = "a line `time_s,target_rpm`, then a line for each change of speed";
            let error = Diagnostic::error("schedule-empty", "the schedule has no rows");
            reader.found.push(error.help(help));
        }
        if reader.found.is_empty() {
            Ok(Self {
                commands: reader.commands,
            })
        } else {
            Err(reader.found)
        }
    }
}

impl Reader<'_> {
    fn line(&mut self, number: u64, text: &str) {
        let fields = fields(text);
        match self.columns.take() {
            None => self.header(number, text, &fields),
            Some(columns) => {
                self.row(number, text, &fields, &columns);
                self.columns = Some(columns);
            }
        }
    }

    fn header(&mut self, number: u64, text: &str, fields: &[Field<'_>]) {
        let all: Vec<usize> = (0..COLUMNS.len()).collect();
        if fields
            .first()
            .is_some_and(|(value, _)| value.parse::<f64>().is_ok())
        {
            // No header: the columns in their order.
            self.row(number, text, fields, &all);
            self.columns = Some(all);
            return;
        }
        let mut columns = Vec::new();
        for &(name, span) in fields {
            let lower = name.to_ascii_lowercase();
            let known = |(column, others): &(&str, &[&str])| {
                *column == lower || others.contains(&lower.as_str())
            };
            let place = (number, text.as_bytes(), span);
            match COLUMNS.iter().position(known) {
                Some(column) if columns.contains(&column) => {
                    let message = format!("column `{name}` is there twice");
                    self.error(
                        "schedule-column",
                        message,
                        Some("keep one of the two".into()),
                        place,
                    );
                }
                Some(column) => columns.push(column),
                None => {
                    let names: Vec<&str> = COLUMNS.iter().map(|column| column.0).collect();
                    let help = format!("columns are {}", names.join(", "));
                    let message = format!("unknown column `{name}`");
                    self.error("schedule-column", message, Some(help), place);
                    columns.push(COLUMNS.len());
                }
            }
        }
        for (index, (name, _)) in COLUMNS.iter().enumerate().take(2) {
            if !columns.contains(&index) && self.found.is_empty() {
                let span = Span::new(0, text.len());
                let message = format!("there is no column `{name}`");
                let place = (number, text.as_bytes(), span);
                self.error("schedule-column", message, None, place);
            }
        }
        self.columns = Some(columns);
    }

    fn row(&mut self, number: u64, text: &str, fields: &[Field<'_>], columns: &[usize]) {
        let line = text.as_bytes();
        if let Some(&(_, span)) = fields.get(columns.len()) {
            let message = "more values than columns";
            return self.error("schedule-value", message, None, (number, line, span));
        }
        if self.commands.len() >= ROWS_MAX {
            let message = format!("more than {ROWS_MAX} rows");
            return self.error(
                "schedule-rows",
                message,
                None,
                (number, line, Span::new(0, line.len())),
            );
        }
        let mut values = [None; COLUMNS.len()];
        let before = self.found.len();
        for (&column, &(field, span)) in columns.iter().zip(fields) {
            if field.is_empty() {
                continue;
            }
            match field.parse::<f64>() {
                Ok(value) if value.is_finite() => {
                    if let Some(slot) = values.get_mut(column) {
                        *slot = Some((value, span));
                    }
                }
                _ => {
                    let message = format!("`{field}` is not a number");
                    self.error("schedule-value", message, None, (number, line, span));
                }
            }
        }
        let [time, target, rest @ ..] = values;
        if self.found.len() > before {
            return;
        }
        let (Some(time), Some(target)) = (time, target) else {
            let missing = usize::from(time.is_some());
            let name = COLUMNS.get(missing).map_or("", |column| column.0);
            let message = format!("`{name}` is missing");
            let end = Span::new(line.len(), line.len());
            return self.error("schedule-value", message, None, (number, line, end));
        };
        self.times(number, line, time);
        self.speed(number, line, target);
        for (value, (name, _)) in rest.iter().zip(COLUMNS.iter().skip(2)) {
            if let Some((_, span)) = value.filter(|value| value.0 <= 0.0) {
                let message = format!("`{name}` must be greater than 0");
                let help = Some("leave it blank for the spindle's own".to_owned());
                self.error("schedule-value", message, help, (number, line, span));
            }
        }
        let [accel, jerk, power, period] = rest;
        if let Some(power) = power.filter(|power| power.0 > 0.0) {
            self.power(number, line, target.0, power);
        }
        let value = |field: Option<(f64, Span)>| field.map(|field| field.0);
        self.commands.push(Command {
            line: number,
            text: line.to_vec(),
            time_s: time.0,
            target_rpm: target.0,
            caps: SpindleCaps {
                accel_rpm_s: value(accel),
                jerk_rpm_s2: value(jerk),
                power_w: value(power),
            },
            period_s: value(period).map(|ms| ms * 1e-3),
        });
    }

    fn times(&mut self, number: u64, line: &[u8], (time, span): (f64, Span)) {
        let last = self.commands.last().map(|command| command.time_s);
        if let Some(last) = last.filter(|last| time <= *last) {
            let message = format!("time {time} s does not come after {last} s");
            let help = Some("rows stand in the order of time".to_owned());
            self.error("schedule-time", message, help, (number, line, span));
        } else if time < 0.0 {
            let message = "a time below 0";
            self.error("schedule-time", message, None, (number, line, span));
        }
    }

    fn speed(&mut self, number: u64, line: &[u8], (target, span): (f64, Span)) {
        let max = self.drive.max_rpm();
        if target.abs() > max {
            let message = format!("the spindle does not reach {target} 1/min");
            let help = Some(format!("its `max_rpm` is {max}"));
            self.error("schedule-speed", message, help, (number, line, span));
        }
    }

    /// A power that does not carry the spindle to its target.
    fn power(&mut self, number: u64, line: &[u8], target: f64, (power, span): (f64, Span)) {
        let needed = self.drive.holding_w(target);
        if power <= needed {
            let message = format!("with {power} W the spindle does not reach {target} 1/min");
            let help = Some(format!("friction and base load take {needed:.0} W there"));
            self.error("schedule-power", message, help, (number, line, span));
        }
    }

    fn error(
        &mut self,
        rule: &'static str,
        message: impl Into<String>,
        help: Option<String>,
        (number, line, span): (u64, &[u8], Span),
    ) {
        let mut error = Diagnostic::error(rule, message).at(number, span, line);
        error.help = help;
        self.found.push(error);
    }
}

/// The lines of a schedule with their numbers, but for blank ones and comments; an error for
/// one that is not text.
pub(super) fn lines(bytes: &[u8]) -> impl Iterator<Item = (u64, Result<&str, Diagnostic>)> {
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    let lines = (1..).zip(bytes.split_inclusive(|&byte| byte == b'\n'));
    lines.filter_map(|(number, line)| {
        let (body, _) = split_line_end(line);
        let Ok(text) = std::str::from_utf8(body) else {
            let error = Diagnostic::error("schedule-text", "this line is not text");
            let whole = Span::new(0, body.len());
            return Some((number, Err(error.at(number, whole, body))));
        };
        let says = !text.trim().is_empty() && !text.trim_start().starts_with('#');
        says.then_some((number, Ok(text)))
    })
}

/// The values of a line, split at commas, semicolons or tabs, without blanks
/// and quotes around them.
pub(super) fn fields(text: &str) -> Vec<Field<'_>> {
    let mut start = 0;
    let mut fields = Vec::new();
    for part in text.split([',', ';', '\t']) {
        let value = part.trim_start();
        let from = start + (part.len() - value.len());
        let value = value.trim_end();
        let span = Span::new(from, from + value.len());
        let quoted = value
            .strip_prefix('"')
            .and_then(|rest| rest.strip_suffix('"'));
        fields.push((quoted.unwrap_or(value), span));
        start += part.len() + 1;
    }
    // Blank columns at the end of a line are none.
    while fields.last().is_some_and(|(value, _)| value.is_empty()) {
        fields.pop();
    }
    fields
}
