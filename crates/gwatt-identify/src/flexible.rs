//! Flexible axes: from a recording to resonances and anti-resonances.

use nalgebra::{DMatrix, DVector};

use super::arx;
use super::candidate_models::FAST;
use super::certainty;
use super::chosen::{LAGS, filtered};
use super::creeping::{inertia, slow_rad_s};
use super::data::Data;
use super::disturbance::as_it_is;
use super::error::{IdentifyError, Outcome};
use super::figure::Figure;
use super::leaky_integrator::Leaky;
use super::left::Left;
use super::mean_speed;
use super::measured_noise::Noise;
use super::methods::{Modelled, estimator};
use super::noise::Whiteness;
use super::output_error::residuals;
use super::parameters::parameters;
use super::prepared::{Prepared, prepare};
use super::recording::Recording;
use super::roots::{roots_of, stands_for_delay_s};
use super::rubbing::{Rubbing, Term};
use super::spectrum::{FrequencyResponse, excited_rad_s};
use super::state_space::Measured;
use super::transfer::{Factor, TransferFunction};

pub use super::choice::{Choice, Method};
pub use super::roots::Root;

/// A flexible axis.
#[derive(Debug, Clone)]
pub struct Flexible {
    /// The model, from force to acceleration (from commanded to real
    /// acceleration where the command is the input).
    pub transfer: TransferFunction,
    /// Inertia or mass: 1/gain, but of motion above what creeps more slowly than it swings. Absent
    /// from a command, and where not even its sign is known.
    pub inertia: Option<Figure>,
    /// Anti-resonances: zeros that make a dip.
    pub zeros: Vec<Root>,
    /// Zeros of which the recording does not show whether there are any: their
    /// frequency is not known to a tenth. The model has them to explain other things,
    /// such as a delay.
    pub unclear_zeros: Vec<Root>,
    /// Resonances.
    pub poles: Vec<Root>,
    /// Viscous friction; absent where the recording shows none.
    pub viscous: Option<Figure>,
    /// Coulomb friction; absent where the recording shows none.
    pub coulomb: Option<Figure>,
    /// Whether there is friction, by errors that may be too small to show.
    pub(crate) rubs: bool,
    /// Whether the speed that friction goes with is a sum of accelerations.
    pub speed_is_summed: bool,
    /// Whether a recorded speed is the mean since the sample before, as differences of a
    /// position are.
    pub speed_is_mean: bool,
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
    /// The energy of that in units of the noise, where it is more than chance: standard
    /// errors are wider by its root.
    pub missed_energy: f64,
    /// By which share of it the inertia differs from one part of the recording to the others,
    /// where it does.
    pub change: Option<Figure>,
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
    /// Whether the sign of the inertia is known, by errors that may be too small to show.
    pub(crate) sign_is_sure: bool,
    /// Up to where the recording shows the axis, rad/s.
    pub(crate) shown_rad_s: f64,
    /// How far the delay is in doubt as long as the zeros stay what they are, s.
    pub(crate) delay_doubt_s: f64,
    /// What was measured.
    pub(crate) measured: Measured,
    /// What makes the noise white, and its standard deviation then.
    pub(crate) noise: Noise,
    pub(crate) noise_std: f64,
    /// How the parameters of the model vary together, where standard errors are known; the
    /// delay is one of them where it was fitted.
    pub(crate) covariance: Option<DMatrix<f64>>,
}

impl Flexible {
    /// The model as it was fitted, with that delay.
    fn fitted(&self) -> TransferFunction {
        TransferFunction {
            delay_s: self.fitted_delay_s,
            ..self.transfer.clone()
        }
    }

    /// By how much slow motion is late by delay, poles and zeros, but for zeros that count
    /// apart, with the standard error of the whole: poles, zeros and a delay that stand
    /// for one another are known together better than one by one, or not at all.
    #[must_use]
    pub fn lateness(&self, apart: &[Factor]) -> Figure {
        let model = &self.transfer;
        let mut value = model.delay_s;
        let mut slopes = vec![0.0];
        let zeros = model.zeros.iter().map(|zero| {
            let counts = !apart.contains(zero);
            (zero, if counts { -1.0 } else { 0.0 })
        });
        for (factor, sign) in zeros.chain(model.poles.iter().map(|pole| (pole, 1.0))) {
            value += sign * factor.lag_s();
            match *factor {
                Factor::Pair { omega_rad_s, .. } => {
                    slopes.extend([-sign * factor.lag_s(), sign * 2.0 / omega_rad_s]);
                }
                Factor::Real { .. } => slopes.push(sign),
            }
        }
        let Some(covariance) = &self.covariance else {
            return Figure {
                value,
                std: f64::NAN,
            };
        };
        let is_late = covariance.nrows() > slopes.len();
        slopes.resize(covariance.nrows().min(slopes.len() + 1), 1.0);
        let slopes = DVector::from_vec(slopes);
        let variance = if slopes.len() == covariance.nrows() {
            (covariance * &slopes).dot(&slopes)
        } else {
            f64::NAN
        };
        // What other models make of the delay comes on top.
        let doubt = if is_late { 0.0 } else { self.delay_doubt_s };
        Figure {
            value,
            std: libm::hypot(
                variance.max(0.0).sqrt(),
                if doubt.is_finite() { doubt } else { 0.0 },
            ),
        }
    }
}

/// Zeros farther beyond the band do not count as anti-resonances.
const BEYOND: f64 = 1.05;

/// Identifies a flexible axis. Where slow motion shows friction, that is a term of the
/// model (instrumental variables alone).
///
/// # Errors
///
/// What keeps the recording from being used, or a model from being found.
pub fn identify(recording: &Recording, choice: &Choice) -> Outcome<Flexible> {
    let (prepared, found) = as_recorded(recording, choice)?;
    if choice.method == Method::Iv
        && prepared.is_force
        && prepared.measured == Measured::Velocity
        && mean_speed::is_likelier(&data_of(&prepared, &[]), &found.fitted())
        && let Ok((_, summed)) = as_recorded(&mean_speed::summed(recording), choice)
        && summed.noise_std < found.noise_std
    {
        return Ok(Flexible {
            speed_is_mean: true,
            ..summed
        });
    }
    Ok(found)
}

fn as_recorded(recording: &Recording, choice: &Choice) -> Outcome<(Prepared, Flexible)> {
    let mut prepared = prepare(recording, choice)?;
    let may_rub = estimator(choice.method).has_friction() && prepared.is_force;
    if let Some(mut rubbing) = may_rub.then(|| Rubbing::of(recording)).flatten() {
        rubbing.take_off(&mut prepared.input, prepared.measured, prepared.period_s);
        let found = identified(&prepared, choice, &rubbing);
        if let Ok(found) = found
            && found.rubs
        {
            return Ok((prepared, found));
        }
        // As it was: a copy that is kept meanwhile would be megabytes.
        prepared = prepare(recording, choice)?;
    }
    let found = identified(&prepared, choice, &Rubbing::default())?;
    Ok((prepared, found))
}

/// What is fitted, next to these terms of friction.
fn data_of<'a>(prepared: &'a Prepared, friction: &'a [Vec<f64>]) -> Data<'a> {
    Data {
        input: &prepared.input,
        friction,
        viscous: None,
        turning: 0,
        output: &prepared.output,
        undisturbed: None,
        period_s: prepared.period_s,
        measured: prepared.measured,
        from_command: !prepared.is_force,
        early_s: prepared.early_s,
        positions: prepared.positions,
        every: 1,
        leak: 0.0,
    }
}

fn identified(prepared: &Prepared, choice: &Choice, rubbing: &Rubbing) -> Outcome<Flexible> {
    let method = estimator(choice.method);
    let mut given = choice.given;
    let whole_s = libm::ceil(prepared.early_s / prepared.period_s) * prepared.period_s;
    let late_s = given.delay_s.map(|delay| delay + prepared.early_s);
    given.delay_s = late_s.or((!method.finds_delay()).then_some(whole_s));
    let undisturbed = match &prepared.excitation {
        Some(r) => Some(arx::undisturbed(r, &prepared.input).ok_or_else(|| {
            IdentifyError::new(
                "the input does not follow from the excitation",
                "check that the column of the excitation holds what was added to the torque",
            )
        })?),
        None => None,
    };
    let data = Data {
        undisturbed: undisturbed.as_deref(),
        viscous: rubbing.viscous_alone(),
        turning: rubbing.turning(),
        ..data_of(prepared, &rubbing.inputs)
    };
    let found = method.estimate(&data, prepared, given);
    let mut found = found.ok_or_else(|| {
        IdentifyError::new(
            "no stable model fits the recording",
            "check units and signs of the columns, excite longer, or give --order",
        )
    })?;
    // What the model misses widens errors, and says nothing of whether there is friction.
    let rubs = rubbing.is_clear(&found.estimate.friction);
    let left = Left::of(&found, &data);
    left.widen(&mut found, method);
    let [viscous, coulomb] = rubbing.figures(&found.estimate.friction);
    let comes_through = found.friction_loop.is_some();
    let mut described = describe(found, &data, prepared, &left)?;
    described.rubs = rubs;
    described.speed_is_summed = rubbing.is_summed();
    (described.viscous, described.coulomb) = (viscous, coulomb);
    // A force is held while the friction changes: which speed of a sample it had is open, unless
    // noise comes as through the friction of that speed.
    if let (Some(inertia), Some(viscous), false) =
        (&mut described.inertia, described.viscous, comes_through)
    {
        inertia.std = libm::hypot(inertia.std, viscous.value * prepared.period_s);
    }
    Ok(described)
}

/// Up to where zeros and poles are shown, rad/s.
fn shown_up_to(data: &Data<'_>, response: &FrequencyResponse) -> (f64, f64) {
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
    let highest = if data.from_command {
        // One beyond what a command excites stands for dead time as well.
        shown
    } else if is_integrated {
        FAST / data.period_s
    } else {
        band
    };
    (shown, highest)
}

/// After a command only what rings is a resonance, and how the command runs between samples
/// is not known.
fn keep_ringing(roots: &mut [Vec<Root>], period_s: f64) {
    for list in roots {
        list.retain(Root::rings);
        for root in list {
            root.runs_between_samples(period_s);
        }
    }
}

/// The inertia, and whether its sign is sure.
fn inertia_of(found: &Modelled, data: &Data<'_>) -> (Figure, bool) {
    let estimate = &found.estimate;
    let slow = slow_rad_s(data.len(), data.period_s);
    let covariance = Some(&estimate.covariance).filter(|it| !it.is_empty());
    let mut out = inertia(&estimate.transfer, slow, covariance);
    let is_sure = out.std.is_nan() || out.std <= certainty::SIGN_SHARE * out.value.abs();
    if !found.has_errors {
        out.std = f64::NAN;
    }
    (out, is_sure)
}

fn describe(
    found: Modelled,
    data: &Data<'_>,
    prepared: &Prepared,
    left: &Left,
) -> Outcome<Flexible> {
    let estimate = &found.estimate;
    let mut transfer = estimate.transfer.clone();
    let fitted_delay_s = transfer.delay_s;
    let std = |index: usize| {
        if found.has_errors {
            estimate.std(index).unwrap_or(f64::NAN)
        } else {
            f64::NAN
        }
    };
    let gain = transfer.gain;
    if gain == 0.0 || !gain.is_finite() {
        return Err(IdentifyError::new(
            "the axis does not answer the input",
            "check that input and motion are of the same axis and the same time",
        ));
    }
    let (inertia, sign_is_sure) = inertia_of(&found, data);
    let bands = shown_up_to(data, &found.response);
    let mut roots = roots_of(&transfer, bands, std);
    if data.from_command {
        keep_ringing(&mut roots, data.period_s);
    }
    let [zeros, unclear_zeros, poles] = roots;
    let squares: Vec<f64> = left.white.iter().map(|x| x * x).collect();
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
        // One that may be of any size, or negative, is no figure.
        inertia: (prepared.is_force && (sign_is_sure || !found.has_errors)).then_some(inertia),
        zeros,
        unclear_zeros,
        poles,
        viscous: None,
        coulomb: None,
        rubs: false,
        speed_is_summed: false,
        speed_is_mean: false,
        delay_s: Figure {
            value: transfer.delay_s,
            std: libm::hypot(delay_std, stands_for_delay_s(&transfer, data.from_command)),
        },
        sign_is_sure,
        shown_rad_s: bands.0,
        delay_doubt_s: delay_std,
        rel_error: left.rel_error,
        whiteness: Whiteness::of(&left.white, LAGS),
        missed_share: left.missed_share,
        missed_energy: left.missed_energy,
        change: left.change,
        steadiness: Whiteness::of(&squares, LAGS),
        noise_order: found.noise.taps.len(),
        leak: found.noise.leak,
        measured: prepared.measured,
        noise_std: (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt(),
        noise: found.noise,
        covariance: found.has_errors.then(|| estimate.covariance.clone()),
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
    let summed = model.speed_is_mean.then(|| mean_speed::summed(other));
    let other = summed.as_ref().unwrap_or(other);
    let mut prepared = prepare(other, choice)?;
    let value = |figure: Option<Figure>| figure.map(|figure| figure.value);
    let figures = [
        (Term::Viscous, value(model.viscous)),
        (Term::Coulomb, value(model.coulomb)),
    ];
    let mass = 1.0 / model.transfer.gain;
    if let Some(mut rubbing) = Rubbing::known(other, mass, figures) {
        rubbing.take_off(&mut prepared.input, prepared.measured, prepared.period_s);
    }
    let data = data_of(&prepared, &[]);
    let fitted = model.fitted();
    let share = |data: &Data<'_>| {
        let left = as_it_is(data, &fitted).and_then(|found| residuals(data, &found))?;
        let norm = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
        Some(norm(&left) / norm(data.output.get(data.skip()..)?))
    };
    let leaky = (model.leak > 0.0).then(|| Leaky::of(&data, model.leak));
    let leaky = leaky.and_then(|leaky| share(&leaky.data(&data)));
    let least = share(&data).map(|plain| plain.min(leaky.unwrap_or(plain)));
    least.ok_or_else(|| {
        IdentifyError::new(
            "the model cannot be simulated on the second recording",
            "record both at the same rate",
        )
    })
}
