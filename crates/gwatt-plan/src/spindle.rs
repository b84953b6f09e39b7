//! What a machine's spindle can do: acceleration and jerk over speed, in 1/min
//! and s.
//!
//! With a time to the largest speed, the acceleration is the one whose curve
//! takes exactly that time: constant up to the base speed, `A·V_f/v` above it,
//! with the jerk `A/jerk_time_s`. Without jerk that is
//! `T = V_f/A + (V_max² − V_f²)/(2·A·V_f)`. With a torque curve it is
//! `(T(v) − C)/M` driving and `(T(v) + C)/M` braking. A largest electrical
//! power P leaves `(η·(P − P_0)/v − C)/M`; what is fed back is `η` of the
//! mechanical power, so it leaves `(P/(η·v) + C)/M`.

use super::period::{Curve, Jerk, LimitError, Limits, Motion, Ramp};
use gwatt_machine::Spindle;
use gwatt_machine::units::RAD_S_PER_RPM;

/// Halvings and doublings of the search for the acceleration.
const STEPS: u32 = 200;

/// Limits beyond the spindle's own.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SpindleCaps {
    /// Largest acceleration in 1/min per s.
    pub accel_rpm_s: Option<f64>,
    /// Largest jerk in 1/min per s².
    pub jerk_rpm_s2: Option<f64>,
    /// Largest electrical power drawn, in W, base load included.
    pub power_w: Option<f64>,
}

/// A spindle's limits of motion.
#[derive(Debug, Clone, PartialEq)]
pub struct SpindleDrive {
    limits: Limits,
    inertia: f64,
    friction_nm: f64,
    efficiency: f64,
    base_load_w: f64,
    max_rpm: f64,
}

impl SpindleDrive {
    /// Works out the limits of `spindle`.
    ///
    /// # Errors
    /// Numbers that are too large or too small to compute with.
    pub fn new(spindle: &Spindle) -> Result<Self, LimitError> {
        // Torque in N·m over this is acceleration in 1/min per s.
        let inertia = spindle.inertia_kg_m2 * RAD_S_PER_RPM;
        let limits = match spindle.accel_time_s {
            Some(time_s) => from_time(spindle, time_s)?,
            None => from_torque(spindle, inertia)?,
        };
        let mut drive = Self {
            limits,
            inertia,
            friction_nm: spindle.friction_nm,
            efficiency: spindle.efficiency,
            base_load_w: spindle.base_load_w,
            max_rpm: spindle.max_rpm,
        };
        if let Some(power_w) = spindle.peak_power_w {
            drive.limits.drive = drive.within_power(&drive.limits.drive, power_w)?;
        }
        if let Some(power_w) = spindle.regen_power_w {
            let power = power_w / drive.efficiency / RAD_S_PER_RPM;
            let brake = &drive.limits.brake;
            drive.limits.brake = brake.limited_by_power(power, -drive.friction_nm, inertia)?;
        }
        Ok(drive)
    }

    /// The spindle's own limits.
    #[must_use]
    pub fn limits(&self) -> &Limits {
        &self.limits
    }

    /// The largest speed in 1/min.
    #[must_use]
    pub fn max_rpm(&self) -> f64 {
        self.max_rpm
    }

    /// The electrical power in W that holds a speed in 1/min.
    #[must_use]
    pub fn holding_w(&self, rpm: f64) -> f64 {
        let friction_w = self.friction_nm * rpm.abs() * RAD_S_PER_RPM;
        self.base_load_w + friction_w / self.efficiency
    }

    /// The limits under further caps.
    ///
    /// # Errors
    /// A cap is not positive, or the power does not even cover the base load.
    pub fn capped(&self, caps: &SpindleCaps) -> Result<Limits, LimitError> {
        let mut limits = self.limits.clone();
        if let Some(accel) = caps.accel_rpm_s {
            let cap = Curve::constant(accel)?;
            limits.drive = limits.drive.lowest(&cap);
            limits.brake = limits.brake.lowest(&cap);
        }
        if let Some(jerk) = caps.jerk_rpm_s2 {
            limits.jerk = limits.jerk.lowest(&Jerk::constant(jerk)?);
        }
        if let Some(power_w) = caps.power_w {
            limits.drive = self.within_power(&limits.drive, power_w)?;
        }
        Ok(limits)
    }

    /// The jerk in 1/min per s² that the acceleration limit asks for where it
    /// falls, if the drive has not got it: the acceleration stays below then.
    #[must_use]
    pub fn missing_jerk(&self) -> Option<f64> {
        let needed = self.limits.drive.jerk_to_follow(self.max_rpm);
        (needed > self.limits.jerk.smallest()).then_some(needed)
    }

    fn within_power(&self, curve: &Curve, power_w: f64) -> Result<Curve, LimitError> {
        let power = self.efficiency * (power_w - self.base_load_w) / RAD_S_PER_RPM;
        curve.limited_by_power(power, self.friction_nm, self.inertia)
    }
}

fn from_torque(spindle: &Spindle, inertia: f64) -> Result<Limits, LimitError> {
    let curve = spindle.torque_curve.iter();
    let points: Vec<(f64, f64)> = curve.map(|point| (point.rpm, point.torque_nm)).collect();
    let drive = Curve::torque(&points, spindle.friction_nm, inertia)?;
    let jerk = drive.at(0.0) / spindle.jerk_time_s;
    Ok(Limits {
        drive,
        brake: Curve::torque(&points, -spindle.friction_nm, inertia)?,
        jerk: Jerk::constant(jerk)?,
    })
}

fn from_time(spindle: &Spindle, time_s: f64) -> Result<Limits, LimitError> {
    let max = spindle.max_rpm;
    let with = |accel: f64| {
        let jerk = accel / spindle.jerk_time_s;
        if spindle.base_rpm > 0.0 && spindle.base_rpm < max {
            Limits::constant_power(accel, spindle.base_rpm, jerk)
        } else {
            Limits::constant(accel, jerk)
        }
    };
    let too_slow = |limits: &Limits| {
        let ramp = Ramp::new(Motion::default(), max, limits);
        ramp.duration_s() > time_s
    };
    // No acceleration below the mean one takes so little time.
    let mut low = max / time_s;
    let mut high = low;
    for _ in 0..STEPS {
        if !too_slow(&with(high)?) {
            break;
        }
        low = high;
        high *= 2.0;
    }
    for _ in 0..STEPS {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if too_slow(&with(middle)?) {
            low = middle;
        } else {
            high = middle;
        }
    }
    with(high)
}
