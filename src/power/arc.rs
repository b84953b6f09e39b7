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

use super::arc_piece::Piece;
use super::axis::{AxisPower, Side};
use super::circle::{ArcAxis, Motion, Shape};
use super::demand::{Totals, Want};
use super::model::{ConverterPower, PowerModel};
use super::quadrature::integral;
use super::search::Search;
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
pub(super) struct Circle<'a> {
    /// Those that move.
    pub axes: ArrayVec<ArcAxis<'a>, AXES>,
    /// Whether fed-back power feeds the other axes.
    pub credit_regen: bool,
    /// What is drawn besides the axes, W.
    pub idle_w: f64,
    /// Angle at the start of the move, rad.
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
    pub fn motion(&self, phase: &Phase, t: f64) -> Motion {
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
    pub fn signs(&self, phase: &Phase, t: f64) -> [f64; AXES] {
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
            let (v, a) = axis.motion_towards(*sign, m);
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
