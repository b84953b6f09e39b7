//! The spindle under G96, which follows X.

use super::SpindleBus;
use crate::Assessment;
use crate::spindle_state::SpindleState;
use crate::surface_speed::{Speeds, Surface};
use gwatt_motion::{Move, MoveKind};
use gwatt_plan::{blended_speed, plan};

/// What following the surface takes during a move.
#[derive(Debug)]
pub(super) struct Followed {
    /// Largest and smallest power, W.
    pub(super) extremes: [f64; 2],
    /// The same at any override below the largest, where these count.
    pub(super) lower: Option<[f64; 2]>,
    /// Energy with and without what is fed back taken off, J.
    pub(super) energy_j: Option<[f64; 2]>,
    /// At 100 %: what it follows, and the speed at the end in 1/min.
    pub(super) surface: Option<(Surface, f64)>,
    /// At 100 %: the speed that it runs to, 1/min.
    pub(super) target: Option<f64>,
}

impl SpindleBus<'_> {
    /// Under G96 the spindle follows X: what that takes during a move.
    pub(super) fn follow_surface(
        &mut self,
        mv: &Move,
        assessment: &Assessment,
    ) -> Option<Followed> {
        let turns = self.direction != 0.0 && self.tap_rpm.is_none();
        let surface = self.surface.filter(|_| turns)?;
        let max = self.spindle.max_rpm;
        let of = |side: usize| {
            let factor = self.overrides[side].spindle;
            Surface {
                speed_mm_s: surface.speed_mm_s * factor,
                clamp_rpm: (surface.clamp_rpm * factor).min(max),
                sign: self.direction,
                ..surface
            }
        };
        let sides = [of(0), of(1)];
        let Some(speeds) = sides[0].speeds(mv) else {
            // Any speed up to the clamp.
            let clamp = sides[0].clamp_rpm * self.direction;
            let range = [clamp.min(0.0), clamp.max(0.0)];
            self.wander(range, clamp);
            let extremes = self.states[0].henceforth(&self.motor);
            self.states[1].pass([assessment.duration_s; 2]);
            return Some(Followed {
                extremes,
                lower: self.wandering(),
                energy_j: None,
                surface: None,
                target: None,
            });
        };
        let nominal = sides[1].speeds(mv)?;
        let same = |a: f64, b: f64| (a - b).abs() <= 1e-9 * a.abs().max(b.abs());
        let has =
            |state: &SpindleState, speed: f64| state.is_steady() && same(state.target(), speed);
        let top_mm_s = blended_speed(self.machine, mv, self.overrides[0]);
        if same(speeds.range[0], speeds.range[1]) && has(&self.states[0], speeds.end) {
            return self.follow_lower_alone(mv, &sides[0], &speeds, top_mm_s);
        }
        let follows = has(&self.states[0], speeds.start) && has(&self.states[1], nominal.start);
        let following = sides[0]
            .following(&self.motor, mv, top_mm_s)
            .filter(|_| follows);
        if let Some(extremes) = following {
            let planned = plan(self.machine, mv, self.overrides[1]);
            let energy_j = sides[1].energy(&self.motor.power, mv, &planned);
            self.states[0].follow(speeds.end);
            let lower = self.follow_lower(mv, &sides[0], &speeds, top_mm_s);
            self.states[1].follow(nominal.end);
            return Some(Followed {
                extremes,
                lower,
                energy_j: Some(energy_j),
                surface: Some((sides[1], nominal.end)),
                target: None,
            });
        }
        self.wander(speeds.range, speeds.end);
        self.states[1].command(&self.motor, nominal.end);
        let span = self.states[1].span(&self.motor, assessment.duration_s);
        self.states[1].pass([assessment.duration_s; 2]);
        Some(Followed {
            extremes: self.states[0].henceforth(&self.motor),
            lower: self.wandering(),
            energy_j: Some([span.energy_j, span.drawn_j]),
            surface: None,
            target: Some(nominal.end),
        })
    }

    /// At the largest overrides it stays at one speed, that of the clamp or where X rests; what
    /// it takes to follow X at lower ones, where these count and that may be.
    fn follow_lower_alone(
        &mut self,
        mv: &Move,
        surface: &Surface,
        speeds: &Speeds,
        top_mm_s: f64,
    ) -> Option<Followed> {
        if !mv.moving.contains(0) {
            return None;
        }
        let lower = self.follow_lower(mv, surface, speeds, top_mm_s)?;
        Some(Followed {
            extremes: [self.motor.holding_w(speeds.end); 2],
            lower: Some(lower),
            energy_j: None,
            surface: None,
            target: None,
        })
    }

    /// What it takes to follow X at overrides below the largest, where these count: the
    /// largest and the smallest power, W. Where the drive cannot follow there, or is still on
    /// a run, it may lag into the moves that come next.
    fn follow_lower(
        &mut self,
        mv: &Move,
        surface: &Surface,
        speeds: &Speeds,
        top_mm_s: f64,
    ) -> Option<[f64; 2]> {
        let most_rpm = self.unturned_clamp_rpm(self.surface.as_ref()?);
        let slower = self.slower.as_mut()?;
        let following = surface
            .following_lower(&self.motor, mv, top_mm_s, most_rpm)
            .filter(|_| slower.state.is_steady());
        if following.is_some() {
            slower.follow(speeds.end);
            return following;
        }
        self.wander_lower(speeds.range, speeds.end, most_rpm);
        self.wandering()
    }

    /// Largest and smallest power during a move that turns the spindle: one that follows the
    /// surface, and a tap, which reverses it.
    pub(super) fn covered(&self, mv: &Move, followed: Option<&Followed>) -> Option<[f64; 2]> {
        let tapping = (mv.kind == MoveKind::Tap).then(|| {
            let n = self.states[0].target().abs();
            self.motor.extremes(-n, n)
        });
        match (followed.map(|it| it.extremes), tapping) {
            (Some(one), Some(other)) => Some([one[0].max(other[0]), one[1].min(other[1])]),
            (one, other) => one.or(other),
        }
    }

    /// Somewhere between two speeds, and on the way to a target; turned down, at any lower
    /// one.
    pub(super) fn wander(&mut self, range: [f64; 2], target: f64) {
        self.states[0].wander(&self.motor, range, target);
        // Where the largest override is below 100 % it may have lowered the clamp.
        let most_rpm = self
            .surface
            .filter(|_| self.overrides[0].spindle < 1.0)
            .map(|surface| self.unturned_clamp_rpm(&surface));
        self.wander_lower(range, target, most_rpm.unwrap_or_default());
    }

    /// The same at lower overrides alone, where it may be as fast as `most_rpm`.
    fn wander_lower(&mut self, [low, high]: [f64; 2], target: f64, most_rpm: f64) {
        let Some(slower) = &mut self.slower else {
            return;
        };
        let most = most_rpm * self.direction;
        let range = [low.min(0.0).min(most), high.max(0.0).max(most)];
        slower.wander(&self.motor, range, target, self.surface.is_some());
    }

    /// What the spindle may ask for at lower overrides while it wanders, W.
    fn wandering(&self) -> Option<[f64; 2]> {
        let slower = self.slower.as_ref()?;
        Some(slower.henceforth(&self.motor))
    }

    /// The clamp where overrides do not lower it, 1/min.
    fn unturned_clamp_rpm(&self, surface: &Surface) -> f64 {
        let factor = self.overrides[0].spindle.max(1.0);
        (surface.clamp_rpm * factor).min(self.spindle.max_rpm)
    }
}
