//! What was identified: for people, and as JSON with flat keys.

use std::fmt::Write as _;
use std::io::{self, Write};

use serde_json::{Map, Value, json};

use super::effects::{effects_json, effects_text, saturation_json};
use super::estimate::{insert, number, shown};
use crate::identify::flexible::{Flexible, Root};
use crate::identify::judgement::{self, Judgement};
use crate::identify::merge::rounded_up;
use crate::identify::power_fit::PowerModel;
use crate::identify::rigid::Rigid;
use crate::identify::{Factor, Figure};

/// What stands at the head of a result.
#[derive(Debug, Clone)]
pub struct Heading {
    /// Name of the recording.
    pub recording: String,
    /// Letter of the axis.
    pub axis: char,
    /// Torque and inertia, where a slide would have force and mass.
    pub rotary: bool,
    /// Relative error on a second recording.
    pub validation: Option<f64>,
    /// Torque was recorded with a motion in metres, or force with one in radians, and no lead is
    /// known.
    pub lever_is_missing: bool,
    /// Remarks.
    pub notes: Vec<String>,
}

impl Heading {
    fn units(&self) -> [&'static str; 3] {
        if self.rotary {
            ["kg·m²", "N·m·s/rad", "N·m"]
        } else {
            ["kg", "N·s/m", "N"]
        }
    }

    /// The unit of acceleration by what drives it.
    #[cfg(feature = "html")]
    pub(super) fn response_unit(&self) -> &'static str {
        if self.rotary { "1/(kg·m²)" } else { "1/kg" }
    }

    /// What drives it.
    #[cfg(feature = "html")]
    pub(super) fn force_name(&self) -> &'static str {
        if self.rotary { "torque" } else { "force" }
    }

    /// Keys of mass, viscous friction, Coulomb friction and offset.
    fn keys(&self) -> [&'static str; 4] {
        let mass = if self.rotary {
            "inertia_kg_m2"
        } else {
            "mass_kg"
        };
        [mass, "viscous_n_s_m", "coulomb_n", "offset_n"]
    }

    fn start(&self, model: &str) -> Map<String, Value> {
        let mut map = Map::new();
        map.insert("recording".into(), json!(self.recording));
        map.insert("axis".into(), json!(self.axis.to_string()));
        map.insert("model".into(), json!(model));
        map.insert("rotary".into(), json!(self.rotary));
        map.insert("notes".into(), json!(self.notes));
        map.insert("validation_rel_error".into(), number(self.validation));
        map
    }
}

fn finish(map: Map<String, Value>, out: &mut dyn Write) -> io::Result<()> {
    serde_json::to_writer_pretty(&mut *out, &Value::Object(map))?;
    writeln!(out)
}

fn judged(map: &mut Map<String, Value>, judgement: Judgement) {
    map.insert("verdict".into(), json!(judgement.word()));
    let times = match judgement {
        Judgement::ExciteLonger { times } => Some(times),
        _ => None,
    };
    map.insert("times_longer".into(), number(times));
}

/// A rigid axis as JSON.
///
/// # Errors
///
/// When it cannot be written.
pub fn rigid_json(heading: &Heading, rigid: &Rigid, out: &mut dyn Write) -> io::Result<()> {
    let mut map = heading.start("rigid");
    let [mass, viscous, coulomb, offset] = heading.keys();
    insert(&mut map, mass, Some(rigid.mass));
    insert(&mut map, viscous, rigid.viscous);
    insert(&mut map, coulomb, rigid.coulomb);
    insert(&mut map, offset, rigid.offset);
    if rigid.constant.is_some() {
        insert(&mut map, "coulomb_and_offset_n", rigid.constant);
    }
    map.insert("friction".into(), json!(rigid.friction()));
    map.insert("recordings".into(), json!(rigid.recordings));
    if let Some(directions) = rigid.directions {
        for (name, (b, f)) in ["forward", "backward"].iter().zip(directions) {
            insert(&mut map, &format!("viscous_{name}_n_s_m"), Some(b));
            insert(&mut map, &format!("coulomb_{name}_n"), Some(f));
        }
    }
    map.insert("rel_error".into(), number(Some(rigid.rel_error)));
    map.insert("noise_share".into(), number(Some(rigid.noise_share)));
    map.insert("zeros".into(), json!([]));
    map.insert("poles".into(), json!([]));
    map.insert("samples".into(), json!(rigid.samples));
    map.insert("bandwidth_hz".into(), json!(rigid.bandwidth_hz));
    map.insert("white".into(), json!(rigid.whiteness.is_white()));
    map.insert("resonates".into(), json!(rigid.resonates));
    if rigid.lateness_s.is_some() {
        insert(&mut map, "force_late_s", rigid.lateness_s);
    }
    if rigid.out_of_step_s.is_some() {
        insert(&mut map, "force_out_of_step_s", rigid.out_of_step_s);
    }
    if rigid.change.is_some() {
        insert(&mut map, "mass_change", rigid.change);
    }
    map.insert("effects".into(), effects_json(rigid));
    map.insert("saturation".into(), saturation_json(rigid));
    judged(&mut map, judgement::rigid(rigid));
    finish(map, out)
}

/// A flexible axis as JSON.
///
/// # Errors
///
/// When it cannot be written.
pub fn flexible_json(
    heading: &Heading,
    method: &str,
    axis: &Flexible,
    out: &mut dyn Write,
) -> io::Result<()> {
    let mut map = heading.start("flexible");
    let [mass, viscous, coulomb, _] = heading.keys();
    map.insert("method".into(), json!(method));
    insert(&mut map, mass, axis.inertia);
    insert(&mut map, viscous, axis.viscous);
    insert(&mut map, coulomb, axis.coulomb);
    map.insert("gain".into(), number(Some(axis.transfer.gain)));
    map.insert("rel_error".into(), number(Some(axis.rel_error)));
    if axis.change.is_some() {
        insert(&mut map, "mass_change", axis.change);
    }
    map.insert("zeros".into(), axis.zeros.iter().map(root).collect());
    map.insert(
        "unclear_zeros".into(),
        axis.unclear_zeros.iter().map(root).collect(),
    );
    map.insert("poles".into(), axis.poles.iter().map(root).collect());
    map.insert(
        "numerator".into(),
        axis.transfer.zeros.iter().map(factor).collect(),
    );
    map.insert(
        "denominator".into(),
        axis.transfer.poles.iter().map(factor).collect(),
    );
    insert(&mut map, "delay_s", Some(axis.delay_s));
    map.insert("order".into(), json!(axis.transfer.order()));
    map.insert("zero_count".into(), json!(axis.transfer.zero_count()));
    map.insert("samples".into(), json!(axis.samples));
    map.insert("seconds".into(), json!(axis.seconds));
    map.insert("white".into(), json!(axis.whiteness.is_white()));
    map.insert("noise_order".into(), json!(axis.noise_order));
    judged(&mut map, judgement::flexible(axis));
    finish(map, out)
}

fn root(root: &Root) -> Value {
    let (w, zeta) = (root.omega_rad_s, root.damping);
    let turn = 2.0 * std::f64::consts::PI;
    let mut map = Map::new();
    insert(&mut map, "omega_rad_s", Some(w));
    insert(
        &mut map,
        "frequency_hz",
        Some(Figure {
            value: w.value / turn,
            std: w.std / turn,
        }),
    );
    insert(&mut map, "damping", Some(zeta));
    map.insert("real".into(), number(Some(-zeta.value * w.value)));
    let square = (1.0 - zeta.value * zeta.value).max(0.0);
    map.insert("imag".into(), number(Some(w.value * square.sqrt())));
    Value::Object(map)
}

fn factor(factor: &Factor) -> Value {
    match *factor {
        Factor::Pair {
            omega_rad_s,
            damping,
        } => json!({"omega_rad_s": omega_rad_s, "damping": damping}),
        Factor::Real { time_constant_s } => json!({"time_constant_s": time_constant_s}),
    }
}

/// A power model as JSON.
///
/// # Errors
///
/// When it cannot be written.
pub fn power_model_json(
    heading: &Heading,
    model: &PowerModel,
    out: &mut dyn Write,
) -> io::Result<()> {
    let mut map = heading.start("power");
    let [mass, viscous, coulomb, _] = heading.keys();
    insert(&mut map, mass, Some(model.mass));
    insert(&mut map, viscous, Some(model.viscous));
    insert(&mut map, coulomb, Some(model.coulomb));
    insert(&mut map, "standby_w", Some(model.standby_w));
    insert(&mut map, "efficiency", Some(model.efficiency));
    let figures = [
        ("r2", model.r2),
        ("r2_centered", model.r2_centered),
        ("rms_w", model.rms_w),
        ("peak_measured_w", model.peak_measured_w),
        ("peak_model_w", model.peak_model_w),
        ("peak_factor", model.peaks.factor),
        ("peak_factor_seen", model.peaks.seen),
        ("margin", margin(model)),
    ];
    for (key, value) in figures {
        map.insert(key.into(), number(Some(value)));
    }
    map.insert("peaks".into(), json!(model.peaks.peaks));
    map.insert("rows".into(), json!(model.rows));
    judged(&mut map, judgement::power(model));
    finish(map, out)
}

/// The margin of the converter's power that covers what measured peaks exceed
/// the model by.
#[must_use]
pub fn margin(model: &PowerModel) -> f64 {
    1.0 - 1.0 / model.peaks.factor.max(1.0)
}

fn percent(share: f64) -> String {
    format!("{:.2} %", 100.0 * share)
}

fn tail(text: &mut String, heading: &Heading) {
    if let Some(error) = heading.validation {
        let _ = writeln!(
            text,
            "  on the second recording: relative error {}",
            percent(error)
        );
    }
}

/// A rigid axis, for people.
#[must_use]
pub fn rigid_text(heading: &Heading, rigid: &Rigid) -> String {
    let [mass, viscous, force] = heading.units();
    let mut text = format!(
        "{}: axis {}, rigid, {} samples in a band of {} Hz\n",
        heading.recording, heading.axis, rigid.samples, rigid.bandwidth_hz
    );
    let name = if heading.rotary { "inertia" } else { "mass" };
    let _ = writeln!(text, "  {name:<17} {} {mass}", shown(rigid.mass));
    if let Some(b) = rigid.viscous {
        let _ = writeln!(text, "  viscous friction  {} {viscous}", shown(b));
    }
    if let Some(f) = rigid.coulomb {
        let _ = writeln!(text, "  Coulomb friction  {} {force}", shown(f));
    }
    if let Some(both) = rigid.constant {
        let _ = writeln!(
            text,
            "  Coulomb + offset  {} {force}: known as a sum, as the axis moves one way only",
            shown(both)
        );
    } else if rigid.coulomb.is_none() {
        text.push_str("  friction          not known: no speed or position was recorded\n");
    } else if rigid.viscous.is_none() {
        text.push_str("  viscous friction  not known: the axis moves at one speed only\n");
    }
    for (name, (b, f)) in ["forward ", "backward"]
        .iter()
        .zip(rigid.directions.into_iter().flatten())
    {
        let _ = writeln!(
            text,
            "    {name}        {} {viscous}, {} {force}",
            shown(b),
            shown(f)
        );
    }
    if let Some(offset) = rigid.offset {
        let _ = writeln!(text, "  offset            {} {force}", shown(offset));
    }
    if let Some(lateness) = rigid.lateness_s {
        let milliseconds = Figure {
            value: 1e3 * lateness.value,
            std: 1e3 * lateness.std,
        };
        let _ = writeln!(
            text,
            "  force acts        {} ms later than recorded, and is taken so",
            shown(milliseconds)
        );
    }
    text.push_str(&effects_text(rigid, force));
    let _ = writeln!(text, "  relative error    {}", percent(rigid.rel_error));
    tail(&mut text, heading);
    let _ = writeln!(text, "verdict: {}", judgement::rigid(rigid));
    text
}

/// A flexible axis, for people.
#[must_use]
pub fn flexible_text(heading: &Heading, method: &str, axis: &Flexible) -> String {
    let [mass, viscous, force] = heading.units();
    let mut text = format!(
        "{}: axis {}, flexible ({method}), from {} to {}, {:.3} s\n",
        heading.recording, heading.axis, axis.signals.0, axis.signals.1, axis.seconds
    );
    if let Some(inertia) = axis.inertia {
        let name = if heading.rotary { "inertia" } else { "mass" };
        let _ = writeln!(text, "  {name:<17} {} {mass}", shown(inertia));
    }
    let frictions = [
        ("viscous friction", axis.viscous, viscous),
        ("Coulomb friction", axis.coulomb, force),
    ];
    for (name, figure, unit) in frictions {
        if let Some(figure) = figure {
            let _ = writeln!(text, "  {name:<17} {} {unit}", shown(figure));
        }
    }
    if axis.zeros.is_empty() {
        let _ = writeln!(text, "  anti-resonance    none");
    }
    let turn = 2.0 * std::f64::consts::PI;
    let lists = [
        ("anti-resonance", &axis.zeros),
        ("unclear, a zero", &axis.unclear_zeros),
        ("resonance", &axis.poles),
    ];
    for (name, root) in lists
        .iter()
        .flat_map(|(name, list)| list.iter().map(move |r| (name, r)))
    {
        let hertz = Figure {
            value: root.omega_rad_s.value / turn,
            std: root.omega_rad_s.std / turn,
        };
        let _ = writeln!(
            text,
            "  {name:<17} {} Hz, damping {}",
            shown(hertz),
            shown(root.damping)
        );
    }
    let delay = Figure {
        value: 1e3 * axis.delay_s.value,
        std: 1e3 * axis.delay_s.std,
    };
    let _ = writeln!(text, "  delay             {} ms", shown(delay));
    let white = if axis.whiteness.is_white() {
        "what is left is white"
    } else {
        "what is left is not white: the model misses something"
    };
    let _ = writeln!(
        text,
        "  order             {} poles, {} zeros",
        axis.transfer.order(),
        axis.transfer.zero_count()
    );
    let _ = writeln!(
        text,
        "  relative error    {}; {white}",
        percent(axis.rel_error)
    );
    if !axis.has_errors {
        let _ = writeln!(text, "  this method gives no standard errors");
    }
    tail(&mut text, heading);
    let judgement = judgement::flexible(axis);
    if axis.speed_is_summed && judgement != Judgement::Good {
        let _ = writeln!(
            text,
            "  there is friction, and its speed is a sum of accelerations: record speed or position too"
        );
    }
    let _ = writeln!(text, "verdict: {judgement}");
    text
}

/// A power model, for people.
#[must_use]
pub fn power_model_text(heading: &Heading, model: &PowerModel) -> String {
    let [mass, viscous, force] = heading.units();
    let mut text = format!(
        "{}: axis {}, {} rows\n",
        heading.recording, heading.axis, model.rows
    );
    let name = if heading.rotary { "inertia" } else { "mass" };
    let _ = writeln!(text, "  {name:<17} {} {mass}", shown(model.mass));
    let _ = writeln!(
        text,
        "  viscous friction  {} {viscous}",
        shown(model.viscous)
    );
    let _ = writeln!(text, "  Coulomb friction  {} {force}", shown(model.coulomb));
    let standby = if model.standby_w.value == 0.0 {
        "not seen in the log".to_owned()
    } else {
        format!("{} W", shown(model.standby_w))
    };
    let _ = writeln!(text, "  standby           {standby}");
    let efficiency = if model.efficiency.value < 1.0 {
        shown(model.efficiency)
    } else {
        "1, none other seen in the log".to_owned()
    };
    let _ = writeln!(text, "  efficiency        {efficiency}");
    // A model without a constant explains the square of the power, not its
    // deviation from a mean that it cannot set.
    let about_zero = if model.standby_w.value == 0.0 {
        format!("{:.4} about zero, as there is no standby; ", model.r2)
    } else {
        String::new()
    };
    let _ = writeln!(
        text,
        "  R²                {about_zero}{:.4} about the mean",
        model.r2_centered
    );
    let _ = writeln!(text, "  left over         {:.3} W rms", model.rms_w);
    let _ = writeln!(
        text,
        "  peaks             {:.1} W measured, {:.1} W by the model",
        model.peak_measured_w, model.peak_model_w
    );
    let peaks = model.peaks;
    let _ = writeln!(
        text,
        "  factor of peaks   {:.3}: 95 % of them stay below, with 95 % confidence, by {} that the other rows predict (largest {:.3}): margin {:.3}",
        peaks.factor,
        peaks.peaks,
        peaks.seen,
        rounded_up(margin(model))
    );
    let _ = writeln!(text, "verdict: {}", judgement::power(model));
    text
}
