//! From a speed and an acceleration up to a rest: with jerk +J until the
//! envelope is met, then along it.
//!
//! The curve has three phases where the limit of the acceleration is met and
//! two where the landing is met first; falling limits add rides along them.

use super::cell::{Cell, bisect, cells};
use super::envelope::{Bound, Stretch, envelope};
use super::limits::Limits;
use super::phase::{Law, Motion, RampPhase, ride_time};

/// Share of the largest acceleration below which a speed counts as out of reach:
/// it would be approached for ever.
const REACH: f64 = 1e-6;
/// Steps within one stretch: enter, leave and meet it again.
const STEPS: u32 = 6;
/// Numbers this near each other differ by rounding.
const ROUNDING: f64 = 1e-13;

/// A climb to a target above.
#[derive(Debug)]
pub(super) struct Climb {
    /// Its phases.
    pub phases: Vec<RampPhase>,
    /// The lowest speed on the way.
    pub lowest: f64,
    /// Where it ends: the target, or the last speed that can be reached.
    pub top: f64,
    speed: f64,
    accel: f64,
    /// Share of the jerk limit that may be added to land exactly.
    spare: f64,
}

/// Rounding of `a²` at a speed: what neighbouring numbers of it make.
pub(super) fn rounding(jerk: f64, speed: f64, target: f64, w: f64) -> f64 {
    64.0 * f64::EPSILON * jerk * (speed.abs() + target.abs()) + ROUNDING * w
}

impl Climb {
    /// The climb from `start` to `target`, which lies above the speed at which
    /// a negative acceleration comes to zero.
    pub fn new(start: Motion, target: f64, limits: &Limits) -> Self {
        let mut climb = Self {
            phases: Vec::new(),
            lowest: start.speed,
            top: target,
            speed: start.speed,
            accel: start.accel,
            spare: 0.5 * limits.jerk.spare(),
        };
        if limits.jerk.is_unlimited() {
            climb.accel = 0.0;
        } else if climb.accel < 0.0 {
            climb.turn(limits);
        }
        climb.lowest = climb.lowest.min(climb.speed);
        if climb.speed >= target {
            climb.land(limits, target);
            return climb;
        }
        let mut cells = cells(limits, climb.speed, target);
        climb.top = cut_to_reach(&mut cells, climb.speed, target);
        if limits.jerk.is_unlimited() {
            for cell in &cells {
                climb.ride(cell, cell.high);
            }
        } else {
            for stretch in envelope(&cells) {
                for _ in 0..STEPS {
                    if climb.speed >= stretch.cell.high || !climb.step(&stretch) {
                        break;
                    }
                }
            }
            climb.land(limits, climb.top);
        }
        climb.arrive(limits.jerk.is_unlimited());
        climb
    }

    /// Takes a negative acceleration to zero.
    fn turn(&mut self, limits: &Limits) {
        // The speed cannot fall further than at the smallest jerk.
        let w = self.accel * self.accel;
        let low = self.speed - w / (2.0 * limits.jerk.smallest());
        for cell in cells(limits, low, self.speed).iter().rev() {
            let w = self.accel * self.accel;
            let left = w - 2.0 * cell.jerk * (self.speed - cell.low);
            if left <= 0.0 {
                self.jerk(cell.jerk, self.speed - w / (2.0 * cell.jerk), 0.0);
                return;
            }
            self.jerk(cell.jerk, cell.low, -left.sqrt());
        }
        // So little is left that the speed does not change.
        self.jerk(limits.jerk.at(self.speed), self.speed, 0.0);
    }

    /// One phase on a stretch; false when there is none.
    fn step(&mut self, stretch: &Stretch) -> bool {
        let Stretch { cell, bound } = *stretch;
        let (v, j2) = (self.speed, 2.0 * cell.jerk);
        let (w, bounded) = (self.accel * self.accel, stretch.w(v));
        let near = rounding(cell.jerk, v, self.top, w.max(bounded));
        if w > bounded + near {
            self.come_down(stretch, w);
        } else if w < bounded - near {
            self.rise(stretch, w, bounded);
        } else {
            match bound {
                Bound::Line(end) => {
                    // Takes up what rounding has left.
                    let exact = (w - end) / (2.0 * (cell.high - v));
                    let most = cell.jerk * (1.0 + self.spare);
                    self.jerk(-exact.max(cell.jerk).min(most), cell.high, end.sqrt());
                }
                Bound::Curve if cell.slope_w(v) >= j2 => {
                    // The limit rises faster than the jerk lets the acceleration.
                    let end = w + j2 * (cell.high - v);
                    self.jerk(cell.jerk, cell.high, end.sqrt());
                }
                Bound::Curve => self.ride(&cell, cell.where_slope(j2, v, cell.high)),
            }
        }
        self.speed > v
    }

    /// From above the envelope with −J down to it.
    fn come_down(&mut self, stretch: &Stretch, w: f64) {
        let Stretch { cell, bound } = *stretch;
        let (v, j2) = (self.speed, 2.0 * cell.jerk);
        let line = |x: f64| w - j2 * (x - v);
        let meets = match bound {
            Bound::Line(_) => cell.high,
            Bound::Curve if cell.is_constant() => v + (w - cell.w(v)) / j2,
            Bound::Curve if line(cell.high) > cell.w(cell.high) => cell.high,
            Bound::Curve => bisect(v, cell.high, |x| line(x) <= cell.w(x)),
        };
        if meets < cell.high {
            self.jerk(-cell.jerk, meets, cell.accel(meets));
        } else {
            self.jerk(-cell.jerk, cell.high, line(cell.high).max(0.0).sqrt());
        }
    }

    /// From below the envelope with +J up to it.
    fn rise(&mut self, stretch: &Stretch, w: f64, bounded: f64) {
        let Stretch { cell, bound } = *stretch;
        let (v, j2) = (self.speed, 2.0 * cell.jerk);
        let line = |x: f64| w + j2 * (x - v);
        let (meets, top) = match bound {
            Bound::Line(_) => (v + (bounded - w) / (2.0 * j2), (0.5 * (w + bounded)).sqrt()),
            Bound::Curve if cell.is_constant() => (v + (bounded - w) / j2, bounded.sqrt()),
            Bound::Curve => {
                let peak = cell.where_slope(j2, v, cell.high);
                if line(peak) >= cell.w(peak) {
                    let meets = bisect(v, peak, |x| line(x) >= cell.w(x));
                    (meets, cell.accel(meets))
                } else {
                    (f64::INFINITY, 0.0)
                }
            }
        };
        if meets < cell.high {
            self.jerk(cell.jerk, meets, top);
        } else {
            self.jerk(cell.jerk, cell.high, line(cell.high).sqrt());
        }
    }

    /// What rounding has left of the landing.
    fn land(&mut self, limits: &Limits, target: f64) {
        if self.accel > 0.0 {
            let jerk = limits.jerk.at(self.speed);
            self.jerk(-jerk, target, 0.0);
        }
    }

    /// The end is the target exactly. Without a limit of the jerk the
    /// acceleration ends there with a step.
    fn arrive(&mut self, with_a_step: bool) {
        if let Some(last) = self.phases.last_mut() {
            last.end.speed = self.top;
            if !with_a_step {
                last.end.accel = 0.0;
            }
        }
    }

    /// A phase of constant jerk to this speed and acceleration.
    fn jerk(&mut self, jerk: f64, speed: f64, accel: f64) {
        self.push(Law::Jerk(jerk), (accel - self.accel) / jerk, speed, accel);
    }

    /// A phase along a cell's limit.
    fn ride(&mut self, cell: &Cell, speed: f64) {
        self.accel = cell.accel(self.speed);
        let duration = ride_time(&cell.law, self.speed.abs(), speed.abs());
        if cell.is_constant() {
            let duration = (speed - self.speed) / self.accel;
            self.push(Law::Jerk(0.0), duration, speed, self.accel);
        } else {
            let law = Law::Curve(cell.law, 1.0);
            self.push(law, duration, speed, cell.accel(speed));
        }
    }

    fn push(&mut self, law: Law, duration: f64, speed: f64, accel: f64) {
        if duration > 0.0 {
            self.phases.push(RampPhase {
                law,
                duration_s: duration,
                start: Motion {
                    speed: self.speed,
                    accel: self.accel,
                },
                end: Motion { speed, accel },
            });
        }
        self.speed = speed;
        self.accel = accel;
    }
}

/// Cuts off the cells in which no acceleration is left; gives the last speed
/// that is reached.
fn cut_to_reach(cells: &mut Vec<Cell>, from: f64, target: f64) -> f64 {
    let ends = |cell: &Cell| cell.accel(cell.low).max(cell.accel(cell.high));
    let floor = REACH * cells.iter().map(ends).fold(0.0, f64::max);
    for (index, cell) in cells.iter_mut().enumerate() {
        let starved = |v: f64| cell.accel(v) <= floor;
        if !starved(cell.low) && !starved(cell.high) {
            continue;
        }
        let reach = if starved(cell.low) {
            cell.low
        } else {
            bisect(cell.low, cell.high, starved).next_down()
        };
        cell.high = reach;
        let kept = if cell.low < reach { index + 1 } else { index };
        cells.truncate(kept);
        return reach.max(from);
    }
    target
}
