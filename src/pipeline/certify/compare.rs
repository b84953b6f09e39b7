//! What is judged of a move by itself: whether it fits, and whether it asks for no more than
//! the original.

use super::{BUG, Reasons};
use crate::interpret::{Move, MoveKind};
use crate::machine::Machine;
use crate::pipeline::expected::ExpectedMove;
use crate::pipeline::split::BESIDE_MM;
use crate::power::{Assessment, PowerModel};

/// The rule of moves that draw too much; what helps depends on what is permitted.
pub(in crate::pipeline) const DOES_NOT_FIT: &str = "does-not-fit";

/// Rounding that speeds and accelerations may differ by, as a share.
const ROUNDING: f64 = 1e-9;

/// (a), (c) and (d) for one move.
pub(super) fn compare(
    (machine, model): (&Machine, &PowerModel),
    original: &ExpectedMove,
    mv: &Move,
    after: &Assessment,
    text: &[u8],
    reasons: &mut Reasons,
) {
    let place = (original.text, original.line);
    if !original.hopeless {
        refuse_unfit(model, place, after, text, reasons);
    }
    let asked = &original.asked;
    // What the control makes of a block that asks for the same depends on its neighbours, which
    // may have changed: next to a stop an arc is not planned with others.
    if asked.is_of(mv) {
        return;
    }
    let rounding = rounding(original, mv, ROUNDING);
    let rises = |before: f64, after: f64| after > before * (1.0 + rounding);
    let asks_more =
        asked.is_faster(mv, rounding) || !original.as_feed && asked.is_harder(mv, rounding);
    // What is left along the path may rise where a limit falls: of arcs under limits of jerk, and of
    // slower moves under a curve of force.
    let has_jerk = |axis: usize| machine.axes[axis].is_some_and(|it| it.jerk_mm_s3 > 0.0);
    let jerky_arc = mv.arc.is_some() && mv.moving.iter().any(has_jerk);
    let may_rise = after.speed_mm_s < original.speed_mm_s || jerky_arc;
    if asks_more
        || rises(original.speed_mm_s, after.speed_mm_s)
        || !may_rise && rises(original.accel_mm_s2, after.accel_mm_s2)
    {
        let message = "a speed or an acceleration went up".to_owned();
        reasons.push(place, "went-up", message, BUG, text);
    }
    let falls = |before: f64, after: f64| after < before * (1.0 - ROUNDING);
    if !original.changed
        && (falls(original.speed_mm_s, after.speed_mm_s)
            || falls(original.accel_mm_s2, after.accel_mm_s2))
    {
        let (message, help) = if asked.has_no_feed() {
            (
                "no F is in force, and the one that the control takes then is not known: feeds that \
                 replace rapids before it leave another",
                "write F before them",
            )
        } else {
            (
                "the feed of a block that was not to be changed differs",
                BUG,
            )
        };
        reasons.push(place, "changed-feed", message.to_owned(), help, text);
    }
}

/// (a): says of a move that it does not fit.
pub(super) fn refuse_unfit(
    model: &PowerModel,
    place: (u16, u64),
    after: &Assessment,
    text: &[u8],
    reasons: &mut Reasons,
) {
    let demand = &after.demand;
    if model.fits(demand) {
        return;
    }
    let limit_w = model.limit_w(demand.converter);
    let regen_limit_w = model.regen_limit_w(demand.converter);
    let message = match regen_limit_w.filter(|_| demand.peak_w <= limit_w) {
        Some(regen_limit_w) => format!(
            "the block still feeds back {:.1} W of {regen_limit_w:.1} W",
            demand.regen_w
        ),
        None => format!(
            "the block still needs {:.1} W of {limit_w:.1} W",
            demand.peak_w
        ),
    };
    reasons.push(place, DOES_NOT_FIT, message, "", text);
}

/// By what share the speed of a move along its path may differ from that of the original
/// by rounding: places of pieces are rounded, and with them its direction.
pub(super) fn rounding(original: &ExpectedMove, mv: &Move, usual: f64) -> f64 {
    if original.split.is_none() || mv.kind == MoveKind::Dwell || mv.length_mm <= 0.0 {
        return usual;
    }
    // An axis has a share of the direction that is never small against its rounding: it
    // would not limit the speed otherwise.
    let ways = mv
        .moving
        .iter()
        .map(|axis| (mv.end[axis] - mv.start[axis]).abs());
    let least = ways.fold(f64::INFINITY, f64::min).max(BESIDE_MM);
    usual + (BESIDE_MM / least).min(1e-4)
}

impl ExpectedMove {
    /// The same for a piece.
    pub(super) fn without_row(&self) -> Self {
        Self {
            row: None,
            split: None,
            ..*self
        }
    }
}
