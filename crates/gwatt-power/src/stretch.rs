//! Demand of a stretch of time on which speed and acceleration of every axis
//! are polynomials and keep their signs.
//!
//! Input: a [`Course`] for each axis. Output: peaks and energy, added to the
//! [`Totals`].
//!
//! The variable z is time at constant jerk, as a share of the stretch, and the
//! path speed where acceleration is a function of it: at constant power
//! (`a = p/v − d`) and along a slope. Then
//!
//! ```text
//! F·w = m·(a·w) + b·(v·w) + c·w        of the second degree
//! el·w² = (v·w)·(F·w)/η + R·(F·w)²     of the fourth degree
//! ```
//!
//! with w = z at constant power and 1 otherwise. Between the points at which
//! the mechanical or electrical power of an axis changes its sign (`F = 0`,
//! `η·v + R·F = 0`), or its force the law that counts, the power of all together is one such function, whose
//! derivative has a numerator of the fourth degree: all extremes are found, and
//! every piece is evaluated up to both its ends. The energy is an exact
//! integral over time, and a quadrature `dt = dv/a` over speed.

use super::axis::{AxisPower, Side};
use super::demand::{Totals, Want, larger};
use super::polynomial::Polynomial;
use super::quadrature::integral;
use arrayvec::ArrayVec;
use gwatt_machine::AXES;
use gwatt_plan::{Phase, PhaseKind};

/// Points at which the law of an axis' power may change: two roots each of six
/// functions, four of one.
const CHANGES: usize = 16 * AXES;

/// What z stands for.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Variable {
    /// Share of the time of a stretch that lasts so many s.
    Time(f64),
    /// Speed of the path under `a·w`, of the second degree.
    Speed {
        /// Coefficients of path acceleration times w.
        accel: [f64; 3],
        /// Whether w is z.
        weighted: bool,
    },
}

/// The law of motion of a path over a stretch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Course {
    variable: Variable,
    /// z at both ends, in order.
    from: f64,
    to: f64,
    /// Speed times w.
    speed: [f64; 3],
    /// Acceleration times w.
    accel: [f64; 3],
    /// Signs of speed and acceleration.
    sign: f64,
    accel_sign: f64,
}

impl Course {
    /// The course of a part of a phase on which no sign changes.
    pub fn new(part: &Phase) -> Self {
        let (v0, v1, a, t) = (
            part.velocity_mm_s,
            part.end_velocity_mm_s,
            part.accel_mm_s2,
            part.duration_s,
        );
        let sign_of = |x: f64| if x == 0.0 { 0.0 } else { x.signum() };
        let over_speed = |accel: [f64; 3], weighted: bool| Self {
            variable: Variable::Speed { accel, weighted },
            from: v0.min(v1),
            to: v0.max(v1),
            speed: if weighted {
                [0.0, 0.0, 1.0]
            } else {
                [0.0, 1.0, 0.0]
            },
            accel,
            sign: sign_of(v0 + v1),
            accel_sign: sign_of(a),
        };
        let over_time = |j: f64| Self {
            variable: Variable::Time(t),
            from: 0.0,
            to: 1.0,
            speed: [v0, a * t, 0.5 * j * t * t],
            accel: [a, j * t, 0.0],
            sign: sign_of(v0 + v1 + 4.0 * part.state_at(0.5 * t).velocity_mm_s),
            accel_sign: sign_of(a + part.end_accel_mm_s2()),
        };
        match part.kind {
            PhaseKind::ConstantAcceleration => over_time(0.0),
            PhaseKind::ConstantJerk { jerk_mm_s3 } => over_time(jerk_mm_s3),
            PhaseKind::ConstantPower { power_mm2_s3: p } => over_speed([p, a - p / v0, 0.0], true),
            PhaseKind::ConstantSlope { slope_per_s: s } => over_speed([a - s * v0, s, 0.0], false),
        }
    }

    /// w as a polynomial.
    fn weight(&self) -> [f64; 3] {
        match self.variable {
            Variable::Speed { weighted: true, .. } => [0.0, 1.0, 0.0],
            _ => [1.0, 0.0, 0.0],
        }
    }

    /// w² at a point.
    fn square(&self, z: f64) -> f64 {
        match self.variable {
            Variable::Speed { weighted: true, .. } => z * z,
            _ => 1.0,
        }
    }
}

/// One axis: its coefficients, its course, and its signed SI motion by unit of
/// that course.
pub(super) struct Follower<'a> {
    pub axis: &'a AxisPower,
    pub course: Course,
    pub direction: f64,
}

/// Force and speed of one axis, both times w.
#[derive(Clone, Copy)]
struct Work {
    /// On the side that is asked for.
    force: [f64; 3],
    /// On the other one, where the force may be anything between them.
    other: Option<[f64; 3]>,
    speed: [f64; 3],
}

impl Follower<'_> {
    fn work(&self, side: Side) -> Work {
        let other = match side {
            Side::Motor => Some(Side::Regen),
            Side::Regen => Some(Side::Motor),
            Side::Nominal => None,
        };
        Work {
            force: self.force(side),
            other: other
                .filter(|_| self.axis.is_spread())
                .map(|other| self.force(other)),
            speed: self.course.speed.map(|c| self.direction * c),
        }
    }

    /// `F·w`.
    fn force(&self, side: Side) -> [f64; 3] {
        let (axis, course, u) = (self.axis, &self.course, self.direction);
        let growing = course.sign * course.accel_sign > 0.0;
        let mass = axis.mass * axis.accel_factor(side, growing) * u;
        let friction = axis.friction_factor(side);
        let constant = axis.coulomb * friction * sign(u * course.sign) + axis.gravity;
        let viscous = axis.viscous * friction * u;
        let weight = course.weight();
        std::array::from_fn(|i| {
            mass * course.accel[i] + viscous * course.speed[i] + constant * weight[i]
        })
    }
}

/// `x·a + y·b`.
fn sum([x, y]: [f64; 2], a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| x * a[i] + y * b[i])
}

impl Work {
    /// The functions at whose roots the law of the power changes.
    fn changes(&self, axis: &AxisPower, side: Side) -> ArrayVec<Polynomial, 7> {
        let (eta, r) = (axis.efficiency, axis.copper);
        let quadratic = |[a, b, c]: [f64; 3]| Polynomial([a, b, c, 0.0, 0.0]);
        let mut changes = ArrayVec::new();
        for force in [Some(self.force), self.other].into_iter().flatten() {
            changes.push(quadratic(force));
            if r > 0.0 {
                changes.push(quadratic(sum([eta, r], self.speed, force)));
            }
        }
        let Some(other) = self.other else {
            return changes;
        };
        if side == Side::Motor {
            // Both draw the same: braking both, or one of them.
            let both = sum([1.0, 1.0], self.force, other);
            changes.push(quadratic(sum([eta, r], self.speed, both)));
            let apart = sum([1.0, -1.0], self.force, other);
            let converted = sum([axis.inverse_efficiency, -eta], self.force, other);
            let mut same = Polynomial::product(self.speed, converted);
            same.add(r, &Polynomial::product(both, apart));
            changes.push(same);
        } else {
            changes.push(quadratic(sum([eta, 2.0 * r], self.speed, self.force)));
            changes.push(quadratic(sum([eta, 2.0 * r], self.speed, other)));
        }
        changes
    }

    /// The force that counts between two changes, times w; `z` lies there. On the motor
    /// side it is that of both which draws more, on the regenerative side the one between
    /// them that feeds most back.
    fn counted(&self, axis: &AxisPower, side: Side, z: f64) -> [f64; 3] {
        let Some(other) = self.other else {
            return self.force;
        };
        let at = |[a, b, c]: [f64; 3]| a + z * (b + z * c);
        let v = at(self.speed);
        let forces = [self.force, other].map(at);
        if side == Side::Motor {
            let [own, others] = forces.map(|force| axis.electrical(v, force));
            return if others > own { other } else { self.force };
        }
        let best_by_speed = -0.5 * axis.efficiency / axis.copper;
        let [own, others] = forces.map(|force| best_by_speed * v - force);
        if own * others < 0.0 {
            self.speed.map(|c| best_by_speed * c)
        } else if others.abs() < own.abs() {
            other
        } else {
            self.force
        }
    }

    /// The electrical power times w² between two changes; `z` lies there.
    fn electrical(&self, axis: &AxisPower, side: Side, z: f64) -> Polynomial {
        let force = self.counted(axis, side, z);
        let mechanical = Polynomial::product(self.speed, force);
        let conversion = if mechanical.value(z) > 0.0 {
            axis.inverse_efficiency
        } else {
            axis.efficiency
        };
        let mut electrical = Polynomial::ZERO;
        electrical.add(axis.copper, &Polynomial::product(force, force));
        electrical.add(conversion, &mechanical);
        electrical
    }
}

fn sign(x: f64) -> f64 {
    if x == 0.0 { 0.0 } else { x.signum() }
}

/// All axes of a converter over one stretch; all have the same variable.
pub(super) struct Stretch<'a> {
    /// Whether fed-back power feeds the other axes.
    pub credit_regen: bool,
    /// What is drawn besides the axes, W.
    pub idle_w: f64,
    pub axes: &'a [Follower<'a>],
}

impl Stretch<'_> {
    /// Raises the peaks and adds the energy. `Totals` must hold the idle
    /// energy already.
    pub fn evaluate(&self, want: Want, totals: &mut Totals) {
        let Some(course) = self.axes.first().map(|follower| follower.course) else {
            return;
        };
        self.pieces(Side::Motor, 1.0, |power, from, to| {
            totals.raise_peak(self.idle_w + largest(&course, power, from, to));
        });
        let credit_w = if self.credit_regen { self.idle_w } else { 0.0 };
        self.pieces(Side::Regen, -1.0, |power, from, to| {
            totals.raise_regen(largest(&course, power, from, to) - credit_w);
        });
        if want.energy {
            self.pieces(Side::Nominal, 1.0, |power, from, to| {
                totals.energy_j += energy_j(&course, power, from, to);
            });
        }
    }

    /// Visits the pieces on which the power is one polynomial: that which is
    /// drawn, or, with the direction −1, fed back.
    pub fn pieces(&self, side: Side, direction: f64, mut visit: impl FnMut(&Polynomial, f64, f64)) {
        let Some(course) = self.axes.first().map(|follower| &follower.course) else {
            return;
        };
        let works: ArrayVec<(&AxisPower, Work), AXES> = self
            .axes
            .iter()
            .take(AXES)
            .map(|follower| (follower.axis, follower.work(side)))
            .collect();
        let mut ends = ArrayVec::<f64, { CHANGES + 1 }>::new();
        for (axis, work) in &works {
            for change in work.changes(axis, side) {
                ends.extend(change.roots(course.from, course.to).into_iter().take(4));
            }
        }
        ends.push(course.to);
        ends.sort_unstable_by(f64::total_cmp);
        let mut from = course.from;
        for to in ends {
            let middle = 0.5 * (from + to);
            let mut sum = Polynomial::ZERO;
            for (axis, work) in &works {
                let electrical = work.electrical(axis, side, middle);
                if self.credit_regen || direction * electrical.value(middle) > 0.0 {
                    sum.add(direction, &electrical);
                }
            }
            visit(&sum, from, to);
            from = to;
        }
    }
}

/// Largest value of `power/w²` between two points.
fn largest(course: &Course, power: &Polynomial, from: f64, to: f64) -> f64 {
    let value = |z: f64| power.value(z) / course.square(z);
    let derivative = power.derivative();
    let numerator = match course.variable {
        // z·N′ − 2·N
        Variable::Speed { weighted: true, .. } => {
            let [a, b, c, d, e] = power.0;
            Polynomial([-2.0 * a, -b, 0.0 * c, d, 2.0 * e])
        }
        _ => derivative,
    };
    let ends = larger(value(from), value(to));
    let inside = numerator.roots(from, to).into_iter().map(value);
    inside.fold(ends, larger)
}

/// Energy between two points, J.
fn energy_j(course: &Course, power: &Polynomial, from: f64, to: f64) -> f64 {
    match course.variable {
        Variable::Time(duration_s) => duration_s * power.integral(from, to),
        Variable::Speed { accel, .. } => {
            if to <= from {
                return 0.0;
            }
            // dt = dv/a, from the lower to the higher speed whichever comes
            // first.
            let [a, b, c] = accel;
            let time_by_speed = |z: f64| course.square(z).sqrt() / (a + z * (b + z * c)).abs();
            integral(
                |z| power.value(z) / course.square(z) * time_by_speed(z),
                from,
                to,
            )
        }
    }
}
