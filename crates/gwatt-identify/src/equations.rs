//! Equations of motion of a rigid axis: the force of each sample, and what it is made of.
//!
//! Position is filtered without delay and differentiated; then force and all
//! regressors pass the same low-pass, and are decimated to what it leaves (Gautier
//! 1997, "Dynamic identification of robots with power model").

use std::sync::Arc;

use super::agreement::agree;
use super::column::{Kind, Quantity};
use super::error::{IdentifyError, Outcome};
use super::filter::{derivative, low_pass, second_derivative};
use super::quality::{self, CutOff};
use super::recording::{Recording, Signal};

/// Below this share of the largest speed an axis counts as standing.
const STANDING: f64 = 0.005;
/// Below this share a speed is as good as none.
const ROUNDING: f64 = 1e-9;
/// What smooths position and speed first reaches so much farther than the band.
const SMOOTH: f64 = 3.4;

/// What friction is made of: speed and its sign, each where the axis moves forward and
/// where it moves backward, and 0 elsewhere.
#[derive(Debug, Clone)]
pub(super) struct Speeds {
    /// The speed where it is positive.
    pub(super) forward: Vec<f64>,
    /// The speed where it is negative.
    pub(super) backward: Vec<f64>,
    /// 1 where it is positive.
    pub(super) forward_sign: Vec<f64>,
    /// −1 where it is negative.
    pub(super) backward_sign: Vec<f64>,
}

/// Force and regressors of one band. Those of the motion are shared by all that are tried.
#[derive(Debug, Clone)]
pub(super) struct Band {
    /// Force, N or N·m.
    pub(super) force: Vec<f64>,
    /// Acceleration, m/s² or rad/s².
    pub(super) acceleration: Arc<Vec<f64>>,
    /// Absent where no speed is known.
    pub(super) speeds: Option<Arc<Speeds>>,
    /// What else the force is made of: a column for each unknown.
    pub(super) further: Vec<Vec<f64>>,
}

/// Equations of one recording.
#[derive(Debug, Clone)]
pub(super) struct Equations {
    /// Up to the band's end.
    pub(super) inside: Band,
    /// From the band's end to twice as far: where noise is as strong as within, and what
    /// the model is to explain is not. Absent where nobody asks for it.
    pub(super) above: Option<Band>,
    /// Which equations count: those where the axis moves.
    pub(super) counts: Vec<bool>,
    /// Distance of samples, s.
    pub(super) step_s: f64,
    /// What they were made of.
    pub(super) raw: Arc<Raw>,
    /// End of the band, Hz.
    pub(super) bandwidth_hz: f64,
}

/// The signals before the common filter, sample by sample. Equations of another force share
/// the motion: of a long recording each signal is megabytes.
#[derive(Debug, Clone)]
pub(super) struct Raw {
    /// Force, N or N·m.
    pub(super) force: Arc<Vec<f64>>,
    /// Acceleration, m/s² or rad/s².
    pub(super) acceleration: Arc<Vec<f64>>,
    /// Speed, m/s or rad/s.
    pub(super) velocity: Option<Arc<Vec<f64>>>,
    /// Position, m or rad: as it was measured, or summed up from the speed.
    pub(super) position: Option<Arc<Vec<f64>>>,
    /// Distance of samples, s.
    pub(super) period_s: f64,
    /// Whether the motion slides or turns.
    pub(super) motion: Kind,
    /// Where the force stands at its largest or smallest value.
    pub(super) cut_off: Option<CutOff>,
}

/// The force of a recording in N (N·m where the motion turns).
///
/// # Errors
///
/// Without a force.
pub(super) fn force_of(recording: &Recording) -> Outcome<Vec<f64>> {
    let Some(force) = recording.get(Quantity::Force) else {
        return Err(IdentifyError::new(
            "there is no force or torque in the recording",
            "add a column force_n or torque_nm: from motor current, times the force constant",
        ));
    };
    Ok(force.values.clone())
}

fn raw(recording: &Recording, bandwidth_hz: f64) -> Outcome<Raw> {
    let t = recording.period_s;
    let force = force_of(recording)?;
    agree(recording)?;
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
        if signal.quantity == Quantity::Acceleration {
            quality::not_saturated(signal)?;
        }
    }
    let smooth_hz = (SMOOTH * bandwidth_hz).min(0.4 / t);
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
            return Err(IdentifyError::new(
                "there is no motion in the recording",
                "add the load's position, speed or acceleration, such as position_mm",
            ));
        }
    };
    let position = position.or_else(|| velocity.as_ref().map(|speed| summed(speed, t)));
    let moving = |signal: &&Signal| {
        !matches!(
            signal.quantity,
            Quantity::Force | Quantity::Excitation | Quantity::Command
        )
    };
    let motion = recording.signals.iter().find(moving);
    let cut_off = recording.get(Quantity::Force).and_then(quality::cut_off);
    Ok(Raw {
        force: Arc::new(force),
        acceleration: Arc::new(acceleration),
        velocity: velocity.map(Arc::new),
        position: position.map(Arc::new),
        period_s: t,
        motion: motion.map_or(Kind::Linear, |signal| signal.kind),
        cut_off,
    })
}

/// The largest speed in either direction.
fn fastest(velocity: &[f64]) -> f64 {
    velocity.iter().fold(0.0, |most, v| v.abs().max(most))
}

/// The sum of a speed over time, from 0 on.
fn summed(speed: &[f64], period_s: f64) -> Vec<f64> {
    let mut at = 0.0;
    let steps = speed.windows(2).map(|pair| {
        at += 0.5 * period_s * pair.iter().sum::<f64>();
        at
    });
    std::iter::once(0.0).chain(steps).collect()
}

/// 1 forward, −1 backward, 0 at rest.
pub(super) fn sign(v: f64) -> f64 {
    if v > 0.0 {
        1.0
    } else if v < 0.0 {
        -1.0
    } else {
        0.0
    }
}

impl Raw {
    /// Every signal after a filter.
    fn filtered(&self, filter: impl Fn(&[f64]) -> Vec<f64>) -> Band {
        let speeds = self.velocity.as_ref().map(|velocity| {
            // Where it turns round, rounding has a sign too, another one in other units.
            let rest = ROUNDING * fastest(velocity);
            let part = |keep: fn(f64) -> f64| {
                let speeds = velocity
                    .iter()
                    .map(|v| if v.abs() > rest { *v } else { 0.0 });
                let kept: Vec<f64> = speeds.map(keep).collect();
                filter(&kept)
            };
            Arc::new(Speeds {
                forward: part(|v| v.max(0.0)),
                backward: part(|v| v.min(0.0)),
                forward_sign: part(|v| sign(v).max(0.0)),
                backward_sign: part(|v| sign(v).min(0.0)),
            })
        });
        Band {
            force: filter(&self.force),
            acceleration: Arc::new(filter(&self.acceleration)),
            speeds,
            further: Vec::new(),
        }
    }
}

/// One of how many samples counts, and how many at either end do not.
fn thinning(samples: usize, bandwidth_hz: f64, t: f64) -> (usize, usize) {
    // The filter leaves nothing above its corner: 2.5 samples a period there.
    let step = ((0.4 / (bandwidth_hz * t)) as usize).max(1);
    let edge = ((1.0 / (bandwidth_hz * t)) as usize).min(samples / 10);
    (step, edge)
}

fn thin(x: &[f64], step: usize, edge: usize) -> Vec<f64> {
    let inner = x.len().saturating_sub(2 * edge);
    let kept = x.iter().skip(edge).take(inner).step_by(step);
    kept.copied().collect()
}

/// What the band leaves of a column.
fn in_band(x: &[f64], bandwidth_hz: f64, t: f64) -> Vec<f64> {
    let (step, edge) = thinning(x.len(), bandwidth_hz, t);
    thin(&low_pass(x, bandwidth_hz, t), step, edge)
}

/// What lies between the band's end and twice as far.
fn above_band(x: &[f64], bandwidth_hz: f64, t: f64) -> Vec<f64> {
    let (step, edge) = thinning(x.len(), bandwidth_hz, t);
    let up_to = |corner_hz| thin(&low_pass(x, corner_hz, t), step, edge);
    let mut apart = up_to(2.0 * bandwidth_hz);
    for (wide, narrow) in apart.iter_mut().zip(up_to(bandwidth_hz)) {
        *wide -= narrow;
    }
    apart
}

impl Equations {
    /// Those of a recording in a band from 0 Hz on.
    ///
    /// # Errors
    ///
    /// When a signal is missing, stands still or is cut off.
    pub(super) fn of(recording: &Recording, bandwidth_hz: f64) -> Outcome<Self> {
        let t = recording.period_s;
        let raw = raw(recording, bandwidth_hz)?;
        let above = raw.filtered(|x| above_band(x, bandwidth_hz, t));
        let mut out = Self::within(raw, bandwidth_hz);
        out.above = Some(above);
        Ok(out)
    }

    /// A column of all samples in the band, as the others are.
    pub(super) fn in_band(&self, column: &[f64]) -> Vec<f64> {
        in_band(column, self.bandwidth_hz, self.raw.period_s)
    }

    /// Adds a column, sample by sample; one without samples is 0.
    pub(super) fn add(&mut self, column: &[f64]) {
        let t = self.raw.period_s;
        let none = || vec![0.0; self.inside.force.len()];
        let inside = if column.is_empty() {
            none()
        } else {
            self.in_band(column)
        };
        if let Some(band) = &mut self.above {
            band.further.push(if column.is_empty() {
                vec![0.0; inside.len()]
            } else {
                above_band(column, self.bandwidth_hz, t)
            });
        }
        self.inside.further.push(inside);
    }

    /// Puts another force into the place of the recorded one.
    pub(super) fn replace_force(&mut self, force: Vec<f64>) {
        let t = self.raw.period_s;
        self.inside.force = self.in_band(&force);
        if let Some(band) = &mut self.above {
            band.force = above_band(&force, self.bandwidth_hz, t);
        }
        self.raw = Arc::new(Raw {
            force: Arc::new(force),
            ..Raw::clone(&self.raw)
        });
    }

    /// Values of all samples that stand at the places of the equations.
    pub(super) fn thinned(&self, column: &[f64]) -> Vec<f64> {
        let (step, edge) = thinning(column.len(), self.bandwidth_hz, self.raw.period_s);
        thin(column, step, edge)
    }

    fn within(raw: Raw, bandwidth_hz: f64) -> Self {
        let t = raw.period_s;
        let (step, _) = thinning(raw.force.len(), bandwidth_hz, t);
        let inside = raw.filtered(|x| in_band(x, bandwidth_hz, t));
        let fastest = fastest(raw.velocity.as_deref().map_or(&[][..], |v| v));
        // An axis that stands is held by friction of any size: no equation.
        let counts = match &inside.speeds {
            Some(speeds) => {
                let pairs = speeds.forward.iter().zip(&speeds.backward);
                pairs
                    .map(|(f, b)| (f + b).abs() > STANDING * fastest)
                    .collect()
            }
            None => vec![true; inside.force.len()],
        };
        Self {
            inside,
            above: None,
            counts,
            step_s: step as f64 * t,
            raw: Arc::new(raw),
            bandwidth_hz,
        }
    }

    /// How many equations count in which the axis moves forward, and backward.
    pub(super) fn directions(&self) -> [usize; 2] {
        let Some(speeds) = &self.inside.speeds else {
            return [0; 2];
        };
        let mut found = [0; 2];
        let all = speeds
            .forward
            .iter()
            .zip(&speeds.backward)
            .zip(&self.counts);
        for ((forward, backward), _) in all.filter(|(_, counts)| **counts) {
            let [ahead, back] = &mut found;
            *(if forward + backward > 0.0 {
                ahead
            } else {
                back
            }) += 1;
        }
        found
    }

    /// Leaves out the equations in which the axis moves forward, or backward.
    pub(super) fn leave_out(&mut self, is_forward: bool) {
        let Some(speeds) = &self.inside.speeds else {
            return;
        };
        let all = speeds.forward.iter().zip(&speeds.backward);
        for ((forward, backward), counts) in all.zip(&mut self.counts) {
            *counts = *counts && (forward + backward > 0.0) != is_forward;
        }
    }
}

#[cfg(test)]
impl Equations {
    /// Those of a band that is given as it is, every 0.01 s.
    pub(super) fn of_band(band: Band) -> Self {
        let samples = band.force.len();
        Self {
            above: Some(band.clone()),
            raw: Arc::new(Raw {
                force: Arc::new(band.force.clone()),
                acceleration: Arc::clone(&band.acceleration),
                velocity: None,
                position: None,
                period_s: 0.01,
                motion: Kind::Linear,
                cut_off: None,
            }),
            inside: band,
            counts: vec![true; samples],
            step_s: 0.01,
            bandwidth_hz: 40.0,
        }
    }
}
