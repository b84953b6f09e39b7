//! The circle in a corner of two lines, or of the tangents of arcs.

use super::super::super::arc_plane::LINUXCNC_NORMAL_SHARE as NORMAL_SHARE;
use super::super::super::axis_limits::lower;
use super::super::vector::{Vector, add, cross, dot, length, scale, sub};
use super::{ANGLE_MIN, ARC_LENGTH_MIN_MM, Axes, Fit, Leg};
use std::f64::consts::{FRAC_PI_2, PI};

/// Share of an element that one blend may take.
const LENGTH_SHARE: f64 = 0.5;

/// The corner that a blend rounds.
#[derive(Debug, Clone, Copy)]
pub(in super::super) struct Corner {
    /// Of half the angle inside.
    sin: f64,
    cos: f64,
    /// By which the path turns.
    turn: f64,
    /// Normal of its plane, and the square of its length.
    across: Vector,
    across2: f64,
}

/// The circle in a corner.
#[derive(Debug, Clone, Copy)]
pub(in super::super) struct Rounding {
    pub radius: f64,
    /// By which the path turns.
    pub sweep: f64,
    /// What it takes from each line, mm.
    pub trim: f64,
    /// Speed that it is planned for, and acceleration of its plane.
    pub speed: f64,
    pub accel: f64,
}

impl Corner {
    /// Of two lines; with `θ = (π − φ)/2` the sum of their directions is as long
    /// as `2·sin θ`, the difference as `2·cos θ`. `None` where there is none.
    #[inline]
    pub fn of(u: Vector, w: Vector) -> Option<Self> {
        let (sum, change) = (add(u, w), sub(w, u));
        let (sum2, change2) = (dot(sum, sum), dot(change, change));
        let (sin, cos) = (0.5 * sum2.sqrt(), 0.5 * change2.sqrt());
        let least = if cos < sin { cos } else { sin };
        let small = libm::asin(least);
        if small < ANGLE_MIN {
            return None;
        }
        Some(Self {
            sin,
            cos,
            turn: 2.0 * if cos < sin { small } else { FRAC_PI_2 - small },
            across: cross(u, w),
            across2: 0.25 * sum2 * change2,
        })
    }

    /// Unit normal of its plane.
    #[inline]
    pub(super) fn binormal(&self) -> Vector {
        scale(self.across, 1.0 / self.across2.sqrt())
    }

    /// Half the angle inside.
    pub(super) fn theta(&self) -> f64 {
        FRAC_PI_2 - 0.5 * self.turn
    }

    /// The same corner with another angle, half of it given.
    pub(super) fn with(self, theta: f64) -> Self {
        Self {
            sin: libm::sin(theta),
            cos: libm::cos(theta),
            turn: PI - 2.0 * theta,
            ..self
        }
    }

    /// Diameter of the circle that fits into the box of the limits, cut through its
    /// centre by the plane.
    #[inline]
    fn inscribed(&self, limits: Vector) -> f64 {
        let inverse2 = limits.map(|limit| {
            if limit > 0.0 {
                1.0 / (limit * limit)
            } else {
                0.0
            }
        });
        (self.across2 / steepest(self.across, self.across2, inverse2)).sqrt()
    }

    /// The speed that both sides and the plane permit.
    #[inline]
    fn goal(&self, [first, second]: [&Leg; 2], axes: &Axes, straight: bool) -> f64 {
        let asked = higher(first.target_speed(), second.target_speed());
        // Whatever the plane, that much fits into it.
        if axes.least_speed >= asked {
            return asked;
        }
        let planar = self.inscribed(axes.speed);
        if !straight || planar >= asked {
            return asked.min(planar);
        }
        let cos = libm::cos(self.turn.min(PI * 0.49));
        let v1 = first.max_speed.min(second.max_speed / cos);
        let v2 = second.max_speed.min(first.max_speed / cos);
        let base = length(sub(scale(second.tangent, v2), scale(first.tangent, v1)));
        let altitude = v1 * v2 * libm::sin(self.turn) / base;
        asked.min(altitude.max(planar))
    }

    /// The circle between two legs that give up so much at most, mm; `None` for
    /// none. Most corners are shallow: what decides is compared without roots and
    /// divisions where that is enough.
    #[inline]
    pub fn round(
        &self,
        legs: [&Leg; 2],
        most_mm: [f64; 2],
        axes: &Axes,
        accel: Vector,
        straight: bool,
    ) -> Option<Rounding> {
        let a = self.inscribed(accel);
        let v_goal = self.goal(legs, axes, straight);
        let (s, c, turn) = (self.sin, self.cos, self.turn);
        let tolerance = lower(legs[0].tolerance(), legs[1].tolerance());
        let give_mm = lower(most_mm[0], most_mm[1]);
        // cos θ/(1 − sin θ) without a difference.
        let over = (1.0 + s) * tolerance;
        let d_most = if over < give_mm * c {
            over / c
        } else {
            give_mm
        };
        let r_most = s / c * d_most;
        let turning = a * NORMAL_SHARE;
        let v = if turning * r_most < v_goal * v_goal {
            (turning * r_most).sqrt()
        } else {
            v_goal
        };
        // A circle no larger than a blend by two ramps at half the acceleration,
        // each over its side, takes; nor smaller than the speed needs.
        let ramp = if a * d_most < v * v {
            (a * d_most).sqrt()
        } else {
            v
        };
        let ramps = 2.0 * ramp * v;
        let r_ramps = if ramps < r_most * turn * a {
            ramps / (turn * a)
        } else {
            r_most
        };
        let v2 = v * v;
        let needs = r_ramps * turning < v2;
        let radius = if needs { v2 / turning } else { r_ramps };
        if radius < 1e-12 || radius * turn < ARC_LENGTH_MIN_MM {
            return None;
        }
        let whole = !needs && r_ramps == r_most;
        Some(Rounding {
            radius,
            sweep: turn,
            trim: if whole { d_most } else { radius * c / s },
            speed: v,
            accel: a,
        })
    }

    /// The same between lines.
    #[inline]
    pub fn round_lines(&self, legs: [&Leg; 2], axes: &Axes, accel: Vector) -> Option<Rounding> {
        self.round(legs, legs_give(legs), axes, accel, true)
    }

    /// The blend along a circle.
    pub(super) fn fit(&self, legs: [&Leg; 2], rounding: &Rounding) -> Fit {
        Fit {
            radius: rounding.radius,
            sweep: rounding.sweep,
            tangent: legs[0].tangent,
            normal: cross(self.binormal(), legs[0].tangent),
            trims: [rounding.trim; 2],
            speed: rounding.speed,
            accel: rounding.accel,
        }
    }
}

/// The largest of `n² − n_i²` by the inverse squares of limits, 0 where there is none:
/// there `limit/√(1 − n_i²/n²)` is lowest, n a normal, its square given as well.
#[inline]
pub(super) fn steepest(across: Vector, across2: f64, inverse2: Vector) -> f64 {
    let least2 = 1e-24 * across2;
    let mut most = 0.0;
    for (part, inverse2) in across.into_iter().zip(inverse2) {
        most = higher(most, higher(across2 - part * part, least2) * inverse2);
    }
    most
}

/// A line gives at most half of its programmed length and what is left of it.
#[inline]
pub(super) fn legs_give([first, second]: [&Leg; 2]) -> [f64; 2] {
    [
        lower(first.length_mm, first.nominal_mm * LENGTH_SHARE),
        second.length_mm * LENGTH_SHARE,
    ]
}

/// The higher of two numbers.
#[inline]
fn higher(a: f64, b: f64) -> f64 {
    if b > a { b } else { a }
}
