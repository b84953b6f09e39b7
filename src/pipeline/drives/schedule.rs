//! A schedule of several drives: what each is to do from which time on, as CSV.
//!
//! ```text
//! time_s,drive,position_mm,speed_mm_min,speed_rpm,power_w
//! 0,spindle,,,12000,
//! 0,X,400,,,
//! 0.2,Y,250,20000,,
//! 0.5,all,,,,3000
//! ```
//!
//! Columns stand in any order below a header; a drive has columns in its own units. A position is
//! gone to with the speed as the largest one; a speed without a position is held. Limits hold
//! until the drive's next row; what `all` says, until the next row of `all`.

use super::column::{COLUMNS, Column, Of, Quantity};
use crate::diagnostic::Diagnostic;
use crate::machine::units::SECONDS_PER_MINUTE;
use crate::machine::{AxisKind, Machine};
use crate::pipeline::schedule::{FINDINGS_MAX, Field, ROWS_MAX, fields, lines};
use crate::source::Span;

/// Which drive a row is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DriveId {
    /// Index of an axis.
    Axis(usize),
    /// The spindle.
    Spindle,
}

/// What a row of the schedule is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum For {
    /// One drive.
    Drive(DriveId),
    /// All of them.
    All,
}

/// A row of the schedule. Positions in mm or degrees, speeds in mm/s, degrees/s or 1/min.
#[derive(Debug, Clone, PartialEq)]
pub struct DriveCommand {
    /// Line number from 1.
    pub line: u64,
    /// The line.
    pub text: Vec<u8>,
    /// From when on, in s.
    pub time_s: f64,
    /// What it is for.
    pub of: For,
    /// The position to go to.
    pub position: Option<f64>,
    /// The speed to hold, or the largest one on the way to a position.
    pub speed: Option<f64>,
    /// The largest acceleration.
    pub accel: Option<f64>,
    /// The largest jerk.
    pub jerk: Option<f64>,
    /// The largest power of the drive, or of all of them together, W.
    pub power_w: Option<f64>,
    /// The interpolation period from here on, s.
    pub period_s: Option<f64>,
}

/// The rows of a schedule, in the order of time; at least one for a drive.
#[derive(Debug, Clone, PartialEq)]
pub struct DriveSchedule {
    /// The rows.
    pub commands: Vec<DriveCommand>,
}

struct Reader<'m> {
    machine: &'m Machine,
    found: Vec<Diagnostic>,
    commands: Vec<DriveCommand>,
    columns: Option<Vec<&'static Column>>,
}

/// A line, for messages.
#[derive(Clone, Copy)]
struct Line<'t> {
    number: u64,
    text: &'t str,
}

impl DriveSchedule {
    /// Reads a schedule for a machine.
    ///
    /// # Errors
    /// What is wrong with it, each with its line.
    pub fn parse(bytes: &[u8], machine: &Machine) -> Result<Self, Vec<Diagnostic>> {
        let mut reader = Reader {
            machine,
            found: Vec::new(),
            commands: Vec::new(),
            columns: None,
        };
        for (number, line) in lines(bytes) {
            match line {
                Ok(text) => reader.line(Line { number, text }),
                Err(error) => reader.found.push(error),
            }
            if reader.found.len() >= FINDINGS_MAX {
                break;
            }
        }
        let of_drive = |command: &DriveCommand| matches!(command.of, For::Drive(_));
        if reader.found.is_empty() && !reader.commands.iter().any(of_drive) {
            let help = "a line `time_s,drive,position_mm`, then a line for each command";
            let error = Diagnostic::error("schedule-empty", "the schedule has no row for a drive");
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
    fn line(&mut self, line: Line<'_>) {
        let fields = fields(line.text);
        match self.columns.take() {
            None => self.columns = Some(self.header(line, &fields)),
            Some(columns) => {
                self.row(line, &fields, &columns);
                self.columns = Some(columns);
            }
        }
    }

    fn header(&mut self, line: Line<'_>, fields: &[Field<'_>]) -> Vec<&'static Column> {
        let mut columns: Vec<&'static Column> = Vec::new();
        for &(name, span) in fields {
            let Some(column) = Column::named(name) else {
                let names: Vec<&str> = COLUMNS.iter().map(|column| column.name).collect();
                let help = format!("columns are {}", names.join(", "));
                let message = format!("unknown column `{name}`");
                self.error("schedule-column", message, Some(help), line, span);
                continue;
            };
            if columns.iter().any(|known| known.name == column.name) {
                let message = format!("column `{name}` is there twice");
                let help = Some("keep one of the two".to_owned());
                self.error("schedule-column", message, help, line, span);
            }
            columns.push(column);
        }
        for needed in ["time_s", "drive"] {
            if self.found.is_empty() && !columns.iter().any(|column| column.name == needed) {
                let message = format!("there is no column `{needed}`");
                let whole = Span::new(0, line.text.len());
                self.error("schedule-column", message, None, line, whole);
            }
        }
        columns
    }

    fn row(&mut self, line: Line<'_>, fields: &[Field<'_>], columns: &[&'static Column]) {
        let whole = Span::new(0, line.text.len());
        if let Some(&(_, span)) = fields.get(columns.len()) {
            return self.error(
                "schedule-value",
                "more values than columns",
                None,
                line,
                span,
            );
        }
        if self.commands.len() >= ROWS_MAX {
            let message = format!("more than {ROWS_MAX} rows");
            return self.error("schedule-rows", message, None, line, whole);
        }
        let before = self.found.len();
        let values = || {
            columns
                .iter()
                .zip(fields)
                .filter(|(_, it)| !it.0.is_empty())
        };
        let drive = values().find(|(column, _)| column.quantity == Quantity::Drive);
        let Some(of) = self.drive(drive.map(|(_, field)| *field), line) else {
            return;
        };
        let mut command = DriveCommand {
            line: line.number,
            text: line.text.as_bytes().to_vec(),
            time_s: f64::NAN,
            of,
            position: None,
            speed: None,
            accel: None,
            jerk: None,
            power_w: None,
            period_s: None,
        };
        for (column, &field) in values() {
            if column.quantity != Quantity::Drive {
                self.value(&mut command, column, field, line);
            }
        }
        if self.found.len() > before {
            return;
        }
        if command.time_s.is_nan() {
            let end = Span::new(line.text.len(), line.text.len());
            return self.error("schedule-value", "`time_s` is missing", None, line, end);
        }
        self.times(&command, line);
        if self.found.len() == before {
            self.commands.push(command);
        }
    }

    /// The drive of a row.
    fn drive(&mut self, field: Option<Field<'_>>, line: Line<'_>) -> Option<For> {
        let Some((name, span)) = field else {
            return Some(For::All);
        };
        if name.eq_ignore_ascii_case("all") {
            return Some(For::All);
        }
        let spindle = name.eq_ignore_ascii_case("spindle") || name.eq_ignore_ascii_case("S");
        if spindle && self.machine.spindle.is_some() {
            return Some(For::Drive(DriveId::Spindle));
        }
        if let [letter] = name.as_bytes()
            && let Some(axis) = crate::machine::AxisId::from_letter(letter.to_ascii_uppercase())
            && self.machine.axes[axis as usize].is_some()
        {
            return Some(For::Drive(DriveId::Axis(axis as usize)));
        }
        let mut known = self.machine.axis_set.to_string();
        if self.machine.spindle.is_some() {
            known.push_str(", spindle");
        }
        let message = format!("the machine has no drive `{name}`");
        let help = format!("it has {known}; `all` or nothing stands for all of them");
        self.error("schedule-drive", message, Some(help), line, span);
        None
    }

    /// Takes a value into a row.
    fn value(
        &mut self,
        command: &mut DriveCommand,
        column: &'static Column,
        (text, span): Field<'_>,
        line: Line<'_>,
    ) {
        let Some(value) = text.parse::<f64>().ok().filter(|value| value.is_finite()) else {
            let message = format!("`{text}` is not a number");
            return self.error("schedule-value", message, None, line, span);
        };
        let (kind, most) = self.kind(command.of);
        if !column.of.contains(&kind) {
            let suits =
                |other: &&Column| other.quantity == column.quantity && other.of.contains(&kind);
            let help = match COLUMNS.iter().find(suits) {
                Some(other) => format!("write it under `{}`", other.name),
                None => "leave it blank".to_owned(),
            };
            let message = format!("`{}` does not go with this drive", column.name);
            return self.error("schedule-column", message, Some(help), line, span);
        }
        let positive = !matches!(
            column.quantity,
            Quantity::Time | Quantity::Position | Quantity::Speed
        );
        if positive && value <= 0.0 || column.quantity == Quantity::Time && value < 0.0 {
            let message = format!("`{}` must be greater than 0", column.name);
            let help = positive.then(|| "leave it blank for the drive's own".to_owned());
            return self.error("schedule-value", message, help, line, span);
        }
        let scaled = match column.quantity {
            Quantity::Speed if kind != Of::Spindle => value / SECONDS_PER_MINUTE,
            Quantity::Period => value * 1e-3,
            _ => value,
        };
        if column.quantity == Quantity::Speed && scaled.abs() > most * (1.0 + 1e-12) {
            let message = format!("the drive does not reach {text}");
            let unit = if kind == Of::Spindle {
                1.0
            } else {
                SECONDS_PER_MINUTE
            };
            let help = format!("its largest speed is {}", most * unit);
            return self.error("schedule-speed", message, Some(help), line, span);
        }
        match column.quantity {
            Quantity::Time => command.time_s = scaled,
            Quantity::Position => command.position = Some(scaled),
            Quantity::Speed => command.speed = Some(scaled.clamp(-most, most)),
            Quantity::Accel => command.accel = Some(scaled),
            Quantity::Jerk => command.jerk = Some(scaled),
            Quantity::Power => command.power_w = Some(scaled),
            Quantity::Period => command.period_s = Some(scaled),
            Quantity::Drive => {}
        }
    }

    /// Of what kind a drive is, and its largest speed.
    fn kind(&self, of: For) -> (Of, f64) {
        match of {
            For::All => (Of::All, f64::INFINITY),
            For::Drive(DriveId::Spindle) => {
                let spindle = self.machine.spindle.as_ref();
                (Of::Spindle, spindle.map_or(0.0, |spindle| spindle.max_rpm))
            }
            For::Drive(DriveId::Axis(axis)) => {
                let data = self.machine.axes[axis];
                let rotary = data.is_some_and(|data| data.kind == AxisKind::Rotary);
                let kind = if rotary { Of::Rotary } else { Of::Linear };
                (kind, data.map_or(0.0, |data| data.rapid_mm_s))
            }
        }
    }

    /// Rows stand in the order of time, those of one drive at different times.
    fn times(&mut self, command: &DriveCommand, line: Line<'_>) {
        let whole = Span::new(0, line.text.len());
        let last_s = self.commands.last().map(|last| last.time_s);
        let time_s = command.time_s;
        if let Some(last_s) = last_s.filter(|last_s| time_s < *last_s) {
            let message = format!("time {time_s} s comes after {last_s} s");
            let help = Some("rows stand in the order of time".to_owned());
            return self.error("schedule-time", message, help, line, whole);
        }
        let mut now = self.commands.iter().rev();
        let mut now = now.by_ref().take_while(|last| last.time_s == time_s);
        if now.any(|last| last.of == command.of) {
            let message = format!("a second row for this drive at {time_s} s");
            self.error("schedule-time", message, None, line, whole);
        }
        let largest = command.position.is_some() && command.speed.is_some_and(|it| it <= 0.0);
        if largest {
            let message = "the largest speed on the way to a position must be greater than 0";
            self.error("schedule-value", message, None, line, whole);
        }
    }

    fn error(
        &mut self,
        rule: &'static str,
        message: impl Into<String>,
        help: Option<String>,
        line: Line<'_>,
        span: Span,
    ) {
        let mut error =
            Diagnostic::error(rule, message).at(line.number, span, line.text.as_bytes());
        error.help = help;
        self.found.push(error);
    }
}
