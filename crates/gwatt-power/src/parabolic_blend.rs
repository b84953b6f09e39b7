//! Two moves at once: in a parabolic blend of `LinuxCNC` the next move begins while
//! the last one comes to rest, each on its own path.
//!
//! Input: both pieces of path with their profiles. Output: the speeds and accelerations
//! that they have at most in the time that they share, and the robust bound from these:
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
use super::robust::Extremes;
use super::slower::speeds_mm_s;
use arrayvec::ArrayVec;
use gwatt_machine::{AXES, AxisValues};
use gwatt_motion::Move;
use gwatt_plan::lookahead::{Piece, Planned};
use gwatt_plan::{PathShares, Phase, PhaseKind, Profile, SpeedBound, State};

/// Slices of the time that two moves share, of which one turns: over each the
/// directions change little.
const SLICES: usize = 8;
/// Halvings in the search for the override at which they share most.
const HALVINGS: u32 = 40;
/// By what share two times may differ by rounding.
const ROUNDING: f64 = 1e-9;

/// A piece of path that may share its time with another one.
#[derive(Debug, Clone)]
pub(super) struct Ride {
    /// The first and the last move that it belongs to.
    pub moves: [u64; 2],
    pub path: Move,
    profile: Profile,
    accel_mm_s2: f64,
    length_mm: f64,
    /// Where the piece begins on the path, mm.
    from_mm: f64,
    /// The speed that is asked for, and as far as axes and curvature permit it, mm/s.
    asked_mm_s: f64,
    cap_mm_s: f64,
}

impl Ride {
    /// A piece of the path of `mv`, with the speed that is asked for and as far as it is
    /// permitted, mm/s; `None` for a blend.
    pub fn of(mv: &Move, planned: &Planned<u64>, [asked_mm_s, cap_mm_s]: [f64; 2]) -> Option<Self> {
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
        let from_mm = match planned.piece {
            Piece::Along { from_mm, .. } => from_mm,
            _ => 0.0,
        };
        Some(Self {
            moves: [planned.first, planned.tag],
            path,
            profile,
            accel_mm_s2: planned.largest_accel_mm_s2(),
            length_mm: planned.length_mm,
            from_mm,
            asked_mm_s,
            cap_mm_s,
        })
    }

    /// The speed that it gets to from rest and to rest at a share of the override, mm/s.
    fn speed_mm_s(&self, share: f64) -> f64 {
        let peak = (self.accel_mm_s2 * self.length_mm).sqrt();
        let asked = share * self.asked_mm_s;
        peak.min(asked).min(self.cap_mm_s)
    }

    /// The same, where it only comes to rest, or begins, over some seconds.
    fn ramp(&self, speed_mm_s: f64, duration_s: f64, begins: bool) -> Self {
        let accel = self.accel_mm_s2;
        let mut profile = Profile::default();
        let mut push = |duration_s: f64, position_mm: f64, ends: [f64; 2], accel_mm_s2: f64| {
            profile.phases.push(Phase {
                kind: PhaseKind::ConstantAcceleration,
                duration_s,
                position_mm,
                velocity_mm_s: ends[0],
                end_velocity_mm_s: ends[1],
                accel_mm_s2,
            });
        };
        if begins {
            let up_s = duration_s.min(speed_mm_s / accel);
            let top = accel * up_s;
            push(up_s, self.from_mm, [0.0, top], accel);
            if duration_s > up_s {
                let from_mm = self.from_mm + 0.5 * top * up_s;
                push(duration_s - up_s, from_mm, [top; 2], 0.0);
            }
        } else {
            let top = accel * duration_s;
            let back_mm = (0.5 * top * duration_s).min(self.length_mm);
            let from_mm = self.from_mm + self.length_mm - back_mm;
            push(duration_s, from_mm, [top, 0.0], -accel);
        }
        Self {
            profile,
            ..self.clone()
        }
    }

    /// How long it lasts, s.
    pub fn duration_s(&self) -> f64 {
        self.profile.duration_s()
    }

    /// Where it is on its path, `t` seconds after its beginning.
    pub fn state(&self, t: f64) -> State {
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

/// What two rides come to while they share their time.
#[derive(Debug)]
pub(super) struct Tandem {
    /// At the largest overrides, in slices of the time that last equally long.
    pub largest: ArrayVec<Extremes, SLICES>,
    /// At lower overrides at which they share more of it.
    pub slower: Vec<Extremes>,
    /// How long that is at the largest overrides, and at any at most, s.
    pub overlap_s: f64,
    pub longest_s: f64,
}

impl Tandem {
    /// Two rides that share the last `overlap_s` of the first one, at these overrides alone.
    pub fn new(rides: [&Ride; 2], overlap_s: f64) -> Self {
        Self {
            largest: shared(rides, overlap_s).collect(),
            slower: Vec::new(),
            overlap_s,
            longest_s: overlap_s,
        }
    }

    /// The same at any override: where the ramps at the largest are as long as the paths, they
    /// share more of it at lower ones, as long as the longer ramp lasts.
    pub fn at_any(rides: [&Ride; 2], overlap_s: f64) -> Self {
        let mut tandem = Self::new(rides, overlap_s);
        // As long as the longer ramp lasts, unless a path is passed sooner: the one falls with
        // the speeds, the other grows.
        let lasts_s = |share: f64| {
            let speeds = rides.map(|ride| ride.speed_mm_s(share));
            let ramps_s = [0, 1].map(|i| speeds[i] / rides[i].accel_mm_s2);
            let paths_s = [0, 1].map(|i| rides[i].length_mm / speeds[i]);
            let longer_s = ramps_s[0].max(ramps_s[1]);
            (longer_s, paths_s[0].min(paths_s[1]), ramps_s[0], speeds[1])
        };
        let (longer_s, passed_s, own_s, _) = lasts_s(1.0);
        let at_largest_s = longer_s.min(passed_s).min(own_s);
        if longer_s <= passed_s || overlap_s < at_largest_s * (1.0 - ROUNDING) {
            // The tolerance may end it sooner, at any override.
            return tandem;
        }
        // With a knob for each, the second may be so slow that all of the first ramp is shared.
        tandem.longest_s = overlap_s.max(own_s);
        let mut shares_of = [0.0, 1.0];
        for _ in 0..HALVINGS {
            let middle = 0.5 * (shares_of[0] + shares_of[1]);
            let (longer_s, passed_s, ..) = lasts_s(middle);
            shares_of[usize::from(longer_s > passed_s)] = middle;
        }
        let longest = shares_of[1];
        let asked_mm_s = rides[1].asked_mm_s;
        let shares = speeds_mm_s(asked_mm_s).map(|speed| speed / asked_mm_s);
        for share in shares.take_while(|share| *share > longest).chain([longest]) {
            let (longer_s, passed_s, own_s, speed_mm_s) = lasts_s(share);
            let lower_s = longer_s.min(passed_s).min(own_s);
            if lower_s > overlap_s * (1.0 + ROUNDING) {
                let [first, next] = rides;
                let first = first.ramp(0.0, lower_s, false);
                let next = next.ramp(speed_mm_s, lower_s, true);
                tandem.slower.extend(shared([&first, &next], lower_s));
            }
        }
        tandem
    }

    /// The robust bound. Of `mv` only the switched loads are read.
    pub fn demand(&self, model: &PowerModel, mv: &Move) -> Demand {
        let most = |all: &[Extremes]| {
            let mut demand = Demand::NONE;
            for Extremes { bound, accel_mm_s2 } in all {
                demand.include(&model.robust(mv, bound, accel_mm_s2));
            }
            demand
        };
        let mut demand = most(&self.largest);
        if !self.slower.is_empty() {
            demand.include_slower(most(&self.slower));
        }
        demand
    }
}

/// The slices of the time that two rides share: the last `overlap_s` of the first.
fn shared(rides: [&Ride; 2], overlap_s: f64) -> impl Iterator<Item = Extremes> {
    let turns = rides.iter().any(|ride| ride.path.arc.is_some());
    let slices = if turns { SLICES } else { 1 };
    let at = move |slice: usize| overlap_s * slice as f64 / slices as f64;
    (0..slices).map(move |slice| extremes(rides, overlap_s, [at(slice), at(slice + 1)]))
}

/// The largest speeds and accelerations of the axes between two instants of the time
/// that they share.
fn extremes(rides: [&Ride; 2], overlap_s: f64, [from_s, to_s]: [f64; 2]) -> Extremes {
    let begins_s = [rides[0].duration_s() - overlap_s, 0.0];
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
    Extremes {
        bound,
        accel_mm_s2: accels,
    }
}
