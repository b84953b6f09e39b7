//! Moves over which the motion keeps its speed.
//!
//! Input: moves in program order. Output: the same as by way of the planner, at a
//! small part of its cost. A joint is passed at the full speed v if the rules
//! permit that and the path behind it is long enough to brake, Σ 2·a·L ≥ v², with
//! no more blocks than the controller sees. What is not final when that ends is
//! given to the planner.

use super::Ahead;
use crate::interpret::{Move, MoveKind};
use crate::machine::{AxisSet, LookAhead, Machine, PathMode};
use crate::plan::Overrides;
use crate::plan::lookahead::{Gliding, Passage};
use crate::power::demand::Want;
use crate::power::eye::Eye;
use crate::power::model::PowerModel;

const LINEAR: usize = 3;
/// What rounding may make of the sum, as a share.
const ROUNDING: f64 = 1e-6;

/// What is known of gliding beforehand, and how far it has come.
#[derive(Debug)]
pub(super) struct Glider {
    /// The axes that glide: those of X, Y and Z.
    axes: AxisSet,
    /// Speed that each of them permits, whatever the direction, mm/s.
    speed_mm_s: f64,
    /// Override of feeds.
    feed: f64,
    /// The rules' own limit along any path, mm/s².
    path_accel_mm_s2: f64,
    /// Moves that may be open.
    blocks: usize,
    /// Moves that pass before it is worth another look.
    pause: usize,
    /// The planner does not know of the last moves.
    glide: Option<Glide>,
}

/// Where a motion glides.
#[derive(Debug)]
struct Glide {
    /// Of F, mm/s.
    feed_mm_s: f64,
    /// The same under the override.
    speed_mm_s: f64,
    /// Of the last move.
    direction: [f64; LINEAR],
    /// The first move that is not final.
    first: u64,
    /// Σ 2·a·L of those behind it, at least.
    ramp2: f64,
}

impl Glider {
    /// `blocks`: moves that may be open; 0: nothing glides.
    pub fn new(machine: &Machine, rules: &LookAhead, overrides: Overrides, blocks: usize) -> Self {
        let mut glider = Self {
            axes: AxisSet::default(),
            speed_mm_s: f64::INFINITY,
            feed: overrides.feed,
            path_accel_mm_s2: rules.path_accel_mm_s2,
            blocks,
            pause: 0,
            glide: None,
        };
        if blocks > 0 && machine.force_curves.is_empty() {
            for (index, axis) in machine.axes.iter().take(LINEAR).enumerate() {
                let Some(axis) = axis else { continue };
                glider.axes.insert(index);
                glider.speed_mm_s = glider.speed_mm_s.min(axis.rapid_mm_s);
            }
        }
        glider
    }

    /// Whether a move may glide at some speed: a straight feed.
    #[inline]
    fn suits(&self, mv: &Move) -> bool {
        mv.kind == MoveKind::Feed
            && mv.moving.0 & !self.axes.0 == 0
            && mv.length_mm > 0.0
            && mv.arc.is_none()
            && mv.unknown_start.is_empty()
    }

    /// The lowest acceleration of some axes of a move, and along its path.
    #[inline]
    fn least_accel_mm_s2(&self, mv: &Move, axes: AxisSet) -> f64 {
        let limits = axes.iter().filter_map(|axis| mv.accel_mm_s2.get(axis));
        let along = mv.path_accel_mm_s2.min(self.path_accel_mm_s2);
        limits.fold(
            along,
            |least, accel| {
                if *accel < least { *accel } else { least }
            },
        )
    }
}

/// Whether nothing but the time and the largest speed of a move at one speed is
/// of interest.
#[inline]
fn is_plain(model: &PowerModel, mv: &Move, speed_mm_s: f64, want: Want) -> bool {
    !want.energy && model.is_below_floor(mv, [speed_mm_s, 0.0], want)
}

impl Ahead {
    /// Adds a move where the motion glides on to it, nothing is in doubt, and the
    /// peaks are of no interest; false, and nothing done, otherwise.
    #[inline]
    pub(super) fn glide(
        &mut self,
        model: &PowerModel,
        eye: &Eye,
        mv: &Move,
        text: &[u8],
        want: Want,
    ) -> bool {
        let doubtful = self.in_doubt || self.reach2.is_some();
        if doubtful || want.accel || !eye.is_closed() || !self.glider.suits(mv) {
            return false;
        }
        if self.glider.glide.is_none() {
            if self.glider.pause > 0 {
                self.glider.pause -= 1;
                return false;
            }
            match self.begin_gliding(model) {
                Ok(glide) => self.glider.glide = Some(glide),
                Err(pause) => {
                    self.glider.pause = pause;
                    return false;
                }
            }
        }
        let (Some(glide), Some(last)) = (&self.glider.glide, self.open.back()) else {
            return false;
        };
        let first = glide.first.saturating_sub(self.first) as usize;
        if self.open.len().saturating_sub(first) > self.glider.blocks {
            self.glider.pause = self.glider.blocks;
            return false;
        }
        let mut w = [0.0; LINEAR];
        for axis in mv.moving.iter() {
            if let Some(change) = w.get_mut(axis) {
                *change = (mv.end[axis] - mv.start[axis]) / mv.length_mm;
            }
        }
        let axes = AxisSet(mv.moving.0 | last.mv.moving.0);
        let passage = Passage {
            accel_mm_s2: self.glider.least_accel_mm_s2(mv, axes),
            length_mm: mv.length_mm,
            speed2: glide.speed_mm_s * glide.speed_mm_s,
        };
        let glides = glide.feed_mm_s == mv.feed_mm_s
            && last.mv.path_mode == PathMode::LookAhead
            && self.largest.planner.permits(&glide.direction, &w, &passage)
            && is_plain(model, mv, glide.speed_mm_s, want);
        if !glides {
            return false;
        }
        let speed_mm_s = glide.speed_mm_s;
        let ramp2 = 2.0 * passage.accel_mm_s2 * mv.length_mm;
        if let Some(glide) = &mut self.glider.glide {
            glide.direction = w;
            glide.ramp2 += ramp2;
        }
        let mut open = self.room(mv, text, want);
        open.assessment.speed_mm_s = speed_mm_s;
        open.ramp2 = ramp2;
        open.moves = true;
        open.rests = mv.path_mode == PathMode::ExactStop;
        self.open.push_back(open);
        self.count_gliding();
        true
    }

    /// How the motion glides over the moves that are open; otherwise, how many of
    /// them must pass before it may.
    fn begin_gliding(&mut self, model: &PowerModel) -> Result<Glide, usize> {
        let Gliding {
            first: number,
            open,
            speed2,
            direction,
        } = self.largest.planner.gliding()?;
        let first = number.checked_sub(self.first).ok_or(open)? as usize;
        if self.open.len().checked_sub(first) != Some(open) || open > self.glider.blocks {
            // Pieces of arcs, or a path that is too short to brake on.
            return Err(open);
        }
        let feed_mm_s = self.open.back().ok_or(0_usize)?.mv.feed_mm_s;
        let speed_mm_s = feed_mm_s * self.glider.feed;
        if speed_mm_s * speed_mm_s != speed2 || speed_mm_s > self.glider.speed_mm_s {
            return Err(open);
        }
        let mut ramp2 = 0.0;
        for (index, open) in self.open.iter_mut().skip(first).enumerate() {
            let glides = self.glider.suits(&open.mv)
                && open.mv.feed_mm_s == feed_mm_s
                && !open.in_doubt
                && is_plain(model, &open.mv, speed_mm_s, open.want);
            if !glides {
                return Err(index + 1);
            }
            let accel_mm_s2 = self.glider.least_accel_mm_s2(&open.mv, open.mv.moving);
            open.ramp2 = 2.0 * accel_mm_s2 * open.mv.length_mm;
            ramp2 += if index > 0 { open.ramp2 } else { 0.0 };
        }
        Ok(Glide {
            feed_mm_s,
            speed_mm_s,
            direction,
            first: number,
            ramp2,
        })
    }

    /// Counts the moves that are final.
    #[inline]
    fn count_gliding(&mut self) {
        let Some(glide) = &mut self.glider.glide else {
            return;
        };
        let needed2 = glide.speed_mm_s * glide.speed_mm_s * (1.0 + ROUNDING);
        while glide.ramp2 >= needed2 {
            let index = glide.first.saturating_sub(self.first) as usize;
            let Some(open) = self.open.get_mut(index) else {
                break;
            };
            let duration_s = open.mv.length_mm / glide.speed_mm_s;
            open.alone = false;
            open.assessment.duration_s += duration_s;
            open.assessment.fastest_s += duration_s;
            open.assessment.top_speed_mm_s = glide.speed_mm_s;
            self.largest.next = glide.first;
            glide.first += 1;
            let Some(next) = self.open.get(index + 1) else {
                break;
            };
            glide.ramp2 -= next.ramp2;
        }
    }

    /// Tells the planner of the moves since it was left alone.
    #[inline]
    pub(super) fn catch_up(&mut self, machine: &Machine) {
        if let Some(glide) = self.glider.glide.take() {
            self.end_gliding(machine, &glide);
        }
    }

    fn end_gliding(&mut self, machine: &Machine, glide: &Glide) {
        let side = &mut self.largest;
        let first = glide.first.saturating_sub(self.first) as usize;
        for (index, open) in self.open.iter().enumerate().skip(first) {
            // All have a path: their lengths and their limits are above 0.
            if !side.describe(machine, &open.mv, self.first + index as u64) {
                continue;
            }
            if index == first {
                let speed2 = glide.speed_mm_s * glide.speed_mm_s;
                side.planner.glide_to(&side.element, speed2);
            } else {
                side.planner.push(&side.element);
            }
        }
    }
}
