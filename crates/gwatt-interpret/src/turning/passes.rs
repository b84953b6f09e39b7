//! The passes of G71 and G72 about a contour without pockets: to where each level meets the
//! contour, and off it.
//!
//! In type I the tool leaves the contour at 45 degrees. In type II it may go along the contour
//! first, up to the pass before, and then straight out of the cut (Haas lathe operator's manual,
//! "G71 Type II Details": "after each pass along the Z axis, the tool will follow the path defined
//! by PQ", "then retract parallel to the X axis").

use super::piece::{Piece, TOLERANCE_MM};
use super::pockets::Stock;
use super::{X, Z};
use crate::control::{Control, Run};
use gwatt_motion::MoveKind;

impl Control<'_> {
    /// The passes; the tool stands at the corner before, and at its place along the cut after.
    pub(super) fn plain_passes(
        &mut self,
        stock: &Stock,
        floor: f64,
        rest: &[Piece],
        run: &mut Run<'_, '_>,
    ) {
        let (deep, along) = (stock.deep, X + Z - stock.deep);
        let Some(last) = rest.last() else { return };
        let errors = run.report.diagnostics.errors;
        let mut number = 1;
        loop {
            let level = stock.level(number);
            if (floor - level) * stock.inward <= TOLERANCE_MM {
                return;
            }
            let mut numbered = rest.iter().enumerate();
            let crossing = numbered.find_map(|(index, piece)| {
                let share = piece.crossing(deep, level)?;
                Some((index, share, piece.place(along, share)))
            });
            let wall = crossing.map_or(last.end[along], |(_, _, place)| place);
            let mut place = stock.corner;
            place[deep] = level;
            self.part(run, stock.into, &place);
            place[along] = wall;
            self.part(run, MoveKind::Feed, &place);
            if stock.follows {
                if let Some((index, share, _)) = crossing {
                    let before = stock.level(number - 1);
                    let rising = rest.get(index..).unwrap_or_default();
                    self.along(&up_to(rising, share, deep, before), run);
                    place = self.position.at;
                }
            } else {
                let away = stock.escape_mm.min((wall - stock.corner[along]).abs());
                place[along] -= stock.forward * away;
            }
            place[deep] -= stock.inward * stock.escape_mm;
            self.part(run, MoveKind::Rapid, &place);
            place[along] = stock.corner[along];
            self.part(run, MoveKind::Rapid, &place);
            if !run.within_limits() || run.report.diagnostics.errors != errors {
                return;
            }
            number += 1;
        }
    }
}

/// The contour from `share` of its first piece to where it reaches a level, or to its end.
fn up_to(pieces: &[Piece], share: f64, deep: usize, level: f64) -> Vec<Piece> {
    let mut out = Vec::new();
    for (index, piece) in pieces.iter().enumerate() {
        let from = if index == 0 { share } else { 0.0 };
        let end = piece.crossing(deep, level);
        let to = end.unwrap_or(1.0);
        let part = piece.part(from, to);
        let goes = |axis: usize| (part.end[axis] - part.start[axis]).abs() > TOLERANCE_MM;
        if to > from && (goes(X) || goes(Z)) {
            out.push(part);
        }
        if end.is_some() {
            break;
        }
    }
    out
}
