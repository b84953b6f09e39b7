//! Moves over which the motion keeps its speed.
//!
//! Input: moves in program order. Output: the same as by way of the planner, at a
//! small part of its cost. A joint is passed at the full speed v if the rules
//! permit that and the path after it is long enough to brake, Σ 2·a·L ≥ v², with
//! no more blocks than the controller sees. What is not final when that ends is
//! given to the planner.

mod glider;
mod terms;

use super::Ahead;
use super::glided::Glided;
use super::joints::glide_over;
use super::open::Open;
use super::pace::Pace;
use super::surges::Surges;
use crate::demand::Want;
use crate::model::PowerModel;
use crate::observer::Observer;
use glider::Glide;
pub(super) use glider::Glider;
use gwatt_machine::{AxisSet, Machine};
use gwatt_motion::Move;
use gwatt_plan::lookahead::{Gliding, Line};
use terms::lower;

/// What rounding may make of the sum, as a share.
const ROUNDING: f64 = 1e-6;

/// Whether nothing but the time and the largest speed of a move is of interest,
/// which has this speed all along.
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
        observer: &mut Observer,
        mv: &Move,
        text: &[u8],
        want: Want,
    ) -> bool {
        let doubtful = self.in_doubt || self.reach2.is_some();
        if doubtful || want.accel || !observer.is_closed() || !self.glider.terms.suit(mv) {
            return false;
        }
        if self.glider.glide.is_none() {
            if self.glider.wait > 0 {
                self.glider.wait -= 1;
                return false;
            }
            self.glider.glide = self.begin_gliding(model, observer);
        }
        let Some(speed_mm_s) = self.glide_on(model, mv) else {
            self.glider.back_off();
            return false;
        };
        let pace = self.open.back().map(|last| Pace {
            own2: 0.0,
            ..last.pace
        });
        let open = self.open.push(mv, text, want);
        open.assessment.speed_mm_s = speed_mm_s;
        open.moves = true;
        // The same speed is asked for; how far it reaches matters when this ends.
        open.pace = pace.unwrap_or_default();
        self.count_gliding(model);
        true
    }

    /// Glides through the joint before a move; gives the speed, mm/s.
    #[inline]
    fn glide_on(&mut self, model: &PowerModel, mv: &Move) -> Option<f64> {
        let Glider { terms, glide, .. } = &mut self.glider;
        let glide = glide.as_mut()?;
        let number = self.open.end();
        if number.checked_sub(glide.first)? > terms.blocks || glide.feed_mm_s != mv.feed_mm_s {
            return None;
        }
        let last = self.open.back_mut()?;
        let axes = AxisSet(mv.moving.0 | last.mv.moving.0);
        let [one, other] = &mut glide.lines;
        let (before, line) = if glide.last == 0 {
            (one, other)
        } else {
            (other, one)
        };
        if !terms.describe(line, mv, axes, glide.speed_mm_s) {
            return None;
        }
        let planner = &self.largest.planner;
        if !planner.passes(before, line, glide.speed_mm_s)
            || !is_plain(model, &last.mv, glide.speed_mm_s, last.want)
        {
            return None;
        }
        let least_mm_s2 = lower(before.least_accel_mm_s2, line.least_accel_mm_s2);
        let ramp2 = 2.0 * planner.accel_share() * least_mm_s2 * before.length_mm;
        let length_mm = before.length_mm;
        last.glided = Glided { length_mm, ramp2 };
        if glide.first + 1 < number {
            glide.ramp2 += ramp2;
        }
        glide.last ^= 1;
        Some(glide.speed_mm_s)
    }

    /// How the motion glides over the moves that are open, if it does.
    fn begin_gliding(&mut self, model: &PowerModel, observer: &mut Observer) -> Option<Glide> {
        self.largest.planner.settle();
        self.pump(model, observer);
        // What has become final may have left a doubt.
        if self.steps.is_doubtful() || self.reach2.is_some() {
            return None;
        }
        let planner = &self.largest.planner;
        let accel_share = planner.accel_share();
        let Gliding {
            first,
            open,
            speed2,
        } = planner.gliding()?;
        let terms = &self.glider.terms;
        if self.open.end().checked_sub(first) != Some(open as u64) || open as u64 > terms.blocks {
            // Pieces of arcs, or a path that is too short to brake on.
            return None;
        }
        let feed_mm_s = self.open.back()?.mv.feed_mm_s;
        let speed_mm_s = feed_mm_s * terms.feed;
        if speed_mm_s * speed_mm_s != speed2 {
            return None;
        }
        // Where rapids and feeds meet, another rapid override speeds the feed up.
        let one = |surges: &Surges| surges.are_one(false, speed2);
        if !self.surges.as_ref().is_none_or(one) {
            return None;
        }
        let (mut ramp2, mut line) = (0.0, Line::default());
        for index in 0..open {
            let each = self.open.get_mut(first + index as u64)?;
            let glides = terms.suit(&each.mv)
                && each.mv.feed_mm_s == feed_mm_s
                && each.certain
                && !each.in_doubt
                && is_plain(model, &each.mv, speed_mm_s, each.want)
                && terms.describe(&mut line, &each.mv, each.mv.moving, speed_mm_s);
            if !glides {
                return None;
            }
            if index + 1 < open {
                each.glided = Glided::whole(&line, accel_share);
                ramp2 += if index > 0 { each.glided.ramp2 } else { 0.0 };
            }
        }
        Some(Glide {
            feed_mm_s,
            speed_mm_s,
            s_per_mm: 1.0 / speed_mm_s,
            lines: [line; 2],
            last: 0,
            begun: first,
            first,
            ramp2,
        })
    }

    /// Counts the moves that are final.
    #[inline]
    fn count_gliding(&mut self, model: &PowerModel) {
        let Some(glide) = &mut self.glider.glide else {
            return;
        };
        let needed2 = glide.speed_mm_s * glide.speed_mm_s * (1.0 + ROUNDING);
        while glide.ramp2 >= needed2 {
            let Some(open) = self.open.get_mut(glide.first) else {
                break;
            };
            let duration_s = open.glided.length_mm * glide.s_per_mm;
            open.glides_for(duration_s, glide.speed_mm_s);
            self.largest.next = glide.first;
            self.glider.pause = 1;
            let glides = [duration_s, glide.speed_mm_s];
            glide_over(&mut self.steps, &mut self.open, model, glide.first, glides);
            glide.first += 1;
            let Some(next) = self.open.get_mut(glide.first) else {
                break;
            };
            glide.ramp2 -= next.glided.ramp2;
        }
    }

    /// Passes the planner the moves since it was left alone.
    #[inline]
    pub(super) fn catch_up(&mut self, machine: &Machine) {
        if let Some(glide) = self.glider.glide.take() {
            self.end_gliding(machine, &glide);
        }
    }

    fn end_gliding(&mut self, machine: &Machine, glide: &Glide) {
        let side = &mut self.largest;
        let speed2 = glide.speed_mm_s * glide.speed_mm_s;
        for number in glide.first..self.open.end() {
            let open = self.open.get(number);
            // All have a path: their lengths and their limits are above 0.
            if !open.is_some_and(|open| side.describe(machine, &open.mv, number)) {
                continue;
            }
            if let (Some(surges), Some(open)) = (&mut self.surges, self.open.get_mut(number))
                && open.pace.own2 == 0.0
            {
                open.pace = surges.push(number, &side.element);
            }
            if number == glide.first {
                side.planner.glide_to(&side.element, speed2);
            } else {
                side.planner.push(&side.element);
            }
        }
    }
}

impl Open {
    /// Counts a time at a constant speed, which it does not begin or end at rest.
    #[inline]
    fn glides_for(&mut self, duration_s: f64, speed_mm_s: f64) {
        let assessment = &mut self.assessment;
        self.alone = false;
        assessment.duration_s += duration_s;
        assessment.fastest_s += duration_s;
        if assessment.top_speed_mm_s < speed_mm_s {
            assessment.top_speed_mm_s = speed_mm_s;
        }
    }
}
