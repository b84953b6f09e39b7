//! A tuning: for people, as JSON, and its filters as CSV.

use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::io::{self, Write};

use serde_json::{Value, json};

use super::estimate::{number, shown};
use crate::identify::Figure;
use crate::identify::Judgement;
use crate::identify::tune::{
    Advice, AxisResponse, Correction, DELAY_TOLERANCE_S, Gain, LowPass, Mismatch, Tuned,
    delays_agree,
};

/// What a difference of a millisecond makes of a circle at 1 m/min, µm.
const UM_PER_MS_AT_1_M_MIN: f64 = 1e3 / 60.0;

/// A tuning, for people.
#[must_use]
pub fn tuned_text(tuned: &Tuned) -> String {
    let mut text = String::new();
    for axis in &tuned.axes {
        axis_text(&mut text, axis);
    }
    filters_text(&mut text, tuned);
    efforts_text(&mut text, tuned);
    for pair in &tuned.pairs {
        let [a, b] = pair.letters;
        let _ = write!(
            text,
            "{a} and {b} differ up to {} Hz by {}, corrected by {}",
            tuned.band_hz,
            apart(pair.before, 1, 0),
            apart(pair.after, 3, 2)
        );
        if pair.error.gain_db > 0.0 && pair.error.gain_db.is_finite() {
            let _ = write!(
                text,
                "; errors of the zeros leave up to {}",
                apart(pair.error, 2, 1)
            );
        }
        text.push('\n');
    }
    delays_text(&mut text, tuned);
    text
}

fn apart(mismatch: Mismatch, gain: usize, phase: usize) -> String {
    format!(
        "{:.gain$} dB and {:.phase$}°",
        mismatch.gain_db, mismatch.phase_deg
    )
}

fn axis_text(text: &mut String, axis: &AxisResponse) {
    let input = if axis.from_command {
        "from the command"
    } else if axis.rotary {
        "from torque"
    } else {
        "from force"
    };
    let _ = write!(text, "{}: {}, {input}", axis.letter, axis.source);
    if let Some(inertia) = axis.inertia {
        let (name, unit) = if axis.rotary {
            ("inertia", "kg·m²")
        } else {
            ("mass", "kg")
        };
        let inertia = shown(Figure {
            value: inertia,
            std: f64::NAN,
        });
        let _ = write!(text, ", {name} {inertia} {unit}");
    }
    if let Some(excited) = axis.excited {
        let _ = write!(text, ", moved by {:.1} {} rms", excited.rms, excited.unit);
    }
    text.push('\n');
    if axis.zeros.is_empty() {
        text.push_str("  no anti-resonance: rigid\n");
    }
    for zero in &axis.zeros {
        let hz = |x: f64| x / TAU;
        let frequency = Figure {
            value: hz(zero.omega_rad_s.value),
            std: hz(zero.omega_rad_s.std),
        };
        let _ = writeln!(
            text,
            "  anti-resonance  {} Hz, damping {}",
            shown(frequency),
            shown(zero.damping)
        );
    }
    for note in &axis.notes {
        let _ = writeln!(text, "  note: {note}");
    }
    if let Some(judgement) = axis.judgement.filter(|it| *it != Judgement::Good) {
        let _ = writeln!(text, "  verdict: {judgement}");
    }
}

fn filters_text(text: &mut String, tuned: &Tuned) {
    let correction = &tuned.correction;
    if correction.filters.iter().all(|f| f.sections.is_empty()) {
        text.push_str(if tuned.axes.len() == 1 {
            "one axis alone has nothing to be matched to: give a recording of each axis that moves with it\n"
        } else {
            "no axis has an anti-resonance: nothing is to be evened out\n"
        });
        return;
    }
    let low_pass = match correction.low_pass {
        LowPass::None => "no low-pass".to_owned(),
        LowPass::Butterworth {
            order,
            bandwidth_hz,
        } => format!("low-pass of order {order} at {bandwidth_hz:.1} Hz"),
    };
    let _ = writeln!(
        text,
        "filters: {}, period {} ms, {low_pass}, {:.3} ms late",
        correction.discretization.name(),
        number_of(1e3 * correction.period_s),
        1e3 * correction.delay_s()
    );
    let names = ["b0", "b1", "b2", "a1", "a2"].map(|name| format!("{name:>14}"));
    let _ = writeln!(text, "  axis section{}", names.concat());
    for (axis, filter) in tuned.axes.iter().zip(&correction.filters) {
        for (index, section) in filter.sections.iter().enumerate() {
            let cells = section.coefficients().map(|c| format!("{c:>14.9}"));
            let _ = writeln!(
                text,
                "  {:<4} {:>7}{}",
                axis.letter,
                index + 1,
                cells.concat()
            );
        }
    }
}

/// What the filters ask of the axes.
fn efforts_text(text: &mut String, tuned: &Tuned) {
    for (index, axis) in tuned.axes.iter().enumerate() {
        let effort = tuned.correction.effort(index, 0.0);
        if effort.accel <= 1.0 && effort.gain <= 1.0 {
            continue;
        }
        let _ = write!(
            text,
            "  {}: gain up to {:.1} dB at {:.0} Hz; a jump of the command's acceleration takes {:.2} times as much",
            axis.letter,
            20.0 * libm::log10(effort.gain),
            effort.gain_hz,
            effort.accel
        );
        if let Some(inertia) = axis.inertia {
            let unit = if axis.rotary {
                "N·m for each rad/s²"
            } else {
                "N for each m/s²"
            };
            let force = shown(Figure {
                value: effort.accel * inertia,
                std: f64::NAN,
            });
            let _ = write!(text, ", {force} {unit}");
        }
        text.push('\n');
    }
}

fn number_of(value: f64) -> f64 {
    super::figure::round_to_digits(value, 6)
}

fn delays_text(text: &mut String, tuned: &Tuned) {
    let Some(advice) = &tuned.advice else {
        text.push_str(
            "delays of the loops are not in recordings of force: give --position-gain, or record position_command_mm\n",
        );
        return;
    };
    let delays: Vec<String> = tuned
        .axes
        .iter()
        .zip(advice)
        .map(|(axis, advice)| {
            let std = if advice.delay_std_s.is_finite() {
                format!(" ± {:.3}", 1e3 * advice.delay_std_s)
            } else {
                String::new()
            };
            format!("{} {:.3}{std} ms", axis.letter, 1e3 * advice.delay_s)
        })
        .collect();
    let delays = delays.join(", ");
    if delays_agree(advice) {
        let all = || advice.iter().map(|a| a.delay_s);
        let apart = all().fold(f64::MIN, f64::max) - all().fold(f64::MAX, f64::min);
        let how = if apart > DELAY_TOLERANCE_S {
            " as far as they are known"
        } else {
            ""
        };
        let _ = writeln!(text, "delays agree{how}: {delays}");
        return;
    }
    let earlier = || advice.iter().filter(|axis| axis.is_earlier);
    let most = earlier().map(|a| a.command_delay_s).fold(0.0, f64::max);
    let _ = writeln!(
        text,
        "delays do not agree: {delays}; circles come {:.1} µm out of round for each m/min of feed",
        1e3 * most * UM_PER_MS_AT_1_M_MIN
    );
    for (axis, advice) in tuned.axes.iter().zip(advice) {
        if !advice.is_earlier {
            continue;
        }
        let gain = match advice.gain {
            Some(Gain::Absolute(gain)) => format!("set its position loop to {gain:.2} 1/s, or "),
            Some(Gain::Factor(factor)) => {
                format!("lower the gain of its position loop to {factor:.4} of what it is, or ")
            }
            None => String::new(),
        };
        let _ = writeln!(
            text,
            "  {}: {gain}delay its command by {:.3} ms",
            axis.letter,
            1e3 * advice.command_delay_s
        );
    }
}

/// A tuning as JSON.
///
/// # Errors
///
/// When it cannot be written.
pub fn tuned_json(tuned: &Tuned, out: &mut dyn Write) -> io::Result<()> {
    let correction = &tuned.correction;
    let axes: Vec<Value> = tuned
        .axes
        .iter()
        .enumerate()
        .map(|(index, axis)| {
            let advice = tuned.advice.as_ref().and_then(|list| list.get(index));
            axis_json(axis, advice, correction, index)
        })
        .collect();
    let (order, bandwidth_hz) = match correction.low_pass {
        LowPass::None => (0, None),
        LowPass::Butterworth {
            order,
            bandwidth_hz,
        } => (order, Some(bandwidth_hz)),
    };
    let pairs: Vec<Value> = tuned
        .pairs
        .iter()
        .map(|pair| {
            json!({
                "axes": pair.letters.map(|l| l.to_string()),
                "before_db": number(Some(pair.before.gain_db)),
                "before_deg": number(Some(pair.before.phase_deg)),
                "after_db": number(Some(pair.after.gain_db)),
                "after_deg": number(Some(pair.after.phase_deg)),
                "error_db": number(Some(pair.error.gain_db)),
                "error_deg": number(Some(pair.error.phase_deg)),
            })
        })
        .collect();
    let value = json!({
        "band_hz": tuned.band_hz,
        "period_s": correction.period_s,
        "discretize": correction.discretization.name(),
        "low_pass_order": order,
        "low_pass_hz": number(bandwidth_hz),
        "delay_s": number(Some(correction.delay_s())),
        "delays_agree": tuned.advice.as_ref().map(|list| delays_agree(list)),
        "axes": axes,
        "pairs": pairs,
    });
    serde_json::to_writer_pretty(&mut *out, &value)?;
    writeln!(out)
}

fn axis_json(
    axis: &AxisResponse,
    advice: Option<&Advice>,
    correction: &Correction,
    index: usize,
) -> Value {
    let key = if axis.rotary {
        "inertia_kg_m2"
    } else {
        "mass_kg"
    };
    let zeros: Vec<Value> = axis
        .zeros
        .iter()
        .map(|zero| {
            json!({
                "frequency_hz": zero.omega_rad_s.value / TAU,
                "frequency_hz_std": number(Some(zero.omega_rad_s.std / TAU)),
                "omega_rad_s": zero.omega_rad_s.value,
                "damping": zero.damping.value,
                "damping_std": number(Some(zero.damping.std)),
            })
        })
        .collect();
    let dips: Vec<Value> = axis
        .dips
        .iter()
        .map(|dip| json!({"frequency_hz": dip.frequency_hz, "depth_db": dip.depth_db}))
        .collect();
    let sections: Vec<Value> = correction
        .filters
        .get(index)
        .map(|f| f.sections.iter().map(|s| json!(s.coefficients())).collect())
        .unwrap_or_default();
    let effort = correction.effort(index, 0.0);
    let (gain, factor) = match advice.and_then(|advice| advice.gain) {
        Some(Gain::Absolute(gain)) => (Some(gain), None),
        Some(Gain::Factor(factor)) => (None, Some(factor)),
        None => (None, None),
    };
    json!({
        "axis": axis.letter.to_string(),
        "source": axis.source,
        "input": if axis.from_command { "command" } else if axis.rotary { "torque" } else { "force" },
        key: number(axis.inertia),
        "rigid": axis.zeros.is_empty(),
        "zeros": zeros,
        "dips": dips,
        "accel_rms_mm_s2": number(axis.excited.map(|e| e.rms)),
        "accel_peak_mm_s2": number(axis.excited.map(|e| e.peak)),
        "sections": sections,
        "largest_gain_db": 20.0 * libm::log10(effort.gain),
        "largest_gain_hz": effort.gain_hz,
        "jump_factor": number(Some(effort.accel)),
        "delay_s": number(advice.map(|a| a.delay_s)),
        "delay_std_s": number(advice.map(|a| a.delay_std_s)),
        "command_delay_s": number(advice.map(|a| a.command_delay_s)),
        "position_gain_1_s": number(gain),
        "position_gain_factor": number(factor),
        "notes": axis.notes,
    })
}

/// The filters as CSV, a line for each section.
///
/// # Errors
///
/// When it cannot be written.
pub fn sections_csv(tuned: &Tuned, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "axis,section,period_s,b0,b1,b2,a1,a2")?;
    let period_s = tuned.correction.period_s;
    for (axis, filter) in tuned.axes.iter().zip(&tuned.correction.filters) {
        for (index, section) in filter.sections.iter().enumerate() {
            let [b0, b1, b2, a1, a2] = section.coefficients();
            writeln!(
                out,
                "{},{},{period_s},{b0},{b1},{b2},{a1},{a2}",
                axis.letter,
                index + 1
            )?;
        }
    }
    Ok(())
}
