//! The pieces of an arc between the quadrants of its circle, on which no axis
//! turns back.
//!
//! Input: an arc and a phase of its profile. Output: an iterator of times.

use super::arc_circle::Circle;
use gwatt_plan::{Phase, PhaseKind};
use std::f64::consts::FRAC_PI_2;

/// Pieces of a phase that are looked at one by one.
const PIECES: u32 = 1024;
/// Steps at most in the search for an instant.
const STEPS: u32 = 100;
/// Share of a quadrant by which rounding may miss its end.
const SNAP: f64 = 1e-9;

/// The pieces of a phase between quadrants, from its fast end; of a cruise,
/// the first turn. Yields start and end in s, and `true` where the rest of the
/// phase is given in one because there are too many.
pub(super) struct Pieces<'a> {
    phase: &'a Phase,
    /// The fast end is the last one.
    backwards: bool,
    /// Angle since the start of the move at the instants left to visit.
    angle: f64,
    /// Angle from the start of the move to the first quadrant of the circle.
    offset: f64,
    angle_per_mm: f64,
    /// What is left to visit, s.
    from: f64,
    to: f64,
    count: u32,
}

impl<'a> Pieces<'a> {
    /// The pieces of a phase of an arc.
    pub fn new(circle: &Circle<'_>, phase: &'a Phase) -> Self {
        let mut to = phase.duration_s;
        if phase.is_cruise() {
            to = to.min(circle.turn_s(phase));
        }
        let backwards = speeds_up(phase);
        let instant = if backwards { to } else { 0.0 };
        Self {
            phase,
            backwards,
            angle: circle.angle_per_mm * phase.state_at(instant).position_mm,
            offset: -circle.sense * circle.start_angle,
            angle_per_mm: circle.angle_per_mm,
            from: 0.0,
            to,
            count: 0,
        }
    }

    /// The instant at which the angle is reached, within what is left.
    fn instant(&self, angle: f64) -> f64 {
        let phase = self.phase;
        let (v, a) = (phase.velocity_mm_s, phase.accel_mm_s2);
        let position = angle / self.angle_per_mm;
        if phase.kind != PhaseKind::ConstantAcceleration {
            return time_at(phase, position, self.from, self.to);
        }
        let distance = (position - phase.position_mm).max(0.0);
        // distance = v·t + a·t²/2, without cancellation.
        let root = (v * v + 2.0 * a * distance).max(0.0).sqrt();
        let t = 2.0 * distance / (v + root);
        if t.is_nan() {
            self.from
        } else {
            t.clamp(self.from, self.to)
        }
    }
}

/// Whether the speed of a phase grows.
fn speeds_up(phase: &Phase) -> bool {
    match phase.kind {
        PhaseKind::ConstantAcceleration => phase.accel_mm_s2 > 0.0,
        _ => phase.end_velocity_mm_s > phase.velocity_mm_s,
    }
}

/// The instant between two at which a phase that runs forwards reaches a
/// position, or the nearest of both: by Newton's method, halving where it would
/// leave the bracket.
fn time_at(phase: &Phase, position_mm: f64, from: f64, to: f64) -> f64 {
    let (mut low, mut high) = (from, to);
    if phase.state_at(low).position_mm >= position_mm {
        return low;
    }
    if phase.state_at(high).position_mm <= position_mm {
        return high;
    }
    let mut t = 0.5 * (low + high);
    for _ in 0..STEPS {
        let state = phase.state_at(t);
        let beyond = state.position_mm - position_mm;
        if beyond > 0.0 {
            high = t;
        } else {
            low = t;
        }
        let step = beyond / state.velocity_mm_s;
        if step.abs() <= f64::EPSILON * to {
            break;
        }
        let newton = t - step;
        t = if newton > low && newton < high {
            newton
        } else {
            0.5 * (low + high)
        };
    }
    t
}

impl Iterator for Pieces<'_> {
    type Item = (f64, f64, bool);

    fn next(&mut self) -> Option<Self::Item> {
        let backwards = self.backwards;
        while self.from < self.to {
            self.count += 1;
            if self.count > PIECES {
                let rest = (self.from, self.to, true);
                self.from = self.to;
                return Some(rest);
            }
            let quadrant = (self.angle - self.offset) / FRAC_PI_2;
            let next = if backwards {
                (quadrant - SNAP).ceil() - 1.0
            } else {
                (quadrant + SNAP).floor() + 1.0
            };
            self.angle = next * FRAC_PI_2 + self.offset;
            let instant = self.instant(self.angle);
            let piece = if backwards {
                let piece = (instant, self.to, false);
                self.to = instant;
                piece
            } else {
                let piece = (self.from, instant, false);
                self.from = instant;
                piece
            };
            if piece.0 < piece.1 {
                return Some(piece);
            }
        }
        None
    }
}
