//! Demand of a straight path on which all axes start and arrive together.
//!
//! Input: a move and its profile. Output: the [`Totals`] of one converter.
//!
//! With direction `u` every axis has `v_n = u_n·v` and `a_n = u_n·a`, so
//!
//! ```text
//! p_n = v·c_n,   c_n = m_n·u_n²·a + Fc_n·|u_n| + Fg_n·u_n
//! ```
//!
//! and without viscous friction and copper loss `c_n` is constant in a phase:
//! power is linear in v, its extremes are at the ends of the phases and the
//! energy is `c_n` times the length of the phase. Otherwise the phases go to
//! [`interval`](super::interval), and those whose acceleration changes to
//! [`stretch`](super::stretch).

use super::axis::{AxisPower, Side};
use super::axis_bound::axis_bound_w;
use super::demand::{Totals, Want};
use super::interval::{Interval, Ramp};
use super::model::{ConverterPower, PowerModel};
use super::stretch::{Course, Follower, Stretch};
use arrayvec::ArrayVec;
use gwatt_machine::{AXES, AxisSet};
use gwatt_motion::Move;
use gwatt_plan::{Phase, PhaseKind, Profile};

/// One axis that moves: its coefficients per unit of path.
struct Share<'a> {
    axis: &'a AxisPower,
    /// Signed SI motion of the axis per mm of path, `u`.
    direction: f64,
    /// `m·u²`.
    mass: f64,
    /// `Fc·|u|`.
    friction: f64,
    /// `Fg·u`.
    gravity: f64,
}

/// The converter's share of a move that follows a straight path.
pub(super) fn totals(
    model: &PowerModel,
    converter: &ConverterPower,
    mv: &Move,
    profile: &Profile,
    idle_w: f64,
    want: Want,
) -> Totals {
    let active = AxisSet(mv.moving.0 & converter.axes.0);
    if let ([up, .., down], false, true) = (
        profile.phases.as_slice(),
        want.energy,
        active.0 & converter.curved.0 == 0,
    ) && profile.phases.iter().all(is_steady)
        && up.end_velocity_mm_s == down.velocity_mm_s
        && (up.velocity_mm_s, down.end_velocity_mm_s) == (0.0, 0.0)
    {
        return ramp_peaks(model, converter, mv, active, [up, down], idle_w);
    }
    let mut totals = Totals::at_rest(idle_w, profile.duration_s(), want);
    let mut shares = ArrayVec::<Share<'_>, AXES>::new();
    let per_length = 1.0 / mv.length_mm;
    for axis in active.iter() {
        let power = &model.axes[axis];
        let direction = (mv.end[axis] - mv.start[axis]) * power.si_per_unit * per_length;
        shares.push(Share {
            axis: power,
            direction,
            mass: power.mass * direction * direction,
            friction: power.coulomb * direction.abs(),
            gravity: power.gravity * direction,
        });
    }
    let factored = active.0 & converter.factored.0 != 0;
    let curved = active.0 & converter.curved.0 != 0;
    for phase in &profile.phases {
        if !is_steady(phase) {
            for part in phase.parts() {
                changing_phase(converter, &shares, &part, want, &mut totals);
            }
        } else if curved {
            let ramps: ArrayVec<Ramp<'_>, AXES> = shares
                .iter()
                .map(|share| Ramp {
                    axis: share.axis,
                    start: share.direction * phase.velocity_mm_s,
                    end: share.direction * phase.end_velocity_mm_s,
                    accel: share.direction * phase.accel_mm_s2,
                })
                .collect();
            Interval {
                credit_regen: converter.credit_regen,
                curved: true,
                idle_w,
                ramps: &ramps,
                duration_s: phase.duration_s,
            }
            .evaluate(want, &mut totals);
        } else {
            linear_phase(converter, &shares, phase, factored, want, &mut totals);
        }
    }
    totals
}

/// Upper bounds of what a straight path draws and feeds back, W, at a speed of at
/// most `v` (mm/s) and accelerations of size `a` (mm/s²) at most.
///
/// Closer than the [`ceiling`](super::ceiling), since it knows the direction:
/// each axis draws most at `v` while it speeds up, and feeds back most at `v`
/// while it brakes.
pub(super) fn bound_w(
    model: &PowerModel,
    converter: &ConverterPower,
    mv: &Move,
    [v, a]: [f64; 2],
    idle_w: f64,
) -> [f64; 2] {
    let (mut drawn_w, mut fed_back_w) = (idle_w, 0.0);
    for axis in AxisSet(mv.moving.0 & converter.axes.0).iter() {
        let [drawn, fed_back] = axis_bound_w(&model.axes[axis], axis, mv, [v, a]);
        drawn_w += drawn;
        fed_back_w += fed_back;
    }
    [drawn_w, fed_back_w]
}

/// Whether a phase has one acceleration.
#[inline]
fn is_steady(phase: &Phase) -> bool {
    phase.kind == PhaseKind::ConstantAcceleration
}

/// A part of a phase whose acceleration changes.
fn changing_phase(
    converter: &ConverterPower,
    shares: &[Share<'_>],
    part: &Phase,
    want: Want,
    totals: &mut Totals,
) {
    let course = Course::new(part);
    let axes: ArrayVec<Follower<'_>, AXES> = shares
        .iter()
        .map(|share| Follower {
            axis: share.axis,
            course,
            direction: share.direction,
        })
        .collect();
    Stretch {
        credit_regen: converter.credit_regen,
        idle_w: totals.idle_w,
        axes: &axes,
    }
    .evaluate(want, totals);
}

/// Peaks of a trapezoid or triangle in which power is linear in speed.
///
/// The power of each axis grows with acceleration, so the largest power is
/// drawn at the end of the ramp up, and the most is fed back at the beginning
/// of the ramp down; a cruise lies between.
#[inline]
fn ramp_peaks(
    model: &PowerModel,
    converter: &ConverterPower,
    mv: &Move,
    active: AxisSet,
    [up, down]: [&Phase; 2],
    idle_w: f64,
) -> Totals {
    let per_length = 1.0 / mv.length_mm;
    let mut totals = Totals::new(idle_w);
    let (mut drawn, mut fed_back) = (0.0, 0.0);
    for axis in active.iter() {
        let power = &model.axes[axis];
        let direction = (mv.end[axis] - mv.start[axis]) * power.si_per_unit * per_length;
        let mass = power.mass * direction * direction;
        let friction = power.coulomb * direction.abs();
        let gravity = power.gravity * direction;
        let electrical = |accel: f64, side: Side, growing: bool| {
            let inertia = mass * accel * power.accel_factor(side, growing);
            power.converted(inertia + friction * power.friction_factor(side) + gravity)
        };
        let growing = electrical(up.accel_mm_s2, Side::Motor, true);
        let braking = electrical(down.accel_mm_s2, Side::Regen, false);
        if converter.credit_regen {
            drawn += growing;
            fed_back -= braking;
        } else {
            drawn += growing.max(0.0);
            fed_back += (-braking).max(0.0);
        }
    }
    let v = up.end_velocity_mm_s;
    let credit_w = if converter.credit_regen { idle_w } else { 0.0 };
    totals.raise_peak(idle_w + v * drawn);
    totals.raise_regen(v * fed_back - credit_w);
    totals
}

/// Sums over the axes per unit of speed: what is drawn and what is fed back.
#[derive(Clone, Copy)]
struct Slope {
    motoring: f64,
    regenerating: f64,
}

/// A phase in which power is linear in speed.
#[inline]
fn linear_phase(
    converter: &ConverterPower,
    shares: &[Share<'_>],
    phase: &Phase,
    factored: bool,
    want: Want,
    totals: &mut Totals,
) {
    let slope_of = |side| slope(shares, phase.accel_mm_s2, side);
    let nominal = slope_of(Side::Nominal);
    let (motor, regen) = if factored {
        (slope_of(Side::Motor), slope_of(Side::Regen))
    } else {
        (nominal, nominal)
    };
    let idle_w = totals.idle_w;
    let (v0, v1) = (phase.velocity_mm_s, phase.end_velocity_mm_s);
    if converter.credit_regen {
        for v in [v0, v1] {
            totals.raise_peak(idle_w + v * (motor.motoring - motor.regenerating));
            totals.raise_regen(v * (regen.regenerating - regen.motoring) - idle_w);
        }
    } else {
        let v = v0.max(v1);
        totals.raise_peak(idle_w + v * motor.motoring);
        totals.raise_regen(v * regen.regenerating);
    }
    if want.energy {
        let credited = if converter.credit_regen {
            nominal.regenerating
        } else {
            0.0
        };
        totals.energy_j += phase.length_mm() * (nominal.motoring - credited);
    }
}

/// The sums at path acceleration `a` (mm/s²).
#[inline]
fn slope(shares: &[Share<'_>], a: f64, side: Side) -> Slope {
    let mut slope = Slope {
        motoring: 0.0,
        regenerating: 0.0,
    };
    for share in shares {
        let a = a * share.axis.accel_factor(side, a > 0.0);
        let friction = share.friction * share.axis.friction_factor(side);
        let p = share.mass * a + friction + share.gravity;
        let electrical = share.axis.converted(p);
        slope.motoring += electrical.max(0.0);
        slope.regenerating += (-electrical).max(0.0);
    }
    slope
}
