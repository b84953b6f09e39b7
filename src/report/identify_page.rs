//! What was identified as a page: the measured frequency response, the model over it, and what
//! it leaves. One file, no network.
//!
//! Everything that comes from outside stands in a block of JSON, in which nothing can end a
//! script; the script puts it into the page as text.

use std::f64::consts::PI;
use std::io::{self, Write};

use serde_json::{Value, json};

use super::estimate::number;
use super::figure::round_to_digits;
use super::identified::{Heading, flexible_text, rigid_text};
use super::tune_page::{harmless, write_template};
use crate::identify::flexible::Flexible;
use crate::identify::judgement::{self, Judgement};
use crate::identify::rigid::{Rigid, Trace};
use crate::identify::{FrequencyResponse, TransferFunction};

const PAGE: &str = include_str!("page/identify.html");
const SCRIPTS: [&str; 2] = [
    include_str!("page/plot.js"),
    include_str!("page/identify.js"),
];
/// Points of a response, and stretches of time, that can be distinguished.
const POINTS_MAX: usize = 2048;
const STRETCHES_MAX: usize = 1500;

/// Writes the page of a flexible axis.
///
/// # Errors
///
/// When it cannot be written.
pub fn flexible_page(
    heading: &Heading,
    method: &str,
    axis: &Flexible,
    out: &mut dyn Write,
) -> io::Result<()> {
    let fitted = TransferFunction {
        delay_s: axis.fitted_delay_s,
        ..axis.transfer.clone()
    };
    let (response, model) = responses(&axis.response, &fitted);
    let [_, output] = [&axis.signals.0, &axis.signals.1];
    let (title, said) = if axis.inertia.is_none() {
        (
            "gain, dB".to_owned(),
            "From the commanded acceleration to the real one.".to_owned(),
        )
    } else {
        (
            format!("gain, dB of {}", heading.response_unit()),
            format!(
                "From {} to the acceleration of {output}.",
                heading.force_name()
            ),
        )
    };
    let text = flexible_text(heading, method, axis);
    let mut data = head(heading, &text, judgement::flexible(axis));
    data["response"] = with(response, &title, &said, worst_root(axis));
    data["model"] = model;
    write(&data, out)
}

/// Writes the page of a rigid axis; `trace` lays it over its first recording.
///
/// # Errors
///
/// When it cannot be written.
pub fn rigid_page(
    heading: &Heading,
    rigid: &Rigid,
    trace: Option<&Trace>,
    out: &mut dyn Write,
) -> io::Result<()> {
    let text = rigid_text(heading, rigid);
    let mut data = head(heading, &text, judgement::rigid(rigid));
    let measured = trace.and_then(|trace| trace.response.as_ref());
    if let Some(measured) = measured {
        let model = TransferFunction {
            gain: 1.0 / rigid.mass.value,
            zeros: Vec::new(),
            poles: Vec::new(),
            delay_s: 0.0,
        };
        let (response, model) = responses(&within(measured, rigid.bandwidth_hz), &model);
        let title = format!("gain, dB of {}", heading.response_unit());
        let said = format!(
            "From {} without the model's friction to acceleration, up to the band's end: of a \
             rigid axis the gain is 1/{} at all frequencies.",
            heading.force_name(),
            if heading.rotary { "inertia" } else { "mass" }
        );
        data["response"] = with(response, &title, &said, 0);
        data["model"] = model;
    }
    if let Some(trace) = trace {
        data["trace"] = over_time(trace, rigid);
    }
    write(&data, out)
}

fn write(data: &Value, out: &mut dyn Write) -> io::Result<()> {
    write_template(PAGE, &harmless(&data.to_string()), &SCRIPTS.concat(), out)
}

/// What stands above the plots.
fn head(heading: &Heading, text: &str, judged: Judgement) -> Value {
    json!({
        "recording": heading.recording,
        "axis": heading.axis.to_string(),
        "unit": if heading.rotary { "N·m" } else { "N" },
        "word": judged.word(),
        "verdict": judged.to_string(),
        "good": judged == Judgement::Good,
        "text": text.trim_end(),
        "notes": heading.notes,
        "response": null,
        "model": null,
        "trace": null,
    })
}

fn with(mut response: Value, title: &str, said: &str, mark: usize) -> Value {
    response["title"] = json!(title);
    response["said"] = json!(said);
    let count = response["frequency_hz"].as_array().map_or(0, Vec::len);
    response["mark"] = json!(mark.min(count.saturating_sub(1)));
    response
}

/// A response up to a frequency.
fn within(measured: &FrequencyResponse, band_hz: f64) -> FrequencyResponse {
    let count = measured.frequency_hz.partition_point(|hz| *hz <= band_hz);
    let mut own = measured.clone();
    own.frequency_hz.truncate(count);
    own.response.truncate(count);
    own.coherence.truncate(count);
    own.variance.truncate(count);
    own
}

/// Points of a long response are left out evenly.
fn step_of(measured: &FrequencyResponse) -> usize {
    measured.response.len().div_ceil(POINTS_MAX).max(1)
}

/// The place of the first anti-resonance, or of the first resonance, among the points.
fn worst_root(axis: &Flexible) -> usize {
    let root = axis.zeros.first().or(axis.poles.first());
    let hz = root.map_or(0.0, |root| root.omega_rad_s.value / (2.0 * PI));
    let place = axis.response.frequency_hz.partition_point(|it| *it < hz);
    place / step_of(&axis.response)
}

/// A list of figures with eight digits: more cannot be seen, and pages stay small.
fn list(values: impl Iterator<Item = f64>) -> Vec<Value> {
    values
        .map(|value| number(Some(round_to_digits(value, 8))))
        .collect()
}

fn decibel(gain: f64) -> f64 {
    20.0 * libm::log10(gain)
}

/// The measured response with what the model leaves of it, and the model.
fn responses(measured: &FrequencyResponse, model: &TransferFunction) -> (Value, Value) {
    let step = step_of(measured);
    let hz = || measured.frequency_hz.iter().step_by(step).copied();
    let found = || measured.response.iter().step_by(step);
    let phase = |re: f64, im: f64| libm::atan2(im, re).to_degrees();
    let sizes: Vec<f64> = hz().map(|hz| model.at_hz(hz).norm()).collect();
    let off = found()
        .zip(hz())
        .map(|(g, hz)| (g - model.at_hz(hz)).norm());
    let left = off.zip(&sizes).map(|(off, size)| decibel(off / size));
    let variance = measured.variance.iter().step_by(step);
    let error = variance.zip(&sizes);
    let error = error.map(|(variance, size)| decibel(variance.sqrt() / size));
    let response = json!({
        "frequency_hz": list(hz()),
        "gain_db": list(found().map(|g| decibel(g.norm()))),
        "phase_deg": list(found().map(|g| phase(g.re, g.im))),
        "coherence": list(measured.coherence.iter().step_by(step).copied()),
        "left_db": list(left),
        "error_db": list(error),
    });
    let model = json!({
        "gain_db": list(sizes.iter().map(|size| decibel(*size))),
        "phase_deg": list(hz().map(|hz| model.at_hz(hz)).map(|m| phase(m.re, m.im))),
    });
    (response, model)
}

/// Force over time: of each stretch the smallest and the largest value.
fn over_time(trace: &Trace, rigid: &Rigid) -> Value {
    let count = trace.force.len();
    let each = count.div_ceil(STRETCHES_MAX).max(1);
    let left: Vec<f64> = trace
        .force
        .iter()
        .zip(&trace.modelled)
        .map(|(f, m)| f - m)
        .collect();
    let ends = |values: &[f64]| -> Vec<Value> {
        if each == 1 {
            return list(values.iter().copied());
        }
        let stretches = values.chunks(each);
        list(stretches.flat_map(|stretch| {
            let least = stretch.iter().copied().fold(f64::INFINITY, f64::min);
            let most = stretch.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            [least, most]
        }))
    };
    let starts = (0..count).step_by(each).map(|k| k as f64 * trace.step_s);
    let times = if each == 1 {
        list(starts)
    } else {
        let half_s = 0.5 * each as f64 * trace.step_s;
        list(starts.flat_map(|t| [t, t + half_s]))
    };
    let standing = trace.counts.iter().filter(|counts| !**counts).count();
    let joined = if rigid.recordings > 1 {
        format!("The first of {} recordings. ", rigid.recordings)
    } else {
        String::new()
    };
    let stands = if standing > 0 {
        format!(" Of {count} samples {standing} do not count, since the axis stands there.")
    } else {
        String::new()
    };
    json!({
        "said": format!(
            "{joined}In the band up to {} Hz. Solid: recorded. Dashed: the model.{stands}",
            rigid.bandwidth_hz
        ),
        "time_s": times,
        "force": ends(&trace.force),
        "modelled": ends(&trace.modelled),
        "left": ends(&left),
    })
}
