//! What a drive can do: acceleration and jerk, each by speed.

use super::curve::{Curve, LimitError, MAX_PIECES, positive};

/// Share of the jerk that a planner in periods keeps free: it takes up what
/// rounding has left before.
const SPARE: f64 = 1e-10;

/// The largest jerk, in steps of the magnitude of the speed.
#[derive(Debug, Clone, PartialEq)]
pub struct Jerk {
    steps: Vec<(f64, f64)>,
    /// Share of the true limit that is kept free for rounding.
    spare: f64,
}

impl Jerk {
    /// The same jerk at every speed; infinite: no limit.
    ///
    /// # Errors
    /// It is not positive.
    pub fn constant(jerk: f64) -> Result<Self, LimitError> {
        if jerk.is_nan() || jerk <= 0.0 {
            return Err(LimitError::NotPositive("the jerk"));
        }
        Ok(Self {
            steps: vec![(0.0, jerk)],
            spare: 0.0,
        })
    }

    /// Steps (speed from which it holds, jerk), the first at speed 0.
    ///
    /// # Errors
    /// The speeds do not ascend from 0, or a jerk is not finite and positive.
    pub fn steps(steps: &[(f64, f64)]) -> Result<Self, LimitError> {
        if steps.is_empty()
            || steps.len() > MAX_PIECES
            || steps.first().is_none_or(|first| first.0 != 0.0)
            || !steps.is_sorted_by(|a, b| a.0 < b.0 && b.0.is_finite())
        {
            return Err(LimitError::Points);
        }
        for step in steps {
            positive(step.1, "the jerk")?;
        }
        Ok(Self {
            steps: steps.to_vec(),
            spare: 0.0,
        })
    }

    /// The jerk at speed `v` of either sign; where two steps meet, the faster's.
    #[must_use]
    pub fn at(&self, v: f64) -> f64 {
        let at = self.steps.partition_point(|step| step.0 <= v.abs());
        let step = self.steps.get(at.saturating_sub(1));
        step.map_or(f64::INFINITY, |step| step.1)
    }

    /// The largest jerk at any speed.
    #[must_use]
    pub fn largest(&self) -> f64 {
        self.steps.iter().fold(0.0, |most, step| step.1.max(most))
    }

    /// The smallest jerk limit at any speed.
    #[must_use]
    pub fn smallest(&self) -> f64 {
        let steps = self.steps.iter();
        steps.fold(f64::INFINITY, |least, step| step.1.min(least))
    }

    /// The change of `a²/2` that this jerk makes between two speeds: its
    /// integral over the speed, signed.
    pub(super) fn integral(&self, from: f64, to: f64) -> f64 {
        if self.steps.len() == 1 {
            return self.at(0.0) * (to - from);
        }
        // Over the magnitude, from 0.
        let below = |u: f64| {
            let mut ends = self.borders();
            self.steps.iter().fold(0.0, |sum, &(start, jerk)| {
                let end = ends.next().unwrap_or(f64::INFINITY).min(u);
                sum + jerk * (end - start).max(0.0)
            })
        };
        below(to.abs()).copysign(to) - below(from.abs()).copysign(from)
    }

    /// True when the limit is the same at every speed.
    #[must_use]
    pub fn is_constant(&self) -> bool {
        self.steps.len() == 1
    }

    /// True without a limit.
    #[must_use]
    pub fn is_unlimited(&self) -> bool {
        self.largest().is_infinite()
    }

    /// Share of the limit that is kept free for rounding.
    pub(super) fn spare(&self) -> f64 {
        self.spare
    }

    pub(super) fn borders(&self) -> impl Iterator<Item = f64> {
        self.steps.iter().skip(1).map(|step| step.0)
    }

    /// The lower of the two at each speed.
    #[must_use]
    pub fn lowest(&self, other: &Self) -> Self {
        let mut borders: Vec<f64> = [0.0].into_iter().chain(self.borders()).collect();
        borders.extend(other.borders());
        borders.sort_by(f64::total_cmp);
        borders.dedup();
        let lower = |v: f64| (v, self.at(v).min(other.at(v)));
        Self {
            steps: borders.into_iter().map(lower).collect(),
            spare: 0.0,
        }
    }
}

/// Limits of one drive, alike in both directions of motion.
#[derive(Debug, Clone, PartialEq)]
pub struct Limits {
    /// The largest acceleration while the magnitude of the speed grows.
    pub drive: Curve,
    /// The largest deceleration while it falls.
    pub brake: Curve,
    /// The largest jerk.
    pub jerk: Jerk,
}

impl Limits {
    /// The same acceleration and jerk at every speed.
    ///
    /// # Errors
    /// A value is not positive, or the acceleration not finite.
    pub fn constant(accel: f64, jerk: f64) -> Result<Self, LimitError> {
        Ok(Self {
            drive: Curve::constant(accel)?,
            brake: Curve::constant(accel)?,
            jerk: Jerk::constant(jerk)?,
        })
    }

    /// Constant torque up to `base_speed`, constant power above, driving and
    /// braking alike.
    ///
    /// # Errors
    /// A value is not positive, or not finite.
    pub fn constant_power(accel: f64, base_speed: f64, jerk: f64) -> Result<Self, LimitError> {
        let drive = Curve::constant_power(accel, base_speed)?;
        Ok(Self {
            brake: drive.clone(),
            drive,
            jerk: Jerk::constant(jerk)?,
        })
    }

    /// Limits of a path on which several drives run in step, each at a fixed
    /// share of the path's speed: the lowest at each speed. A drive with share
    /// 0 stands still and limits nothing; `None` if all do.
    #[must_use]
    pub fn in_step(drives: &[(f64, &Self)]) -> Option<Self> {
        let scaled = |share: f64, limits: &Self| {
            let factor = 1.0 / share.abs();
            let steps = limits.jerk.steps.iter();
            Self {
                drive: limits.drive.scaled(factor),
                brake: limits.brake.scaled(factor),
                jerk: Jerk {
                    steps: steps.map(|s| (s.0 * factor, s.1 * factor)).collect(),
                    spare: 0.0,
                },
            }
        };
        drives
            .iter()
            .filter(|(share, _)| *share != 0.0)
            .map(|&(share, limits)| scaled(share, limits))
            .reduce(|a, b| Self {
                drive: a.drive.lowest(&b.drive),
                brake: a.brake.lowest(&b.brake),
                jerk: a.jerk.lowest(&b.jerk),
            })
    }

    /// The same with a little less jerk, so that the differences of what is put
    /// out every `period_s` stay within the limit however they are rounded.
    pub(super) fn for_period(&self, period_s: f64) -> Self {
        let accel = self.drive.at(0.0).max(self.brake.at(0.0));
        let digits = 8.0 * f64::EPSILON * accel / (self.jerk.smallest() * period_s);
        let spare = (SPARE + digits).min(0.5);
        let steps = self.jerk.steps.iter();
        Self {
            jerk: Jerk {
                steps: steps.map(|s| (s.0, s.1 * (1.0 - spare))).collect(),
                spare,
            },
            ..self.clone()
        }
    }

    /// The largest acceleration in + direction at the signed speed `v`.
    #[must_use]
    pub fn up(&self, v: f64) -> f64 {
        if v < 0.0 {
            self.brake.at(v)
        } else {
            self.drive.at(v)
        }
    }
}
