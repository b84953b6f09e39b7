//! Forces and powers along a circle, and their peaks.

use super::Circle;
use crate::arc_piece::Piece;
use crate::axis::{AxisPower, Side};
use crate::circle::{ArcAxis, Motion, Reach, Shape};
use crate::model::{ConverterPower, PowerModel};
use crate::quadrants::Pieces;
use crate::search::Search;
use gwatt_machine::{AXES, AxisSet};
use gwatt_motion::{Arc, Move};
use gwatt_plan::{Phase, PhaseKind};
use std::f64::consts::TAU;

impl<'a> Circle<'a> {
    pub fn new(
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

    /// The same circle for a path that is counted the other way.
    pub fn reversed(&self) -> Self {
        let mut reversed = self.clone();
        reversed.sense = -self.sense;
        for axis in &mut reversed.axes {
            if let Shape::Line(direction) = &mut axis.shape {
                *direction = -*direction;
            }
        }
        reversed
    }

    /// Finds the peak of one phase, or of a part of one.
    pub(crate) fn search(&self, phase: &Phase, side: Side, search: &mut Search) {
        let steady = phase.kind == PhaseKind::ConstantAcceleration;
        for (from, to, last) in Pieces::new(self, phase) {
            if last {
                let envelope = self.envelope(&self.reach(phase, from, to), side);
                if !search.covers(envelope) {
                    search.take_in(envelope);
                }
                return;
            }
            // What is slower stays below only at the same acceleration.
            if !self.search_piece(phase, (from, to), side, search) && steady {
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
        let reach = self.reach(phase, from, to);
        let envelope = self.envelope(&reach, side);
        if search.covers(envelope) {
            return false;
        }
        let middle = 0.5 * (from + to);
        if uneven(phase, from, to) && from < middle && middle < to {
            let first = self.search_piece(phase, (from, middle), side, search);
            return self.search_piece(phase, (middle, to), side, search) || first;
        }
        let piece = Piece::new(self, phase, side, (from, to), &reach);
        search.run(&piece, from, to, envelope.abs());
        true
    }

    /// What a piece of a phase reaches; a phase whose acceleration changes is a
    /// part on which neither speed nor acceleration changes its sign, so that
    /// the extremes of both are at the ends.
    pub fn reach(&self, phase: &Phase, from: f64, to: f64) -> Reach {
        if phase.kind == PhaseKind::ConstantAcceleration {
            let fast = if phase.accel_mm_s2 > 0.0 { to } else { from };
            let fastest = self.motion(phase, fast);
            return Reach {
                fastest,
                accel: [fastest.a; 2],
                alpha: [fastest.alpha; 2],
                path_rates: [0.0; 2],
                angle_rates: [0.0; 2],
            };
        }
        let (start, end) = (phase.state_at(from), phase.state_at(to));
        let (v0, v1) = (start.velocity_mm_s, end.velocity_mm_s);
        let (a0, a1) = (start.accel_mm_s2, end.accel_mm_s2);
        let v = v0.max(v1);
        let a = a0.abs().max(a1.abs());
        let rates = phase.rates(v0.min(v1), a);
        let by_angle = self.angle_per_mm;
        Reach {
            fastest: Motion {
                v,
                a,
                omega: v * by_angle,
                alpha: a * by_angle,
                sin: 0.0,
                cos: 1.0,
                sense: self.sense,
            },
            accel: [a0.min(a1), a0.max(a1)],
            alpha: [a0.min(a1) * by_angle, a0.max(a1) * by_angle],
            path_rates: rates,
            angle_rates: rates.map(|rate| rate * by_angle),
        }
    }

    /// Upper bound of the power on one side within a reach.
    pub fn envelope(&self, reach: &Reach, side: Side) -> f64 {
        let sum = |which: usize| -> f64 {
            let factors = |axis: &AxisPower| {
                [
                    axis.accel_factor(Side::Motor, true),
                    axis.accel_factor(Side::Regen, false),
                ]
            };
            self.axes
                .iter()
                .map(|axis| axis.envelope(reach, factors(axis.axis))[which])
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

/// Whether the rates of a phase differ so much between two instants that bounds
/// by the larger ones are of little use: at constant power they grow with
/// 1/v³ and more.
fn uneven(phase: &Phase, from: f64, to: f64) -> bool {
    let speed = |t: f64| phase.state_at(t).velocity_mm_s;
    matches!(phase.kind, PhaseKind::ConstantPower { .. }) && {
        let (v0, v1) = (speed(from), speed(to));
        v0.max(v1) > 1.5 * v0.min(v1).max(f64::MIN_POSITIVE)
    }
}
