//! One axis: from speed and acceleration to electrical power, SI.
//!
//! Input: an [`Axis`] of the machine. Output: [`AxisPower`], whose formulas are
//!
//! ```text
//! F  = m·a + b·v + Fc·sign(v) + Fg        force (or torque)
//! p  = v·F                                mechanical power
//! el = p/η where p > 0, else p·η; + R·F²  electrical power
//! ```
//!
//! At rest an axis holds its weight: `F = Fg`, `el = R·Fg²`.
//!
//! With servo factors, warm friction and errors of mass and friction the force lies
//! anywhere between that of the motor side (heavier while speed grows, lighter while it
//! falls, the most friction) and that of the regenerative side (the other way round). `el` is convex in F: it is largest at
//! one of them, and least at `F = −η·v/(2·R)` or at what is next to it.

use gwatt_machine::Axis;

/// Which reading of the model is meant: what the command says, or its least
/// favourable outcome.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Side {
    /// The command itself: for energy.
    Nominal,
    /// Motoring peaks: acceleration exceeds the command while speed grows.
    Motor,
    /// Regenerative peaks: braking exceeds the command, friction is warm.
    Regen,
}

/// The coefficients of one axis, SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct AxisPower {
    /// Metres per mm, or radians per degree.
    pub si_per_unit: f64,
    /// Mass m in kg, or inertia.
    pub mass: f64,
    /// Viscous friction b.
    pub viscous: f64,
    /// Coulomb friction Fc.
    pub coulomb: f64,
    /// Weight Fg.
    pub gravity: f64,
    /// Efficiency η.
    pub efficiency: f64,
    /// 1/η.
    pub inverse_efficiency: f64,
    /// Copper loss R.
    pub copper: f64,
    /// Factors of acceleration while speed grows: nominal, motor, regen.
    growing: [f64; 3],
    /// Factors of acceleration while braking.
    braking: [f64; 3],
    /// Factors of friction.
    friction: [f64; 3],
    /// Copper loss meets factors: which force draws most depends on the speed.
    spread: bool,
}

/// Electrical power of an axis in W at a speed (m/s or rad/s) and a force of its
/// drive (N or N·m), by the nominal model; negative where it feeds back.
#[must_use]
pub fn electrical_w(axis: &Axis, speed_m_s: f64, force_n: f64) -> f64 {
    AxisPower::new(axis).electrical(speed_m_s, force_n)
}

impl AxisPower {
    /// An axis that does not exist.
    pub const ABSENT: Self = Self {
        si_per_unit: 0.0,
        mass: 0.0,
        viscous: 0.0,
        coulomb: 0.0,
        gravity: 0.0,
        efficiency: 1.0,
        inverse_efficiency: 1.0,
        copper: 0.0,
        growing: [1.0; 3],
        braking: [1.0; 3],
        friction: [1.0; 3],
        spread: false,
    };

    /// Takes over the data of an axis.
    pub fn new(axis: &Axis) -> Self {
        let [light, heavy] = [1.0 - axis.mass_error, 1.0 + axis.mass_error];
        let [loose, stiff] = [1.0 - axis.friction_error, 1.0 + axis.friction_error];
        let mut own = Self {
            si_per_unit: axis.si_per_unit,
            mass: axis.mass_kg,
            viscous: axis.viscous_n_s_m,
            coulomb: axis.coulomb_n,
            gravity: axis.gravity_n,
            efficiency: axis.efficiency,
            inverse_efficiency: 1.0 / axis.efficiency,
            copper: axis.copper_w_n2,
            growing: [1.0, axis.servo_factor_motor * heavy, light],
            braking: [1.0, light, axis.servo_factor_regen * heavy],
            friction: [1.0, stiff, axis.friction_min_ratio * loose],
            spread: false,
        };
        own.spread = own.copper != 0.0 && own.has_factors();
        own
    }

    /// True where the force that draws or feeds back most is not that of one side.
    #[inline]
    pub fn is_spread(&self) -> bool {
        self.spread
    }

    /// The largest factor of acceleration.
    pub fn largest_factor(&self) -> f64 {
        let all = self.growing.into_iter().chain(self.braking);
        all.fold(1.0, f64::max)
    }

    /// True when power is not linear in speed.
    pub fn is_curved(&self) -> bool {
        self.viscous != 0.0 || self.copper != 0.0
    }

    /// True when the peaks are not those of the command.
    pub fn has_factors(&self) -> bool {
        [self.growing, self.braking, self.friction] != [[1.0; 3]; 3]
    }

    /// Factor by which acceleration exceeds the command.
    #[inline]
    pub fn accel_factor(&self, side: Side, growing: bool) -> f64 {
        if growing {
            self.growing[side as usize]
        } else {
            self.braking[side as usize]
        }
    }

    /// The most Coulomb friction.
    #[inline]
    pub fn coulomb_most(&self) -> f64 {
        self.coulomb * self.friction_factor(Side::Motor)
    }

    /// The most viscous friction.
    #[inline]
    pub fn viscous_most(&self) -> f64 {
        self.viscous * self.friction_factor(Side::Motor)
    }

    /// Factor of friction.
    #[inline]
    pub fn friction_factor(&self, side: Side) -> f64 {
        self.friction[side as usize]
    }

    /// Electrical power without copper loss of mechanical power `p`.
    #[inline]
    pub fn converted(&self, p: f64) -> f64 {
        if p > 0.0 {
            p * self.inverse_efficiency
        } else {
            p * self.efficiency
        }
    }

    /// Electrical power at speed `v` and force `f`.
    #[inline]
    pub fn electrical(&self, v: f64, f: f64) -> f64 {
        self.converted(v * f) + self.copper * f * f
    }

    /// Force at a speed `v` and an acceleration `a`, moving in the direction of `sign`
    /// (0 at rest).
    #[inline]
    pub fn force(&self, side: Side, v: f64, a: f64, sign: f64) -> f64 {
        let inertia = self.mass * a * self.accel_factor(side, a * sign > 0.0);
        let drag = (self.coulomb * sign + self.viscous * v) * self.friction_factor(side);
        inertia + drag + self.gravity
    }

    /// Electrical power in the same state: the largest that may be drawn (motor side),
    /// the least (regenerative side), or that of the command.
    #[inline]
    pub fn power(&self, side: Side, v: f64, a: f64, sign: f64) -> f64 {
        let own = self.force(side, v, a, sign);
        match side {
            Side::Motor if self.spread => self.most(v, [own, self.force(Side::Regen, v, a, sign)]),
            Side::Regen if self.spread => self.least(v, [own, self.force(Side::Motor, v, a, sign)]),
            _ => self.electrical(v, own),
        }
    }

    /// The largest electrical power at a speed and any force between two.
    pub fn most(&self, v: f64, forces: [f64; 2]) -> f64 {
        let [a, b] = forces.map(|force| self.electrical(v, force));
        a.max(b)
    }

    /// The least electrical power at a speed and any force between two.
    pub fn least(&self, v: f64, [a, b]: [f64; 2]) -> f64 {
        if self.copper == 0.0 {
            return self.electrical(v, a).min(self.electrical(v, b));
        }
        let best = -0.5 * self.efficiency * v / self.copper;
        self.electrical(v, best.max(a.min(b)).min(a.max(b)))
    }

    /// Power lost while holding the weight, W.
    #[inline]
    pub fn holding_w(&self) -> f64 {
        self.copper * self.gravity * self.gravity
    }
}
