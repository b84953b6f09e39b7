//! What one drive draws at a speed and an acceleration, and what a share of the supply leaves
//! it to accelerate with.
//!
//! ```text
//! p  = u·(M·a + C + B·u)      mechanical power, u the speed, a along it
//! el = p/η + K where p > 0    what is drawn
//! a ≤ (η·(P − K)/u − C − B·u)/M      with no more than P
//! ```
//!
//! C is the most Coulomb friction and the weight, which counts as lifted in both directions; K
//! what the drive draws besides: the base load of a spindle, the copper loss at the largest force
//! of an axis. Nothing that is fed back is credited.

use super::axis::{AxisPower, Side};
use gwatt_machine::units::RAD_S_PER_RPM;
use gwatt_machine::{Axis, ForcePoint, Spindle};
use gwatt_plan::period::{Curve, LimitError, Limits, Motion};

/// Halvings of the search for the largest power of a phase.
const HALVINGS: u32 = 60;

/// The power of one drive; speeds in its own unit in one second or minute: mm/s, degrees/s or
/// 1/min.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DriveLaw {
    /// M, in W by speed and acceleration, while it drives.
    inertia: f64,
    /// The least and the most while it brakes.
    braked_inertia: [f64; 2],
    /// C and B, in W by speed and its square: the most, and the least.
    friction: [[f64; 2]; 2],
    efficiency: f64,
    /// K while the drive moves, in W, and while it stands.
    besides_w: [f64; 2],
}

impl DriveLaw {
    /// That of an axis; speeds in mm/s or degrees/s.
    #[must_use]
    pub fn of_axis(axis: &Axis) -> Self {
        let own = AxisPower::new(axis);
        let si = own.si_per_unit;
        let inertia = |side: Side, grows: bool| own.mass * own.accel_factor(side, grows) * si * si;
        let friction = |side: Side, weight: f64| {
            let factor = own.friction_factor(side);
            [
                (own.coulomb * factor + weight) * si,
                own.viscous * factor * si * si,
            ]
        };
        let weight = own.gravity.abs();
        let accel = axis.accel_mm_s2 * si * own.largest_factor();
        let speed = axis.rapid_mm_s * si;
        let force = own.mass * accel + own.coulomb_most() + own.viscous_most() * speed + weight;
        Self {
            inertia: inertia(Side::Motor, true),
            braked_inertia: [Side::Motor, Side::Regen].map(|side| inertia(side, false)),
            friction: [
                friction(Side::Motor, weight),
                friction(Side::Regen, -weight),
            ],
            efficiency: own.efficiency,
            besides_w: [own.copper * force * force, own.holding_w()],
        }
    }

    /// The limits of an axis' motion: its own, and what the curve of its drive's force leaves.
    /// Speeds in mm/s or degrees/s.
    ///
    /// # Errors
    /// Numbers that are too large or too small to compute with.
    pub fn limits_of_axis(axis: &Axis, curve: &[ForcePoint]) -> Result<Limits, LimitError> {
        let own = AxisPower::new(axis);
        let jerk = if axis.jerk_mm_s3 > 0.0 {
            axis.jerk_mm_s3
        } else {
            f64::INFINITY
        };
        let mut limits = Limits::constant(axis.accel_mm_s2, jerk)?;
        if !curve.is_empty() {
            let drag = own.viscous_most() * own.si_per_unit;
            let points: Vec<(f64, f64)> = curve
                .iter()
                .map(|point| (point.speed_mm_s, point.force_n - drag * point.speed_mm_s))
                .collect();
            let friction = own.coulomb_most() + own.gravity.abs();
            let inertia = own.mass * own.accel_factor(Side::Motor, true) * own.si_per_unit;
            limits.drive = limits
                .drive
                .lowest(&Curve::torque(&points, friction, inertia)?);
            let points: Vec<(f64, f64)> = curve
                .iter()
                .map(|point| (point.speed_mm_s, point.force_n))
                .collect();
            let inertia = own.mass * own.accel_factor(Side::Regen, false) * own.si_per_unit;
            limits.brake =
                limits
                    .brake
                    .lowest(&Curve::torque(&points, own.gravity.abs(), inertia)?);
        }
        Ok(limits)
    }

    /// That of a spindle; speeds in 1/min.
    #[must_use]
    pub fn of_spindle(spindle: &Spindle) -> Self {
        let friction = [spindle.friction_nm * RAD_S_PER_RPM, 0.0];
        let inertia = spindle.inertia_kg_m2 * RAD_S_PER_RPM * RAD_S_PER_RPM;
        Self {
            inertia,
            braked_inertia: [inertia; 2],
            friction: [friction; 2],
            efficiency: spindle.efficiency,
            besides_w: [spindle.base_load_w; 2],
        }
    }

    /// The largest power that is drawn in a state of motion, W.
    #[must_use]
    pub fn drawn_w(&self, motion: Motion) -> f64 {
        let [_, standing_w] = self.besides_w;
        let u = motion.speed.abs();
        if u == 0.0 && motion.accel == 0.0 {
            return standing_w;
        }
        let along = motion.accel * motion.speed.signum();
        let mechanical_w = if along < 0.0 {
            let [least, _] = self.braked_inertia;
            (self.mechanical_w(u, 0.0) + u * least * along).max(0.0)
        } else {
            self.mechanical_w(u, along)
        };
        self.electrical_w(mechanical_w)
    }

    /// The largest power that is fed back in a state of motion, W; not negative.
    #[must_use]
    pub fn fed_back_w(&self, motion: Motion) -> f64 {
        let u = motion.speed.abs();
        let brakes = -motion.accel * motion.speed.signum();
        let [_, inertia] = self.braked_inertia;
        let [_, [coulomb, viscous]] = self.friction;
        let mechanical_w = u * (inertia * brakes.max(0.0) - coulomb - viscous * u);
        (mechanical_w * self.efficiency).max(0.0)
    }

    /// What the drive draws at rest, W.
    #[must_use]
    pub fn standing_w(&self) -> f64 {
        let [_, standing_w] = self.besides_w;
        standing_w
    }

    /// The largest power that the drive cannot do without, W: it takes its acceleration back
    /// with this jerk and holds the speed that it has then. While it brakes, what holds its speed.
    #[must_use]
    pub fn committed_w(&self, motion: Motion, jerk: f64) -> f64 {
        let u = motion.speed.abs();
        let accel = motion.accel * motion.speed.signum();
        if u == 0.0 && motion.accel == 0.0 {
            return self.standing_w();
        }
        // From rest the acceleration is along the speed that begins.
        let accel = if u == 0.0 { motion.accel.abs() } else { accel };
        if accel <= 0.0 {
            let holds_w = self.electrical_w(self.mechanical_w(u, 0.0));
            // What it has left of its acceleration where it turns, it has the other way.
            let turning = accel * accel - 2.0 * jerk * u;
            return if turning > 0.0 {
                let accel = turning.sqrt();
                holds_w.max(self.committed_w(Motion { speed: 0.0, accel }, jerk))
            } else {
                holds_w
            };
        }
        let last = u + 0.5 * accel * accel / jerk;
        let at = |a: f64| self.mechanical_w(last - 0.5 * a * a / jerk, a);
        // dp/da falls as a grows: there is one largest value.
        let [[coulomb, viscous], _] = self.friction;
        let rises = |a: f64| {
            let u = last - 0.5 * a * a / jerk;
            self.inertia * u - a / jerk * (self.inertia * a + coulomb + 2.0 * viscous * u) > 0.0
        };
        let (mut low, mut high) = (0.0, accel);
        if rises(accel) {
            low = accel;
        } else {
            for _ in 0..HALVINGS {
                let middle = f64::midpoint(low, high);
                if rises(middle) {
                    low = middle;
                } else {
                    high = middle;
                }
            }
        }
        self.electrical_w(at(low).max(at(high)))
    }

    /// The largest power that a run from a state of motion to a speed draws with these limits of
    /// the acceleration, W, from above.
    #[must_use]
    pub fn wanted_w(&self, motion: Motion, target: f64, accel: &Curve) -> f64 {
        const STEPS: u32 = 32;
        let from = motion.speed.abs();
        let to = target.abs().max(from);
        let steps = (0..STEPS).map(|step| {
            let speed = |step: u32| from + (to - from) * f64::from(step) / f64::from(STEPS);
            self.mechanical_w(speed(step + 1), accel.at(speed(step)))
        });
        self.electrical_w(steps.fold(self.mechanical_w(from, 0.0), f64::max))
    }

    /// The limits of the acceleration while the speed grows with no more than a power, W.
    ///
    /// # Errors
    /// The power leaves nothing to accelerate with.
    pub fn within(&self, accel: &Curve, power_w: f64) -> Result<Curve, LimitError> {
        let [besides_w, _] = self.besides_w;
        let [friction, _] = self.friction;
        let mechanical_w = (power_w - besides_w) * self.efficiency;
        accel.limited_by_power_and_drag(mechanical_w, friction, self.inertia)
    }

    /// Mechanical power at a speed and an acceleration along it, neither negative, W.
    fn mechanical_w(&self, u: f64, a: f64) -> f64 {
        let [[coulomb, viscous], _] = self.friction;
        u * (self.inertia * a + coulomb + viscous * u)
    }

    fn electrical_w(&self, mechanical_w: f64) -> f64 {
        let [besides_w, _] = self.besides_w;
        mechanical_w / self.efficiency + besides_w
    }
}

#[cfg(test)]
mod tests {
    use super::DriveLaw;
    use gwatt_plan::period::{Curve, Motion};

    /// M = 0.5, C = 2, B = 0.1, η = 0.8, 10 W besides, 3 W at rest.
    const LAW: DriveLaw = DriveLaw {
        inertia: 0.5,
        braked_inertia: [0.5; 2],
        friction: [[2.0, 0.1]; 2],
        efficiency: 0.8,
        besides_w: [10.0, 3.0],
    };

    fn motion(speed: f64, accel: f64) -> Motion {
        Motion { speed, accel }
    }

    #[test]
    fn powers_by_hand() {
        // 10·(0.5·8 + 2 + 1) = 70 W, by 0.8, and 10 W.
        assert_eq!(LAW.drawn_w(motion(10.0, 8.0)), 97.5);
        assert_eq!(LAW.drawn_w(motion(-10.0, -8.0)), 97.5);
        assert_eq!(LAW.drawn_w(motion(0.0, 0.0)), 3.0);
        // What slows it down besides friction comes from the drive from 6 on: 30 W − 10·0.5·a.
        assert_eq!(LAW.drawn_w(motion(10.0, -8.0)), 10.0);
        assert_eq!(LAW.drawn_w(motion(10.0, -4.0)), 22.5);
        // 10·(4 − 2 − 1) = 10 W, of which 0.8 comes back.
        assert_eq!(LAW.fed_back_w(motion(10.0, -8.0)), 8.0);
        assert_eq!(LAW.fed_back_w(motion(10.0, 8.0)), 0.0);
        assert_eq!(LAW.fed_back_w(motion(10.0, -2.0)), 0.0);
    }

    /// What a drive cannot do without is the most along the way back to no acceleration.
    #[test]
    fn what_is_committed_is_the_most_on_the_way_back() {
        for (speed, accel, jerk) in [(10.0, 8.0, 20.0), (0.0, 8.0, 5.0), (2.0, 1.0, 50.0)] {
            let found = LAW.committed_w(motion(speed, accel), jerk);
            let along = (0..=10_000).map(|step| {
                let t = accel / jerk * f64::from(step) / 1e4;
                let u = speed + accel * t - 0.5 * jerk * t * t;
                LAW.drawn_w(motion(u.max(1e-12), accel - jerk * t))
            });
            let most = along.fold(0.0, f64::max);
            assert!(found >= most * (1.0 - 1e-12), "{found} {most}");
            assert!(found <= most * (1.0 + 1e-6), "{found} {most}");
        }
        assert_eq!(LAW.committed_w(motion(10.0, -8.0), 20.0), 47.5);
        assert_eq!(LAW.committed_w(motion(0.0, 0.0), 20.0), 3.0);
        // It turns: √(8² − 2·20·0.1) is left where it stands.
        let turns = LAW.committed_w(motion(0.0, f64::sqrt(60.0)), 20.0);
        assert_eq!(LAW.committed_w(motion(0.1, -8.0), 20.0), turns);
    }

    #[test]
    fn a_share_leaves_what_it_draws() -> Result<(), gwatt_plan::period::LimitError> {
        let own = Curve::constant(8.0)?;
        let within = LAW.within(&own, 60.0)?;
        assert_eq!(within.at(1.0), 8.0);
        // (40/10 − 2 − 1)/0.5.
        assert!((within.at(10.0) - 2.0).abs() < 1e-12);
        assert!((LAW.drawn_w(motion(10.0, within.at(10.0))) - 60.0).abs() < 1e-9);
        assert!(LAW.within(&own, 10.0).is_err());
        let wanted = LAW.wanted_w(motion(0.0, 0.0), 10.0, &own);
        assert!((97.5..110.0).contains(&wanted), "{wanted}");
        Ok(())
    }
}
