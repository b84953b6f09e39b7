//! The planned motion of all axes over time.
//!
//! Input: plans and pieces of plans. Output: pieces of motion, and the instants
//! at which their laws change.

use super::blend::{cuts, pieces};
use super::piece::straight_line;
use gwatt_machine::AXES;
use gwatt_motion::Move;
use gwatt_plan::lookahead::{Piece, Planned};
use gwatt_plan::{Blend, Phase, Plan, Profile, Trajectory, UnknownMotion};
use std::f64::consts::FRAC_PI_2;

/// Instants at which the axes of one arc may turn back that are looked at.
const QUADRANTS: f64 = 4096.0;
/// A quadrant nearer than this to the end of a phase is that end but for rounding, rad:
/// the piece between them would last no time.
const APART: f64 = 1e-9;
/// Rounding of a difference of instants, as a share.
const ROUNDING: f64 = 1e-12;
/// Halvings that locate an instant.
const HALVINGS: u32 = 60;

/// A piece of motion.
#[derive(Debug, Clone, PartialEq)]
pub struct Motion {
    /// The move that it belongs to.
    pub mv: Move,
    /// How long it runs already while the motion before it comes to rest, s.
    pub overlap_s: f64,
    /// The part of the course that it is, s.
    pub(super) from_s: f64,
    to_s: f64,
    pub(super) course: Course,
}

/// How the axes move.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Course {
    /// Not, for so many s.
    Rest(f64),
    /// Along the path of the move.
    Path(Vec<Phase>),
    /// Along a line that begins where the last motion ends.
    Line(Vec<Phase>),
    /// Round a corner, from where the last motion ends.
    Blend(Blend, Vec<Phase>),
    /// Each axis for itself.
    Axes(Vec<(usize, Vec<Phase>)>),
    /// Two motions at once: the speeds of each axis add up.
    Both(Box<[Motion; 2]>),
    /// From an unknown start: no more is known than bounds.
    Unknown(Box<Bounds>),
}

/// What is known of a motion from an unknown start.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Bounds {
    pub most: UnknownMotion,
    /// The largest speed along the path.
    pub speed_mm_s: f64,
    duration_s: f64,
}

impl Motion {
    /// The motion of a planned move; `None` where it never ends.
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
            Trajectory::Unknown(motion) if plan.duration_s.is_finite() => {
                let most = UnknownMotion::clone(motion);
                let (speed_mm_s, duration_s) = (plan.speed_limit_mm_s, plan.duration_s);
                Course::Unknown(Box::new(Bounds {
                    most,
                    speed_mm_s,
                    duration_s,
                }))
            }
            Trajectory::Rest | Trajectory::Unknown(_) => return None,
        };
        Some(Self::new(mv.clone(), course))
    }

    /// The axes stand, in place of `mv`.
    pub(super) fn rest(mv: Move, duration_s: f64) -> Self {
        Self::new(mv, Course::Rest(duration_s))
    }

    fn new(mv: Move, course: Course) -> Self {
        let lasts_s = course.switches_s().last().copied();
        Self {
            mv,
            overlap_s: 0.0,
            from_s: 0.0,
            to_s: lasts_s.unwrap_or(0.0),
            course,
        }
    }

    /// The motion of a piece of a plan, which belongs to `mv`.
    #[must_use]
    pub(super) fn of_piece(mv: &Move, planned: &Planned<u64>) -> Self {
        let mut profile = planned.profile();
        let (mv, course) = match &planned.piece {
            Piece::Along { from_mm, .. } => {
                for phase in &mut profile.phases {
                    phase.position_mm += from_mm;
                }
                (mv.clone(), Course::Path(along(mv, &profile)))
            }
            Piece::Joined { direction } => {
                let line = straight_line(mv, direction, planned.length_mm);
                (line, Course::Line(profile.phases.to_vec()))
            }
            Piece::Blend(blend) => {
                let cuts = cuts(blend);
                let phases = profile.phases.iter();
                let phases = phases.flat_map(|phase| pieces(phase, &cuts));
                let lead = straight_line(mv, &blend.tangent, 1.0);
                (lead, Course::Blend(*blend, phases.collect()))
            }
        };
        Self {
            overlap_s: planned.overlap_s,
            ..Self::new(mv, course)
        }
    }

    /// This motion and the next one, which may begin before this one ends: one
    /// after the other, with what they do at once between them. Of this one
    /// `done_s` seconds are over.
    #[must_use]
    pub fn followed_by(self, next: Self, done_s: f64) -> Vec<Self> {
        let lasts_s = self.duration_s();
        let overlap_s = next.overlap_s.min(lasts_s - done_s);
        if overlap_s <= 0.0 {
            return vec![self, next];
        }
        let at_s = lasts_s - overlap_s;
        let both_s = overlap_s.min(next.duration_s());
        let both = [self.part(at_s, at_s + both_s), next.part(0.0, both_s)];
        let together = Self::new(self.mv.clone(), Course::Both(Box::new(both)));
        let first = self.part(0.0, at_s);
        let rest = [
            self.part(at_s + both_s, lasts_s),
            next.part(both_s, next.duration_s()),
        ];
        let parts = [first, together].into_iter().chain(rest);
        // What rounding leaves of a part is none.
        let least_s = ROUNDING * lasts_s.max(1.0);
        parts.filter(|part| part.duration_s() > least_s).collect()
    }

    /// The part between two of its instants.
    fn part(&self, from_s: f64, to_s: f64) -> Self {
        Self {
            overlap_s: 0.0,
            from_s: self.from_s + from_s,
            to_s: self.to_s.min(self.from_s + to_s),
            ..self.clone()
        }
    }

    /// Its two halves, the second of which belongs to `next`.
    pub(super) fn halves(self, next: &Move) -> [Self; 2] {
        let half_s = 0.5 * self.duration_s();
        let mut second = self.part(half_s, 2.0 * half_s);
        second.mv.line = next.line;
        second.mv.text = next.text;
        second.mv.loads = next.loads;
        let first = Self {
            to_s: self.from_s + half_s,
            ..self
        };
        [first, second]
    }

    /// How long it lasts, s.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        (self.to_s - self.from_s).max(0.0)
    }

    /// Instants at which an acceleration may jump, from 0 to the end, s.
    #[must_use]
    pub fn switches_s(&self) -> Vec<f64> {
        let inside = |t: &f64| *t > self.from_s && *t < self.to_s;
        let mut switches = vec![0.0];
        let own = self.course.switches_s().into_iter().filter(inside);
        switches.extend(own.map(|t| t - self.from_s));
        switches.push(self.duration_s());
        switches.dedup();
        if matches!(self.course, Course::Both(_)) {
            let pairs = switches.windows(2);
            let turns: Vec<f64> = pairs.flat_map(|pair| self.turns_s(pair)).collect();
            switches.extend(turns);
            switches.sort_by(f64::total_cmp);
            switches.dedup();
        }
        switches
    }

    /// Where axes turn back between two switches, s: two speeds that add up may do so
    /// at any time.
    fn turns_s(&self, pair: &[f64]) -> Vec<f64> {
        let [from, to] = *pair else {
            return Vec::new();
        };
        let inside = 0.5 * (from + to);
        let turn = |axis: usize| {
            let speed = |t: f64| self.axis(axis, [t, inside]).map(|[(speed, _), _]| speed);
            let first = speed(from)?;
            if first * speed(to)? >= 0.0 {
                return None;
            }
            let (mut low, mut high) = (from, to);
            for _ in 0..HALVINGS {
                let middle = 0.5 * (low + high);
                if first * speed(middle)? > 0.0 {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            Some(high)
        };
        (0..AXES).filter_map(turn).collect()
    }
}

impl Course {
    /// Instants at which an acceleration may jump, from 0 to the end, s.
    fn switches_s(&self) -> Vec<f64> {
        let ends = |phases: &[Phase]| {
            let mut end = 0.0;
            let ends = phases.iter().map(|phase| {
                end += phase.duration_s;
                end
            });
            ends.collect::<Vec<f64>>()
        };
        let mut switches = match self {
            Self::Rest(duration_s) => vec![*duration_s],
            Self::Unknown(bounds) => vec![bounds.duration_s],
            Self::Path(phases) | Self::Line(phases) | Self::Blend(_, phases) => ends(phases),
            Self::Axes(axes) => axes.iter().flat_map(|(_, phases)| ends(phases)).collect(),
            Self::Both(both) => both.iter().flat_map(Motion::switches_s).collect(),
        };
        switches.push(0.0);
        switches.sort_by(f64::total_cmp);
        switches.dedup();
        switches
    }
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
    let apart_mm = APART * mm_per_rad;
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
            let inside_mm = at_mm - phase.position_mm;
            if inside_mm >= phase.length_mm() - apart_mm {
                break;
            }
            let pieces = pieces(&rest, &[at_mm]);
            if inside_mm > apart_mm
                && let [before, after] = pieces.as_slice()
            {
                cut.push(*before);
                rest = *after;
            }
            step += 1.0;
        }
        cut.push(rest);
    }
    cut
}
