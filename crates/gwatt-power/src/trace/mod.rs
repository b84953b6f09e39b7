//! Power over time: what a plan draws or feeds back at each instant.
//!
//! Input: a move and its plan, or a piece of a plan. Output: [`Slice`]s in the
//! order of time that together last as long as the plan.
//!
//! Where acceleration or jerk is constant on a straight path the power is a
//! polynomial of time between the instants at which an axis turns from driving
//! to braking: exact. On arcs each slice is a chord, raised by the bound of what
//! lies above it, and so fine that it is nowhere higher than a tolerance. Where
//! speed follows a curve of torque or power, the largest power of each 64th
//! of the phase counts for all of it. So the trace is never too low.

mod course;
mod line;
mod raised;
mod shifted;
mod slice;
mod turn;

pub(super) use line::Line;
pub(super) use raised::Apart;
pub use slice::Slice;

use super::axis::Side;
use super::model::{ConverterPower, PowerModel};
use super::piece::straight_line;
use super::steps::StepEnergy;
use gwatt_machine::{AXES, AxisSet};
use gwatt_motion::Move;
use gwatt_plan::lookahead::{Piece, Planned};
use gwatt_plan::{Plan, Profile, Trajectory};

/// Share of a converter's peak power by which a slice of an arc may be too high.
const TOLERANCE: f64 = 1e-3;

/// Which way power flows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Flow {
    /// Out of the converter, base load included, with the servo factors of
    /// driving; below 0 only where what is fed back is credited.
    Drawn,
    /// Back into it, with the servo factors of braking and warm friction; may be
    /// below 0 where what is fed back is credited and more is drawn.
    FedBack,
}

impl Flow {
    fn side(self) -> Side {
        match self {
            Self::Drawn => Side::Motor,
            Self::FedBack => Side::Regen,
        }
    }

    /// The sign of what is drawn.
    fn sign(self) -> f64 {
        match self {
            Self::Drawn => 1.0,
            Self::FedBack => -1.0,
        }
    }
}

/// What one converter's power is traced with.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tracer<'a> {
    model: &'a PowerModel,
    converter: &'a ConverterPower,
    flow: Flow,
    /// Power by which a slice may be too high.
    tolerance_w: f64,
    /// Ramps count no less than a cruise at the same place and speed: see `raised`.
    raised: bool,
}

impl PowerModel {
    /// The power of a planned move on one converter. Nothing where its timing is
    /// not known (an unknown start, or a rest that never ends), and for a
    /// converter that does not exist.
    #[must_use]
    pub fn trace(&self, mv: &Move, plan: &Plan, converter: usize, flow: Flow) -> Vec<Slice> {
        let converter = self.converters.get(converter);
        converter.map_or_else(Vec::new, |converter| self.slices(converter, mv, plan, flow))
    }

    /// The same of a converter.
    pub(super) fn slices(
        &self,
        converter: &ConverterPower,
        mv: &Move,
        plan: &Plan,
        flow: Flow,
    ) -> Vec<Slice> {
        let mut slices = Vec::new();
        self.tracer_of(converter, flow)
            .plan(mv, plan, &mut |slice| slices.push(slice));
        slices
    }

    /// For a converter that exists.
    pub(super) fn tracer(&self, converter: usize, flow: Flow) -> Option<Tracer<'_>> {
        Some(self.tracer_of(self.converters.get(converter)?, flow))
    }

    pub(super) fn tracer_of<'a>(&'a self, converter: &'a ConverterPower, flow: Flow) -> Tracer<'a> {
        Tracer {
            model: self,
            converter,
            flow,
            tolerance_w: TOLERANCE * converter.limit_w(),
            raised: false,
        }
    }
}

impl Tracer<'_> {
    /// The slices of a planned move.
    pub fn plan(&self, mv: &Move, plan: &Plan, out: &mut impl FnMut(Slice)) {
        match &plan.trajectory {
            Trajectory::Path(profile) => self.path(mv, profile, out),
            Trajectory::Axes(profiles) => self.independent(mv, profiles, out),
            Trajectory::Rest => {
                if plan.duration_s.is_finite() {
                    let idle_w = self.idle_w(mv, AxisSet::default());
                    self.at_rest(plan.duration_s, idle_w, out);
                }
            }
            Trajectory::Unknown(_) => {}
        }
    }

    /// The energy of a step of speed, J; what flows the other way counts where it is
    /// credited.
    pub fn step_j(&self, step: &StepEnergy) -> f64 {
        let [drawn_j, fed_back_j] = step.of(self.model, self.converter.axes);
        let [own_j, other_j] = match self.flow {
            Flow::Drawn => [drawn_j, fed_back_j],
            Flow::FedBack => [fed_back_j, drawn_j],
        };
        if self.converter.credit_regen {
            (own_j - other_j).max(0.0)
        } else {
            own_j
        }
    }

    /// The slices of a piece of a plan, which belongs to `mv`.
    pub fn piece(&self, mv: &Move, planned: &Planned<u64>, out: &mut impl FnMut(Slice)) {
        let mut profile = planned.profile();
        match &planned.piece {
            Piece::Along { from_mm, .. } => {
                for phase in &mut profile.phases {
                    phase.position_mm += from_mm;
                }
                self.path(mv, &profile, out);
            }
            Piece::Joined { direction } => {
                let line = straight_line(mv, direction, planned.length_mm);
                self.path(&line, &profile, out);
            }
            Piece::Blend(blend) => {
                let lead = straight_line(mv, &blend.tangent, 1.0);
                self.blend(&lead, blend, &profile, out);
            }
        }
    }

    fn path(&self, mv: &Move, profile: &Profile, out: &mut impl FnMut(Slice)) {
        let active = AxisSet(mv.moving.0 & self.converter.axes.0);
        let idle_w = self.idle_w(mv, active);
        match &mv.arc {
            Some(arc) => self.arc(mv, arc, profile, idle_w, out),
            None => self.straight(mv, profile, idle_w, out),
        }
    }

    /// What is drawn besides the axes in `active`.
    fn idle_w(&self, mv: &Move, active: AxisSet) -> f64 {
        self.converter.idle_w(mv, &self.model.axes, active)
    }

    /// Nothing but the idle load.
    fn at_rest(&self, duration_s: f64, idle_w: f64, out: &mut impl FnMut(Slice)) {
        if duration_s > 0.0 {
            out(Slice::constant(duration_s, self.base_w(idle_w)));
        }
    }

    /// What the power of the axes starts from.
    fn base_w(&self, idle_w: f64) -> f64 {
        match self.flow {
            Flow::Drawn => idle_w,
            Flow::FedBack if self.converter.credit_regen => -idle_w,
            Flow::FedBack => 0.0,
        }
    }

    /// Signed SI motion of each of the converter's axes per mm of a line.
    fn directions(&self, mv: &Move) -> arrayvec::ArrayVec<(usize, f64), AXES> {
        let active = AxisSet(mv.moving.0 & self.converter.axes.0);
        active
            .iter()
            .map(|axis| {
                let unit = self.model.axes[axis].si_per_unit;
                (axis, (mv.end[axis] - mv.start[axis]) * unit / mv.length_mm)
            })
            .collect()
    }
}
