//! Stock removal of type II: the contour may rise and fall, it only has to go
//! one way along the cut (B-63604EN, "Stock Removal in Turning (G71)", "Type
//! II"; Haas lathe operator's manual, "G71 Type 2").
//!
//! A valley is cut level by level until it divides; then one valley after the
//! other. How the tool gets from one to the next is a matter of the control's
//! parameters: here it rises at rapid by the escape above the level before, goes
//! along, and feeds down.

use super::piece::{Piece, TOLERANCE_MM, contour_wrong};
use super::{X, Z};
use crate::control::{Control, Run};
use gwatt_machine::AxisValues;
use gwatt_motion::MoveKind;

/// Levels of a cycle.
const LEVELS_MAX: f64 = 1e5;

/// What a cycle works with.
pub(super) struct Stock {
    pub(super) deep: usize,
    pub(super) depth_mm: f64,
    pub(super) escape_mm: f64,
    /// Where it begins, and the signs of its way in and along.
    pub(super) corner: AxisValues,
    pub(super) inward: f64,
    pub(super) forward: f64,
    /// How the tool goes in from outside.
    pub(super) into: MoveKind,
    /// After a pass it goes along the contour up to the pass before.
    pub(super) follows: bool,
}

/// A cut that is still to be made.
#[derive(Debug, Clone, Copy)]
struct Valley {
    /// Number of its level, from 1.
    level: u32,
    /// From where to where.
    from: f64,
    to: f64,
    /// It is open at the side that the tool comes from.
    open: bool,
}

impl Stock {
    pub(super) fn level(&self, number: u32) -> f64 {
        self.corner[self.deep] + self.inward * self.depth_mm * f64::from(number)
    }

    /// The parts of a level that lie outside of the contour, in `within`.
    fn valleys(&self, number: u32, within: &Valley, pieces: &[Piece]) -> Vec<Valley> {
        let along = X + Z - self.deep;
        let level = self.level(number);
        let below = |place: f64| (place - level) * self.inward > TOLERANCE_MM;
        let mut out: Vec<Valley> = Vec::new();
        let mut begin = None;
        let Some(first) = pieces.first() else {
            return out;
        };
        if below(first.start[self.deep]) {
            begin = Some((self.corner[along], true));
        }
        let mut add = |(from, open): (f64, bool), to: f64| {
            let ahead = |a: f64, b: f64| (b - a) * self.forward;
            // Open only where what it lies in was open too.
            let open = open && within.open;
            let from = if ahead(within.from, from) < 0.0 || open {
                within.from
            } else {
                from
            };
            let to = if ahead(to, within.to) < 0.0 {
                within.to
            } else {
                to
            };
            if ahead(from, to) > TOLERANCE_MM {
                out.push(Valley {
                    level: number,
                    from,
                    to,
                    open,
                });
            }
        };
        for piece in pieces {
            let (start, end) = (piece.start[self.deep], piece.end[self.deep]);
            if below(start) == below(end) {
                continue;
            }
            let share = piece.crossing(self.deep, level).unwrap_or(1.0);
            let place = piece.place(along, share);
            match begin.take() {
                None => begin = Some((place, false)),
                Some(from) => add(from, place),
            }
        }
        if let (Some(from), Some(last)) = (begin, pieces.last()) {
            add(from, last.end[along]);
        }
        out
    }
}

impl Control<'_> {
    /// The passes; the tool stands at the corner before and after.
    pub(super) fn pockets(&mut self, stock: &Stock, rest: &[Piece], run: &mut Run<'_, '_>) {
        let along = X + Z - stock.deep;
        let pieces: Vec<Piece> = rest.iter().flat_map(Piece::quarters).collect();
        let deepest = pieces
            .iter()
            .map(|piece| (piece.end[stock.deep] - stock.corner[stock.deep]) * stock.inward)
            .fold(0.0, f64::max);
        if deepest / stock.depth_mm > LEVELS_MAX {
            contour_wrong("more than 100000 passes", run);
            return;
        }
        let Some(last) = pieces.last() else { return };
        let whole = Valley {
            level: 0,
            from: stock.corner[along],
            to: last.end[along],
            open: true,
        };
        let errors = run.report.diagnostics.errors;
        let mut place = stock.corner;
        let mut open = stock.valleys(1, &whole, &pieces);
        open.reverse();
        while let Some(valley) = open.pop() {
            let level = stock.level(valley.level);
            let mut above = stock.level(valley.level - 1);
            if valley.level > 1 {
                above -= stock.inward * stock.escape_mm;
            }
            // Out of a valley before, along, and in.
            place[stock.deep] = above;
            self.part(run, MoveKind::Rapid, &place);
            place[along] = valley.from;
            self.part(run, MoveKind::Rapid, &place);
            place[stock.deep] = level;
            let into = if valley.open {
                stock.into
            } else {
                MoveKind::Feed
            };
            self.part(run, into, &place);
            place[along] = valley.to;
            self.part(run, MoveKind::Feed, &place);
            let away = stock.escape_mm.min((valley.to - valley.from).abs());
            place[stock.deep] -= stock.inward * stock.escape_mm;
            place[along] -= stock.forward * away;
            self.part(run, MoveKind::Rapid, &place);
            if !run.within_limits() || run.report.diagnostics.errors != errors {
                return;
            }
            let deeper = stock.valleys(valley.level + 1, &valley, &pieces);
            open.extend(deeper.into_iter().rev());
        }
        place[stock.deep] = stock.corner[stock.deep];
        self.part(run, MoveKind::Rapid, &place);
        self.part(run, MoveKind::Rapid, &stock.corner);
        let whole = run.whole();
        let message = "how the tool goes from pocket to pocket is a matter of the control's \
                       parameters: taken as out at rapid, along, and in at the feed";
        run.report.note_once("pockets", message, whole);
    }
}
