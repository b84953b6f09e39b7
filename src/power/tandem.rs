//! Two moves at once: in a parabolic blend of `LinuxCNC` the next move begins while
//! the last one comes to rest, each on its own path.
//!
//! Input: both pieces of path with their profiles. Output: the robust bound for the
//! time that they share, from the speeds and accelerations that they have then:
//!
//! ```text
//! v̂ = max over t of s₁·v₁(t) + s₂·v₂(t),   â = s₁·â₁ + s₂·â₂
//! ```
//!
//! for each axis and direction, s its largest share of the path speed. Both speeds
//! are linear in time but for the switches of their profiles, so that the largest
//! sum stands at one of these. On an arc â₁ is √(a² + (v²/r)²).

use super::demand::Demand;
use super::model::PowerModel;
use crate::interpret::Move;
use crate::machine::{AXES, AxisValues};
use crate::plan::lookahead::{Piece, Planned};
use crate::plan::{Profile, SpeedBound, path_shares};

/// A piece of path that may share its time with another one.
#[derive(Debug, Clone)]
pub(super) struct Ride {
    /// The first and the last move that it belongs to.
    pub moves: [u64; 2],
    shares: SpeedBound,
    /// The plane of an arc, what of the speed lies in it, and its radius in mm.
    turn: Option<([usize; 2], f64, f64)>,
    profile: Profile,
    accel_mm_s2: f64,
}

impl Ride {
    /// A piece of the path of `mv`; `None` for a blend.
    pub fn of(mv: &Move, planned: &Planned<u64>) -> Option<Self> {
        let mut shares = SpeedBound::default();
        let mut turn = None;
        match &planned.piece {
            Piece::Blend(_) => return None,
            Piece::Joined { direction } => {
                for (axis, share) in direction.iter().enumerate() {
                    shares.positive[axis] = share.max(0.0);
                    shares.negative[axis] = (-share).max(0.0);
                }
            }
            Piece::Along { .. } => {
                shares = path_shares(mv);
                turn = mv.arc.map(|arc| {
                    let in_plane = arc.radius_mm * arc.sweep_rad.abs() / mv.length_mm;
                    (arc.plane, in_plane, arc.radius_mm)
                });
            }
        }
        Some(Self {
            moves: [planned.first, planned.tag],
            shares,
            turn,
            profile: planned.profile(),
            accel_mm_s2: planned.largest_accel_mm_s2(),
        })
    }

    /// Its speed, mm/s.
    fn speed(&self, t: f64) -> f64 {
        let state = self.profile.state_at(t);
        state.map_or(0.0, |state| state.velocity_mm_s)
    }

    /// The instants at which its acceleration may jump.
    fn switches_s(&self) -> impl Iterator<Item = f64> {
        let mut end_s = 0.0;
        self.profile.phases.iter().map(move |phase| {
            end_s += phase.duration_s;
            end_s
        })
    }

    /// Adds what it asks of the axes up to a speed, mm/s².
    fn add_accels(&self, speed_mm_s: f64, accels: &mut AxisValues) {
        let along = self.accel_mm_s2;
        for (axis, accel) in accels.iter_mut().enumerate() {
            let share = self.shares.positive[axis].max(self.shares.negative[axis]);
            *accel += match self.turn {
                Some((plane, in_plane, radius_mm)) if plane.contains(&axis) => {
                    let speed = speed_mm_s * in_plane;
                    libm::hypot(along * in_plane, speed * speed / radius_mm)
                }
                _ => along * share,
            };
        }
    }
}

/// What two rides ask for while they share their time: `overlap_s` before the end of
/// the first. Of `mv` only the switched loads are read.
pub(super) fn tandem_demand(
    model: &PowerModel,
    mv: &Move,
    [first, second]: [&Ride; 2],
    overlap_s: f64,
) -> Demand {
    let from_s = first.profile.duration_s() - overlap_s;
    let instants = first.switches_s().map(|t| t - from_s);
    let instants = instants.chain(second.switches_s()).chain([0.0, overlap_s]);
    let (mut bound, mut tops) = (SpeedBound::default(), [0.0_f64; 2]);
    for t in instants.filter(|t| (0.0..=overlap_s).contains(t)) {
        let speeds = [first.speed(from_s + t), second.speed(t)];
        for axis in 0..AXES {
            let sum = |[a, b]: [&AxisValues; 2]| a[axis] * speeds[0] + b[axis] * speeds[1];
            let positive = sum([&first.shares.positive, &second.shares.positive]);
            let negative = sum([&first.shares.negative, &second.shares.negative]);
            bound.positive[axis] = bound.positive[axis].max(positive);
            bound.negative[axis] = bound.negative[axis].max(negative);
        }
        tops = [tops[0].max(speeds[0]), tops[1].max(speeds[1])];
    }
    let mut accels = [0.0; AXES];
    first.add_accels(tops[0], &mut accels);
    second.add_accels(tops[1], &mut accels);
    model.robust(mv, &bound, &accels)
}
