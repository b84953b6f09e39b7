//! Rigid axes: `force = m·a + b·v + Fc·sign v + offset`, from one recording or several
//! of the same axis.

use nalgebra::DVector;

use super::column::Kind;
use super::constancy::mass_changes;
use super::effects::{self, Effect, Found, Saturation, Shape};
use super::equations::Equations;
use super::error::{IdentifyError, Outcome};
pub use super::figure::Figure;
use super::friction::{Solved, Terms, inertial, left_above, left_of, solve_best};
use super::lateness::{self, Late};
use super::noise::Whiteness;
use super::recording::Recording;
use super::rigidity::resonates;
use super::spectrum::{FrequencyResponse, measure};

pub use super::friction::Friction;

/// Band of the common filter where none is given, Hz: above what moves an axis,
/// below the first resonance of most.
pub const BANDWIDTH_HZ: f64 = 30.0;
/// Equations at least, for each unknown.
const EQUATIONS_MIN: usize = 3;
/// A model that leaves less than this share of the force is good enough.
const SUSPECT: f64 = 0.1;

/// A rigid axis; N·m and kg·m² for N and kg where it turns.
#[derive(Debug, Clone, PartialEq)]
pub struct Rigid {
    /// Mass or inertia.
    pub mass: Figure,
    /// Viscous friction; absent where no speed is known, or one alone.
    pub viscous: Option<Figure>,
    /// Coulomb friction; absent where no speed is known, or one direction alone.
    pub coulomb: Option<Figure>,
    /// Offset: gravity, or bias of the force. Absent where the axis moves one way.
    pub offset: Option<Figure>,
    /// Coulomb friction and offset together, where the axis moves one way: positive if
    /// they push in + direction.
    pub constant: Option<Figure>,
    /// In + and − direction: viscous and Coulomb friction of their own.
    pub directions: Option<[(Figure, Figure); 2]>,
    /// Norm of what is left by norm of the force.
    pub rel_error: f64,
    /// What noise as strong as that above the band would leave, by norm of the force.
    pub noise_share: f64,
    /// Samples after filter and decimation.
    pub samples: usize,
    /// Recordings.
    pub recordings: usize,
    /// The band, Hz.
    pub bandwidth_hz: f64,
    /// Whiteness of what is left.
    pub whiteness: Whiteness,
    /// Whether it resonates within the band, so that no mass alone describes it.
    pub resonates: bool,
    /// Whether the motion slides or turns: units of what has to do with places.
    pub motion: Kind,
    /// By how much later than recorded the force acts, s; absent where the recordings do not
    /// show it. The figures are those of the force as late as that.
    pub lateness_s: Option<Figure>,
    /// By how much later than recorded the force acts, s, where that is more than a drive that
    /// samples makes of it, and changes the figures; they are those of the force as recorded.
    pub out_of_step_s: Option<Figure>,
    /// By which share of it the mass differs from one part of the recordings to the others,
    /// where it does.
    pub change: Option<Figure>,
    /// Forces that no mass and friction have, estimated together with them.
    pub effects: Vec<Effect>,
    /// Whether the force ends at a value.
    pub saturation: Option<Saturation>,
    /// Unknowns in the order of the terms, for [`predict_error`].
    theta: Vec<f64>,
    terms: Terms,
    shapes: Vec<Shape>,
}

impl Rigid {
    /// How friction is modelled, in a word or two.
    #[must_use]
    pub fn friction(&self) -> &'static str {
        match self.terms {
            Terms::Offset => "unknown",
            Terms::Symmetric => "symmetric",
            Terms::Directional => "directional",
            Terms::Dry => "dry",
            Terms::OneWay | Terms::Constant => "one way",
        }
    }
}

/// The band that is used: as given, else the usual one, as far as the sampling
/// rate allows.
#[must_use]
pub fn bandwidth(recording: &Recording, given_hz: Option<f64>) -> f64 {
    given_hz
        .unwrap_or(BANDWIDTH_HZ)
        .min(0.1 / recording.period_s)
}

/// Fits a rigid axis to one recording, with this friction.
///
/// # Errors
///
/// What keeps the figures from being determined.
pub fn fit(recording: &Recording, friction: Friction, bandwidth_hz: Option<f64>) -> Outcome<Rigid> {
    fit_all(
        std::slice::from_ref(recording),
        Some(friction),
        bandwidth_hz,
    )
}

/// Fits a rigid axis to several recordings of it at once. Without a friction the data
/// decide whether it differs by direction.
///
/// # Errors
///
/// What keeps the figures from being determined.
pub fn fit_all(
    recordings: &[Recording],
    friction: Option<Friction>,
    bandwidth_hz: Option<f64>,
) -> Outcome<Rigid> {
    let bandwidth_hz = recordings
        .iter()
        .map(|recording| bandwidth(recording, bandwidth_hz))
        .fold(f64::INFINITY, f64::min);
    let mut all = recordings
        .iter()
        .map(|recording| Equations::of(recording, bandwidth_hz))
        .collect::<Outcome<Vec<_>>>()?;
    let with_speed = all.iter().filter(|it| it.inside.speeds.is_some()).count();
    if with_speed != 0 && with_speed != all.len() {
        return Err(IdentifyError::new(
            "some of the recordings have a speed or position, others have not",
            "join recordings of the same signals",
        ));
    }
    let counted = |all: &[Equations]| -> usize {
        let counts = all.iter().flat_map(|it| &it.counts);
        counts.filter(|counts| **counts).count()
    };
    let least = if with_speed == 0 {
        Terms::Offset
    } else {
        Terms::OneWay
    };
    let enough = |all: &[Equations], terms: Terms| {
        let n = counted(all);
        if n >= EQUATIONS_MIN * terms.width() {
            return Ok(n);
        }
        Err(IdentifyError::new(
            format!(
                "the recording is too short: {n} samples are left in a band of {bandwidth_hz} Hz where the axis moves"
            ),
            "record longer, with motion to and fro",
        ))
    };
    enough(&all, least)?;
    let solved = solve_best(&mut all, friction).ok_or_else(not_excited)?;
    let (found, late) = lateness::fitted(&all, friction, &solved);
    if let Some(Saturation::Recording { limit, share }) = found.saturation
        && !found.is_known
    {
        return Err(saturated(limit, share));
    }
    let solved = &found.solved;
    let samples = enough(&found.all, solved.terms)?;
    let mass_std = solved.covariance[(0, 0)].sqrt();
    if !mass_std.is_finite() {
        return Err(not_excited());
    }
    Ok(described(found, late, samples, bandwidth_hz))
}

fn saturated(limit: f64, share: f64) -> IdentifyError {
    IdentifyError::new(
        format!(
            "the force is saturated: {:.0} % of the samples stand at {limit:.4}, the motion shows more, and the rest shows no mass",
            100.0 * share
        ),
        "record with a smaller amplitude or lower accelerations, or with a larger range of the current",
    )
}

fn not_excited() -> IdentifyError {
    IdentifyError::new(
        "the motion does not distinguish mass and friction: it is not excited enough",
        "move to and fro at several speeds, with accelerations between; gwatt excite makes signals",
    )
}

/// A combination of unknowns, with its error.
fn combined(solved: &Solved, weights: &[f64]) -> Figure {
    let mut all = weights.to_vec();
    all.resize(solved.theta.len(), 0.0);
    let w = DVector::from_vec(all);
    Figure {
        value: w.iter().zip(&solved.theta).map(|(w, t)| w * t).sum(),
        std: (&solved.covariance * &w).dot(&w).max(0.0).sqrt(),
    }
}

fn described(found: Found, late: Late, samples: usize, bandwidth_hz: f64) -> Rigid {
    let (all, solved) = (&found.all[..], &found.solved);
    let single = |index: usize| {
        let mut weights = vec![0.0; index];
        weights.push(1.0);
        combined(solved, &weights)
    };
    let terms = solved.terms;
    let (mut viscous, mut coulomb, mut offset) = (None, None, None);
    let (mut constant, mut directions) = (None, None);
    match terms {
        Terms::Offset => offset = Some(single(1)),
        Terms::Symmetric => {
            (viscous, coulomb) = (Some(single(1)), Some(single(2)));
            offset = Some(single(3));
        }
        Terms::Dry => (coulomb, offset) = (Some(single(1)), Some(single(2))),
        Terms::OneWay => (viscous, constant) = (Some(single(1)), Some(single(2))),
        Terms::Constant => constant = Some(single(1)),
        Terms::Directional => {
            viscous = Some(combined(solved, &[0.0, 0.5, 0.5]));
            coulomb = Some(combined(solved, &[0.0, 0.0, 0.0, 0.5, 0.5]));
            offset = Some(combined(solved, &[0.0, 0.0, 0.0, 0.5, -0.5]));
            directions = Some([(single(1), single(3)), (single(2), single(4))]);
        }
    }
    let mass = single(0);
    let theta = solved.theta.clone();
    let [rest, total] = sums(all, terms, &theta);
    let above: f64 = all.iter().map(|it| left_above(it, terms, &theta)).sum();
    let rel_error = (rest / total).sqrt();
    let is_flexible = |equations: &Equations| {
        resonates(
            &inertial(equations, terms, &theta),
            &equations.inside.acceleration,
            mass.value,
            equations.step_s,
            bandwidth_hz,
        )
    };
    let left: Vec<f64> = solved.residuals.concat();
    Rigid {
        mass,
        viscous,
        coulomb,
        offset,
        constant,
        directions,
        rel_error,
        noise_share: (above / total).sqrt(),
        samples,
        recordings: all.len(),
        bandwidth_hz,
        whiteness: Whiteness::of(&left, 20.min(samples / 5)),
        resonates: rel_error > SUSPECT && all.iter().any(is_flexible),
        motion: all.first().map_or(Kind::Linear, |it| it.raw.motion),
        lateness_s: late.by_s(),
        out_of_step_s: late.out_of_step_s(),
        change: mass_changes(all, solved),
        effects: found.effects,
        saturation: found.saturation,
        theta,
        terms,
        shapes: found.shapes,
    }
}

/// Sums of squares of what is left and of the force, over all recordings.
fn sums(all: &[Equations], terms: Terms, theta: &[f64]) -> [f64; 2] {
    let each = all.iter().map(|it| left_of(it, terms, theta));
    each.fold([0.0; 2], |[a, b], [c, d]| [a + c, b + d])
}

/// Relative error with which a fitted axis predicts the force of another
/// recording.
///
/// # Errors
///
/// When that recording cannot be used.
pub fn predict_error(rigid: &Rigid, other: &Recording) -> Outcome<f64> {
    let (equations, theta) = settled(rigid, other)?;
    let [left, all] = left_of(&equations, rigid.terms, &theta);
    Ok((left / all).sqrt())
}

/// The force of a recording and that of a fitted axis, after the common filter.
#[derive(Debug, Clone)]
pub struct Trace {
    /// Distance of samples, s.
    pub step_s: f64,
    /// The recorded force, N or N·m.
    pub force: Vec<f64>,
    /// That of the model.
    pub modelled: Vec<f64>,
    /// Which samples count: those where the axis moves.
    pub counts: Vec<bool>,
    /// From the recorded force without the model's friction to the acceleration; `None` for a
    /// short recording.
    pub response: Option<FrequencyResponse>,
}

/// Lays a fitted axis over a recording of it.
///
/// # Errors
///
/// When that recording cannot be used.
pub fn trace(rigid: &Rigid, recording: &Recording) -> Outcome<Trace> {
    let (equations, theta) = settled(rigid, recording)?;
    let without_friction = inertial(&equations, rigid.terms, &theta);
    let band = &equations.inside;
    let mass = theta.first().copied().unwrap_or_default();
    let samples = band.force.iter().zip(&without_friction);
    let modelled = samples
        .zip(band.acceleration.iter())
        .map(|((force, inertial), accel)| force - inertial + mass * accel);
    Ok(Trace {
        step_s: equations.step_s,
        modelled: modelled.collect(),
        response: measure(
            &without_friction,
            &band.acceleration,
            None,
            equations.step_s,
            None,
        ),
        force: equations.inside.force,
        counts: equations.counts,
    })
}

/// The equations of another recording, and the unknowns with those that it has alone.
fn settled(rigid: &Rigid, other: &Recording) -> Outcome<(Equations, Vec<f64>)> {
    let mut equations = Equations::of(other, rigid.bandwidth_hz)?;
    if equations.inside.speeds.is_some() == (rigid.terms == Terms::Offset) {
        return Err(IdentifyError::new(
            "the second recording has other signals than the first",
            "record the same signals in both",
        ));
    }
    if matches!(rigid.terms, Terms::OneWay | Terms::Constant) {
        let [forward, backward] = equations.directions();
        if forward.min(backward) > forward.max(backward) / 10 {
            return Err(IdentifyError::new(
                "the second recording moves both ways, the first one way only: its friction on the way back is not known",
                "record motion to and fro, or check on a recording of the same direction",
            ));
        }
        equations.leave_out(forward < backward);
    }
    if let Some(lateness_s) = rigid.lateness_s {
        lateness::delay(&mut equations, lateness_s.value);
    }
    let theta = effects::add_known(
        &mut equations,
        rigid.terms,
        &rigid.theta,
        (&rigid.shapes, rigid.recordings),
    );
    let theta = theta.ok_or_else(|| {
        IdentifyError::new(
            "the second recording does not go through a period of the cogging",
            "record as much motion as in the first",
        )
    })?;
    Ok((equations, theta))
}
