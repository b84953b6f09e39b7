//! The spindle: what a change of its speed draws and feeds back.
//!
//! ```text
//! T  = M·dω/dt + C·sign(ω)                torque
//! p  = ω·T                                mechanical power
//! el = P_0 + p/η where p > 0, else P_0 + p·η
//! ```
//!
//! Extremes are exact: at constant jerk p is a cubic, along a limit of the
//! acceleration a parabola over the speed. The energy is that of the change of
//! speed and of the friction over the angle, each part with its efficiency.

use arrayvec::ArrayVec;

use gwatt_machine::Spindle;
use gwatt_machine::units::RAD_S_PER_RPM;
use gwatt_plan::SpindleDrive;
use gwatt_plan::period::{LimitError, Motion, Ramp, RampPhase};

/// Instants of one phase between which power has one law and no extreme.
type Instants = ArrayVec<f64, 12>;

/// Coefficients of a spindle; speeds in 1/min.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpindlePower {
    /// Power by speed and acceleration, in W/(1/min · 1/min/s).
    inertia: f64,
    /// Power of friction by speed, in W/(1/min).
    friction: f64,
    efficiency: f64,
    base_load_w: f64,
}

/// A phase of a run from one speed to another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RunPhase {
    /// When it begins, in s from the start of the run.
    pub start_s: f64,
    /// How long it lasts in s.
    pub duration_s: f64,
    /// Speed in 1/min and acceleration in 1/min per s where it begins.
    pub start: Motion,
    /// The same where it ends.
    pub end: Motion,
    /// Largest electrical power in W.
    pub peak_w: f64,
    /// Smallest electrical power in W; negative where it is fed back.
    pub least_w: f64,
    /// Electrical energy in J, what is fed back taken off.
    pub energy_j: f64,
    /// Electrical energy drawn in J, what is fed back left aside; base load not
    /// counted.
    pub drawn_j: f64,
}

/// A run-up or a braking between two speeds.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SpindleRun {
    /// Its phases in order of time.
    pub phases: Vec<RunPhase>,
    /// How long it lasts in s.
    pub duration_s: f64,
    /// Largest electrical power drawn, in W.
    pub peak_w: f64,
    /// Largest electrical power fed back, in W; positive.
    pub regen_w: f64,
    /// Electrical energy in J, what is fed back taken off.
    pub energy_j: f64,
}

/// The run of a machine's spindle between two speeds in 1/min, signed by the
/// direction of rotation, from steady to steady.
///
/// # Errors
/// Numbers that are too large or too small to compute with.
pub fn spindle_run(
    spindle: &Spindle,
    from_rpm: f64,
    to_rpm: f64,
) -> Result<SpindleRun, LimitError> {
    let drive = SpindleDrive::new(spindle)?;
    let start = Motion {
        speed: from_rpm,
        accel: 0.0,
    };
    let ramp = Ramp::new(start, to_rpm, drive.limits());
    Ok(SpindlePower::new(spindle).run(&ramp))
}

impl SpindlePower {
    /// Takes over the data of a spindle.
    #[must_use]
    pub fn new(spindle: &Spindle) -> Self {
        Self {
            inertia: spindle.inertia_kg_m2 * RAD_S_PER_RPM * RAD_S_PER_RPM,
            friction: spindle.friction_nm * RAD_S_PER_RPM,
            efficiency: spindle.efficiency,
            base_load_w: spindle.base_load_w,
        }
    }

    /// Torque of the motor in N·m at a speed in 1/min and an acceleration in
    /// 1/min per s. At rest, friction is that of the motion that begins.
    #[must_use]
    pub fn torque_nm(&self, motion: Motion) -> f64 {
        let Motion { speed, accel } = motion;
        self.torque_turning_nm(accel, if speed == 0.0 { accel } else { speed })
    }

    /// The same where it turns in the direction of a speed.
    pub(super) fn torque_turning_nm(&self, accel: f64, turns: f64) -> f64 {
        let side = if turns == 0.0 { 0.0 } else { turns.signum() };
        (self.inertia * accel + self.friction * side) / RAD_S_PER_RPM
    }

    /// Electrical power in W.
    #[must_use]
    pub fn electrical_w(&self, motion: Motion) -> f64 {
        self.base_load_w + self.turned_w(motion.speed, self.torque_nm(motion))
    }

    /// Electrical power at a speed in 1/min and a torque in N·m, without the base
    /// load, W.
    pub(super) fn turned_w(&self, speed: f64, torque_nm: f64) -> f64 {
        self.converted(speed * RAD_S_PER_RPM * torque_nm)
    }

    /// What a ramp in 1/min draws and feeds back, phase by phase.
    #[must_use]
    pub fn run(&self, ramp: &Ramp) -> SpindleRun {
        self.phases(&ramp.phases)
    }

    /// What phases of a ramp in 1/min draw and feed back.
    #[must_use]
    pub fn phases(&self, phases: &[RampPhase]) -> SpindleRun {
        let mut run = SpindleRun::default();
        for phase in phases {
            let phase = self.phase(phase, run.duration_s);
            run.duration_s += phase.duration_s;
            run.peak_w = run.peak_w.max(phase.peak_w);
            run.regen_w = run.regen_w.max(-phase.least_w);
            run.energy_j += phase.energy_j;
            run.phases.push(phase);
        }
        run
    }

    pub(super) fn phase(&self, phase: &RampPhase, start_s: f64) -> RunPhase {
        let instants = self.instants(phase);
        let first = self.electrical_w(phase.start);
        let mut found = RunPhase {
            start_s,
            duration_s: phase.duration_s,
            start: phase.start,
            end: phase.end,
            peak_w: first,
            least_w: first,
            energy_j: self.base_load_w * phase.duration_s,
            drawn_j: 0.0,
        };
        let mut from = (phase.start, 0.0);
        for &t in &instants {
            let to = (phase.at(t), phase.distance(t));
            let power = self.electrical_w(to.0);
            found.peak_w = found.peak_w.max(power);
            found.least_w = found.least_w.min(power);
            let squares = (to.0.speed - from.0.speed) * (to.0.speed + from.0.speed);
            let work = 0.5 * self.inertia * squares + self.friction * (to.1 - from.1).abs();
            let electrical = self.converted(work);
            found.energy_j += electrical;
            found.drawn_j += electrical.max(0.0);
            from = to;
        }
        found
    }

    /// The same without the base load.
    pub(super) fn motor(spindle: &Spindle) -> Self {
        Self {
            base_load_w: 0.0,
            ..Self::new(spindle)
        }
    }

    /// Power of inertia by speed and acceleration, W/(1/min · 1/min/s), and of
    /// friction by speed, W/(1/min).
    pub(super) fn coefficients(&self) -> [f64; 2] {
        [self.inertia, self.friction]
    }

    /// Electrical power of mechanical power `p`, W.
    pub(super) fn converted(&self, p: f64) -> f64 {
        if p > 0.0 {
            p / self.efficiency
        } else {
            p * self.efficiency
        }
    }

    /// Instants inside a phase at which the power has an extreme or changes its
    /// sign, and the phase's end, ascending.
    fn instants(&self, phase: &RampPhase) -> Instants {
        let (m, c) = (self.inertia, self.friction);
        let mut instants = Instants::new();
        let mut add = |t: f64| {
            if t > 0.0 && t < phase.duration_s {
                let _ = instants.try_push(t);
            }
        };
        let Motion { speed: v, accel: a } = phase.start;
        if let Some([h, k, s]) = phase.curve() {
            // Over the magnitude u of the speed p = ±M·(h + k·u + s·u²) + C·u,
            // + while it grows.
            let side = (v + phase.end.speed).signum();
            let grows = phase.end.speed.abs() > v.abs();
            let m = if grows { m } else { -m };
            let rest = m * k + c;
            let extreme = (s != 0.0).then(|| -rest / (2.0 * m * s));
            for u in roots(m * s, rest, m * h).into_iter().chain(extreme) {
                if let Some(t) = phase.time_at(side * u).filter(|_| u > 0.0) {
                    add(t);
                }
            }
        } else if let Some(j) = phase.jerk() {
            if j == 0.0 {
                // p is linear in the speed on either side of rest.
                if a != 0.0 {
                    add(-v / a);
                }
            } else {
                // v = v₀ + (a² − a₀²)/2j, so dp/dt = 0 is a parabola in a.
                let e = j * v - 0.5 * a * a;
                let at_rest = -2.0 * e;
                if at_rest >= 0.0 {
                    add((at_rest.sqrt() - a) / j);
                    add((-at_rest.sqrt() - a) / j);
                }
                for friction in [c, -c] {
                    add((-friction / m - a) / j);
                    for accel in roots(1.5 * m, friction, m * e) {
                        add((accel - a) / j);
                    }
                }
            }
        }
        instants.sort_by(f64::total_cmp);
        let _ = instants.try_push(phase.duration_s);
        instants
    }
}

/// Real roots of `a·x² + b·x + c`, at most two.
fn roots(a: f64, b: f64, c: f64) -> ArrayVec<f64, 2> {
    let mut found = ArrayVec::new();
    if a == 0.0 {
        if b != 0.0 {
            found.push(-c / b);
        }
        return found;
    }
    let discriminant = b * b - 4.0 * a * c;
    if discriminant >= 0.0 {
        // Without the difference of numbers that are nearly equal.
        let t = -0.5 * (b + discriminant.sqrt().copysign(b));
        found.push(t / a);
        if t != 0.0 {
            found.push(c / t);
        }
    }
    found
}
