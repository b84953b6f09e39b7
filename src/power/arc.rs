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

use super::arc_energy;
use super::arc_piece::Piece;
use super::axis::{AxisPower, Side};
use super::circle::{ArcAxis, Motion, Shape};
use super::demand::{Totals, Want};
use super::model::{ConverterPower, PowerModel};
use super::quadrants::Pieces;
use super::search::Search;
use crate::interpret::{Arc, Move};
use crate::machine::{AXES, AxisSet};
use crate::plan::{Phase, Profile};
use arrayvec::ArrayVec;
use std::f64::consts::TAU;

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
    let mut regen = Search::new(0.0, want.regen_floor_w);
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
            totals.energy_j += arc_energy::phase_energy_j(&circle, phase);
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
    pub start_angle: f64,
    /// Sense of the sweep, ±1.
    pub sense: f64,
    /// Angle in rad per mm of path, positive.
    pub angle_per_mm: f64,
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
            if last {
                let fastest = self.motion(phase, if phase.accel_mm_s2 > 0.0 { to } else { from });
                let envelope = self.envelope(&fastest, side);
                if !search.covers(envelope) {
                    search.take_in(envelope);
                }
                return;
            }
            if !self.search_piece(phase, (from, to), side, search) {
                return;
            }
        }
    }

    /// The same between two instants, in s, between which no axis turns back;
    /// false where the power at any angle is below what was found.
    pub fn search_piece(
        &self,
        phase: &Phase,
        (from, to): (f64, f64),
        side: Side,
        search: &mut Search,
    ) -> bool {
        let fast = if phase.accel_mm_s2 > 0.0 { to } else { from };
        let fastest = self.motion(phase, fast);
        let envelope = self.envelope(&fastest, side);
        if search.covers(envelope) {
            return false;
        }
        let piece = Piece::new(self, phase, side, (from, to), &fastest);
        search.run(&piece, from, to, envelope.abs());
        true
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

    /// Time of one turn at the speed of a cruise; infinite if it does not turn.
    pub fn turn_s(&self, phase: &Phase) -> f64 {
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
}
