//! What slow motion shows of mass and friction of an axis that is flexible.
//!
//! Where an axis moves slowly it is as good as rigid, and it does not count at which of its
//! masses friction acts. What it does above that does: a model of a force at the motor and
//! friction at the table would need a transfer function for each. The sign of the speed is
//! taken before any filter: a table that swings as it turns round goes to and fro, which a
//! smoothed speed does not show, and Coulomb friction passes for viscous.

use nalgebra::DMatrix;

use super::column::Quantity;
use super::figure::Figure;
use super::filter::{derivative, low_pass};
use super::normal::Normal;
use super::recording::Recording;
use super::sandwich::{sandwich, widening};
use super::speeds::{Followed, Speed, are_sums, between, followed, mean_sign, mean_speed, speeds};

/// Band in which friction is looked for, Hz, and as a share of the sampling rate at most.
pub(super) const SLOW_HZ: f64 = 5.0;
const SLOW_SHARE: f64 = 0.1;
/// Below this share of the largest speed an axis counts as standing.
const STANDING: f64 = 0.005;
/// Motion is one way where the other has fewer rows, or a smaller share.
const OTHER_WAY: usize = 5;
const OTHER_WAY_SHARE: f64 = 0.02;
/// A band has so many independent values for each row: 2 a period of its end, of 2.5.
const INDEPENDENT: f64 = 0.8;
/// Samples by which speeds that may be it are compared.
const COMPARED: usize = 30_000;
/// Coulomb friction from which on the speed of an acceleration is followed, as shares of
/// the force.
const STARTS: [f64; 3] = [0.05, 0.15, 0.3];
/// How often speed and friction are found from one another, and by which share the friction
/// still changes then.
const ROUNDS: usize = 8;
const SETTLED: f64 = 0.005;

/// Coulomb friction as a share: what reversals between samples make of it, and what the
/// drift of a summed acceleration does, in simulations.
const BETWEEN_SAMPLES: f64 = 0.015;
const SUMMED: f64 = 0.12;
/// The same of viscous friction.
const SUMMED_VISCOUS: f64 = 0.04;

/// Places of the unknowns; between them are those of the jerk, which stands for what is late,
/// and of an offset.
const MASS: usize = 0;
const VISCOUS: usize = 1;
const COULOMB: usize = 4;

/// Mass and friction of slow motion.
#[derive(Debug, Clone)]
pub(super) struct SlowMotion {
    pub(super) mass: f64,
    pub(super) viscous: Figure,
    /// Absent where the motion is one way: an offset is as good.
    pub(super) coulomb: Option<Figure>,
    /// By how much viscous friction is off where Coulomb friction is, by its standard error:
    /// each takes the other's place.
    pub(super) exchanged: f64,
    /// Sum of squares of what is left of the force.
    left: f64,
}

impl SlowMotion {
    /// With what is wrong with the speed in the errors.
    fn widened(mut self, is_summed: bool) -> Self {
        let (coulomb, viscous) = if is_summed {
            (SUMMED, SUMMED_VISCOUS)
        } else {
            (BETWEEN_SAMPLES, 0.0)
        };
        let viscous = viscous * self.viscous.value;
        let mut taken = 0.0;
        if let Some(figure) = &mut self.coulomb {
            let more = coulomb * figure.value;
            figure.std = libm::hypot(figure.std, more);
            taken = self.exchanged * more;
        }
        self.viscous.std = libm::hypot(libm::hypot(self.viscous.std, viscous), taken);
        self
    }
}

/// Mass and friction of a recording, and the speed that they go with best. `None` where it
/// does not show them, or has no force or motion.
pub(super) fn slow_motion(recording: &Recording) -> Option<(SlowMotion, Speed)> {
    let t = recording.period_s;
    let force = &recording.get(Quantity::Force)?.values;
    let measured = recording.get(Quantity::Acceleration).map(|it| &it.values);
    // That of a held force: as a mean from sample to sample, as the friction is.
    let acceleration = match measured {
        Some(measured) => between(measured, mean_speed),
        None => differences(&speeds(recording).next_back()?.plain, t),
    };
    let is_summed = are_sums(recording);
    let mut follows = None;
    if let Some(measured) = measured.filter(|_| is_summed) {
        let compared = COMPARED.min(force.len()).min(measured.len());
        let head = |x: &'_ [f64]| x.get(..compared).unwrap_or_default().to_vec();
        let slow = Slow::of(&head(force), &head(&acceleration), t);
        let plain = speeds(recording).map(|speed| Speed::alone(head(&speed.plain)));
        let sums: Vec<Speed> = plain.collect();
        let by = friction_of_the_followed(&slow, &head(measured), &head(force), &sums);
        follows = by.map(|by| (measured, by));
    }
    let slow = Slow::of(force, &acceleration, t);
    drop(acceleration);
    let follows = follows.into_iter();
    let follows = follows.map(|(measured, by)| Speed::alone(followed(measured, force, by, t)));
    // One after the other, of which the best so far is kept.
    let found = speeds(recording).chain(follows).filter_map(|speed| {
        let found = slow.solved(&speed, is_summed)?;
        Some((found, speed))
    });
    let (found, speed) = found.min_by(|a, b| a.0.left.total_cmp(&b.0.left))?;
    Some((found.widened(is_summed), speed))
}

/// Mass and friction by which the speed of an acceleration is followed best, each found from
/// the other in turn. `None` where a sum is as good.
fn friction_of_the_followed(
    slow: &Slow,
    acceleration: &[f64],
    force: &[f64],
    sums: &[Speed],
) -> Option<Followed> {
    let sums = sums.iter().filter_map(|sum| slow.solved(sum, true));
    let sum = sums.min_by(|a, b| a.left.total_cmp(&b.left))?;
    let squares: f64 = force.iter().map(|f| f * f).sum();
    let rms = (squares / force.len().max(1) as f64).sqrt();
    let from = |viscous: f64, coulomb: f64| Followed {
        mass: sum.mass,
        viscous: viscous.max(0.0),
        coulomb: coulomb.max(0.0),
    };
    let known = from(sum.viscous.value, sum.coulomb.map_or(0.0, |it| it.value));
    let starts = STARTS.map(|share| from(0.0, share * rms));
    let (mut least, mut best) = (sum.left, None);
    for mut by in std::iter::once(known).chain(starts) {
        for _ in 0..ROUNDS {
            if by.mass <= 0.0 {
                break;
            }
            let speed = Speed::alone(followed(acceleration, force, by, slow.period_s));
            let Some(found) = slow.solved(&speed, true) else {
                break;
            };
            if found.left < least {
                (least, best) = (found.left, Some(by));
            }
            let coulomb = found.coulomb.map_or(0.0, |it| it.value).max(0.0);
            let is_settled = (coulomb - by.coulomb).abs() <= SETTLED * coulomb;
            by = Followed {
                mass: found.mass,
                ..from(found.viscous.value, coulomb)
            };
            if is_settled {
                break;
            }
        }
    }
    best
}

/// How a speed changes from each sample to the next one.
fn differences(speed: &[f64], period_s: f64) -> Vec<f64> {
    between(speed, |a, b| (b - a) / period_s)
}

/// A recording in the slow band, but for the speed: what of it becomes a row. All samples of
/// all signals would be many times a long recording.
struct Slow {
    force: Vec<f64>,
    acceleration: Vec<f64>,
    jerk: Vec<f64>,
    period_s: f64,
}

/// What the band leaves of a column.
pub(super) fn in_band(x: &[f64], t: f64) -> Vec<f64> {
    low_pass(x, SLOW_HZ.min(SLOW_SHARE / t), t)
}

/// The samples of a slow column that become rows: 2.5 a period of the band's end.
fn thin(x: &[f64], t: f64) -> Vec<f64> {
    let band_hz = SLOW_HZ.min(SLOW_SHARE / t);
    let step = ((0.4 / (band_hz * t)) as usize).max(1);
    let edge = ((1.0 / (band_hz * t)) as usize).min(x.len() / 10);
    let inner = x.get(edge..x.len().saturating_sub(edge));
    let kept = inner.unwrap_or_default().iter().step_by(step);
    kept.copied().collect()
}

impl Slow {
    fn of(force: &[f64], acceleration: &[f64], period_s: f64) -> Self {
        let acceleration = in_band(acceleration, period_s);
        Self {
            force: thin(&in_band(force, period_s), period_s),
            jerk: thin(&derivative(&acceleration, period_s), period_s),
            acceleration: thin(&acceleration, period_s),
            period_s,
        }
    }

    /// Solves for mass and friction of this speed. `None` where the motion does not show
    /// them.
    fn solved(&self, speed: &Speed, is_summed: bool) -> Option<SlowMotion> {
        let t = self.period_s;
        let slow = in_band(&speed.means(), t);
        let fastest = slow.iter().fold(0.0_f64, |most, v| v.abs().max(most));
        let slow = thin(&slow, t);
        let signs = thin(&in_band(&between(&speed.smooth, mean_sign), t), t);
        let moved = slow.iter().zip(&signs);
        let driven = self.acceleration.iter().zip(&self.jerk).zip(&self.force);
        let mut rows: Vec<(Vec<f64>, f64)> = moved
            .zip(driven)
            // An axis that stands is held by friction of any size.
            .filter(|((v, _), _)| v.abs() > STANDING * fastest)
            .map(|((v, sign), ((acceleration, jerk), force))| {
                (vec![*acceleration, *v, *jerk, 1.0, *sign], *force)
            })
            .collect();
        // Sums of accelerations do not show which way. One way Coulomb friction is as good
        // as an offset.
        if let Some(way) = one_way(&rows).filter(|_| !is_summed) {
            rows.retain(|(row, _)| way * speed_of_row(row) > 0.0);
            for (row, _) in &mut rows {
                row.truncate(COULOMB);
            }
        }
        solved(&rows)
    }
}

/// The way that slow motion goes, 1 or −1, where nearly all of it is one way.
fn one_way(rows: &[(Vec<f64>, f64)]) -> Option<f64> {
    let forward = rows.iter().filter(|(row, _)| speed_of_row(row) > 0.0);
    let forward = forward.count();
    let backward = rows.len() - forward;
    let (less, more) = (forward.min(backward), forward.max(backward));
    let is_one_way = less < OTHER_WAY || (less as f64) < OTHER_WAY_SHARE * more as f64;
    is_one_way.then_some(if forward > backward { 1.0 } else { -1.0 })
}

fn speed_of_row(row: &[f64]) -> f64 {
    row.get(VISCOUS).copied().unwrap_or_default()
}

fn solved(rows: &[(Vec<f64>, f64)]) -> Option<SlowMotion> {
    let width = rows.first()?.0.len();
    let mut normal = Normal::new(width);
    for (row, force) in rows {
        normal.add(row, *force);
    }
    let solution = normal.solve()?;
    let theta = solution.x.as_slice();
    let (mut left, mut scores) = (0.0, Vec::with_capacity(rows.len() * width));
    for (row, force) in rows {
        let gap = force - row.iter().zip(theta).map(|(x, p)| x * p).sum::<f64>();
        left += gap * gap;
        scores.extend(row.iter().map(|x| x * gap));
    }
    let known = INDEPENDENT * rows.len() as f64;
    let freedom = (known - width as f64 - 2.0).max(0.5);
    let covariance: DMatrix<f64> =
        sandwich(&[scores], &solution.inverse) * (known / freedom) * widening(rows.len());
    let figure = |at: usize| {
        let (value, std) = (*theta.get(at)?, covariance[(at, at)].sqrt());
        (value.is_finite() && std.is_finite()).then_some(Figure { value, std })
    };
    let coulomb = if width > COULOMB {
        Some(figure(COULOMB)?)
    } else {
        None
    };
    let exchanged = coulomb.map_or(0.0, |coulomb| {
        covariance[(VISCOUS, COULOMB)].abs() / (coulomb.std * coulomb.std).max(f64::MIN_POSITIVE)
    });
    Some(SlowMotion {
        mass: figure(MASS)?.value,
        viscous: figure(VISCOUS)?,
        coulomb,
        exchanged,
        left,
    })
}
