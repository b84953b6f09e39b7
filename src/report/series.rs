//! A series over time as CSV (RFC 4180).

use std::io::{self, Write};
use std::iter;

use super::figure::{Figure, Position};
use crate::machine::{ALL_AXES, AxisKind, Machine};
use crate::pipeline::SeriesSink;
use crate::power::{BusVoltages, Instant, PowerModel};

/// The columns of the spindle.
const SPINDLE: [&str; 5] = [
    "spindle_speed_rpm",
    "spindle_accel_rpm_s",
    "spindle_torque_nm",
    "spindle_power_w",
    "cutting_power_w",
];

/// The columns of a series over time, for any format: their names, and the values of a row.
#[derive(Debug, Clone)]
pub struct SeriesColumns {
    names: Vec<String>,
    axes: Vec<usize>,
    spindle: bool,
    /// Whether each converter has columns of its own.
    several: bool,
    /// Voltages of buses.
    volts: usize,
}

impl SeriesColumns {
    /// Those of a machine: of each axis speed, acceleration, force or torque and power, of the
    /// spindle what it does, what the converters deliver and take back, and the voltages of
    /// buses that have limits.
    #[must_use]
    pub fn new(machine: &Machine) -> Self {
        let axes: Vec<usize> = machine.axis_set.iter().collect();
        let mut names = Vec::new();
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
            names.extend([
                format!("{name}_velocity_{length}_s"),
                format!("{name}_accel_{length}_s2"),
                format!("{name}_{force}"),
                format!("{name}_power_w"),
            ]);
        }
        let spindle = machine.spindle.is_some();
        if spindle {
            names.extend(SPINDLE.map(str::to_owned));
        }
        names.extend(["bus_w".to_owned(), "regen_w".into()]);
        let several = machine.converters.len() > 1;
        if several {
            for converter in &machine.converters {
                let name = &converter.name;
                names.extend([format!("{name}_bus_w"), format!("{name}_regen_w")]);
            }
        }
        let buses = BusVoltages::new(machine, &PowerModel::new(machine));
        let before = names.len();
        for (converter, lowest) in buses.iter().flat_map(BusVoltages::names) {
            let converter = machine.converters.get(converter).filter(|_| several);
            let prefix = converter.map_or_else(String::new, |it| format!("{}_", it.name));
            let which = if lowest { "low" } else { "high" };
            names.push(format!("{prefix}bus_{which}_v"));
        }
        Self {
            volts: names.len() - before,
            names,
            axes,
            spindle,
            several,
        }
    }

    /// Their names, units as suffixes.
    #[must_use]
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Appends the values of an instant to `values`, one for each name.
    pub fn append(&self, instant: &Instant, values: &mut Vec<f64>) {
        for &axis in &self.axes {
            let own = instant.axes.get(axis).copied().unwrap_or_default();
            values.extend([own.velocity_mm_s, own.accel_mm_s2, own.force_n, own.power_w]);
        }
        if self.spindle {
            let own = &instant.spindle;
            values.extend([
                own.speed_rpm,
                own.accel_rpm_s,
                own.torque_nm,
                own.power_w,
                own.cutting_w,
            ]);
        }
        values.extend([&instant.bus_w, &instant.regen_w].map(|powers| powers.iter().sum::<f64>()));
        if self.several {
            for (bus_w, regen_w) in instant.bus_w.iter().zip(&instant.regen_w) {
                values.extend([*bus_w, *regen_w]);
            }
        }
        let volts = instant.volts.iter().copied().chain(iter::repeat(f64::NAN));
        values.extend(volts.take(self.volts));
    }

    /// Whether there are voltages of buses: see [`SeriesSink::wants_volts`].
    #[must_use]
    pub fn has_volts(&self) -> bool {
        self.volts > 0
    }
}

/// Writes the rows of a series below a header.
#[derive(Debug)]
pub struct SeriesRows<W: Write> {
    out: csv::Writer<W>,
    columns: SeriesColumns,
    program: &'static str,
    values: Vec<f64>,
    figures: Vec<Figure>,
}

impl<W: Write> SeriesRows<W> {
    /// Writes the header for a machine to `out`; `program` is the first column's
    /// value until it is changed.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn new(out: W, machine: &Machine, program: &'static str) -> io::Result<Self> {
        let columns = SeriesColumns::new(machine);
        let mut out = csv::WriterBuilder::new()
            .has_headers(false)
            .terminator(csv::Terminator::CRLF)
            .from_writer(out);
        let first = ["program", "time_s", "line"].into_iter();
        out.write_record(first.chain(columns.names.iter().map(String::as_str)))?;
        Ok(Self {
            out,
            columns,
            program,
            values: Vec::new(),
            figures: Vec::new(),
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
    fn wants_volts(&self) -> bool {
        self.columns.has_volts()
    }

    fn row(&mut self, time_s: f64, line: u64, instant: &Instant) -> io::Result<()> {
        self.values.clear();
        self.columns.append(instant, &mut self.values);
        self.figures.clear();
        self.figures.extend(self.values.iter().copied().map(Figure));
        let time = Position(time_s);
        Ok(self
            .out
            .serialize((self.program, time, line, &self.figures))?)
    }
}
