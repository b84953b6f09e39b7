//! Demand of arcs and helices.
//!
//! Input: an arc and its profile. Output: the [`Totals`] of one converter.
//!
//! Each phase is cut where the path meets a quadrant of the circle: between
//! quadrants no axis changes its direction, and every axis' power is a maximum
//! of smooth functions of time, whose second derivatives `circle` bounds. The
//! peaks come from `search`, the energy from `quadrature`. Pieces are visited
//! from the fast end of the phase, so that the slow ones fall below what has
//! been found. A cruise repeats after one turn.

use super::axis::{AxisPower, Side};
use super::circle::{ArcAxis, Motion, Shape};
use super::demand::{Totals, Want};
use super::model::{ConverterPower, PowerModel};
use super::quadrature::integral;
use super::search::{Bounded, Search};
use crate::interpret::{Arc, Move};
use crate::machine::{AXES, AxisSet};
use crate::plan::{Phase, Profile};
use arrayvec::ArrayVec;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Pieces of a phase that are looked at one by one; beyond them bounds and
/// averages over a turn are used.
const PIECES: u32 = 1024;

/// The converter's share of an arc.
pub(super) fn totals(
    model: &PowerModel,
    converter: &ConverterPower,
    mv: &Move,
    arc: &Arc,
    profile: &Profile,
    idle_w: f64,
    want: Want,
) -> Totals {
    let circle = Circle::new(model, converter, mv, arc, idle_w);
    let mut totals = Totals::at_rest(idle_w, profile.duration_s(), want);
    let mut peak = Search::new(idle_w, want.floor_w);
    let mut regen = Search::new(0.0, 0.0);
    for phase in &profile.phases {
        circle.search(phase, Side::Motor, &mut peak);
    }
    // Braking feeds back most: last phases first.
    for phase in profile.phases.iter().rev() {
        circle.search(phase, Side::Regen, &mut regen);
    }
    totals.raise_peak(peak.upper());
    totals.raise_regen(regen.upper());
    if want.energy {
        for phase in &profile.phases {
            totals.energy_j += circle.energy(phase);
        }
    }
    totals
}

/// The axes of a converter on an arc.
struct Circle<'a> {
    axes: ArrayVec<ArcAxis<'a>, AXES>,
    credit_regen: bool,
    idle_w: f64,
    start_angle: f64,
    /// Sense of the sweep, ±1.
    sense: f64,
    /// Angle in rad per mm of path, positive.
    angle_per_mm: f64,
}

impl<'a> Circle<'a> {
    fn new(
        model: &'a PowerModel,
        converter: &ConverterPower,
        mv: &Move,
        arc: &Arc,
        idle_w: f64,
    ) -> Self {
        let active = AxisSet(mv.moving.0 & converter.axes.0);
        let axes = active.iter().map(|index| {
            let axis = &model.axes[index];
            let radius = arc.radius_mm * axis.si_per_unit;
            let shape = if index == arc.plane[0] {
                Shape::Cosine(radius)
            } else if index == arc.plane[1] {
                Shape::Sine(radius)
            } else {
                let distance = mv.end[index] - mv.start[index];
                Shape::Line(distance * axis.si_per_unit / mv.length_mm)
            };
            ArcAxis { axis, shape }
        });
        Self {
            axes: axes.collect(),
            credit_regen: converter.credit_regen,
            idle_w,
            start_angle: arc.start_angle_rad,
            sense: 1.0_f64.copysign(arc.sweep_rad),
            angle_per_mm: arc.sweep_rad.abs() / mv.length_mm,
        }
    }

    /// Motion `t` seconds into a phase.
    #[inline]
    fn motion(&self, phase: &Phase, t: f64) -> Motion {
        let state = phase.state_at(t);
        let angle = self.start_angle + self.sense * self.angle_per_mm * state.position_mm;
        let (sin, cos) = libm::sincos(angle);
        Motion {
            v: state.velocity_mm_s,
            a: state.accel_mm_s2,
            omega: state.velocity_mm_s * self.angle_per_mm,
            alpha: state.accel_mm_s2 * self.angle_per_mm,
            sin,
            cos,
            sense: self.sense,
        }
    }

    /// Finds the peak of one phase.
    fn search(&self, phase: &Phase, side: Side, search: &mut Search) {
        for (from, to, last) in Pieces::new(self, phase) {
            let fast = if phase.accel_mm_s2 > 0.0 { to } else { from };
            let fastest = self.motion(phase, fast);
            let envelope = self.envelope(&fastest, side);
            if search.covers(envelope) {
                return;
            }
            if last {
                search.take_in(envelope);
                return;
            }
            let piece = Piece::new(self, phase, side, (from, to), &fastest);
            search.run(&piece, from, to, envelope.abs());
        }
    }

    /// Upper bound of the power on one side at speeds up to those of `m`.
    fn envelope(&self, m: &Motion, side: Side) -> f64 {
        let sum = |which: usize| -> f64 {
            let factors = |axis: &AxisPower| {
                [
                    axis.accel_factor(Side::Motor, true),
                    axis.accel_factor(Side::Regen, false),
                ]
            };
            self.axes
                .iter()
                .map(|axis| axis.envelope(m, factors(axis.axis))[which])
                .sum()
        };
        match side {
            Side::Regen if self.credit_regen => sum(1) - self.idle_w,
            Side::Regen => sum(1),
            _ => self.idle_w + sum(0),
        }
    }

    /// Energy of the axes in one phase, J.
    fn energy(&self, phase: &Phase) -> f64 {
        let mut sum = 0.0;
        let turn_s = self.turn_s(phase);
        let turns = if phase.accel_mm_s2 == 0.0 && turn_s > 0.0 {
            (phase.duration_s / turn_s).floor()
        } else {
            0.0
        };
        let rest_s = phase.duration_s - turns * turn_s;
        for (from, to, last) in Pieces::new(self, phase) {
            if last {
                sum += integral(|t| self.turn_average(phase, t), from, to);
                break;
            }
            let mut add = |from: f64, to: f64, times: f64| {
                if to > from && times > 0.0 {
                    let signs = self.signs(phase, 0.5 * (from + to));
                    sum += times
                        * integral(|t| self.nominal(&signs, &self.motion(phase, t)), from, to);
                }
            };
            // Of a cruise the first turn is visited; what lies in the last,
            // broken turn counts once more.
            let split = if turns > 0.0 {
                rest_s.clamp(from, to)
            } else {
                to
            };
            add(from, split, turns + 1.0);
            add(split, to, turns);
        }
        sum
    }

    /// Time of one turn at the speed of a cruise; infinite if it does not turn.
    fn turn_s(&self, phase: &Phase) -> f64 {
        TAU / (phase.velocity_mm_s * self.angle_per_mm)
    }

    /// Direction of each axis at an instant at which none of them turns back.
    fn signs(&self, phase: &Phase, t: f64) -> [f64; AXES] {
        let motion = self.motion(phase, t);
        let mut signs = [0.0; AXES];
        for (sign, axis) in signs.iter_mut().zip(&self.axes) {
            let (speed, _) = axis.motion(&motion);
            *sign = if speed == 0.0 { 0.0 } else { speed.signum() };
        }
        signs
    }

    /// Power of the axes that counts towards the energy, W.
    fn nominal(&self, signs: &[f64; AXES], m: &Motion) -> f64 {
        let mut sum = 0.0;
        for (axis, sign) in self.axes.iter().zip(signs) {
            let (v, a) = axis.motion(m);
            let power = axis.axis;
            let force = power.mass * a + power.viscous * v + power.coulomb * sign + power.gravity;
            let electrical = power.electrical(v, force);
            sum += if self.credit_regen {
                electrical
            } else {
                electrical.max(0.0)
            };
        }
        sum
    }

    /// `nominal`, averaged over a turn at the speed of one instant.
    fn turn_average(&self, phase: &Phase, t: f64) -> f64 {
        const POINTS: u32 = 64;
        let mut motion = self.motion(phase, t);
        let mut sum = 0.0;
        for i in 0..POINTS {
            (motion.sin, motion.cos) = libm::sincos(TAU * (f64::from(i) + 0.5) / f64::from(POINTS));
            let mut signs = [0.0; AXES];
            for (sign, axis) in signs.iter_mut().zip(&self.axes) {
                *sign = axis.motion(&motion).0.signum();
            }
            sum += self.nominal(&signs, &motion);
        }
        sum / f64::from(POINTS)
    }
}

/// The pieces of a phase between quadrants, from its fast end; of a cruise,
/// the first turn. Yields start and end in s, and `true` where the rest of the
/// phase is given in one because there are too many.
struct Pieces<'a> {
    phase: &'a Phase,
    /// Angle since the start of the move at the instants left to visit.
    angle: f64,
    /// Angle from the start of the move to the first quadrant of the circle.
    offset: f64,
    angle_per_mm: f64,
    /// What is left to visit, s.
    from: f64,
    to: f64,
    count: u32,
}

impl<'a> Pieces<'a> {
    fn new(circle: &Circle<'_>, phase: &'a Phase) -> Self {
        let mut to = phase.duration_s;
        if phase.accel_mm_s2 == 0.0 {
            to = to.min(circle.turn_s(phase));
        }
        let backwards = phase.accel_mm_s2 > 0.0;
        let instant = if backwards { to } else { 0.0 };
        Self {
            phase,
            angle: circle.angle_per_mm * phase.state_at(instant).position_mm,
            offset: -circle.sense * circle.start_angle,
            angle_per_mm: circle.angle_per_mm,
            from: 0.0,
            to,
            count: 0,
        }
    }

    /// The instant at which the angle is reached, within what is left.
    fn instant(&self, angle: f64) -> f64 {
        let phase = self.phase;
        let (v, a) = (phase.velocity_mm_s, phase.accel_mm_s2);
        let distance = (angle / self.angle_per_mm - phase.position_mm).max(0.0);
        // distance = v·t + a·t²/2, without cancellation.
        let root = (v * v + 2.0 * a * distance).max(0.0).sqrt();
        let t = 2.0 * distance / (v + root);
        if t.is_nan() {
            self.from
        } else {
            t.clamp(self.from, self.to)
        }
    }
}

impl Iterator for Pieces<'_> {
    type Item = (f64, f64, bool);

    fn next(&mut self) -> Option<Self::Item> {
        let backwards = self.phase.accel_mm_s2 > 0.0;
        while self.from < self.to {
            self.count += 1;
            if self.count > PIECES {
                let rest = (self.from, self.to, true);
                self.from = self.to;
                return Some(rest);
            }
            let quadrant = (self.angle - self.offset) / FRAC_PI_2;
            let next = if backwards {
                (quadrant - 1e-9).ceil() - 1.0
            } else {
                (quadrant + 1e-9).floor() + 1.0
            };
            self.angle = next * FRAC_PI_2 + self.offset;
            let instant = self.instant(self.angle);
            let piece = if backwards {
                let piece = (instant, self.to, false);
                self.to = instant;
                piece
            } else {
                let piece = (self.from, instant, false);
                self.from = instant;
                piece
            };
            if piece.0 < piece.1 {
                return Some(piece);
            }
        }
        None
    }
}

/// One piece of a phase, seen from one side.
struct Piece<'a> {
    circle: &'a Circle<'a>,
    phase: &'a Phase,
    side: Side,
    signs: [f64; AXES],
    /// Bound of the second derivative of each axis' power, divided by 8.
    bend: [f64; AXES],
}

/// Power of each axis at one instant. Fed-back power that is credited is the
/// smaller of two smooth functions, any other power counts as the first.
#[derive(Clone)]
struct Sample {
    t: f64,
    value: f64,
    first: [f64; AXES],
    second: [f64; AXES],
}

impl<'a> Piece<'a> {
    fn new(
        circle: &'a Circle<'a>,
        phase: &'a Phase,
        side: Side,
        (from, to): (f64, f64),
        fastest: &Motion,
    ) -> Self {
        let mut bend = [0.0; AXES];
        for (bend, arc_axis) in bend.iter_mut().zip(&circle.axes) {
            let axis = arc_axis.axis;
            let factor = axis
                .accel_factor(side, true)
                .max(axis.accel_factor(side, false));
            let (mechanical, copper) = arc_axis.curvature(fastest, factor);
            let conversion = match side {
                Side::Regen if !circle.credit_regen => axis.efficiency,
                _ => axis.inverse_efficiency,
            };
            *bend = 0.125 * (mechanical * conversion + copper);
        }
        Self {
            circle,
            phase,
            side,
            signs: circle.signs(phase, 0.5 * (from + to)),
            bend,
        }
    }

    /// The largest of an axis' power over what its acceleration may be: the
    /// command, or the command exceeded. For fed-back power with both
    /// conversions.
    fn axis_power(&self, index: usize, m: &Motion) -> [f64; 2] {
        let arc_axis = &self.circle.axes[index];
        let axis = arc_axis.axis;
        let (v, a) = arc_axis.motion(m);
        let friction = axis.friction_factor(self.side);
        let steady =
            friction * (axis.viscous * v + axis.coulomb * self.signs[index]) + axis.gravity;
        let power = |factor: f64| {
            let force = axis.mass * a * factor + steady;
            let (p, copper) = (v * force, axis.copper * force * force);
            match self.side {
                Side::Regen => [
                    -p * axis.efficiency - copper,
                    -p * axis.inverse_efficiency - copper,
                ],
                _ => [axis.converted(p) + copper; 2],
            }
        };
        // Only one of the factors is not 1: exceeding counts where it is worse.
        let exceeding = axis.accel_factor(self.side, self.side == Side::Motor);
        let nominal = power(1.0);
        if exceeding == 1.0 {
            return nominal;
        }
        let exceeded = power(exceeding);
        [nominal[0].max(exceeded[0]), nominal[1].max(exceeded[1])]
    }

    /// What all axes together start from, W.
    fn base(&self) -> f64 {
        match self.side {
            Side::Regen if self.circle.credit_regen => -self.circle.idle_w,
            Side::Regen => 0.0,
            _ => self.circle.idle_w,
        }
    }
}

impl Bounded for Piece<'_> {
    type Sample = Sample;

    fn sample(&self, t: f64) -> Sample {
        let motion = self.circle.motion(self.phase, t);
        let mut sample = Sample {
            t,
            value: self.base(),
            first: [0.0; AXES],
            second: [0.0; AXES],
        };
        for index in 0..self.circle.axes.len() {
            let [first, second] = self.axis_power(index, &motion);
            (sample.first[index], sample.second[index]) = (first, second);
            sample.value += if self.circle.credit_regen {
                first.min(second)
            } else {
                first.max(0.0)
            };
        }
        sample
    }

    fn value(&self, sample: &Sample) -> (f64, f64) {
        (sample.t, sample.value)
    }

    fn bound(&self, from: &Sample, to: &Sample) -> f64 {
        let h = to.t - from.t;
        let (mut start, mut end, mut bend) = (self.base(), self.base(), 0.0);
        for (index, axis_bend) in self.bend[..self.circle.axes.len()].iter().enumerate() {
            let first = (from.first[index], to.first[index]);
            let second = (from.second[index], to.second[index]);
            let axis_bend = axis_bend * h * h;
            let (f0, f1) = if first.0 + first.1 <= second.0 + second.1 {
                first
            } else {
                second
            };
            if self.circle.credit_regen {
                (start, end, bend) = (start + f0, end + f1, bend + axis_bend);
            } else if first.0.max(first.1) + axis_bend > 0.0 {
                // An axis that stays below 0 all along does not count.
                start += first.0.max(0.0);
                end += first.1.max(0.0);
                bend += axis_bend;
            }
        }
        start.max(end) + bend
    }
}
