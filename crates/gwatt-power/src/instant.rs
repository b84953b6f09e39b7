//! All axes, the spindle and the converters at one instant of a motion.
//!
//! Input: a [`Motion`] and a time in it. Output: an [`Instant`], as commanded:
//! without servo factors.

use super::model::PowerModel;
use super::motion::{Bounds, Course, Motion};
use gwatt_machine::{AXES, AxisSet};
use gwatt_motion::Move;
use gwatt_plan::{Phase, State};

/// The axis that the speed of the spindle follows under G96.
const X: usize = 0;
/// Share of a phase by which rounding may miss its end.
const ROUNDING: f64 = 1e-12;

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

/// The spindle at one instant; all 0 where the machine has none.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SpindleInstant {
    /// Speed in 1/min, signed by the direction of rotation.
    pub speed_rpm: f64,
    /// Acceleration in 1/min per s.
    pub accel_rpm_s: f64,
    /// Torque in N·m that accelerates it and overcomes its friction.
    pub torque_nm: f64,
    /// Electrical power in W, base load of its drive included, cutting not;
    /// negative where it is fed back.
    pub power_w: f64,
    /// Electrical power of cutting in W.
    pub cutting_w: f64,
}

/// All axes, the spindle and the converters at one instant.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Instant {
    /// The axes by index.
    pub axes: [AxisInstant; AXES],
    /// Axes that move from an unknown start: their figures are NaN, and `bus_w` and `regen_w`
    /// are the most that may be, both at once.
    pub unknown_axes: AxisSet,
    /// Speed along the path, mm/s; 0 where there is none, the largest from an unknown start.
    pub path_mm_s: f64,
    /// The spindle; NaN but for cutting where it follows X in a move from an unknown start.
    pub spindle: SpindleInstant,
    /// What each converter draws, base load included, W; what is fed back is
    /// taken off where the converter credits it.
    pub bus_w: Vec<f64>,
    /// What is fed back to each converter, W.
    pub regen_w: Vec<f64>,
    /// The lowest and the highest voltage of each bus that has limits of them, in the order of
    /// [`BusVoltages::names`](super::BusVoltages::names), V; empty where none is followed.
    pub volts: Vec<f64>,
}

impl Motion {
    /// The state `t` seconds after the beginning, by the laws that hold at
    /// `inside`, which lies between the same switches.
    pub fn at(&self, model: &PowerModel, t: f64, inside: f64, instant: &mut Instant) {
        instant.unknown_axes = AxisSet::default();
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
        instant.spindle = SpindleInstant::default();
        instant.path_mm_s = self.path_mm_s([t, inside]);
        instant.bus_w.clear();
        instant.regen_w.clear();
        if let Course::Unknown(motion) = &self.course {
            return self.bound(model, motion, instant);
        }
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

    /// The most that the converters may draw and take back, from an unknown start.
    fn bound(&self, model: &PowerModel, motion: &Bounds, instant: &mut Instant) {
        instant.unknown_axes = AxisSet(self.mv.moving.0 | self.mv.unknown_start.0);
        for axis in instant.unknown_axes.iter() {
            instant.axes[axis] = AxisInstant {
                velocity_mm_s: f64::NAN,
                accel_mm_s2: f64::NAN,
                force_n: f64::NAN,
                power_w: f64::NAN,
            };
        }
        for converter in &model.converters {
            let (bound, accel_mm_s2) = (&motion.most.bound, &motion.most.accel_mm_s2);
            let most = model.robust_totals(converter, &self.mv, bound, accel_mm_s2);
            instant.bus_w.push(most.peak_w);
            instant.regen_w.push(most.regen_w);
        }
    }

    /// Speed and acceleration of an axis at two instants between the same
    /// switches, of which the second gives the law; `None` where it stands.
    pub(super) fn axis(&self, axis: usize, instants: [f64; 2]) -> Option<[(f64, f64); 2]> {
        let [t, inside] = instants.map(|t| t + self.from_s);
        match &self.course {
            Course::Rest(_) | Course::Unknown(_) => None,
            Course::Path(phases) | Course::Line(phases) => {
                if !self.mv.moving.contains(axis) {
                    return None;
                }
                let states = states_along(phases, [t, inside])?;
                Some(states.map(|state| on_path(&self.mv, axis, &state)))
            }
            Course::Blend(blend, phases) => {
                let (tangent, normal) = (blend.tangent.get(axis)?, blend.normal.get(axis)?);
                if (*tangent, *normal) == (0.0, 0.0) {
                    return None;
                }
                let states = states_along(phases, [t, inside])?;
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
            Course::Both(both) => {
                let both = both.iter().filter_map(|one| one.axis(axis, [t, inside]));
                both.reduce(|a, b| [0, 1].map(|i| (a[i].0 + b[i].0, a[i].1 + b[i].1)))
            }
        }
    }

    /// Speed along the path at the first of two instants, as in [`Self::axis`].
    fn path_mm_s(&self, instants: [f64; 2]) -> f64 {
        let own = instants.map(|t| t + self.from_s);
        match &self.course {
            Course::Rest(_) | Course::Axes(_) => 0.0,
            Course::Unknown(motion) => motion.speed_mm_s,
            Course::Path(phases) | Course::Line(phases) | Course::Blend(_, phases) => {
                states_along(phases, own).map_or(0.0, |[state, _]| state.velocity_mm_s)
            }
            Course::Both(both) => {
                let speeds = [0, 1, 2].map(|axis| self.axis(axis, instants));
                let speeds = speeds.map(|axis| axis.map_or(0.0, |[(speed, _), _]| speed));
                let speed_mm_s = speeds.iter().map(|speed| speed * speed).sum::<f64>().sqrt();
                if speed_mm_s > 0.0 {
                    return speed_mm_s;
                }
                both.iter().map(|one| one.path_mm_s(own)).sum()
            }
        }
    }

    /// Where X is `t` seconds after the beginning, by the laws that hold at
    /// `inside`; it was at `before_mm` where the last motion ended.
    #[must_use]
    pub fn x_mm(&self, t: f64, inside: f64, before_mm: f64) -> f64 {
        let [t, inside] = [t, inside].map(|t| t + self.from_s);
        let at = |phases: &[Phase], instants| {
            let state = states(phases, instants).map(|[state, _]| state.position_mm);
            // After the last phase.
            state.unwrap_or_else(|| {
                let last = phases.last();
                last.map_or(0.0, |last| last.position_mm + last.length_mm())
            })
        };
        let along = |phases: &[Phase]| at(phases, [t, inside]);
        let first = |phases: &[Phase]| at(phases, [self.from_s; 2]);
        let share = (self.mv.end[X] - self.mv.start[X]) / self.mv.length_mm;
        match &self.course {
            Course::Rest(_) => before_mm,
            Course::Unknown(_) => self.mv.end[X],
            Course::Path(phases) => {
                let turned = self.mv.arc.as_ref().and_then(|arc| {
                    let which = arc.plane.iter().position(|own| *own == X)?;
                    let turn = arc.sweep_rad / self.mv.length_mm;
                    let angle = arc.start_angle_rad + turn * along(phases);
                    let (sin, cos) = libm::sincos(angle);
                    Some(arc.center[which] + arc.radius_mm * [cos, sin][which])
                });
                turned.unwrap_or_else(|| self.mv.start[X] + share * along(phases))
            }
            Course::Line(phases) => before_mm + share * (along(phases) - first(phases)),
            Course::Blend(blend, phases) => {
                let [tangent, normal] = [blend.tangent[X], blend.normal[X]];
                let x_mm = |position_mm: f64| {
                    let lead_mm = position_mm.min(blend.lead_mm);
                    let angle = (position_mm - lead_mm) / blend.radius_mm;
                    let (sin, cos) = libm::sincos(angle);
                    let across = tangent * sin + normal * (1.0 - cos);
                    tangent * lead_mm + blend.radius_mm * across
                };
                before_mm + x_mm(along(phases)) - x_mm(first(phases))
            }
            Course::Axes(axes) => {
                let Some((_, phases)) = axes.iter().find(|(own, _)| *own == X) else {
                    return self.mv.start[X];
                };
                let side = 1.0_f64.copysign(self.mv.end[X] - self.mv.start[X]);
                self.mv.start[X] + side * along(phases)
            }
            Course::Both(both) => {
                let from_s = self.from_s;
                let moved_mm = both
                    .iter()
                    .map(|one| one.x_mm(t, inside, 0.0) - one.x_mm(from_s, from_s, 0.0));
                before_mm + moved_mm.sum::<f64>()
            }
        }
    }
}

/// The states at two instants, by the phase of the second; `None` after the last
/// phase.
fn states(phases: &[Phase], [t, inside]: [f64; 2]) -> Option<[State; 2]> {
    let mut start = 0.0;
    for phase in phases {
        if inside < start + phase.duration_s {
            return Some([t, inside].map(|t| state_in(phase, t - start)));
        }
        start += phase.duration_s;
    }
    None
}

/// The same along a path, which ends with its last phase: an instant after it is that
/// end but for rounding.
fn states_along(phases: &[Phase], instants: [f64; 2]) -> Option<[State; 2]> {
    states(phases, instants).or_else(|| {
        let (last, before) = phases.split_last()?;
        let start: f64 = before.iter().map(|phase| phase.duration_s).sum();
        Some(instants.map(|t| state_in(last, t - start)))
    })
}

fn state_in(phase: &Phase, t: f64) -> State {
    let own = t.clamp(0.0, phase.duration_s);
    let mut state = phase.state_at(own);
    if phase.duration_s - own <= ROUNDING * phase.duration_s {
        state.velocity_mm_s = phase.end_velocity_mm_s;
    }
    state
}

/// Speed and acceleration of an axis along the path of a move.
pub(super) fn on_path(mv: &Move, axis: usize, state: &State) -> (f64, f64) {
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
