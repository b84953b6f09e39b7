//! A machine as the physics page needs it, read from its TOML as plain values:
//! nothing of `gwatt::machine` is used.
//!
//! Screw with lead `h` (m) and `i` motor revolutions per screw revolution: one
//! metre turns the motor by `k = 2π·i/h`, so that `m = J·k²`, `F = T·k`,
//! `b = d·k²`; a rotary table with a gear is the same with `k = i`.

use std::f64::consts::{PI, TAU};
use toml::{Table, Value};

/// The letters of axes, in the order of their indices.
pub const LETTERS: &str = "XYZABCUVWE";

/// An axis; its unit of motion is mm or degrees, everything else SI.
#[derive(Debug, Clone)]
pub struct Axis {
    /// Index in [`LETTERS`].
    pub index: usize,
    /// m per mm, or rad per degree.
    pub unit: f64,
    /// Largest speed, units/s.
    pub speed: f64,
    /// Largest acceleration, units/s².
    pub accel: f64,
    /// Largest jerk, units/s³; infinite without one.
    pub jerk: f64,
    pub mass: f64,
    pub coulomb: f64,
    pub viscous: f64,
    pub gravity: f64,
    pub efficiency: f64,
    pub copper: f64,
    /// Servo factors of driving and braking.
    pub factors: [f64; 2],
    /// Friction of the warm machine by that of the cold one.
    pub warm: f64,
    /// Largest force (N or N·m) over speed (units/s); empty without limit.
    pub curve: Vec<[f64; 2]>,
}

/// A converter.
#[derive(Debug, Clone)]
pub struct Converter {
    pub name: String,
    /// Indices of its axes.
    pub axes: Vec<usize>,
    pub limit_w: f64,
    pub regen_limit_w: f64,
    pub base_w: f64,
    pub credit: bool,
    /// The table itself, for its limits over time.
    pub table: Table,
}

/// A spindle without jerk limit.
#[derive(Debug, Clone)]
pub struct Spindle {
    pub inertia: f64,
    pub friction_nm: f64,
    pub max_rpm: f64,
    /// 0: constant torque up to `max_rpm`.
    pub base_rpm: f64,
    pub accel_time_s: f64,
    pub efficiency: f64,
    pub base_w: f64,
    pub converter: usize,
}

/// A machine.
#[derive(Debug, Clone)]
pub struct Plant {
    pub axes: Vec<Axis>,
    pub converters: Vec<Converter>,
    /// What each load draws, and from which converter.
    pub loads: Vec<(f64, usize)>,
    pub spindle: Option<Spindle>,
    pub independent: bool,
    /// Largest overrides of feeds and of rapids, as factors.
    pub overrides: [f64; 2],
    /// What the margin leaves of limits.
    pub share: f64,
}

fn number(value: &Value) -> f64 {
    let whole = value.as_integer().map(|whole| whole as f64);
    value.as_float().or(whole).unwrap()
}

/// A number of a table, or its default.
pub fn get(table: &Table, key: &str, default: f64) -> f64 {
    table.get(key).map_or(default, number)
}

fn text<'t>(table: &'t Table, key: &str) -> &'t str {
    table.get(key).and_then(Value::as_str).unwrap_or_default()
}

/// The tables of a key that may stand once or several times.
pub fn tables<'t>(table: &'t Table, key: &str) -> Vec<&'t Table> {
    match table.get(key) {
        Some(Value::Array(list)) => list.iter().filter_map(Value::as_table).collect(),
        Some(Value::Table(one)) => vec![one],
        _ => vec![],
    }
}

impl Axis {
    fn new(letter: &str, table: &Table) -> Self {
        let turns = match text(table, "kind") {
            "" => "ABC".contains(letter),
            kind => kind == "rotary",
        };
        let unit = if turns { PI / 180.0 } else { 1e-3 };
        let gear = get(table, "gear_ratio", 1.0);
        let lead_m = table.get("lead_mm").map(|lead| 1e-3 * number(lead));
        // Motor radians per metre or per radian of the table.
        let k = match lead_m {
            Some(lead_m) if !turns => TAU * gear / lead_m,
            _ => gear,
        };
        let per_rpm = TAU / 60.0 / k / unit;
        let either = |load: &str, motor: &str, factor: f64| {
            let at_motor = get(table, motor, 0.0) * factor;
            table.get(load).map_or(at_motor, number)
        };
        let rapid = if turns {
            "rapid_deg_min"
        } else {
            "rapid_mm_min"
        };
        let per_min = get(table, rapid, 0.0) / 60.0;
        let speed = per_min.max(get(table, "max_speed_rpm", 0.0) * per_rpm);
        let accel = if turns { "accel_deg_s2" } else { "accel_mm_s2" };
        let accel = match table.get("accel_time_s") {
            Some(time) => speed / number(time),
            None => get(table, accel, 0.0),
        };
        let jerk = get(table, if turns { "jerk_deg_s3" } else { "jerk_mm_s3" }, 0.0);
        let points = |key: &str, speed_key: &str, force_key: &str, speed: f64, force: f64| {
            let list = tables(table, key).into_iter();
            list.map(|point| {
                let force_n = get(point, force_key, 0.0) * force;
                [get(point, speed_key, 0.0) * speed, force_n]
            })
            .collect::<Vec<_>>()
        };
        let mut curve = points("force_curve", "speed_mm_min", "force_n", 1.0 / 60.0, 1.0);
        curve.extend(points("torque_curve", "rpm", "torque_nm", per_rpm, k));
        Self {
            index: LETTERS.find(letter).unwrap(),
            unit,
            speed,
            accel,
            jerk: if jerk > 0.0 { jerk } else { f64::INFINITY },
            mass: either("mass_kg", "inertia_kg_m2", k * k),
            coulomb: either("coulomb_n", "friction_nm", k),
            viscous: either("viscous_n_s_m", "viscous_nm_s_rad", k * k),
            gravity: either("gravity_n", "gravity_nm", k),
            efficiency: get(table, "efficiency", 1.0),
            copper: either("copper_w_n2", "copper_w_nm2", 1.0 / (k * k)),
            factors: ["servo_factor_motor", "servo_factor_regen"].map(|key| get(table, key, 1.0)),
            warm: get(table, "friction_min_ratio", 1.0),
            curve,
        }
    }

    /// The largest force of the drive at a speed; straight between the points.
    pub fn force_n(&self, speed: f64) -> f64 {
        let Some(last) = self.curve.last() else {
            return f64::INFINITY;
        };
        let mut pairs = self.curve.windows(2);
        pairs
            .find(|pair| speed <= pair[1][0])
            .map_or(last[1], |pair| {
                let [[v0, f0], [v1, f1]] = [pair[0], pair[1]];
                f0 + (speed - v0) / (v1 - v0) * (f1 - f0)
            })
    }
}

impl Plant {
    /// Reads a machine file that is known to be right.
    pub fn new(toml: &str) -> Self {
        let file: Table = toml.parse().unwrap();
        let axes = file["axes"].as_table().unwrap();
        let mut axes: Vec<Axis> = axes
            .iter()
            .map(|(letter, table)| Axis::new(letter, table.as_table().unwrap()))
            .collect();
        axes.sort_by_key(|axis| axis.index);
        let limits = file.get("limits").and_then(Value::as_table);
        let share = 1.0 - limits.map_or(0.1, |limits| get(limits, "margin", 0.1));
        let overrides = limits
            .and_then(|limits| limits.get("override_max_percent"))
            .and_then(Value::as_table);
        let factor = |key| overrides.map_or(1.0, |table| get(table, key, 100.0) / 100.0);
        let all: Vec<usize> = axes.iter().map(|axis| axis.index).collect();
        let converters: Vec<Converter> = tables(&file, "converter")
            .into_iter()
            .map(|table| Converter::new(table, &all, share))
            .collect();
        let fed_by = |table: &Table| {
            let name = text(table, "converter");
            converters.iter().position(|it| it.name == name).unwrap()
        };
        let loads = tables(&file, "load");
        let loads = loads
            .into_iter()
            .map(|load| (get(load, "power_w", 0.0), fed_by(load)));
        let path = file.get("path").and_then(Value::as_table);
        Self {
            loads: loads.collect(),
            spindle: tables(&file, "spindle").first().map(|table| Spindle {
                inertia: get(table, "inertia_kg_m2", 0.0),
                friction_nm: get(table, "friction_nm", 0.0),
                max_rpm: get(table, "max_rpm", 0.0),
                base_rpm: get(table, "base_rpm", 0.0),
                accel_time_s: get(table, "accel_time_s", 0.0),
                efficiency: get(table, "efficiency", 1.0),
                base_w: get(table, "base_load_w", 0.0),
                converter: fed_by(table),
            }),
            independent: path.is_some_and(|path| text(path, "rapid") == "independent"),
            overrides: [factor("feed"), factor("rapid")],
            share,
            axes,
            converters,
        }
    }
}

impl Converter {
    fn new(table: &Table, all: &[usize], share: f64) -> Self {
        let letters = table.get("axes").and_then(Value::as_array);
        let axes = letters.map(|letters| {
            let index = |letter: &Value| LETTERS.find(letter.as_str().unwrap()).unwrap();
            letters.iter().map(index).collect()
        });
        Self {
            name: text(table, "name").to_owned(),
            axes: axes.unwrap_or_else(|| all.to_vec()),
            limit_w: share * get(table, "peak_power_w", 0.0),
            regen_limit_w: share * get(table, "regen_power_w", f64::INFINITY),
            base_w: get(table, "base_load_w", 0.0),
            credit: table.get("credit_regen") == Some(&Value::Boolean(true)),
            table: table.clone(),
        }
    }
}
