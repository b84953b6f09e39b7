//! The frequency responses as a page with sliders: one file, no network.
//!
//! Everything that comes from outside stands in a block of JSON, in which
//! nothing can end a script; the script puts it into the page as text.

use std::f64::consts::{PI, TAU};
use std::io::{self, Write};

use serde_json::{Value, json};

use super::estimate::number;
use crate::identify::tune::{AxisResponse, LowPass, Tuned};
use crate::identify::{Factor, FrequencyResponse};

const PAGE: &str = include_str!("page/tune.html");
pub(super) const STYLE: &str = include_str!("page/tune.css");
const SCRIPTS: [&str; 3] = [
    include_str!("page/plot.js"),
    include_str!("page/tune.js"),
    include_str!("page/tune_view.js"),
];
/// Points of a measured response that can be distinguished.
const POINTS_MAX: usize = 2048;

/// Writes the page.
///
/// # Errors
///
/// When it cannot be written.
pub fn tune_page(tuned: &Tuned, out: &mut dyn Write) -> io::Result<()> {
    let data = harmless(&data(tuned).to_string());
    write_template(PAGE, &data, &SCRIPTS.concat(), out)
}

/// Writes a page: its style, data and scripts in place of their marks.
pub(super) fn write_template(
    page: &str,
    data: &str,
    scripts: &str,
    out: &mut dyn Write,
) -> io::Result<()> {
    let mut rest = page;
    for (mark, text) in [
        ("/*STYLE*/", STYLE),
        ("/*DATA*/", data),
        ("/*SCRIPT*/", scripts),
    ] {
        if let Some((before, after)) = rest.split_once(mark) {
            out.write_all(before.as_bytes())?;
            out.write_all(text.trim_end().as_bytes())?;
            rest = after;
        }
    }
    out.write_all(rest.as_bytes())
}

/// JSON in which no tag can begin or end.
pub(super) fn harmless(json: &str) -> String {
    let mut text = String::with_capacity(json.len());
    for letter in json.chars() {
        match letter {
            '<' => text.push_str("\\u003c"),
            '>' => text.push_str("\\u003e"),
            '&' => text.push_str("\\u0026"),
            other => text.push(other),
        }
    }
    text
}

fn data(tuned: &Tuned) -> Value {
    let (order, bandwidth_hz) = match tuned.correction.low_pass {
        LowPass::None => (0, 0.0),
        LowPass::Butterworth {
            order,
            bandwidth_hz,
        } => (order, bandwidth_hz),
    };
    json!({
        "wish": {
            "period_ms": 1e3 * tuned.wish.period_s,
            "discretize": tuned.wish.discretization.name(),
            "no_low_pass": tuned.wish.no_low_pass,
            "order": order,
            "bandwidth_hz": bandwidth_hz,
        },
        "band_hz": tuned.band_hz,
        "axes": tuned.axes.iter().map(axis).collect::<Vec<_>>(),
    })
}

fn axis(axis: &AxisResponse) -> Value {
    let (input, key) = match (axis.from_command, axis.rotary) {
        (true, _) => ("command", ""),
        (false, true) => ("torque", "inertia_kg_m2"),
        (false, false) => ("force", "mass_kg"),
    };
    let roots = |factors: &[Factor]| factors.iter().map(root).collect::<Vec<_>>();
    json!({
        "letter": axis.letter.to_string(),
        "source": axis.source,
        "input": input,
        "inertia_key": key,
        "inertia": number(axis.inertia),
        "delay_ms": 1e3 * axis.delay_s,
        "hold_s": axis.hold_s,
        "position_gain_1_s": number(axis.position_gain_1_s),
        "zeros": roots(&axis.zero_factors()),
        "further_zeros": roots(&axis.further_zeros),
        "poles": roots(&axis.poles),
        "measured": axis.measured.as_ref().map(measured),
    })
}

fn root(factor: &Factor) -> Value {
    match *factor {
        Factor::Pair {
            omega_rad_s,
            damping,
        } => json!({"frequency_hz": omega_rad_s / TAU, "damping": damping}),
        Factor::Real { time_constant_s } => json!({"time_constant_s": time_constant_s}),
    }
}

/// Gain and phase: of a long response every so many points.
fn measured(response: &FrequencyResponse) -> Value {
    let step = response.response.len().div_ceil(POINTS_MAX).max(1);
    // Eight digits: more cannot be seen, and pages stay small.
    let rounded = |x: f64| number(Some(super::figure::round_to_digits(x, 8)));
    let points = response.response.iter().step_by(step);
    let (gain, phase): (Vec<Value>, Vec<Value>) = points
        .map(|g| {
            (
                rounded(20.0 * libm::log10(g.norm())),
                rounded(libm::atan2(g.im, g.re) * 180.0 / PI),
            )
        })
        .unzip();
    let coherence = response.coherence.iter().step_by(step);
    let coherence = coherence.map(|it| number(Some(super::figure::round_to_digits(*it, 3))));
    let frequencies = response.frequency_hz.iter().step_by(step);
    json!({
        "frequency_hz": frequencies.map(|f| rounded(*f)).collect::<Vec<_>>(),
        "gain_db": gain,
        "phase_deg": phase,
        "coherence": coherence.collect::<Vec<_>>(),
    })
}
