//! Two moves at once: in a parabolic blend of `LinuxCNC` the next move begins while
//! the last one comes to rest, each on its own path.
//!
//! Input: both pieces of path with their profiles. Output: the robust bound for the
//! time that they share, from the speeds and accelerations that they have then:
//!
//! ```text
//! v̂ = max over t of s₁·v₁(t) + s₂·v₂(t),   â = Σ s·â + c·v̂²
//! ```
//!
//! for each axis and direction, s its largest share of the path speed and c that of
//! the turning. Both speeds are linear in time but for the switches of their profiles,
//! so that the largest sum stands at one of these.

use super::demand::Demand;
use super::model::PowerModel;
use super::piece::straight_line;
use crate::interpret::Move;
use crate::machine::{AXES, AxisValues};
use crate::plan::lookahead::{Piece, Planned};
use crate::plan::{PathShares, Profile, SpeedBound, State};

/// Slices of the time that two moves share, of which one turns: over each the
/// directions change little.
const SLICES: u32 = 8;

/// A piece of path that may share its time with another one.
#[derive(Debug, Clone)]
pub(super) struct Ride {
    /// The first and the last move that it belongs to.
    pub moves: [u64; 2],
    path: Move,
    profile: Profile,
    accel_mm_s2: f64,
}

impl Ride {
    /// A piece of the path of `mv`; `None` for a blend.
    pub fn of(mv: &Move, planned: &Planned<u64>) -> Option<Self> {
        let mut profile = planned.profile();
        let path = match &planned.piece {
            Piece::Blend(_) => return None,
            Piece::Joined { direction } => straight_line(mv, direction, planned.length_mm),
            Piece::Along { from_mm, .. } => {
                for phase in &mut profile.phases {
                    phase.position_mm += from_mm;
                }
                mv.clone()
            }
        };
        Some(Self {
            moves: [planned.first, planned.tag],
            path,
            profile,
            accel_mm_s2: planned.largest_accel_mm_s2(),
        })
    }

    fn state(&self, t: f64) -> State {
        self.profile.state_at(t).unwrap_or_default()
    }

    /// The instants at which its acceleration may jump.
    fn switches_s(&self) -> impl Iterator<Item = f64> {
        let mut end_s = 0.0;
        self.profile.phases.iter().map(move |phase| {
            end_s += phase.duration_s;
            end_s
        })
    }

    /// What its axes take between two instants.
    fn shares(&self, from_s: f64, to_s: f64) -> PathShares {
        let places = [from_s, to_s].map(|t| self.state(t).position_mm);
        PathShares::of(&self.path, places)
    }
}

/// What two rides ask for while they share their time: `overlap_s` before the end of
/// the first. Of `mv` only the switched loads are read.
pub(super) fn tandem_demand(
    model: &PowerModel,
    mv: &Move,
    rides: [&Ride; 2],
    overlap_s: f64,
) -> Demand {
    let turns = rides.iter().any(|ride| ride.path.arc.is_some());
    let slices = if turns { SLICES } else { 1 };
    let at = |slice: u32| overlap_s * f64::from(slice) / f64::from(slices);
    let mut demand = Demand::NONE;
    for slice in 0..slices {
        let (bound, accels) = extremes(rides, overlap_s, [at(slice), at(slice + 1)]);
        demand.include(&model.robust(mv, &bound, &accels));
    }
    demand
}

/// The largest speeds and accelerations of the axes between two instants of the time
/// that they share.
fn extremes(
    rides: [&Ride; 2],
    overlap_s: f64,
    [from_s, to_s]: [f64; 2],
) -> (SpeedBound, AxisValues) {
    let begins_s = [rides[0].profile.duration_s() - overlap_s, 0.0];
    let switches = rides.iter().zip(begins_s);
    let switches =
        switches.flat_map(|(ride, begins_s)| ride.switches_s().map(move |t| t - begins_s));
    let instants = switches.chain([from_s, to_s]);
    let both = [0, 1].map(|i| rides[i].shares(begins_s[i] + from_s, begins_s[i] + to_s));
    let (mut bound, mut tops) = (SpeedBound::default(), [0.0_f64; 2]);
    for t in instants.filter(|t| (from_s..=to_s).contains(t)) {
        let speeds = [0, 1].map(|i| rides[i].state(begins_s[i] + t).velocity_mm_s);
        tops = [tops[0].max(speeds[0]), tops[1].max(speeds[1])];
        let [a, b] = both.each_ref().map(|shares| &shares.along);
        for axis in 0..AXES {
            let sum = |a: &AxisValues, b: &AxisValues| a[axis] * speeds[0] + b[axis] * speeds[1];
            bound.positive[axis] = bound.positive[axis].max(sum(&a.positive, &b.positive));
            bound.negative[axis] = bound.negative[axis].max(sum(&a.negative, &b.negative));
        }
    }
    let mut accels = [0.0; AXES];
    for ((ride, shares), top) in rides.into_iter().zip(&both).zip(tops) {
        let SpeedBound {
            positive, negative, ..
        } = &shares.along;
        for (axis, accel) in accels.iter_mut().enumerate() {
            let along = ride.accel_mm_s2 * positive[axis].max(negative[axis]);
            *accel += along + shares.across[axis] * top * top;
        }
    }
    (bound, accels)
}
