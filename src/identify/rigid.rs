//! Rigid axes: `force = m·a + b·v + Fc·sign v + offset`.
//!
//! Position is filtered without delay and differentiated; then force and all
//! regressors pass the same low-pass, and are decimated to what it leaves (Gautier
//! 1997, "Dynamic identification of robots with power model"). Standard errors
//! allow for residuals that hang together (Newey & West 1987).

use nalgebra::{DMatrix, DVector};

use super::column::Quantity;
use super::filter::{derivative, low_pass, second_derivative};
use super::noise::Whiteness;
use super::normal::Normal;
use super::quality;
use super::recording::Recording;
use super::rigidity::resonates;
use super::trouble::{Outcome, Trouble};

/// Band of the common filter where none is given, Hz: above what moves an axis,
/// below the first resonance of most.
pub const BANDWIDTH_HZ: f64 = 30.0;

/// How friction is modelled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Friction {
    /// The same in both directions, besides an offset.
    Symmetric,
    /// Of its own in each direction.
    Directional,
}

/// A figure with its standard error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Figure {
    /// The estimate.
    pub value: f64,
    /// Its standard error.
    pub std: f64,
}

/// A rigid axis; N·m and kg·m² for N and kg where it turns.
#[derive(Debug, Clone, PartialEq)]
pub struct Rigid {
    /// Mass or inertia.
    pub mass: Figure,
    /// Viscous friction; absent where no speed is known.
    pub viscous: Option<Figure>,
    /// Coulomb friction; absent where no speed is known.
    pub coulomb: Option<Figure>,
    /// Offset: gravity, or bias of the force.
    pub offset: Figure,
    /// In + and − direction: viscous and Coulomb friction of their own.
    pub directions: Option<[(Figure, Figure); 2]>,
    /// Norm of what is left by norm of the force.
    pub rel_error: f64,
    /// Samples after filter and decimation.
    pub samples: usize,
    /// The band, Hz.
    pub bandwidth_hz: f64,
    /// Whiteness of what is left.
    pub whiteness: Whiteness,
    /// Whether it resonates within the band, so that no mass alone describes it.
    pub resonates: bool,
    /// Unknowns in the order of the regressors, for [`predict_error`].
    theta: Vec<f64>,
    friction: Friction,
}

/// Force and regressors, filtered and decimated.
struct Equations {
    columns: Vec<Vec<f64>>,
    force: Vec<f64>,
    /// Both with the samples in which the axis stands.
    whole: (Vec<Vec<f64>>, Vec<f64>),
    /// Distance of samples, s.
    step_s: f64,
}

/// The force of a recording in N (N·m where the motion turns).
///
/// # Errors
///
/// Without a force, or with one that does not go with the motion.
pub fn force_of(recording: &Recording) -> Outcome<Vec<f64>> {
    let Some(force) = recording.get(Quantity::Force) else {
        return Err(Trouble::new(
            "there is no force or torque in the recording",
            "add a column force_n or torque_nm: from motor current, times the force constant",
        ));
    };
    Ok(force.values.clone())
}

fn equations(recording: &Recording, friction: Friction, bandwidth_hz: f64) -> Outcome<Equations> {
    let t = recording.period_s;
    let force = force_of(recording)?;
    for signal in &recording.signals {
        if matches!(
            signal.quantity,
            Quantity::Position | Quantity::Velocity | Quantity::Acceleration
        ) {
            quality::moves(
                signal,
                "record a motion to and fro; gwatt excite makes signals",
            )?;
        }
        if matches!(signal.quantity, Quantity::Force | Quantity::Acceleration) {
            quality::not_saturated(signal)?;
        }
    }
    let smooth_hz = (3.4 * bandwidth_hz).min(0.4 / t);
    let smooth = |quantity| {
        recording
            .get(quantity)
            .map(|signal| low_pass(&signal.values, smooth_hz, t))
    };
    let position = smooth(Quantity::Position);
    let velocity = smooth(Quantity::Velocity)
        .or_else(|| position.as_ref().map(|position| derivative(position, t)));
    let measured = recording.get(Quantity::Acceleration);
    let acceleration = match (measured, &position, &velocity) {
        (Some(signal), _, _) => signal.values.clone(),
        (None, Some(position), _) if recording.get(Quantity::Velocity).is_none() => {
            second_derivative(position, t)
        }
        (None, _, Some(velocity)) => derivative(velocity, t),
        _ => {
            return Err(Trouble::new(
                "there is no motion in the recording",
                "add the load's position, speed or acceleration, such as position_mm",
            ));
        }
    };
    let mut columns = vec![acceleration];
    let fastest = velocity
        .iter()
        .flatten()
        .fold(0.0, |fastest: f64, v| fastest.max(v.abs()));
    if let Some(velocity) = &velocity {
        let part = |keep: fn(f64) -> f64| velocity.iter().map(|v| keep(*v)).collect();
        match friction {
            Friction::Symmetric => {
                columns.push(velocity.clone());
                columns.push(part(sign));
                columns.push(vec![1.0; velocity.len()]);
            }
            Friction::Directional => {
                columns.push(part(|v| v.max(0.0)));
                columns.push(part(|v| v.min(0.0)));
                columns.push(part(|v| sign(v).max(0.0)));
                columns.push(part(|v| sign(v).min(0.0)));
            }
        }
    } else {
        columns.push(vec![1.0; force.len()]);
    }
    // The filter leaves nothing above its corner: 2.5 samples a period there.
    let step = ((0.4 / (bandwidth_hz * t)) as usize).max(1);
    let edge = ((1.0 / (bandwidth_hz * t)) as usize).min(force.len() / 10);
    let thin = |x: &[f64]| -> Vec<f64> {
        let filtered = low_pass(x, bandwidth_hz, t);
        let inner = filtered.len().saturating_sub(2 * edge);
        filtered
            .into_iter()
            .skip(edge)
            .take(inner)
            .step_by(step)
            .collect()
    };
    // An axis that stands is held by friction of any size: no equation.
    let moves: Option<Vec<bool>> = velocity.as_ref().map(|velocity| {
        thin(velocity)
            .iter()
            .map(|v| v.abs() > STANDING * fastest)
            .collect()
    });
    let keep = |x: Vec<f64>| -> Vec<f64> {
        match &moves {
            Some(moves) => {
                let pairs = x.into_iter().zip(moves);
                pairs.filter(|(_, moves)| **moves).map(|(x, _)| x).collect()
            }
            None => x,
        }
    };
    let thinned: Vec<Vec<f64>> = columns.iter().map(|x| thin(x)).collect();
    let force = thin(&force);
    Ok(Equations {
        columns: thinned.iter().cloned().map(&keep).collect(),
        force: keep(force.clone()),
        whole: (thinned, force),
        step_s: step as f64 * t,
    })
}

/// Below this share of the largest speed an axis counts as standing.
const STANDING: f64 = 0.005;

fn sign(v: f64) -> f64 {
    if v > 0.0 {
        1.0
    } else if v < 0.0 {
        -1.0
    } else {
        0.0
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

/// Fits a rigid axis.
///
/// # Errors
///
/// What keeps the figures from being determined.
pub fn fit(recording: &Recording, friction: Friction, bandwidth_hz: Option<f64>) -> Outcome<Rigid> {
    let bandwidth_hz = bandwidth(recording, bandwidth_hz);
    let equations = equations(recording, friction, bandwidth_hz)?;
    let n = equations.force.len();
    let width = equations.columns.len();
    if n < 10 * width {
        return Err(Trouble::new(
            format!(
                "the recording is too short: {n} samples are left in a band of {bandwidth_hz} Hz where the axis moves"
            ),
            "record longer, with motion to and fro",
        ));
    }
    let mut normal = Normal::new(width);
    for (row, force) in rows(&equations) {
        normal.add(&row, force);
    }
    let not_excited = || {
        Trouble::new(
            "the motion does not tell mass and friction apart: it is not excited enough",
            "move to and fro at several speeds, with accelerations between; gwatt excite makes signals",
        )
    };
    let solution = normal.solve().ok_or_else(not_excited)?;
    let theta: Vec<f64> = solution.x.iter().copied().collect();
    let residuals: Vec<f64> = rows(&equations)
        .map(|(row, force)| force - row.iter().zip(&theta).map(|(x, t)| x * t).sum::<f64>())
        .collect();
    let covariance = robust(&equations, &residuals, &solution.inverse);
    let norm = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
    let combined = |weights: &[f64]| -> Figure {
        let mut all = weights.to_vec();
        all.resize(width, 0.0);
        let w = DVector::from_vec(all);
        Figure {
            value: w.iter().zip(&theta).map(|(w, t)| w * t).sum(),
            std: (&covariance * &w).dot(&w).max(0.0).sqrt(),
        }
    };
    let single = |index: usize| {
        let mut weights = vec![0.0; width];
        if let Some(slot) = weights.get_mut(index) {
            *slot = 1.0;
        }
        combined(&weights)
    };
    let mass = single(0);
    let (viscous, coulomb, offset, directions) = match (width, friction) {
        (2, _) => (None, None, single(1), None),
        (_, Friction::Symmetric) => (Some(single(1)), Some(single(2)), single(3), None),
        (_, Friction::Directional) => (
            Some(combined(&[0.0, 0.5, 0.5])),
            Some(combined(&[0.0, 0.0, 0.0, 0.5, 0.5])),
            combined(&[0.0, 0.0, 0.0, 0.5, -0.5]),
            Some([(single(1), single(3)), (single(2), single(4))]),
        ),
    };
    if !(mass.std.is_finite() && mass.value.is_finite()) {
        return Err(not_excited());
    }
    let rel_error = norm(&residuals) / norm(&equations.force);
    let resonates =
        rel_error > SUSPECT && not_rigid(&equations, &theta, bandwidth_hz).unwrap_or(false);
    Ok(Rigid {
        mass,
        viscous,
        coulomb,
        offset,
        directions,
        rel_error,
        samples: n,
        bandwidth_hz,
        whiteness: Whiteness::of(&residuals, 20.min(n / 5)),
        resonates,
        theta,
        friction,
    })
}

/// A model that leaves less than this share of the force is good enough.
const SUSPECT: f64 = 0.1;

/// Whether the axis resonates: by what is left of its force when friction is taken
/// off.
fn not_rigid(equations: &Equations, theta: &[f64], bandwidth_hz: f64) -> Option<bool> {
    let (columns, force) = &equations.whole;
    let (acceleration, others) = columns.split_first()?;
    let (mass, friction) = theta.split_first()?;
    let mut inertial = force.clone();
    for (column, factor) in others.iter().zip(friction) {
        for (slot, x) in inertial.iter_mut().zip(column) {
            *slot -= factor * x;
        }
    }
    let step_s = equations.step_s;
    Some(resonates(
        &inertial,
        acceleration,
        *mass,
        step_s,
        bandwidth_hz,
    ))
}

/// Relative error with which a fitted axis predicts the force of another
/// recording.
///
/// # Errors
///
/// When that recording cannot be used.
pub fn predict_error(rigid: &Rigid, other: &Recording) -> Outcome<f64> {
    let equations = equations(other, rigid.friction, rigid.bandwidth_hz)?;
    if equations.columns.len() != rigid.theta.len() {
        return Err(Trouble::new(
            "the second recording has other signals than the first",
            "record the same signals in both",
        ));
    }
    let (mut left, mut all) = (0.0, 0.0);
    for (row, force) in rows(&equations) {
        let model: f64 = row.iter().zip(&rigid.theta).map(|(x, t)| x * t).sum();
        left += (force - model) * (force - model);
        all += force * force;
    }
    Ok((left / all).sqrt())
}

fn rows(equations: &Equations) -> impl Iterator<Item = (Vec<f64>, f64)> {
    equations.force.iter().enumerate().map(|(k, force)| {
        let row = equations
            .columns
            .iter()
            .map(|column| column.get(k).copied().unwrap_or_default())
            .collect();
        (row, *force)
    })
}

/// Covariance that holds for residuals that hang together over some samples.
fn robust(equations: &Equations, residuals: &[f64], inverse: &DMatrix<f64>) -> DMatrix<f64> {
    let n = residuals.len();
    let width = inverse.nrows();
    let lags = (4.0 * libm::pow(n as f64 / 100.0, 2.0 / 9.0)).max(4.0) as usize;
    let scores: Vec<DVector<f64>> = rows(equations)
        .zip(residuals)
        .map(|((row, _), e)| DVector::from_vec(row) * *e)
        .collect();
    let mut middle = DMatrix::zeros(width, width);
    for lag in 0..=lags {
        let weight = 1.0 - lag as f64 / (lags as f64 + 1.0);
        let mut sum = DMatrix::zeros(width, width);
        for (a, b) in scores.iter().zip(scores.iter().skip(lag)) {
            sum += a * b.transpose();
        }
        if lag == 0 {
            middle += sum;
        } else {
            middle += (&sum + sum.transpose()) * weight;
        }
    }
    let freedom = n as f64 / (n.saturating_sub(width).max(1)) as f64;
    inverse * middle * inverse * freedom
}
