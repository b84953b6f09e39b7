//! What is nowhere less than at any lower override: slices at the largest overrides in
//! which a ramp counts at least as a cruise at the same place and speed.
//!
//! At a lower override a path is passed at each place x at a speed `v ≤ V` of the
//! largest, and with an acceleration between that of the largest and 0: it may cruise
//! already, or still. With a power P that is convex in the acceleration, and convex in v
//! from no more than the level λ at rest,
//!
//! ```text
//! P(v, a) − λ ≤ v/V · (P̂ − λ),    P̂ = max(P(V, A), P(V, 0))
//! ```
//!
//! so that with `dt = dx/v` what fills a store above λ at x is no more than that of P̂
//! at the largest overrides, and takes no less time; for λ ≥ 0 the same holds of
//! `(P² − λ²)⁺`. In a turn the force towards the centre counts as it is, or not at all:
//! power is convex in v² of that, too.

use super::slice::Slice;
use super::{Flow, Tracer};
use arrayvec::ArrayVec;
use gwatt_machine::{AXES, AxisSet, AxisValues};
use gwatt_motion::Move;
use gwatt_plan::{Blend, PathShares, Phase, PhaseKind, Profile, SpeedBound};
use std::f64::consts::PI;

/// Parts of a ramp that are raised one by one.
const PARTS: u32 = 8;
/// Parts of a turn, and of a phase at most.
const PARTS_A_TURN: f64 = 16.0;
const PARTS_MAX: f64 = 128.0;

/// Axes that run for themselves: how they meet at lower overrides is not known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Apart {
    /// The most that they draw together at any time above what is drawn at rest, W.
    pub most_w: f64,
    /// What they draw above that in all, J.
    pub work_j: f64,
    /// How long the move lasts at least, s.
    pub duration_s: f64,
}

/// No less than a power.
fn raise(slice: &Slice, floor_w: f64) -> Slice {
    if slice.keeps_above(floor_w) {
        *slice
    } else {
        let most_w = super::super::demand::larger(slice.peak_w(), floor_w);
        Slice::constant(slice.duration_s, most_w)
    }
}

impl Tracer<'_> {
    /// The same that raises.
    pub fn raised(self) -> Self {
        Self {
            raised: true,
            ..self
        }
    }

    /// What is drawn or fed back next to rest, however long it takes, W.
    pub fn rest_w(&self, mv: &Move) -> f64 {
        let active = AxisSet(mv.moving.0 & self.converter.axes.0);
        let held = active.iter().map(|axis| self.held_w(axis));
        self.base_w(self.idle_w(mv, active)) + held.sum::<f64>()
    }

    /// The share of an axis in that.
    pub(super) fn held_w(&self, axis: usize) -> f64 {
        let axis = &self.model.axes[axis];
        let power_w = |sign: f64| self.flow.sign() * axis.power(self.flow.side(), 0.0, 0.0, sign);
        power_w(1.0).max(power_w(-1.0)).max(0.0)
    }

    /// The power of a cruise on a line, W.
    pub fn cruise_w(&self, mv: &Move, speed_mm_s: f64) -> f64 {
        let active = AxisSet(mv.moving.0 & self.converter.axes.0);
        self.steady_w(&self.directions(mv), speed_mm_s, self.idle_w(mv, active))
    }

    fn steady_w(&self, directions: &[(usize, f64)], speed_mm_s: f64, idle_w: f64) -> f64 {
        let (side, sign) = (self.flow.side(), self.flow.sign());
        let mut power_w = self.base_w(idle_w);
        for &(axis, u) in directions {
            let v = u * speed_mm_s;
            let direction = if v == 0.0 { 0.0 } else { v.signum() };
            let own_w = sign * self.model.axes[axis].power(side, v, 0.0, direction);
            power_w += if self.converter.credit_regen {
                own_w
            } else {
                own_w.max(0.0)
            };
        }
        power_w
    }

    /// A phase along a line.
    pub(super) fn raised_phase(
        &self,
        directions: &[(usize, f64)],
        phase: &Phase,
        idle_w: f64,
        out: &mut impl FnMut(Slice),
    ) {
        if phase.is_cruise() || phase.duration_s <= 0.0 {
            return self.straight_phase(directions, phase, idle_w, out);
        }
        let has_copper = directions
            .iter()
            .any(|(axis, _)| self.model.axes[*axis].copper != 0.0);
        for part in phase.parts() {
            let grows = part.end_velocity_mm_s.abs() > part.velocity_mm_s.abs();
            if grows == (self.flow == Flow::Drawn) && !has_copper {
                // A cruise draws less than speeding up, and feeds back less than braking.
                self.straight_phase(directions, &part, idle_w, out);
                continue;
            }
            for own in split(&part, f64::from(PARTS)) {
                let ends = [own.velocity_mm_s, own.end_velocity_mm_s];
                let [a, b] = ends.map(|speed| self.steady_w(directions, speed, idle_w));
                let floor_w = a.max(b);
                self.straight_phase(directions, &own, idle_w, &mut |slice| {
                    out(raise(&slice, floor_w));
                });
            }
        }
    }

    /// A part of a phase on an arc, forwards.
    pub(super) fn raised_turn(
        &self,
        mv: &Move,
        circle: &super::super::arc_circle::Circle<'_>,
        part: &Phase,
        out: &mut impl FnMut(Slice),
    ) {
        let turns = mv.arc.as_ref().map_or(0.0, |arc| {
            arc.sweep_rad.abs() * part.length_mm() / (mv.length_mm * 2.0 * PI)
        });
        let shares = |ends_mm| PathShares::of(mv, ends_mm);
        for own in parts_of_turn(part, turns) {
            let floor_w = self.turned_floor_w(mv, circle, &own, &shares);
            self.turning(circle, &own, &mut |slice| out(raise(&slice, floor_w)));
        }
    }

    /// A part of a phase on the circle of a blend in which no axis turns back.
    pub(super) fn raised_blend(
        &self,
        lead: &Move,
        (blend, circle): (&Blend, &super::super::arc_circle::Circle<'_>),
        part: &Phase,
        out: &mut impl FnMut(Slice),
    ) {
        let turns = part.length_mm() / (blend.radius_mm * 2.0 * PI);
        let shares = |ends_mm| PathShares::of_blend(blend, ends_mm);
        for own in parts_of_turn(part, turns) {
            let floor_w = self.turned_floor_w(lead, circle, &own, &shares);
            let span_s = (0.0, own.duration_s);
            self.chords(circle, &own, span_s, &mut |slice| {
                out(raise(&slice, floor_w));
            });
        }
    }

    /// What a part of a turn asks for at its largest speed without being sped up or braked,
    /// and without the turn as well, W.
    fn turned_floor_w(
        &self,
        mv: &Move,
        circle: &super::super::arc_circle::Circle<'_>,
        own: &Phase,
        shares: &impl Fn([f64; 2]) -> PathShares,
    ) -> f64 {
        let speed_mm_s = own.velocity_mm_s.max(own.end_velocity_mm_s);
        let length_mm = own.length_mm();
        let shares = shares([own.position_mm, own.position_mm + length_mm]);
        let mut floor_w = self.turned_w(mv, &shares.along, speed_mm_s);
        if !own.is_cruise() && speed_mm_s > 0.0 && length_mm > 0.0 {
            let cruise = Phase {
                kind: PhaseKind::ConstantAcceleration,
                duration_s: length_mm / speed_mm_s,
                velocity_mm_s: speed_mm_s,
                end_velocity_mm_s: speed_mm_s,
                accel_mm_s2: 0.0,
                ..*own
            };
            self.turning(circle, &cruise, &mut |slice| {
                floor_w = floor_w.max(slice.peak_w());
            });
        }
        floor_w
    }

    /// A part of a phase on an arc that runs backwards: its bound.
    pub(super) fn raised_back(&self, mv: &Move, part: &Phase, out: &mut impl FnMut(Slice)) {
        let shares = PathShares::of(mv, [0.0, mv.length_mm]);
        let speed_mm_s = part.velocity_mm_s.abs().max(part.end_velocity_mm_s.abs());
        let accel_mm_s2 = part.accel_mm_s2.abs().max(part.end_accel_mm_s2().abs());
        let (mut bound, mut accels) = (shares.along, AxisValues::default());
        for (axis, accel) in accels.iter_mut().enumerate() {
            let share = bound.positive[axis].max(bound.negative[axis]);
            *accel = share * accel_mm_s2 + shares.across[axis] * speed_mm_s * speed_mm_s;
            bound.positive[axis] = share * speed_mm_s;
            bound.negative[axis] = share * speed_mm_s;
        }
        out(Slice::constant(
            part.duration_s,
            self.robust_w(mv, &bound, &accels),
        ));
    }

    /// What axes draw or feed back at a speed of the path in directions of these shares,
    /// without any acceleration, W.
    fn turned_w(&self, mv: &Move, shares: &SpeedBound, speed_mm_s: f64) -> f64 {
        let mut bound = *shares;
        for share in bound.positive.iter_mut().chain(&mut bound.negative) {
            *share *= speed_mm_s;
        }
        self.robust_w(mv, &bound, &AxisValues::default())
    }

    fn robust_w(&self, mv: &Move, bound: &SpeedBound, accels: &AxisValues) -> f64 {
        let totals = self.model.robust_totals(self.converter, mv, bound, accels);
        match self.flow {
            Flow::Drawn => totals.peak_w,
            Flow::FedBack => totals.regen_w,
        }
    }

    /// Axes that run for themselves; where one of the converter's moves alone, nothing
    /// but its slices.
    pub fn apart(
        &self,
        mv: &Move,
        profiles: &[(usize, Profile)],
        out: &mut impl FnMut(Slice),
    ) -> Option<Apart> {
        let own: ArrayVec<&(usize, Profile), AXES> = profiles
            .iter()
            .filter(|(axis, _)| self.converter.axes.contains(*axis))
            .take(AXES)
            .collect();
        let lasts_s = |profile: &Profile| profile.duration_s();
        let durations = profiles.iter().map(|(_, profile)| lasts_s(profile));
        let duration_s = durations.fold(0.0, f64::max);
        let direction = |axis: usize| {
            let unit = self.model.axes[axis].si_per_unit;
            [(axis, unit.copysign(mv.end[axis] - mv.start[axis]))]
        };
        if let [(axis, profile)] = own.as_slice() {
            let active = AxisSet(mv.moving.0 & self.converter.axes.0);
            let idle_w = self.idle_w(mv, active);
            for phase in &profile.phases {
                self.raised_phase(&direction(*axis), phase, idle_w, out);
            }
            // The axes of other converters may run on, but at lower overrides for less time.
            return None;
        }
        let mut apart = Apart {
            most_w: 0.0,
            work_j: 0.0,
            duration_s,
        };
        for (axis, profile) in own {
            let (base_w, held_w) = (self.base_w(0.0), self.held_w(*axis));
            let mut most_w = 0.0_f64;
            for phase in &profile.phases {
                self.raised_phase(&direction(*axis), phase, 0.0, &mut |slice| {
                    let raised = raise(&slice.raised(-base_w - held_w), 0.0);
                    most_w = most_w.max(raised.peak_w());
                    apart.work_j += raised.energy_j();
                });
            }
            apart.most_w += most_w;
        }
        Some(apart)
    }
}

/// Parts of a phase in which the directions of a turn change little.
fn parts_of_turn(part: &Phase, turns: f64) -> impl Iterator<Item = Phase> {
    let ramp = if part.is_cruise() { 1.0 } else { 4.0 };
    split(
        part,
        libm::ceil(turns * PARTS_A_TURN).clamp(ramp, PARTS_MAX),
    )
}

/// Equal parts of a phase.
pub(super) fn split(phase: &Phase, parts: f64) -> impl Iterator<Item = Phase> {
    let (phase, step_s) = (*phase, phase.duration_s / parts);
    let count = parts as u32;
    (0..count).map(move |part| {
        let to_s = if part + 1 == count {
            phase.duration_s
        } else {
            f64::from(part + 1) * step_s
        };
        phase.between(f64::from(part) * step_s, to_s)
    })
}
