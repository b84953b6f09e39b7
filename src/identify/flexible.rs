//! Flexible axes: from a recording to resonances and anti-resonances.

use super::arx;
use super::column::Quantity;
use super::command_input::CommandInput;
use super::data::Data;
use super::disturbance::as_it_is;
use super::leaky::Leaky;
use super::methods::{Modelled, by_arx, by_response, by_search, by_subspace};
use super::neighbours::{FAST, Given};
use super::noise::Whiteness;
use super::output_error::residuals;
use super::parameters::parameters;
use super::quality;
use super::recording::Recording;
use super::rigid::Figure;
use super::search::{LAGS, filtered};
use super::spectrum::{FrequencyResponse, excited_rad_s, explained_share};
use super::state_space::Measured;
use super::transfer::{Factor, TransferFunction};
use super::trouble::{Outcome, Trouble};

/// How the transfer function is estimated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// Instrumental variables.
    Iv,
    /// Plain least squares.
    Arx,
    /// Through the averaged frequency response.
    Frequency,
    /// Subspaces (MOESP).
    Subspace,
}

/// What may be chosen.
#[derive(Debug, Clone)]
pub struct Choice {
    /// The method.
    pub method: Method,
    /// What is given instead of searched for.
    pub given: Given,
    /// The position command is the input, though a force is recorded.
    pub from_command: bool,
}

/// A resonance or anti-resonance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Root {
    /// rad/s.
    pub omega_rad_s: Figure,
    /// Damping ratio.
    pub damping: Figure,
}

/// A flexible axis.
#[derive(Debug, Clone)]
pub struct Flexible {
    /// The model, from force to acceleration (from commanded to real
    /// acceleration where the command is the input).
    pub transfer: TransferFunction,
    /// Inertia or mass: 1/gain. Absent from a command.
    pub inertia: Option<Figure>,
    /// Anti-resonances: zeros that make a dip.
    pub zeros: Vec<Root>,
    /// Zeros of which the recording does not tell whether there are any: their
    /// frequency is not known to a tenth. The model has them to explain other things,
    /// such as a delay.
    pub unclear_zeros: Vec<Root>,
    /// Resonances.
    pub poles: Vec<Root>,
    /// Delay; from a command that is held, its half period of holding too.
    pub delay_s: Figure,
    /// The delay that was fitted, s: from a command it is longer by half a
    /// period or a whole one, as the input was taken early.
    pub fitted_delay_s: f64,
    /// Norm of what is left by norm of the output; of a position or speed the smaller
    /// one of its differences, and after leaky integrators.
    pub rel_error: f64,
    /// Whiteness of what is left, after the filter for coloured noise.
    pub whiteness: Whiteness,
    /// Order of that filter; 0 for white noise.
    pub noise_order: usize,
    /// Which share of what is left the input explains, as any linear system could: what
    /// the model misses of the axis, where the rest is noise.
    pub missed_share: f64,
    /// Whiteness of the squares of what is left: noise of one strength has it, what comes
    /// and goes with the motion has not.
    pub steadiness: Whiteness,
    /// What leaky integrators lose from sample to sample, through which a position or
    /// speed and the force went to be compared; 0 without them.
    pub leak: f64,
    /// The measured response.
    pub response: FrequencyResponse,
    /// Input and output, by name.
    pub signals: (String, String),
    /// Samples and seconds that were used.
    pub samples: usize,
    /// Length of the recording, s.
    pub seconds: f64,
    /// True where standard errors are known.
    pub has_errors: bool,
}

/// Damping from which on a pair of zeros makes no dip, and a pair of poles no
/// peak: 1/√2.
const DIP: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Relative standard error of a frequency from which on a zero is not clear.
const UNCLEAR: f64 = 0.1;

/// Zeros farther beyond the band do not count as anti-resonances.
const BEYOND: f64 = 1.05;

/// Input and output as they are fitted.
pub(super) struct Prepared {
    input: Vec<f64>,
    output: Vec<f64>,
    pub(super) excitation: Option<Vec<f64>>,
    measured: Measured,
    period_s: f64,
    is_force: bool,
    positions: bool,
    /// By how much the fitted delay is longer than that of the load, s: what the
    /// input was taken early, less what made it late.
    early_s: f64,
    names: (String, String),
}

fn prepare(recording: &Recording, choice: &Choice) -> Outcome<Prepared> {
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
            return Err(Trouble::new(
                "there is neither torque nor force nor a position command in the recording",
                "add a column torque_nm, force_n, or position_command_mm",
            ));
        }
    };
    quality::moves(input_signal, help)?;
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
            Trouble::new(
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
    if prepared.input.len() < 256 {
        return Err(Trouble::new(
            format!(
                "the recording is too short: {} samples",
                prepared.input.len()
            ),
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

/// Identifies a flexible axis.
///
/// # Errors
///
/// What keeps the recording from being used, or a model from being found.
pub fn identify(recording: &Recording, choice: &Choice) -> Outcome<Flexible> {
    let prepared = prepare(recording, choice)?;
    let mut choice = choice.clone();
    let searches = matches!(choice.method, Method::Iv | Method::Frequency);
    let whole_s = libm::ceil(prepared.early_s / prepared.period_s) * prepared.period_s;
    let given = choice.given.delay_s.map(|delay| delay + prepared.early_s);
    choice.given.delay_s = given.or((!searches).then_some(whole_s));
    let undisturbed = match &prepared.excitation {
        Some(r) => Some(arx::undisturbed(r, &prepared.input).ok_or_else(|| {
            Trouble::new(
                "the input does not follow from the excitation",
                "check that the column of the excitation holds what was added to the torque",
            )
        })?),
        None => None,
    };
    let data = Data {
        input: &prepared.input,
        output: &prepared.output,
        undisturbed: undisturbed.as_deref(),
        period_s: prepared.period_s,
        measured: prepared.measured,
        from_command: !prepared.is_force,
        early_s: prepared.early_s,
        positions: prepared.positions,
        every: 1,
        leak: 0.0,
    };
    let find = |choice: &Choice| match choice.method {
        Method::Iv => by_search(&data, &prepared, choice),
        Method::Frequency => by_response(&data, &prepared, choice),
        Method::Arx => by_arx(&data, &prepared, choice),
        Method::Subspace => by_subspace(&data, &prepared, choice),
    };
    let found = find(&choice);
    let found = found.ok_or_else(|| {
        Trouble::new(
            "no stable model fits the recording",
            "check units and signs of the columns, excite longer, or give --order",
        )
    })?;
    describe(found, &data, &prepared)
}

/// Norm of what is left by norm of the output, means taken off.
fn share(data: &Data<'_>, left: &[f64]) -> f64 {
    let power = |x: &[f64]| -> f64 {
        let n = x.len().max(1) as f64;
        let mean = x.iter().sum::<f64>() / n;
        x.iter().map(|x| (x - mean) * (x - mean)).sum()
    };
    let all = power(data.output.get(data.skip()..).unwrap_or_default());
    (power(left) / all).sqrt()
}

/// Up to where zeros and poles are told, rad/s.
fn told(data: &Data<'_>, response: &FrequencyResponse) -> (f64, f64) {
    let band = std::f64::consts::PI / data.period_s;
    // A zero beyond what the recording shows stands for something else.
    let excited = if data.positions {
        excited_rad_s(&filtered(data.input, &[-2.0, 1.0]), data.period_s)
    } else {
        excited_rad_s(data.input, data.period_s)
    };
    let shown = band.min(BEYOND * excited.max(response.shown_rad_s()));
    // What the steps of a measured position make of a held input swings at the end of
    // the band too.
    let is_integrated = !data.from_command && data.measured.integrators() > 0;
    let highest = if is_integrated {
        FAST / data.period_s
    } else {
        band
    };
    (shown, highest)
}

fn describe(found: Modelled, data: &Data<'_>, prepared: &Prepared) -> Outcome<Flexible> {
    let leaky = found.noise.held(data);
    let compared = leaky.as_ref().map_or(*data, |leaky| leaky.data(data));
    let estimate = &found.estimate;
    let mut transfer = estimate.transfer.clone();
    let fitted_delay_s = transfer.delay_s;
    let left = residuals(&compared, estimate).unwrap_or_default();
    let mut rel_error = share(&compared, &left);
    if leaky.is_some() {
        let plain = as_it_is(data, &transfer).and_then(|plain| residuals(data, &plain));
        rel_error = rel_error.min(plain.map_or(f64::MAX, |left| share(data, &left)));
    }
    let std = |index: usize| {
        if found.has_errors {
            estimate.std(index).unwrap_or(f64::NAN)
        } else {
            f64::NAN
        }
    };
    let gain = transfer.gain;
    if gain == 0.0 || !gain.is_finite() {
        return Err(Trouble::new(
            "the axis does not answer the input",
            "check that input and motion are of the same axis and the same time",
        ));
    }
    let mut at = 1;
    let mut zeros = Vec::new();
    let mut unclear_zeros = Vec::new();
    let mut poles = Vec::new();
    let (shown, highest) = told(data, &found.response);
    for (index, factor) in transfer.zeros.iter().chain(&transfer.poles).enumerate() {
        if let Factor::Pair {
            omega_rad_s,
            damping,
        } = *factor
        {
            let root = Root {
                omega_rad_s: Figure {
                    value: omega_rad_s,
                    std: omega_rad_s * std(at),
                },
                damping: Figure {
                    value: damping,
                    std: std(at + 1),
                },
            };
            let is_zero = index < transfer.zeros.len();
            let band = if is_zero { shown } else { highest };
            if damping.abs() < DIP && omega_rad_s < band {
                if is_zero && std(at) > UNCLEAR {
                    unclear_zeros.push(root);
                } else if is_zero {
                    zeros.push(root);
                } else {
                    poles.push(root);
                }
            }
        }
        at += factor.degree();
    }
    for list in [&mut zeros, &mut unclear_zeros, &mut poles] {
        list.sort_by(|a: &Root, b: &Root| a.omega_rad_s.value.total_cmp(&b.omega_rad_s.value));
    }
    let known = data.undisturbed.unwrap_or(compared.input);
    let missed_share = explained_share(
        known.get(data.skip()..).unwrap_or_default(),
        &left,
        data.period_s,
    );
    let white = filtered(&left, &found.noise.taps);
    let squares: Vec<f64> = white.iter().map(|x| x * x).collect();
    let delay_std = if found.delay_is_free {
        // Where other parameters can take its place, it is no longer straight.
        let alone = std(parameters(&transfer, true).len() - 1);
        libm::hypot(alone.min(data.period_s), found.delay_doubt_s)
    } else {
        found.delay_doubt_s
    };
    transfer.delay_s = (fitted_delay_s - prepared.early_s).max(0.0);
    Ok(Flexible {
        fitted_delay_s,
        inertia: prepared.is_force.then(|| Figure {
            value: 1.0 / gain,
            std: std(0) / (gain * gain),
        }),
        zeros,
        unclear_zeros,
        poles,
        delay_s: Figure {
            value: transfer.delay_s,
            std: delay_std,
        },
        rel_error,
        whiteness: Whiteness::of(&white, LAGS),
        missed_share,
        steadiness: Whiteness::of(&squares, LAGS),
        noise_order: found.noise.taps.len(),
        leak: found.noise.leak,
        response: found.response,
        signals: prepared.names.clone(),
        samples: data.len(),
        seconds: data.len() as f64 * data.period_s,
        has_errors: found.has_errors,
        transfer,
    })
}

/// Relative error with which a model simulates another recording, its offset
/// and first state fitted.
///
/// # Errors
///
/// When that recording cannot be used.
pub fn predict_error(model: &Flexible, other: &Recording, choice: &Choice) -> Outcome<f64> {
    let prepared = prepare(other, choice)?;
    let data = Data {
        input: &prepared.input,
        output: &prepared.output,
        undisturbed: None,
        period_s: prepared.period_s,
        measured: prepared.measured,
        from_command: !prepared.is_force,
        early_s: prepared.early_s,
        positions: prepared.positions,
        every: 1,
        leak: 0.0,
    };
    let fitted = TransferFunction {
        delay_s: model.fitted_delay_s,
        ..model.transfer.clone()
    };
    let share = |data: &Data<'_>| {
        let left = as_it_is(data, &fitted).and_then(|found| residuals(data, &found))?;
        let norm = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
        Some(norm(&left) / norm(data.output.get(data.skip()..)?))
    };
    let leaky = (model.leak > 0.0).then(|| Leaky::of(&data, model.leak));
    let leaky = leaky.and_then(|leaky| share(&leaky.data(&data)));
    let least = share(&data).map(|plain| plain.min(leaky.unwrap_or(plain)));
    least.ok_or_else(|| {
        Trouble::new(
            "the model cannot be simulated on the second recording",
            "record both at the same rate",
        )
    })
}
