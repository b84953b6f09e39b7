//! A series over time as CSV (RFC 4180).

use std::io::{self, Write};

use super::figure::{Figure, Position};
use crate::machine::{ALL_AXES, AxisKind, Machine};
use crate::pipeline::SeriesSink;
use crate::power::Instant;

/// The columns of the spindle.
const SPINDLE: [&str; 5] = [
    "spindle_speed_rpm",
    "spindle_accel_rpm_s",
    "spindle_torque_nm",
    "spindle_power_w",
    "cutting_power_w",
];

/// Writes the rows of a series below a header.
#[derive(Debug)]
pub struct SeriesRows<W: Write> {
    out: csv::Writer<W>,
    axes: Vec<usize>,
    spindle: bool,
    /// Whether each converter has columns of its own.
    several: bool,
    program: &'static str,
    values: Vec<Figure>,
}

impl<W: Write> SeriesRows<W> {
    /// Writes the header for a machine to `out`; `program` is the first column's
    /// value until it is changed.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn new(out: W, machine: &Machine, program: &'static str) -> io::Result<Self> {
        let mut header = vec!["program".to_owned(), "time_s".into(), "line".into()];
        let axes: Vec<usize> = machine.axis_set.iter().collect();
        for &axis in &axes {
            let letter = ALL_AXES.get(axis).map_or('?', |id| id.letter() as char);
            let name = letter.to_ascii_lowercase();
            let kind = machine.axes.get(axis).and_then(Option::as_ref);
            let rotary = kind.is_some_and(|axis| axis.kind == AxisKind::Rotary);
            let (length, force) = if rotary {
                ("deg", "torque_nm")
            } else {
                ("mm", "force_n")
            };
            header.extend([
                format!("{name}_velocity_{length}_s"),
                format!("{name}_accel_{length}_s2"),
                format!("{name}_{force}"),
                format!("{name}_power_w"),
            ]);
        }
        let spindle = machine.spindle.is_some();
        if spindle {
            header.extend(SPINDLE.map(str::to_owned));
        }
        header.extend(["bus_w".to_owned(), "regen_w".into()]);
        let several = machine.converters.len() > 1;
        if several {
            for converter in &machine.converters {
                let name = &converter.name;
                header.extend([format!("{name}_bus_w"), format!("{name}_regen_w")]);
            }
        }
        let mut out = csv::WriterBuilder::new()
            .has_headers(false)
            .terminator(csv::Terminator::CRLF)
            .from_writer(out);
        out.write_record(header)?;
        Ok(Self {
            out,
            axes,
            spindle,
            several,
            program,
            values: Vec::new(),
        })
    }

    /// Changes the first column.
    pub fn program(&mut self, program: &'static str) {
        self.program = program;
    }

    /// Writes what is still held back and gives the writer below back.
    ///
    /// # Errors
    /// Those of the writer below.
    pub fn finish(self) -> io::Result<W> {
        self.out
            .into_inner()
            .map_err(csv::IntoInnerError::into_error)
    }
}

impl<W: Write> SeriesSink for SeriesRows<W> {
    fn row(&mut self, time_s: f64, line: u64, instant: &Instant) -> io::Result<()> {
        self.values.clear();
        for &axis in &self.axes {
            let Some(own) = instant.axes.get(axis) else {
                continue;
            };
            self.values
                .extend([own.velocity_mm_s, own.accel_mm_s2, own.force_n, own.power_w].map(Figure));
        }
        if self.spindle {
            let own = &instant.spindle;
            let values = [
                own.speed_rpm,
                own.accel_rpm_s,
                own.torque_nm,
                own.power_w,
                own.cutting_w,
            ];
            self.values.extend(values.map(Figure));
        }
        let sums = [&instant.bus_w, &instant.regen_w].map(|powers| powers.iter().sum());
        self.values.extend(sums.map(Figure));
        if self.several {
            for (bus_w, regen_w) in instant.bus_w.iter().zip(&instant.regen_w) {
                self.values.extend([*bus_w, *regen_w].map(Figure));
            }
        }
        let time = Position(time_s);
        Ok(self
            .out
            .serialize((self.program, time, line, &self.values))?)
    }
}
