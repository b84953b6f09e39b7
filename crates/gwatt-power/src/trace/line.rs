//! Straight moves in phases of constant acceleration, no axis' power being curved:
//! no force changes in a phase, and the power runs evenly. The slices are those of
//! [`Tracer::straight_phase`] to the last bit, without polynomials.

use super::slice::Slice;
use super::{Flow, Tracer};
use arrayvec::ArrayVec;
use gwatt_machine::{AXES, AxisSet};
use gwatt_motion::Move;
use gwatt_plan::{Phase, PhaseKind, Phases, Profile};

/// A little more, for rounding.
const ROUNDING: f64 = 1e-9;

/// Such a move for one converter.
#[derive(Debug, Clone)]
pub(crate) struct Line {
    /// Signed SI motion of each axis per mm.
    directions: ArrayVec<(usize, f64), AXES>,
    phases: Phases,
    idle_w: f64,
}

/// Whether the power may run evenly in a phase.
#[inline]
fn is_even(phase: &Phase) -> bool {
    let (v0, v1) = (phase.velocity_mm_s, phase.end_velocity_mm_s);
    let forward = v0 >= 0.0 && v1 >= 0.0 && v0 + v1 > 0.0;
    matches!(phase.kind, PhaseKind::ConstantAcceleration) && forward && phase.duration_s > 0.0
}

impl Line {
    /// How long its slices last, s.
    pub fn durations_s(&self) -> impl Iterator<Item = f64> {
        self.phases.iter().map(|phase| phase.duration_s)
    }
}

impl Tracer<'_> {
    /// The move as a line, if it is one, to be looked at later.
    pub fn line(&self, mv: &Move, profile: &Profile) -> Option<Line> {
        let directions = self.directions(mv);
        let evenly = mv.arc.is_none() && self.is_line(mv, &directions, profile);
        evenly.then(|| Line {
            idle_w: self.idle_w(mv, AxisSet(mv.moving.0 & self.converter.axes.0)),
            directions,
            phases: profile.phases.clone(),
        })
    }

    /// Whether the power runs evenly in all phases.
    #[inline]
    pub(super) fn is_line(
        &self,
        mv: &Move,
        directions: &[(usize, f64)],
        profile: &Profile,
    ) -> bool {
        let curved = mv.moving.0 & self.converter.curved.0 != 0;
        !curved && !directions.is_empty() && profile.phases.iter().all(is_even)
    }

    /// No more than this is fed back on a line, W; `None` where it takes a closer
    /// look: friction and efficiency only lower it.
    #[inline]
    pub fn fed_back_bound_w(&self, line: &Line) -> Option<f64> {
        if self.converter.credit_regen || self.flow != Flow::FedBack {
            return None;
        }
        let (mut speed, mut accel) = (0.0_f64, 0.0_f64);
        for phase in &line.phases {
            speed = speed.max(phase.velocity_mm_s).max(phase.end_velocity_mm_s);
            accel = accel.max(phase.accel_mm_s2.abs());
        }
        let side = self.flow.side();
        let mut bound_w = 0.0;
        for &(axis, u) in &line.directions {
            let axis = &self.model.axes[axis];
            let u = u.abs();
            let factor = axis
                .accel_factor(side, true)
                .max(axis.accel_factor(side, false));
            bound_w += speed * u * (axis.mass * factor * u * accel + axis.gravity.abs());
        }
        Some(bound_w * (1.0 + ROUNDING))
    }

    /// The slices of a line.
    pub fn line_slices(&self, line: &Line, out: &mut impl FnMut(Slice)) {
        self.even(&line.directions, &line.phases, line.idle_w, out);
    }

    /// Phases along a line on which the power runs evenly.
    #[inline]
    pub(super) fn even(
        &self,
        directions: &[(usize, f64)],
        phases: &[Phase],
        idle_w: f64,
        out: &mut impl FnMut(Slice),
    ) {
        let (side, sign) = (self.flow.side(), self.flow.sign());
        let credit = self.converter.credit_regen;
        let mut powers: ArrayVec<[f64; 2], 7> = ArrayVec::new();
        powers.extend(phases.iter().take(7).map(|_| [0.0; 2]));
        let mut cruises = powers.clone();
        for &(axis, u) in directions {
            let axis = &self.model.axes[axis];
            let growing = axis.mass * axis.accel_factor(side, true) * u;
            let braking = axis.mass * axis.accel_factor(side, false) * u;
            let direction = if u == 0.0 { 0.0 } else { u.signum() };
            let constant = axis.coulomb * axis.friction_factor(side) * direction + axis.gravity;
            let add = |phase: &Phase, force: f64, power: &mut [f64; 2]| {
                let start = u * phase.velocity_mm_s * force;
                let change = u * (phase.accel_mm_s2 * phase.duration_s) * force;
                let middle = change * 0.5 + start;
                if credit || sign * middle > 0.0 {
                    let conversion = if middle > 0.0 {
                        axis.inverse_efficiency
                    } else {
                        axis.efficiency
                    };
                    power[0] += sign * (conversion * start);
                    power[1] += sign * (conversion * change);
                }
            };
            for (phase, power) in phases.iter().zip(&mut powers) {
                let a = phase.accel_mm_s2;
                let mass = if a > 0.0 { growing } else { braking };
                add(phase, mass * a + constant, power);
            }
            if self.raised {
                for (phase, cruise) in phases.iter().zip(&mut cruises) {
                    add(phase, constant, cruise);
                }
            }
        }
        if self.raised {
            // Both are in proportion to the speed.
            let middle = |power: &[f64; 2]| power[0] + 0.5 * power[1];
            for (power, cruise) in powers.iter_mut().zip(cruises) {
                if middle(&cruise) > middle(power) {
                    *power = cruise;
                }
            }
        }
        let base_w = self.base_w(idle_w);
        for (phase, [start_w, change_w]) in phases.iter().zip(powers) {
            out(Slice::even(phase.duration_s, start_w + base_w, change_w));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::PowerModel;
    use gwatt_interpret::{Diagnostics, Effects, Facts, Interpreter, Reading, Step};
    use gwatt_machine::Machine;
    use gwatt_plan::{Overrides, Trajectory, plan};
    use gwatt_syntax::{Block, scan_line};

    fn machine(converter: &str) -> Machine {
        let text = format!(
            "schema = 1\nname = \"test\"\ncontroller = \"iso\"\n[converter]\n\
             peak_power_w = 4000\nregen_power_w = 3000\nbase_load_w = 130\n{converter}\n\
             [axes.X]\nrapid_mm_min = 30000\naccel_mm_s2 = 2000\nmass_kg = 700\n\
             coulomb_n = 90\nefficiency = 0.8\nservo_factor_motor = 1.1\n\
             [axes.Y]\nrapid_mm_min = 30000\naccel_mm_s2 = 3000\nmass_kg = 150\n\
             coulomb_n = 1500\nefficiency = 0.9\nfriction_min_ratio = 0.5\n\
             [axes.Z]\nrapid_mm_min = 20000\naccel_mm_s2 = 2500\nmass_kg = 300\n\
             gravity_n = 900\nservo_factor_regen = 1.2\n"
        );
        Machine::from_toml("test.toml", &text).expect("a machine").0
    }

    fn moves(machine: &Machine, lines: &[&str]) -> Vec<Move> {
        let reading = Reading::default();
        let mut interpreter = Interpreter::new(machine, &reading);
        let (mut block, mut all) = (Block::default(), Vec::new());
        for (line, text) in lines.iter().enumerate() {
            let (mut steps, text) = (Vec::new(), text.as_bytes());
            let (mut facts, mut found) = (Facts::default(), Diagnostics::default());
            scan_line(text, line == 0, &mut block);
            interpreter.execute(
                1,
                text,
                &mut block,
                Effects::new(&mut steps, &mut facts, &mut found),
            );
            all.extend(steps.into_iter().filter_map(|step| match step {
                Step::Move(mv) => Some(mv),
                Step::Action(_) => None,
            }));
        }
        all
    }

    /// The slices are those of the general way to the last bit, and the bound is
    /// not below any of them.
    #[test]
    fn slices_without_polynomials_are_the_same() {
        let lines = [
            "G21 G90 G0 X300 Y-200 Z-90\n",
            "G1 X301 Y-190 F900\n",
            "G0 Z40\n",
            "G1 Z-5 F20000\n",
            "G0 X-10 Z300\n",
            "G1 Y3\n",
            "G0 X0 Y0 Z0\n",
        ];
        let mut compared = 0;
        for converter in ["", "credit_regen = true"] {
            let machine = machine(converter);
            let model = PowerModel::new(&machine);
            for mv in moves(&machine, &lines) {
                let planned = plan(&machine, &mv, Overrides::default());
                let Trajectory::Path(profile) = &planned.trajectory else {
                    panic!("a path");
                };
                for flow in [Flow::Drawn, Flow::FedBack] {
                    let tracer = model.tracer(0, flow).expect("a converter");
                    let line = tracer.line(&mv, profile).expect("a line");
                    let mut quick = Vec::new();
                    tracer.line_slices(&line, &mut |slice| quick.push(slice));
                    let mut general = Vec::new();
                    for phase in &profile.phases {
                        let out = &mut |slice| general.push(slice);
                        tracer.straight_phase(&line.directions, phase, line.idle_w, out);
                    }
                    assert_eq!(quick, general, "{mv:?} {flow:?}");
                    let bound_w = tracer.fed_back_bound_w(&line);
                    assert_eq!(
                        bound_w.is_some(),
                        flow == Flow::FedBack && converter.is_empty()
                    );
                    for slice in &quick {
                        assert!(bound_w.is_none_or(|bound_w| slice.peak_w() <= bound_w));
                        compared += 1;
                    }
                }
            }
        }
        assert!(compared > 60, "{compared}");
    }
}
