//! The passes of G71, G72 and G73.
//!
//! G71: from the start the tool goes aside by what is left for finishing; then
//! passes along Z, each deeper by the depth of cut, to where they meet the
//! contour; an escape (`passes`) and back; at the end once along the contour
//! and back to the start. G72 the same with X and Z exchanged. The escape is a
//! rapid here, which counts higher than a feed.

use super::piece::{Piece, TOLERANCE_MM, contour_wrong};
use super::pockets::Stock;
use super::state::{Contour, ContourCycle};
use super::{TYPE_TWO, X, Z};
use crate::control::{Control, Run};
use gwatt_machine::{AxisSet, AxisValues, TypeTwo};
use gwatt_motion::{Move, MoveKind};

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
        let Some((approach, rest)) = pieces.split_first() else {
            return;
        };
        let (rest, way_out) = way_out(approach, rest, deep);
        let Some(last) = rest.last() else { return };
        let start = self.position.at;
        let mut corner = start;
        corner[X] += contour.allowance[0];
        corner[Z] += contour.allowance[1];
        guess_way_out(way_out, &corner, run);
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
        let has_pockets = !one_way(deep, -inward);
        if has_pockets && !contour.two_axes {
            contour_wrong(
                "the contour rises and falls; pockets (type II) need X and Z in its first block",
                run,
            );
            return;
        }
        let language = &self.machine.controller.language;
        let type_two = language.type_2.filter(|_| !has_pockets);
        if contour.two_axes && type_two.is_none() {
            run.facts.guessed = run.facts.guessed.or(Some(TYPE_TWO));
        }
        let follows = contour.two_axes && type_two == Some(TypeTwo::AlongContour);
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
            follows,
        };
        if has_pockets {
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
        self.along(way_out, run);
        self.part(run, MoveKind::Rapid, &start);
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
    pub(super) fn along(&mut self, pieces: &[Piece], run: &mut Run<'_, '_>) {
        for piece in pieces {
            if piece.kind == MoveKind::Dwell {
                continue;
            }
            self.go(run, piece.kind, &piece.end, AxisSet::default(), piece.arc);
        }
    }
}

/// Why such a cycle stays as it is.
const WAY_OUT: &str = "its contour ends with a rapid back along the cut";

/// Says that the rapids at the end of a contour are taken for the way out of it. Where they lead
/// to the beginning of the cycle, `corner`, they are the cycle's own return.
fn guess_way_out(way_out: &[Piece], corner: &AxisValues, run: &mut Run<'_, '_>) {
    let near = |piece: &Piece, axis: usize| (piece.end[axis] - corner[axis]).abs() < TOLERANCE_MM;
    let returns = |piece: &Piece| near(piece, X) && near(piece, Z);
    if way_out.last().is_none_or(returns) {
        return;
    }
    run.facts.guessed = Some(WAY_OUT);
    let whole = run.whole();
    let message = "the contour ends with a rapid back along the cut: taken for the way out of it";
    run.report.note_once("contour-way-out", message, whole);
}

/// The pieces of a contour, and the rapids at its end that lead back along the cut: a last
/// block such as `G0 G40 Z2.`, which ends the compensation of the nose radius as well.
fn way_out<'p>(approach: &Piece, rest: &'p [Piece], deep: usize) -> (&'p [Piece], &'p [Piece]) {
    let along = X + Z - deep;
    let contour = rest
        .iter()
        .rposition(|piece| piece.kind != MoveKind::Rapid)
        .map_or(rest.len(), |last| last + 1);
    let (contour, after) = rest.split_at(contour);
    let Some(last) = contour.last() else {
        return (rest, &[]);
    };
    let forward = (last.end[along] - approach.end[along]).signum();
    let outward = (last.end[deep] - approach.end[deep]).signum();
    let leads_out = |piece: &Piece| piece.goes(deep, outward);
    if after.iter().all(|piece| piece.goes(along, forward)) || !after.iter().all(leads_out) {
        return (rest, &[]);
    }
    (contour, after)
}
