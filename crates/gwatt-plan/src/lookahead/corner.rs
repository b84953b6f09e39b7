//! Corner speeds of controllers that run through the corner itself.
//!
//! Input: the elements on both sides. Output: the largest squared speed at
//! which the path may pass their joint.
//!
//! With `s` the sine of half the inside angle (`cos = −u·w` of the directions),
//! a circle that touches both sides and stays the distance d from the corner
//! has the radius `R = d·s/(1 − s)`, and is run at `v² = a·R` (Jeon 2011).

mod jerk;

use super::rounding::{EXTRUDER, UNIT};
use jerk::JerkJoint;
use std::f64::consts::{FRAC_1_SQRT_2, SQRT_2};

use super::element::{Element, Joint};
use super::passage::{Kind, Passage, kind};
use super::turn::angle_at_least;
use gwatt_machine::{AXES, AxisValues, CornerAngle, CornerRule};

/// Cosines beyond this are no corner, or a reversal.
const STRAIGHT: f64 = 0.999_999;
const LINEAR: usize = 3;

/// What the rules must know of the element before a joint.
#[derive(Debug, Clone)]
pub(super) struct Before {
    /// What happens at the joint.
    pub joint: Joint,
    /// Speed that feed, axes and curvature permit, mm/s.
    pub top_mm_s: f64,
    /// Speed that F asks for, mm/s.
    asked_mm_s: f64,
    /// Direction at the joint, how many axes it needs, and whether X, Y and Z
    /// make a unit of it.
    end: AxisValues,
    /// Of the last chord of an arc: where that heads, which shorter ones come closer to.
    pub tangent: Option<AxisValues>,
    span: usize,
    is_unit: bool,
    is_curved: bool,
    /// Length by acceleration, mm²/s².
    ramp2: f64,
    /// Squared speed at which it could begin from rest.
    rest2: f64,
    kind: Kind,
    /// See [`After`].
    square2: f64,
}

impl Before {
    /// The largest speed, squared, at which the joint with the element after it is passed.
    pub fn joint2<T>(&self, rule: &CornerRule, after: &After<'_, T>) -> f64 {
        if self.joint == Joint::Stop {
            return 0.0;
        }
        let (before, next) = (self.top_mm_s, after.top_mm_s);
        let most2 = if before < next {
            before * before
        } else {
            next * next
        };
        let own2 = speed2(rule, self, after, most2);
        let Some(end) = self.tangent else {
            return own2;
        };
        let tangent = Self {
            end,
            ..self.clone()
        };
        own2.max(speed2(rule, &tangent, after, most2))
    }

    /// The joint with the element after it, under the rule of classic jerk.
    pub fn jerk_joint<'a, T>(
        &'a self,
        rule: &'a CornerRule,
        after: &After<'a, T>,
    ) -> Option<JerkJoint<'a>> {
        let CornerRule::ClassicJerk { step_mm_s } = rule else {
            return None;
        };
        let span = self.span.max(after.span);
        let steps = after.element.set.steps_mm_s(step_mm_s);
        (self.joint != Joint::Stop).then(|| jerk(steps, self, after, span))
    }

    /// Whether the element is straight, as long as its part in X, Y and Z, and runs
    /// through the joint if the corner permits it.
    pub fn is_straight(&self) -> bool {
        self.joint != Joint::Stop && self.is_unit && !self.is_curved
    }
}

/// The element after a joint.
#[derive(Debug)]
pub(super) struct After<'e, T> {
    element: &'e Element<T>,
    /// Speed that feed, axes and curvature permit, mm/s.
    pub top_mm_s: f64,
    span: usize,
    is_unit: bool,
    /// Squared speed at which motion may begin from rest.
    pub rest2: f64,
    /// Of interest to [`CornerRule::SpeedStep`] alone.
    kind: Kind,
    /// Squared speed at a right angle, less where its acceleration is below what counts
    /// for all paths; of interest to [`CornerRule::SquareCorner`] alone.
    square2: f64,
}

impl<'e, T> After<'e, T> {
    #[inline]
    pub fn new(rule: &CornerRule, element: &'e Element<T>) -> Self {
        let top_mm_s = element.top_mm_s();
        let span = span(&element.start);
        let rest2 = match rule {
            CornerRule::ClassicJerk { step_mm_s } => {
                let steps = element.set.steps_mm_s(step_mm_s);
                rest2(steps, &element.start, span, top_mm_s)
            }
            _ => 0.0,
        };
        let kind = match rule {
            CornerRule::SpeedStep { .. } => kind(&element.start, element.start[EXTRUDER]),
            _ => Kind::default(),
        };
        let square2 = match rule {
            CornerRule::SquareCorner { velocity_mm_s, .. } => {
                let v90 = element.set.square_mm_s(*velocity_mm_s);
                accel_share(element.accel_mm_s2, element.common_accel_mm_s2()) * v90 * v90
            }
            _ => 0.0,
        };
        Self {
            element,
            top_mm_s,
            span,
            is_unit: is_unit(&element.start),
            rest2,
            kind,
            square2,
        }
    }

    /// The same element, before its other joint.
    #[inline]
    pub fn before(&self) -> Before {
        let element = self.element;
        Before {
            joint: element.joint,
            top_mm_s: self.top_mm_s,
            asked_mm_s: element.feed_mm_s,
            end: element.end,
            tangent: None,
            is_curved: element.curve.is_some(),
            span: match element.curve {
                Some(_) => span(&element.end),
                None => self.span,
            },
            is_unit: match element.curve {
                Some(_) => is_unit(&element.end),
                None => self.is_unit,
            },
            ramp2: element.length_mm * element.accel_mm_s2,
            rest2: self.rest2,
            kind: self.kind,
            square2: self.square2,
        }
    }
}

/// The first axes that a direction needs: all others are 0.
#[inline]
fn span(direction: &AxisValues) -> usize {
    let others = direction.iter().skip(LINEAR);
    if others.fold(0, |bits, part| bits | part.to_bits() << 1) == 0 {
        LINEAR
    } else {
        AXES
    }
}

/// Whether X, Y and Z make a unit.
#[inline]
fn is_unit(direction: &AxisValues) -> bool {
    (dot(direction, direction, LINEAR) - 1.0).abs() <= UNIT
}

/// The largest squared speed at the joint of two elements, but not above
/// `most2`. 0: they meet at rest.
#[inline]
pub(super) fn speed2<T>(
    rule: &CornerRule,
    before: &Before,
    after: &After<'_, T>,
    most2: f64,
) -> f64 {
    let span = before.span.max(after.span);
    let set = &after.element.set;
    let v2 = match rule {
        CornerRule::LinuxCnc { .. } => 0.0,
        CornerRule::JunctionDeviation {
            deviation_mm,
            angle,
            per_axis,
            block_accel,
            small_block_mm,
        } => {
            let corner = Corner {
                deviation_mm: set.deviation_mm(*deviation_mm),
                per_axis: *per_axis,
                block_accel: *block_accel || !*per_axis,
                small_block_mm: *small_block_mm,
                axes: match angle {
                    CornerAngle::AllAxes => span,
                    CornerAngle::Linear => LINEAR,
                },
                are_units: before.is_unit && after.is_unit,
                before,
                after: after.element,
            };
            if corner.permits(most2) {
                most2
            } else {
                corner.speed2()
            }
        }
        CornerRule::ClassicJerk { step_mm_s } => {
            jerk(set.steps_mm_s(step_mm_s), before, after, span).speed2()
        }
        CornerRule::SquareCorner {
            extruder_step_mm_s, ..
        } => square(*extruder_step_mm_s, before, after),
        CornerRule::SpeedStep {
            step_mm_s,
            same_kind_only,
        } => {
            let same_kind_only = set.same_kind_only(*same_kind_only);
            step(
                set.steps_mm_s(step_mm_s),
                same_kind_only,
                before,
                after,
                span,
            )
        }
    };
    v2.min(most2)
}

/// Squared speed at which motion may begin from rest.
fn rest2(steps: &AxisValues, start: &AxisValues, span: usize, top_mm_s: f64) -> f64 {
    let mut speed = top_mm_s;
    for (step, change) in steps.iter().zip(start).take(span) {
        if *change != 0.0 {
            speed = speed.min(step / change.abs());
        }
    }
    speed * speed
}

#[inline]
fn dot(a: &AxisValues, b: &AxisValues, axes: usize) -> f64 {
    if axes == LINEAR {
        return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    }
    a.iter().zip(b).take(axes).map(|(a, b)| a * b).sum()
}

/// The cosine of the inside angle, negative for a shallow corner.
#[inline]
fn cosine(axes: usize, before: &AxisValues, after: &AxisValues) -> Option<f64> {
    let length2 = dot(before, before, axes) * dot(after, after, axes);
    if length2 <= 0.0 {
        return None;
    }
    Some((-dot(before, after, axes) / length2.sqrt()).clamp(-1.0, 1.0))
}

/// A corner that is passed within a distance from it.
struct Corner<'a, T> {
    deviation_mm: f64,
    per_axis: bool,
    /// The acceleration of the block counts.
    block_accel: bool,
    small_block_mm: f64,
    /// The first axes make the angle.
    axes: usize,
    /// X, Y and Z of both directions make units.
    are_units: bool,
    before: &'a Before,
    after: &'a Element<T>,
}

impl<T> Corner<'_, T> {
    /// True only where [`Self::speed2`] is not below `most2`, at a small part of
    /// its cost: most corners of a finishing pass are shallow.
    #[inline]
    fn permits(&self, most2: f64) -> bool {
        let (u, w) = (&self.before.end, &self.after.start);
        if self.axes != LINEAR || !self.are_units {
            return false;
        }
        let mut accel = self.block_accel_mm_s2();
        if self.per_axis {
            for axis in 0..LINEAR {
                let limit = self.after.axis_accel_mm_s2[axis];
                if limit > 0.0 {
                    accel = if limit < accel { limit } else { accel };
                } else if u[axis] != 0.0 || w[axis] != 0.0 {
                    return false;
                }
            }
        }
        let passage = Passage {
            accel_mm_s2: accel,
            length_mm: self.after.length_mm,
            speed2: most2,
        };
        passage.is_shallow(dot(u, w, LINEAR), self.deviation_mm, self.small_block_mm)
    }

    /// The acceleration of the block after, where it counts.
    #[inline]
    fn block_accel_mm_s2(&self) -> f64 {
        if self.block_accel {
            self.after.accel_mm_s2
        } else {
            f64::INFINITY
        }
    }

    fn speed2(&self) -> f64 {
        let (u, w) = (&self.before.end, &self.after.start);
        let Some(cos) = cosine(self.axes, u, w) else {
            return 0.0;
        };
        if cos > STRAIGHT {
            return 0.0;
        }
        let after = self.after;
        let chords = after.length_mm < self.small_block_mm;
        if cos < -STRAIGHT && !chords {
            return f64::INFINITY;
        }
        // Marlin takes what is straighter for this straight.
        let cos = cos.max(-STRAIGHT);
        let accel = if self.per_axis {
            let mut change = [0.0; AXES];
            for (i, value) in change.iter_mut().enumerate().take(self.axes) {
                *value = w[i] - u[i];
            }
            let length = dot(&change, &change, self.axes).sqrt();
            let limits = change.iter().zip(&after.axis_accel_mm_s2).take(self.axes);
            let permitted = limits.filter(|(d, _)| **d != 0.0);
            permitted.fold(self.block_accel_mm_s2(), |accel, (d, limit)| {
                accel.min(limit * length / d.abs())
            })
        } else {
            after.accel_mm_s2
        };
        let s = (0.5 * (1.0 - cos)).sqrt();
        let mut v2 = accel * self.deviation_mm * s / (1.0 - s);
        // Chords of a circle: radius = length / turn.
        if chords && cos < -FRAC_1_SQRT_2 {
            v2 = v2.min(accel * after.length_mm / angle_at_least(-cos));
        }
        v2
    }
}

/// The joint under the classic jerk rule.
fn jerk<'a, T>(
    steps: &'a AxisValues,
    before: &'a Before,
    after: &After<'a, T>,
    span: usize,
) -> JerkJoint<'a> {
    JerkJoint {
        steps: steps.get(..span).unwrap_or(steps),
        exit: &before.end,
        entry: &after.element.start,
        tops: [before.top_mm_s, after.top_mm_s],
        asked: [before.asked_mm_s, after.element.feed_mm_s],
        rests2: [before.rest2, after.rest2],
    }
}

/// The speed at a right angle holds at the acceleration of all paths; what Z or the
/// extruder slow down is slower there too, in proportion.
#[inline]
pub(super) fn accel_share(accel_mm_s2: f64, common_mm_s2: f64) -> f64 {
    if accel_mm_s2 < common_mm_s2 && common_mm_s2 < f64::INFINITY {
        accel_mm_s2 / common_mm_s2
    } else {
        1.0
    }
}

fn square<T>(extruder_step: f64, before: &Before, after: &After<'_, T>) -> f64 {
    let square2 = before.square2.min(after.square2);
    let after = after.element;
    let Some(cos) = cosine(LINEAR, &before.end, &after.start) else {
        return 0.0;
    };
    let turn = (after.start[EXTRUDER] - before.end[EXTRUDER]).abs();
    let extruder2 = if turn > 0.0 {
        (extruder_step / turn) * (extruder_step / turn)
    } else {
        f64::INFINITY
    };
    let s = (0.5 * (1.0 - cos)).max(0.0).sqrt();
    let c = (0.5 * (1.0 + cos)).max(0.0).sqrt();
    if s >= 1.0 || c <= 0.0 {
        return extruder2;
    }
    // Half a block may bend into the circle: v² = a·(L/2)·tan(half angle).
    let half_tan = 0.5 * s / c;
    let bent = (after.length_mm * after.accel_mm_s2).min(before.ramp2);
    (square2 * (SQRT_2 - 1.0) * s / (1.0 - s))
        .min(bent * half_tan)
        .min(extruder2)
}

fn step<T>(
    steps: &AxisValues,
    same_kind_only: bool,
    before: &Before,
    after: &After<'_, T>,
    span: usize,
) -> f64 {
    if same_kind_only && before.kind != after.kind {
        return 0.0;
    }
    let mut v = f64::INFINITY;
    let sides = before.end.iter().zip(&after.element.start);
    for (step, (exit, entry)) in steps.iter().zip(sides).take(span) {
        let change = (entry - exit).abs();
        if change > 0.0 {
            v = v.min(step / change);
        }
    }
    v * v
}

#[cfg(test)]
mod tests;
