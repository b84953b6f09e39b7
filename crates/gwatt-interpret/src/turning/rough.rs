//! The passes of G71, G72 and G73.
//!
//! G71: from the start the tool goes aside by what is left for finishing; then
//! passes along Z, each deeper by the depth of cut, to where they meet the
//! contour; an escape of 45 degrees and back; at the end once along the contour
//! and back to the start. G72 the same with X and Z exchanged. The escape is a
//! rapid here, which counts higher than a feed.

use std::f64::consts::FRAC_PI_2;

use super::contour::{Contour, ContourCycle, contour_value};
use super::pockets::Stock;
use super::{Control, Run, X, Z};
use gwatt_machine::{AxisSet, AxisValues};
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
    arc: Option<Arc>,
    kind: MoveKind,
}

impl Piece {
    fn new(mv: &Move, shift: [f64; 2]) -> Self {
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

    /// Its parts between the ends of the quarters of its circle, each of which
    /// goes one way along both axes.
    pub(super) fn quarters(&self) -> Vec<Self> {
        let part = |from: f64, to: f64| Self {
            start: self.at(from),
            end: self.at(to),
            arc: self.arc.map(|arc| Arc {
                start_angle_rad: arc.start_angle_rad + arc.sweep_rad * from,
                sweep_rad: arc.sweep_rad * (to - from),
                ..arc
            }),
            kind: self.kind,
        };
        let Some(arc) = &self.arc else {
            return vec![part(0.0, 1.0)];
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
            .map(|(&from, &to)| part(from, to))
            .collect()
    }

    /// Its place in X and Z; other axes do not move.
    fn at(&self, share: f64) -> AxisValues {
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
    fn goes(&self, axis: usize, way: f64) -> bool {
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

impl Control<'_> {
    pub(super) fn rough(&mut self, contour: &Contour, moves: &[Move], run: &mut Run<'_, '_>) {
        let pieces: Vec<Piece> = moves
            .iter()
            .filter(|mv| !mv.moving.is_empty())
            .map(|mv| Piece::new(mv, contour.allowance))
            .collect();
        if pieces.len() < 2 {
            contour_wrong(
                "the contour of a turning cycle needs two moves at least",
                run,
            );
            return;
        }
        match &contour.cycle {
            ContourCycle::Rough {
                deep,
                depth_mm,
                escape_mm,
            } => self.rough_passes(*deep, [*depth_mm, *escape_mm], contour, &pieces, run),
            ContourCycle::Pattern { relief_mm, times } => {
                self.repeat(*relief_mm, *times, contour, moves, run);
            }
            ContourCycle::Finish => {}
        }
    }

    /// G71 and G72.
    fn rough_passes(
        &mut self,
        deep: usize,
        [depth_mm, escape_mm]: [f64; 2],
        contour: &Contour,
        pieces: &[Piece],
        run: &mut Run<'_, '_>,
    ) {
        let along = X + Z - deep;
        let (Some((approach, rest)), Some(last)) = (pieces.split_first(), pieces.last()) else {
            return;
        };
        let start = self.position.at;
        let mut corner = start;
        corner[X] += contour.allowance[0];
        corner[Z] += contour.allowance[1];
        let floor = approach.end[deep];
        let inward = (floor - corner[deep]).signum();
        let forward = (last.end[along] - approach.end[along]).signum();
        if (floor - corner[deep]).abs() < TOLERANCE_MM {
            contour_wrong(
                "the contour begins at the depth where the cycle stands",
                run,
            );
            return;
        }
        let one_way = |axis: usize, way: f64| rest.iter().all(|piece| piece.goes(axis, way));
        if !one_way(along, forward) {
            contour_wrong("the contour goes back on itself along the cut", run);
            return;
        }
        let type_two = !one_way(deep, -inward);
        if type_two && !contour.two_axes {
            contour_wrong(
                "the contour rises and falls; pockets (type II) need X and Z in its first block",
                run,
            );
            return;
        }
        let count = (floor - corner[deep]).abs() / depth_mm;
        if count > 1e5 {
            contour_wrong("more than 100000 passes", run);
            return;
        }
        let into = match approach.kind {
            MoveKind::Rapid => MoveKind::Rapid,
            _ => MoveKind::Feed,
        };
        self.part(run, MoveKind::Rapid, &corner);
        let errors = run.report.diagnostics.errors;
        let stock = Stock {
            deep,
            depth_mm,
            escape_mm,
            corner,
            inward,
            forward,
            into,
        };
        if type_two {
            self.pockets(&stock, rest, run);
        } else {
            self.plain_passes(&stock, floor, rest, run);
        }
        if !run.within_limits() || run.report.diagnostics.errors != errors {
            return;
        }
        let mut place = corner;
        place[deep] = floor;
        place[along] = approach.end[along];
        self.part(run, into, &place);
        self.along(rest, run);
        self.part(run, MoveKind::Rapid, &start);
    }

    /// Type I: passes to where each level meets the contour.
    fn plain_passes(&mut self, stock: &Stock, floor: f64, rest: &[Piece], run: &mut Run<'_, '_>) {
        let (deep, along) = (stock.deep, X + Z - stock.deep);
        let Some(last) = rest.last() else { return };
        let errors = run.report.diagnostics.errors;
        let mut number = 1;
        loop {
            let level = stock.level(number);
            if (floor - level) * stock.inward <= TOLERANCE_MM {
                return;
            }
            let crossing = rest.iter().find_map(|piece| {
                let share = piece.crossing(deep, level)?;
                Some(piece.place(along, share))
            });
            let wall = crossing.unwrap_or(last.end[along]);
            let mut place = stock.corner;
            place[deep] = level;
            self.part(run, stock.into, &place);
            place[along] = wall;
            self.part(run, MoveKind::Feed, &place);
            let away = stock.escape_mm.min((wall - stock.corner[along]).abs());
            place[deep] -= stock.inward * stock.escape_mm;
            place[along] -= stock.forward * away;
            self.part(run, MoveKind::Rapid, &place);
            place[along] = stock.corner[along];
            self.part(run, MoveKind::Rapid, &place);
            if !run.within_limits() || run.report.diagnostics.errors != errors {
                return;
            }
            number += 1;
        }
    }

    /// G73.
    fn repeat(
        &mut self,
        relief_mm: [f64; 2],
        times: u64,
        contour: &Contour,
        moves: &[Move],
        run: &mut Run<'_, '_>,
    ) {
        let start = self.position.at;
        let errors = run.report.diagnostics.errors;
        for time in 0..times {
            let share = if times > 1 {
                1.0 - time as f64 / (times - 1) as f64
            } else {
                0.0
            };
            let shift = [0, 1].map(|slot| contour.allowance[slot] + relief_mm[slot] * share);
            let mut corner = start;
            corner[X] += shift[0];
            corner[Z] += shift[1];
            self.part(run, MoveKind::Rapid, &corner);
            let pieces: Vec<Piece> = moves.iter().map(|mv| Piece::new(mv, shift)).collect();
            self.along(&pieces, run);
            if !run.within_limits() || run.report.diagnostics.errors != errors {
                return;
            }
        }
        self.part(run, MoveKind::Rapid, &start);
    }

    /// Along pieces of the contour, at the feed of the cycle.
    fn along(&mut self, pieces: &[Piece], run: &mut Run<'_, '_>) {
        for piece in pieces {
            if piece.kind == MoveKind::Dwell {
                continue;
            }
            self.go(run, piece.kind, &piece.end, AxisSet::default(), piece.arc);
        }
    }
}

pub(super) fn contour_wrong(message: &str, run: &mut Run<'_, '_>) {
    let whole = run.whole();
    contour_value(message, whole, run);
}
