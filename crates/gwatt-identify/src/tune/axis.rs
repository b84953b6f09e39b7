//! What is known of an axis' response, from a recording or from a file.

use std::f64::consts::TAU;

use super::dip::{Dip, dips};
use crate::column::{Kind, Quantity};
use crate::error::{IdentifyError, Outcome};
use crate::figure::Figure;
use crate::filter::{derivative, low_pass, second_derivative};
use crate::flexible::{Choice, Flexible, Root, identify};
use crate::judgement::{self, Judgement};
use crate::recording::Recording;
use crate::spectrum::FrequencyResponse;
use crate::transfer::{Factor, TransferFunction};
use gwatt_machine::units::{M_PER_MM, RAD_PER_DEG};

/// A dip and a zero of the model are the same within this share of the
/// frequency, and a few steps of its resolution.
const SAME_SHARE: f64 = 0.1;
const STEPS: f64 = 3.0;

/// A dip is missing in a model whose gain there is so many times larger.
const DEEPER: f64 = 2.0;
/// A gain from command to load that is further from 1 is worth a word.
const GAIN_OFF: f64 = 0.02;

/// An anti-resonance that is evened out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Zero {
    /// ω, rad/s.
    pub omega_rad_s: Figure,
    /// ζ.
    pub damping: Figure,
}

impl Zero {
    /// As a factor.
    #[must_use]
    pub fn factor(&self) -> Factor {
        Factor::Pair {
            omega_rad_s: self.omega_rad_s.value,
            damping: self.damping.value,
        }
    }

    /// Without errors.
    #[must_use]
    pub fn exact(omega_rad_s: f64, damping: f64) -> Self {
        let exact = |value| Figure {
            value,
            std: f64::NAN,
        };
        Self {
            omega_rad_s: exact(omega_rad_s),
            damping: exact(damping),
        }
    }
}

impl From<Root> for Zero {
    fn from(root: Root) -> Self {
        Self {
            omega_rad_s: root.omega_rad_s,
            damping: root.damping,
        }
    }
}

/// The response of an axis.
#[derive(Debug, Clone)]
pub struct AxisResponse {
    /// Its letter.
    pub letter: char,
    /// The recording or file that it comes from.
    pub source: String,
    /// How much the recording moves it.
    pub excited: Option<Excited>,
    /// Torque and inertia, where a slide has force and mass.
    pub rotary: bool,
    /// From the position command, not from force or torque.
    pub from_command: bool,
    /// Mass or inertia; absent from a command.
    pub inertia: Option<f64>,
    /// The anti-resonances that are evened out.
    pub zeros: Vec<Zero>,
    /// What else the numerator has.
    pub further_zeros: Vec<Factor>,
    /// The denominator.
    pub poles: Vec<Factor>,
    /// Delay, s.
    pub delay_s: f64,
    /// Standard error of how late the axis is by delay and poles, s; not finite where it
    /// has none.
    pub lateness_std_s: f64,
    /// Gain of the position loop in 1/s, where it is known.
    pub position_gain_1_s: Option<f64>,
    /// The measured response, if there is a recording.
    pub measured: Option<FrequencyResponse>,
    /// By how much the measured response is late, s, because the input is held
    /// between samples.
    pub hold_s: f64,
    /// Dips of the measured response.
    pub dips: Vec<Dip>,
    /// The verdict on its recording; none where figures come from a file.
    pub judgement: Option<Judgement>,
    /// Remarks.
    pub notes: Vec<String>,
}

impl AxisResponse {
    /// The whole model: from force to acceleration, or from the command to the
    /// load.
    #[must_use]
    pub fn transfer(&self) -> TransferFunction {
        let zeros = self.zeros.iter().map(Zero::factor);
        TransferFunction {
            gain: self.inertia.map_or(1.0, |inertia| 1.0 / inertia),
            zeros: zeros.chain(self.further_zeros.iter().copied()).collect(),
            poles: self.poles.clone(),
            delay_s: self.delay_s,
        }
    }

    /// Its anti-resonances as factors.
    #[must_use]
    pub fn zero_factors(&self) -> Vec<Factor> {
        self.zeros.iter().map(Zero::factor).collect()
    }

    /// How the load follows the command, as far as it is known: everything from
    /// a command; from force the zeros, and the position loop where its gain is
    /// given. Loops that are not known are taken to be alike.
    #[must_use]
    pub fn follows(&self) -> TransferFunction {
        if self.from_command {
            return TransferFunction {
                gain: 1.0,
                ..self.transfer()
            };
        }
        let loop_pole = self.position_gain_1_s.map(|gain| Factor::Real {
            time_constant_s: 1.0 / gain,
        });
        TransferFunction {
            gain: 1.0,
            zeros: self.zero_factors(),
            poles: loop_pole.into_iter().collect(),
            delay_s: self.delay_s,
        }
    }
}

/// Identifies an axis, and judges whether it has anti-resonances: dips of the
/// measured response at zeros of the model.
///
/// # Errors
///
/// What keeps the recording from being used.
pub fn of_recording(recording: &Recording, letter: char, choice: &Choice) -> Outcome<AxisResponse> {
    let found = identify(recording, choice)?;
    let from_command = found.inertia.is_none();
    let force = recording
        .get(Quantity::Force)
        .or_else(|| recording.get(Quantity::Excitation));
    let rotary = force.is_some_and(|f| f.kind == Kind::Rotary);
    let found_dips = dips(&found.response);
    let (zeros, hidden) = visible(&found, &found_dips);
    let mut notes = Vec::new();
    if let (Some(force), Some(motion)) = (force, motion(recording))
        && force.kind != motion
    {
        let which = if rotary {
            "torque with a motion in metres: the inertia"
        } else {
            "force with a motion in radians: the mass"
        };
        notes.push(format!("{which} is for a lever of 1 m"));
    }
    if from_command && (found.transfer.gain - 1.0).abs() > GAIN_OFF {
        notes.push(format!(
            "the load follows the command with a gain of {:.4}, taken as 1: check the units of both",
            found.transfer.gain
        ));
    }
    for zero in &hidden {
        notes.push(format!(
            "the model's zero at {:.2} Hz, damping {:.3}, makes no dip: it is not evened out",
            zero.omega_rad_s.value / TAU,
            zero.damping.value
        ));
    }
    for dip in &found_dips {
        // Between two resonances there may be a valley without a zero.
        let model = found.transfer.at_hz(dip.frequency_hz).norm();
        if model > DEEPER * dip.gain && !zeros.iter().any(|z| is_at(z, dip, &found.response)) {
            notes.push(format!(
                "a dip of {:.0} dB at {:.1} Hz is not in the model: try another --order",
                dip.depth_db, dip.frequency_hz
            ));
        }
    }
    let early_s = found.fitted_delay_s - found.transfer.delay_s;
    let evened: Vec<Factor> = zeros.iter().map(Zero::factor).collect();
    let lateness_std_s = found.lateness(&evened).std;
    let further_zeros = found
        .transfer
        .zeros
        .iter()
        .filter(|factor| !zeros.iter().any(|zero| zero.factor() == **factor))
        .copied()
        .collect();
    Ok(AxisResponse {
        letter,
        source: String::new(),
        excited: None,
        judgement: Some(judgement::flexible(&found)),
        rotary,
        from_command,
        inertia: found.inertia.map(|inertia| inertia.value),
        zeros,
        further_zeros,
        poles: found.transfer.poles.clone(),
        delay_s: found.transfer.delay_s,
        lateness_std_s,
        position_gain_1_s: None,
        measured: Some(found.response),
        hold_s: 0.5 * found.seconds / found.samples as f64 + early_s,
        dips: found_dips,
        notes,
    })
}

/// Whether the motion slides or turns.
fn motion(recording: &Recording) -> Option<Kind> {
    let motions = [
        Quantity::Acceleration,
        Quantity::Velocity,
        Quantity::Position,
    ];
    let signal = motions.into_iter().find_map(|q| recording.get(q))?;
    Some(signal.kind)
}

/// Zeros of the model that make a dip, and those that make none.
fn visible(found: &Flexible, dips: &[Dip]) -> (Vec<Zero>, Vec<Zero>) {
    let zeros = found.zeros.iter().map(|root| Zero::from(*root));
    zeros.partition(|zero| dips.iter().any(|dip| is_at(zero, dip, &found.response)))
}

fn is_at(zero: &Zero, dip: &Dip, response: &FrequencyResponse) -> bool {
    let hz = zero.omega_rad_s.value / TAU;
    let ends = response
        .frequency_hz
        .first()
        .zip(response.frequency_hz.get(1));
    let step = ends.map_or(0.0, |(a, b)| b - a);
    (hz - dip.frequency_hz).abs() <= SAME_SHARE * hz + STEPS * step
}

/// How much an excitation moves an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Excited {
    /// Acceleration, rms, in `unit`.
    pub rms: f64,
    /// The largest.
    pub peak: f64,
    /// mm/s² or deg/s².
    pub unit: &'static str,
}

/// Frequency up to which an acceleration that comes from positions or speeds is
/// looked at, as a share of the sampling rate: above, it is the encoder's steps.
const BAND: f64 = 0.1;

/// The load's acceleration in a recording, and a refusal where its rms is less
/// than `least_mm_s2` (mm/s², or degrees/s²).
///
/// # Errors
///
/// A recording without motion, or with too little of it.
pub fn excited(recording: &Recording, letter: char, least_mm_s2: Option<f64>) -> Outcome<Excited> {
    let t = recording.period_s;
    let pick = |quantity| recording.get(quantity);
    let smooth = |x: &[f64]| low_pass(x, BAND / t, t);
    let (accel, kind) = if let Some(signal) = pick(Quantity::Acceleration) {
        (signal.values.clone(), signal.kind)
    } else if let Some(signal) = pick(Quantity::Velocity) {
        (derivative(&smooth(&signal.values), t), signal.kind)
    } else if let Some(signal) = pick(Quantity::Position) {
        (second_derivative(&smooth(&signal.values), t), signal.kind)
    } else {
        return Err(IdentifyError::new(
            format!("axis {letter}: there is no motion in the recording"),
            "add the load's acceleration, speed or position, such as accel_m_s2",
        ));
    };
    let (unit, si_per_unit) = match kind {
        Kind::Rotary => ("deg/s²", RAD_PER_DEG),
        _ => ("mm/s²", M_PER_MM),
    };
    let n = accel.len().max(1) as f64;
    let mean = accel.iter().sum::<f64>() / n;
    let power = accel.iter().map(|a| (a - mean) * (a - mean)).sum::<f64>() / n;
    let peak = accel.iter().map(|a| (a - mean).abs()).fold(0.0, f64::max);
    let found = Excited {
        rms: power.sqrt() / si_per_unit,
        peak: peak / si_per_unit,
        unit,
    };
    if let Some(least) = least_mm_s2.filter(|least| found.rms < *least) {
        return Err(IdentifyError::new(
            format!(
                "axis {letter}: the excitation moves it by {:.2} {unit} rms, less than the {least} that are asked for",
                found.rms
            ),
            "excite with more amplitude (gwatt excite --amplitude), and record again",
        ));
    }
    Ok(found)
}
