//! The planned motion of all axes over time, and what each asks for.
//!
//! Input: plans and pieces of plans. Output: speed, acceleration, force and power
//! of each axis at any instant, as commanded: without servo factors.

use super::blend::{cuts, pieces};
use super::model::PowerModel;
use super::piece::straight_line;
use crate::interpret::Move;
use crate::machine::{AXES, AxisSet};
use crate::plan::lookahead::{Piece, Planned};
use crate::plan::{Blend, Phase, Plan, Profile, State, Trajectory};
use std::f64::consts::FRAC_PI_2;

/// Instants at which the axes of one arc may turn back that are looked at.
const QUADRANTS: f64 = 4096.0;

/// A piece of motion.
#[derive(Debug, Clone, PartialEq)]
pub struct Motion {
    /// The move that it belongs to.
    pub mv: Move,
    course: Course,
}

#[derive(Debug, Clone, PartialEq)]
enum Course {
    Rest(f64),
    Path(Vec<Phase>),
    Blend(Blend, Vec<Phase>),
    Axes(Vec<(usize, Vec<Phase>)>),
}

/// One axis at one instant, in the units of the machine file.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct AxisInstant {
    /// Speed in mm/s or degrees/s.
    pub velocity_mm_s: f64,
    /// Acceleration in mm/s² or degrees/s².
    pub accel_mm_s2: f64,
    /// Force in N, or torque in N·m.
    pub force_n: f64,
    /// Electrical power in W; negative where it is fed back.
    pub power_w: f64,
}

/// All axes and converters at one instant.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Instant {
    /// The axes by index.
    pub axes: [AxisInstant; AXES],
    /// What each converter draws, base load included, W; what is fed back is
    /// taken off where the converter credits it.
    pub bus_w: Vec<f64>,
    /// What is fed back to each converter, W.
    pub regen_w: Vec<f64>,
}

impl Motion {
    /// The motion of a planned move; `None` where its timing is not known.
    #[must_use]
    pub fn of_plan(mv: &Move, plan: &Plan) -> Option<Self> {
        let course = match &plan.trajectory {
            Trajectory::Path(profile) => Course::Path(along(mv, profile)),
            Trajectory::Axes(profiles) => {
                let phases = |profile: &Profile| profile.phases.to_vec();
                let axes = profiles.iter();
                Course::Axes(axes.map(|(axis, own)| (*axis, phases(own))).collect())
            }
            Trajectory::Rest if plan.duration_s.is_finite() => Course::Rest(plan.duration_s),
            Trajectory::Rest | Trajectory::Unknown(_) => return None,
        };
        let mv = mv.clone();
        Some(Self { mv, course })
    }

    /// The motion of a piece of a plan, which belongs to `mv`.
    #[must_use]
    pub(super) fn of_piece(mv: &Move, planned: &Planned<u64>) -> Self {
        let mut profile = planned.profile();
        match &planned.piece {
            Piece::Along { from_mm, .. } => {
                for phase in &mut profile.phases {
                    phase.position_mm += from_mm;
                }
                Self {
                    mv: mv.clone(),
                    course: Course::Path(along(mv, &profile)),
                }
            }
            Piece::Joined { direction } => Self {
                mv: straight_line(mv, direction, planned.length_mm),
                course: Course::Path(profile.phases.to_vec()),
            },
            Piece::Blend(blend) => {
                let cuts = cuts(blend);
                let phases = profile.phases.iter();
                let phases = phases.flat_map(|phase| pieces(phase, &cuts));
                Self {
                    mv: straight_line(mv, &blend.tangent, 1.0),
                    course: Course::Blend(*blend, phases.collect()),
                }
            }
        }
    }

    /// Instants at which an acceleration may jump, from 0 to the end, s.
    #[must_use]
    pub fn switches_s(&self) -> Vec<f64> {
        let ends = |phases: &[Phase]| {
            let mut end = 0.0;
            let ends = phases.iter().map(|phase| {
                end += phase.duration_s;
                end
            });
            ends.collect::<Vec<f64>>()
        };
        let mut switches = match &self.course {
            Course::Rest(duration_s) => vec![*duration_s],
            Course::Path(phases) | Course::Blend(_, phases) => ends(phases),
            Course::Axes(axes) => axes.iter().flat_map(|(_, phases)| ends(phases)).collect(),
        };
        switches.push(0.0);
        switches.sort_by(f64::total_cmp);
        switches.dedup();
        switches
    }

    /// The state `t` seconds after the beginning, by the laws that hold at
    /// `inside`, which lies between the same switches.
    pub fn at(&self, model: &PowerModel, t: f64, inside: f64, instant: &mut Instant) {
        let mut active = AxisSet::default();
        instant.axes = [AxisInstant::default(); AXES];
        for (index, own) in instant.axes.iter_mut().enumerate() {
            let axis = &model.axes[index];
            let holding = AxisInstant {
                force_n: axis.gravity,
                power_w: axis.holding_w(),
                ..AxisInstant::default()
            };
            *own = holding;
            let Some([(speed, accel), (nearby, _)]) = self.axis(index, [t, inside]) else {
                continue;
            };
            active.insert(index);
            let unit = axis.si_per_unit;
            let direction = if nearby == 0.0 { 0.0 } else { nearby.signum() };
            // At a turning point rounding must not let it move back.
            let speed = if speed * direction < 0.0 { 0.0 } else { speed };
            let v = speed * unit;
            let force = axis.mass * accel * unit
                + axis.viscous * v
                + axis.coulomb * direction
                + axis.gravity;
            *own = AxisInstant {
                velocity_mm_s: speed,
                accel_mm_s2: accel,
                force_n: force,
                power_w: axis.electrical(v, force),
            };
        }
        instant.bus_w.clear();
        instant.regen_w.clear();
        for converter in &model.converters {
            let moving = AxisSet(active.0 & converter.axes.0);
            let idle_w = converter.idle_w(&self.mv, &model.axes, moving);
            let powers = moving
                .iter()
                .filter_map(|axis| instant.axes.get(axis))
                .map(|axis| axis.power_w);
            let (mut drawn_w, mut fed_back_w) = (0.0, 0.0);
            for power_w in powers {
                drawn_w += power_w.max(0.0);
                fed_back_w += (-power_w).max(0.0);
            }
            if converter.credit_regen {
                let net_w = idle_w + drawn_w - fed_back_w;
                instant.bus_w.push(net_w);
                instant.regen_w.push((-net_w).max(0.0));
            } else {
                instant.bus_w.push(idle_w + drawn_w);
                instant.regen_w.push(fed_back_w);
            }
        }
    }

    /// Speed and acceleration of an axis at two instants between the same
    /// switches, of which the second tells the law; `None` where it stands.
    fn axis(&self, axis: usize, [t, inside]: [f64; 2]) -> Option<[(f64, f64); 2]> {
        match &self.course {
            Course::Rest(_) => None,
            Course::Path(phases) => {
                if !self.mv.moving.contains(axis) {
                    return None;
                }
                let states = states(phases, [t, inside])?;
                Some(states.map(|state| on_path(&self.mv, axis, &state)))
            }
            Course::Blend(blend, phases) => {
                let (tangent, normal) = (blend.tangent.get(axis)?, blend.normal.get(axis)?);
                if (*tangent, *normal) == (0.0, 0.0) {
                    return None;
                }
                let states = states(phases, [t, inside])?;
                let leads = states[1].position_mm < blend.lead_mm;
                Some(states.map(|state| {
                    let (v, a) = (state.velocity_mm_s, state.accel_mm_s2);
                    if leads {
                        return (tangent * v, tangent * a);
                    }
                    let angle = (state.position_mm - blend.lead_mm) / blend.radius_mm;
                    let (sin, cos) = libm::sincos(angle);
                    let along = tangent * cos + normal * sin;
                    let across = normal * cos - tangent * sin;
                    (along * v, along * a + across * v * v / blend.radius_mm)
                }))
            }
            Course::Axes(axes) => {
                let (_, phases) = axes.iter().find(|(own, _)| *own == axis)?;
                let side = 1.0_f64.copysign(self.mv.end[axis] - self.mv.start[axis]);
                let states = states(phases, [t, inside]).unwrap_or_default();
                Some(states.map(|state| (side * state.velocity_mm_s, side * state.accel_mm_s2)))
            }
        }
    }
}

/// The states at two instants, by the phase of the second; `None` behind the last
/// phase.
fn states(phases: &[Phase], [t, inside]: [f64; 2]) -> Option<[State; 2]> {
    let mut start = 0.0;
    for phase in phases {
        if inside < start + phase.duration_s {
            let state = |t: f64| {
                let own = (t - start).clamp(0.0, phase.duration_s);
                let mut state = phase.state_at(own);
                if own >= phase.duration_s {
                    state.velocity_mm_s = phase.end_velocity_mm_s;
                }
                state
            };
            return Some([t, inside].map(state));
        }
        start += phase.duration_s;
    }
    None
}

/// Speed and acceleration of an axis along the path of a move.
fn on_path(mv: &Move, axis: usize, state: &State) -> (f64, f64) {
    let (v, a) = (state.velocity_mm_s, state.accel_mm_s2);
    if let Some(arc) = &mv.arc
        && let Some(which) = arc.plane.iter().position(|&own| own == axis)
    {
        let turn = arc.sweep_rad / mv.length_mm;
        let angle = arc.start_angle_rad + turn * state.position_mm;
        let (sin, cos) = libm::sincos(angle);
        let (tangent, normal) = if which == 0 {
            (-sin, -cos)
        } else {
            (cos, -sin)
        };
        let (omega, alpha, r) = (turn * v, turn * a, arc.radius_mm);
        return (
            r * omega * tangent,
            r * (alpha * tangent + omega * omega * normal),
        );
    }
    let share = (mv.end[axis] - mv.start[axis]) / mv.length_mm;
    (share * v, share * a)
}

/// The phases along a path; on an arc cut where an axis turns back.
fn along(mv: &Move, profile: &Profile) -> Vec<Phase> {
    let Some(arc) = &mv.arc else {
        return profile.phases.to_vec();
    };
    let mm_per_rad = mv.length_mm / arc.sweep_rad.abs();
    // Where the path meets the first quadrant of the circle.
    let angle = arc.start_angle_rad * arc.sweep_rad.signum();
    let first_rad = (libm::ceil(angle / FRAC_PI_2) * FRAC_PI_2 - angle).max(0.0);
    let mut cut = Vec::new();
    for phase in &profile.phases {
        let steps = phase.length_mm() / (FRAC_PI_2 * mm_per_rad);
        let few = steps < QUADRANTS;
        if !few {
            cut.push(*phase);
            continue;
        }
        let mut rest = *phase;
        let start_rad = phase.position_mm / mm_per_rad;
        let skipped = libm::floor((start_rad - first_rad) / FRAC_PI_2) + 1.0;
        let mut step = skipped.max(0.0);
        loop {
            let at_mm = (first_rad + step * FRAC_PI_2) * mm_per_rad;
            let inside = at_mm - phase.position_mm < phase.length_mm();
            if !inside {
                break;
            }
            let pieces = pieces(&rest, &[at_mm]);
            if let [before, after] = pieces.as_slice() {
                cut.push(*before);
                rest = *after;
            }
            step += 1.0;
        }
        cut.push(rest);
    }
    cut
}
