//! Demand of a piece of path that may be sped up or braked at any place on it, from
//! rest to some speed.
//!
//! Input: the piece, the speeds up to which that may happen, and the acceleration.
//! Output: its [`Demand`]. On a line it is that of the ramps themselves. Where the
//! path turns it is the robust bound, over short stretches of an arc.

use super::demand::{Demand, Totals, Want, larger};
use super::model::PowerModel;
use super::piece::straight_line;
use super::robust::Part;
use gwatt_machine::AxisValues;
use gwatt_motion::Move;
use gwatt_plan::lookahead::{Piece, Planned, Speeds2};
use gwatt_plan::{PathShares, Plan, Section, Trajectory};
use std::f64::consts::PI;

/// Stretches of a turn over which the directions change little, and of a piece at most.
const STRETCHES_A_TURN: f64 = 32.0;
const STRETCHES_MAX: f64 = 64.0;

/// Up to which speed a piece may be sped up and from which it may be braked, mm/s, if
/// it may.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Surge {
    pub rises_mm_s: Option<f64>,
    pub falls_mm_s: Option<f64>,
    /// mm/s².
    pub accel_mm_s2: f64,
    /// With limits of jerk: the piece whose ramp from rest is as steep as may be.
    pub section: Option<Section>,
}

/// What a piece of a plan, which belongs to the move `mv`, may ask for.
pub(super) fn surge_demand(
    model: &PowerModel,
    mv: &Move,
    planned: &Planned<u64>,
    surge: Surge,
    want: Want,
) -> Demand {
    let want = Want {
        energy: false,
        ..want
    };
    match &planned.piece {
        Piece::Along { .. } if mv.arc.is_some() => turn_demand(model, mv, planned, surge),
        Piece::Along { .. } => line_demand(model, mv, surge, want),
        Piece::Joined { direction } => {
            let line = straight_line(mv, direction, planned.length_mm);
            line_demand(model, &line, surge, want)
        }
        Piece::Blend(_) => turn_demand(model, mv, planned, surge),
    }
}

/// The largest powers of one converter in that, drawn and fed back, W.
pub(super) fn surge_powers(
    model: &PowerModel,
    converter: usize,
    mv: &Move,
    planned: &Planned<u64>,
    surge: Surge,
) -> [f64; 2] {
    let speed_mm_s = surge.speed_mm_s();
    let of = |shares: &PathShares| {
        let (mut bound, mut accels) = (shares.along, AxisValues::default());
        for (axis, accel) in accels.iter_mut().enumerate() {
            let share = bound.positive[axis].max(bound.negative[axis]);
            *accel = share * surge.accel_mm_s2 + shares.across[axis] * speed_mm_s * speed_mm_s;
            bound.positive[axis] *= speed_mm_s;
            bound.negative[axis] *= speed_mm_s;
        }
        let part = Part {
            bound: &bound,
            accel_mm_s2: &accels,
        };
        model.robust_powers(converter, mv, &[part])
    };
    let powers = stretches(mv, planned).map(|shares| of(&shares));
    powers.fold([0.0; 2], |most, own| {
        [0, 1].map(|i| larger(most[i], own[i]))
    })
}

impl Surge {
    /// Of the squares of both speeds, if there is one.
    pub fn between([rises2, falls2]: [Option<f64>; 2], accel_mm_s2: f64) -> Option<Self> {
        let surge = Self {
            rises_mm_s: rises2.map(f64::sqrt),
            falls_mm_s: falls2.map(f64::sqrt),
            accel_mm_s2,
            section: None,
        };
        surge.without([false; 2])
    }

    /// What is left of it without being sped up, or braked.
    pub fn without(mut self, [rises, falls]: [bool; 2]) -> Option<Self> {
        self.rises_mm_s = self.rises_mm_s.filter(|_| !rises);
        self.falls_mm_s = self.falls_mm_s.filter(|_| !falls);
        (self.rises_mm_s.is_some() || self.falls_mm_s.is_some()).then_some(self)
    }

    /// How long its ramps last at most, s, where no place of the piece is passed at less than
    /// a share of its speed at the largest overrides.
    pub fn lasts_s(&self, planned: Speeds2, least_share: f64) -> f64 {
        let ramps = [
            (self.rises_mm_s, planned.start, false),
            (self.falls_mm_s, planned.end, true),
        ];
        let lasts = ramps.into_iter().filter_map(|(speed_mm_s, end2, last)| {
            let speed_mm_s = speed_mm_s.filter(|speed| *speed > 0.0)?;
            Some(match &self.section {
                // As part of another curve it may be gentler, and its own ramp is no longer
                // than that.
                Some(section) => {
                    let change_mm_s = speed_mm_s * (1.0 - least_share);
                    2.0 * section.ramp(change_mm_s, last).duration_s()
                }
                None => (speed_mm_s - least_share * end2.sqrt()).max(0.0) / self.accel_mm_s2,
            })
        });
        lasts.sum()
    }

    /// The largest speed of both, mm/s.
    pub fn speed_mm_s(&self) -> f64 {
        let speeds = [self.rises_mm_s, self.falls_mm_s];
        speeds.into_iter().flatten().fold(0.0, f64::max)
    }
}

fn line_demand(model: &PowerModel, mv: &Move, surge: Surge, want: Want) -> Demand {
    let mut demand = Demand::NONE;
    for (speed_mm_s, last) in [(surge.rises_mm_s, false), (surge.falls_mm_s, true)] {
        let Some(speed_mm_s) = speed_mm_s.filter(|speed| *speed > 0.0) else {
            continue;
        };
        let mut plan = Plan::ramps(speed_mm_s, surge.accel_mm_s2);
        if let Trajectory::Path(profile) = &mut plan.trajectory {
            if let Some(section) = &surge.section {
                *profile = section.ramp(speed_mm_s, last);
            } else {
                if last {
                    profile.phases.reverse();
                }
                profile.phases.truncate(1);
            }
        }
        demand.include(&model.demand(mv, &plan, want));
    }
    demand
}

/// Stretches of a piece over which the directions change little; a line is one.
fn stretches<'a>(mv: &'a Move, planned: &'a Planned<u64>) -> impl Iterator<Item = PathShares> + 'a {
    let ([from_mm, to_mm], turns) = match &planned.piece {
        Piece::Blend(blend) => (blend.ends_mm(), blend.sweep_rad / (2.0 * PI)),
        Piece::Along { from_mm, to_mm } => {
            let sweep_rad = mv.arc.as_ref().map_or(0.0, |arc| arc.sweep_rad.abs());
            let turns = sweep_rad * (to_mm - from_mm) / (mv.length_mm * 2.0 * PI);
            ([*from_mm, *to_mm], turns)
        }
        Piece::Joined { .. } => ([0.0, planned.length_mm], 0.0),
    };
    let count = libm::ceil(turns * STRETCHES_A_TURN).clamp(1.0, STRETCHES_MAX);
    let at = move |stretch: u32| from_mm + (to_mm - from_mm) * f64::from(stretch) / count;
    (0..count as u32).map(move |stretch| {
        let ends_mm = [at(stretch), at(stretch + 1)];
        match &planned.piece {
            Piece::Blend(blend) => PathShares::of_blend(blend, ends_mm),
            Piece::Along { .. } => PathShares::of(mv, ends_mm),
            Piece::Joined { direction } => {
                PathShares::of(&straight_line(mv, direction, planned.length_mm), ends_mm)
            }
        }
    })
}

fn turn_demand(model: &PowerModel, mv: &Move, planned: &Planned<u64>, surge: Surge) -> Demand {
    let mut demand = Demand::NONE;
    for shares in stretches(mv, planned) {
        demand.include(&turning_demand(model, mv, &shares, surge));
    }
    demand
}

/// What a path with directions within `shares` asks for. While it is sped up no axis is braked but
/// by the turn, and while it is braked none is sped up but by that; what is lost in copper grows
/// either way.
fn turning_demand(model: &PowerModel, mv: &Move, shares: &PathShares, surge: Surge) -> Demand {
    let sides = [(surge.rises_mm_s, false), (surge.falls_mm_s, true)];
    let sides = sides.map(|(speed_mm_s, falls)| {
        let speed_mm_s = speed_mm_s.filter(|speed| *speed > 0.0)?;
        let mut bound = shares.along;
        let (mut both, mut turn) = (AxisValues::default(), AxisValues::default());
        for (axis, (both, turn)) in both.iter_mut().zip(&mut turn).enumerate() {
            let share = bound.positive[axis].max(bound.negative[axis]);
            *turn = shares.across[axis] * speed_mm_s * speed_mm_s;
            *both = *turn + share * surge.accel_mm_s2;
            bound.positive[axis] *= speed_mm_s;
            bound.negative[axis] *= speed_mm_s;
        }
        Some((falls, bound, both, turn))
    });
    let mut demand = Demand::NONE;
    let copper = model.has_copper(mv);
    for (index, converter) in model.converters.iter().enumerate() {
        // A demand takes each converter once.
        let mut most: Option<Totals> = None;
        for (falls, bound, both, turn) in sides.iter().flatten() {
            let mut totals = model.robust_totals(converter, mv, bound, both);
            if !copper {
                let turning = model.robust_totals(converter, mv, bound, turn);
                if *falls {
                    totals.peak_w = turning.peak_w;
                } else {
                    totals.regen_w = turning.regen_w;
                }
            }
            let most = most.get_or_insert(totals);
            most.raise_peak(totals.peak_w);
            most.raise_regen(totals.regen_w);
        }
        if let Some(most) = most {
            demand.add(index, converter, most);
        }
    }
    demand
}
