//! The spindle under constant surface speed (G96).
//!
//! Input: the surface speed V, the clamp, the place of the spindle's axis, and a
//! move. Output: the speeds on the way, and what following them takes. At the
//! distance r of the tool from the axis
//!
//! ```text
//! n = V/(2π·r), at most the clamp          dn/dt = −n·(dr/dt)/r
//! ```

use super::quadrature::integral;
use super::spindle::SpindlePower;
use super::spindle_state::SpindleMotor;
use gwatt_machine::units::SECONDS_PER_MINUTE;
use gwatt_motion::{Move, MoveKind};
use gwatt_plan::period::Motion;
use gwatt_plan::{Plan, Profile, Trajectory};
use std::f64::consts::TAU;

/// Speeds between the ends of a range at which the drive's limit is compared.
const SAMPLES: u32 = 16;
/// Halvings that find where the clamp begins.
const HALVINGS: u32 = 60;

/// G96 in force; with the sign of the direction of rotation and the override.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Surface {
    /// V, mm/s.
    pub speed_mm_s: f64,
    /// Largest speed, 1/min.
    pub clamp_rpm: f64,
    /// X of the axis in machine coordinates, mm; not a number: not known.
    pub center_mm: f64,
    /// ±1.
    pub sign: f64,
}

/// Speeds of a move, 1/min, signed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Speeds {
    pub start: f64,
    pub end: f64,
    /// Lowest and highest.
    pub range: [f64; 2],
}

impl Surface {
    fn at(&self, radius_mm: f64) -> f64 {
        // On the axis rounding must not make a negative 0 of it.
        let n = self.speed_mm_s * SECONDS_PER_MINUTE / (TAU * radius_mm.abs());
        // Not a number at V = 0 on the axis.
        let n = if n < self.clamp_rpm {
            n
        } else {
            self.clamp_rpm
        };
        self.sign * n
    }

    /// Speed and acceleration with X at `x_mm`, moving at `velocity_mm_s`, by the
    /// law that holds at `inside_mm`.
    pub fn motion(&self, x_mm: f64, inside_mm: f64, velocity_mm_s: f64) -> Motion {
        let side = (inside_mm - self.center_mm).signum();
        let r = side * (x_mm - self.center_mm);
        if self.beyond_clamp_mm(inside_mm) <= 0.0 {
            let speed = self.sign * self.clamp_rpm;
            return Motion { speed, accel: 0.0 };
        }
        let speed = self.sign * self.speed_mm_s * SECONDS_PER_MINUTE / (TAU * r);
        let accel = -speed * side * velocity_mm_s / r;
        Motion { speed, accel }
    }

    /// How far X is from where the clamp begins: below 0 the clamp holds.
    pub fn beyond_clamp_mm(&self, x_mm: f64) -> f64 {
        (x_mm - self.center_mm).abs() - self.clamp_radius_mm()
    }

    /// Where the clamp begins.
    fn clamp_radius_mm(&self) -> f64 {
        self.speed_mm_s * SECONDS_PER_MINUTE / (TAU * self.clamp_rpm)
    }

    /// The speeds on a move; `None` where nothing is known but the clamp.
    pub fn speeds(&self, mv: &Move) -> Option<Speeds> {
        if self.center_mm.is_nan() || mv.unknown_start.contains(0) {
            return None;
        }
        let [from, to] = [&mv.start, &mv.end].map(|place| place[0] - self.center_mm);
        let (mut low, mut high) = (from.min(to), from.max(to));
        if let Some(arc) = &mv.arc {
            for (axis, center) in arc.plane.into_iter().zip(arc.center) {
                if axis == 0 {
                    low = low.min(center - self.center_mm - arc.radius_mm);
                    high = high.max(center - self.center_mm + arc.radius_mm);
                }
            }
        }
        let nearest = if low > 0.0 { low } else { (-high).max(0.0) };
        let farthest = high.abs().max(low.abs());
        let mut range = [self.at(farthest), self.at(nearest)];
        range.sort_by(f64::total_cmp);
        Some(Speeds {
            start: self.at(from.abs()),
            end: self.at(to.abs()),
            range,
        })
    }

    /// The largest and the smallest power of following a straight feed at up to
    /// `speed_mm_s` along the path, W; `None` where the drive cannot.
    pub fn following(&self, motor: &SpindleMotor, mv: &Move, speed_mm_s: f64) -> Option<[f64; 2]> {
        if mv.arc.is_some() || mv.kind == MoveKind::Rapid || mv.length_mm <= 0.0 {
            return None;
        }
        let [from, to] = [&mv.start, &mv.end].map(|place| place[0] - self.center_mm);
        if from * to < 0.0 {
            return None;
        }
        let radial_mm_s = speed_mm_s * (to - from).abs() / mv.length_mm;
        let (near, far) = (from.abs().min(to.abs()), from.abs().max(to.abs()));
        let inward = to.abs() < from.abs();
        let clamp = self.clamp_radius_mm();
        let [inertia, friction] = motor.power.coefficients();
        let mut extremes = [self.at(near), self.at(far)].map(|n| motor.holding_w(n));
        extremes.sort_by(|a, b| b.total_cmp(a));
        if far <= clamp {
            return Some(extremes);
        }
        let nearest = near.max(clamp);
        // Over u = 1/r: |n| = c·u, |dn/dt| = c·vr·u².
        let c = self.speed_mm_s * SECONDS_PER_MINUTE / TAU;
        let rate = |radius: f64| c * radial_mm_s / (radius * radius);
        let sampled = (0..=SAMPLES).map(|i| {
            let share = f64::from(i) / f64::from(SAMPLES);
            nearest + share * (far - nearest)
        });
        let limits = &motor.limits;
        for radius in sampled {
            let limit = limits.drive.at(c / radius).min(limits.brake.at(c / radius));
            if rate(radius) > limit {
                return None;
            }
        }
        let power = |radius: f64| {
            let n = c / radius;
            let change = if inward { rate(radius) } else { -rate(radius) };
            motor.power.converted(n * (inertia * change + friction))
        };
        // −M·c²·vr·u³ + C·c·u has an extreme at u² = C/(3·M·c·vr).
        let turning = (3.0 * inertia * c * radial_mm_s / friction).sqrt();
        for radius in [nearest, far, turning.clamp(nearest, far)] {
            if radius.is_finite() {
                extremes[0] = extremes[0].max(power(radius));
                extremes[1] = extremes[1].min(power(radius));
            }
        }
        Some(extremes)
    }

    /// The same at any override of feed and spindle up to these; what it gives is no more
    /// than at rest. `most_rpm` is the clamp at most: whether an override lowers it is not
    /// known, and where it does not the spindle follows the closer to the axis the lower it
    /// stands, at the clamp's speed at most.
    ///
    /// `n ≤ min(c/r, clamp)` and `dn/dt ≤ n·vr/r`: both are largest where the tool is
    /// nearest, and so is what they take. Turned down n falls, and with it what follows the
    /// square of it more than friction.
    pub fn following_lower(
        &self,
        motor: &SpindleMotor,
        mv: &Move,
        speed_mm_s: f64,
        most_rpm: f64,
    ) -> Option<[f64; 2]> {
        let [from, to] = [&mv.start, &mv.end].map(|place| place[0] - self.center_mm);
        let (near, far) = (from.abs().min(to.abs()), from.abs().max(to.abs()));
        let radial_mm_s = speed_mm_s * (to - from).abs() / mv.length_mm;
        let c = self.speed_mm_s * SECONDS_PER_MINUTE / TAU;
        let speed = |radius: f64| (c / radius).min(most_rpm);
        let rate = |radius: f64| speed(radius) * radial_mm_s / radius;
        let share = |i: u32| f64::from(i) / f64::from(SAMPLES);
        for radius in (0..=SAMPLES).map(|i| near + share(i) * (far - near)) {
            let limits = &motor.limits;
            let speeds = (0..=SAMPLES).map(|i| share(i) * speed(radius));
            let limit = speeds.fold(f64::INFINITY, |least, n| {
                least.min(limits.drive.at(n)).min(limits.brake.at(n))
            });
            // Not a number on the axis.
            if rate(radius).is_nan() || rate(radius) > limit {
                return None;
            }
        }
        let [inertia, friction] = motor.power.coefficients();
        let power_w = |sign: f64| {
            let n = speed(near);
            motor
                .power
                .converted(n * (sign * inertia * rate(near) + friction))
        };
        let inward = to.abs() < from.abs();
        let held_w = motor.holding_w(speed(near));
        Some(if inward {
            [held_w.max(power_w(1.0)), 0.0]
        } else {
            [held_w, power_w(-1.0).min(0.0)]
        })
    }

    /// Energy of following a planned move, J: with what is fed back taken off,
    /// and without; the move stays on one side of the axis.
    pub fn energy(&self, power: &SpindlePower, mv: &Move, plan: &Plan) -> [f64; 2] {
        let Trajectory::Path(profile) = &plan.trajectory else {
            return [0.0; 2];
        };
        let clamp = self.clamp_radius_mm();
        let [from, to] = [&mv.start, &mv.end].map(|place| (place[0] - self.center_mm).abs());
        let per_length = (to - from) / mv.length_mm;
        let radius = |position_mm: f64| from + per_length * position_mm;
        let [inertia, friction] = power.coefficients();
        let c = self.speed_mm_s * SECONDS_PER_MINUTE / TAU;
        let mut energy = [0.0; 2];
        for (start_s, end_s) in spans(profile, |position| radius(position) - clamp) {
            let watts = |t: f64| {
                let Some(state) = profile.state_at(t) else {
                    return 0.0;
                };
                let r = radius(state.position_mm);
                let (n, change) = if r > clamp {
                    (c / r, -c / (r * r) * per_length * state.velocity_mm_s)
                } else {
                    (self.clamp_rpm, 0.0)
                };
                power.converted(n * (inertia * change + friction))
            };
            energy[0] += integral(watts, start_s, end_s);
            energy[1] += integral(|t| watts(t).max(0.0), start_s, end_s);
        }
        energy
    }
}

/// The phases of a profile as spans of time, cut where a function of the
/// position changes its sign.
fn spans(profile: &Profile, side: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
    let mut spans = Vec::new();
    let mut start = 0.0;
    for phase in &profile.phases {
        let end = start + phase.duration_s;
        let at = |t: f64| side(phase.state_at(t).position_mm);
        let (mut low, mut high) = (0.0, phase.duration_s);
        if at(low) * at(high) < 0.0 {
            let sign = at(low).signum();
            for _ in 0..HALVINGS {
                let middle = f64::midpoint(low, high);
                if at(middle) * sign > 0.0 {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            spans.push((start, start + low));
            spans.push((start + low, end));
        } else {
            spans.push((start, end));
        }
        start = end;
    }
    spans
}
