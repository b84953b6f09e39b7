//! Input and output of a flexible axis, as they are fitted.

use super::agreement::agree;
use super::choice::{Choice, Method};
use super::column::Quantity;
use super::command_input::CommandInput;
use super::error::{IdentifyError, Outcome};
use super::quality;
use super::recording::Recording;
use super::state_space::Measured;

/// Input and output as they are fitted.
pub(super) struct Prepared {
    /// Input, held between samples.
    pub(super) input: Vec<f64>,
    /// Output, or differences of it.
    pub(super) output: Vec<f64>,
    /// What excites a closed loop.
    pub(super) excitation: Option<Vec<f64>>,
    /// What was measured.
    pub(super) measured: Measured,
    /// Sampling period, s.
    pub(super) period_s: f64,
    /// Whether the input is a force or torque.
    pub(super) is_force: bool,
    /// Whether input and output are positions.
    pub(super) positions: bool,
    /// By how much the fitted delay is longer than that of the load, s: what the
    /// input was taken early, less what made it late.
    pub(super) early_s: f64,
    /// Input and output by name.
    pub(super) names: (String, String),
}

/// Input and output of a recording.
///
/// # Errors
///
/// When one is missing, stands still or is cut off, or the recording is too short.
pub(super) fn prepare(recording: &Recording, choice: &Choice) -> Outcome<Prepared> {
    let t = recording.period_s;
    let help = "excite the axis: gwatt excite makes signals";
    let force = recording
        .get(Quantity::Force)
        .or_else(|| recording.get(Quantity::Excitation))
        .filter(|_| !choice.from_command);
    let command = recording.get(Quantity::Command);
    let (input_signal, is_force) = match (force, command) {
        (Some(force), _) => (force, true),
        (None, Some(command)) => (command, false),
        (None, None) => {
            return Err(IdentifyError::new(
                "there is neither torque nor force nor a position command in the recording",
                "add a column torque_nm, force_n, or position_command_mm",
            ));
        }
    };
    quality::moves(input_signal, help)?;
    agree(recording)?;
    // A command that stands at the end of its stroke is meant to.
    if is_force {
        quality::not_saturated(input_signal)?;
    }
    let pick = |quantity| recording.get(quantity);
    let (output_signal, measured) = pick(Quantity::Acceleration)
        .map(|s| (s, Measured::Direct))
        .or_else(|| pick(Quantity::Velocity).map(|s| (s, Measured::Velocity)))
        .or_else(|| pick(Quantity::Position).map(|s| (s, Measured::Position)))
        .ok_or_else(|| {
            IdentifyError::new(
                "there is no motion in the recording",
                "add the load's acceleration, speed or position, such as accel_m_s2",
            )
        })?;
    quality::moves(output_signal, help)?;
    if measured == Measured::Direct {
        quality::not_saturated(output_signal)?;
    }
    // From a command both sides are differenced as often as the noise of what was
    // measured stays white: positions not at all. The plain methods know held
    // inputs only.
    let command = if choice.method == Method::Iv {
        CommandInput::spline
    } else {
        CommandInput::held
    };
    let (input, output, runs, late_s) = if is_force {
        let input = input_signal.values.clone();
        let output = differences(&output_signal.values, measured, t);
        (input, output, measured, 0.0)
    } else {
        let command = command(&input_signal.values, measured, t);
        let output = output_signal.values.clone();
        (command.values, output, command.runs, command.late_s)
    };
    let excitation = pick(Quantity::Excitation)
        .filter(|signal| is_force && signal.name != input_signal.name)
        .map(|signal| signal.values.clone());
    let positions = !is_force && measured == Measured::Position;
    let mut prepared = Prepared {
        input,
        output,
        excitation,
        measured: runs,
        period_s: t,
        is_force,
        positions,
        early_s: 0.0,
        names: (input_signal.name.clone(), output_signal.name.clone()),
    };
    if !is_force {
        // A command that runs on between samples is half a period ahead of one that
        // is held: taken early, it comes late in either case.
        let lead = libm::ceil(late_s / prepared.period_s + 0.5 - 1e-9);
        take_early(&mut prepared.input, lead as usize);
        prepared.early_s = lead * prepared.period_s - late_s;
    }
    let samples = prepared.input.len();
    if samples < 256 {
        return Err(IdentifyError::new(
            format!("the recording is too short: {samples} samples"),
            "record some seconds: 4 s at 1 kHz are usual",
        ));
    }
    Ok(prepared)
}

/// Moves a signal so many samples forward; its end goes on as it was.
fn take_early(x: &mut [f64], samples: usize) {
    let samples = samples.min(x.len());
    x.copy_within(samples.., 0);
    let known = x.len() - samples;
    let (kept, end) = x.split_at_mut(known);
    end.fill(kept.last().copied().unwrap_or_default());
}

/// Differences that stand for the acceleration; the first ones, for which there
/// are no samples before, are 0.
fn differences(x: &[f64], measured: Measured, period_s: f64) -> Vec<f64> {
    match measured {
        Measured::Direct => x.to_vec(),
        Measured::Velocity => std::iter::once(0.0)
            .chain(
                x.iter()
                    .zip(x.iter().skip(1))
                    .map(|(a, b)| (b - a) / period_s),
            )
            .collect(),
        Measured::Position => [0.0, 0.0]
            .into_iter()
            .chain(x.windows(3).map(|w| {
                let sum: f64 = w.iter().zip([1.0, -2.0, 1.0]).map(|(x, k)| x * k).sum();
                sum / (period_s * period_s)
            }))
            .collect(),
    }
}
