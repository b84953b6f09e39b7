//! Parameters of a tuning as a TOML file: what the page saves, and what is
//! designed from again.

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::fmt::Write as _;

use serde::Deserialize;

use super::axis::{AxisResponse, Zero};
use super::correction::{Correction, Wish};
use super::discretize::Discretization;
use super::low_pass::LowPass;
use crate::error::{IdentifyError, Outcome};
use crate::transfer::Factor;

/// Letters in the order of reports.
const LETTERS: &str = "XYZABCUVWE";
/// Factors that an axis may have.
const FACTORS_MAX: usize = 32;

/// What a file says: axes without recordings, and how filters are made.
#[derive(Debug, Clone)]
pub struct Parameters {
    /// The axes.
    pub axes: Vec<AxisResponse>,
    /// Sampling period of the filters, s.
    pub period_s: Option<f64>,
    /// How they become digital.
    pub discretization: Option<Discretization>,
    /// Order of the low-pass.
    pub order: Option<usize>,
    /// Bandwidth of the low-pass, Hz.
    pub bandwidth_hz: Option<f64>,
    /// F = 1.
    pub no_low_pass: bool,
    /// Band in which the axes are compared, Hz.
    pub band_hz: Option<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    schema: u32,
    period_ms: Option<f64>,
    discretize: Option<String>,
    low_pass: Option<String>,
    order: Option<usize>,
    bandwidth_hz: Option<f64>,
    band_hz: Option<f64>,
    axes: BTreeMap<String, AxisTable>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct AxisTable {
    input: String,
    mass_kg: Option<f64>,
    inertia_kg_m2: Option<f64>,
    #[serde(default)]
    delay_ms: f64,
    lateness_std_ms: Option<f64>,
    position_gain_1_s: Option<f64>,
    #[serde(default)]
    zeros: Vec<FactorTable>,
    #[serde(default)]
    further_zeros: Vec<FactorTable>,
    #[serde(default)]
    poles: Vec<FactorTable>,
    /// The filter as it was: designed again.
    #[serde(default)]
    #[allow(dead_code, reason = "the file may have it")]
    filter: Vec<[f64; 5]>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FactorTable {
    frequency_hz: Option<f64>,
    damping: Option<f64>,
    time_constant_s: Option<f64>,
    frequency_std_hz: Option<f64>,
    damping_std: Option<f64>,
}

impl Parameters {
    /// Reads a file.
    ///
    /// # Errors
    ///
    /// What is wrong with it, with its line.
    pub fn read(text: &str) -> Outcome<Self> {
        let file: File = toml::from_str(text).map_err(|error| {
            IdentifyError::new(
                format!(
                    "this is no file of parameters: {}",
                    error.to_string().trim_end()
                ),
                "gwatt tune --toml writes one, and so does the page's button",
            )
        })?;
        if file.schema != 1 {
            return Err(refused(format!("schema {} is not known", file.schema)));
        }
        let no_low_pass = match file.low_pass.as_deref() {
            None | Some("butterworth") => false,
            Some("none") => true,
            Some(other) => return Err(refused(format!("low_pass = \"{other}\" is not known"))),
        };
        let discretization = match file.discretize.as_deref() {
            None => None,
            Some(name) => Some(
                Discretization::from_name(name)
                    .ok_or_else(|| refused(format!("discretize = \"{name}\" is not known")))?,
            ),
        };
        for (key, value) in [
            ("period_ms", file.period_ms),
            ("bandwidth_hz", file.bandwidth_hz),
            ("band_hz", file.band_hz),
        ] {
            positive(key, value)?;
        }
        let mut axes = Vec::new();
        for (name, table) in &file.axes {
            axes.push(axis(name, table)?);
        }
        axes.sort_by_key(|axis| LETTERS.find(axis.letter));
        Ok(Self {
            axes,
            period_s: file.period_ms.map(|ms| ms * 1e-3),
            discretization,
            order: file.order,
            bandwidth_hz: file.bandwidth_hz,
            no_low_pass,
            band_hz: file.band_hz,
        })
    }

    /// Writes a file: the axes, what was asked for, and the filters.
    #[must_use]
    pub fn write(
        axes: &[AxisResponse],
        wish: &Wish,
        band_hz: f64,
        correction: &Correction,
    ) -> String {
        let mut text = "# gwatt tune: read it back with --from\nschema = 1\n".to_owned();
        let _ = writeln!(text, "period_ms = {:?}", 1e3 * wish.period_s);
        let _ = writeln!(text, "discretize = \"{}\"", wish.discretization.name());
        if wish.no_low_pass {
            text.push_str("low_pass = \"none\"\n");
        } else if let LowPass::Butterworth {
            order,
            bandwidth_hz,
        } = correction.low_pass
        {
            text.push_str("low_pass = \"butterworth\"\n");
            let _ = writeln!(text, "order = {order}");
            let _ = writeln!(text, "bandwidth_hz = {bandwidth_hz:?}");
        }
        let _ = writeln!(text, "band_hz = {band_hz:?}");
        for (index, axis) in axes.iter().enumerate() {
            write_axis(&mut text, axis);
            if let Some(filter) = correction.filters.get(index) {
                text.push_str("filter = [ # b0, b1, b2, a1, a2\n");
                for section in &filter.sections {
                    let _ = writeln!(text, "  {:?},", section.coefficients());
                }
                text.push_str("]\n");
            }
        }
        text
    }
}

fn refused(message: String) -> IdentifyError {
    IdentifyError::new(message, "gwatt tune --toml writes files that it reads back")
}

fn positive(key: &str, value: Option<f64>) -> Outcome<()> {
    match value {
        Some(value) if !(value > 0.0 && value.is_finite()) => {
            Err(refused(format!("{key} = {value} is not positive")))
        }
        _ => Ok(()),
    }
}

/// Whether an axis turns, whether its input is a command, and its mass or inertia; what does not
/// go together is refused.
fn input_of(letter: char, table: &AxisTable) -> Outcome<(bool, bool, Option<f64>)> {
    let (rotary, from_command) = match table.input.as_str() {
        "force" => (false, false),
        "torque" => (true, false),
        "command" => (false, true),
        other => {
            return Err(refused(format!(
                "axis {letter}: input = \"{other}\" is not \"force\", \"torque\" or \"command\""
            )));
        }
    };
    let inertia = if rotary {
        table.inertia_kg_m2
    } else {
        table.mass_kg
    };
    let (key, other) = if rotary {
        ("inertia_kg_m2", table.mass_kg)
    } else {
        ("mass_kg", table.inertia_kg_m2)
    };
    positive(key, inertia)?;
    positive("position_gain_1_s", table.position_gain_1_s)?;
    if table
        .lateness_std_ms
        .is_some_and(|std| std.is_nan() || std < 0.0)
    {
        return Err(refused(format!(
            "axis {letter}: lateness_std_ms is not 0 or more"
        )));
    }
    if other.is_some() || inertia.is_none() != from_command {
        return Err(refused(format!(
            "axis {letter}: from a {} there is {}",
            table.input,
            if from_command {
                "neither mass_kg nor inertia_kg_m2".to_owned()
            } else {
                format!("{key}, and nothing else for it")
            }
        )));
    }
    if !(0.0..10_000.0).contains(&table.delay_ms) {
        return Err(refused(format!(
            "axis {letter}: delay_ms = {} is not between 0 and 10000",
            table.delay_ms
        )));
    }
    if table.zeros.len() + table.further_zeros.len() + table.poles.len() > FACTORS_MAX {
        return Err(refused(format!(
            "axis {letter}: more than {FACTORS_MAX} zeros and poles"
        )));
    }
    Ok((rotary, from_command, inertia))
}

fn axis(name: &str, table: &AxisTable) -> Outcome<AxisResponse> {
    let mut letters = name.chars();
    let letter = letters
        .next()
        .filter(|letter| LETTERS.contains(*letter) && letters.next().is_none())
        .ok_or_else(|| refused(format!("[axes.{name}]: {name} is no axis")))?;
    let (rotary, from_command, inertia) = input_of(letter, table)?;
    let zeros = evened(letter, &table.zeros)?;
    let list = |entries: &[FactorTable]| -> Outcome<Vec<Factor>> {
        entries.iter().map(|entry| factor(letter, entry)).collect()
    };
    let (further_zeros, poles) = (list(&table.further_zeros)?, list(&table.poles)?);
    let axis = AxisResponse {
        letter,
        source: String::new(),
        excited: None,
        rotary,
        from_command,
        inertia,
        zeros,
        further_zeros,
        poles,
        delay_s: table.delay_ms * 1e-3,
        lateness_std_s: table.lateness_std_ms.map_or(f64::NAN, |ms| ms * 1e-3),
        position_gain_1_s: table.position_gain_1_s,
        measured: None,
        hold_s: 0.0,
        dips: Vec::new(),
        judgement: None,
        notes: Vec::new(),
    };
    if !axis.transfer().is_stable() {
        return Err(IdentifyError::new(
            format!("axis {letter}: a pole is not stable"),
            "poles have a damping above 0, or a time constant above 0",
        ));
    }
    Ok(axis)
}

/// The zeros that are evened out.
fn evened(letter: char, entries: &[FactorTable]) -> Outcome<Vec<Zero>> {
    let mut zeros = Vec::new();
    for entry in entries {
        let Factor::Pair {
            omega_rad_s,
            damping,
        } = factor(letter, entry)?
        else {
            return Err(refused(format!(
                "axis {letter}: a zero with a time constant belongs to further_zeros"
            )));
        };
        let mut zero = Zero::exact(omega_rad_s, damping);
        zero.omega_rad_s.std = entry.frequency_std_hz.map_or(f64::NAN, |std| std * TAU);
        zero.damping.std = entry.damping_std.unwrap_or(f64::NAN);
        zeros.push(zero);
    }
    Ok(zeros)
}

fn factor(letter: char, entry: &FactorTable) -> Outcome<Factor> {
    let finite = |value: f64| value.is_finite();
    match (entry.frequency_hz, entry.damping, entry.time_constant_s) {
        (Some(hz), Some(damping), None) if hz > 0.0 && finite(hz) && finite(damping) => {
            Ok(Factor::Pair {
                omega_rad_s: hz * TAU,
                damping,
            })
        }
        (None, None, Some(time_constant_s))
            if time_constant_s != 0.0 && finite(time_constant_s) =>
        {
            Ok(Factor::Real { time_constant_s })
        }
        _ => Err(refused(format!(
            "axis {letter}: a zero or pole needs frequency_hz above 0 and damping, or time_constant_s alone"
        ))),
    }
}

fn write_axis(text: &mut String, axis: &AxisResponse) {
    let (input, key) = match (axis.from_command, axis.rotary) {
        (true, _) => ("command", ""),
        (false, true) => ("torque", "inertia_kg_m2"),
        (false, false) => ("force", "mass_kg"),
    };
    let _ = writeln!(text, "\n[axes.{}]\ninput = \"{input}\"", axis.letter);
    if let Some(inertia) = axis.inertia {
        let _ = writeln!(text, "{key} = {inertia:?}");
    }
    let _ = writeln!(text, "delay_ms = {:?}", 1e3 * axis.delay_s);
    if axis.lateness_std_s.is_finite() {
        let _ = writeln!(text, "lateness_std_ms = {:?}", 1e3 * axis.lateness_std_s);
    }
    if let Some(gain) = axis.position_gain_1_s {
        let _ = writeln!(text, "position_gain_1_s = {gain:?}");
    }
    text.push_str("zeros = [ # evened out\n");
    for zero in &axis.zeros {
        let hz = |omega: f64| omega / TAU;
        let (w, zeta) = (zero.omega_rad_s, zero.damping);
        let _ = write!(
            text,
            "  {{ frequency_hz = {:?}, damping = {:?}",
            hz(w.value),
            zeta.value
        );
        if w.std.is_finite() && zeta.std.is_finite() {
            let _ = write!(
                text,
                ", frequency_std_hz = {:?}, damping_std = {:?}",
                hz(w.std),
                zeta.std
            );
        }
        text.push_str(" },\n");
    }
    text.push_str("]\n");
    for (key, factors) in [
        ("further_zeros", &axis.further_zeros),
        ("poles", &axis.poles),
    ] {
        let _ = writeln!(text, "{key} = [");
        for factor in factors {
            let _ = match *factor {
                Factor::Pair {
                    omega_rad_s,
                    damping,
                } => writeln!(
                    text,
                    "  {{ frequency_hz = {:?}, damping = {damping:?} }},",
                    omega_rad_s / TAU
                ),
                Factor::Real { time_constant_s } => {
                    writeln!(text, "  {{ time_constant_s = {time_constant_s:?} }},")
                }
            };
        }
        text.push_str("]\n");
    }
}
