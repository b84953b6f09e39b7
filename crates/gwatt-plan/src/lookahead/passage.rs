//! Whether a joint of two lines may be passed at a speed: a quick answer, which may
//! be no where the rules of `corner` say yes, never the other way round.

use std::f64::consts::SQRT_2;

use super::super::axis_limits::lower;
use super::line::Line;
use super::rounding::{EXTRUDER, ROUNDING, UNIT};
use gwatt_machine::{CornerAngle, CornerRule};

/// What a turn is at least where chords make it, as 1 less its cosine: see `turn`.
const LEAST_TURN: f64 = 1e-6 + 2.0 * UNIT;

/// What rounding may make of a cosine.
const COSINE: f64 = 1e-15;

/// True only where the rule permits a joint of two lines at a speed, mm/s; a quick
/// answer.
#[inline]
pub(super) fn permits(rule: &CornerRule, before: &Line, after: &Line, speed_mm_s: f64) -> bool {
    let (u, w) = (&before.direction, &after.direction);
    let speed2 = speed_mm_s * speed_mm_s;
    let c = u[0] * w[0] + u[1] * w[1] + u[2] * w[2];
    let [e, f] = [before.extrusion, after.extrusion];
    match rule {
        CornerRule::JunctionDeviation {
            deviation_mm,
            angle,
            small_block_mm,
            ..
        } => {
            let passage = Passage {
                accel_mm_s2: after.least_accel_mm_s2,
                length_mm: after.length_mm,
                speed2,
            };
            // The root of a product is not above the mean.
            let c = match angle {
                CornerAngle::AllAxes if (e, f) != (0.0, 0.0) => {
                    (c + e * f) / (1.0 + 0.5 * (e * e + f * f))
                }
                _ => c,
            };
            passage.is_shallow(c, *deviation_mm, *small_block_mm)
        }
        CornerRule::SquareCorner {
            velocity_mm_s,
            extruder_step_mm_s,
        } => {
            // See `square`, with the sine s and the cosine of half the inside angle.
            let s2 = 0.5 * (1.0 + c);
            let s = s2.sqrt();
            let c2 = 0.5 * (1.0 - c) + COSINE;
            let bent = lower(
                after.length_mm * after.least_accel_mm_s2,
                before.length_mm * before.least_accel_mm_s2,
            );
            let most2 = speed2 * (1.0 + ROUNDING);
            let share = lower(before.common_share, after.common_share);
            c > 0.0
                && share * velocity_mm_s * velocity_mm_s * (SQRT_2 - 1.0) * (s + s2) >= most2 * c2
                && bent * bent * s2 >= 4.0 * most2 * most2 * c2
                && (f - e) * (f - e) * most2 <= extruder_step_mm_s * extruder_step_mm_s
        }
        CornerRule::SpeedStep {
            step_mm_s,
            same_kind_only,
        } => {
            let most2 = speed2 * (1.0 + ROUNDING);
            let mut changes = u.iter().zip(w).zip(step_mm_s);
            let step = step_mm_s[EXTRUDER];
            changes.all(|((u, w), step)| (w - u) * (w - u) * most2 <= step * step)
                && (f - e) * (f - e) * most2 <= step * step
                && (!same_kind_only || kind(u, e) == kind(w, f))
        }
        _ => false,
    }
}

/// Whether a move in this direction prints, whether its extruder moves otherwise, and whether X or Y
/// move (RepRapFirmware, DDA.cpp, `InitStandardMove`).
pub(super) type Kind = [bool; 3];

/// That of a move: it prints where the extruder feeds while X or Y move.
#[inline]
pub(super) fn kind(direction: &[f64], extruder: f64) -> Kind {
    let moves = direction.iter().take(2).any(|change| *change != 0.0);
    let prints = moves && extruder > 0.0;
    [prints, extruder != 0.0 && !prints, moves]
}

/// A joint that is to be passed at a speed.
#[derive(Debug, Clone, Copy)]
pub(super) struct Passage {
    /// Lowest acceleration of the axes and along the element after, mm/s².
    pub accel_mm_s2: f64,
    /// Of the element after.
    pub length_mm: f64,
    /// The speed, squared.
    pub speed2: f64,
}

impl Passage {
    /// With `c = u·w` the rule is `s² = (1 + c)/2 ≥ (K/(1 + K))²` for
    /// `K = v²/(a·d)`, with the lowest acceleration of the axes for a. Turns θ
    /// of chords up to π/4 have `1 − c ≥ 0.47·θ²`.
    #[inline]
    pub fn is_shallow(&self, c: f64, deviation_mm: f64, small_block_mm: f64) -> bool {
        let speed2 = self.speed2 * (1.0 + ROUNDING);
        let s = speed2 / (self.accel_mm_s2 * deviation_mm + speed2);
        let chords = self.length_mm < small_block_mm;
        let turns = self.accel_mm_s2 * self.length_mm;
        c > 0.0
            && 0.5 * (1.0 + c) * (1.0 - ROUNDING) >= s * s
            && (!chords || 0.47 * turns * turns >= speed2 * speed2 * (1.0 - c + LEAST_TURN))
    }
}
