//! Pieces of the contour of a turning cycle.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::contour::contour_value;
use super::{X, Z};
use crate::control::Run;
use gwatt_machine::AxisValues;
use gwatt_motion::{Arc, Move, MoveKind};

/// A contour may go back by this much, mm: rounding.
pub(super) const TOLERANCE_MM: f64 = 1e-6;
/// Halvings until a crossing is exact.
const HALVINGS: u32 = 60;
/// Places of an arc that are looked at.
const SAMPLES: u32 = 64;

/// A piece of the contour, moved by what is left for finishing.
pub(super) struct Piece {
    pub(super) start: AxisValues,
    pub(super) end: AxisValues,
    pub(super) arc: Option<Arc>,
    pub(super) kind: MoveKind,
}

impl Piece {
    pub(super) fn new(mv: &Move, shift: [f64; 2]) -> Self {
        let by = |axis: usize| match axis {
            X => shift[0],
            Z => shift[1],
            _ => 0.0,
        };
        let shifted = |place: &AxisValues| std::array::from_fn(|axis| place[axis] + by(axis));
        let arc = mv.arc.map(|mut arc| {
            for (axis, center) in arc.plane.into_iter().zip(&mut arc.center) {
                *center += by(axis);
            }
            arc
        });
        Self {
            start: shifted(&mv.start),
            end: shifted(&mv.end),
            arc,
            kind: mv.kind,
        }
    }

    /// Place along an axis, `share` from 0 at the start to 1 at the end.
    pub(super) fn place(&self, axis: usize, share: f64) -> f64 {
        if let Some(arc) = &self.arc {
            let angle = arc.start_angle_rad + arc.sweep_rad * share;
            if arc.plane[0] == axis {
                return arc.center[0] + arc.radius_mm * libm::cos(angle);
            }
            if arc.plane[1] == axis {
                return arc.center[1] + arc.radius_mm * libm::sin(angle);
            }
        }
        self.start[axis] + (self.end[axis] - self.start[axis]) * share
    }

    /// The part of it between two shares of its length.
    pub(super) fn part(&self, from: f64, to: f64) -> Self {
        Self {
            start: self.at(from),
            end: self.at(to),
            arc: self.arc.map(|arc| {
                let angle = arc.start_angle_rad + arc.sweep_rad * from;
                Arc {
                    // Between -π and π, as that of a block of its own.
                    start_angle_rad: angle - TAU * (angle / TAU).round(),
                    sweep_rad: arc.sweep_rad * (to - from),
                    ..arc
                }
            }),
            kind: self.kind,
        }
    }

    /// Its parts between the ends of the quarters of its circle, each of which
    /// goes one way along both axes.
    pub(super) fn quarters(&self) -> Vec<Self> {
        let Some(arc) = &self.arc else {
            return vec![self.part(0.0, 1.0)];
        };
        let (first, last) = (arc.start_angle_rad, arc.start_angle_rad + arc.sweep_rad);
        let (low, high) = (first.min(last), first.max(last));
        let mut shares = vec![0.0, 1.0];
        let mut quarter = (low / FRAC_PI_2).ceil();
        while quarter * FRAC_PI_2 < high && shares.len() < 16 {
            shares.push((quarter * FRAC_PI_2 - first) / arc.sweep_rad);
            quarter += 1.0;
        }
        shares.sort_by(f64::total_cmp);
        let pairs = shares.iter().zip(shares.iter().skip(1));
        pairs
            .filter(|(from, to)| to > from)
            .map(|(&from, &to)| self.part(from, to))
            .collect()
    }

    /// Its place in X and Z; other axes do not move.
    pub(super) fn at(&self, share: f64) -> AxisValues {
        let mut place = self.start;
        if share == 1.0 {
            return self.end;
        }
        if share > 0.0 {
            place[X] = self.place(X, share);
            place[Z] = self.place(Z, share);
        }
        place
    }

    /// Whether it goes one way only along an axis.
    pub(super) fn goes(&self, axis: usize, way: f64) -> bool {
        let count = if self.arc.is_some() { SAMPLES } else { 1 };
        let mut last = self.place(axis, 0.0);
        (1..=count).all(|sample| {
            let next = self.place(axis, f64::from(sample) / f64::from(count));
            let fine = (next - last) * way >= -TOLERANCE_MM;
            last = next;
            fine
        })
    }

    /// Where it crosses a level along an axis.
    pub(super) fn crossing(&self, axis: usize, level: f64) -> Option<f64> {
        let (mut low, mut high) = (0.0, 1.0);
        let side = |share: f64| self.place(axis, share) - level;
        let begin = side(0.0);
        if begin == 0.0 {
            return Some(0.0);
        }
        if begin * side(1.0) > 0.0 {
            return None;
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if begin * side(middle) > 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        Some(high)
    }
}

pub(super) fn contour_wrong(message: &str, run: &mut Run<'_, '_>) {
    let whole = run.whole();
    contour_value(message, whole, run);
}
